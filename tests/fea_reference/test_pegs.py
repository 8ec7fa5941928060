"""A cantilever between two close pegs: the frame and the sense of the beam leave the answer as it is."""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer

LENGTH, THICKNESS, WIDTH, YOUNG = 0.1, 0.001, 0.01, 2e11
EI = YOUNG * WIDTH * THICKNESS**3 / 12.0
PLACES = np.array([0.55, 0.6]) * LENGTH
FORCE = 0.02 * EI / LENGTH**2


def pegged(angle=0.0, *, backward=False):
    """Values of the last station, as (peg above, peg below, size of the root's reaction)."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    ends = [("A", [0.0, 0.0]), ("T", list(turn @ [LENGTH, 0.0]))]
    (start, first), (end, last) = reversed(ends) if backward else ends
    away = 0.5 * THICKNESS + 0.003
    got = answer(
        scene_from(
            {
                "name": "pegs",
                "theory": "bending",
                "materials": {"steel": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
                "bodies": {
                    "ground": {"motion": "fixed", "points": {"A": ends[0][1]}},
                    "tip": {"motion": "free", "points": {"T": ends[1][1]}},
                },
                "beams": {
                    "beam": {
                        "curve": {"kind": "line", "start": first, "end": last},
                        "thickness": THICKNESS,
                        "width": WIDTH,
                        "material": "steel",
                        "start": {"joint": "weld", "point": start},
                        "end": {"joint": "weld", "point": end},
                    }
                },
                "loads": {"F": {"kind": "force", "point": "T", "direction": list(turn @ [0.0, -1.0])}},
                "contacts": {
                    name: {
                        "kind": "beam-circle",
                        "beam": "beam",
                        "body": "ground",
                        "center": list(turn @ [place, side * away]),
                        "radius": 0.003,
                    }
                    for name, place, side in zip(("above", "below"), PLACES, (1.0, -1.0), strict=True)
                },
                "stages": [{"name": "push", "steps": "F", "stations": [0.1 * FORCE, FORCE]}],
                "probes": [
                    {"of": "above", "quantity": "force"},
                    {"of": "below", "quantity": "force"},
                    {"of": "A", "quantity": "reaction"},
                ],
            }
        ),
        Settings(elements=20, kinematics="bending"),
    )
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[-1].values
    return np.array([values["above.force"][0], values["below.force"][0], np.hypot(*values["A.reaction"])])


def flexibility(place, other):
    """Deflection at one place by a unit force at another."""
    near, far = np.minimum(place, other), np.maximum(place, other)
    return near**2 * (3.0 * far - near) / (6.0 * EI)


def test_the_pegs_hold_their_places():
    """Small deflections: the forces that leave both places where they are."""
    by_tip = FORCE * flexibility(PLACES, LENGTH)
    forces = np.linalg.solve(flexibility(PLACES[:, None], PLACES), by_tip)
    assert pegged()[:2] == pytest.approx(np.abs(forces), rel=2e-3)


@pytest.mark.parametrize(("angle", "backward"), [(np.radians(37.0), False), (0.0, True), (np.radians(37.0), True)])
def test_the_frame_and_the_sense_of_the_beam_change_nothing(angle, backward):
    assert pegged(angle, backward=backward) == pytest.approx(pegged(), rel=3e-8)
