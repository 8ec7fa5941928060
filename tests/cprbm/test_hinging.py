"""Pins between bodies: derivatives, and linkages of pinned bodies against statics and geometry."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.together.pivots import FORCE, LENGTH, MATERIALS, MOMENT, STRIP, line, pin, weld

D = (1.1, 0.2)
CRANK, COUPLER, FOLLOWER = 0.4, 0.9, 0.7


def meeting(a, d, r, s):
    """The upper one of the two places at distances r from a and s from d."""
    a, d = np.array(a), np.array(d)
    way = d - a
    size = np.hypot(*way)
    along = (size**2 + r**2 - s**2) / (2.0 * size)
    return a + (along * way + np.sqrt(r**2 - along**2) * np.array([-way[1], way[0]])) / size


def four_bar(*, pinned, spring=False):
    """Crank OA, coupler AB and follower DB, lengths in LENGTH, the crank upright; beside them an idle beam.

    With ``pinned`` the crank is held on the ground by a pin in the place of a pivot; the ``spring`` is a beam that the
    follower drags along.
    """
    a = np.array([0.0, CRANK])
    b = meeting(a, D, COUPLER, FOLLOWER)
    far = b + np.array([1.0, 0.5])

    def at(place):
        return [float(LENGTH * coordinate) for coordinate in place]

    crank = {"points": {"O": at((0.0, 0.0)), "A": at(a)}} | (
        {"motion": "free"} if pinned else {"motion": "turns", "about": "O"}
    )
    bodies = {
        "ground": {"motion": "fixed", "points": {"W": at((-3.0, 0.0)), "O_ground": at((0.0, 0.0)), "S": at(far)}},
        "crank": crank,
        "coupler": {"motion": "free", "points": {"mid": at(0.5 * (a + b)), "A_c": at(a), "B_c": at(b)}},
        "follower": {"motion": "turns", "about": "D", "points": {"D": at(D), "B": at(b)}},
    }
    pins = {"at_A": {"points": ["A", "A_c"]}, "at_B": {"points": ["B_c", "B"]}}
    if pinned:
        pins["at_O"] = {"points": ["O_ground", "O"]}
    start, end = at((-3.0, 0.0)), at((-2.0, 0.0))
    idle = {**STRIP, "curve": line(start, end), "start": weld("W"), "end": {"joint": "free"}}
    drag = {**STRIP, "curve": line(at(b), at(far)), "start": pin("B"), "end": weld("S")}
    return {
        "name": "four-bar",
        "theory": "bending",
        "materials": MATERIALS,
        "bodies": bodies,
        "pins": pins,
        "beams": {"idle": idle} | ({"drag": drag} if spring else {}),
    }


@pytest.mark.parametrize("pinned", [False, True])
def test_a_four_bar_linkage_goes_where_its_lengths_say(pinned):
    # reference: where two circles meet
    angles = [0.3, -0.7]
    scene = scene_from(
        {
            **four_bar(pinned=pinned),
            "drives": {"turn": {"kind": "rotation", "body": "crank"}},
            "stages": [{"name": "turn", "steps": "turn", "stations": angles}],
            "probes": [
                {"of": "B", "quantity": "displacement"},
                {"of": "follower", "quantity": "rotation"},
                {"of": "crank", "quantity": "reaction_moment"},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=5))
    assert answer.completed, answer.sentence
    drawn = meeting((0.0, CRANK), D, COUPLER, FOLLOWER)
    for station, angle in zip(answer.stations, angles, strict=True):
        b = meeting((-CRANK * np.sin(angle), CRANK * np.cos(angle)), D, COUPLER, FOLLOWER)
        assert station.values["B.displacement"] == pytest.approx(LENGTH * (b - drawn), abs=1e-9 * LENGTH)
        turned = np.arctan2(*(b - D)[::-1]) - np.arctan2(*(drawn - D)[::-1])
        assert station.values["follower.rotation"] == pytest.approx([turned], abs=1e-9)
        assert station.values["crank.reaction_moment"] == pytest.approx([0.0], abs=1e-9 * MOMENT)


@pytest.mark.parametrize("pinned", [False, True])
def test_forces_in_a_linkage_that_a_drive_holds(pinned):
    # reference: statics. A force on the coupler's middle; the follower is a two-force member, along DB
    scene = scene_from(
        {
            **four_bar(pinned=pinned),
            "loads": {"P": {"kind": "force", "point": "mid", "direction": [0.3, -0.7]}},
            "drives": {"turn": {"kind": "rotation", "body": "crank"}},
            "stages": [{"name": "pull", "steps": "P", "stations": [FORCE]}],
            "probes": [
                {"of": "O_ground" if pinned else "O", "quantity": "reaction"},
                {"of": "D", "quantity": "reaction"},
                {"of": "crank", "quantity": "reaction_moment"},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=5))
    assert answer.completed, answer.sentence
    values, certificate = answer.stations[0].values, answer.stations[0].certificate
    a, b = np.array([0.0, CRANK]), meeting((0.0, CRANK), D, COUPLER, FOLLOWER)
    load = FORCE * np.array([0.3, -0.7]) / np.hypot(0.3, 0.7)
    along = (b - D) / FOLLOWER

    def cross(one, other):
        return one[0] * other[1] - one[1] * other[0]

    # moments about A of the coupler
    push = -cross(0.5 * (b - a), load) / cross(b - a, along)
    at_o = -load - push * along
    assert values["D.reaction"] == pytest.approx(push * along, abs=1e-9 * FORCE)
    assert values["O_ground.reaction" if pinned else "O.reaction"] == pytest.approx(at_o, abs=1e-9 * FORCE)
    assert values["crank.reaction_moment"] == pytest.approx([cross(a, at_o) * LENGTH], abs=1e-9 * MOMENT)
    assert max(certificate.force_balance, certificate.moment_balance) < 1e-9
