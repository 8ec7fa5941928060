"""Beams that lie on each other over a length: against an exact solution, and from a point to a length."""

from dataclasses import replace

import numpy as np
import pytest

import cprbm
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, MODULUS, RIGIDITY, THICKNESS, cantilever_data, drives_of
from tests.references.lying import Lying, Strip

# elements of one length where B has four for every five of A
PAIR = Lying(
    top=Strip(length=0.0973, thickness=1.03e-3, width=8.7e-3, youngs_modulus=2.03e11),
    bottom=Strip(length=0.8 * 0.0973, thickness=1.27e-3, width=8.7e-3, youngs_modulus=2.03e11),
    curvature=1.0 / 0.12,
    force=45.0,
)
LIKE = {n: {"A": n, "B": 4 * n // 5} for n in (20, 40, 80, 160)}
STEP = 1e-6


def scene_of(tip, clamp, center, radius, load, direction, order=("A", "B"), below=PAIR.bottom, turn=0.0, block=False):
    """An arc A from ``clamp`` to ``tip`` above a straight beam B along x, the force on A's tip; all of it turned.

    B's clamp is on the wall, or on a ``block`` that drives hold.
    """
    cos, sin = np.cos(turn), np.sin(turn)

    def place(x, y):
        return [float(cos * x - sin * y), float(sin * x + cos * y)]

    def beam(curve, strip, start, end):
        welds = {"start": {"joint": "weld", "point": start}, "end": {"joint": "weld", "point": end}}
        return {"curve": curve, "thickness": strip.thickness, "width": strip.width, "material": "m", **welds}

    arc = {"kind": "arc", "center": place(*center), "start": place(*clamp), "end": place(*tip)}
    line = {"kind": "line", "start": place(0.0, 0.0), "end": place(below.length, 0.0)}
    probes = [("T", "displacement"), ("S", "displacement"), ("tip", "rotation"), ("c", "force"), ("c", "centre")]
    probes += [("c", "ends"), ("R", "reaction"), ("R", "reaction_moment"), ("scene", "potential_energy")]
    wall, foot = {"R": place(*clamp)}, {"Q": place(0.0, 0.0)}
    held = {"block": {"motion": "free", "points": foot}} if block else {}
    return scene_from(
        {
            "name": "lying",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": below.youngs_modulus, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": wall if block else {**wall, **foot}},
                **held,
                "tip": {"motion": "free", "points": {"T": place(*tip)}},
                "end": {"motion": "free", "points": {"S": place(below.length, 0.0)}},
            },
            "beams": {
                "A": beam({**arc, "direction": "counterclockwise"}, PAIR.top, "R", "T"),
                "B": beam(line, below, "Q", "S"),
            },
            "contacts": {"c": {"kind": "beam-beam", "between": list(order)}},
            "drives": drives_of("Q", "block") if block else {},
            "loads": {"P": {"kind": "force", "point": "T", "direction": place(*direction)}},
            "stages": [{"name": "load", "steps": "P", "stations": [load]}],
            "probes": [{"of": of, "quantity": quantity} for of, quantity in probes],
        }
    )


def lying(pair=PAIR, **changes):
    """A and B clamped beside each other, as in the reference."""
    T, R = pair.distance, 1.0 / pair.curvature
    angle = pair.curvature * pair.top.length
    tip = (R * np.sin(angle), T + R * (1.0 - np.cos(angle)))
    pull = (np.cos(pair.pull), np.sin(pair.pull))
    return scene_of(tip, (0.0, T), (0.0, T + R), R, pair.force, pull, below=pair.bottom, **changes)


def bowl(load, **changes):
    """A comes down on B from a clamp above it: first at a point, then over a length, with B's free end beyond."""
    below = replace(PAIR.bottom, length=0.0811, thickness=1.8e-3)
    x, R = 0.045, 0.12
    y = 0.5 * (PAIR.top.thickness + below.thickness) + 2e-4 + R

    def height(at):
        return y - np.sqrt(R**2 - (at - x) ** 2)

    tip = (0.0973, height(0.0973))
    return scene_of(tip, (0.0, height(0.0)), (x, y), R, load, (0.0, -1.0), below=below, **changes)


def test_the_ends_of_the_zone():
    # reference: tests.references.lying; the clamp is one end, the point of lift-off the other
    for links in (20, {"A": 40, "B": 32}, {"A": 40, "B": 53}):
        begin, end = solved(lying(), links).values["c.ends"]
        assert begin == 0.0
        assert end == pytest.approx(PAIR.lift_off[0], rel=1e-3)


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer.stations[-1]


def errors_of(station, pair=PAIR):
    values, L = station.values, pair.top.length
    return {
        "displacement": np.hypot(*(values["T.displacement"] - pair.displacement)) / L,
        "below": np.hypot(*(values["S.displacement"] - pair.bottom_displacement)) / L,
        "rotation": abs(values["tip.rotation"][0] - pair.rotation),
        "energy": abs(values["scene.potential_energy"][0] / pair.potential_energy - 1.0),
        "force": abs(values["c.force"][0] / np.hypot(*pair.contact_force) - 1.0),
        "centre": abs(values["c.centre"][0] - pair.contact_centre) / L,
        "reaction": np.hypot(*(values["R.reaction"] - pair.reaction[0])) / pair.force,
        "moment": abs(values["R.reaction_moment"][0] / pair.reaction_moment[0] - 1.0),
    }


@pytest.fixture(scope="module")
def like():
    return {n: errors_of(solved(lying(), links)) for n, links in LIKE.items() if n < 160}


def test_the_shape_converges(like):
    # reference: tests.references.lying
    for n, error in like.items():
        for name in ("displacement", "below", "rotation", "energy", "moment"):
            assert error[name] < 0.02 / n**2, name


