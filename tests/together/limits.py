"""To where the chain's values go as links grow short, beside what the finite elements have there."""

from __future__ import annotations

import pytest

import cprbm
import fea_reference
from cprbm_scene import Answer, Ending, Scene


def check(scene: Scene, links: int, rel: float) -> Answer:
    """Of every probe at every station, errors of the chain falling with the square of the link.

    The finite elements have 40 to a beam, in bending; the chain ``links`` and twice as many, whose answer is returned.
    """
    true = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    coarse, fine = (cprbm.answer(scene, cprbm.Settings(links=n)) for n in (links, 2 * links))
    assert {one.ending for one in (true, coarse, fine)} == {Ending.COMPLETED}
    for a, b, known in zip(coarse.stations, fine.stations, true.stations, strict=True):
        for probe, value in known.values.items():
            limit = (4.0 * b.values[probe] - a.values[probe]) / 3.0
            assert limit == pytest.approx(value, rel=rel), (probe, b.value)
    return fine
