# Set-up, demo and checks on the ROS 2 wheels; docs/use/setup.md also has the way with apt's ROS 2.
SHELL := /bin/bash
.SHELLFLAGS := -e -o pipefail -c
.DELETE_ON_ERROR:
.PHONY: setup demo test test-fast test-nightly lint docs lock clean help

ifneq ($(words $(CURDIR)),1)
$(error colcon fails in a folder with a space in its path, move the repository: $(CURDIR))
endif

# An inherited ROS or Python environment would mix its libraries with those of the wheels, and
# without bytecode files every node of every run would compile its imports again.
unexport $(filter AMENT_% COLCON_% RMW_% ROS_% _ROS_% CMAKE_PREFIX_PATH LD_LIBRARY_PATH \
    PYTHONDONTWRITEBYTECODE PYTHONHOME PYTHONPATH VIRTUAL_ENV,$(.VARIABLES))

# The matrices are small: further threads of the numerics would only wait for one another.
export OPENBLAS_NUM_THREADS := 1

BIN := .venv/bin
SOURCED := . install/setup.bash;
VENV_MADE := .venv/.made
WORKSPACE_BUILT := install/.built
BUILD_INPUTS := $(wildcard ddct_*/package.xml ddct_*/setup.* ddct_*/bin ddct_*/config ddct_*/foxglove)

# Groups of pyproject.toml that are installed on request, each from its lock.
EXTRA_GROUPS := bench fmu fuzz gym site test tune
COMMA := ,
WANTED := $(subst $(COMMA), ,$(EXTRAS))
ifneq ($(filter-out $(EXTRA_GROUPS),$(WANTED)),)
$(error no extra $(filter-out $(EXTRA_GROUPS),$(WANTED)): EXTRAS takes some of $(EXTRA_GROUPS), with commas between them)
endif
FOR_TESTS := $(addprefix .venv/.,fmu gym site test tune)

PYTHONS := $(or $(PYTHON),python3.13 python3.12 python3.11 python3)
SUITABLE := import ensurepip, sys, venv; sys.exit(not (3, 11) <= sys.version_info < (3, 14))
NEEDED_AT_RUN := bokeh, control, daqp, jinja2, matplotlib, osqp, scipy.signal, threadpoolctl, yaml, rich, rosbags.typesys, rclpy, \
    diagnostic_msgs.msg, geometry_msgs.msg, rosgraph_msgs.msg, sensor_msgs.msg, trajectory_msgs.msg

help:
	@echo 'make setup | demo | test | test-fast | test-nightly | lint | docs | lock | clean (see docs/use/setup.md)'

setup: $(WORKSPACE_BUILT) $(addprefix .venv/.,$(WANTED))

# Always a new environment: each ROS wheel holds a second package record (rclpy in ros-rclpy), and
# a second sync would take those for strangers and remove their modules.
# colcon's install/setup.* chain to local_setup.*: the ament index has the message packages, and
# python3 is that of the environment.
$(VENV_MADE): locks/workspace.txt locks/uv.txt
	@if [ "$$(uname -sm)" != 'Linux x86_64' ]; then \
	    echo "make: the ROS 2 wheels are for x86-64 Linux, this is $$(uname -sm): see docs/use/setup.md" \
	        'for ROS 2 from apt, and for headless runs by pip alone' >&2; exit 1; fi; \
	for python in $(PYTHONS); do \
	    "$$python" -c '$(SUITABLE)' 2>/dev/null && break; python=; \
	done; \
	if [ -z "$$python" ]; then \
	    echo 'make: no Python 3.11, 3.12 or 3.13 with venv (Debian, Ubuntu: python3-venv)' \
	        'among: $(PYTHONS). Name one: make PYTHON=/path/to/python3.12' >&2; exit 1; fi; \
	echo "Making .venv with $$("$$python" --version) ($$python)"; \
	"$$python" -m venv --clear .venv
	@$(BIN)/python -m pip install -qq --disable-pip-version-check --require-hashes \
	    --only-binary :all: -r locks/uv.txt
	@echo 'Installing locks/workspace.txt'
	@$(BIN)/uv pip sync --quiet --python $(BIN)/python --require-hashes \
	    --build-constraints locks/workspace.txt locks/workspace.txt locks/uv.txt
	@$(BIN)/python -c 'import $(NEEDED_AT_RUN)'
	@for shell in sh bash zsh; do \
	    printf '%s\n' 'export AMENT_PREFIX_PATH="$(CURDIR)/.venv$${AMENT_PREFIX_PATH:+:$$AMENT_PREFIX_PATH}"' \
	        'case ":$$PATH:" in *":$(CURDIR)/$(BIN):"*) ;; *) export PATH="$(CURDIR)/$(BIN):$$PATH" ;; esac' \
	        > .venv/local_setup.$$shell; \
	done
	@touch $@

