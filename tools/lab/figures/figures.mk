# The paper's figures from own data. What is drawn of libale comes from its own functions through figure_data.
$(BUILD)/figures/figure_data: $(call objects,tools/lab/figures/figure_data.cpp tools/lab/figures/growth.c tools/lab/inspect/trace.c $(BENCH_PARTS)) $(BUILD)/libale.a
	$(call link)

$(BUILD)/figures/corner_data: $(call objects,tools/lab/figures/corner_data.cpp) $(ARCHIVES)
	$(call link)

# A recording for the figures 8 and 10, where one is at hand.
RECORDED = $(wildcard $(ALE_SHARED)/data/urg04lx/exp1.dat)

.PHONY: figures
figures: ## the paper's figures, redrawn from own data (build/figures)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-figures.txt
	@$(MAKE) --no-print-directory -s programs $(BUILD)/figures/figure_data $(BUILD)/figures/corner_data $(BUILD)/bench/lines
	@/usr/bin/python3 tools/lab/figures/figures.py --build $(BUILD) --world tools/lab/worlds/home.world \
	    $(addprefix --recorded ,$(RECORDED)) --out $(BUILD)/figures

# Recordings at hand: those of the tree, and of $(ALE_SHARED)/data where it is there. What is left out there holds no
# scans of a scanner, or no motion between scans that are metres apart (orebro), or is the same scans once more.
MAP_LOGS ?= tests/digest/apartment.log.gz $(if $(ALE_SHARED),$(wildcard $(addprefix $(ALE_SHARED)/data/,urg04lx/*.dat urg04lx/*.gz \
    intel/intel_every5th.clf.gz intel/intel-lab.graph.log.gz killian/infinite-corridor.clf.gz killian/killian.g2o.gz \
    corrected/*.clf.gz other/*.gz)))
# The page of this folder is renewed by make maps MAPS=tools/lab/figures/maps.
MAPS ?= $(BUILD)/maps
.PHONY: maps
maps: programs ## a page of maps of all recordings at hand (build/maps; MAP_LOGS=paths, MAPS=folder)
	@$(PYTHON) tools/lab/figures/maps.py --replay $(BUILD)/bin/ale-replay --out $(MAPS) $(MAP_LOGS)

# A drive with each fault of tools/lab/bench/faults: its page is renewed by make fault-maps FAULT_MAPS=tools/lab/bench/faults/maps.
FAULT_MAPS ?= $(BUILD)/fault-maps
WORLD ?=
.PHONY: fault-maps
fault-maps: ## maps of a drive with each kind of fault (build/fault-maps; WORLD=apartment, KINDS=gap,dark-8, FAULT_MAPS=folder)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt tools/make/packages-figures.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-replay $(BUILD)/bin/ale-sim
	@$(PYTHON) tools/lab/figures/fault_maps.py --build $(BUILD) --out $(FAULT_MAPS) $(addprefix --world ,$(WORLD)) $(addprefix --kinds ,$(KINDS))
