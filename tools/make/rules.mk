# How sources become programs.
#
#   lib/**/*.c           -> libale.a            the real-time core, integers only
#   lib/graph/**/*.cpp   -> libale_graph.a      the mapper
#   drivers/**/*.c       -> libale_drivers.a    with the generated LCM types
#   firmware/**/*.c      -> libale_firmware.a   all but main.c; main.c -> ale-slamd; one realtime/rt_$(RT).c (rtai.mk)
#   tools/common/*/*     -> libale_tools.a      linked to every tool
#   tools/GROUP/NAME/**  -> ale-NAME            page/ beside them is embedded; or of Python, all in one file
#
# Dependencies point down only: the include paths of each floor name only what lies below it.

Q = $(if $(filter 0,$(V)),@)
say = $(if $(filter 0,$(V)),@echo "  $(1)	$(2)")

SANITIZER_FLAGS = $(if $(SANITIZE),-fsanitize=$(SANITIZE) -fno-omit-frame-pointer -fno-sanitize-recover=all $(SANITIZER_SCOPE))
# What stack traces need: it compiles in three quarters of the time that a debugger's (`make DEBUG=-g`) takes.
DEBUG ?= -g1
COMMON_FLAGS = $(DEBUG) $(OPT) $(WARNINGS) $(SANITIZER_FLAGS) -MMD -MP
C_FLAGS = -std=c11 -D_GNU_SOURCE $(COMMON_FLAGS) $(CFLAGS)
# Generated LCM types read floats through pointers to integers. clang 19 warns of what libstdc++ 12 itself calls in its sort;
# what we call that is deprecated gcc tells.
CXX_FLAGS = -std=c++17 -fno-strict-aliasing $(COMMON_FLAGS) $(if $(findstring clang,$(CXX)),-Wno-deprecated-declarations) $(CXXFLAGS)
# Symbols are bound at start (-z now): the first call of a function would otherwise do it in the hard task. A build's id would
# tell debug information, and with it the folder of the build: stripped programs are the same bytes wherever they were made.
LINK_FLAGS = $(SANITIZER_FLAGS) -pthread -Wl,--as-needed,-z,now,--build-id=none $(LDFLAGS)
LIBRARIES = $(LCM_LIBRARIES) -lserialport -linih -lsodium -lwebsockets -lpng -lz -lbz2 -lm
# Without vectors a structure of Eigen's is laid out alike in every file, whatever processor and flags it is compiled for.
EIGEN = -isystem /usr/include/eigen3 -DEIGEN_DONT_VECTORIZE
SYSTEM_INCLUDES = -isystem $(BUILD)/lcmtypes $(LCM_INCLUDES) $(EIGEN)
CCACHE = $(if $(findstring ccache,$(CC)),ccache )
# The extractor is short loops over all beams and short functions: unrolled and inlined it takes 6 % fewer instructions.
EXTRACT_OPT = -O3 -funroll-loops
# -O2 leaves Eigen's products of two by two as chains of calls.
GRAPH_OPT = -O3
# The same bytes on every machine: sums in the order written, no fused or vector arithmetic. Python's module takes these
# objects, too (tools/library/python). CHECKED_GRAPH is another level for the mapper alone.
GRAPH_FLAGS = -ffp-contract=off -fno-tree-vectorize -fPIC $(CHECKED_GRAPH)

OBJ = $(BUILD)/obj
objects = $(patsubst %,$(OBJ)/%.o,$(1))

$(OBJ)/lib/base/%.o $(OBJ)/lib/extract/%.o: OPT = $(EXTRACT_OPT)
$(OBJ)/lib/graph/%.o: OPT = $(GRAPH_OPT)
$(OBJ)/lib/graph/%.o: CXX_FLAGS += $(GRAPH_FLAGS)
# Sums of whole numbers are the same in vectors, too.
$(OBJ)/lib/graph/fields/position_grid.cpp.o: CXX_FLAGS += -ftree-vectorize
# Room for no further observation is an array of none for gcc 14, which then warns of what is never written there. clang knows
# no such warning.
$(OBJ)/lib/track/step_observe.c.o: C_FLAGS += $(if $(findstring clang,$(CC)),,-Wno-stringop-overflow)

# Changes when objects are to be made by another compiler (also one of the same name and another release) or with other
# flags: those at hand are old then. Debug information and the compiler cache make no other object. Taken here, since a rule
# inherits the flags of what asks for it.
release_of = $(shell $(1) --version 2>/dev/null | head -n 1)
FLAGS := $(strip $(filter-out ccache $(DEBUG),$(CC) $(call release_of,$(CC)) $(C_FLAGS) $(CXX) $(call release_of,$(CXX)) $(CXX_FLAGS) \
    $(EXTRACT_OPT) $(GRAPH_OPT) $(GRAPH_FLAGS) $(EIGEN)))
FLAGS_STAMP = $(OBJ)/flags
ifneq ($(FLAGS),$(file < $(FLAGS_STAMP)))
$(FLAGS_STAMP): FORCE
endif
$(FLAGS_STAMP):
	@mkdir -p $(@D)
	@echo '$(FLAGS)' > $@

