# LCM, and the types made with it.
#
# Generator, headers, library and Java classes are of one release, the one that pkg-config tells of. The lcm-gen that is
# first in the PATH may be another's (PyPI's `lcm` brings one), and what that writes need not compile with these headers.
#
#   make LCM_PREFIX=FOLDER    another release: bin/lcm-gen, include, lib and share/java below FOLDER

LCM_PREFIX ?= $(shell pkg-config --variable=prefix lcm 2>/dev/null)
LCM_FOLDER := $(or $(LCM_PREFIX),/usr)
LCM_GEN ?= $(firstword $(wildcard $(LCM_FOLDER)/bin/lcm-gen) lcm-gen)
LCM_CLASSES = $(LCM_FOLDER)/share/java/lcm.jar
# The compiler looks below /usr by itself.
LCM_ELSEWHERE := $(filter-out /usr,$(LCM_FOLDER))
LCM_INCLUDES = $(addprefix -isystem ,$(addsuffix /include,$(LCM_ELSEWHERE)))
LCM_LIBRARIES = $(foreach folder,$(addsuffix /lib,$(abspath $(LCM_ELSEWHERE))),-L$(folder) -Wl,-rpath,$(folder)) -llcm

# Changes with the release: types that another one has made are old then.
LCM_RELEASE := $(LCM_GEN) $(shell $(LCM_GEN) --version 2>/dev/null)
LCM_RELEASE_STAMP = $(OBJ)/lcm-release
ifneq ($(LCM_RELEASE),$(file < $(LCM_RELEASE_STAMP)))
$(LCM_RELEASE_STAMP): FORCE
endif
$(LCM_RELEASE_STAMP):
	@mkdir -p $(@D)
	@echo '$(LCM_RELEASE)' > $@

# C with the prefix lcmtypes_ (ale_pose_t is the core's own), C++, Python, Java. The C++ makes room for as many elements as
# a message claims to have, gigabytes for a few bytes of anybody's: here for no more than it has bytes left.
LCM_FILES = $(wildcard lib/messages/*.lcm)
LCM_NAMES = $(foreach f,$(LCM_FILES),$(addprefix lcmtypes_$(basename $(notdir $(f)))_,$(shell sed -n 's/^struct \([a-z0-9_]*\).*/\1/p' $(f))))
LCM_OBJECTS = $(patsubst %,$(OBJ)/lcmtypes/%.o,$(LCM_NAMES))
LCM_STAMP = $(BUILD)/lcmtypes/stamp

# The release that the headers are of, as lcm-gen would tell its own.
headers_release = printf '\#include <lcm/lcm.h>\nlcm-gen LCM_MAJOR_VERSION LCM_MINOR_VERSION LCM_MICRO_VERSION\n' | \
    $(CC) $(LCM_INCLUDES) -E -P -x c - | sed -n 's/^\(lcm-gen [0-9]*\) \([0-9]*\) /\1.\2./p'

$(LCM_STAMP): $(LCM_FILES) tools/make/lcm.mk $(LCM_RELEASE_STAMP)
	$(call say,lcm-gen,$(LCM_FILES))
	@headers=$$($(headers_release)); generator=$$($(LCM_GEN) --version); test "$$headers" = "$$generator" || { echo \
	    "$(LCM_GEN) is $$generator and does not fit the headers of $$headers: LCM_PREFIX= names the folder of one release" >&2; exit 1; }
	$(Q)rm -rf $(@D) $(BUILD)/python/ale $(BUILD)/java && mkdir -p $(@D) $(BUILD)/python $(BUILD)/java
	$(Q)$(LCM_GEN) -c --c-no-pubsub --c-cpath $(@D) --c-hpath $(@D) --package-prefix lcmtypes $(LCM_FILES)
	$(Q)$(LCM_GEN) -x --cpp-hpath $(@D) --cpp-std c++11 $(LCM_FILES)
	$(Q)sed -i -E 's/^( *)this->\w+\.resize\(this->(\w+)\);/\1if(this->\2 < 0 || this->\2 > maxlen - pos) return -1;\n&/' $(@D)/*/*.hpp
	$(Q)$(LCM_GEN) -p --ppath $(BUILD)/python $(LCM_FILES)
	$(Q)$(LCM_GEN) -j --jpath $(BUILD)/java $(LCM_FILES)
	$(Q)touch $@

.SECONDARY:
.DELETE_ON_ERROR:
$(BUILD)/lcmtypes/%.c: $(LCM_STAMP) ;

$(OBJ)/lcmtypes/%.o: $(BUILD)/lcmtypes/%.c $(FLAGS_STAMP)
	@mkdir -p $(@D)
	$(Q)$(CC) -std=gnu11 $(DEBUG) $(OPT) $(SANITIZER_FLAGS) $(LCM_INCLUDES) -ffunction-sections -w -c $< -o $@

LCM_JAR = $(BUILD)/ale-lcmtypes.jar
$(LCM_JAR): $(LCM_STAMP)
	$(call say,jar,$@)
	$(Q)mkdir -p $(BUILD)/java/classes
	$(Q)javac -nowarn -cp $(LCM_CLASSES) -d $(BUILD)/java/classes $$(find $(BUILD)/java -name '*.java')
	$(Q)jar cf $@ -C $(BUILD)/java/classes .

.PHONY: lcm-types
lcm-types: $(LCM_JAR) ## the LCM types for lcm-spy (build/ale-lcmtypes.jar) and Python (build/python)
