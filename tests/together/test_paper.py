"""The paper's contact in the verdict: its error is uneven in N, and its stated uncertainty must know that.

At an even number of links the hinge's contact falls between two joints, at an odd one on a joint
(tests/cprbm/test_hinge.py holds both against the exact solution).
"""

import numpy as np
import pytest

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.verdict import Word
from comparisons.verdict.rows import rows_of
from tests.cprbm.scenes import hinge
from tests.references import hinge as exact


@pytest.mark.parametrize(("links", "word"), [(20, Word.UNDECIDED), (41, Word.AGREE)])
def test_the_verdict_at_even_and_odd_numbers_of_links(links, word):
    scene = hinge(stages=[{"name": "load", "steps": "M", "stations": [0.2, 0.67]}])
    runs = paired(scene, Choices(links=links, elements=30, formulation="paper", kinematics="bending"), Solvers())
    assert compare(runs).verdict.word is word
    # reference: tests.references.hinge
    truth = exact.solve(exact.PAPER, 0.67)
    true = {"B.displacement": truth.displacement_B, "contact.force": [truth.contact_force]}
    for row in rows_of(runs):
        if row.probe.name in true and row.station == 0.67:
            assert row.bounds is not None
            assert np.linalg.norm(row.cprbm - true[row.probe.name]) <= row.bounds.cprbm
