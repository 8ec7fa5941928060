# What is needed: python3 (3.11 or later) with its venv module, and make.
#
#   make compare   set up where that is missing, run the comparison of all cases, write report/
#   make test      set up where that is missing, run the whole test suite
#   make check     the rules of style and the types
#   make fuzz      alter scene files at places drawn from SEED, RUNS times, and see that the reader takes them
#   make mutants   put MUTANTS small faults, drawn from SEED, into the solvers, and see which the quick tests catch; an hour
#   make setup     only the set-up
#   make lock      renew requirements.lock (needs uv)

.POSIX:
.PHONY: setup compare test check fuzz mutants lock clean

PYTHON = python3
SEED = 905
RUNS = 2000
MUTANTS = 200
BIN = .venv/bin
READY = .venv/ready
ENVIRONMENT = MPLBACKEND=Agg PIP_DISABLE_PIP_VERSION_CHECK=1

compare: $(READY)
	$(ENVIRONMENT) $(BIN)/cprbm compare all

test: $(READY)
	$(ENVIRONMENT) OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist loadfile

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

fuzz: $(READY)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.scene.fuzzing --runs $(RUNS) --seed $(SEED)

mutants: $(READY)
	$(ENVIRONMENT) OMP_NUM_THREADS=1 $(BIN)/python -m tests.mutants --mutants $(MUTANTS) --seed $(SEED)

setup: $(READY)

# The stamp is older than the lock or the project's description exactly if the environment may be stale.
$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' \
	  || { echo "Python 3.11 or later is needed: make PYTHON=/path/to/it"; exit 1; }
	rm -rf .venv
	$(PYTHON) -m venv .venv \
	  || { echo "Python's venv module is needed; on Debian or Ubuntu: apt install python3-venv"; exit 1; }
	$(ENVIRONMENT) $(BIN)/python -m pip install --quiet --require-hashes -r requirements.lock
	$(ENVIRONMENT) $(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .
	touch $(READY)

# The extra 'view' is left out: VTK is 100 MB, and nothing but pictures in space needs it.
lock:
	{ sed '/^$$/q' requirements.lock; \
	  uv pip compile --universal --generate-hashes --python-version 3.11 --quiet \
	    --extra build --extra peers --extra solid --extra test \
	    --no-header --no-emit-index-url pyproject.toml; } > requirements.new
	mv requirements.new requirements.lock

clean:
	rm -rf .venv report build *.egg-info
