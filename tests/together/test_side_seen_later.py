"""An arch drawn over the end of another beam, beyond whose reach it ends at rest: its side of that is seen on the way.

At rest no place of the beam below has a closest point on the arch, whose root in turn lies across from it on the other
side: the end below is what is nearest once the arch has come over it.
"""

import pytest

import cprbm
import elastica_reference
import fea_reference
from cprbm_scene import Ending, scene_from
from tests.together import limits


def arch_over_an_end():
    root, tip = [0.0461496, 0.0185081], [0.0064772, 0.0659698]
    material = {"material": "m"}
    return scene_from(
        {
            "name": "arch",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": root}},
                "tip": {"motion": "free", "points": {"T": tip}},
            },
            "beams": {
                "arch": {
                    **material,
                    "curve": {
                        "kind": "arc",
                        "center": [0.014323886923516098, 0.03189649863360206],
                        "start": [0.0, 0.0],
                        "end": tip,
                        "direction": "clockwise",
                    },
                    "thickness": 0.00033,
                    "width": 0.0116,
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                },
                "below": {
                    **material,
                    "curve": {"kind": "line", "start": root, "end": [0.0105549, 0.057178]},
                    "thickness": 0.000291,
                    "width": 0.0053,
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"F": {"kind": "force", "point": "T", "direction": [0.7, -0.71]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["arch", "below"]}},
            "stages": [{"name": "draw", "steps": "F", "stations": [0.0075]}],
            "probes": [{"of": "T", "quantity": "displacement"}, {"of": "touch", "quantity": "force"}],
        }
    )


@pytest.fixture(scope="module")
def truth():
    return elastica_reference.answer(arch_over_an_end()).stations[0].values


def test_an_end_below_an_arch_is_met_whichever_side_is_seen_first(truth):
    """Reference: the exact answer."""
    got = fea_reference.answer(arch_over_an_end(), fea_reference.Settings(elements=40, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[0].values
    assert values["T.displacement"] == pytest.approx(truth["T.displacement"], rel=2e-5)
    assert values["touch.force"] == pytest.approx(truth["touch.force"], rel=2e-4)


def test_the_chain_meets_it_too(truth):
    """Reference: the exact answer; errors fall with the square of the link."""
    coarse, fine = (cprbm.answer(arch_over_an_end(), cprbm.Settings(links=n)) for n in (40, 80))
    assert coarse.completed, coarse.sentence
    assert fine.completed, fine.sentence
    for probe, value in truth.items():
        limit = (4.0 * fine.stations[0].values[probe] - coarse.stations[0].values[probe]) / 3.0
        assert limit == pytest.approx(value, rel=1e-4), probe


def folded_up(*moments):
    """A leg and a shin, which a moment folds up under a strip above: the knee comes to stand on the strip from below.

    The strip lies beyond the shin's upper end at rest, in part on one side of the shin's line, in part on the other.
    """
    knee, foot, root = [0.288751, 0.22035], [0.44062, -0.046291], [0.563142, 0.390112]
    steel = {"material": "steel"}
    strip = [root, [0.428804, 0.350636], [0.2694, 0.287228], [0.114363, 0.25954]]
    return scene_from(
        {
            "name": "folded-up",
            "materials": {"steel": {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": root}},
                "knee": {"motion": "free", "points": {"K": knee}},
            },
            "beams": {
                "leg": {
                    **steel,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": knee},
                    "thickness": 0.00143,
                    "width": 0.0752,
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "K"},
                },
                "shin": {
                    **steel,
                    "curve": {"kind": "line", "start": knee, "end": foot},
                    "thickness": 0.00159,
                    "width": 0.0607,
                    "start": {"joint": "weld", "point": "K"},
                    "end": {"joint": "free"},
                },
                "strip": {
                    **steel,
                    "curve": {"kind": "spline", "points": strip, "end_direction": [-1.013, -0.099]},
                    "thickness": 0.00141,
                    "width": 0.0427,
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"M": {"kind": "beam_moment", "beam": "shin", "at": 0.52}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["shin", "strip"], "thick": False}},
            "stages": [{"name": "fold", "steps": "M", "stations": list(moments)}],
            "probes": [{"of": "K", "quantity": "displacement"}, {"of": "touch", "quantity": "force"}],
        }
    )


def test_a_strip_that_lies_beyond_a_shins_end_is_touched_on_the_side_on_which_it_comes_to_lie():
    """Reference: the finite elements; errors of the chain fall with the square of the link."""
    scene = folded_up(5.1, 10.2, 12.1, 15.4)
    limits.check(scene, 20, rel=1e-3)
