# Tests. Each tests/**/test_*.cpp is one GoogleTest program; every other tests/**/*.cpp is linked to all of them.
#
#   make unit [T="part/of/path .."]  unit and property tests
#   make system [T=word]             tests of the real programs (pytest)

TEST_SOURCES = $(shell find tests -name 'test_*.cpp' | sort)
TEST_SHARED_SOURCES = $(shell find tests -name '*.cpp' ! -name 'test_*' ! -name 'fuzz_*' ! -path 'tests/planted/*' ! -path 'tests/proofs/*' | sort)
TEST_PROGRAMS = $(patsubst tests/%.cpp,$(BUILD)/tests/%,$(TEST_SOURCES))
SELECTED_TESTS = $(if $(T),$(foreach p,$(TEST_PROGRAMS),$(if $(strip $(foreach t,$(T),$(findstring $(t),$(p)))),$(p))),$(TEST_PROGRAMS))
T ?=

SHARED_DATA = $(abspath ../shared)
export ALE_SHARED = $(if $(wildcard $(SHARED_DATA)/data),$(SHARED_DATA))
export ALE_BUILD = $(abspath $(BUILD))

# Tools whose parts are tested: everything of tools/GROUP/NAME but its main.
TOOL_PARTS = $(foreach t,$(TOOL_FOLDERS),$(filter-out %/main.c %/main.cpp,$(call sources_of,$(t))))
$(BUILD)/libale_tool_parts.a: $(call objects,$(TOOL_PARTS))
	$(archive)

# The tests themselves are compiled once, without sanitizers, for every build of the code under test; what they all
# include, once for all of them. TEST_BUILD names the build whose tests are linked. By clang: unlike gcc it keeps the
# templates that were instantiated there, too, and takes half the time. What it warns of is told; the twins and all
# that is delivered are held to gcc's warnings.
TEST_CXX ?= $(CCACHE)clang++
TEST_BUILD ?= $(BUILD)
TEST_OBJ = $(TEST_BUILD)/test-objects
test_objects = $(patsubst %,$(TEST_OBJ)/%.o,$(1))
TEST_FLAGS = -std=c++17 -fno-strict-aliasing -g1 $(WARNINGS) -MMD -MP $(CXXFLAGS) $(TEST_INCLUDES)
# The twins of the core do the most work of all tests.
TWIN_FLAGS = $(TEST_FLAGS) -O1
TWIN_CXX = $(CCACHE)g++
TWIN_PRELUDE = $(if $(CCACHE),,$(TEST_OBJ)/twins.hpp)
PRELUDE = $(TEST_OBJ)/prelude.hpp
PRELUDE_FLAGS = $(filter-out -Werror,$(TEST_FLAGS)) -Wno-sign-conversion -O0 -fpch-instantiate-templates -Xclang -fno-pch-timestamp
# ccache must be told that a precompiled header is known by its contents; the header itself names the folder it was made in.
export CCACHE_SLOPPINESS = pch_defines,time_macros

# Another release of these compilers refuses what was precompiled: all is made anew, where TEST_BUILD is another build's, too.
TEST_COMPILERS := $(call release_of,$(TEST_CXX)) $(call release_of,$(TWIN_CXX))
TEST_COMPILERS_STAMP = $(TEST_OBJ)/compilers
ifneq ($(TEST_COMPILERS),$(file < $(TEST_COMPILERS_STAMP)))
$(TEST_COMPILERS_STAMP): FORCE
endif
$(TEST_COMPILERS_STAMP):
	@mkdir -p $(@D)
	@echo '$(TEST_COMPILERS)' > $@

$(PRELUDE).pch: tests/prelude.hpp $(TEST_COMPILERS_STAMP)
	$(call say,c++,$<)
	@mkdir -p $(@D)
	$(Q)cp $< $(PRELUDE)
	$(Q)CCACHE_DISABLE=1 $(TEST_CXX) $(PRELUDE_FLAGS) -x c++-header $(PRELUDE) -o $@
# Message types are system headers, which no .d file names.
$(TEST_OBJ)/%.cpp.o: %.cpp $(LCM_FILES) $(PRELUDE).pch | $(LCM_STAMP)
	$(call say,c++,$<)
	@mkdir -p $(@D)
	$(Q)$(TEST_CXX) -include-pch $(PRELUDE).pch $(PRELUDE_FLAGS) -c $< -o $@
