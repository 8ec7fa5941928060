"""A beam that is pressed over corners of a rigid edge, against an elastica with a point force normal to it."""

import math

import numpy as np
import pytest

import cprbm
from cprbm import newton
from cprbm.corner import corners_of
from cprbm.edge import REACH
from cprbm.faces import faces_of, sides_of
from cprbm.kinematics import positions, rest_state
from cprbm.mechanism import mechanism_of
from cprbm_scene import HalfPlaneContact, LineContact
from tests.fea_reference.on_an_edge import T, cantilever_over, scene_of
from tests.references.cornered import Cornered

AT, FORCE = (0.5, -0.02), 3.0
ROOF = ((0.2, -0.3), AT, (0.8, -0.3))
SHELF = ((0.0, -0.02), AT)
CLOSED = (AT, (0.8, -0.3), (0.2, -0.3), AT)
SHARP = ((0.5, -0.6), AT, (0.7, -0.5))


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1].values


def errors_of(values, exact):
    """Of the force, of its place, of the tip's place and of the energy."""
    assert values["edge.ends"][0] == values["edge.ends"][1]
    return np.array(
        [
            abs(values["edge.force"][0] / exact.pressed - 1.0),
            abs(values["edge.ends"][0] - exact.place),
            np.hypot(*(values["tip.displacement"] + [1.0, 0.0] - exact.tip)),
            abs(values["scene.potential_energy"][0] / exact.potential_energy - 1.0),
        ]
    )


@pytest.mark.parametrize("thick", [False, True])
def test_the_errors_fall_with_the_fourth_power_of_the_number_of_links(thick):
    # shooting finds the reference to 1e-9; 0.5 is a joint of 41 links, and between joints of the others
    exact = Cornered(FORCE, AT, 0.5 * T if thick else 0.0)
    scene = cantilever_over({"kind": "beam-line", "points": ROOF, "side": "left", "thick": thick}, force=FORCE)
    for n in (10, 20, 41, 80):
        assert np.all(errors_of(solved(scene, n), exact) < np.maximum(0.2 / n**4, 3e-9))


@pytest.mark.parametrize("points", [SHELF, SHARP, CLOSED, ROOF[::-1]])
def test_a_corner_is_the_same_whatever_lies_behind_it(points):
    side = "right" if points == ROOF[::-1] else "left"
    scene = cantilever_over({"kind": "beam-line", "points": points, "side": side, "thick": True}, force=FORCE)
    assert np.all(errors_of(solved(scene, 40), Cornered(FORCE, AT, 0.5 * T)) < 0.2 / 40**4)


def turned(place, about, angle):
    (x, y), (u, v) = place, about
    cos, sin = math.cos(angle), math.sin(angle)
    return (u + cos * (x - u) - sin * (y - v), v + sin * (x - u) + cos * (y - v))


