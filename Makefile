VENV ?= .venv
PYTHONS ?= python3 python3.13 python3.12 python3.11

BIN := $(VENV)/bin
INSTALL := $(BIN)/pip install --quiet --disable-pip-version-check

.DEFAULT_GOAL := help
.PHONY: help run test long bench lint types wheel clean
# Two installs into one environment would collide.
.NOTPARALLEL:

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z]+:.*## / { printf "make %-6s %s\n", $$1, $$2 }' Makefile

run: $(VENV)/.installed ## Trace the example disc through resonance
	$(BIN)/orbitrace trace vitrea79-810N --sweep

test: $(VENV)/.installed-dev ## Run the tests
	$(BIN)/python -m pytest

long: $(VENV)/.installed-dev ## Run the long studies
	$(BIN)/python -m pytest -m long

bench: $(VENV)/.installed ## Run the benchmarks, compare with the last record
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m reports.bench

lint: $(VENV)/.installed-dev ## Check style and formatting
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.installed-dev ## Check the type hints
	$(BIN)/mypy

wheel: $(VENV)/.installed ## Build the wheel into dist/
	$(BIN)/pip wheel --quiet --disable-pip-version-check --no-deps --wheel-dir dist .

# Only the default environment: a VENV from outside may hold more than this project.
clean: ## Remove the environment, caches and builds
	rm -rf .venv build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find symbolic periodic reports tests -name __pycache__ -prune -exec rm -rf {} +

$(VENV)/.installed: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace and its development tools into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable '.[dev]'
	@touch $(VENV)/.installed $@

# Each candidate is run, not just looked up: a version manager's shim may be on PATH with nothing behind it.
$(BIN)/pip:
	@for python in $(PYTHONS); do \
	  if $$python -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then \
	    exec $$python -m venv $(VENV); \
	  fi; \
	done; \
	echo "orbitrace needs Python 3.11 or newer with its venv module; none of these is one: $(PYTHONS)." >&2; \
	exit 1
