# The paper's figures from own data. What is drawn of libale comes from its own functions through figure_data.
$(BUILD)/figures/figure_data: $(call objects,tools/figures/figure_data.cpp tools/figures/growth.c tools/inspect/trace.c $(BENCH_PARTS)) $(BUILD)/libale.a
	$(call link)

.PHONY: figures
figures: ## the paper's figures, redrawn from own data (build/figures)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-figures.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/figures/figure_data $(BUILD)/bench/lines
	@/usr/bin/python3 tools/figures/figures.py --data $(BUILD)/figures/figure_data --bench $(BUILD)/bench/lines --out $(BUILD)/figures

# Recordings at hand: those of the tree, and of $(ALE_SHARED)/data where it is there.
MAP_LOGS ?= tests/digest/apartment.log.gz $(if $(ALE_SHARED),$(wildcard $(addprefix $(ALE_SHARED)/data/,urg04lx/*.dat \
    intel/intel_every5th.clf.gz killian/infinite-corridor.clf.gz corrected/*.clf.gz other/*.gz)))
.PHONY: maps
maps: programs ## a page of maps of all recordings at hand (build/maps; MAP_LOGS=paths)
	@$(PYTHON) tools/figures/maps.py --replay $(BUILD)/bin/ale-replay --out $(BUILD)/maps $(MAP_LOGS)
