# ale-replay for other machines: 64 bits, 32 bits, and the other byte order. Linked whole, run under qemu-user.
#
#   make cross            build for all and compare what they write with this machine, byte for byte
#   make cross-aarch64    build one

CROSS = aarch64 armhf s390x
CROSS_BUILD = $(BUILD)/cross
CROSS_LIBRARIES = zlib1g-dev libbz2-dev libpng-dev libinih-dev

triple_aarch64 = aarch64-linux-gnu
triple_armhf = arm-linux-gnueabihf
triple_s390x = s390x-linux-gnu
debian_aarch64 = arm64
debian_armhf = armhf
debian_s390x = s390x

$(CROSS_BUILD)/%/libraries/ready:
	$(call say,libraries,$*)
	$(Q)tools/make/cross.sh $(debian_$*) $(@D) $(CROSS_LIBRARIES) && touch $@

# What is compared needs no LCM, keys or ports: what wants those libraries (ale-replay --lcm) is left open by the linker, and must not
# be called there.
# $(call cross_make,machine,build folder,flags,target), in a rule whose first prerequisite is $(CROSS_BUILD)/machine/libraries/ready.
cross_make = $(MAKE) --no-print-directory BUILD=$(2) \
    CC="$(CCACHE)$(triple_$(1))-gcc" CXX="$(CCACHE)$(triple_$(1))-g++" AR=$(triple_$(1))-ar \
    CFLAGS="$(3) -isystem $(<D)/usr/include" CXXFLAGS="$(3) -isystem $(<D)/usr/include -Wno-psabi" \
    LDFLAGS="-static -L$(<D)/usr/lib/$(triple_$(1)) -Wl,--gc-sections -Wl,--unresolved-symbols=ignore-all" LIBRARIES="-lpng -lz -lbz2 -linih -lm" \
    $(4)

.PHONY: $(addprefix cross-,$(CROSS)) cross
$(addprefix cross-,$(CROSS)): cross-%: $(CROSS_BUILD)/%/libraries/ready
	$(Q)$(call cross_make,$*,$(CROSS_BUILD)/$*,,$(CROSS_BUILD)/$*/bin/ale-replay)

cross: programs ## the same bytes from aarch64, armhf and s390x, emulated
	@tools/make/deps.sh tools/make/packages-cross.txt
	@$(PYTHON) tools/make/digest.py --build $(BUILD) check $(CROSS)
