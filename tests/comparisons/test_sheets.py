"""The tables: as many cells as headers, and no figure that hides what it stands for."""

import re
from dataclasses import replace

import pytest

from comparisons import cases, sheets, tables
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.paper_sheets import of_paper
from comparisons.sheet import Sheet, without_empty
from comparisons.steps import contact_model
from cprbm_scene import Ending
from tests.verdict.made_up import MadeUp, with_value


@pytest.fixture(scope="module")
def comparison():
    """Two solvers that differ by a few parts in ten million."""
    scene = cases.opened("hinge")
    return compare(scene, paired(scene, Choices(), Solvers(MadeUp("cprbm", 2e-7), MadeUp("fea", -5e-8))))


def cell(sheet, row, header):
    return next(line for line in sheet.rows if line[0] == row)[sheet.headers.index(header)]


def test_every_row_has_a_cell_for_every_header(comparison):
    found = sheets.of_comparison(comparison)
    assert len(found) == 8
    for sheet in found:
        assert {len(row) for row in sheet.rows} == {len(sheet.headers)}


def test_no_small_error_reads_as_nothing(comparison):
    cells = [cell for sheet in sheets.of_comparison(comparison) for row in sheet.rows for cell in row]
    assert not [cell for cell in cells if re.fullmatch(r"-?0\.0+ %", cell)]
    assert any("e-05 %" in cell for cell in cells)


def test_the_curved_beam_correction_is_the_hinges(comparison):
    """t/(3R) = 2 / 75."""
    stresses = next(sheet for sheet in sheets.of_comparison(comparison) if "t/(3R)" in sheet.headers)
    assert cell(stresses, "beam1.bending_stress", "t/(3R)") == "2.67 %"


def test_there_is_one_explanation_per_claim(comparison):
    sentences = sheets.explanation(comparison)
    assert [sentence.split()[0] for sentence in sentences] == ["B.displacement", "D.displacement"]
    assert "0.620 %" in sentences[0]
    assert "0.810 %" in sentences[1]


@pytest.mark.parametrize(("formulation", "said"), [("auto", "would put the CPRBM"), ("paper", "in the contact model")])
def test_the_contact_model_has_a_column_and_a_word(formulation, said):
    scene, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", 0.0))
    found = compare(scene, paired(scene, Choices(formulation=formulation), solvers))
    sheet = next(sheet for sheet in sheets.of_comparison(found) if "contact model" in sheet.headers)
    row = next(row for row in found.rows if row.probe.name == "BD.rotation" and row.station == 0.67)
    share = 100 * contact_model(found.runs, row) / row.denominator
    assert float(cell(sheet, "BD.rotation", "contact model").removesuffix(" %").lstrip("-")) == pytest.approx(
        share, 1e-2
    )
    assert said in sheets.explanation(found)[0]


def test_by_how_much_paper_is_off_at_most_and_at_last_and_why():
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
        sheet = next(
            sheet for sheet in sheets.of_comparison(found) if sheet.title == "The formulation paper beside auto"
        )
        rows = [row for row in found.rows if row.probe.name == "BD.rotation" and row.station <= last]
        shares = {row.station: contact_model(found.runs, row) / row.denominator for row in rows}
        worst = max(shares, key=shares.get)
        said = [cell(sheet, "BD.rotation", header) for header in sheet.headers]
        assert sheet.headers[3] == f"at load {last:g} N·m"
        assert said[2] == f"load {worst:g} N·m"
        for told, station in ((said[1], worst), (said[3], last)):
            assert float(told.removesuffix(" %")) == pytest.approx(100.0 * shares[station], rel=1e-2)
        assert ("In paper: the chord is held." in sheet.note) is (paper is early)
        assert ("It ended before load 0.335 N·m: joint 3 presses beyond the end." in sheet.note) is (paper is early)
        assert all(contact_model(found.runs, row) is None for row in found.rows if row.station > last)


@pytest.mark.parametrize(("denominator", "told"), [(0.05, "804 %"), (0.04, "402 mN")])
def test_what_is_more_than_tenfold_is_told_as_it_is(comparison, denominator, told):
    """A force that the formulation ``paper`` changes by 0.402 N, as a share of a denominator."""
    row = [row for row in comparison.rows if row.probe.name == "contact.force"][-1]
    auto = comparison.runs.cprbm[0]
    changed = with_value("contact.force", row.cprbm + 0.402)(auto.stations[-1])
    runs = replace(comparison.runs, paper=replace(auto, stations=(*auto.stations[:-1], changed)))
    only = replace(comparison, runs=runs, rows=(replace(row, denominator=denominator),))
    assert cell(of_paper(only), "contact.force", "off by at most") == told


def test_without_a_whole_answer_in_paper_the_column_is_left_out_and_the_verdict_is_the_same(comparison):
    early = replace(
        comparison.runs.cprbm[0], ending=Ending.LEFT_BOUNDARY, stations=comparison.runs.cprbm[0].stations[:3]
    )
    for paper in (early, None):
        found = compare(comparison.scene, replace(comparison.runs, paper=paper))
        assert found.verdict == comparison.verdict
        steps = next(sheet for sheet in sheets.of_comparison(found) if sheet.title.startswith("What the difference"))
        assert "contact model" not in steps.headers
        assert (Ending.LEFT_BOUNDARY.value in steps.note) is (paper is not None)


def test_one_answer_makes_its_own_tables(comparison):
    values, events = sheets.of_answer(comparison.scene, comparison.runs.cprbm[0])
    assert [row[0] for row in values.rows] == [f"{station:g}" for station in comparison.scene.stages[0].stations]
    assert events.rows[0][:2] == ("load", "contact")


def test_a_table_keeps_to_its_width(comparison):
    plain = re.compile("\x1b\\[[0-9;]*m")
    for sheet in sheets.of_comparison(comparison):
        lines = plain.sub("", tables.drawn(sheet, width=100)).splitlines()
        assert max(map(len, lines)) <= 100


def test_a_column_without_any_value_is_left_out():
    found = without_empty(Sheet("ratios", ("N", "IPOPT", "ours"), (("10", "–", "1.3"), ("20", "–", "–")), "medians"))
    assert found == Sheet("ratios", ("N", "ours"), (("10", "1.3"), ("20", "–")), "medians")
