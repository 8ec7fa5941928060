"""Progress of a solve: bars on a terminal alone, sentences on request."""

import logging
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.cli.main import run
from comparisons.cli.output import Bar, bar
from comparisons.logs import PACKAGES, RUNS, level, steps_from

ROOT = Path(__file__).parents[2]


ASKED = {
    "solve": ["solve", "hinge", "-n", "13"],
    "compare": ["compare", "offset", "tapered", "-n", "20", "--elements", "20", "--no-exact"],
    "sentences": ["solve", "hinge", "-n", "13", "-v", "--quiet"],
}
PROGRAM = f"""
import sys
from comparisons.cli.main import run

for asked in {list(ASKED.values())}:
    code = run(asked)
    for stream in (sys.stdout, sys.stderr):
        print(f"== ended with {{code}} ==", file=stream, flush=True)
"""


@pytest.fixture(scope="module")
def on_a_terminal():
    """Exit code, standard output in a pipe, and the text on a terminal at standard error, by name of the command.

    One process runs all commands, since a process loads all modules anew.
    """
    try:
        mine, its = pty.openpty()
    except OSError as error:
        pytest.skip(f"no pseudo-terminal can be opened ({error}): mount devpts on /dev/pts")
    environment = os.environ | {"PYTHONPATH": str(ROOT), "TERM": "xterm", "COLUMNS": "100", "OMP_NUM_THREADS": "1"}
    environment["NUMBA_DISABLE_JIT"] = "1"  # with few links, machine code takes longer to load
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM], stdout=subprocess.PIPE, stderr=its, env=environment, cwd=ROOT
    )
    os.close(its)
    seen = b""
    while True:
        try:
            piece = os.read(mine, 4096)
        except OSError:  # the program's end of the terminal is closed
            break
        if not piece:
            break
        seen += piece
    os.close(mine)
    out = process.stdout.read().decode()
    process.stdout.close()
    assert process.wait() == 0, seen.decode()
    ends = re.compile(r"== ended with (\d+) ==\r?\n")
    (said, codes), (shown, again) = ((ends.split(text)[::2], ends.findall(text)) for text in (out, seen.decode()))
    assert codes == again
    return {name: (int(code), *texts) for name, code, *texts in zip(ASKED, codes, said, shown, strict=False)}


def test_on_a_terminal_a_bar_goes_to_the_end_with_the_time_that_remains_and_the_tables_go_where_they_are_sent(
    on_a_terminal,
):
    code, out, seen = on_a_terminal["solve"]
    assert code == 0
    parts = [int(part) for part in re.findall(r"(\d+)%", seen)]
    # the hinge has ten stations
    assert {10 * k for k in range(11)} <= set(parts)
    assert parts == sorted(parts)
    assert re.search(r"solving, about \d+ s left", seen)
    assert "B.displacement" in out
    assert "B.displacement" not in seen
    assert "solving" not in out


def test_on_a_terminal_a_comparison_says_the_number_of_the_case(on_a_terminal):
    code, out, seen = on_a_terminal["compare"]
    assert code == 0
    assert "case 1 of 2" in seen
    assert re.search(r"case 2 of 2, about \d+ s left", seen)
    assert "Summary" in out


def test_sentences_stand_in_the_bar_s_place(on_a_terminal):
    code, out, seen = on_a_terminal["sentences"]
    assert (code, out) == (0, "")
    lines = seen.splitlines()
    assert len(lines) == 10
    assert re.fullmatch(r"cprbm: hinge: cprbm, stage load: station 1 of 10, M = 0\.067, \d+ iterations?", lines[0])


def test_a_comparison_says_which_of_its_runs_are_done_and_then_nobody_listens(right, capsys):
    assert run(["compare", "hinge", "--quiet", "-v"], right) == 0
    lines = capsys.readouterr().err.splitlines()
    done = [re.search(r"run (\d+) of (\d+) is done", line).groups() for line in lines]
    whole = len(done)
    assert whole > 3
    assert done == [(str(number), str(whole)) for number in range(1, whole + 1)]
    assert level() == logging.NOTSET
    assert not any(logging.getLogger(name).handlers for name in PACKAGES)


def test_who_does_not_listen_costs_no_sentence(right, monkeypatch):
    """No record is made without a listener at the level."""
    made = []
    monkeypatch.setattr(logging.Logger, "makeRecord", lambda *given, **named: made.append(given))
    assert run(["solve", "hinge", "--quiet"], right) == 0
    import cprbm
    from comparisons.cases import opened

    assert cprbm.answer(opened("hinge"), cprbm.Settings(links=11)).completed
    assert made == []


def test_steps_are_heard_from_those_alone_who_are_listened_to():
    heard = []
    with steps_from((RUNS,), lambda done, whole: heard.append((done, whole))):
        logging.getLogger(RUNS).info("x", extra={"done": 3, "whole": 7})
        logging.getLogger(RUNS).info("no steps")
        logging.getLogger("cprbm.march").info("x", extra={"done": 5, "whole": 7})
    logging.getLogger(RUNS).info("x", extra={"done": 4, "whole": 7})
    assert heard == [(3, 7)]


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


def test_one_round_goes_evenly_to_the_end():
    moves = []
    shown = Bar(moves.append)
    for done in (1, 2, 3, 4):
        shown.step(done, 4)
    assert moves == [0.25, 0.5, 0.75, 1.0]


@pytest.mark.parametrize("shown", [True, False])
def test_items_are_handed_on_as_they_are(shown):
    with bar(3, shown=shown) as progress:
        assert list(progress.through([3, 1, 2])) == [3, 1, 2]
