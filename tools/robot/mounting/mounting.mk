# ale-mounting reads a drive with the configuration that ale-replay would use.
$(BUILD)/bin/ale-mounting: $(call objects,tools/lab/replay/robot_config.cpp)
