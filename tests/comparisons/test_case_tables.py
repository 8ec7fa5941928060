"""The brief report of ``compare`` and all tables with ``-v``: made-up solvers with known errors."""

import re
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.opinions import contact_model
from comparisons.pairing import Solvers, paired
from comparisons.present.brief import brief
from comparisons.present.case_tables import answer_tables, branch_table, case_sections
from comparisons.present.offset import compared_offset, error_table
from comparisons.present.row_tables import paper_table
from comparisons.verdict.events import NO_EVENTS
from cprbm_scene import Ending
from cprbm_scene.frozendict import frozendict
from tests.tables import tables_of
from tests.verdict.made_up import MadeUp, with_value

HEADERS = ["probe", "unit", "CPRBM", "FEA", "difference", "stated", "word"]


@pytest.fixture(scope="module")
def comparison():
    """Two solvers that differ by a few parts in ten million."""
    scene = cases.opened("hinge")
    return compare(paired(scene, Choices(), Solvers(MadeUp("cprbm", 2e-7), MadeUp("fea", -5e-8))))


def cell(table, row, header):
    return next(line for line in table.rows if line[0] == row)[table.headers.index(header)]


def titled(tables, start):
    return next(table for table in tables if table.title.startswith(start))


def percentage(text):
    return 0.01 * float(text.removesuffix(" %"))


def printed(capsys, *arguments, solvers=None):
    code = run(["compare", *arguments], solvers)
    return code, capsys.readouterr().out.splitlines()


def test_all_tables_are_complete_and_no_small_error_reads_as_zero(comparison):
    found = tables_of(comparison)
    cells = [cell for table in found for row in table.rows for cell in row]
    assert all(len(row) == len(table.headers) for table in found for row in table.rows)
    assert len({table.title for table in found}) == len(found)
    assert not [cell for cell in cells if re.fullmatch(r"-?0\.0+ %", cell)]
    assert any("e-05 %" in cell for cell in cells)
    headings = [section.heading for section in case_sections(comparison) if not section.empty]
    assert headings == [section.heading for section in case_sections(comparison)]
    assert "Critical points and branches" not in headings


def test_every_probe_of_the_last_station_stands_once_in_the_tables_of_errors(comparison):
    errors = [table for table in tables_of(comparison) if table.title.startswith("Error")]
    quantities = ("Errors in displacement", "Errors in stress", "Errors in force and reaction", "Error in energy")
    assert [table.title for table in errors] == [f"{name} at load 0.67 N·m" for name in quantities]
    names = [row[0] for table in errors for row in table.rows]
    assert sorted(names) == sorted(probe.name for probe in comparison.scene.probes)
    rows = [row for row in comparison.rows if row.probe.name == "B.displacement"]
    worst = max(rows, key=lambda row: row.difference / row.denominator)
    share = percentage(cell(errors[0], "B.displacement", "largest error"))
    assert share == pytest.approx(worst.difference / worst.denominator, rel=5e-3)
    assert cell(errors[0], "B.displacement", "at") == f"load {worst.station:g} N·m"
    # reference: 2 mm over 3 times a radius of 25 mm
    assert cell(errors[1], "beam1.bending_stress", "t/(3R)") == "2.67 %"


@pytest.mark.parametrize("formulation", ["auto", "paper"])
def test_the_contact_model_has_a_table_in_both_formulations(formulation):
    """f is 1e-3 larger in ``paper``: 0.8·0.67·1e-3 of a rotation behind contact, over the finite elements' value."""
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    found = compare(paired(scene, Choices(formulation=formulation), solvers))
    shown = cell(titled(tables_of(found), "The formulation paper beside auto"), "BD.rotation", "at load 0.67 N·m")
    assert percentage(shown) == pytest.approx(0.8 * 0.67e-3 / (0.8 * 0.67 + 0.02), rel=1e-2)


def test_the_distance_of_paper_at_its_largest_and_at_its_last_station_and_why_it_ended():
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    runs = paired(scene, Choices(), solvers)
    whole = runs.answers["cprbm paper"]
    early = replace(
        whole,
        ending=Ending.LEFT_BOUNDARY,
        sentence="joint 3 presses beyond the end",
        stations=whole.stations[:4],
        notes=("the chord is held",),
    )
    for paper, last in ((whole, 0.67), (early, 0.268)):
        found = compare(replace(runs, answers={**runs.answers, "cprbm paper": paper}))
        table = titled(tables_of(found), "The formulation paper beside auto")
        rows = [row for row in found.rows if row.probe.name == "BD.rotation" and row.station <= last]
        shares = {row.station: contact_model(found.runs, row) / row.denominator for row in rows}
        worst = max(shares, key=shares.get)
        texts = [cell(table, "BD.rotation", header) for header in table.headers]
        assert table.headers[3] == f"at load {last:g} N·m"
        assert texts[2] == f"load {worst:g} N·m"
        assert percentage(texts[1]) == pytest.approx(shares[worst], rel=1e-2)
        assert percentage(texts[3]) == pytest.approx(shares[last], rel=1e-2)
        assert ("In paper: the chord is held." in table.note) is (paper is early)
        assert ("It ended before load 0.335 N·m: joint 3 presses beyond the end." in table.note) is (paper is early)
        assert all(contact_model(found.runs, row) is None for row in found.rows if row.station > last)
    without = compare(replace(runs, answers={name: runs.answers[name] for name in runs.answers if "paper" not in name}))
    assert without.verdict == found.verdict
    assert not [table for table in tables_of(without) if table.title == "The formulation paper beside auto"]


