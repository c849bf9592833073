# libale for those who link it alone: a shared library (for ctypes), one header, a pkg-config file.
SHARED_LIBRARY = $(BUILD)/libale.so
$(SHARED_LIBRARY): $(LIB_SOURCES) $(wildcard lib/*.h lib/*/*.h lib/*/*/*.h)
	$(call say,link,$@)
	@mkdir -p $(@D)
	$(Q)$(CC) -std=c11 -D_GNU_SOURCE $(OPT) -fPIC -shared -Ilib $(LIB_SOURCES) -o $@

.PHONY: library install-library
library: $(BUILD)/libale.a $(SHARED_LIBRARY) ## libale alone, static and shared
install: install-library
install-library: library
	install -d $(DESTDIR)$(PREFIX)/lib/pkgconfig
	install -m 644 $(BUILD)/libale.a $(DESTDIR)$(PREFIX)/lib
	install -m 755 $(SHARED_LIBRARY) $(DESTDIR)$(PREFIX)/lib
	for h in ale.h $(patsubst lib/%,%,$(wildcard lib/base/*.h)) extract/extract.h; do \
	    install -D -m 644 lib/$$h $(DESTDIR)$(PREFIX)/include/ale/$$h || exit 1; done
	sed 's|@PREFIX@|$(PREFIX)|; s|@VERSION@|$(VERSION)|' tools/make/libale.pc.in > $(DESTDIR)$(PREFIX)/lib/pkgconfig/libale.pc
