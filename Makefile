# Two commands do everything on a fresh machine: `make demo` and `make test`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test check generate bench fuzz fuzz-atheris clean

demo: $(STAMP)
	$(BIN)/colladaphy demo

test: $(STAMP)
	$(BIN)/python -m pytest -n auto --dist worksteal

check: $(STAMP)
	$(BIN)/python -m tools.bindings --check
	$(BIN)/python -m tools.rules_page --check
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

generate: $(STAMP)
	$(BIN)/python -m tools.bindings
	$(BIN)/python -m tools.rules_page

bench: $(STAMP)
	$(BIN)/python -m tools.bench

# Nightly: 100,000 examples of every property; FUZZ="--minutes 60 --processes 8" sets other bounds.
fuzz: $(STAMP)
	$(BIN)/python -m tools.fuzz $(FUZZ)

# Coverage-guided, for ten minutes; ATHERIS="--minutes 60" for longer. Installs atheris for itself.
fuzz-atheris: $(STAMP)
	$(BIN)/python -m tools.fuzz.guided $(ATHERIS)

$(STAMP): pyproject.toml
	$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed: make PYTHON=python3.12 ..." if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade "pip>=25.1"
	$(BIN)/python -m pip install --quiet --editable . --group dev
	@touch $@

clean:
	rm -rf $(VENV) build dist
