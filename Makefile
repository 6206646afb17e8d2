# Two commands matter: `make demo` and `make test`. Each sets up, builds and runs.
SHELL := /bin/bash
.DEFAULT_GOAL := help
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
DEMO ?= examples/helix_outer_20.toml
SOURCES = $(shell find src apps python tests bench -name '*.hpp' -o -name '*.cpp')

# Objects that ccache has serve every clone and the package of tools/check_package.sh too.
export CCACHE_BASEDIR ?= $(CURDIR)
export CCACHE_NOHASHDIR ?= 1

# With Python, the module is built too and its tests are run, in an environment of the project's own.
WITH_PYTHON = -DTENDRIL_BUILD_PYTHON=ON -DTENDRIL_PYTHON=$(CURDIR)/build/venv/bin/python

.PHONY: help setup setup-tests python-env build demo test docs verify campaign insertions bench asan format check-format clean

help:            ## this list
	@grep -E '^[a-z-]+: .*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):[^#]*## /\1\t/' | expand -t 14

setup:           ## install missing Debian packages (apt, as root or with sudo)
	@tools/setup.sh

setup-tests:     ## the same with a browser for the tests of the report
	@tools/setup.sh tests

python-env: setup  # build/venv with what the Python tests need, from PyPI
	@tools/python_env.sh

build: setup     ## configure and build the release preset
	@cmake --preset release $(PYTHON_FACE) >/dev/null
	@cmake --build --preset release -j $(JOBS)

demo: build      ## solve the main example: contact table, events and, with Node, a page to look at
	build/release/bin/tendril run $(DEMO) $(if $(shell [ -s build/release/web/report.html ] && echo page),--report build/demo.html)

test: PYTHON_FACE = $(WITH_PYTHON)
test: setup-tests python-env build  ## build and run every test, the fast ones first
	ctest --preset release -j $(JOBS) -L fast
	ctest --preset release -j $(JOBS) -LE fast --no-tests=ignore

docs: PYTHON_FACE = $(WITH_PYTHON)
docs: python-env build  ## the documentation as a site in build/docs; warnings are errors
	PYTHONPATH=build/release/python build/venv/bin/python tools/make_docs.py build/release/bin/tendril build
	@echo "open build/docs/index.html"

verify: build    ## computed against printed numbers, row by row
	build/release/bin/tendril verify

campaign: build  ## a thousand random problems, each solution judged by independent equations
	@cmake --build --preset release -j $(JOBS) --target campaign
	build/release/tests/campaign

insertions: build  ## rods fed into a hundred random tubes, each last state compared with a cold start's
	@cmake --build --preset release -j $(JOBS) --target insertions
	build/release/tests/insertions

bench: setup     ## build and run the benchmarks, then the comparison with SciPy if it is there
	@cmake --preset bench >/dev/null
	@cmake --build --preset bench -j $(JOBS)
	@for b in build/bench/bench/bench_*; do [ ! -x "$$b" ] || "$$b" || exit 1; done
	@if python3 -c 'import scipy' 2>/dev/null; then python3 bench/compare_scipy.py --build build/bench; \
	  else echo "bench: no SciPy for python3, comparison left out"; fi

asan: setup      ## fast tests with the address and undefined-behaviour sanitizers
	@cmake --preset asan >/dev/null
	@cmake --build --preset asan -j $(JOBS)
	ctest --preset asan -j $(JOBS) -L fast

format:          ## format every source in place
	clang-format -i $(SOURCES)

check-format:    ## fail if a source is not formatted
	@clang-format --dry-run -Werror $(SOURCES) && echo "format: $(words $(SOURCES)) files"

clean:           ## remove everything built
	rm -rf build
