"""A beam that is pressed over corners of a rigid edge, against an elastica with a point force normal to it."""

import math

import numpy as np
import pytest

import cprbm
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


def polyline_around(at, slope):
    """A round edge of straight pieces, three in a link of 40; the ``slope`` lies between both pieces beside ``at``."""
    angles = slope - 0.06 * (np.arange(16) - 7.5)
    pieces = 0.008 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points = np.concatenate([np.zeros((1, 2)), np.cumsum(pieces, axis=0)])
    return tuple(map(tuple, np.array(at) + points - points[8]))


@pytest.mark.parametrize("links", [20, 40, 41])
def test_a_beam_touches_a_fine_polyline_at_a_corner(links):
    exact = Cornered(FORCE, AT, 0.5 * T)
    points = polyline_around(AT, exact.leaning)
    scene = cantilever_over({"kind": "beam-line", "points": points, "side": "left", "thick": True}, force=FORCE)
    assert np.all(errors_of(solved(scene, links), exact) < 0.2 / links**4)


@pytest.mark.parametrize("points", [SHELF, SHARP, CLOSED, ROOF[::-1]])
def test_a_corner_is_the_same_whatever_lies_behind_it(points):
    side = "right" if points == ROOF[::-1] else "left"
    scene = cantilever_over({"kind": "beam-line", "points": points, "side": side, "thick": True}, force=FORCE)
    assert np.all(errors_of(solved(scene, 40), Cornered(FORCE, AT, 0.5 * T)) < 0.2 / 40**4)


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


@pytest.mark.parametrize("turned_over", [False, True])
def test_a_round_tip_meets_the_ramp_behind_a_concave_corner(turned_over):
    # geometry: the tip's circle of the half thickness touches the ramp while the tip is still over the flat; until then
    # the flat, below the tip, is nearer than the ramp
    corner, ramp = (1.03, -0.0054), math.radians(30.0)
    closing = corner[0] - 1.0 + (-corner[1] * math.cos(ramp) - 0.5 * T) / math.sin(ramp)
    points = ((0.9, corner[1]), corner, (corner[0] + math.cos(ramp), corner[1] + math.sin(ramp)))
    edge = {"kind": "beam-line", "body": "nose", "points": points, "side": "left"}
    if turned_over:
        edge |= {"points": tuple(points[::-1]), "side": "right"}
    scene = scene_of(
        {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
        {"joint": "weld", "point": "root"},
        {"joint": "free"},
        edge,
        bodies={
            "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
            "nose": {"motion": "slides", "along": (1.0, 0.0), "points": {"tip": corner}},
        },
        drives={"in": {"kind": "displacement", "point": "tip", "direction": (-1.0, 0.0)}},
        stages=(("in", (1.02 * closing, 1.1 * closing)),),
        probes=(("edge", "force"),),
    )
    for links in (20, 43):
        answer = cprbm.answer(scene, cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        (event,) = answer.events
        assert event.value == pytest.approx(closing, rel=1e-9)
        # small deflections: the tip rises by what the ramp moves beyond the closing
        for station, beyond in zip(answer.stations, (0.02, 0.1), strict=True):
            rise = beyond * closing * math.tan(ramp)
            assert station.values["edge.force"][0] * math.cos(ramp) == pytest.approx(3.0 * rise, rel=0.01, abs=1e-9)
