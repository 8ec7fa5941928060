"""The tables of a comparison: as many cells as headers, errors by quantity, and no small number that reads as zero."""

import re
from dataclasses import replace

import pytest

from comparisons import cases
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.contact_model import contact_model
from comparisons.pairing import Solvers, paired
from comparisons.present.answer_tables import answer_tables
from comparisons.present.case_tables import case_sections
from comparisons.present.row_tables import paper_table
from comparisons.present.table import screen_text
from cprbm_scene import Ending
from tests.tables import tables_of
from tests.verdict.made_up import MadeUp, with_value


@pytest.fixture(scope="module")
def comparison():
    """Two solvers that differ by a few parts in ten million."""
    scene = cases.opened("hinge")
    return compare(scene, paired(scene, Choices(), Solvers(MadeUp("cprbm", 2e-7), MadeUp("fea", -5e-8))))


def cell(table, row, header):
    return next(line for line in table.rows if line[0] == row)[table.headers.index(header)]


def titled(tables, start):
    return next(table for table in tables if table.title.startswith(start))


def test_every_row_has_a_cell_for_every_header(comparison):
    found = tables_of(comparison)
    for table in found:
        assert {len(row) for row in table.rows} == {len(table.headers)}
    assert len({table.title for table in found}) == len(found)


def test_every_probe_of_the_last_station_stands_once_in_the_tables_of_errors(comparison):
    errors = [table for table in tables_of(comparison) if table.title.startswith("Error")]
    assert [table.title for table in errors] == [
        f"{name} at load 0.67 N·m"
        for name in ("Errors in displacement", "Errors in stress", "Errors in force and reaction", "Error in energy")
    ]
    names = [row[0] for table in errors for row in table.rows]
    assert sorted(names) == sorted(probe.name for probe in comparison.scene.probes)


def test_the_largest_error_over_all_stations_stands_beside_the_last(comparison):
    table = titled(tables_of(comparison), "Errors in displacement")
    rows = [row for row in comparison.rows if row.probe.name == "B.displacement"]
    worst = max(rows, key=lambda row: row.difference / row.denominator)
    assert float(cell(table, "B.displacement", "largest error").removesuffix(" %")) == pytest.approx(
        100.0 * worst.difference / worst.denominator, rel=5e-3
    )
    assert cell(table, "B.displacement", "at") == f"load {worst.station:g} N·m"


def test_no_small_error_reads_as_nothing(comparison):
    cells = [cell for table in tables_of(comparison) for row in table.rows for cell in row]
    assert not [cell for cell in cells if re.fullmatch(r"-?0\.0+ %", cell)]
    assert any("e-05 %" in cell for cell in cells)


def test_the_curved_beam_correction_is_the_hinges(comparison):
    """t/(3R) = 2 / 75."""
    stresses = next(table for table in tables_of(comparison) if "t/(3R)" in table.headers)
    assert cell(stresses, "beam1.bending_stress", "t/(3R)") == "2.67 %"


@pytest.mark.parametrize("formulation", ["auto", "paper"])
def test_the_contact_model_has_a_table_in_both_formulations(formulation):
    """f is 1e-3 larger in ``paper``: 0.8·0.67·1e-3 of a rotation behind contact, over the finite elements' value."""
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    found = compare(scene, paired(scene, Choices(formulation=formulation), solvers))
    table = titled(tables_of(found), "The formulation paper beside auto")
    shown = cell(table, "BD.rotation", "at load 0.67 N·m")
    assert float(shown.removesuffix(" %")) == pytest.approx(100.0 * 0.8 * 0.67e-3 / (0.8 * 0.67 + 0.02), rel=1e-2)


