# Everything this project does, from a fresh machine on: the first target that needs it installs it into .venv.

STUDY ?= quick
RUNS ?= runs
WORKERS ?=
THREADS ?=
OPTIONS ?=
BASE ?= HEAD
PYTHON ?= $(shell for candidate in python3 python3.13 python3.12 python3.11; do \
	$$candidate -c 'import sys, venv, ensurepip; sys.exit(not (3, 11) <= sys.version_info[:2] <= (3, 13))' \
	2>/dev/null && echo $$candidate && break; done)

VENV := .venv
RUN := $(VENV)/bin/python -m
INSTALLED := $(VENV)/installed
RESOURCES = $(if $(WORKERS),--workers $(WORKERS)) $(if $(THREADS),--threads-per-job $(THREADS)) $(OPTIONS)
# what is done is drawn, also when a job failed; the exit code is the campaign's, or else tells of damaged results
THEN = ; code=$$?; [ $$code -gt 1 ] || $(1); drawn=$$?; [ $$code -ne 0 ] || code=$$drawn; exit $$code
THEN_PLOT = $(call THEN,$(MAKE) --no-print-directory plots)

.DEFAULT_GOAL := help
.PHONY: help install campaign resume plan status plots accuracy comparison stability test test-slow bench bench-compare bench-gpu bench-gravity lint clean

help: ## explain all targets
	@echo 'make TARGET [STUDY=quick] [RUNS=runs] [WORKERS=n] [THREADS=n] [OPTIONS=...]'
	@echo
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  %-13s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)
	@echo
	@echo '  STUDY    a shipped study ($(basename $(notdir $(wildcard campaigns/studies/*.toml)))) or a path to a study file'
	@echo '  RUNS     directory that holds the results of all studies'
	@echo '  WORKERS  jobs at the same time; THREADS: CPU threads of one job'
	@echo '  OPTIONS  further options, as --retry-failed, --scheduler ADDRESS or --slurm'

install: $(INSTALLED) ## make .venv and install everything into it

campaign: $(INSTALLED) ## run all unfinished jobs of STUDY, collect the results and plot them
	@$(RUN) campaigns run '$(STUDY)' --runs '$(RUNS)' $(RESOURCES) $(THEN_PLOT)

resume: $(INSTALLED) ## go on with a STUDY that was stopped, and plot its results
	@$(RUN) campaigns resume '$(STUDY)' --runs '$(RUNS)' $(RESOURCES) $(THEN_PLOT)

plan: $(INSTALLED) ## show what a run of STUDY would do with every job, and why
	@$(RUN) campaigns plan '$(STUDY)' --runs '$(RUNS)'

status: $(INSTALLED) ## show how every job of STUDY stands
	@$(RUN) campaigns status '$(STUDY)' --runs '$(RUNS)'

plots: $(INSTALLED) ## print the table of shapes of STUDY and draw its figures
	@directory=$$($(RUN) campaigns where '$(STUDY)' --runs '$(RUNS)') && $(RUN) analysis plots "$$directory"

accuracy: $(INSTALLED) ## vary every numerical setting of scenes and of a collision: error against computing time
	@$(RUN) engine accuracy '$(RUNS)/verification' $(if $(WORKERS),--workers $(WORKERS))
	@$(RUN) campaigns run accuracy --runs '$(RUNS)' $(RESOURCES) $(call THEN,$(RUN) analysis accuracy '$(RUNS)/accuracy')

comparison: $(INSTALLED) ## collisions that other methods have computed, by law of friction, beside what they find
	@$(RUN) campaigns run comparison --runs '$(RUNS)' $(RESOURCES) \
		$(call THEN,$(RUN) analysis comparison '$(RUNS)/comparison')

stability: $(INSTALLED) ## run stiff and extreme cases; each is stable, or stopped with a reason
	@$(RUN) engine stability '$(RUNS)/stability' $(if $(WORKERS),--workers $(WORKERS))

test: $(INSTALLED) ## run the fast tests, a file at a time on every core
	$(RUN) pytest -n logical --maxprocesses 8 --dist loadfile -rs

test-slow: $(INSTALLED) ## run the tests that take minutes
	$(RUN) pytest -m slow

bench: $(INSTALLED) ## time the engine and compare it with the usual way and the machine's limits
	@$(RUN) tests.benchmarks --out '$(RUNS)/bench.json'

bench-compare: $(INSTALLED) ## time the steps of another commit and of this code in turns: BASE=commit
	@$(RUN) tests.benchmarks.compare '$(BASE)' $(OPTIONS)

bench-gpu: $(INSTALLED) ## time steps and cases on a GPU, repeat and verify them: OPTIONS="--arch cuda"
	@$(RUN) tests.benchmarks.gpu --out '$(RUNS)/bench-gpu' $(OPTIONS)

bench-gravity: $(INSTALLED) ## compare gravity with pytreegrav and rebound, which it installs; half an hour
	@$(RUN) pip install --quiet --disable-pip-version-check --editable '.[dev,bench]'
	@$(RUN) tests.benchmarks.gravity --out '$(RUNS)/bench-gravity'

lint: $(INSTALLED) ## check style and types
	$(RUN) ruff check .
	$(RUN) ruff format --check .
	$(RUN) mypy

clean: ## remove .venv and caches; results stay
	rm -rf $(VENV) build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
	find engine campaigns analysis tests -name __pycache__ -prune -exec rm -rf {} +

$(INSTALLED): pyproject.toml
	@test -n '$(PYTHON)' || { echo 'no Python 3.11, 3.12 or 3.13 with venv found;' \
		'install one, or name it: make PYTHON=/path/to/python3.12' >&2; exit 1; }
	@$(RUN) pip --version >/dev/null 2>&1 || { echo 'making $(VENV)'; $(PYTHON) -m venv --clear $(VENV); }
	@echo 'installing into $(VENV)'
	@$(RUN) pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@
