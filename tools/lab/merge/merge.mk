# ale-merge has the progress bar of ale-replay: that part is linked in.
$(BUILD)/bin/ale-merge: $(call objects,tools/lab/replay/summary.cpp)
