# Everything a person does with this repository, by name. `make help` lists it.
# Needs Python >= 3.11 with venv, Rust with cargo, and make; all else is installed into .venv.

VENV := .venv
PYTHON ?= python3
BENCH ?= # options of benchmarks/run.py, as in BENCH="--contact rigid"
PY := $(VENV)/bin/python
MODELS := $(wildcard examples/*/*.padl) $(filter-out %/expected.toml,$(wildcard examples/*/*.toml))
export PYO3_PYTHON := $(CURDIR)/$(VENV)/bin/python
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.DEFAULT_GOAL := help
.PHONY: help build test check demo bench docs pictures format clean

help: ## list what can be made
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

$(VENV)/ready: requirements-dev.txt
	$(PYTHON) -c 'import sys; sys.exit("Python 3.11 or newer is needed") if sys.version_info < (3, 11) else None'
	$(PYTHON) -m venv $(VENV)
	$(PY) -m pip install --quiet --requirement requirements-dev.txt
	touch $@

build: $(VENV)/ready ## build the core and leave .venv/bin/mainspring
	$(VENV)/bin/maturin develop --release --locked --quiet
	@echo "built: $(VENV)/bin/mainspring"

test: build ## all tests, Rust and Python
	cargo test --workspace --locked --quiet
	$(PY) -m pytest -q tests

check: build ## format, lint, types, layers, links
	cargo fmt --all --check
	cargo clippy --workspace --all-targets --locked --quiet -- -D warnings
	$(VENV)/bin/ruff format --check python tests scripts benchmarks
	$(VENV)/bin/ruff check python tests scripts benchmarks
	$(VENV)/bin/mypy
	$(PY) -m mypy.stubtest mainspring._core --ignore-disjoint-bases
	$(VENV)/bin/lint-imports --no-cache
	$(PY) scripts/check_layers.py
	$(PY) scripts/check_docs.py

demo: build ## the escapement, from its shapes to what it will do; writes mainspring-demo/report.html
	$(VENV)/bin/mainspring demo

benchmarks/$(VENV)/ready: benchmarks/requirements.txt
	$(PYTHON) -m venv benchmarks/$(VENV)
	benchmarks/$(VENV)/bin/python -m pip install --quiet --requirement benchmarks/requirements.txt
	touch $@

bench: build benchmarks/$(VENV)/ready ## measure time, error and memory on one thread beside MuJoCo and pymunk; takes minutes
	benchmarks/$(VENV)/bin/python benchmarks/run.py $(BENCH)
	cargo run --release --quiet -p mainspring --example sources $(MODELS)
	cargo run --release --quiet -p mainspring --example maps $(MODELS)
	cargo run --release --quiet -p mainspring-cspace --example growth | benchmarks/$(VENV)/bin/python benchmarks/growth.py

docs: build ## check the documentation: links, keys, pages without a way to them
	$(PY) scripts/check_docs.py

pictures: build ## draw the pictures of README and documentation anew
	$(PY) scripts/make_pictures.py

format: $(VENV)/ready ## put all code in shape
	cargo fmt --all
	$(VENV)/bin/ruff format python tests scripts benchmarks
	$(VENV)/bin/ruff check --fix python tests scripts benchmarks

clean: ## remove what was built
	rm -rf $(VENV) target mainspring-demo python/mainspring/*.so
