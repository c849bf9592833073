# The paper's figures from own data. What is drawn of libale comes from its own functions through figure_data.
$(BUILD)/figures/figure_data: $(call objects,tools/figures/figure_data.cpp tools/figures/growth.c tools/inspect/trace.c $(BENCH_PARTS)) $(BUILD)/libale.a
	$(call link)

.PHONY: figures
figures: ## the paper's figures, redrawn from own data (build/figures)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-figures.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/figures/figure_data $(BUILD)/bench/lines
	@/usr/bin/python3 tools/figures/figures.py --data $(BUILD)/figures/figure_data --bench $(BUILD)/bench/lines --out $(BUILD)/figures
