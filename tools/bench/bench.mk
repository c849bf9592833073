# Benchmarks. Everything in tools/bench but the mains is one set of objects, linked to each program and test.
BENCH_MAINS = tools/bench/lines.cpp
BENCH_PARTS = $(filter-out $(BENCH_MAINS),$(wildcard tools/bench/*.cpp tools/bench/textbook/*.cpp))
BENCH_SCANS ?= 20
BENCH_COUNTED_SCANS ?= 1

BENCH_PROGRAMS = $(patsubst tools/bench/%.cpp,$(BUILD)/bench/%,$(BENCH_MAINS))
$(BENCH_PROGRAMS): $(BUILD)/bench/%: $(OBJ)/tools/bench/%.cpp.o $(call objects,$(BENCH_PARTS)) $(BUILD)/libale_drivers.a $(BUILD)/libale.a
	$(call link)

# Tests of the benchmark, and of the calibration, which use its worlds.
BENCH_TESTS = $(patsubst %.cpp,$(BUILD)/%,$(wildcard tests/tools/bench/test_*.cpp tests/tools/calibrate/test_*.cpp))
$(BENCH_TESTS): $(call objects,$(BENCH_PARTS))

.PHONY: bench bench-lines
bench: bench-lines ## the benchmarks as tables
bench-lines: deps-test
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines
	@$(PYTHON) tools/bench/lines_table.py --program $(BUILD)/bench/lines --scans $(BENCH_SCANS) --counted $(BENCH_COUNTED_SCANS)
