# No run-time error, for whatever comes in: Frama-C over the core's arithmetic, the scanners' protocols, and commands.
PROVE_JOBS ?= 2
PROVE = PYTHONDONTWRITEBYTECODE=1 $(PYTHON) tests/proofs/eva/prove.py --build $(BUILD) --jobs $(PROVE_JOBS)
# The share of `make test-all`: the arithmetic, what of the extraction is proved, and what comes over the line from a scanner.
PROVE_SHARE = base_ wp_ extract_ ldrobot rplidar rotary scip_parse
.PHONY: prove prove-share
prove: ## no run-time error whatever comes in: proved by Frama-C, and planted faults that the proof must find
	@tools/make/deps.sh tools/make/packages-prove.txt
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) -m pytest -q -p no:cacheprovider -n $(PROVE_JOBS) tests/proofs/eva/planted_faults.py
	@$(PROVE)
prove-share:
	@tools/make/deps.sh tools/make/packages-prove.txt
	@$(PROVE) --only $(PROVE_SHARE)
