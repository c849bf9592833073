# Benchmarks. Everything in tools/lab/bench but the main is one set of objects, linked to the program and its tests.
BENCH_PARTS = $(filter-out %/lines.cpp,$(wildcard tools/lab/bench/*.cpp tools/lab/bench/lines/*.cpp tools/lab/bench/lines/textbook/*.cpp))
BENCH_SCANS ?= 20
BENCH_COUNTED_SCANS ?= 1

$(BUILD)/bench/lines: $(call objects,tools/lab/bench/lines/lines.cpp $(BENCH_PARTS)) $(addprefix $(BUILD)/,libale_tools.a libale_drivers.a libale.a)
	$(call link)

# Tests of the benchmark, and of the calibration, which use its worlds.
BENCH_TESTS = $(patsubst %.cpp,$(BUILD)/%,$(wildcard tests/tools/lab/bench/*/test_*.cpp tests/tools/robot/calibrate/test_*.cpp))
$(BENCH_TESTS): $(call objects,$(filter-out $(TEST_WORLD_SOURCES),$(BENCH_PARTS)))

.PHONY: bench bench-lines
bench: bench-lines ## the benchmarks as tables
bench-lines: deps-test
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines
	@$(PYTHON) tools/lab/bench/lines_table.py --program $(BUILD)/bench/lines --scans $(BENCH_SCANS) --counted $(BENCH_COUNTED_SCANS)

REST_LOGS ?= $(if $(ALE_SHARED),$(addprefix $(ALE_SHARED)/data/urg04lx/,obstacle_demo_front.scan.gz test_lab.dat exp1.dat))
.PHONY: bench-rest
bench-rest: deps-test ## lines where real scanners rest, as a table (REST_LOGS='LOG ...': recordings)
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines
	@$(PYTHON) tools/lab/bench/rest_table.py --program $(BUILD)/bench/lines $(REST_LOGS)

BENCH_TURNS ?= 1024,512,450
.PHONY: bench-turns
bench-turns: deps-test ## lines in whole turns of a scanner, wherever it begins, as a table (BENCH_TURNS=1024,512,450: beams)
	@$(MAKE) --no-print-directory -s $(BUILD)/bench/lines
	@$(PYTHON) tools/lab/bench/scanners/turns_table.py --program $(BUILD)/bench/lines --scans $(BENCH_SCANS) --beams $(BENCH_TURNS)

# Drives with the models of all scanners, each read with its preset.
SCANNERS_SEEDS ?= 1
WORLDS ?=
.PHONY: bench-scanners
bench-scanners: ## drives with every scanner's model beside the URG's, as tables: long (SCANNERS_SEEDS=1,2; ONLY=ld06; WORLDS=home,maze; JOBS=2)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-replay $(BUILD)/bin/ale-sim
	@$(PYTHON) tools/lab/bench/scanners/scanners_table.py --build $(BUILD) --seeds $(SCANNERS_SEEDS) $(addprefix --only ,$(ONLY)) $(addprefix --worlds ,$(WORLDS)) --jobs $(JOBS)

# Localisation and mapping: drives through the worlds of the tree, and what lies in $(ALE_SHARED).
BENCH_SLAM_SEEDS ?= 1,2,3
ONLY ?=
JITTER ?=
.PHONY: bench-slam
bench-slam: ## localisation and mapping as tables, beside the best of other systems: minutes (BENCH_SLAM_SEEDS=1,2,3; ONLY=home: seconds; JITTER=1,2: buildings also with noise of these seeds)
	@tools/make/deps.sh tools/make/packages-build.txt $(if $(ONLY),tools/make/packages-test.txt,tools/make/packages-bench.txt)
	@$(MAKE) --no-print-directory -s programs
	@$(PYTHON) tools/lab/bench/slam_table.py --build $(BUILD) --seeds $(BENCH_SLAM_SEEDS) $(addprefix --only ,$(ONLY)) $(addprefix --jitter ,$(JITTER))

