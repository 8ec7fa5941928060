"""The program beside its machine: kills, signals, full disks, closed streams, missing libraries, and terminals."""

import errno
import filecmp
import gzip
import json
import logging
import math
import multiprocessing
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons import writing
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.cli.output import Bar, bar
from comparisons.executor import WorkerDiedError, call_fresh
from comparisons.logs import PACKAGES, RUNS, level, steps_from
from comparisons.pairing import Solvers, paired
from comparisons.present import page
from comparisons.writing import write
from tests.comparisons.killed import NAMES, QUESTION
from tests.comparisons.programs import ENVIRONMENT, MAIN, SIGNALLED, WAITING, WORKERS, interrupted, on_a_terminal
from tests.verdict.made_up import MadeUp

KILLS = 7


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


def test_a_full_disk_at_any_write_is_a_sentence_and_leaves_whole_files(tmp_path, asked, right, monkeypatch, capsys):
    monkeypatch.setattr(page, "figures_of", lambda compared: ())
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
    assert run([*arguments, str(whole)], right) == 0
    writes = 10**9 - left[0]
    assert writes == len(written) > 10
    # a name in the folder of the second question is a name in the folder of the first; kept answers have one kind
    kinds = {kind_of(file): nth for nth, file in enumerate(written, 1)}
    assert 5 < len(kinds) < writes
    for nth in (1, *kinds.values()):
        out = tmp_path / f"r{nth}"
        left[0] = nth
        assert run([*arguments, str(out)], right) == 2
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
        assert run([*arguments, str(out)], right) == 0
        assert same_files(whole, out)


def test_a_failed_write_leaves_the_old_file_and_a_link_leads_no_file_out_of_the_folder(hinge, right, tmp_path):
    file = tmp_path / "data.json"
    write(file, "old")
    with pytest.raises(UnicodeEncodeError):
        write(file, "new \udc80")
    assert file.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [file]
    elsewhere, folder = tmp_path / "elsewhere", tmp_path / "out"
    for each in (elsewhere, folder):
        each.mkdir()
    (folder / "hinge").symlink_to(elsewhere)
    comparison = compare(paired(hinge, Choices(), right))
    with pytest.raises(OSError, match="outside the report's folder"):
        page.put_case(folder, comparison)
    assert list(elsewhere.iterdir()) == []
    (folder / "index.html").symlink_to(elsewhere / "index.html")
    page.put_page(folder, page.report_page([]))
    assert list(elsewhere.iterdir()) == []


@pytest.mark.parametrize("library", ["matplotlib", "jinja2", "rich"])
def test_a_missing_library_is_named_with_the_command_that_installs_it(
    tmp_path, asked, right, monkeypatch, capsys, library
):
    for module in [name for name in sys.modules if name.partition(".")[0] == library]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, library, None)
    page.renderer.cache_clear()
    quiet = [] if library == "rich" else ["--quiet"]
    assert run(["compare", asked[0], *quiet, "--out", str(tmp_path / "r")], right) == 2
    said = capsys.readouterr().err
    assert f"The library {library}" in said
    assert f"-m pip install --upgrade --force-reinstall {library}" in said
    assert said.count("\n") == 1


# -- Streams and signals


def test_standard_output_that_takes_nothing_is_a_sentence_and_a_reader_that_goes_away_ends_quietly():
    for where, said in ((">/dev/full", os.strerror(errno.ENOSPC)), (">&-", "closed")):
        shell = f"exec {sys.executable} -c '{MAIN}' list {where}"
        done = subprocess.run(["sh", "-c", shell], stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, check=False)
        assert done.returncode == 2, where
        assert done.stderr.count("\n") == 1
        assert said in done.stderr
    # the reading end is closed before anything is written, so the first write finds nobody
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as nowhere:
        command = [sys.executable, "-c", MAIN, "list"]
        done = subprocess.run(command, stdout=nowhere, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, check=False)
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_a_signal_while_modules_are_loaded_is_a_sentence(number, code):
    program = SIGNALLED.format(number=int(number))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=ENVIRONMENT, check=False)
    assert (done.returncode, done.stdout) == (code, "")
    assert done.stderr.startswith("cprbm: ")
    assert done.stderr.count("\n") == 1


def test_an_interrupt_from_the_keyboard_ends_every_process_with_a_sentence(tmp_path):
    """The workers solve at that moment."""
    (tmp_path / "program.py").write_text(WAITING, "utf-8")
    interrupted(["compare", "hinge"], tmp_path, (tmp_path / "started").exists)


def test_no_worker_outlives_the_process_that_was_killed(tmp_path):
    (tmp_path / "program.py").write_text(WORKERS, "utf-8")
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


