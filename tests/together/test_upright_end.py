"""Ends of both beams press each other's sides, then only the one, which comes to stand upright on the other beam.

The end of a clamped strip leans on a beam whose own end is driven round until that meets the strip from below; there
the first end lets go.  Along the strip nothing is seen of the driven end before it has sunk in, and once it stands
upright the strip lies on both of its sides.  The chain of links is the reference, and the other mesh.
"""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import read

SCENE = Path(__file__).parent / "scenes" / "upright.toml"


@pytest.mark.parametrize("elements", [20, 40])
def test_an_end_that_comes_to_stand_upright_presses_on(elements):
    scene = read(SCENE)
    chain = cprbm.answer(scene, cprbm.Settings(links=80))
    beams = fea_reference.answer(scene, fea_reference.Settings(elements=elements, kinematics="bending"))
    for answer in (chain, beams):
        assert answer.completed, answer.sentence
    for one, other in zip(chain.stations, beams.stations, strict=True):
        for probe in ("scene.potential_energy", "contact1.force"):
            assert one.values[probe] == pytest.approx(other.values[probe], rel=1e-3)
        np.testing.assert_allclose(
            one.values["T.displacement"], other.values["T.displacement"], rtol=0.0, atol=2e-5, strict=True
        )
