# libale for those who link it alone: a shared library (for ctypes), its headers, a pkg-config file. ale.h is the extractor,
# track/pipeline.h the tracker; what they include is installed with them.
SHARED_LIBRARY = $(BUILD)/libale.so
$(SHARED_LIBRARY): $(LIB_SOURCES) $(wildcard lib/*.h lib/*/*.h lib/*/*/*.h)
	$(call say,link,$@)
	@mkdir -p $(@D)
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE $(OPT) -fPIC -shared -Ilib $(LIB_SOURCES) -o $@

PUBLIC_HEADERS = lib/ale.h $(wildcard lib/base/*.h) $(addprefix lib/track/,pipeline.h keyframe.h correction.h scan_observation.h)
INCLUDE = $(DESTDIR)$(PREFIX)/include/ale

.PHONY: library install-library
library: $(BUILD)/libale.a $(SHARED_LIBRARY) ## libale alone, static and shared
install: install-library
install-library: library
	install -d $(DESTDIR)$(PREFIX)/lib/pkgconfig
	install -m 644 $(BUILD)/libale.a $(DESTDIR)$(PREFIX)/lib
	install -m 755 $(SHARED_LIBRARY) $(DESTDIR)$(PREFIX)/lib
	for h in $$($(CC) -std=c11 -Ilib -MM $(PUBLIC_HEADERS) | tr ' ' '\n' | grep '^lib/' | sort -u); do \
	    install -D -m 644 $$h $(INCLUDE)/$${h#lib/} || exit 1; done
	echo '#include "motion/odometry_sample.h" /* its name until 0.1 */' > $(INCLUDE)/track/odometry_sample.h
	sed 's|@PREFIX@|$(PREFIX)|; s|@VERSION@|$(VERSION)|' tools/make/libale.pc.in > $(DESTDIR)$(PREFIX)/lib/pkgconfig/libale.pc