def test_the_distance_of_paper_at_its_largest_and_at_its_last_station_and_why_it_ended():
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    runs = paired(scene, Choices(), solvers)
    assert runs.paper is not None
    early = replace(
        runs.paper,
        ending=Ending.LEFT_BOUNDARY,
        sentence="joint 3 presses beyond the end",
        stations=runs.paper.stations[:4],
        notes=("the chord is held",),
    )
    for paper, last in ((runs.paper, 0.67), (early, 0.268)):
        found = compare(scene, replace(runs, paper=paper))
        table = titled(tables_of(found), "The formulation paper beside auto")
        rows = [row for row in found.rows if row.probe.name == "BD.rotation" and row.station <= last]
        shares = {row.station: contact_model(found.runs, row) / row.denominator for row in rows}
        worst = max(shares, key=shares.get)
        texts = [cell(table, "BD.rotation", header) for header in table.headers]
        assert table.headers[3] == f"at load {last:g} N·m"
        assert texts[2] == f"load {worst:g} N·m"
        for text, station in ((texts[1], worst), (texts[3], last)):
            assert float(text.removesuffix(" %")) == pytest.approx(100.0 * shares[station], rel=1e-2)
        assert ("In paper: the chord is held." in table.note) is (paper is early)
        assert ("It ended before load 0.335 N·m: joint 3 presses beyond the end." in table.note) is (paper is early)
        assert all(contact_model(found.runs, row) is None for row in found.rows if row.station > last)


@pytest.mark.parametrize(("denominator", "text"), [(0.05, "804 %"), (0.04, "402 mN")])
def test_a_distance_above_tenfold_has_its_unit(comparison, denominator, text):
    """A force that the formulation ``paper`` changes by 0.402 N, as a share of a denominator."""
    row = [row for row in comparison.rows if row.probe.name == "contact.force"][-1]
    auto = comparison.runs.cprbm[0]
    changed = with_value("contact.force", row.cprbm + 0.402)(auto.stations[-1])
    runs = replace(comparison.runs, paper=replace(auto, stations=(*auto.stations[:-1], changed)))
    only = replace(comparison, runs=runs, rows=(replace(row, denominator=denominator),))
    assert cell(paper_table(only), "contact.force", "largest distance") == text


def test_without_a_complete_answer_in_paper_the_column_is_left_out_and_the_verdict_is_the_same(comparison):
    early = replace(
        comparison.runs.cprbm[0], ending=Ending.LEFT_BOUNDARY, stations=comparison.runs.cprbm[0].stations[:3]
    )
    for paper in (early, None):
        found = compare(comparison.scene, replace(comparison.runs, paper=paper))
        assert found.verdict == comparison.verdict
        tables = [table for table in tables_of(found) if table.title == "The formulation paper beside auto"]
        assert bool(tables) is (paper is not None)
        assert all(Ending.LEFT_BOUNDARY.value in table.note for table in tables)


def test_both_theories_stand_in_one_table(comparison):
    """Made-up solvers: before contact shear adds 0.5 % to the displacements, of which the finite elements have 1."""
    table = titled(tables_of(comparison), "Both theories")
    assert table.headers == ("probe", "unit", "CPRBM in shear", "CPRBM in bending", "FEA in bending", "theory")
    row = next(row for row in comparison.rows if (row.probe.name, row.station) == ("BD.rotation", 0.67))
    assert float(cell(table, "BD.rotation", "CPRBM in shear")) == pytest.approx(row.other[0], rel=1e-3)
    share = float(cell(table, "BD.rotation", "theory").removesuffix(" %"))
    assert share == pytest.approx(100.0 * row.theory / row.denominator, rel=1e-2)


def test_one_answer_makes_its_own_tables(comparison):
    values, events = answer_tables(comparison.scene, comparison.runs.cprbm[0])
    assert [row[0] for row in values.rows] == [f"{station:g}" for station in comparison.scene.stages[0].stations]
    assert events.rows[0][:2] == ("load", "contact")


def test_a_table_keeps_to_its_width(comparison):
    plain = re.compile("\x1b\\[[0-9;]*m")
    for table in tables_of(comparison):
        lines = plain.sub("", screen_text(table, width=100)).splitlines()
        assert max(map(len, lines)) <= 100


def test_sections_without_content_are_left_out(comparison):
    assert not [section for section in case_sections(comparison) if section.empty]
    assert "Critical points and branches" not in [section.heading for section in case_sections(comparison)]
