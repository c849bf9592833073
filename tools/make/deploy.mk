# Everything laid out as a machine has it, and as Debian packages. What is laid out where: firmware/deploy/README.md.

PREFIX ?= /usr/local
SYSCONFDIR ?= /etc
STRIP ?= strip --strip-unneeded
DEPLOY = firmware/deploy
VERSION := $(shell sed -n 's/.*ALE_VERSION "\(.*\)"/\1/p' lib/base/version.h)
SHARE = $(DESTDIR)$(PREFIX)/share
PACKAGES = $(BUILD)/packages

# Manual pages are what --help says.
MANUALS = $(patsubst $(BUILD)/bin/%,$(BUILD)/man/%.1,$(filter-out %/ale-slamd,$(PROGRAMS) $(OLDER_NAMES))) $(BUILD)/man/ale-slamd.8
define manual
	@mkdir -p $(@D)
	$(Q)$(PYTHON) tools/make/man_page.py $< $(subst .,,$(suffix $@)) > $@
endef
$(BUILD)/man/%.1: $(BUILD)/bin/% tools/make/man_page.py
	$(manual)
$(BUILD)/man/%.8: $(BUILD)/bin/% tools/make/man_page.py
	$(manual)

.PHONY: install install-programs install-service install-documents manuals deb test-deb same-packages
manuals: $(MANUALS)
install: all install-programs install-service install-documents ## install programs, library, headers, types, manuals and the services under $(DESTDIR)$(PREFIX)

install-programs: all
	install -d $(DESTDIR)$(PREFIX)/bin $(SHARE)/ale-slam/worlds $(SHARE)/ale-slam/python $(SHARE)/java
	install -m 755 $(PROGRAMS) $(DESTDIR)$(PREFIX)/bin
	$(STRIP) $(patsubst $(BUILD)/bin/%,$(DESTDIR)$(PREFIX)/bin/%,$(filter-out $(PYTHON_PROGRAMS),$(PROGRAMS)))
	cp -P $(OLDER_NAMES) $(DESTDIR)$(PREFIX)/bin
	install -m 644 $(wildcard lib/messages/*.lcm) $(SHARE)/ale-slam
	install -m 644 $(wildcard tools/lab/worlds/*.world) $(SHARE)/ale-slam/worlds
	cd $(BUILD)/python && find . -name '*.py' -exec install -D -m 644 {} $(abspath $(SHARE))/ale-slam/python/{} \;
	install -m 644 $(BUILD)/ale-lcmtypes.jar $(SHARE)/java/ale-lcmtypes-$(VERSION).jar
	ln -sf ale-lcmtypes-$(VERSION).jar $(SHARE)/java/ale-lcmtypes.jar

install-documents: manuals
	install -d $(SHARE)/man/man1 $(SHARE)/man/man8 $(SHARE)/doc/libale-dev/examples $(SHARE)/doc/ale-slam-tools/examples
	install -m 644 $(filter %.1,$(MANUALS)) $(SHARE)/man/man1
	install -m 644 $(filter %.8,$(MANUALS)) $(SHARE)/man/man8
	for page in README.md $$(git ls-files '*.md' firmware/config/scanners.ini | grep -E '^(lib|drivers|firmware|tools)/'); do \
	    install -D -m 644 $$page $(SHARE)/doc/ale-slam/$$page || exit 1; done
	install -m 644 $(wildcard tools/library/examples/*.c tools/library/examples/*.txt tools/library/python/*lines.py) $(SHARE)/doc/libale-dev/examples
	install -m 644 $(filter-out %.md,$(wildcard tools/library/odometry/* tools/library/motors/*)) $(SHARE)/doc/ale-slam-tools/examples

install-service:
	install -d $(DESTDIR)$(PREFIX)/lib/systemd/system
	for unit in ale-slamd ale-console ale-bridge ale-odometry; do sed 's,@PREFIX@,$(PREFIX),; s,@SYSCONFDIR@,$(SYSCONFDIR),' $(DEPLOY)/$$unit.service.in \
	    > $(DESTDIR)$(PREFIX)/lib/systemd/system/$$unit.service || exit 1; done
	install -D -m 644 $(DEPLOY)/60-ale-slam.rules $(DESTDIR)$(PREFIX)/lib/udev/rules.d/60-ale-slam.rules
	install -D -m 644 $(DEPLOY)/60-ale-slam.conf $(DESTDIR)$(PREFIX)/lib/sysctl.d/60-ale-slam.conf
	install -D -m 644 $(DEPLOY)/ale-slam.sysusers $(DESTDIR)$(PREFIX)/lib/sysusers.d/ale-slam.conf
	[ -e $(DESTDIR)$(SYSCONFDIR)/ale-slam/ale-slamd.ini ] || \
	    install -D -m 644 $(DEPLOY)/ale-slamd.ini $(DESTDIR)$(SYSCONFDIR)/ale-slam/ale-slamd.ini

deb: all manuals library ## Debian packages into build/packages: ale-slam, ale-slam-tools, libale0, libale-dev
	@tools/make/deps.sh tools/make/packages-deb.txt
	@rm -rf $(PACKAGES) && mkdir -p $(PACKAGES)
	@umask 022 && $(MAKE) --no-print-directory -s install DESTDIR=$(abspath $(PACKAGES))/laid-out PREFIX=/usr SYSCONFDIR=/etc \
	    LIBDIR=/usr/lib/$$(dpkg-architecture -qDEB_HOST_MULTIARCH) > $(PACKAGES)/install.log
	@tools/make/deb.sh $(PACKAGES)

# Not of Debian's archive: nobody's address is in it, and no bug of Debian's is closed.
NO_MATTER = bogus-mail-host,bogus-mail-host-in-debian-changelog,initial-upload-closes-no-bugs
test-deb: deb ## lintian, and the packages installed into a layer over this machine, looked at, removed and purged (root)
	@lintian --fail-on error,warning --suppress-tags $(NO_MATTER) --allow-root $(PACKAGES)/*.changes
	@$(PYTHON) tools/make/test_deb.py $(PACKAGES) || [ $$? = 77 ]

same-packages: deb ## the packages built again in another folder, at another time, in another language: the same bytes
	@tools/make/same_packages.sh $(PACKAGES) CC="$(CC)" CXX="$(CXX)" CCACHE="$(CCACHE)"
