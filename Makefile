# `make` builds everything, `make test` tests it, `make test-workflow` runs and kills the workflow itself, `make archive`
# writes one file of it all, `make pdf` prints the book.
# Each sets up .venv first if needed.

export PYTHON ?= python3
export VENV := .venv
BIN := $(VENV)/bin

# Snakemake and Matplotlib keep files in the home; where there is none to write to, they keep them here.
ifeq ($(shell test -w "$$HOME" && echo home),)
export XDG_CACHE_HOME ?= $(CURDIR)/.snakemake/cache
export MPLCONFIGDIR ?= $(CURDIR)/.snakemake/cache/matplotlib
endif

.DEFAULT_GOAL := all
.PHONY: all archive pdf test test-workflow environment

all: environment
	@$(BIN)/snakemake all

archive: all
	@$(BIN)/cosserat archive

pdf: environment
	@$(BIN)/snakemake results/cosserat.pdf

# Two test processes, each with one thread for linear algebra.  Python keeps what it compiles, also where the environment
# says otherwise: some thirty tests start processes of their own, each of which would compile the package again.
test test-workflow: export OMP_NUM_THREADS = 1
test test-workflow: export PYTHONDONTWRITEBYTECODE =

test: environment
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	@$(BIN)/mypy & types=$$!; $(BIN)/pytest -m "not workflow" --numprocesses=2 --dist=worksteal; tests=$$?; \
	  wait $$types || { echo "mypy found errors, above" >&2; exit 1; }; exit $$tests

test-workflow: environment
	$(BIN)/pytest -m workflow

environment:
	@.ci/environment