$(TEST_OBJ)/twins.hpp.gch: $(TEST_COMPILERS_STAMP)
	$(call precompile,$(TWIN_CXX) $(filter-out -MMD -MP,$(TWIN_FLAGS)))
define twin
	$(call say,c++,$<)
	@mkdir -p $(@D)
	$(Q)$(TWIN_CXX) $(addprefix -include ,$(TWIN_PRELUDE)) $(TWIN_FLAGS) -c $< -o $@
endef
$(TEST_OBJ)/tests/reference/%.cpp.o: tests/reference/%.cpp $(addsuffix .gch,$(TWIN_PRELUDE)) | $(LCM_STAMP)
	$(twin)
$(TEST_OBJ)/tools/%.cpp.o: tools/%.cpp $(addsuffix .gch,$(TWIN_PRELUDE)) | $(LCM_STAMP)
	$(twin)
-include $(shell find $(TEST_OBJ) -name '*.d' 2>/dev/null)

# Tests of the core use the benchmark's worlds and its simulated scanner.
TEST_WORLD_SOURCES = tools/lab/bench/world.cpp tools/lab/bench/simulate.cpp tools/lab/bench/truth.cpp
TEST_SHARED = $(TEST_BUILD)/libale_test_shared.a
$(TEST_SHARED): $(call test_objects,$(TEST_SHARED_SOURCES) $(TEST_WORLD_SOURCES))
	$(archive)

include tests/rtai/rtai.mk
include tests/proofs/wcet/wcet.mk
include tests/proofs/eva/eva.mk
TEST_ARCHIVES = $(TEST_SHARED) $(FIRMWARE_ARCHIVES)
$(BUILD)/tests/tools/%: $(TEST_OBJ)/tests/tools/%.cpp.o $(BUILD)/libale_tool_parts.a $(BUILD)/libale_tools.a $(TEST_ARCHIVES)
	$(call link,-lgtest_main -lgtest)
# Of templates that both instantiate the linker keeps the first: the mapper's own, optimised and sanitized as it is, come before
# the test's, which are neither.
$(BUILD)/tests/lib/graph/%: $(call objects,$(GRAPH_SOURCES)) $(TEST_OBJ)/tests/lib/graph/%.cpp.o $(TEST_ARCHIVES)
	$(call link,-lgtest_main -lgtest)
$(BUILD)/tests/%: $(TEST_OBJ)/tests/%.cpp.o $(TEST_ARCHIVES)
	$(call link,-lgtest_main -lgtest)

.PHONY: unit unit-programs system system-rtai venv
unit-programs: $(SELECTED_TESTS)
unit: unit-programs ## unit and property tests (T=part of a path selects)
	@$(if $(strip $(SELECTED_TESTS)),,$(error no unit test has '$(T)' in its path))$(PYTHON) tools/make/run_tests.py unit $(SELECTED_TESTS)

VENV = $(BUILD)/venv
# What the tests of the bridges compare with, and the storage and tables of ale-fleet: where these cannot be had they are skipped, and say so.
$(VENV)/ready: tests/requirements.txt tests/requirements-bridges.txt tests/requirements-fleet.txt
	@$(PYTHON) -m venv --system-site-packages $(VENV)
	@$(VENV)/bin/pip install -q --disable-pip-version-check -r $<
	@$(VENV)/bin/pip install -q --disable-pip-version-check -r tests/requirements-bridges.txt || \
	    echo "tests/requirements-bridges.txt cannot be had: tests of ale-ros2 and ale-foxglove are skipped" >&2
	@$(VENV)/bin/pip install -q --disable-pip-version-check -r tests/requirements-fleet.txt || \
	    echo "tests/requirements-fleet.txt cannot be had: tests of ale-fleet with S3 and Parquet are skipped" >&2
	@touch $@
venv: $(VENV)/ready

SYSTEM_PROGRAMS ?= programs python-package
system: $(SYSTEM_PROGRAMS) lcm-types venv ## tests of the real programs over pseudo terminals and LCM (T=word selects; MARK=long: the long ones alone)
	@$(PYTHON) tools/make/run_tests.py system $(VENV)/bin/python $(if $(T),-rP -k "$(T)") $(if $(MARK),-m $(MARK)) $(if $(DIST),--dist $(DIST))

system-rtai: programs lcm-types venv $(BUILD)/rtai/ale-slamd ## the system tests with the firmware on an emulated RTAI (T=file of tests/system)
	@ALE_SLAMD=$(BUILD)/rtai/ale-slamd $(PYTHON) tools/make/run_tests.py system $(VENV)/bin/python $(or $(T),tests/system)