# The same drives with faults in wheels, scans or place (faults/spoil.py).
FAULTS_SEEDS ?= 1,2,3
KINDS ?=
ODOMETRY ?= on
CARRIED ?= 0
EACH ?=
JOBS ?= 2
.PHONY: bench-faults
bench-faults: ## drives on which something goes wrong, as tables: long (FAULTS_SEEDS=1,2,3; ONLY=home,office; KINDS=gap,dark-8; ODOMETRY=off; CARRIED=100; EACH=1; JOBS=2)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-replay $(BUILD)/bin/ale-sim
	@$(PYTHON) tools/lab/bench/faults/faults_table.py --build $(BUILD) --seeds $(FAULTS_SEEDS) $(addprefix --only ,$(ONLY)) $(addprefix --kinds ,$(KINDS)) \
		--odometry $(ODOMETRY) --carried $(CARRIED) --jobs $(JOBS) $(if $(EACH),--each)

LOG ?=
RELATIONS ?=
OFTEN ?=
.PHONY: bench-published
bench-published: ## the published benchmark, all relations, beside others (ONLY=aces; LOG=path RELATIONS=path: your own recording; JITTER=1,2: also with noise of these seeds; OFTEN=1,2: with wheels that go wrong)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-replay $(BUILD)/bin/ale-sim
	@$(PYTHON) tools/lab/bench/published_table.py --build $(BUILD) $(addprefix --only ,$(ONLY)) $(addprefix --log ,$(LOG)) $(addprefix --relations ,$(RELATIONS)) $(addprefix --jitter ,$(JITTER)) $(addprefix --often ,$(OFTEN))

# Buildings of five drives each, homes that are alike, Intel in six drives, and a hall driven twice.
MERGE_SEEDS ?= 1
INTEL_DRIVES ?= 6
.PHONY: bench-merge
bench-merge: ## drives that become one map, as tables: minutes (MERGE_SEEDS=1,2; INTEL_DRIVES=6,4; ONLY=office, alike, intel or hall; pictures in build/merge)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-bench.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-merge $(BUILD)/bin/ale-sim
	@$(PYTHON) tools/lab/bench/merge_table.py --build $(BUILD) --seeds $(MERGE_SEEDS) --pieces $(INTEL_DRIVES) $(addprefix --only ,$(ONLY)) --maps $(BUILD)/merge

# Many short drives by ale-fleet.
FLEET_DRIVES ?= 200
FLEET_WORKERS ?= 1,2,4,8
FLEET_ROUNDS ?= 1
.PHONY: bench-fleet
bench-fleet: ## drives by ale-fleet over more and more workers, some of them killed, and over two hosts (as root), as tables: minutes (FLEET_DRIVES=200; FLEET_WORKERS=1,2,4,8; FLEET_ROUNDS=3: interleaved; ONLY=replay or merge)
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt tools/make/packages-bench.txt
	@$(MAKE) --no-print-directory -s $(addprefix $(BUILD)/bin/ale-,fleet merge replay sim)
	@$(PYTHON) tools/lab/bench/fleet/fleet_table.py --build $(BUILD) --drives $(FLEET_DRIVES) --workers $(FLEET_WORKERS) --rounds $(FLEET_ROUNDS) $(addprefix --only ,$(ONLY))

.PHONY: bench-saved-map
bench-saved-map: ## recordings that begin anywhere in their own saved map, and in that of others, as a table (ONLY="exp3 aces")
	@tools/make/deps.sh tools/make/packages-build.txt tools/make/packages-test.txt
	@$(MAKE) --no-print-directory -s $(BUILD)/bin/ale-replay
	@$(PYTHON) tools/lab/bench/saved_map_table.py "$(ALE_SHARED)" --build $(BUILD) $(addprefix --only ,$(ONLY))

POSES ?= 100
.PHONY: relocalise
relocalise: programs ## lost at random places of every bundled world, with a saved map (POSES=100)
	@$(PYTHON) tools/lab/bench/relocalise.py --build $(BUILD) --poses $(POSES)
