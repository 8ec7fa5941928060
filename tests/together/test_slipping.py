"""An end that presses on another beam's side and is drawn past the end of that: no equilibrium is near then.

A stout arm leans on a slender cantilever from above, at 50°, both as lines.  It is pressed down by δ and then drawn
towards the cantilever's end.  Without friction the force is normal to the cantilever, which is a cantilever loaded at
its end when the arm's tip comes there: by small deflections w = δ (3 u² − u³)/2 over u = x/L, so that its end is
∫ ½ w'² dx = 3 δ²/(5 L) short of L, and it holds 3 EI δ²/(2 L³).  Before, with the tip at x = a, the force is 3 EI δ/a³.
"""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, Loss, scene_from

L, T, B, E = 0.0913, 0.00071, 0.0123, 2.1e9
ARM = 0.0307
AT = 0.0871  # where the arm's tip stands at rest
PRESSED = 0.0037
SHORTER = 3.0 * PRESSED**2 / (5.0 * L)
SLIPS = L - SHORTER - AT
EI = E * B * T**3 / 12.0


def drawn_past_the_end(order):
    up = np.array([np.cos(np.radians(50.0)), np.sin(np.radians(50.0))])
    root = [float(AT + ARM * up[0]), float(ARM * up[1])]
    line = {"kind": "line"}
    return scene_from(
        {
            "name": "slipping",
            "materials": {"m": {"youngs_modulus": E, "poisson_ratio": 0.37}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "hand": {"motion": "free", "points": {"H": root}},
            },
            "beams": {
                "slender": {
                    "curve": {**line, "start": [0.0, 0.0], "end": [L, 0.0]},
                    "thickness": T,
                    "width": B,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "free"},
                },
                "arm": {
                    "curve": {**line, "start": root, "end": [AT, 0.0]},
                    "thickness": 8.0 * T,
                    "width": B,
                    "material": "m",
                    "start": {"joint": "weld", "point": "H"},
                    "end": {"joint": "free"},
                },
            },
            "drives": {
                "down": {"kind": "displacement", "point": "H", "direction": [0.0, -1.0]},
                "along": {"kind": "displacement", "point": "H", "direction": [1.0, 0.0]},
                "turn": {"kind": "rotation", "body": "hand"},
            },
            "contacts": {"touch": {"kind": "beam-beam", "between": order, "thick": False}},
            "stages": [
                {"name": "press", "steps": "down", "stations": [PRESSED]},
                {"name": "draw", "steps": "along", "stations": [0.0011, 0.0053]},
            ],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "touch", "quantity": "force"}],
        }
    )


SOLVED = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=40)),
    "fea": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=20, kinematics="bending")),
}


@pytest.mark.parametrize(
    ("solver", "order"),
    [("cprbm", ["slender", "arm"]), ("cprbm", ["arm", "slender"]), ("fea", ["slender", "arm"])],
)
def test_the_branch_ends_where_an_end_slips_off_another(solver, order):
    got = SOLVED[solver](drawn_past_the_end(order))
    assert got.ending is Ending.BRANCH_ENDS, got.sentence
    assert [station.value for station in got.stations] == [PRESSED, 0.0011]
    assert got.stations[0].values["touch.force"][0] == pytest.approx(3.0 * EI * PRESSED / AT**3, rel=5e-3)
    (critical,) = got.critical
    assert (critical.loss, critical.what) == (Loss.SLIP, "touch")
    assert critical.value == pytest.approx(SLIPS, abs=0.02 * SHORTER)
    assert critical.energy == pytest.approx(1.5 * EI * PRESSED**2 / L**3, rel=3e-3)


@pytest.mark.parametrize("order", [["slender", "arm"], ["arm", "slender"]])
def test_the_chain_jumps_from_an_end_to_what_is_left(order):
    # closed form: nothing touches any more, and what nothing presses stands straight, without energy
    asked = drawn_past_the_end(order)
    jumps = tuple(stage.model_copy(update={"beyond": "jump"}) for stage in asked.stages)
    got = SOLVED["cprbm"](asked.model_copy(update={"stages": jumps}))
    assert got.completed, got.sentence
    (critical,) = got.critical
    assert (critical.loss, critical.what) == (Loss.SLIP, "touch")
    assert critical.value == pytest.approx(SLIPS, abs=0.02 * SHORTER)
    assert critical.after == pytest.approx(0.0, abs=1e-12 * critical.energy)
    assert got.stations[-1].values["touch.force"] == pytest.approx([0.0], abs=0.0)