def test_force_and_centre_beside_a_common_clamp_converge(like):
    # reference: tests.references.lying.  Clamp and contact share with first order, docs/contact-rules.md, 1
    for n, error in like.items():
        for name in ("force", "centre", "reaction"):
            assert error[name] < 0.1 / n, name


def test_a_common_clamp_is_one_too_where_drives_hold_one_of_the_beams(like):
    # reference: tests.references.lying, as where both are clamped to the wall
    error = errors_of(solved(lying(block=True), LIKE[20]))
    for name, value in error.items():
        assert value < (0.1 / 20 if name in ("force", "centre", "reaction") else 0.05 / 20**2), name


@pytest.mark.parametrize(
    "links", [41, 53, {"A": 40, "B": 83}, {"A": 83, "B": 40}], ids=["41", "53", "fine below", "fine above"]
)
def test_elements_of_any_lengths(links):
    # reference: tests.references.lying. How the clamp and the first elements share the force is of first order
    n = links if isinstance(links, int) else min(links.values())
    error = errors_of(solved(lying(), links))
    assert error["displacement"] < 0.25 / n**2
    assert error["energy"] < 0.4 / n**2
    assert error["moment"] < 0.06 / n
    assert error["force"] < 0.7 / n
    assert error["centre"] < 0.5 / n


@pytest.mark.parametrize("links", [40, {"A": 40, "B": 32}, {"A": 23, "B": 40}])
def test_which_beam_is_named_first_changes_no_more_than_the_mesh(links):
    # reference: no beam is first in nature.  Places lie at the joints of the first beam, a share of a link apart
    one, two = (solved(bowl(60.0, order=order), links).values for order in (("A", "B"), ("B", "A")))
    fewest = links if isinstance(links, int) else min(links.values())
    scales = {"T.displacement": 0.0973, "S.displacement": 0.0973, "c.force": 60.0, "R.reaction": 60.0}
    for name in (*scales, "scene.potential_energy"):
        assert np.max(np.abs(one[name] - two[name])) <= 0.8 / fewest**2 * scales.get(name, abs(one[name][0])), name


def test_a_turned_scene_turns_its_answer():
    flat, turned = (solved(lying(turn=turn), 31).values for turn in (0.0, 0.6458))
    cos, sin = np.cos(0.6458), np.sin(0.6458)
    expected = np.array([[cos, -sin], [sin, cos]]) @ flat["T.displacement"]
    assert turned["T.displacement"] == pytest.approx(expected, abs=1e-13)
    assert turned["c.force"] == pytest.approx(flat["c.force"], rel=1e-10)
    assert turned["c.centre"] == pytest.approx(flat["c.centre"], rel=1e-10)


@pytest.mark.parametrize("load", [22.0, 24.0, 26.0, 28.0, 30.0, 33.0])
def test_no_load_falls_between_a_point_and_a_length(load):
    # loads at which neither a row at the minimum nor rows at the joints around would keep themselves; such a
    # contact's place is known to an element, and its force with it. Reference: a mesh of many more elements
    fine = solved(bowl(load), 160).values["c.force"][0]
    for links in (20, 41, {"A": 30, "B": 43}):
        station = solved(bowl(load), links)
        n = links if isinstance(links, int) else min(links.values())
        assert station.values["c.force"][0] == pytest.approx(fine, rel=0.6 / n)
        assert station.certificate.penetration < 0.02


@pytest.mark.parametrize("links", [40, 80])
def test_a_heavy_strip_is_lifted_off_a_floor_at_its_end(links):
    # reference: a length a is free, with the deflection h = q a⁴/24 EI, the force q a/2 at the end and the moment
    # q a²/8 in the middle (small slopes); the strip on the floor is straight, and has no stress
    q, heights = 18.5 * RIGIDITY / LENGTH**3, np.array([0.002, 0.01]) * LENGTH
    floor = {"kind": "beam-half-plane", "beam": "beam", "body": "wall"}
    scene = scene_from(
        {
            **cantilever_data({"kind": "distributed", "beam": "beam", "direction": [0.0, -1.0]}, [q]),
            "drives": {"h": {"kind": "displacement", "point": "T", "direction": [0.0, 1.0]}},
            "contacts": {"c": {**floor, "point": [0.0, -0.5 * THICKNESS], "normal": [0.0, 1.0]}},
            "stages": [
                {"name": "lie", "steps": "P", "stations": [q]},
                {"name": "lift", "steps": "h", "stations": heights.tolist()},
            ],
            "probes": [
                {"of": "c", "quantity": "ends"},
                {"of": "T", "quantity": "reaction"},
                {"of": "beam", "quantity": "bending_stress", "points": 101},
            ],
        }
    )
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    free = (24.0 * RIGIDITY * heights / q) ** 0.25
    lifted = [station.values for station in answer.stations[1:]]
    assert [values["c.ends"][1] for values in lifted] == pytest.approx(LENGTH - free, abs=0.05 * LENGTH / links)
    assert [values["T.reaction"][1] for values in lifted] == pytest.approx(0.5 * q * free, rel=1e-3)
    for values, a in zip(lifted, free, strict=True):
        stress, largest = np.abs(values["beam.bending_stress"]), q * a**2 / 8.0 * 0.5 * MODULUS * THICKNESS / RIGIDITY
        assert stress.max() == pytest.approx(largest, rel=2e-3)
        # the clamp takes a part of the force of the first joint; a few joints carry the force at the end of the zone
        flat = (np.arange(101) > 0) & (np.linspace(0.0, LENGTH, 101) < LENGTH - a - 8.0 * LENGTH / links)
        assert stress[flat].max() < 1.6 / links**2 * largest