# Which of them: hil (a drive), boots, power.
VIRTUAL ?= hil boots power
.PHONY: hil-vm
hil-vm: programs lcm-types venv deb ## virtual robot PCs in qemu: a drive under PREEMPT_RT, days from boot to power cut, cuts while files are written (BOOTS=10 CUTS=50)
	@tools/make/deps.sh tools/make/packages-vm.txt
	@for machine in $(VIRTUAL); do \
	    $(PYTHON) tools/make/run_tests.py system $(VENV)/bin/python --reruns 0 -rP tests/system/$${machine}_vm.py || failed=1; done; [ -z "$$failed" ]

.PHONY: endurance
endurance: programs lcm-types venv ## 20,000 scans at ten times the speed, and latency under load: minutes, on an idle machine
	@PYTHONPATH=$(BUILD)/python PYTHONDONTWRITEBYTECODE=1 $(VENV)/bin/python -m pytest -q -rP -p no:cacheprovider tests/system/endurance.py

.PHONY: screenshots
screenshots: programs lcm-types venv ## pictures of the console for its README, of the real programs in Chromium: look at each
	@PYTHONPATH=$(BUILD)/python PYTHONDONTWRITEBYTECODE=1 $(VENV)/bin/python -m pytest -q -p no:cacheprovider tests/system/screenshots.py

.PHONY: soak
soak: programs lcm-types venv ## a day at ten times the speed: nothing grows, no deadline is missed (SOAK_HOURS=1: an hour), on an idle machine
	@PYTHONPATH=$(BUILD)/python PYTHONDONTWRITEBYTECODE=1 $(VENV)/bin/python -m pytest -q -rP -p no:cacheprovider tests/system/soak.py

.PHONY: proofs
proofs: programs ## bounded by construction: symbols, call graph, soft-float build, system call filter (part of make test)
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) -m pytest -q -rP -p no:cacheprovider tests/proofs

.PHONY: soak-bridges
soak-bridges: programs lcm-types venv ## half an hour of exploring with console, Foxglove and ROS 2 looked at: no pose later than without (BRIDGES_MINUTES=30), on an idle machine
	@PYTHONPATH=$(BUILD)/python PYTHONDONTWRITEBYTECODE=1 $(VENV)/bin/python -m pytest -q -rP -s -p no:cacheprovider tests/system/bridges_soak.py

# Coverage-guided fuzzing with clang's libFuzzer, one program a harness.
FUZZ_SECONDS ?= 600
FUZZ_BUILD = $(BUILD)/fuzz
FUZZ_SOURCES = $(wildcard tests/fuzz/fuzz_*.cpp)
FUZZ_PROGRAMS = $(patsubst tests/fuzz/%.cpp,$(FUZZ_BUILD)/bin/%,$(FUZZ_SOURCES))
FUZZ_FLAGS = -g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all
# What takes bytes from outside, and what that stands on.
FUZZ_C = $(filter lib/base/% drivers/%,$(LIB_SOURCES) $(DRIVER_SOURCES))

$(FUZZ_BUILD)/obj/%.c.o: %.c | $(LCM_STAMP)
	@mkdir -p $(@D)
	$(Q)clang -std=c11 -D_GNU_SOURCE $(FUZZ_FLAGS) -MMD -MP $(DRIVER_INCLUDES) -c $< -o $@
$(FUZZ_BUILD)/libale.a: $(patsubst %,$(FUZZ_BUILD)/obj/%.o,$(FUZZ_C)) $(LCM_OBJECTS)
	$(archive)
$(FUZZ_BUILD)/bin/%: tests/fuzz/%.cpp $(FUZZ_BUILD)/libale.a
	$(call say,fuzzer,$@)
	@mkdir -p $(@D)
	$(Q)clang++ -std=c++17 $(FUZZ_FLAGS) -fsanitize=fuzzer -MMD -MP -MT $@ -MF $(FUZZ_BUILD)/$*.d $(DRIVER_INCLUDES) -Itests \
	    $< $(FUZZ_BUILD)/libale.a $(filter-out -lwebsockets -lpng,$(LIBRARIES)) -o $@
-include $(shell find $(FUZZ_BUILD) -name '*.d' 2>/dev/null)

