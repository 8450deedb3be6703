VENV ?= .venv
PYTHONS ?= python3 python3.13 python3.12 python3.11

BIN := $(VENV)/bin
INSTALL := $(BIN)/pip install --quiet --disable-pip-version-check

ONE_THREAD := OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
# A worker for each core, with one thread; the tests of a file share branches, so they stay together,
# and keep them for other files and later runs of the same engine.
PYTEST := $(ONE_THREAD) $(BIN)/python -m pytest --numprocesses auto --dist loadfile --keep
# What `make test` leaves to targets of its own: a marker each.
KINDS := browser distributed faults mutated drawn grids backends studies gallery
EMPTY :=
ANY_KIND := $(subst $(EMPTY) $(EMPTY), or ,$(KINDS))
# Processor times, medians; the record goes to .benchmarks/.
BENCHMARK := --benchmark-autosave --benchmark-compare --benchmark-timer=time.process_time \
  --benchmark-sort=name --benchmark-columns=median,iqr,rounds

# The rooms of periodic/ whose tests `--in-c` runs in C where there is a compiler: tests/support/rooms.py.
KERNEL_ROOMS := bifurcations collocation condensed correction linear

# Of the mutants: how many, which draw, the commit since which files have changed (all, if empty), and the
# seconds of the processor for the tests of one (those of tests/mutants/run.py, if empty).
COUNT ?= 110
SEED ?= 2029
SINCE ?=
LIMIT ?=

# Of a study: which sections, or those whose engine has changed; all, if empty.
SECTION ?=
STALE ?=

.DEFAULT_GOAL := help
.PHONY: help run test $(KINDS) apart kernels long dependencies survey survey-machines fuzz mutants bench report-paper report-trade report-extremes report-machines report-structures report-proof report-decide report-motions stale docs lint types layers wheel clean
# Two installs into one environment would collide.
.NOTPARALLEL:

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z -]+:.*## / { gsub(" ", ", ", $$1); printf "make %-7s %s\n", $$1, $$2 }' Makefile

run: $(VENV)/.installed ## Trace the example disc through resonance
	$(BIN)/orbitrace trace vitrea79-810N --sweep

test: $(VENV)/.installed-dev ## Run the tests
	$(PYTEST) -rs --in-c -m "not (long or $(ANY_KIND))"

browser distributed faults mutated drawn grids backends studies gallery: $(VENV)/.installed-dev ## Run the tests of a kind
	$(PYTEST) --in-c -m "$@ and not long"

apart: $(VENV)/.installed-dev ## Run the tests of all these kinds, which `make test` leaves out
	$(PYTEST) -rs --in-c -m "($(ANY_KIND)) and not long"

kernels: $(VENV)/.installed-dev ## Run the tests of orbits once more, with kernels in NumPy
	ORBITRACE_KERNELS=numpy $(PYTEST) $(KERNEL_ROOMS:%=tests/periodic/%) -m "not (long or backends)"

long: $(VENV)/.installed-dev ## Run the long studies
	$(PYTEST) -m long

dependencies: $(VENV)/.installed-dev ## Install the lowest versions declared and the newest, and try them
	$(BIN)/python tests/dependencies/run.py

survey: $(VENV)/.installed-dev ## Trace and judge models with contact drawn at random (hours)
	@mkdir -p build
	PYTHONPATH=tests $(ONE_THREAD) $(BIN)/python -m survey build/survey-0.jsonl --share 0/2 & \
	  PYTHONPATH=tests $(ONE_THREAD) $(BIN)/python -m survey build/survey-1.jsonl --share 1/2; wait
	PYTHONPATH=tests $(BIN)/python -m survey build/survey-*.jsonl --page tests/survey/README.md

survey-machines: $(VENV)/.installed-dev ## Trace and judge machines drawn at random from catalogues (hours)
	@mkdir -p build
	PYTHONPATH=tests $(ONE_THREAD) $(BIN)/python -m survey.machines build/machines-0.jsonl --share 0/2 & \
	  PYTHONPATH=tests $(ONE_THREAD) $(BIN)/python -m survey.machines build/machines-1.jsonl --share 1/2; wait
	PYTHONPATH=tests $(BIN)/python -m survey.machines build/machines-*.jsonl --page tests/survey/machines/README.md

fuzz: $(VENV)/.installed-dev ## Read spoilt files of every kind (COUNT of each, by default 10000)
	PYTHONPATH=tests $(ONE_THREAD) $(BIN)/python -m fuzz --count $(if $(filter file,$(origin COUNT)),10000,$(COUNT))

mutants: $(VENV)/.installed-mutants ## Change the code at random, see that tests notice (COUNT, SEED, SINCE, LIMIT)
	$(ONE_THREAD) $(BIN)/python tests/mutants/run.py --count $(COUNT) --seed $(SEED) \
	  $(if $(LIMIT),--limit $(LIMIT)) $(if $(SINCE),--since $(SINCE),--page tests/mutants/README.md)

bench: $(VENV)/.installed-dev ## Run the benchmarks, compare with the last record
	$(ONE_THREAD) $(BIN)/python -m pytest reports/benchmarks -q -rs -W default::pytest.PytestWarning $(BENCHMARK)

report-paper report-trade report-extremes report-machines report-structures report-proof report-decide report-motions: $(VENV)/.installed-dev ## Compute the page of a study anew (SECTION="NAME ...", STALE=1)
	$(BIN)/python -m reports.studies.$(@:report-%=%) $(if $(SECTION),--only $(SECTION)) $(if $(STALE),--stale)

stale: $(VENV)/.installed-dev ## List sections of pages whose engine has changed since
	@$(BIN)/python -m reports.studies.stale

docs: $(VENV)/.installed-docs ## Build the site into docs/_build
	$(ONE_THREAD) $(BIN)/python -m sphinx -W --keep-going -q -b html docs docs/_build

lint: $(VENV)/.installed-dev ## Check style and formatting
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .

types: $(VENV)/.installed-dev ## Check the type hints
	$(BIN)/mypy

layers: $(VENV)/.installed-dev ## Check which packages and rooms import which
	$(BIN)/lint-imports --no-logo

wheel: $(VENV)/.installed-dev ## Build the wheel and the sdist into dist/
	$(BIN)/python -m build --outdir dist .
	@du -h --apparent-size dist/*

# Only the default environment: a VENV from outside may hold more than this project.
clean: ## Remove the environment, caches and builds
	rm -rf .venv build dist docs/_build docs/gallery docs/reference/generated .pytest_cache .mypy_cache .ruff_cache .import_linter_cache
	find symbolic periodic reports tests -name __pycache__ -prune -exec rm -rf {} +

$(VENV)/.installed: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable .
	@touch $@

$(VENV)/.installed-dev: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace and its development tools into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable '.[dev]'
	@touch $(VENV)/.installed $@

$(VENV)/.installed-mutants: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace and what makes mutants of it into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable '.[dev,mutants]'
	@touch $(VENV)/.installed $(VENV)/.installed-dev $@

$(VENV)/.installed-docs: pyproject.toml | $(BIN)/pip
	@echo "Installing orbitrace and what builds its site into $(VENV) (a minute or two, once)"
	@$(INSTALL) --editable '.[docs]'
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
