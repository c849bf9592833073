# Everything by every gcc and clang of the machine, each into build/toolchains/NAME; what they make of the recording at hand
# is compared.
#
#   make toolchains [TOOLCHAINS="gcc-13 clang-19"]

cxx_of = $(patsubst clang%,clang++%,$(patsubst gcc%,g++%,$(1)))
TOOLCHAINS ?= $(foreach cc,$(sort $(notdir $(wildcard $(foreach digit,0 1 2 3 4 5 6 7 8 9,/usr/bin/gcc-1$(digit) /usr/bin/clang-1$(digit))))),$(if \
    $(wildcard /usr/bin/$(call cxx_of,$(cc))),$(cc)))
TOOLCHAIN_BUILDS = $(BUILD)/toolchains

.PHONY: toolchains $(addprefix toolchain-,$(TOOLCHAINS))
$(addprefix toolchain-,$(TOOLCHAINS)): toolchain-%:
	@echo "$*: $$($* --version | head -n 1)"
	@$(MAKE) --no-print-directory -s BUILD=$(TOOLCHAIN_BUILDS)/$* CC="$(CCACHE)$*" CXX="$(CCACHE)$(call cxx_of,$*)" V=1 programs library

toolchains: programs $(addprefix toolchain-,$(TOOLCHAINS)) ## everything by every gcc-NN and clang-NN of the machine, the same bytes from each (TOOLCHAINS="gcc-13 clang-19")
	@$(MAKE) --no-print-directory -s same-bytes SAME_BYTES_HOW=--quick \
	    SAME_BYTES_BUILDS="$(TOOLCHAINS:%=$(TOOLCHAIN_BUILDS)/%/bin/ale-replay)"