# Files of every format, damaged, read by the real programs of the sanitized build: all of them in `make mutated`, some 25 minutes;
# a share in `make test-all`.
MUTATED_INPUTS ?= 2000
MUTATED_FIRST ?= 0
MUTATED_SHORT = 25
MUTATED_SHARE = 100
MUTATED_FORMATS ?= $(shell $(PYTHON) tests/fuzz/mutated_files.py --formats)
MUTATED = $(PYTHON) tests/fuzz/mutated_files.py --programs $(BUILD)/asan/bin --keep $(BUILD)/mutated
export ALE_TYPES = $(ALE_BUILD)/python
.PHONY: mutated
mutated: programs lcm-types ## damaged files of every format, 2,000 of each (MUTATED_INPUTS=100; MUTATED_FORMATS="map scip")
	@$(CHECKED) -j2 $(MUTATED_PROGRAMS) $(addprefix $(BUILD)/asan/bin/ale-,$(MUTATED_LONG_PROGRAMS))
	@for format in $(MUTATED_FORMATS); do \
	    $(PYTHON) tools/make/run_tests.py command "mutated $$format" $(MUTATED) --seed $(MUTATED_FIRST) --inputs $(MUTATED_INPUTS) --only $$format || failed=1; done; \
	    test -z "$$failed"

.PHONY: fuzz-programs fuzz
fuzz-programs: $(FUZZ_PROGRAMS)
fuzz: deps-test ## long run of the fuzzers (FUZZ_SECONDS=600 each)
	@$(MAKE) --no-print-directory -s fuzz-programs
	@$(PYTHON) tools/make/run_tests.py fuzz --seconds $(FUZZ_SECONDS) $(FUZZ_PROGRAMS)

# The same bytes from every compiler and level: ale-replay built again, and its results compared with one another
# and with the digests in tests/digest.
.PHONY: same-bytes digest lint lint-format lint-cppcheck lint-misra lint-tidy misra
SAME_BYTES_BUILDS ?= gcc:-O0 clang:-O3
same-bytes: programs
	@$(PYTHON) tools/make/digest.py --build $(BUILD) check $(SAME_BYTES_HOW) $(SAME_BYTES_BUILDS)
digest: programs ## after a wanted change of features or trajectories: their new digests into tests/digest
	@$(PYTHON) tools/make/digest.py --build $(BUILD) update

LINT_JOBS ?= 2
MISRA = $(PYTHON) tests/proofs/misra.py --build $(BUILD) --jobs $(LINT_JOBS)
misra: ## MISRA C:2012 over the core, by cppcheck's addon: what tests/proofs/misra.md says of it is so
	@tools/make/deps.sh tools/make/packages-test.txt
	@$(MISRA)

C_FAMILY = $(shell git ls-files --cached --others --exclude-standard '*.c' '*.h' '*.cpp' '*.hpp')
lint: lint-format lint-cppcheck lint-misra lint-tidy ## clang-format and cppcheck of everything, clang-tidy of what runs on the robot
lint-format:
	@$(PYTHON) tools/make/run_tests.py command clang-format clang-format --dry-run -Werror $(C_FAMILY)
lint-cppcheck:
	@$(PYTHON) tools/make/run_tests.py command cppcheck tools/make/cppcheck.sh $(LINT_JOBS)
lint-misra:
	@$(PYTHON) tools/make/run_tests.py command misra $(MISRA)
lint-tidy: $(LCM_STAMP)
	@$(PYTHON) tools/make/run_tests.py command clang-tidy env JOBS=$(LINT_JOBS) tools/make/tidy.sh $(BUILD) $(LIB_SOURCES) $(DRIVER_SOURCES) $(FIRMWARE_SOURCES) $(wildcard firmware/main.c)

.PHONY: docs-check
docs-check: programs ## what the READMEs name is there, and their figures are what their commands print (ALL=1: the long ones, too)
	@$(PYTHON) tools/make/docs_check.py --build $(BUILD) $(if $(ALL),--all)

# The whole of it, as continuous integration runs it. Each part counts its tests; the sum is the last line.
SHORT_FUZZ = --seconds 5 --inputs 50000
export ALE_RESULTS ?= $(ALE_BUILD)/test-results.txt
PHASE = $(PYTHON) tools/make/run_tests.py phase
SUB = $(MAKE) --no-print-directory -s
# By clang, which can be told in whose code to look for undefined behaviour: in Eigen's it doubles what the mapper costs. With -O1 clang puts
# no function into its caller, of which the mapper is made: it gets -O2.
CHECKED = $(SUB) CC=$(CCACHE)clang CXX=$(CCACHE)clang++ BUILD=$(BUILD)/asan TEST_BUILD=$(BUILD) SANITIZE=address,undefined OPT=-O1 \
    SANITIZER_SCOPE=-fsanitize-ignorelist=tests/sanitizer_scope.txt CHECKED_GRAPH=-O2
