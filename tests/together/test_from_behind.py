"""A beam that has gone round another's end, and presses that from the side on which it was not at rest."""

import pytest

import cprbm
import fea_reference
from cprbm_scene import scene_from

E, THICK, WIDE, TALL, HIGH = 2.1e9, 0.0011, 0.0093, 0.1, 0.053
SIDEWAYS = 7e-5
"""By how much the post is bent aside where it is pressed, m."""


def carried(*last):
    """A post, and a bar on its right that a sledge carries up, to the left over the post's tip, down, and back."""
    bar, up, left = 0.047, 0.08, 0.13
    beam = {"thickness": THICK, "width": WIDE, "material": "m"}
    start, end = [0.03, HIGH], [0.03 + bar, HIGH]
    touches = left - end[0] - THICK  # from there the sledge comes back to the right
    ways = {
        "up": ("y", [up]),
        "over": ("x", [-left]),
        "down": ("y", [0.0]),
        "back": ("x", [touches - left + each for each in last]),
    }
    return scene_from(
        {
            "name": "carried",
            "materials": {"m": {"youngs_modulus": E, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"O": [0.0, 0.0]}},
                "sledge": {"motion": "free", "points": {"S": start}},
            },
            "beams": {
                "post": {
                    **beam,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0, TALL]},
                    "start": {"joint": "weld", "point": "O"},
                    "end": {"joint": "free"},
                },
                "bar": {
                    **beam,
                    "curve": {"kind": "line", "start": start, "end": end},
                    "start": {"joint": "weld", "point": "S"},
                    "end": {"joint": "free"},
                },
            },
            "drives": {
                "x": {"kind": "displacement", "point": "S", "direction": [1.0, 0.0]},
                "y": {"kind": "displacement", "point": "S", "direction": [0.0, 1.0]},
                "turn": {"kind": "rotation", "body": "sledge"},
            },
            "contacts": {"touch": {"kind": "beam-beam", "between": ["post", "bar"]}},
            "stages": [{"name": name, "steps": steps, "stations": to} for name, (steps, to) in ways.items()],
            "probes": [{"of": "touch", "quantity": "force"}, {"of": "O", "quantity": "reaction_moment"}],
        }
    )


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
def test_what_is_carried_round_a_tip_presses_a_post_from_its_other_side(solver):
    """Reference: a cantilever pressed aside by w at the height h, F = 3EIw/h³; of w/h two thousandths are left."""
    scene = carried(-0.01, SIDEWAYS)
    if solver == "cprbm":
        answer = cprbm.answer(scene, cprbm.Settings(links=80))
    else:
        answer = fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="bending"))
    assert answer.completed, answer.sentence
    forces = [float(station.values["touch.force"][0]) for station in answer.stations]
    assert forces[:4] == [0.0] * 4
    force = 3.0 * E * (WIDE * THICK**3 / 12.0) * SIDEWAYS / HIGH**3
    assert forces[4] == pytest.approx(force, rel=2e-3)
    assert float(answer.stations[4].values["O.reaction_moment"][0]) == pytest.approx(force * HIGH, rel=2e-3)
