PYTHON ?= python3.11
VENV   ?= .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check
LINKED := pyproject.toml constraints.txt

.PHONY: demo test test-full cluster-test mutants readers real check format bench soak faults site site-test docs clean
WEB := factory/report/site/web

demo: $(VENV)/.ready                ## the main job on the example meshes
	$(BIN)/factory build --input examples/meshes examples/generated examples/stated --sim sapien --output out/

test: $(VENV)/.ready-dev            ## every test, two files at a time
	$(BIN)/python -m pytest -n 2 --dist loadfile --no-loadscope-reorder

test-full: $(VENV)/.ready-dev       ## the few that run the released networks at full size
	$(BIN)/python -m pytest -m full

cluster-test: $(VENV)/.ready-dev    ## several hosts, as network namespaces; S3, Slurm, systemd
	$(BIN)/python -m pytest -m 'not full' --durations=10 tests/factory/jobs/ray/test_hosts.py \
		tests/factory/jobs/nightly/test_units.py tests/factory/registry/test_registry_sync.py \
		tests/factory/intake/test_mirror.py

mutants: $(VENV)/.ready-dev         ## fifty small wrong changes, one by one: a test notices each
	$(BIN)/python .ci/mutants.py -j 2

# Plugins of what is installed here for a moment are none of ours.
readers: $(VENV)/.ready-dev         ## every export format in Drake, Pinocchio, yourdfpy and Newton
	$(PIP) install --quiet -c constraints.txt --editable '.[all,dev,readers]'
	PYTEST_DISABLE_PLUGIN_AUTOLOAD=1 $(BIN)/python -m pytest tests/factory/export/test_formats.py

real: $(VENV)/.ready-dev            ## real objects against the table of what becomes of them
	$(BIN)/python benchmarks/real_objects.py

check: $(VENV)/.ready-dev           ## lint, types, layers, conventions, budgets, tables in the docs
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python .ci/conventions.py
	$(BIN)/python .ci/budget.py
	$(BIN)/python docs/generate.py --check

format: $(VENV)/.ready-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# What these measure comes with no checkout.
ASKED := $(addprefix benchmarks/,board.py broken_copies.py defects.py real_objects.py real_yield.py \
	stated.py)

bench: $(VENV)/.ready-dev           ## one JSON line per claim
	for script in $(filter-out $(ASKED),$(wildcard benchmarks/*.py)); do $(BIN)/python $$script || exit 1; done

soak: $(VENV)/.ready-dev            ## hours: kills, full disks, thousands of assets; one JSON line each
	for script in kill_build full_disk long_build scaling fuzz_readers; do \
		$(BIN)/python benchmarks/soak/$$script.py || exit 1; done

faults: $(VENV)/.ready-dev          ## what each check and simulator catches of the fault corpus
	$(BIN)/python benchmarks/confusion_table.py

site:                               ## the scripts of the report's pages, from npm; needs Node
	cd $(WEB) && npm ci --no-audit --no-fund && npm run build

site-test: $(VENV)/.ready-dev site  ## the pages in Chromium; the scripts are as npm makes them
	git diff --exit-code -- $(WEB)/../static
	$(BIN)/python -m pytest -m browser tests/factory/report/site tests/factory/edit tests/test_docs.py

# The variable silences an announcement of MkDocs's successor.
docs: $(VENV)/.ready-dev            ## the docs as a site in build/docs; fails on broken links
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build

clean:
	rm -rf $(VENV) out build dist .mypy_cache .ruff_cache .pytest_cache .hypothesis

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

# torch comes first and alone: any other order lets the resolver try several multi-gigabyte builds.
$(VENV)/.ready: $(LINKED) | $(VENV)/bin/python
	$(PIP) install --quiet -c constraints.txt torch
	$(PIP) install --quiet -c constraints.txt --editable '.[all]'
	touch $@

$(VENV)/.ready-dev: $(VENV)/.ready
	$(PIP) install --quiet -c constraints.txt --editable '.[all,dev]'
	touch $@
