"""In shear, sections stay upright at a weld beside a touching circle or beam: the CPRBM against a closed form.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
F       force across at the tip; EI = L = 1
a       √(EI/GA)
======  =====================================================================================

The angle of shear tanh²(s/(√2 a)) F/GA adds a² F (1 − √2 a) to the displacement in bending, but for e^(−1/a).
"""

import math

import pytest

import cprbm
from cprbm_scene import Scene
from tests.fea_reference.test_upright import KAPPA, STOUT, layer, on_circle, on_its_like

FORCE = 0.02 * KAPPA
"""Too little to press the beam on anything."""


def sheared(scene: Scene, links: int) -> float:
    """Displacement of the tip in shear less the displacement in bending."""
    asked = {**scene.model_dump(), "probes": ({"of": "tip", "quantity": "displacement"},)}
    found = []
    for theory in ("shear", "bending"):
        answer = cprbm.answer(Scene.model_validate({**asked, "theory": theory}), cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        found.append(answer.stations[0].values["tip.displacement"][1])
    return float(found[0] - found[1])


@pytest.mark.parametrize("links", [20, 80])
@pytest.mark.parametrize("scene", [on_circle, on_its_like])
def test_a_weld_keeps_a_part_of_the_shear(scene, links):
    a = layer(STOUT)
    expected = -FORCE * a**2 * (1.0 - math.sqrt(2.0) * a)
    assert sheared(scene(STOUT, FORCE), links) == pytest.approx(expected, rel=2e-3)


def test_a_weld_apart_from_the_circle_keeps_none():
    a, plain = layer(STOUT), on_circle(STOUT, FORCE).model_dump()
    plain["contacts"]["edge"]["radius"] -= 0.2 * a
    assert sheared(Scene.model_validate(plain), 20) == pytest.approx(-FORCE * a**2, rel=2e-3)
