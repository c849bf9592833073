# lcm-spy with our types. Debian's own script cannot start under Java 17 (it passes an option that is gone), so Java is called
# here; LCM's Java part speaks IPv4 multicast only.
SPY_CLASSES = $(LCM_CLASSES):/usr/share/java/jchart2d.jar:$(LCM_JAR)
.PHONY: spy
spy: deps ## lcm-spy with our types: every channel live, as a table and as graphs (needs a screen; LCM_DEFAULT_URL says where)
	@tools/make/deps.sh tools/make/packages-spy.txt
	@$(MAKE) --no-print-directory -s lcm-types
	@test -n "$$DISPLAY" || { echo "lcm-spy needs a screen and DISPLAY is not set; ale-watch shows the robot without one" >&2; exit 1; }
	@java -Djava.net.preferIPv4Stack=true -ea -cp $(SPY_CLASSES) lcm.spy.Spy
