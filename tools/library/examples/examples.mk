# libale for those who link it alone: a shared library (for ctypes), its headers, a pkg-config file. ale.h is the extractor,
# track/pipeline.h the tracker, map/tile_change.h what it takes of a map of tiles; what they include is installed with them.
#
# The shared library shows what the installed headers declare, and nothing else; firmware/deploy/debian/libale0.symbols lists it.
# SOVERSION changes with what makes programs that are linked already fail.
SOVERSION = 0
SHARED_LIBRARY = $(BUILD)/libale.so
SONAME = libale.so.$(SOVERSION)
PUBLIC_HEADERS = lib/ale.h $(wildcard lib/base/*.h) $(addprefix lib/track/,pipeline.h keyframe.h correction.h scan_observation.h) lib/map/tile_change.h
installed_headers = $$($(CC) -std=c11 -Ilib -MM $(PUBLIC_HEADERS) | tr ' ' '\n' | grep '^lib/' | LC_ALL=C sort -u)

$(BUILD)/libale.map: $(wildcard lib/*.h lib/*/*.h lib/*/*/*.h) $(FLAGS_STAMP) tools/library/examples/examples.mk
	@mkdir -p $(@D)
	$(Q){ echo '{ global:'; cat $(installed_headers) | grep -oE '\bale_[a-z0-9_]+\(' | LC_ALL=C sort -u | tr '(' ';'; \
	    echo 'local: *; };'; } > $@
# Its warnings are those of the archive, whose sources these are.
$(SHARED_LIBRARY): $(LIB_SOURCES) $(BUILD)/libale.map
	$(call say,link,$@)
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE $(OPT) -w -fPIC -shared -Ilib -Wl,-soname,$(SONAME),--version-script=$(BUILD)/libale.map,-z,now,--build-id=none \
	    $(LIB_SOURCES) $(LDFLAGS) -o $@
	$(Q)ln -sf $(@F) $(BUILD)/$(SONAME)

INCLUDE = $(DESTDIR)$(PREFIX)/include/ale
LIBDIR ?= $(PREFIX)/lib

.PHONY: library install-library
library: $(BUILD)/libale.a $(SHARED_LIBRARY) ## libale alone, static and shared
install: install-library
install-library: library
	install -d $(DESTDIR)$(LIBDIR)/pkgconfig
	install -m 644 $(BUILD)/libale.a $(DESTDIR)$(LIBDIR)
	install -m 644 $(SHARED_LIBRARY) $(DESTDIR)$(LIBDIR)/libale.so.$(VERSION)
	ln -sf libale.so.$(VERSION) $(DESTDIR)$(LIBDIR)/$(SONAME)
	ln -sf $(SONAME) $(DESTDIR)$(LIBDIR)/libale.so
	for h in $(installed_headers); do install -D -m 644 $$h $(INCLUDE)/$${h#lib/} || exit 1; done
	echo '#include "motion/odometry_sample.h" /* its name until 0.1 */' > $(INCLUDE)/track/odometry_sample.h
	sed 's|@PREFIX@|$(PREFIX)|; s|@LIBDIR@|$(LIBDIR)|; s|@VERSION@|$(VERSION)|' tools/make/libale.pc.in \
	    > $(DESTDIR)$(LIBDIR)/pkgconfig/libale.pc
