"""Stability of a column between circles that touch without force: contact forbids a motion in a single sense."""

import pytest

import cprbm
from cprbm_scene import Ending, Loss, scene_from
from tests.references.small import euler_load_pinned

LENGTH, THICKNESS, WIDTH, MODULUS = 0.0931, 0.0011, 0.0083, 7.1e10
RADIUS = 0.0043


def column(*sides):
    """A perfect pinned column with circles at the middle on the ``sides``, all touching as drawn."""
    away = RADIUS + 0.5 * THICKNESS
    circles = {
        f"c{k}": {
            "kind": "beam-circle",
            "beam": "beam",
            "body": "ground",
            "center": [0.5 * LENGTH, side * away],
            "radius": RADIUS,
        }
        for k, side in enumerate(sides)
    }
    return scene_from(
        {
            "name": "column",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": MODULUS, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0]}},
                "top": {"motion": "slides", "along": [1.0, 0.0], "points": {"B": [LENGTH, 0.0]}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "pin", "point": "A"},
                    "end": {"joint": "pin", "point": "B"},
                }
            },
            "contacts": circles,
            "loads": {"P": {"kind": "force", "point": "B", "direction": [-1.0, 0.0]}},
            "stages": [{"name": "load", "steps": "P", "stations": [euler(0.5), euler(5.0)], "beyond": "stop"}],
            "probes": [{"of": "B", "quantity": "displacement"}],
        }
    )


def euler(times):
    return times * euler_load_pinned(MODULUS * WIDTH * THICKNESS**3 / 12.0, LENGTH)


@pytest.mark.parametrize("links", [20, 21])
@pytest.mark.parametrize(("sides", "times"), [((1.0, -1.0), 4.0), ((1.0,), 1.0), ((-1.0,), 1.0)])
def test_a_touching_circle_forbids_one_sense_of_a_mode(sides, times, links):
    # Euler: a half wave where the middle is free on one side, two half waves between circles on both sides
    answer = cprbm.answer(column(*sides), cprbm.Settings(links=links))
    (critical,) = answer.critical
    assert answer.ending is Ending.BRANCH_ENDS
    assert critical.loss is Loss.BIFURCATION
    assert critical.value == pytest.approx(euler(times), rel=1e-3)