def on_a_wheel(*, thick, turn=0.4):
    """The roof drawn turned back, and brought to where it is in :func:`cantilever_over` by its wheel."""
    pivot = (0.6, -0.5)
    points = tuple(turned(place, pivot, -turn) for place in ROOF)
    return scene_of(
        {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
        {"joint": "weld", "point": "root"},
        {"joint": "weld", "point": "tip"},
        {"kind": "beam-line", "body": "wheel", "points": points, "side": "left", "thick": thick},
        bodies={
            "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
            "wheel": {"motion": "turns", "about": "pivot", "points": {"pivot": pivot}},
            "block": {"motion": "free", "points": {"tip": (1.0, 0.0)}},
        },
        loads={"P": {"kind": "force", "point": "tip", "direction": (0.0, -1.0)}},
        drives={"r": {"kind": "rotation", "body": "wheel"}},
        stages=(("P", (FORCE,)), ("r", (turn,))),
        probes=(
            ("tip", "displacement"),
            ("edge", "force"),
            ("edge", "ends"),
            ("scene", "potential_energy"),
            ("wheel", "reaction_moment"),
        ),
    )


@pytest.mark.parametrize("thick", [False, True])
def test_a_corner_on_a_body_that_turns(thick, monkeypatch):
    # the corner arrives where the other one is; its moment about the pivot is that of N; and both forms of Newton's
    # system give one answer
    exact = Cornered(FORCE, AT, 0.5 * T if thick else 0.0)
    values = solved(on_a_wheel(thick=thick), 40)
    assert np.all(errors_of(values, exact) < 1.5 / 40**2)
    push = -exact.pressed * np.array([-math.sin(exact.leaning), math.cos(exact.leaning)])
    arm = np.array(AT) - (0.6, -0.5)
    assert values["wheel.reaction_moment"][0] == pytest.approx(-(arm[0] * push[1] - arm[1] * push[0]), abs=2e-3)
    monkeypatch.setattr(newton, "MANY", 0)
    other = solved(on_a_wheel(thick=thick), 40)
    for name, value in values.items():
        assert other[name] == pytest.approx(value, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("thick", [False, True])
def test_from_a_face_to_a_corner_nothing_jumps(thick):
    """A block with a flat top presses a beam that bulges towards it, and goes sideways from under it."""
    top = -0.5 * T if thick else 0.0
    h = 0.004
    scene = scene_of(
        {
            "kind": "arc",
            "center": (0.0, 1.0),
            "start": (-math.sin(0.5), 1.0 - math.cos(0.5)),
            "end": (math.sin(0.5), 1.0 - math.cos(0.5)),
            "direction": "counterclockwise",
        },
        {"joint": "weld", "point": "root"},
        {"joint": "free"},
        {
            "kind": "beam-line",
            "body": "block",
            "points": ((-0.1, top), (0.1, top), (0.15, top - 0.1)),
            "side": "left",
            "thick": thick,
        },
        bodies={
            "ground": {"motion": "fixed", "points": {"root": (-math.sin(0.5), 1.0 - math.cos(0.5))}},
            "block": {"motion": "free", "points": {"foot": (0.0, -0.5)}},
        },
        drives={
            "up": {"kind": "displacement", "point": "foot", "direction": (0.0, 1.0)},
            "aside": {"kind": "displacement", "point": "foot", "direction": (-1.0, 0.0)},
            "turn": {"kind": "rotation", "body": "block"},
        },
        stages=(("up", (0.01,)), ("aside", tuple(0.11 + h * k for k in range(11)))),
        probes=(("edge", "force"), ("edge", "centre"), ("foot", "reaction"), ("scene", "potential_energy")),
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=20))
    assert answer.completed, answer.sentence
    values = [station.values for station in answer.stations[1:]]
    energy, force, place = (
        np.array([each[probe][0] for each in values])
        for probe in ("scene.potential_energy", "foot.reaction", "edge.centre")
    )
    # on the flat top nothing pushes the block aside, on its corner it does
    on_top = np.abs(force) < 1e-9
    assert on_top[0]
    assert not on_top[-1]
    assert list(on_top) == sorted(on_top, reverse=True)
    assert np.all(np.abs(np.diff(place)) < 2.0 * h)
    # what the drive does is what the energy gains: the trapezium rule's error is of the size of force's change
    done = -0.5 * h * (force[:-1] + force[1:])
    assert np.diff(energy) == pytest.approx(done, abs=0.1 * h * np.max(np.abs(np.diff(force))))


def test_where_an_edge_stands_out():
    # a convex and a hollow corner, and the two ends, between the normals of what meets there
    line = LineContact(
        kind="beam-line",
        beam="beam",
        body="wall",
        points=((0.0, 0.0), (1.0, 0.0), (2.0, -1.0), (3.0, -1.0)),
        side="left",
    )
    pieces = faces_of(line, 1.0, (0.0, 0.0))
    corners = sorted(corners_of(pieces, sides_of(pieces)), key=lambda corner: corner.place)
    assert [corner.ends for corner in corners] == [True, False, True]
    assert [corner.place for corner in corners] == [(0.0, 0.0), (1.0, 0.0), (3.0, -1.0)]
    half = math.sqrt(0.5)
    assert corners[0].before == pytest.approx((-1.0, 0.0))
    assert corners[0].behind == pytest.approx((0.0, 1.0))
    assert corners[1].behind == pytest.approx((half, half))
    assert corners[2].behind == pytest.approx((1.0, 0.0))
    normals = np.array([[0.0, 1.0], [0.1, 1.0], [half, half], [-0.1, 1.0], [1.0, 0.9], [-0.3, -1.0]])
    assert list(np.sign(np.round(corners[1].beyond(normals), 12))) == [0.0, 1.0, 0.0, -1.0, -1.0, -1.0]


def test_what_is_rigid_behind_an_edge_ends_where_its_sides_meet():
    # a gable of equal legs: both sides go back at right angles to them, and meet below its ridge; a hollow edge's part
    gable = LineContact(
        kind="beam-line", beam="beam", body="wall", points=((-3.0, -1.0), (0.0, 0.0), (3.0, -1.0)), side="left"
    )
    first, last = sides_of(faces_of(gable, 1.0, (0.0, 0.0)))
    # from (3, −1) on along −(1, 3) to x = 0
    assert np.array(last.ends) == pytest.approx(np.array([[3.0, -1.0], [0.0, -10.0]]))
    assert np.array(first.ends) == pytest.approx(np.array([[0.0, -10.0], [-3.0, -1.0]]))
    assert last.normal == pytest.approx((3.0 / math.sqrt(10.0), -1.0 / math.sqrt(10.0)))
    hollow = gable.model_copy(update={"points": ((-3.0, 1.0), (0.0, 0.0), (3.0, 1.0))})
    assert [side.high for side in sides_of(faces_of(hollow, 1.0, (0.0, 0.0)))] == [math.inf, math.inf]
    # a straight edge without ends, and one that goes round, have none
    round_it = gable.model_copy(update={"points": (*gable.points, gable.points[0])})
    half_plane = HalfPlaneContact(kind="beam-half-plane", beam="beam", body="wall", point=(0.0, 0.0), normal=(1.0, 2.0))
    assert sides_of(faces_of(round_it, 1.0, (0.0, 0.0))) == sides_of(faces_of(half_plane, 1.0, (0.0, 0.0))) == ()


def apart(one, other):
    """The least distance of two segments (2, 2) that do not cross."""
    found = []
    for places, (begin, end) in ((one, other), (other, one)):
        along = end - begin
        share = np.clip((places - begin) @ along / (along @ along), 0.0, 1.0)
        found.append(np.linalg.norm(places - begin - share[:, None] * along, axis=1).min())
    return min(found)


def crossing(one, other):
    """Whether two segments (2, 2) cross."""

    def sides(of, places):
        (ux, uy), r = of[1] - of[0], places - of[0]
        return ux * r[:, 1] - uy * r[:, 0]

    return sides(one, other).prod() < 0.0 and sides(other, one).prod() < 0.0


def test_a_beam_that_passes_a_triangle_is_as_far_from_it_as_from_its_sides():
    # reference: the distances of segments.  A sharp corner's normals are those, too, of beams that pass another side
    # of it; behind it they would be as deep as they are far away
    rng = np.random.default_rng(41)
    beam, checked, passing = np.array([[0.0, 0.0], [1.0, 0.0]]), 0, 0
    for _ in range(100):
        corners = rng.uniform((0.1, -0.25), (0.9, 0.25)) + 0.17 * rng.standard_normal((3, 2))
        (ux, uy), (vx, vy) = corners[1] - corners[0], corners[2] - corners[0]
        corners = corners if ux * vy < uy * vx else corners[::-1]  # clockwise: what is free is on the left
        sides = [np.array(side) for side in zip(corners, np.roll(corners, -1, axis=0), strict=True)]
        if any(crossing(beam, side) for side in sides):
            continue
        points = tuple(map(tuple, [*corners.tolist(), corners[0].tolist()]))
        scene = cantilever_over({"kind": "beam-line", "points": points, "side": "left", "thick": False})
        made = mechanism_of(scene, cprbm.Settings(links=13))
        rest = rest_state(made.problem.model)
        at, edge = positions(made.problem.model, rest), made.pairs["edge"]
        away = min(apart(beam, side) for side in sides) / edge.unit_length
        # what is farther than any row is known by samples alone
        assert edge.least_gap(rest, at) >= away - 1e-9
        assert edge.least_gap(rest, at) <= away + 1e-9 or away > REACH
        assert all(np.all(group.values <= 1e-12 - away) for group in edge.groups(rest, at))
        checked += 1
        passing += any(group.values.size for group in edge.groups(rest, at))
    assert checked > 40
    assert passing > 12