# From nothing, as it takes seconds: colcon leaves behind what is gone from the sources.
$(WORKSPACE_BUILT): $(VENV_MADE) $(BUILD_INPUTS)
	@rm -rf build install log
	@AMENT_PREFIX_PATH="$(CURDIR)/.venv" $(BIN)/colcon build --symlink-install
	@touch $@

# Added to the environment that is there; a second sync would break it.
$(addprefix .venv/.,$(EXTRA_GROUPS)): .venv/.%: locks/%.txt $(VENV_MADE)
	@$(BIN)/uv pip install --quiet --python $(BIN)/python --require-hashes -r $<
	@touch $@

demo: setup
	@$(SOURCED) ddct compare \
	    --controllers pi,ls8,hinf1,mpc3,mpc4 --out runs/demo --overwrite

# One session of pytest: one for each package would import and collect everything again, on an idle core at its end.
# That colcon finds the tests of each package is a test of its own.
TEST_FOLDERS := $(wildcard tests ddct_*/test)
NIGHTLY := tests/nightly
# A process that a hanging test has ended is not replaced: its successor would run that test again.
WORKERS := --dist loadfile --max-worker-restart 0
test: setup $(FOR_TESTS)
	@$(SOURCED) $(BIN)/python -m pytest $(WORKERS) -n 3 --no-loadscope-reorder \
	    -m 'not nightly' --ignore=$(NIGHTLY) $(TEST_FOLDERS)

# What depends on the wall clock, whole gates and products of lists: before a release.
LONG := -o faulthandler_timeout=3600
test-nightly: setup $(FOR_TESTS)
	@$(SOURCED) $(BIN)/python -m pytest $(LONG) $(WORKERS) -n 2 $(NIGHTLY)
	@$(SOURCED) $(BIN)/python -m pytest $(LONG) $(WORKERS) -n 2 -m nightly --ignore=$(NIGHTLY) $(TEST_FOLDERS)
	@$(SOURCED) DDCT_SCHEDULES=1000 $(BIN)/python -m pytest $(LONG) $(WORKERS) -n 2 --dist load \
	    ddct_plant/test/ticks ddct_plant/test/fail_safe

# Tests without a marker; tests/plugins/tiers.py selects and checks them.
test-fast: setup .venv/.gym .venv/.tune
	@$(SOURCED) $(BIN)/python -m pytest $(WORKERS) -q -n 2 \
	    --fast-tier --ignore=$(NIGHTLY) $(TEST_FOLDERS)

# With everything that the tests install: mypy judges otherwise without a package's types than with them.
lint: setup $(FOR_TESTS)
	@status=0; \
	$(BIN)/ruff check || status=1; \
	$(BIN)/ruff format --check || status=1; \
	$(BIN)/mypy || status=1; \
	exit $$status

# The documentation as one folder that opens from disk, with search and a reference: site/index.html.
# What it shows of results, programs compute first: some minutes, and again only once the sources have changed.
RESULTS := build/results
SOURCES := $(shell find ddct_*/ddct_* -name '*.py' -o -name '*.yaml' -o -name '*.parquet')
docs: setup .venv/.site $(RESULTS)/numbers.json $(RESULTS)/benchmark.json $(RESULTS)/studies.json
	@$(SOURCED) PYTHONPATH="$(CURDIR)/docs:$$PYTHONPATH" $(BIN)/python -P -m website --results '$(RESULTS)'

$(RESULTS)/numbers.json: COMMAND = thesis numbers --json -
$(RESULTS)/benchmark.json: COMMAND = benchmark --packaged --json -
$(RESULTS)/studies.json: COMMAND = thesis studies --json - --charts $(RESULTS)
$(RESULTS)/%.json: $(WORKSPACE_BUILT) $(SOURCES)
	@mkdir -p $(RESULTS)
	@$(SOURCED) ddct $(COMMAND) > $@

# One numpy and one scipy for all three Pythons, so that figures do not depend on the Python.
# The versions of the locks that are there stay where they can.
COMPILE := $(BIN)/uv pip compile --quiet --universal --python-version 3.11 --generate-hashes \
    --no-header --fork-strategy fewest
lock: $(VENV_MADE)
	@$(COMPILE) --group workspace -o locks/workspace.txt
	@for group in uv $(EXTRA_GROUPS); do \
	    $(COMPILE) --group $$group -c locks/workspace.txt -o locks/$$group.txt; done

clean:
	rm -rf .venv build install log site dist .fuzz_cache .mypy_cache .pytest_cache .ruff_cache
