# ale-ros2: the messages of ROS 2 in C, from their IDL. Where there is no idlc (Debian: cyclonedds-tools, cyclonedds-dev) the
# program is left out (tools/make/rules.mk).
ROS2 = tools/operator/ros2
ROS2_IDL = $(wildcard $(ROS2)/idl/*.idl)
ROS2_TYPES = $(BUILD)/dds
ROS2_OBJECTS = $(patsubst $(ROS2)/idl/%.idl,$(OBJ)/dds/%.o,$(ROS2_IDL))
ROS2_STAMP = $(ROS2_TYPES)/stamp

# Final, and without a description of the types on the network: as ROS 2's own middlewares have them.
$(ROS2_STAMP): $(ROS2_IDL) $(ROS2)/ros2.mk
	$(call say,idlc,$(ROS2)/idl)
	@rm -rf $(@D) && mkdir -p $(@D)
	$(Q)for idl in $(ROS2_IDL); do idlc -x final -t -I $(ROS2)/idl -o $(@D) $$idl || exit 1; done
	@touch $@
$(ROS2_TYPES)/%.c: $(ROS2_STAMP) ;
$(OBJ)/dds/%.o: $(ROS2_TYPES)/%.c $(FLAGS_STAMP)
	@mkdir -p $(@D)
	$(Q)$(CC) -std=gnu11 $(DEBUG) $(OPT) $(SANITIZER_FLAGS) -w -c $< -o $@

$(OBJ)/$(ROS2)/%.o: INCLUDES = $(TOOL_INCLUDES) -isystem $(ROS2_TYPES)
$(if $(LEFT_OUT),,$(call objects,$(call sources_of,$(ROS2))): $(ROS2_STAMP))
$(BUILD)/bin/ale-ros2: $(ROS2_OBJECTS)
$(BUILD)/bin/ale-ros2: LIBRARIES += -lddsc