def test_a_call_in_another_process_returns_raises_or_names_its_end(monkeypatch):
    assert call_fresh(math.hypot, 3.3, 5.6) == 6.5
    with pytest.raises(ValueError, match="math domain error"):
        call_fresh(math.sqrt, -0.3)
    for ends, by, code in ((os._exit, 139, 139), (signal.raise_signal, 9, -9)):
        with pytest.raises(WorkerDiedError, match=f"ended with {code}$"):
            call_fresh(ends, by)

    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("multiprocessing.connection.Connection.recv", interrupted)
    with pytest.raises(KeyboardInterrupt):
        call_fresh(signal.pause)
    assert not multiprocessing.active_children()


# -- Progress: bars on a terminal alone, sentences on request


@pytest.fixture(scope="module")
def terminal():
    """Exit code, standard output in a pipe, and standard error on a terminal, of three commands of a process."""
    commands = (
        ["solve", "hinge", "-n", "11"],
        ["compare", "offset", "tapered", "-n", "10", "--elements", "10", "--no-exact"],
        ["solve", "hinge", "-n", "11", "-v", "--quiet"],
    )
    try:
        return on_a_terminal(commands)
    except OSError as error:
        pytest.skip(f"no pseudo-terminal can be opened ({error}): mount devpts on /dev/pts")


def test_on_a_terminal_a_bar_or_sentences_go_to_the_end_and_the_tables_go_where_they_are_sent(terminal):
    code, out, seen = terminal[0]
    assert code == 0
    parts = [int(part) for part in re.findall(r"(\d+)%", seen)]
    # the hinge has ten stations
    assert {10 * k for k in range(11)} <= set(parts)
    assert parts == sorted(parts)
    assert re.search(r"solving, about \d+ s left", seen)
    assert "B.displacement" in out
    assert "B.displacement" not in seen
    assert "solving" not in out
    code, out, seen = terminal[1]
    assert code == 0
    assert "case 1 of 2" in seen
    assert re.search(r"case 2 of 2, about \d+ s left", seen)
    assert "Summary" in out
    code, out, seen = terminal[2]
    assert (code, out) == (0, "")
    lines = seen.splitlines()
    assert len(lines) == 10
    assert re.fullmatch(r"cprbm: hinge: cprbm, stage load: station 1 of 10, M = 0\.067, \d+ iterations?", lines[0])


def test_a_comparison_says_which_of_its_runs_are_done_and_steps_are_heard_of_the_asked_loggers_alone(right, capsys):
    assert run(["compare", "hinge", "--quiet", "-v"], right) == 0
    lines = capsys.readouterr().err.splitlines()
    done = [re.search(r"run (\d+) of (\d+) is done", line).groups() for line in lines]
    whole = len(done)
    assert whole > 3
    assert done == [(str(number), str(whole)) for number in range(1, whole + 1)]
    assert level() == logging.NOTSET
    assert not any(logging.getLogger(name).handlers for name in PACKAGES)
    heard = []
    with steps_from((RUNS,), lambda done, whole: heard.append((done, whole))):
        logging.getLogger(RUNS).info("x", extra={"done": 3, "whole": 7})
        logging.getLogger(RUNS).info("no steps")
        logging.getLogger("cprbm.march").info("x", extra={"done": 5, "whole": 7})
    logging.getLogger(RUNS).info("x", extra={"done": 4, "whole": 7})
    assert heard == [(3, 7)]


def test_who_does_not_listen_costs_no_sentence(right, monkeypatch):
    """No record is made without a listener at the level."""
    made = []
    monkeypatch.setattr(logging.Logger, "makeRecord", lambda *given, **named: made.append(given))
    assert run(["solve", "hinge", "--quiet"], right) == 0
    import cprbm
    from comparisons.cases import opened

    assert cprbm.answer(opened("hinge"), cprbm.Settings(links=11)).completed
    assert made == []


@given(st.lists(st.lists(st.integers(1, 9), min_size=1, max_size=4), min_size=1, max_size=4))
def test_through_rounds_of_any_length_a_bar_never_goes_back_nor_beyond_its_item(items):
    moves, before = [], 0.0
    shown = Bar(moves.append)
    for place, each in enumerate(shown.through(items)):
        assert moves[-1] == place
        for whole in each:
            for done in range(1, whole + 1):
                shown.step(done, whole)
                assert before - 1e-12 <= moves[-1] <= place + 1.0
                before = moves[-1]
    assert before == len(items)


def test_one_round_goes_evenly_to_the_end_and_items_are_handed_on_as_they_are():
    moves = []
    with_steps = Bar(moves.append)
    for done in (1, 2, 3, 4):
        with_steps.step(done, 4)
    assert moves == [0.25, 0.5, 0.75, 1.0]
    for shown in (True, False):
        with bar(3, shown=shown) as progress:
            assert list(progress.through([3, 1, 2])) == [3, 1, 2]
