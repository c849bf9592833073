# Benchmarks. Everything in tools/lab/bench but the mains is one set of objects, linked to each program and test.
BENCH_MAINS = tools/lab/bench/lines.cpp tools/lab/bench/wcet.cpp tools/lab/bench/hardest.cpp
BENCH_PARTS = $(filter-out $(BENCH_MAINS),$(wildcard tools/lab/bench/*.cpp tools/lab/bench/textbook/*.cpp))
BENCH_SCANS ?= 20
BENCH_COUNTED_SCANS ?= 1

BENCH_PROGRAMS = $(patsubst tools/lab/bench/%.cpp,$(BUILD)/bench/%,$(filter-out %/hardest.cpp,$(BENCH_MAINS)))
$(BENCH_PROGRAMS): $(BUILD)/bench/%: $(OBJ)/tools/lab/bench/%.cpp.o $(call objects,$(BENCH_PARTS)) $(addprefix $(BUILD)/,libale_tools.a libale_drivers.a libale.a)
	$(call link)

# Tests of the benchmark, and of the calibration, which use its worlds.
BENCH_TESTS = $(patsubst %.cpp,$(BUILD)/%,$(wildcard tests/tools/lab/bench/test_*.cpp tests/tools/robot/calibrate/test_*.cpp))
$(BENCH_TESTS): $(call objects,$(filter-out $(TEST_WORLD_SOURCES),$(BENCH_PARTS)))

.PHONY: bench bench-lines
bench: bench-lines ## the benchmarks as tables
bench-lines: deps-test
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines
	@$(PYTHON) tools/lab/bench/lines_table.py --program $(BUILD)/bench/lines --scans $(BENCH_SCANS) --counted $(BENCH_COUNTED_SCANS)

# Localisation and mapping: drives through the worlds of the tree, and what lies in $(ALE_SHARED).
BENCH_SLAM_SEEDS ?= 1,2,3
ONLY ?=
.PHONY: bench-slam
bench-slam: ## localisation and mapping as tables, beside the best of other systems: minutes (BENCH_SLAM_SEEDS=1,2,3; ONLY=home: seconds)
	@tools/make/deps.sh tools/make/packages-build.txt $(if $(ONLY),tools/make/packages-test.txt,tools/make/packages-bench.txt)
	@$(MAKE) --no-print-directory -s programs
	@$(PYTHON) tools/lab/bench/slam_table.py --build $(BUILD) --seeds $(BENCH_SLAM_SEEDS) $(addprefix --only ,$(ONLY))

# Instructions of one scan's way through the estimate task: recorded ones, and the most expensive that a search finds.
WCET_TRIES ?= 100
WCET_SEED ?= 11
WCET_LOGS = tests/digest/apartment.log.gz $(if $(ALE_SHARED),$(wildcard $(ALE_SHARED)/data/urg04lx/exp1.dat))
WCET_OUT = $(BUILD)/bench/wcet.counts
.PHONY: wcet
wcet: deps-test ## instructions of a scan by callgrind: recorded, and the worst that a search finds (WCET_TRIES=100 WCET_SEED=11)
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/wcet
	@valgrind -q --tool=callgrind --collect-atstart=no --callgrind-out-file=$(WCET_OUT) \
	    $(BUILD)/bench/wcet --counts $(WCET_OUT) --tries $(WCET_TRIES) --seed $(WCET_SEED) $(WCET_LOGS)

POSES ?= 100
.PHONY: relocalise
relocalise: programs ## lost at random places of every bundled world, with a saved map (POSES=100)
	@$(PYTHON) tools/lab/bench/relocalise.py --build $(BUILD) --poses $(POSES)

# The costliest scan: the extractor compiled with a call at every basic block, which are counted. Its loops stay rolled:
# blocks of unrolled ones stand for several turns, and the search then finds scans that cost 4 % less.
COUNTED_OBJECTS = $(patsubst %.c,$(OBJ)/counted/%.o,$(wildcard lib/base/*.c lib/extract/*.c))
$(COUNTED_OBJECTS): $(OBJ)/counted/%.o: %.c $(FLAGS_STAMP)
	@mkdir -p $(@D)
	$(Q)$(CC) $(C_FLAGS) -fsanitize-coverage=trace-pc $(LIB_INCLUDES) -c $< -o $@

$(BUILD)/bench/hardest: $(call objects,$(patsubst %,tools/lab/bench/%.cpp,hardest suite world simulate truth)) $(BUILD)/libale_tools.a $(COUNTED_OBJECTS)
	$(call link)

BENCH_STEPS ?= 40000
BENCH_SEEDS ?= 1,2,3
.PHONY: bench-hardest
bench-hardest: deps-test ## the scan that costs the extractor most, in instructions
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines $(BUILD)/bench/hardest $(BUILD)/bin/ale-replay
	@$(PYTHON) tools/lab/bench/hardest_table.py --build $(BUILD) --steps $(BENCH_STEPS) --seeds $(BENCH_SEEDS)
