# Everything sets itself up in .venv; only Python 3.11-3.13 and access to PyPI are needed.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: demo test check slow clean

demo: $(VENV)/ready  ## bend the hexagonal-prism actuator to 80 kPa, report in runs/demo
	rm -rf runs/demo
	$(BIN)/pneumorph reproduce hexagonal-prism --part bending --quick --out runs/demo

test: $(VENV)/ready  ## the default tests, a process a core
	PNEUMORPH_THREADS=1 $(BIN)/python -m pytest -m "not slow" -n auto --maxprocesses 8 --dist loadfile

check: $(VENV)/ready  ## lint, format and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

slow: $(VENV)/ready  ## the tests that take minutes
	$(BIN)/python -m pytest -m slow

clean:
	rm -rf $(VENV) runs build dist

$(VENV)/ready: pyproject.toml
	$(PYTHON) -c "import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))" || (echo "pneumorph needs Python 3.11, 3.12 or 3.13: make PYTHON=python3.12"; false)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --upgrade pip
	$(BIN)/python -m pip install --quiet -e ".[dev,test]"
	touch $@
