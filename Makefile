# ALE-SLAM. `make help` lists the targets.
#
# Sources are found by their folder; a new file needs no line here (tools/make/rules.mk says how).

BUILD ?= build
CC = gcc
CXX = g++
AR = ar
PYTHON = /usr/bin/python3
OPT ?= -O2
SANITIZE ?=
WARNINGS = -Wall -Wextra -Wconversion -Wshadow -Werror
V ?= 0

.DEFAULT_GOAL = all
include tools/make/rules.mk
include tools/make/cross.mk
include tools/make/tests.mk
include tools/make/toolchains.mk
include tools/make/deploy.mk
-include $(wildcard tools/*/*/*.mk)

.PHONY: help deps deps-test all run explore clean
help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | sort | expand -t 14

all: programs lcm-types ## build everything into build/ (programs in build/bin/)

deps: ## install what the build needs (Debian packages); silent when nothing is missing
	@tools/make/deps.sh tools/make/packages-build.txt

deps-test: deps
	@tools/make/deps.sh tools/make/packages-test.txt

run: deps ## the whole chain: simulator, firmware, console; LOG=path plays a recording, SPEED=x faster
	@$(MAKE) --no-print-directory -s -j$$(nproc) programs
	@$(PYTHON) tools/make/run.py --build $(BUILD) $(if $(LOG),--log $(LOG)) $(if $(SPEED),--speed $(SPEED))

explore: deps ## the robot explores the arena by itself, console open; WORLD=path another world, SPEED=x faster
	@$(MAKE) --no-print-directory -s -j$$(nproc) programs
	@$(PYTHON) tools/make/explore.py --build $(BUILD) $(if $(WORLD),--world $(WORLD)) $(if $(SPEED),--speed $(SPEED))

clean: ## remove build/
	rm -rf $(BUILD)
