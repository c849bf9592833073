# The real-time port that ale-slamd is built with.
#
#   make                                     RT=posix: PREEMPT_RT and any Linux
#   make RT=rtai [RTAI_CONFIG=rtai-config]   RTAI/LXRT; RTAI_CONFIG says where its headers and libraries are
#
# RTAI's headers warn and need GNU C: they are system headers, and of its flags only folders and macros are taken.

RT ?= posix
RTAI_CONFIG ?= rtai-config

rtai_config = $(shell ALE_BUILD=$(abspath $(BUILD)) $(1) $(2) 2>/dev/null)
rtai_cflags = -std=gnu11 -Wno-cpp $(patsubst -I%,-isystem %,$(filter-out -I.,$(filter -I% -D%,$(call rtai_config,$(1),--lxrt-cflags))))

ifeq ($(RT),rtai)
ifeq ($(call rtai_config,$(RTAI_CONFIG),--lxrt-cflags),)
$(error RT=rtai: $(RTAI_CONFIG) gives no flags: name the rtai-config of the RTAI that is installed with RTAI_CONFIG=)
endif
$(OBJ)/firmware/realtime/rt_rtai.c.o: C_FLAGS += $(call rtai_cflags,$(RTAI_CONFIG))
LIBRARIES += $(call rtai_config,$(RTAI_CONFIG),--lxrt-ldflags)
endif

# Changes when another port is asked for, and with it what was built for the old one.
PORT = $(RT)$(if $(filter rtai,$(RT)), $(RTAI_CONFIG))
.PHONY: FORCE
$(BUILD)/realtime-port: FORCE
	@mkdir -p $(@D)
	@echo "$(PORT)" | cmp -s - $@ || echo "$(PORT)" > $@
$(OBJ)/firmware/realtime/rt_rtai.c.o: $(BUILD)/realtime-port
