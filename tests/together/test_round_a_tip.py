"""A long arc that is wound down round the tip of another beam, until its own end is on the other's far side."""

from pathlib import Path

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm.contact import NO_ROWS
from cprbm.kinematics import State
from cprbm.march import March
from cprbm.nearest import BEHIND
from cprbm.point import point_at
from cprbm_scene import Ending, read, scene_from
from tests.cprbm.lagrangian import check
from tests.together import limits

SCENES = Path(__file__).parent / "scenes"
THICK, THIN = 9.58e-05, 7.75e-05
"""Of the arc and of the other, m.

From a moment of 2.304e-5 N·m on the arc's end presses the other from behind (finite elements).
"""


def wound(*moments, thin=THIN, thick=True):
    material, tip = {"material": "m"}, [0.0154861, -0.0032692]
    return scene_from(
        {
            "name": "wound",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": tip}}},
            "beams": {
                "arc": {
                    **material,
                    "curve": {
                        "kind": "arc",
                        "center": [0.009368026153168073, 0.005955237838734915],
                        "start": [0.0, 0.0],
                        "end": [0.0147978, 0.0156373],
                        "direction": "clockwise",
                    },
                    "thickness": THICK,
                    "width": 0.00198,
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "free"},
                },
                "tip": {
                    **material,
                    "curve": {"kind": "spline", "points": [tip, [0.0112901, 0.0046755], [0.0075953, 0.0098835]]},
                    "thickness": thin,
                    "width": 0.00247,
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "loads": {"M": {"kind": "beam_moment", "beam": "arc", "at": 0.55}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["arc", "tip"], "thick": thick}},
            "stages": [{"name": "wind", "steps": "M", "stations": [-one for one in moments]}],
            "probes": [{"of": "touch", "quantity": "force"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


@pytest.mark.parametrize("thick", [True, False])
def test_what_has_come_round_a_tip_does_not_lie_across_it(thick):
    """Reference: the finite elements; errors of the chain fall with the square of the link.

    The arc goes past the tip at half of both thicknesses, aslant: places of it that face the tip's side from behind
    are as near, and a link is twenty times as long.
    """
    scene = wound(2.04e-05, 2.2e-05, 2.29e-05, thick=thick)
    limits.check(scene, 40, rel=2e-3)


@pytest.mark.parametrize("links", [37, 80])
def test_a_line_that_is_pressed_on_an_end_comes_round_it(links):
    """Reference: the finite elements.  Behind the end the line is no farther from the other than round-off at first."""
    scene = read(SCENES / "round-a-root.toml")
    true = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    got = cprbm.answer(scene, cprbm.Settings(links=links))
    assert {true.ending, got.ending} == {Ending.COMPLETED}
    for probe, value in true.stations[-1].values.items():
        assert np.linalg.norm(got.stations[-1].values[probe] - value) < 25.0 / links**2 * np.linalg.norm(value), probe


def test_what_presses_from_behind_is_pressed_there_and_goes_the_same_way_back():
    """Reference: the finite elements; errors of the chain fall with the square of the link."""
    scene = wound(2.2e-05, 2.4e-05, 2.8e-05, 2.40001e-05, 2.20001e-05)
    fine = limits.check(scene, 40, rel=1e-4)
    for there, back in ((1, 3), (0, 4)):
        one, other = fine.stations[there], fine.stations[back]
        assert other.value == pytest.approx(one.value, rel=1e-5)
        assert other.values["touch.force"] == pytest.approx(one.values["touch.force"], rel=1e-4)


@pytest.mark.parametrize("thin", [THIN, {"at": [0.0, 1.0], "values": [THIN, 0.9 * THIN]}], ids=["even", "tapered"])
@pytest.mark.parametrize("links", [{"arc": 23, "tip": 31}, {"arc": 31, "tip": 23}], ids=["rows on arc", "rows on tip"])
def test_derivatives_of_gaps_from_behind_and_of_the_lagrangian(thin, links):
    """Reference: central differences, beside a state in which the arc's end presses from behind."""
    asked = cprbm.Settings(links=links)
    march = March(wound(2.2e-05, 2.4e-05, thin=thin), (asked,))
    assert march.run()[0] is Ending.COMPLETED
    problem, found = march.on.mechanism.problem, march.on.point
    assert any(key >= BEHIND or key < -1 for key in (key for _, key in found.rows.pressed(found.lam)))
    values, random = {"M": -2.4e-05}, np.random.default_rng(99)
    state = State(found.state.theta + 1e-5 * random.standard_normal(problem.model.n_links), found.state.bodies)
    mu = random.standard_normal(problem.closure.rows)
    moved = point_at(problem, values, state, mu, np.zeros(0), NO_ROWS)
    check(
        problem, values, point_at(problem, values, state, mu, 0.5 + random.random(moved.rows.size), moved.rows), random
    )
