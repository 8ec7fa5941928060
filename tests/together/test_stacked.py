"""Three cantilevers, one of which is in both contacts: both solvers against exact elastica."""

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, scene_from
from tests.references.three_cantilevers import Stack, solve

STACK = Stack(gap=0.05, reach=1.6, middle=1.1, lower=0.95, force=6.0)
L, T, WIDTH, YOUNG = 0.1, 1e-4, 0.01, 2e11
EI = YOUNG * WIDTH * T**3 / 12


def _beam(start, end, at, tip):
    return {
        "curve": {"kind": "line", "start": start, "end": end},
        "thickness": T,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": "weld", "point": at},
        "end": tip,
    }


def stacked():
    h, a, free = STACK.gap * L, STACK.reach * L, {"joint": "free"}
    return scene_from(
        {
            "name": "stacked",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.0, h], "V": [a, 0.0], "W": [0.0, -h]}},
                "end": {"motion": "free", "points": {"tip": [L, h]}},
            },
            "beams": {
                "upper": _beam([0.0, h], [L, h], "U", {"joint": "weld", "point": "tip"}),
                "middle": _beam([a, 0.0], [a - STACK.middle * L, 0.0], "V", free),
                "lower": _beam([0.0, -h], [STACK.lower * L, -h], "W", free),
            },
            "loads": {"F": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {
                "first": {"kind": "beam-beam", "between": ["upper", "middle"], "thick": False},
                "second": {"kind": "beam-beam", "between": ["middle", "lower"], "thick": False},
            },
            "stages": [{"name": "load", "steps": "F", "stations": [STACK.force * EI / L**2]}],
            "probes": [
                {"of": "tip", "quantity": "displacement"},
                {"of": "end", "quantity": "rotation"},
                {"of": "first", "quantity": "force"},
                {"of": "second", "quantity": "force"},
                *({"of": point, "quantity": "reaction_moment"} for point in "UVW"),
            ],
        }
    )


def _errors(got, exact):
    """Differences from the exact answer, each over its exact magnitude."""
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[0].values
    moves = np.array(values["tip.displacement"]) / L - (exact.tip - [1.0, STACK.gap])
    numbers = {
        "tip": np.hypot(*moves) / np.hypot(*(exact.tip - [1.0, STACK.gap])),
        "rotation": values["end.rotation"][0] / exact.rotation - 1.0,
    }
    for name, force in zip(("first", "second"), exact.forces, strict=True):
        numbers[name] = values[f"{name}.force"][0] * L**2 / EI / force - 1.0
    for point, moment in zip("UVW", exact.moments, strict=True):
        numbers[point] = abs(values[f"{point}.reaction_moment"][0]) * L / EI / abs(moment) - 1.0
    return {name: abs(float(value)) for name, value in numbers.items()}


@pytest.fixture(scope="module")
def exact():
    return solve(STACK)


def test_small_loads_share_as_springs():
    """Straight beams: (F − P1)/3 = h + w(σ1) and w(b) = h + P2 σ2³/3, w per force at ξ x² (3 ξ − x)/6."""
    h, force, at, b, rests = 1e-6, 1e-4, 0.6, 1.1, 0.5
    found = solve(Stack(gap=h, reach=1.0 + at, middle=b, lower=0.95, force=force))
    near, across, far = at**3 / 3.0, at**2 * (3.0 * b - at) / 6.0, b**3 / 3.0
    shares = np.linalg.solve(
        [[1.0 / 3.0 + near, -across], [across, -far - rests**3 / 3.0]],
        [force / 3.0 - h, h],
    )
    assert found.forces == pytest.approx(tuple(shares), rel=1e-5)


def test_the_cprbm_converges_to_the_exact_stack(exact):
    """All within 0.4 % at 20 links; the displacement with second order."""
    coarse, fine = (_errors(cprbm.answer(stacked(), cprbm.Settings(links=n)), exact) for n in (20, 40))
    assert max(coarse.values()) < 4e-3
    assert max(fine.values()) < 1e-3
    assert coarse["tip"] > 3.0 * fine["tip"]


def test_the_finite_elements_are_the_exact_stack(exact):
    """The penetration of lines is a fraction of the beam's length: 1e-6 of it, as asked, is all that is left."""
    settings = fea_reference.Settings(elements=20, kinematics="bending", penetration=1e-6)
    assert max(_errors(fea_reference.answer(stacked(), settings), exact).values()) < 5e-4


def test_many_short_elements_do_not_let_a_tip_through(exact):
    """The first contact closes early, and a step after it is long beside an element of a 160th of the beam."""
    settings = fea_reference.Settings(elements=160, kinematics="bending", penetration=1e-6)
    assert max(_errors(fea_reference.answer(stacked(), settings), exact).values()) < 5e-4
