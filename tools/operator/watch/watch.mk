$(BUILD)/bin/ale-watch: LIBRARIES += -lncursesw -ltinfo
