# No run-time error, for whatever comes in: Frama-C over the core's arithmetic, what the URG says of itself, and commands.
PROVE_JOBS ?= 2
.PHONY: prove
prove: ## no run-time error whatever comes in: proved by Frama-C, and planted faults that the proof must find
	@tools/make/deps.sh tools/make/packages-prove.txt
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) -m pytest -q -p no:cacheprovider tests/proofs/eva/planted_faults.py
	@PYTHONDONTWRITEBYTECODE=1 $(PYTHON) tests/proofs/eva/prove.py --build $(BUILD) --jobs $(PROVE_JOBS)
