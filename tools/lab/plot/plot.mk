# ale-plot is Python: its package in one file, beside the other programs.
PLOT = $(BUILD)/bin/ale-plot
$(PLOT): $(wildcard tools/lab/plot/ale_plot/*.py) lib/base/version.h tools/make/zip_program.py
	$(call say,zip,$@)
	@mkdir -p $(@D)
	$(Q)$(PYTHON) tools/make/zip_program.py $@ tools/lab/plot/ale_plot lib/base/version.h
programs: $(PLOT)

.PHONY: install-plot
install: install-plot
install-plot: $(PLOT)
	install -D -m 755 $(PLOT) $(DESTDIR)$(PREFIX)/bin/ale-plot

MANUALS += $(BUILD)/man/ale-plot.1
$(BUILD)/man/ale-plot.1: $(PLOT)
manuals: $(BUILD)/man/ale-plot.1
