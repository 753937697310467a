# `make` builds everything, `make test` tests it; both set up .venv first if needed.

export PYTHON ?= python3
export VENV := .venv
BIN := $(VENV)/bin

.DEFAULT_GOAL := all
.PHONY: all test environment

all: environment
	@$(BIN)/snakemake all

test: environment
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	@$(BIN)/mypy & types=$$!; $(BIN)/pytest --cov --cov-report=term --numprocesses=2 --dist=loadfile; tests=$$?; \
	  wait $$types || { echo "mypy found errors, above" >&2; exit 1; }; exit $$tests

environment:
	@.ci/environment
