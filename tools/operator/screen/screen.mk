$(BUILD)/bin/ale-screen: LIBRARIES += -lncursesw -ltinfo
