# ale-slamd as a service: `make install` and `make deb`. What is laid out where: firmware/deploy/README.md.

PREFIX ?= /usr/local
SYSCONFDIR ?= /etc
DEPLOY = firmware/deploy
VERSION := $(shell sed -n 's/.*ALE_VERSION "\(.*\)"/\1/p' lib/base/version.h)
DEB = $(BUILD)/ale-slam_$(VERSION)_$(shell dpkg --print-architecture 2>/dev/null).deb

.PHONY: install install-service deb test-deb
install: all install-service ## install programs, library, headers, types and the service under $(DESTDIR)$(PREFIX)
	install -d $(DESTDIR)$(PREFIX)/bin $(DESTDIR)$(PREFIX)/share/ale-slam $(DESTDIR)$(PREFIX)/share/java
	install -m 755 $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	cp -P $(OLDER_NAMES) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(wildcard lib/messages/*.lcm) $(DESTDIR)$(PREFIX)/share/ale-slam
	install -m 644 $(BUILD)/ale-lcmtypes.jar $(DESTDIR)$(PREFIX)/share/java

install-service:
	install -d $(DESTDIR)$(PREFIX)/lib/systemd/system
	sed 's,@PREFIX@,$(PREFIX),; s,@SYSCONFDIR@,$(SYSCONFDIR),' $(DEPLOY)/ale-slamd.service.in \
	    > $(DESTDIR)$(PREFIX)/lib/systemd/system/ale-slamd.service
	install -D -m 644 $(DEPLOY)/60-ale-slam.rules $(DESTDIR)$(PREFIX)/lib/udev/rules.d/60-ale-slam.rules
	install -D -m 644 $(DEPLOY)/60-ale-slam.conf $(DESTDIR)$(PREFIX)/lib/sysctl.d/60-ale-slam.conf
	install -D -m 644 $(DEPLOY)/ale-slam.sysusers $(DESTDIR)$(PREFIX)/lib/sysusers.d/ale-slam.conf
	[ -e $(DESTDIR)$(SYSCONFDIR)/ale-slam/ale-slamd.ini ] || \
	    install -D -m 644 $(DEPLOY)/ale-slamd.ini $(DESTDIR)$(SYSCONFDIR)/ale-slam/ale-slamd.ini

deb: all ## a Debian package into build/
	@tools/make/deb.sh $(BUILD)/deb $(DEB) $(VERSION) "$(MAKE) --no-print-directory -s BUILD=$(BUILD)"

test-deb: deb ## installs the package into a layer over this machine, looks, removes and purges it (root)
	@tools/make/deps.sh tools/make/packages-deb.txt
	@$(PYTHON) tools/make/test_deb.py $(DEB) || [ $$? = 77 ]
