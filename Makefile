# The front door. `make` alone lists what there is; every target sets up the environment it needs.

JOBS          ?= 2
ARGS          ?=
SMOKE_RESULTS ?= results-smoke
SITE          ?= site

# requirements.lock is resolved for this version of Python.
PYTHON_VERSION := 3.11
VERSION_OF      = $(shell $(1) -c 'import sys; print("%d.%d" % sys.version_info[:2])' 2>/dev/null)
PYTHON         ?= $(or $(firstword $(foreach p,python$(PYTHON_VERSION) python3 python,\
                    $(if $(filter $(PYTHON_VERSION),$(call VERSION_OF,$(p))),$(p)))),python3)

VENV      := .venv
BIN       := $(VENV)/bin
LOCKED    := $(VENV)/.locked
INSTALLED := $(VENV)/.installed
PIP       := $(BIN)/python -m pip --disable-pip-version-check

# The workflow starts Python some hundred times, the tests as often: what is not kept is compiled each time.
unexport PYTHONDONTWRITEBYTECODE

# Shell commands of the workflow find the environment's programs first.
SNAKEMAKE = PATH="$(abspath $(BIN)):$$PATH" $(BIN)/snakemake -j$(JOBS)
# One thread each: the tests already run in $(JOBS) processes, each module of tests in one of them.
PYTEST    = OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 \
            $(BIN)/python -m pytest -n $(JOBS) --dist loadscope --no-loadscope-reorder

SHELL         := bash
.SHELLFLAGS   := -eu -o pipefail -c
.DEFAULT_GOAL := help
.PHONY: help setup study test thorough smoke bench verify browser coverage test-slurm mutants lint report lock clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-11s %s\n", $$1, $$2 }' $(firstword $(MAKEFILE_LIST))
	@echo '  JOBS=$(JOBS) parallel jobs, ARGS="..." more arguments for test, study, smoke and bench'

setup: $(INSTALLED) ## make .venv from requirements.lock, again only when the lock or pyproject.toml changed

study: $(INSTALLED) ## run the whole study: runs, tables, figures, report
	$(SNAKEMAKE) $(ARGS)

test: $(INSTALLED) ## run the tests
	$(PYTEST) $(ARGS)

thorough: $(INSTALLED) ## run the tests with whole sweeps and twenty times as many examples
	$(PYTEST) --hypothesis-profile=thorough $(ARGS)

smoke: $(INSTALLED) ## run the same study on tiny grids, into results-smoke
	$(SNAKEMAKE) --configfile config/smoke.yaml --config results_dir=$(SMOKE_RESULTS) report_dir=$(SMOKE_RESULTS)/report site_dir=$(SMOKE_RESULTS)/site $(ARGS)

bench: $(INSTALLED) ## time the schemes; wants the machine to itself
	$(SNAKEMAKE) bench $(ARGS)

report: $(INSTALLED) ## build the report, and the site of it
	$(SNAKEMAKE) site

verify: $(INSTALLED) ## recompute a sample of the tracked results and compare; ARGS="--seed 1 --scenes 20"
	PATH="$(abspath $(BIN)):$$PATH" $(BIN)/python -m fracstudy.verify $(ARGS)

browser: $(INSTALLED) ## look at every page of the site in headless Chromium; SITE=site
	$(BIN)/python tools/browser.py $(SITE)

coverage: $(INSTALLED) ## run the tests, and report which lines of the packages they run
	$(PYTEST) --cov=fracparticles --cov=fracstudy --cov-report=term:skip-covered --cov-report=html:htmlcov $(ARGS)

test-slurm: $(INSTALLED) ## the smoke workflow through a Slurm of this machine (root, Debian), compared with a local run
	tools/slurm.sh $(ARGS)

mutants: $(INSTALLED) ## change the code in small ways and see whether a test fails; some 30 minutes
	$(BIN)/python tools/mutants.py --jobs $(JOBS) $(ARGS)

lint: $(INSTALLED) ## check style, types and layers
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/mypy
	$(BIN)/lint-imports

# Not part of the environment: the compiler of the lock lives in an environment of its own.
lock: ## resolve requirements.lock anew from pyproject.toml
	$(PYTHON) -m venv --clear .venv-lock
	.venv-lock/bin/python -m pip install --quiet --upgrade pip pip-tools
	CUSTOM_COMPILE_COMMAND='make lock' .venv-lock/bin/pip-compile --quiet --upgrade \
	    --extra study --extra dev --build-deps-for editable --allow-unsafe \
	    --generate-hashes --strip-extras \
	    --no-emit-index-url --no-emit-trusted-host --no-emit-find-links \
	    --output-file requirements.lock pyproject.toml
	rm -rf .venv-lock

clean: ## remove the environment, the caches and the smoke results; results/ stays
	rm -rf $(VENV) .venv-lock $(SMOKE_RESULTS) .hypothesis .mypy_cache .pytest_cache .ruff_cache
	rm -rf build dist src/*.egg-info
	find . -type d -name __pycache__ -prune -exec rm -rf {} +

# The environment is made anew, so that it holds what the lock names and nothing else. What the lock has at its end
# goes in first: pip, which installs the rest, and setuptools, which builds, without fetching anything unpinned, what
# comes as source only, and the package. Most modules are never imported: those that are get compiled then.
$(LOCKED): requirements.lock
	@found="$(call VERSION_OF,$(PYTHON))"; [ "$$found" = "$(PYTHON_VERSION)" ] || { \
	    echo "setup needs Python $(PYTHON_VERSION); $(PYTHON) is $${found:-not there}:" \
	         "make setup PYTHON=/path/to/python$(PYTHON_VERSION)" >&2; exit 1; }
	$(PYTHON) -m venv --clear $(VENV)
	sed -n '/^# The following packages/,$$p' requirements.lock > $(VENV)/first.lock
	$(PIP) install --quiet --require-hashes -r $(VENV)/first.lock
	$(PIP) install --quiet --no-compile --require-hashes --no-build-isolation --use-pep517 -r requirements.lock
	@touch $@

$(INSTALLED): $(LOCKED) pyproject.toml
	@rm -f $@
	$(PIP) install --quiet --no-deps --no-build-isolation -e .
	$(PIP) check
	@touch $@