MUTATED_PROGRAMS = $(addprefix $(BUILD)/asan/bin/,ale-replay ale-slamd ale-keys)
# Who reads what a share of the damaged files leaves out.
MUTATED_LONG_PROGRAMS = bridge sim
MUTATED_LONG_FORMATS = secret world
# Tests of hostile input on every socket, and what they start.
HOSTILE_TESTS = test_hostile or ten_thousand_hostile
HOSTILE_PROGRAMS = $(addprefix $(BUILD)/asan/bin/ale-,slamd keys send sim console watch latency record bridge)
ROBOT_TESTS = tests/lib tests/drivers tests/firmware
THREADED = $(SUB) BUILD=$(BUILD)/tsan TEST_BUILD=$(BUILD) SANITIZE=thread OPT=-O1 T=tests/firmware
MORE_SEEDS = tools/lab/explore/test_exploration lib/graph/test_joins
RTAI_SYSTEM_TESTS = tests/system/test_daemon.py tests/system/test_latency.py
RTAI_BUILD = BUILD=$(BUILD)/rtai-build RT=rtai RTAI_CONFIG=$(RTAI_EMULATION_CONFIG)
# What waits for programs in real time does not run beside what computes, not even with a low priority for that: the kernel's
# worker that hands on what a pseudo terminal received may then get no processor for seconds, and the firmware is blind.
# One program at a time, when nothing else wants a processor, does no harm to what waits.
IDLY = chrt --idle 0
.PHONY: test test-waiting test-computing test-all
test: deps-test ## all tests on this machine; the last line counts them
	@$(PYTHON) tools/make/run_tests.py begin
	@$(PHASE) "build"
	@$(SUB) -j2 all library python-package $(BUILD)/bench/lines $(BUILD)/rtai/ale-slamd venv
	-@$(PYTHON) tools/make/run_tests.py part $(SUB) test-waiting
	-@$(PYTHON) tools/make/run_tests.py part $(SUB) test-computing
	@$(PHASE) "all of it"
	@$(PYTHON) tools/make/run_tests.py sum

test-waiting:
	@$(PHASE) "the real programs over pseudo terminals and LCM"
	-@$(SUB) system
	@$(PHASE) "the firmware as an RTAI program, on an emulated RTAI"
	-@$(SUB) T="$(RTAI_SYSTEM_TESTS)" system-rtai

test-computing:
	@$(PHASE) "unit and property tests: what runs on the robot, address and undefined-behaviour sanitizers"
	@$(CHECKED) -j2 T="$(ROBOT_TESTS)" unit-programs
	-@$(CHECKED) T="$(ROBOT_TESTS)" unit
	@$(PHASE) "unit tests of the tools"
	@$(SUB) -j2 T="tests/tools tests/rtai" unit-programs
	-@$(SUB) T="tests/tools tests/rtai" unit
	@$(PHASE) "thread sanitizer"
	@$(THREADED) -j2 unit-programs
	-@$(THREADED) unit
	@$(PHASE) "fuzzers"
	@$(SUB) -j2 fuzz-programs
	-@$(PYTHON) tools/make/run_tests.py fuzz $(SHORT_FUZZ) $(FUZZ_PROGRAMS)
	@$(PHASE) "the documents"
	-@$(PYTHON) tools/make/run_tests.py command "documents" $(SUB) docs-check
	@$(PHASE) "the same bytes from another compiler and level, with sanitizers"
	@$(CHECKED) -j2 $(BUILD)/asan/bin/ale-replay
	-@$(PYTHON) tools/make/run_tests.py command "same bytes" $(SUB) same-bytes SAME_BYTES_HOW=--quick SAME_BYTES_BUILDS=$(BUILD)/asan/bin/ale-replay
	@$(PHASE) "damaged files, a share of them"
	@$(CHECKED) -j2 $(MUTATED_PROGRAMS)
	-@$(PYTHON) tools/make/run_tests.py command "mutated files" $(MUTATED) --inputs $(MUTATED_SHORT) --without $(MUTATED_LONG_FORMATS)

