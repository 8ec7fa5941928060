"""Faults outside the program: kills, signals, full disks, closed streams, missing libraries."""

import errno
import filecmp
import gzip
import json
import math
import multiprocessing
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from comparisons import writing
from comparisons.cli.main import run
from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.pairing import Solvers
from comparisons.present import page
from tests.comparisons.killed import NAMES, QUESTION
from tests.verdict.made_up import MadeUp

ROOT = Path(__file__).parents[2]
KILLS = 7
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def files_below(folder):
    return {file.relative_to(folder) for file in folder.rglob("*") if file.is_file()}


def same_files(one, other):
    names = [str(name) for name in files_below(one)]
    return files_below(one) == files_below(other) and filecmp.cmpfiles(one, other, names, shallow=False)[0] == names


@pytest.fixture
def asked(tmp_path):
    """Two questions as files."""
    paths = []
    for name in NAMES[:2]:
        paths.append(tmp_path / f"{name}.toml")
        paths[-1].write_text(QUESTION.format(name=name, length=0.117), "utf-8")
    return [str(path) for path in paths]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="children are forked")
def test_kills_lose_nothing_and_the_next_run_goes_on(tmp_path):
    """The program checks files after every kill; the test compares the last report with the report of a whole run."""
    program = [
        sys.executable,
        "-W",
        "ignore",
        str(Path(__file__).parent / "killed.py"),
        str(tmp_path),
        str(KILLS),
        "905",
    ]
    done = subprocess.run(program, capture_output=True, text=True, env=ENVIRONMENT, check=False)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["killed"] == KILLS
    assert found["solved"] <= found["jobs"] * (found["finished"] + 1) + KILLS  # a kill loses a single solve at most
    assert same_files(tmp_path / "whole", tmp_path / "killed")


def test_an_interrupted_run_solves_nothing_again_and_a_changed_question_does(tmp_path, asked, monkeypatch, capsys):
    monkeypatch.setattr(page, "figures_of", lambda compared: ())
    solved = []

    class Noting(MadeUp):
        def __call__(self, scene, choices):
            if scene.name == "second" and not solved.count("stopped"):
                solved.append("stopped")
                raise KeyboardInterrupt
            solved.append((self.solver, scene.name))
            return super().__call__(scene, choices)

    arguments = ["compare", *asked, "--quiet", "--out", str(tmp_path / "r")]
    solvers = Solvers(Noting("cprbm", 2e-3), Noting("fea", -5e-4))
    assert run(arguments, solvers) == 130
    before = solved.count(("cprbm", "first"))
    assert before > 0
    assert (tmp_path / "r" / ".unfinished").is_dir()
    first = Path(asked[0])
    assert run(arguments, solvers) == 0
    assert solved.count(("cprbm", "first")) == before
    assert not (tmp_path / "r" / ".unfinished").exists()
    # a finished run begins anew, and so does a run with a changed question
    solved.clear()
    assert run(arguments, solvers) == 130
    first.write_text(first.read_text("utf-8").replace("0.0011", "0.0012"), "utf-8")
    assert run(arguments, solvers) == 0
    assert solved.count(("cprbm", "first")) == 2 * before
    assert "Interrupted" in capsys.readouterr().err


def kind_of(partial):
    """Ending of a kept answer, and the name of another file."""
    name = partial.name.removeprefix(".").rsplit(".", 2)[0]  # without the unique part and the suffix
    return name.partition(".")[2] if ".unfinished" in partial.parts else name


def test_a_full_disk_at_any_write_is_a_sentence_and_leaves_whole_files(tmp_path, asked, monkeypatch, capsys):
    monkeypatch.setattr(page, "figures_of", lambda compared: ())
    solvers = Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4))
    whole = tmp_path / "whole"
    arguments = ["compare", *asked, "--quiet", "--out"]
    opened, left, written = os.fdopen, [10**9], []

    def full(handle, mode):
        written.append(Path(f"/proc/self/fd/{handle}").readlink())
        stream = opened(handle, mode)
        left[0] -= 1
        if left[0] == 0:
            stream.close()
            return opened(os.open("/dev/full", os.O_WRONLY), mode)
        return stream

    monkeypatch.setattr(writing.os, "fdopen", full)
    assert run([*arguments, str(whole)], solvers) == 0
    writes = 10**9 - left[0]
    assert writes == len(written) > 10
    # a name in the folder of the second question is a name in the folder of the first; kept answers have one kind
    kinds = {kind_of(file): nth for nth, file in enumerate(written, 1)}
    assert 5 < len(kinds) < writes
    for nth in (1, *kinds.values()):
        out = tmp_path / f"r{nth}"
        left[0] = nth
        assert run([*arguments, str(out)], solvers) == 2
        said = capsys.readouterr().err
        assert said.startswith(f"cprbm: Cannot write {out}")
        assert said.endswith(f": {os.strerror(errno.ENOSPC)}.\n")
        assert said.count("\n") == 1
        assert not list(out.rglob("*.partial"))
        for file in out.rglob("*.json"):
            json.loads(file.read_text("utf-8"))
        for file in out.rglob(".unfinished/*.json.gz"):
            json.loads(gzip.decompress(file.read_bytes()))
        left[0] = 10**9
        assert run([*arguments, str(out)], solvers) == 0
        assert same_files(whole, out)


