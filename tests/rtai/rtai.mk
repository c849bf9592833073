# The emulation of RTAI: a library, known to whoever asks its rtai-config; and ale-slamd over it.

RTAI_EMULATION_CONFIG = tests/rtai/rtai-config
RTAI_EMULATION = $(BUILD)/rtai/liblxrt.a
$(OBJ)/tests/rtai/%.c.o: C_FLAGS += -std=gnu11 -fno-builtin
$(RTAI_EMULATION): $(call objects,$(wildcard tests/rtai/*.c))
	$(archive)

# make RT=rtai RTAI_CONFIG=tests/rtai/rtai-config
ifeq ($(RT) $(realpath $(RTAI_CONFIG)),rtai $(realpath $(RTAI_EMULATION_CONFIG)))
$(BUILD)/realtime-port: $(RTAI_EMULATION)
endif

# Out of the objects of an ordinary build: what the system tests run a second time, and unit tests of the port.
EMULATED_PORT = $(OBJ)/emulated/rt_rtai.c.o
EMULATED_FIRMWARE = $(BUILD)/rtai/libale_firmware.a
EMULATED_ARCHIVES = $(EMULATED_FIRMWARE) $(filter-out %libale_firmware.a,$(FIRMWARE_ARCHIVES)) $(RTAI_EMULATION)
$(EMULATED_PORT): firmware/realtime/rt_rtai.c | $(LCM_STAMP)
	$(call say,cc,$< (emulated))
	@mkdir -p $(@D)
	$(Q)$(CC) $(C_FLAGS) $(call rtai_cflags,$(RTAI_EMULATION_CONFIG)) $(FIRMWARE_INCLUDES) -c $< -o $@
$(EMULATED_FIRMWARE): $(call objects,$(filter-out firmware/realtime/rt_%.c,$(FIRMWARE_SOURCES))) $(SCANNERS_INI).o $(EMULATED_PORT)
	$(archive)
$(BUILD)/rtai/ale-slamd: $(OBJ)/firmware/main.c.o $(EMULATED_ARCHIVES)
	$(call link)
$(BUILD)/tests/rtai/%: $(TEST_OBJ)/tests/rtai/%.cpp.o $(EMULATED_ARCHIVES)
	$(call link,-lgtest_main -lgtest)
