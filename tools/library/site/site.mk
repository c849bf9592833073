# The site: pages of tools/library/site and those written from the sources, by mkdocs-material.
SITE = $(BUILD)/site

.PHONY: docs
docs: deps ## the site: first hours, messages, options, the story, troubleshooting; into build/site/html
	@tools/make/deps.sh tools/make/packages-docs.txt
	@$(MAKE) --no-print-directory -s -j$$(nproc) programs
	@$(PYTHON) tools/library/site/generate.py --build $(BUILD) --out $(SITE)
	@mkdocs build --quiet --strict --config-file $(SITE)/mkdocs.yml --site-dir $(abspath $(SITE))/html
	@echo "$(SITE)/html/index.html"
