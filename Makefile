# What is needed: python3 (3.11 or later) with its venv module, and make.
#
#   make compare   set up where that is missing, run the comparison of all cases, write report/
#   make test      set up where that is missing, run the whole test suite
#   make check     the rules of style, the types and the rules of imports
#   make ratchets  sizes of the packages beside their limits, which only fall
#   make docs      the documentation in build/docs, with figures made by the code; warnings are errors
#   make fuzz      alter scene files at places drawn from SEED, RUNS times, and see that the reader takes them
#   make mutants   put MUTANTS small faults, drawn from SEED, into the solvers, and see which the quick tests catch; an hour
#   make wheel     the archive of sources and the wheel, in dist/
#   make pythons   install that wheel under each Python found, try the program and the quick tests; minutes each
#   make lowest    the same under the oldest one with the lowest versions declared (needs uv)
#   make setup     only the set-up
#   make lock      renew requirements.lock (needs uv)

.POSIX:
.PHONY: setup compare test check ratchets docs fuzz mutants wheel pythons lowest lock clean

PYTHON = python3
SEED = 905
RUNS = 2000
MUTANTS = 200
BIN = .venv/bin
READY = .venv/ready
ENVIRONMENT = MPLBACKEND=Agg PIP_DISABLE_PIP_VERSION_CHECK=1

compare: $(READY)
	$(ENVIRONMENT) $(BIN)/cprbm compare all

# With --dist loadfile a worker that takes the place of one that died leaves files unassigned, and the run never ends.
# Bytecode is written, since workers and commands in fresh processes load the same modules.
test: $(READY)
	$(ENVIRONMENT) PYTHONDONTWRITEBYTECODE= OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist loadfile --max-worker-restart 0

check: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-cache --no-logo

ratchets: $(READY)
	$(BIN)/python -m tests.ratchets

docs: $(READY)
	$(ENVIRONMENT) OMP_NUM_THREADS=1 $(BIN)/python -m sphinx --builder html --fail-on-warning --keep-going --quiet \
	  --doctree-dir build/doctrees docs build/docs

fuzz: $(READY)
	OMP_NUM_THREADS=1 $(BIN)/python -m tests.cprbm_scene.fuzzing --runs $(RUNS) --seed $(SEED)

mutants: $(READY)
	$(ENVIRONMENT) OMP_NUM_THREADS=1 NUMBA_DISABLE_JIT=1 $(BIN)/python -m tests.mutants --mutants $(MUTANTS) --seed $(SEED)

wheel: $(READY)
	rm -rf dist
	$(BIN)/python -m tests.packaging.made dist

pythons: $(READY)
	$(ENVIRONMENT) $(BIN)/python -m tests.packaging

lowest: $(READY)
	$(ENVIRONMENT) $(BIN)/python -m tests.packaging --lowest

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
	$(ENVIRONMENT) $(BIN)/python -c "from cprbm import Settings, answer; from cprbm_scene import read; \
	  [answer(read(f'comparisons/cases/{case}.toml'), Settings(formulation=formulation)) for case, formulation \
	  in (('hinge', 'auto'), ('wrapped', 'auto'), ('five-bar', 'auto'), ('hinge', 'paper'))]"  # stores the compiled kernels
	touch $(READY)

# The extra 'view' is left out: VTK's modules take 565 MB, and nothing but pictures in space needs them.
lock:
	{ sed '/^$$/q' requirements.lock; \
	  uv pip compile --universal --generate-hashes --python-version 3.11 --quiet \
	    --extra build --extra cluster --extra docs --extra dxf --extra netcdf --extra peers --extra solid --extra test \
	    --extra threads \
	    --no-header --no-emit-index-url pyproject.toml; } > requirements.new
	mv requirements.new requirements.lock

clean:
	rm -rf .venv report full-report build dist docs/made *.egg-info
