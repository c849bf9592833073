# ale-merge closes loops as ale-replay does, with its progress bar: these parts are linked in.
$(BUILD)/bin/ale-merge: $(call objects,$(addprefix tools/lab/replay/,loops.cpp summary.cpp))