def bent_past_an_end(moments):
    """A cantilever bent by a moment M (N m) across a curved one, both thick, until an end passes the other."""
    curved = [[-0.021601, 0.0240269], [0.0068393, -0.0220891], [0.0094681, -0.0636223]]
    free = {"material": "m", "end": {"joint": "free"}}
    return scene_from(
        {
            "name": "bent-past",
            "materials": {"m": {"youngs_modulus": 1.14e11, "poisson_ratio": 0.33}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "Q": curved[0]}}},
            "beams": {
                "straight": {
                    **free,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0264413, -0.0724486]},
                    "thickness": 0.000406,
                    "width": 0.008,
                    "start": {"joint": "weld", "point": "R"},
                },
                "curved": {
                    **free,
                    "curve": {"kind": "spline", "points": curved},
                    "thickness": 0.000285,
                    "width": 0.018,
                    "start": {"joint": "weld", "point": "Q"},
                },
            },
            "loads": {"M": {"kind": "beam_moment", "beam": "straight", "at": 0.8}},
            "contacts": {
                "touch": {"kind": "beam-beam", "between": ["straight", "curved"]},
                "post": {
                    "kind": "beam-circle",
                    "beam": "straight",
                    "body": "wall",
                    "center": [0.0054029, -0.0226188],
                    "radius": 0.00231,
                },
            },
            "stages": [{"name": "bend", "steps": "M", "stations": moments}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "touch", "quantity": "force"}],
        }
    )


@pytest.mark.parametrize("solver", SOLVED)
def test_an_end_that_slips_in_a_long_step_is_told(solver):
    # reference: the same branch by steps that are short beside what the end has left to go
    ends = []
    for moments in ([-0.1927], [-0.12, -0.14, -0.155, -0.16, -0.164, -0.1927]):
        got = SOLVED[solver](bent_past_an_end(moments))
        assert got.ending is Ending.BRANCH_ENDS, got.sentence
        (critical,) = got.critical
        assert (critical.loss, critical.what) == (Loss.SLIP, "touch")
        ends.append(critical.value)
    assert ends[0] == pytest.approx(ends[1], rel=1e-4)


def test_a_corner_that_lifts_off_far_from_the_end_that_presses_slips_off_nothing():
    # a moment bends a cantilever over a circle: its end comes to lie on an edge, and lifts it off that edge's corner
    scene = scene_from(
        {
            "name": "lifted",
            "materials": {"titanium": {"youngs_modulus": 114e9, "poisson_ratio": 0.33}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}}},
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0202147, -0.0411207]},
                    "thickness": 0.000471,
                    "width": 0.00727,
                    "material": "titanium",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "free"},
                }
            },
            "loads": {"moment": {"kind": "beam_moment", "beam": "beam", "at": 0.45}},
            "contacts": {
                "edge": {
                    "kind": "beam-line",
                    "beam": "beam",
                    "body": "wall",
                    "points": [[0.0022016, -0.0050788], [0.020347, -0.0483042]],
                    "side": "left",
                },
                "circle": {
                    "kind": "beam-circle",
                    "beam": "beam",
                    "body": "wall",
                    "center": [0.0115869, -0.0299003],
                    "radius": 0.00102,
                },
            },
            "stages": [{"name": "bend", "steps": "moment", "stations": [-0.05374, -0.1075, -0.1612]}],
            "probes": [{"of": "scene", "quantity": "potential_energy"}, {"of": "circle", "quantity": "force"}],
        }
    )
    got, reference = (SOLVED[solver](scene) for solver in ("cprbm", "fea"))
    assert got.completed, got.sentence
    for mine, other in zip(got.stations, reference.stations, strict=True):
        for probe in ("scene.potential_energy", "circle.force"):
            assert mine.values[probe] == pytest.approx(other.values[probe], rel=5e-3)