@pytest.mark.parametrize(("denominator", "text"), [(0.05, "804 %"), (0.04, "402 mN")])
def test_a_distance_above_tenfold_has_its_unit(comparison, denominator, text):
    """A force that the formulation ``paper`` changes by 0.402 N, as a share of a denominator."""
    row = [row for row in comparison.rows if row.probe.name == "contact.force"][-1]
    auto = comparison.runs.answers["cprbm"]
    changed = with_value("contact.force", row.cprbm + 0.402)(auto.stations[-1])
    paper = replace(auto, stations=(*auto.stations[:-1], changed))
    runs = replace(comparison.runs, answers={**comparison.runs.answers, "cprbm paper": paper})
    only = replace(comparison, runs=runs, rows=(replace(row, denominator=denominator),))
    assert cell(paper_table(only), "contact.force", "largest distance") == text


def test_both_theories_stand_in_one_table(comparison):
    """Made-up solvers: before contact shear adds 0.5 % to the displacements, of which the finite elements have 1."""
    table = titled(tables_of(comparison), "Both theories")
    assert table.headers == ("probe", "unit", "CPRBM in shear", "CPRBM in bending", "FEA in bending", "theory")
    row = next(row for row in comparison.rows if (row.probe.name, row.station) == ("BD.rotation", 0.67))
    assert float(cell(table, "BD.rotation", "CPRBM in shear")) == pytest.approx(row.other[0], rel=1e-3)
    share = percentage(cell(table, "BD.rotation", "theory"))
    assert share == pytest.approx(row.theory / row.denominator, rel=1e-2)


def test_a_row_of_the_branch_table_is_an_interval_of_stations(comparison):
    """Stations 3 to 5 and 8 of 10 lie between events: two intervals."""
    stations = comparison.scene.stages[0].stations
    between = replace(NO_EVENTS, branch=None)
    rows = tuple(
        replace(row, events=between) if stations.index(row.station) in (3, 4, 5, 8) else row for row in comparison.rows
    )
    found = [row for row in branch_table(replace(comparison, rows=rows)).rows if "between" in row[0]]
    assert [row[1:3] for row in found] == [("0.268 N·m to 0.402 N·m", "3"), ("0.603 N·m", "1")]


def test_one_answer_makes_its_own_tables(comparison):
    values, events = answer_tables(comparison.scene, comparison.runs.answers["cprbm"])
    assert [row[0] for row in values.rows] == [f"{station:g}" for station in comparison.scene.stages[0].stations]
    assert events.rows[0][:2] == ("load", "contact")


def test_a_case_takes_at_most_30_lines_of_80_columns_and_all_tables_come_with_v(right, capsys):
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
    _, full = printed(capsys, "hinge", "-v", solvers=right)
    assert any(line.startswith("Certificates") for line in full)
    assert not any(line.startswith("Certificates") for line in lines)


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


def test_the_worst_row_is_shown_and_values_below_their_floor_print_as_0(capsys):
    def spoilt(factor):
        def change(station):
            values = dict(station.values)
            values["A.reaction_moment"] = factor * values["A.reaction_moment"]
            values["A.reaction"] = np.array([values["A.reaction"][0], 1e-17])
            return replace(station, values=frozendict(values))

        return change

    solvers = Solvers(MadeUp("cprbm", 2e-3, spoilt=spoilt(1.2)), MadeUp("fea", -5e-4, spoilt=spoilt(1.0)))
    _, lines = printed(capsys, "hinge", solvers=solvers)
    assert next(line for line in lines if line.startswith("A.reaction_moment")).endswith("DIFFER")
    _, lines = printed(capsys, "hinge", "-v", solvers=solvers)
    assert next(line for line in lines if line.split()[:1] == ["A.reaction"]).count(", 0)") == 2


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


@pytest.mark.parametrize("width", [60, 72, 80])
def test_a_brief_report_keeps_to_the_terminal_and_cuts_no_number(comparison, width):
    offset = compared_offset(cases.asked("offset"))
    for found in (comparison, offset):
        lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in brief(found, "case", None, width).splitlines()]
        assert max(map(len, lines)) <= width
    text = "\n".join(lines)
    table = error_table(offset)
    assert all(cell in text for row in table.rows for cell in row)
    assert all(re.search(rf"^ *{row[0]} ", text, re.MULTILINE) for row in table.rows)
