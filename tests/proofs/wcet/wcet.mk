# The most expensive scans: of the whole estimate task, and of the extractor alone.
$(BUILD)/bench/wcet: $(call objects,$(patsubst %,tests/proofs/wcet/%.cpp,wcet bound every_scan_parts tracked_parts lost_parts crowd scans)) $(addprefix $(BUILD)/,libale_tools.a libale_drivers.a libale.a)
	$(call link)

# Instructions of one scan's way through the estimate task: recorded ones, and the most expensive that a search finds.
WCET_TRIES ?= 100
WCET_SEED ?= 11
WCET_LOGS = tests/digest/apartment.log.gz $(if $(ALE_SHARED),$(wildcard $(ALE_SHARED)/data/urg04lx/exp1.dat))
WCET_OUT = $(BUILD)/bench/wcet.counts
.PHONY: wcet
wcet: deps-test ## instructions of a scan by callgrind: recorded, the worst that a search finds, and the bound of any; fails above 10 million (WCET_TRIES=100 WCET_SEED=11)
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/wcet
	@valgrind -q --tool=callgrind --collect-atstart=no --callgrind-out-file=$(WCET_OUT) \
	    $(BUILD)/bench/wcet --counts $(WCET_OUT) --tries $(WCET_TRIES) --seed $(WCET_SEED) $(WCET_LOGS)

# The same on a processor in order: cycles of a Cortex-A7, counted under qemu-arm by a plugin.
CORTEX_A7_BUILD = $(CROSS_BUILD)/cortex-a7
CORTEX_A7_SOURCES = $(wildcard tests/proofs/wcet/cortex_a7/*.c)
$(BUILD)/bench/cortex_a7.so: $(CORTEX_A7_SOURCES) $(wildcard tests/proofs/wcet/cortex_a7/*.h)
	@mkdir -p $(@D)
	$(Q)$(CC) -std=c11 -O2 $(WARNINGS) -fPIC -shared -fvisibility=hidden -o $@ $(CORTEX_A7_SOURCES)

.PHONY: wcet-cycles cortex-a7-build
cortex-a7-build: $(CROSS_BUILD)/armhf/libraries/ready
	$(Q)$(call cross_make,armhf,$(CORTEX_A7_BUILD),-mcpu=cortex-a7,$(CORTEX_A7_BUILD)/bench/wcet)

wcet-cycles: deps-test ## the same in cycles of a Cortex-A7 (1 GHz, in order), by qemu: minutes; fails above 100 million
	@tools/make/deps.sh tools/make/packages-cross.txt
	@$(MAKE) --no-print-directory -s cortex-a7-build $(BUILD)/bench/cortex_a7.so
	@qemu-arm -plugin $(BUILD)/bench/cortex_a7.so,out=$(WCET_OUT) \
	    $(CORTEX_A7_BUILD)/bench/wcet --counts $(WCET_OUT) $(WCET_LOGS)

# The costliest scan: the extractor compiled with a call at every basic block, which are counted. Its loops stay rolled:
# blocks of unrolled ones stand for several turns, and the search then finds scans that cost 4 % less.
COUNTED_OBJECTS = $(patsubst %.c,$(OBJ)/counted/%.o,$(wildcard lib/base/*.c lib/extract/*.c))
$(COUNTED_OBJECTS): $(OBJ)/counted/%.o: %.c $(FLAGS_STAMP)
	@mkdir -p $(@D)
	$(Q)$(CC) $(C_FLAGS) -fsanitize-coverage=trace-pc $(LIB_INCLUDES) -c $< -o $@

$(BUILD)/bench/hardest: $(call objects,tests/proofs/wcet/hardest.cpp $(patsubst %,tools/lab/bench/%.cpp,suite world simulate truth)) $(BUILD)/libale_tools.a $(COUNTED_OBJECTS)
	$(call link)

BENCH_STEPS ?= 40000
BENCH_SEEDS ?= 1,2,3
.PHONY: bench-hardest
bench-hardest: deps-test ## the scan that costs the extractor most, in instructions
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines $(BUILD)/bench/hardest $(BUILD)/bin/ale-replay
	@$(PYTHON) tests/proofs/wcet/hardest_table.py --build $(BUILD) --steps $(BENCH_STEPS) --seeds $(BENCH_SEEDS)
