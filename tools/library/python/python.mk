# Python's package in place, for tests: what a wheel has as one library, built by the same CMakeLists.txt, the mapper taken from
# the archive. PYTHONPATH=tools/library/python/src ALE_CORE=build/python-package.
PYTHON_CORE = $(BUILD)/python-package/ale_core.so
PYTHON_CORE_SOURCES = $(wildcard $(addprefix tools/library/python/,CMakeLists.txt binding/*) tools/common/offline/* lib/*/*.h lib/*/*/*.h)

.PHONY: python-package wheel
python-package: $(PYTHON_CORE)
$(PYTHON_CORE): $(BUILD)/libale_graph.a $(LIB_SOURCES) $(PYTHON_CORE_SOURCES)
	$(call say,cmake,$@)
	$(Q)cmake -S tools/library/python -B $(@D) -DCMAKE_BUILD_TYPE=Debug -DCMAKE_C_FLAGS_DEBUG=-O1 -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
	    -DCMAKE_C_COMPILER="$(lastword $(CC))" -DCMAKE_CXX_COMPILER="$(lastword $(CXX))" -DALE_MAPPER_ARCHIVE=$(abspath $<) > $(@D).log 2>&1 && \
	    cmake --build $(@D) -j 2 >> $(@D).log 2>&1 || { tail -n 20 $(@D).log >&2; exit 1; }
	$(Q)touch $@

wheel: deps ## a wheel of Python's package, and an sdist, into build/wheel (needs pip and PyPI)
	$(Q)$(PYTHON) -m venv $(BUILD)/wheel-venv
	$(Q)$(BUILD)/wheel-venv/bin/pip install -q --disable-pip-version-check build
	$(Q)$(BUILD)/wheel-venv/bin/python -m build --outdir $(BUILD)/wheel tools/library/python > $(BUILD)/wheel.log 2>&1 || { tail -n 20 $(BUILD)/wheel.log >&2; exit 1; }
	$(Q)ls $(BUILD)/wheel