@pytest.mark.parametrize("library", ["matplotlib", "jinja2", "rich"])
def test_a_library_that_is_not_there_is_named_with_what_installs_it(tmp_path, asked, monkeypatch, capsys, library):
    for module in [name for name in sys.modules if name.partition(".")[0] == library]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, library, None)
    page.renderer.cache_clear()
    solvers = Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4))
    quiet = [] if library == "rich" else ["--quiet"]
    assert run(["compare", asked[0], *quiet, "--out", str(tmp_path / "r")], solvers) == 2
    said = capsys.readouterr().err
    assert f"The library {library}" in said
    assert f"-m pip install --upgrade --force-reinstall {library}" in said
    assert said.count("\n") == 1


def test_too_little_memory_is_a_sentence(asked, capsys):
    def large(scene, choices):
        raise MemoryError

    assert run(["compare", asked[0]], Solvers(large, large)) == 1
    assert (
        capsys.readouterr().err
        == "cprbm: The memory is too small for this model. Finished results stand; ask for fewer links.\n"
    )


@pytest.mark.parametrize("closed", ["full", "closed"])
def test_standard_output_that_takes_nothing_is_a_sentence(closed):
    shell = f"exec {sys.executable} -c 'from comparisons.cli.program import main; main()' list"
    shell += " >/dev/full" if closed == "full" else " >&-"
    done = subprocess.run(["sh", "-c", shell], stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert (os.strerror(errno.ENOSPC) if closed == "full" else "closed") in done.stderr


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_signal_while_modules_are_loaded_is_a_sentence(number, code):
    """The program sends the signal at the import of a module, neither too early nor too late."""
    program = f"""
import os, signal, sys
signal.signal({int(number)}, signal.SIG_DFL)  # a test run may be started so that it ignores the signal
class Sending:
    def find_spec(self, name, path=None, target=None):
        if name == 'cprbm_scene.statement':
            os.kill(os.getpid(), {int(number)})
sys.meta_path.insert(0, Sending())
sys.argv[1:] = ['solve', 'hinge']
from comparisons.cli.program import main
main()
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=ENVIRONMENT, check=False)
    assert done.returncode == code
    assert done.stdout == ""
    assert done.stderr.startswith("cprbm: ")
    assert done.stderr.count("\n") == 1


LONG = """
import os, time
from pathlib import Path
from comparisons.choices import Choices
from comparisons.executor import crew_of


def waits(scene, choices):
    Path(f"worker{os.getpid()}").touch()
    time.sleep(600.0)


if __name__ == "__main__":
    with crew_of(2) as crew:
        crew.answers([(waits, None, Choices()), (waits, None, Choices())])
"""


def test_no_worker_outlives_the_process_that_was_killed(tmp_path):
    (tmp_path / "program.py").write_text(LONG, "utf-8")
    process = subprocess.Popen([sys.executable, "program.py"], cwd=tmp_path, env=ENVIRONMENT)
    while len(workers := list(tmp_path.glob("worker*"))) < 2:
        assert process.poll() is None
        time.sleep(0.05)
    process.kill()
    process.wait()
    alive = [int(worker.name.removeprefix("worker")) for worker in workers]
    until = time.monotonic() + 60.0
    while any(running(pid) for pid in alive):
        assert time.monotonic() < until, "a worker goes on solving for nobody"
        time.sleep(0.05)


def running(pid):
    """Whether a process is there and no zombie."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def test_a_call_runs_in_another_process_and_its_value_or_exception_comes_back():
    assert call_fresh(os.getpid) != os.getpid()
    assert call_fresh(math.hypot, 3.3, 5.6) == 6.5
    with pytest.raises(ValueError, match="math domain error"):
        call_fresh(math.sqrt, -0.3)


@pytest.mark.parametrize(("ends", "by", "with_"), [(os._exit, 139, 139), (signal.raise_signal, 9, -9)])
def test_one_that_ends_by_force_is_told_of(ends, by, with_):
    with pytest.raises(WorkerDiedError, match=f"ended with {with_}$"):
        call_fresh(ends, by)


def test_an_interrupt_ends_it(monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("multiprocessing.connection.Connection.recv", interrupted)
    with pytest.raises(KeyboardInterrupt):
        call_fresh(signal.pause)
    assert not multiprocessing.active_children()