include tools/make/lcm.mk
include tools/make/rtai.mk

# Floors of the house: each sees itself and what lies below.
LIB_SOURCES = $(wildcard lib/*/*.c lib/*/*/*.c)
GRAPH_SOURCES = $(wildcard lib/graph/*.cpp lib/graph/*/*.cpp)
DRIVER_SOURCES = $(wildcard drivers/*/*.c drivers/*/*/*.c)
FIRMWARE_SOURCES = $(filter-out firmware/main.c firmware/realtime/rt_%.c,$(wildcard firmware/*.c firmware/*/*.c)) firmware/realtime/rt_$(RT).c
TOOL_SHARED_SOURCES = $(wildcard tools/common/*/*.c tools/common/*/*.cpp)

LIB_INCLUDES = -Ilib
DRIVER_INCLUDES = -Ilib -Idrivers $(SYSTEM_INCLUDES)
FIRMWARE_INCLUDES = -Ilib -Idrivers -Ifirmware $(SYSTEM_INCLUDES)
TOOL_INCLUDES = -Ilib -Idrivers -Ifirmware -Itools $(SYSTEM_INCLUDES)
TEST_INCLUDES = $(TOOL_INCLUDES) -Itests

$(OBJ)/lib/%.o: INCLUDES = $(LIB_INCLUDES)
$(OBJ)/lib/graph/%.o: INCLUDES = $(LIB_INCLUDES) $(EIGEN)
$(OBJ)/drivers/%.o: INCLUDES = $(DRIVER_INCLUDES)
$(OBJ)/firmware/%.o: INCLUDES = $(FIRMWARE_INCLUDES)
$(OBJ)/tools/%.o: INCLUDES = $(TOOL_INCLUDES)
$(OBJ)/tests/%.o: INCLUDES = $(TEST_INCLUDES)

# System headers are in no .d file: changed message types are a reason to compile again.
$(OBJ)/%.c.o: %.c $(LCM_STAMP) $(FLAGS_STAMP)
	$(call say,cc,$<)
	@mkdir -p $(@D)
	$(Q)$(CC) $(C_FLAGS) $(INCLUDES) -c $< -o $@

define compile_cpp
	$(call say,c++,$<)
	@mkdir -p $(@D)
	$(Q)$(CXX) $(PRELUDE_USED) $(CXX_FLAGS) $(INCLUDES) -c $< -o $@
endef
$(OBJ)/%.cpp.o: %.cpp $(LCM_STAMP) $(FLAGS_STAMP)
	$(compile_cpp)

# What the mapper and the tools include most is compiled before, once for each: Eigen is half of what the mapper costs, the
# standard library of what a small file does. Not with a compiler cache, which knows each file by itself; so it shows, too, who
# includes too little.
COMMON_HEADERS = Eigen/Cholesky Eigen/Core Eigen/LU algorithm array cmath cstring fstream functional iostream map memory optional random \
    sstream stdexcept string vector
define precompile
	@mkdir -p $(@D)
	$(Q)printf '#include <%s>\n' $(COMMON_HEADERS) > $(basename $@)
	$(Q)$(1) -x c++-header $(basename $@) -o $@
endef
# Compilers refuse what another compiler or other flags have made: each has its own.
PRELUDE_KEY := $(if $(CCACHE),,$(shell { $(CXX) --version; echo '$(CXX_FLAGS)'; } | cksum | cut -d ' ' -f 1))
COMMON_PRELUDE = prelude-$(PRELUDE_KEY).hpp
define with_prelude
$(OBJ)/$(1)/$(COMMON_PRELUDE).gch:
	$$(call precompile,$$(CXX) $$(filter-out -MMD -MP,$$(CXX_FLAGS)) $$(INCLUDES))
$(OBJ)/$(1)/%.cpp.o: PRELUDE_USED = -include $(OBJ)/$(1)/$(COMMON_PRELUDE)
$(OBJ)/$(1)/%.cpp.o: $(1)/%.cpp $(LCM_STAMP) $(FLAGS_STAMP) $(OBJ)/$(1)/$(COMMON_PRELUDE).gch
	$$(compile_cpp)
endef
$(if $(CCACHE),,$(foreach floor,lib/graph tools,$(eval $(call with_prelude,$(floor)))))

define archive
	$(call say,ar,$@)
	@mkdir -p $(@D)
	$(Q)rm -f $@ && $(AR) rcs $@ $(filter %.o,$^)
endef

$(BUILD)/libale.a: $(call objects,$(LIB_SOURCES))
	$(archive)
$(BUILD)/libale_graph.a: $(call objects,$(GRAPH_SOURCES))
	$(archive)
$(BUILD)/libale_drivers.a: $(call objects,$(DRIVER_SOURCES)) $(LCM_OBJECTS)
	$(archive)
