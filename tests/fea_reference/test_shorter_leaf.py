"""The end of a short leaf pressed on a longer one: both leaves bend alike, and each bears half of the force.

Both lie on each other without pressure up to the end of the shorter leaf. The elements of the longer leaf are wider,
and the contact in a point must not be taken for a contact in an area.
"""

import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

LENGTH, THICKNESS, WIDTH, YOUNG = 0.1, 0.001, 0.01, 2e11
EI = YOUNG * WIDTH * THICKNESS**3 / 12.0


def leaves(share, order):
    """A leaf of a ``share`` of the lower leaf's length, at zero gap above it, under small forces down at its tip."""
    heights, lengths = {"lower": 0.0, "upper": THICKNESS}, {"lower": LENGTH, "upper": share * LENGTH}
    force = 0.01 * EI / LENGTH**2
    return scene_from(
        {
            "name": "leaves",
            "theory": "bending",
            "materials": {"steel": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {f"root-{name}": [0.0, y] for name, y in heights.items()}},
                **{
                    f"tip-of-{name}": {"motion": "free", "points": {f"tip-{name}": [lengths[name], y]}}
                    for name, y in heights.items()
                },
            },
            "beams": {
                name: {
                    "curve": {"kind": "line", "start": [0.0, y], "end": [lengths[name], y]},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "steel",
                    "start": {"joint": "weld", "point": f"root-{name}"},
                    "end": {"joint": "weld", "point": f"tip-{name}"},
                }
                for name, y in heights.items()
            },
            "loads": {"F": {"kind": "force", "point": "tip-upper", "direction": [0.0, -1.0]}},
            "contacts": {"k": {"kind": "beam-beam", "between": order}},
            "stages": [{"name": "press", "steps": "F", "stations": [0.1 * force, force]}],
            "probes": [{"of": "k", "quantity": "force"}, {"of": "tip-upper", "quantity": "displacement"}],
        }
    )


@pytest.mark.parametrize(("share", "elements", "order"), [(0.5, 80, ["lower", "upper"]), (0.8, 40, ["upper", "lower"])])
def test_both_leaves_bear_half_of_the_force(share, elements, order):
    got = answer(leaves(share, order), Settings(elements=elements, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    for station in got.stations:
        half = 0.5 * station.value
        assert station.values["k.force"][0] == pytest.approx(half, rel=2e-3)
        deflection = half * (share * LENGTH) ** 3 / (3.0 * EI)
        assert station.values["tip-upper.displacement"][1] == pytest.approx(-deflection, rel=1e-3)
