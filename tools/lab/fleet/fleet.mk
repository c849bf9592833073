# ale-fleet is Python: its package in one file, beside the other programs.
FLEET = $(BUILD)/bin/ale-fleet
$(FLEET): $(wildcard tools/lab/fleet/ale_fleet/*.py) lib/base/version.h tools/make/zip_program.py
	$(call say,zip,$@)
	@mkdir -p $(@D)
	$(Q)$(PYTHON) tools/make/zip_program.py $@ tools/lab/fleet/ale_fleet lib/base/version.h
programs: $(FLEET)