# A build with RTAI begins with the objects of the ordinary one: only the port is another, and what is linked with it.
#
# After `make test` in the same build folder (AFTER_TEST=1) only the rest runs, and the sum is of both.
test-all: ## make test, lint, and the same bytes from every compiler, level and emulated machine
	$(if $(AFTER_TEST),,@$(SUB) test)
	@$(PHASE) "the same bytes from another compiler"
	-@$(PYTHON) tools/make/run_tests.py command "same bytes, every recording" $(SUB) same-bytes SAME_BYTES_BUILDS=clang:-O3
	@$(PHASE) "no run-time error in the arithmetic and the scanners' protocols: Frama-C"
	-@$(PYTHON) tools/make/run_tests.py command "proofs of run time" $(SUB) prove-share
	@$(PHASE) "damaged files"
	-@$(SUB) mutated MUTATED_FIRST=$(MUTATED_SHORT) MUTATED_INPUTS=$$(($(MUTATED_SHARE) - $(MUTATED_SHORT))) \
	    MUTATED_FORMATS="$(filter-out $(MUTATED_LONG_FORMATS),$(MUTATED_FORMATS))"
	-@$(SUB) mutated MUTATED_INPUTS=$(MUTATED_SHARE) MUTATED_FORMATS="$(MUTATED_LONG_FORMATS)"
	@$(PHASE) "the Debian packages"
	-@$(PYTHON) tools/make/run_tests.py command "install, remove, purge" $(SUB) test-deb
	-@$(PYTHON) tools/make/run_tests.py command "packages of the same bytes" $(SUB) same-packages
	@$(PHASE) "the same bytes on other machines, emulated"
	-@$(PYTHON) tools/make/run_tests.py command "same bytes, aarch64 armhf s390x" $(SUB) cross
	@$(PHASE) "a drive, days and power cuts of a virtual robot PC, mostly waiting; meanwhile lint"
	-@$(IDLY) $(SUB) --keep-going lint LINT_JOBS=1 > $(BUILD)/lint.txt 2>&1 & $(SUB) hil-vm; wait
	@cat $(BUILD)/lint.txt
	@$(PHASE) "the firmware as an RTAI program, on an emulated RTAI"
	@rm -rf $(BUILD)/rtai-build && mkdir -p $(BUILD)/rtai-build && cp -a $(BUILD)/obj $(BUILD)/lcmtypes $(BUILD)/rtai-build
	-@$(PYTHON) tools/make/run_tests.py command "make RT=rtai" $(SUB) $(RTAI_BUILD) -j2 programs
	-@$(SUB) T="$(filter-out $(RTAI_SYSTEM_TESTS),$(wildcard tests/system/test_*.py))" system-rtai
	@$(PHASE) "hostile datagrams, messages and requests on every socket, with sanitizers"
	@$(CHECKED) -j2 $(HOSTILE_PROGRAMS) lcm-types
	-@ALE_LONG_TESTS=1 $(CHECKED) VENV=$(abspath $(VENV)) SYSTEM_PROGRAMS= T="$(HOSTILE_TESTS)" system
	@$(PHASE) "the robot explores at a click in the browser; the console's page in every size, theme and layer; the bridges: what make test leaves out"
	-@ALE_LONG_TESTS=1 $(SUB) system T=console_explores
	-@ALE_LONG_TESTS=1 $(SUB) system T="test_console_access or test_console_controls or test_console_fleet or test_console_flights or test_console_recordings or ros2 or test_foxglove or test_bags" MARK=long DIST=load
	@$(PHASE) "simulated scanners read by clients that are not ours, a minute each"
	-@ALE_LONG_TESTS=1 $(SUB) system T=independent_clients DIST=load
	@$(PHASE) "a robot in a building of a square kilometre"
	-@ALE_LONG_TESTS=1 $(SUB) system T=square_kilometre
	@$(PHASE) "Python's wheel in an empty virtual environment"
	-@ALE_LONG_TESTS=1 $(SUB) system T="test_python_wheel or test_python_types"
	@$(PHASE) "explorations in a closed loop with the simulator and maps that join, more of them"
	@$(SUB) -j2 T="$(MORE_SEEDS)" unit-programs
	-@ALE_LONG_TESTS=1 $(SUB) T="$(MORE_SEEDS)" unit
	@$(PHASE) "all of it"
	@$(PYTHON) tools/make/run_tests.py sum