# Presets of scanners, compiled in.
SCANNERS_INI = $(OBJ)/firmware/config/scanners_ini.c
$(SCANNERS_INI): firmware/config/scanners.ini tools/make/embed_text.py
	@mkdir -p $(@D)
	$(Q)$(PYTHON) tools/make/embed_text.py $@ ale_scanners_ini $<
$(SCANNERS_INI).o: $(SCANNERS_INI) $(FLAGS_STAMP)
	$(Q)$(CC) $(C_FLAGS) -c $< -o $@
$(BUILD)/libale_firmware.a: $(call objects,$(FIRMWARE_SOURCES)) $(SCANNERS_INI).o $(BUILD)/realtime-port
	$(archive)
$(BUILD)/libale_tools.a: $(call objects,$(TOOL_SHARED_SOURCES))
	$(archive)

ARCHIVES = $(addprefix $(BUILD)/,libale_tools.a libale_firmware.a libale_drivers.a $(if $(GRAPH_SOURCES),libale_graph.a) libale.a)
FIRMWARE_ARCHIVES = $(filter-out %tools.a,$(ARCHIVES))

define link
	$(call say,link,$@)
	@mkdir -p $(@D)
	$(Q)$(CXX) $(LINK_FLAGS) $(filter %.o,$^) $(filter %.a,$^) $(LIBRARIES) $(1) -o $@
endef

# Programs: one folder each, with a main; a folder with other rules has them in NAME.mk.
TOOL_FOLDERS = $(filter-out $(LEFT_OUT),$(patsubst %/,%,$(sort $(dir $(wildcard tools/*/*/main.c tools/*/*/main.cpp)))))
# The bridge to ROS 2 wants Cyclone DDS: where that is not there (no idlc), all the rest is built.
LEFT_OUT := $(if $(shell command -v idlc),,tools/operator/ros2)
# A folder with a main.py is a program of Python: its modules in one file.
PYTHON_FOLDERS = $(patsubst %/,%,$(sort $(dir $(wildcard tools/*/*/main.py))))
PYTHON_PROGRAMS = $(addprefix $(BUILD)/bin/ale-,$(notdir $(PYTHON_FOLDERS)))
PROGRAMS = $(addprefix $(BUILD)/bin/ale-,$(if $(wildcard firmware/main.c),slamd) $(notdir $(TOOL_FOLDERS))) $(PYTHON_PROGRAMS)

# Names of the release before, as links: ale-screen for ale-watch --screen, ale-mounting for ale-calibrate.
OLDER_NAMES = $(addprefix $(BUILD)/bin/,ale-screen ale-mounting)
$(BUILD)/bin/ale-screen: $(BUILD)/bin/ale-watch
$(BUILD)/bin/ale-mounting: $(BUILD)/bin/ale-calibrate
$(OLDER_NAMES):
	$(Q)ln -sf $(notdir $<) $@

.PHONY: programs
programs: $(PROGRAMS) $(OLDER_NAMES)

$(BUILD)/bin/ale-slamd: $(OBJ)/firmware/main.c.o $(FIRMWARE_ARCHIVES)
	$(call link)

# All of a program, its main too: sources of its folder and of the folders in it.
sources_of = $(wildcard $(addprefix $(1)/,*.c *.cpp */*.c */*.cpp))

define program
$(BUILD)/bin/ale-$(notdir $(1)): $$(call objects,$$(call sources_of,$(1))) $$(if $$(wildcard $(1)/page/*),$$(OBJ)/$(1)/page.o) $$(ARCHIVES)
	$$(call link)
$$(OBJ)/$(1)/page.cpp: $$(wildcard $(1)/page/*) tools/make/embed.py
	@mkdir -p $$(@D)
	$$(Q)$$(PYTHON) tools/make/embed.py $$@ $$(wildcard $(1)/page/*)
$$(OBJ)/$(1)/page.o: $$(OBJ)/$(1)/page.cpp $$(FLAGS_STAMP)
	$$(Q)$$(CXX) $$(CXX_FLAGS) $$(TOOL_INCLUDES) -c $$< -o $$@
endef
$(foreach tool,$(TOOL_FOLDERS),$(eval $(call program,$(tool))))

PACKED_foxglove = $(BUILD)/python/ale tools/library/python/src/ale/ros_messages.py
PACKED_plot = $(BUILD)/python/ale
INTERPRETER_foxglove = /usr/bin/env

define python_program
$(BUILD)/bin/ale-$(notdir $(1)): $$(wildcard $(1)/*.py $(1)/*.json) lib/base/version.h tools/make/python_program.py $$(filter %.py,$$(PACKED_$(notdir $(1)))) $$(if $$(PACKED_$(notdir $(1))),$$(LCM_STAMP))
	$$(call say,python,$$@)
	@mkdir -p $$(@D)
	$$(Q)$$(PYTHON) tools/make/python_program.py $$@ $(1) $$(or $$(INTERPRETER_$(notdir $(1))),/usr/bin/python3) $$(PACKED_$(notdir $(1)))
endef
$(foreach tool,$(PYTHON_FOLDERS),$(eval $(call python_program,$(tool))))

-include $(shell find $(OBJ) -name '*.d' 2>/dev/null)
