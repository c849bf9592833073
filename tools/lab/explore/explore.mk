# ale-explore drives the simulator's robot: its parts are linked in.
$(BUILD)/bin/ale-explore: $(call objects,$(filter-out %/main.cpp,$(call sources_of,tools/lab/sim)))

.PHONY: explorations
explorations: programs ## ten explorations of each bundled world, in lock step
	@for world in home apartment office arena; do echo "$$world"; \
	    $(BUILD)/bin/ale-explore --world tools/lab/worlds/$$world.world --seeds 10; done
