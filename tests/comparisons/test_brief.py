"""Brief output of ``cprbm compare``: the verdict with its reason, the nearest rows, and the next command."""

from dataclasses import replace

import numpy as np
import pytest

from comparisons.cli.main import run
from comparisons.pairing import Solvers
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp

HEADERS = ["probe", "unit", "CPRBM", "FEA", "difference", "stated", "word"]


def printed(capsys, *arguments, solvers=None):
    code = run(["compare", *arguments], solvers)
    return code, capsys.readouterr().out.splitlines()


def test_a_case_takes_at_most_30_lines_of_80_columns(right, capsys):
    code, lines = printed(capsys, "hinge", solvers=right)
    assert code == 0
    assert len(lines) <= 30
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith("hinge: AGREE. All 126 rows agree")
    table = lines[next(place for place, line in enumerate(lines) if line.split() == HEADERS) + 2 :]
    assert table[0] == "load 0.67 N·m"
    # the hinge has 13 probes; components of a vector share one word
    assert sum(line.endswith(" AGREE") for line in table) == 12
    assert "1 more row AGREE (-v)" in table
    assert table[-2:] == ["next: cprbm compare hinge --out DIR", ""]


def test_the_reason_and_the_next_command_of_the_sentence_stand_first_and_last(right, capsys):
    code, lines = printed(capsys, "hinge", solvers=Solvers(MadeUp("cprbm", 2e-3, stiffness=1.02), right.fea))
    assert code == 1
    assert lines[0].startswith("hinge: DIFFER (VALUES). ")
    assert "next: cprbm compare hinge --solver cprbm,fea,solid" in lines
    code, lines = printed(capsys, "hinge", solvers=Solvers(MadeUp("cprbm", 2e-2), right.fea))
    assert code == 3
    assert lines[0].startswith("hinge: UNDECIDED (COARSE). ")
    (line,) = (line for line in lines if line.startswith("next: "))
    assert line.startswith("next: cprbm compare hinge -n ")
    # the command is a command of the program, and its links are sufficient
    assert run(line.removeprefix("next: cprbm ").split(), Solvers(MadeUp("cprbm", 2e-2), right.fea)) == 0


def test_rows_that_differ_come_before_rows_that_agree(capsys):
    def spoilt(station):
        values = dict(station.values)
        values["A.reaction_moment"] = 1.2 * values["A.reaction_moment"]
        return replace(station, values=frozendict(values))

    solvers = Solvers(MadeUp("cprbm", 2e-3, spoilt=spoilt), MadeUp("fea", -5e-4))
    _, lines = printed(capsys, "hinge", solvers=solvers)
    (line,) = (line for line in lines if line.startswith("A.reaction_moment"))
    assert line.endswith("DIFFER")


def test_values_below_their_floor_print_as_0(capsys):
    def spoilt(station):
        values = dict(station.values)
        values["A.reaction"] = np.array([values["A.reaction"][0], 1e-17])
        return replace(station, values=frozendict(values))

    solvers = Solvers(MadeUp("cprbm", 2e-3, spoilt=spoilt), MadeUp("fea", -5e-4, spoilt=spoilt))
    _, lines = printed(capsys, "hinge", "-v", solvers=solvers)
    line = next(line for line in lines if line.split()[:1] == ["A.reaction"])
    assert line.count(", 0)") == 2


@pytest.mark.parametrize("verbose", [[], ["-v"]])
def test_all_tables_come_with_v(right, capsys, verbose):
    code, lines = printed(capsys, "hinge", *verbose, solvers=right)
    assert code == 0
    assert any(line.startswith("Certificates") for line in lines) is bool(verbose)


def test_several_cases_end_with_a_summary(right, capsys, tmp_path):
    code, lines = printed(capsys, "hinge", "offset", "--out", str(tmp_path / "r"), solvers=right)
    assert code == 0
    assert max(map(len, lines[:-1])) <= 80
    assert len(lines) <= 2 * 30 + 16
    start = lines.index(next(line for line in lines if line.startswith("Summary")))
    cells = {line.split()[0]: line.split() for line in lines[start:] if line.split()[:1] in (["hinge"], ["offset"])}
    assert cells["hinge"][1:5] == ["AGREE", "126", "of", "126"]
    assert 0.0 < float(cells["hinge"][5]) <= 1.0
    assert cells["offset"][1:5] == ["AGREE", "2000", "of", "2000"]
    assert lines[-1] == f"report: {tmp_path / 'r' / 'index.html'}"
