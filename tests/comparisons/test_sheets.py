"""The tables: as many cells as headers, and no figure that hides what it stands for."""

import re

import pytest

from comparisons import cases, sheets, tables
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.verdict import compared
from tests.comparisons.made_up import MadeUp


@pytest.fixture(scope="module")
def comparison():
    """Two solvers that differ by a few parts in ten million."""
    scene = cases.opened("hinge")
    return compared(scene, paired(scene, Choices(), Solvers(MadeUp("cprbm", 2e-7), MadeUp("fea", -5e-8))))


def cell(sheet, row, header):
    return next(line for line in sheet.rows if line[0] == row)[sheet.headers.index(header)]


def test_every_row_has_a_cell_for_every_header(comparison):
    found = sheets.of_comparison(comparison)
    assert len(found) == 6
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


def test_one_answer_makes_its_own_tables(comparison):
    values, events = sheets.of_answer(comparison.scene, comparison.runs.cprbm[0])
    assert len(values.rows) == len(comparison.scene.probes)
    assert events.rows[0][:2] == ("load", "contact")


def test_a_table_keeps_to_its_width(comparison):
    plain = re.compile("\x1b\\[[0-9;]*m")
    for sheet in sheets.of_comparison(comparison):
        lines = plain.sub("", tables.drawn(sheet, width=100)).splitlines()
        assert max(map(len, lines)) <= 100
