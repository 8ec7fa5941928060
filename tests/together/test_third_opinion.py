"""The solid beside both solvers."""

import numpy as np
import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.opinions import solid_sentence, thirds_of
from comparisons.pairing import Solvers, paired, with_solid
from comparisons.present.brief import brief
from comparisons.present.json_document import comparison
from comparisons.present.row_tables import solid_table
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, straight


@pytest.fixture(scope="module")
def thick():
    """A cantilever nine times as long as thick under a small force, by all three."""
    scene = bar(straight(0.31), 0.034, stations=(0.011,), probes=(("tip", "displacement"), ("beam", "bending_stress")))
    return compare(paired(scene, Choices(links=8, elements=16), with_solid(Solvers())))


def test_what_bending_alone_misses_is_timoshenkos_shear(thick):
    # 6 P L/(5 G A), less what the held ends keep from warping
    (one,) = (found.third for found in thirds_of(thick) if found.probe.quantity == "displacement")
    shear = 1.2 * 0.011 * 0.31 / (0.5 * YOUNG * WIDTH * 0.034)
    # both solvers answer in the scene's theory, bending; the CPRBM's other theory is shear
    for bending in (one.cprbm, one.fea):
        assert 0.8 * shear < bending < shear + one.uncertainty
    assert one.other < 0.2 * shear
    assert one.uncertainty < 0.02 * shear


def test_the_stress_of_a_straight_cantilever_is_the_beams(thick):
    # M t/(2 I) away from its ends, linear elasticity's own (Timoshenko & Goodier, section 21)
    (one,) = (found.third for found in thirds_of(thick) if found.probe.quantity == "bending_stress")
    s = np.linspace(0.0, 0.31, 81)
    inner = (s > 0.034) & (s < 0.31 - 0.034)
    exact = 0.011 * (0.31 - s) * 6 / (WIDTH * 0.034**2)
    assert np.abs(one.solid - exact)[inner].max() < 2e-3 * exact.max()


def test_three_columns_are_told(thick):
    sheet = solid_table(thick)
    assert {"CPRBM", "FEA", "solid"} <= set(sheet.headers)
    assert len(sheet.rows) == 2
    assert "in bending (finite elements)" in solid_sentence(thick)
    assert "in shear (CPRBM)" in solid_sentence(thick)
    assert solid_sentence(thick) in " ".join(brief(thick, "thick.toml").split())
    document = comparison(thick)
    assert document["solvers"]["solid"]["ending"] == "COMPLETED"
    assert {row["probe"] for row in document["solid"]} == {"tip.displacement", "beam.bending_stress"}
