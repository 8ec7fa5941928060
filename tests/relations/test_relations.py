"""What may be done to a scene without another answer, done to small ones; and planted solvers that notice it.

A relation needs no reference: the answer to the scene says what the answer to its image must be.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.pairing import cprbm_answer, fea_answer
from cprbm_scene import Critical, Loss, Scene, scene_from
from cprbm_scene.answer import frozen_array
from cprbm_scene.curve_records import shape_of
from cprbm_scene.frozendict import frozendict
from tests.relations.frames import MIRROR, QUARTER, Frame, turned_by
from tests.relations.image import copied, plain
from tests.relations.measured import TARGET, violations
from tests.relations.relations import RELATIONS
from tests.relations.reversing import reversed_beam
from tests.together.planted import asked_of

COARSE = Choices(links=11, elements=11)
SOLVERS = {"cprbm": cprbm_answer, "fea": fea_answer}
BY_NAME = {relation.name: relation for relation in RELATIONS}


def few(name, *stations):
    """A built-in case at these stations only."""
    data = plain(cases.data(name))
    data["stages"][0] = {"name": "load", "steps": data["stages"][0]["steps"], "stations": list(stations)}
    return data


def tangled():
    """A tapered beam from a weld to a free start, loaded in its inside, which lies on an edge that is a polynomial."""
    return {
        "name": "tangled",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": 7.3e10, "poisson_ratio": 0.31}},
        "bodies": {"ground": {"motion": "fixed", "points": {"P": [0.1173, 0.0213]}}},
        "beams": {
            "beam": {
                "curve": {"kind": "arc", "direction": "clockwise",
                          "center": [0.0573, 0.0213], "start": [-0.0027, 0.0213], "end": [0.1173, 0.0213]},
                "thickness": {"at": [0.0, 0.37, 1.0], "values": [0.0009, 0.0013, 0.0011]},
                "width": 0.0083,
                "material": "m",
                "start": {"joint": "free"},
                "end": {"joint": "weld", "point": "P"},
            }
        },
        "loads": {"F": {"kind": "beam_force", "beam": "beam", "at": 0.083, "direction": [0.31, -0.87]}},
        "contacts": {
            "edge": {"kind": "beam-function", "beam": "beam", "body": "ground", "axis": "x", "side": "above",
                     "coefficients": [-0.0031, 0.17, -3.1], "range": [-0.03, 0.04]}
        },
        "stages": [{"name": "load", "steps": "F", "stations": [1.7, 9.3]}],
        "probes": [
            {"of": "beam", "quantity": "bending_stress", "points": 23},
            {"of": "P", "quantity": "reaction"},
            {"of": "P", "quantity": "reaction_moment"},
            {"of": "edge", "quantity": "force"},
            {"of": "edge", "quantity": "centre"},
            {"of": "edge", "quantity": "closing_load"},
            {"of": "scene", "quantity": "potential_energy"},
        ],
    }  # fmt: skip


def on_edges():
    """A beam from a weld to a free end, loaded in its inside, on an ellipse that is not upright, then on a spline."""
    data = tangled()
    data["beams"]["beam"]["curve"] = {"kind": "line", "start": [-0.0027, 0.0213], "end": [0.1173, 0.0213]}
    data["loads"]["F"]["direction"] = [0.0, -0.87]
    on = {"beam": "beam", "body": "ground"}
    data["contacts"] = {
        "edge": {
            "kind": "beam-spline",
            **on,
            "points": [[0.02, 0.003], [0.041, 0.0171], [0.057, 0.011]],
            "side": "left",
            "start_direction": [0.3, 0.5],
        },
        "cam": {"kind": "beam-ellipse", **on, "center": [0.083, 0.0125], "semi_axes": [0.013, 0.007], "angle": 0.31},
    }
    data["probes"] += [{"of": "cam", "quantity": "force"}, {"of": "cam", "quantity": "centre"}]
    return data


QUESTIONS = {
    "hinge": (lambda: few("hinge", 0.31, 0.57), tuple(BY_NAME)),
    "wrapped": (
        lambda: few("wrapped", 67.0),
        ("motion", "mirror", "direction", "modulus", "length", "steps", "reaction"),
    ),
    "stack": (lambda: few("stack", 0.037), ("direction", "pair")),
    "on edges": (on_edges, ("motion", "mirror", "length")),
    "tangled": (tangled, ("motion", "mirror", "direction", "length", "company", "reaction")),
}


@pytest.mark.parametrize(
    ("name", "solver"),
    [
        (name, solver)
        for name in QUESTIONS
        for solver in SOLVERS
        if solver == "cprbm" or name not in ("stack", "on edges")
    ],
)
def test_relations_hold(name, solver):
    asked, relations = QUESTIONS[name]
    if (name, solver) == ("hinge", "fea"):  # its penalty is the one wanted to 3 %, by the way: docs/tests.md
        relations = tuple(each for each in relations if each != "steps")
    if (name, solver) == ("tangled", "cprbm"):  # open: the energy of a reversed beam differs by 4e-5 at the sharp bend
        relations = tuple(each for each in relations if each != "direction")
    if (name, solver) == ("tangled", "fea"):  # seconds each; the others are as in the hinge
        relations = ("direction",)
    found = tuple(violations(asked(), SOLVERS[solver], COARSE, [BY_NAME[each] for each in relations]))
    assert {each.relation for each in found} == set(relations)
    broken = [each for each in found if not each.holds]
    assert not broken, "\n".join(map(str, broken))
    # what is told of the worst is told of something that was measured
    assert all(each.worst.allowed >= TARGET and np.isfinite(each.worst.size) for each in found)


def test_where_couples_alone_act_forces_that_are_round_off_balance():
    # a strip rolled by its end: its forces are round-off, and as shares of each other had ΣF = 1
    (found,) = violations(few("rolled", 2.3), fea_answer, COARSE, [BY_NAME["reaction"]])
    assert found.holds, found


def test_what_knows_where_a_beam_begins_is_another_discretised_problem():
    def anew(name):
        return {image.what: image.discretised_anew for image in BY_NAME["direction"].images(plain(cases.data(name)))}

    assert anew("rolled") == {"strip reversed": True}  # the first of two parts that touch is asked for gaps
    assert anew("gripper") == {"beam1 reversed": False, "beam2 reversed": True}  # a line, and a polynomial
    assert anew("hinge") == {"beam1 reversed": False, "beam2 reversed": False}  # arcs


# ---------------------------------------------------------------------------------------- planted faults


def values_by(change, solver=cprbm_answer):
    """A solver whose answers' values are changed: by the scene, the number of the station, its probe and value."""

    def planted(scene, choices):
        answer = solver(scene, choices)
        stations = tuple(
            replace(
                station,
                values=frozendict(
                    {name: frozen_array(change(scene, i, name, value)) for name, value in station.values.items()}
                ),
            )
            for i, station in enumerate(answer.stations)
        )
        return replace(answer, stations=stations)

    return planted


def thicker(scene: Scene, which, factor: float = 1.00001, more: float = 0.0) -> Scene:
    """The scene with those beams thicker that ``which`` says, by name and record."""
    beams = {
        name: beam.model_copy(update={"thickness": factor * beam.thickness + more}) if which(name, beam) else beam
        for name, beam in scene.beams.items()
    }
    return scene.model_copy(update={"beams": frozendict(beams)})


def stiffened(scene: Scene) -> Scene:
    """The scene with all moduli larger by one pascal."""
    materials = {
        name: each.model_copy(update={"youngs_modulus": each.youngs_modulus + 1.0})
        for name, each in scene.materials.items()
    }
    return scene.model_copy(update={"materials": frozendict(materials)})


def moved(factor):
    """Displacements times what a scene and the number of a station say."""
    return values_by(lambda scene, i, name, v: factor(scene, i) * v if name.endswith(".displacement") else v)


FAULTS = {
    # what lies along y goes by another measure
    "motion": values_by(lambda scene, i, name, v: v * [1.0, 1.00001] if name == "B.displacement" else v),
    # left is not as right
    "mirror": values_by(lambda scene, i, name, v: v + 1e-5 * np.abs(v) if name == "BD.rotation" else v),
    # the first beam is another
    "order": asked_of(cprbm_answer, lambda scene: thicker(scene, lambda name, beam: name == next(iter(scene.beams)))),
    # a beam that runs clockwise is another
    "direction": asked_of(
        cprbm_answer, lambda scene: thicker(scene, lambda name, beam: beam.curve.direction == "clockwise")
    ),
    # a pascal, and a nanometre, stand for nothing
    "modulus": asked_of(cprbm_answer, stiffened),
    "length": asked_of(cprbm_answer, lambda scene: thicker(scene, lambda name, beam: True, 1.0, 1e-9)),
    # steps add up
    "steps": moved(lambda scene, i: 1.0 + 1e-5 * i),
    # what is far away has a part
    "company": moved(lambda scene, i: 1.0 + 1e-5 * len(scene.contacts)),
    # a support bears more than acts on it
    "reaction": values_by(lambda scene, i, name, v: 1.0001 * v if name == "A.reaction" else v),
    # a contact's first beam is another
    "pair": asked_of(
        cprbm_answer,
        lambda scene: thicker(scene, lambda name, beam: name == scene.contacts["contact"].between[0], 1.04),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_caught(name):
    asked = few("hinge", 0.23, 0.57)
    found = tuple(violations(asked, FAULTS[name], COARSE, [BY_NAME[name]]))
    assert any(not each.holds for each in found), found


def turned():
    """A strip whose end is turned, and else free: by statics a moment alone holds it."""
    return {
        "name": "turned",
        "theory": "bending",
        "materials": {"m": {"youngs_modulus": 7.3e10, "poisson_ratio": 0.31}},
        "bodies": {"ground": {"motion": "fixed", "points": {"P": [0.013, 0.021]}},
                   "tip": {"motion": "free", "points": {"T": [0.093, 0.054]}}},
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": [0.013, 0.021], "end": [0.093, 0.054]},
                "thickness": 0.0007,
                "width": 0.0083,
                "material": "m",
                "start": {"joint": "weld", "point": "P"},
                "end": {"joint": "weld", "point": "T"},
            }
        },
        "drives": {"turn": {"kind": "rotation", "body": "tip"}},
        "stages": [{"name": "turn", "steps": "turn", "stations": [1.3]}],
        "probes": [{"of": "P", "quantity": "reaction"}],
    }  # fmt: skip


def test_forces_that_are_round_off_beside_a_moment_are_told_by_the_moment():
    def pushed(scene, choices):
        length = np.hypot(0.08, 0.033)
        moment = 7.3e10 * 0.0083 * 0.0007**3 / 12.0 * 1.3 / length  # EI times curvature
        change = values_by(
            lambda scene, i, name, v: v + np.array([1e-5 * moment / length, 0.0]) if name == "P.reaction" else v,
            fea_answer,
        )
        return change(scene, choices)

    (found,) = violations(turned(), fea_answer, COARSE, [BY_NAME["reaction"]])
    assert found.holds, found
    (found,) = violations(turned(), pushed, COARSE, [BY_NAME["reaction"]])
    assert found.worst.probe == "ΣF"
    assert found.worst.size == pytest.approx(1e-5, rel=1e-3)


def test_every_relation_has_a_planted_fault():
    assert FAULTS.keys() == BY_NAME.keys()


def test_an_image_that_ends_otherwise_violates_it_wholly():
    def ends_in_the_mirror(scene, choices):
        answer = cprbm_answer(scene, choices)
        return answer if scene.bodies["BD"].points["B"][1] > 0.0 else replace(answer, stations=())

    asked = few("hinge", 0.23)
    (found,) = violations(asked, ends_in_the_mirror, COARSE, [BY_NAME["mirror"]])
    assert found.worst.size == np.inf
    assert found.worst.why == "it was not reached"


@pytest.mark.parametrize(("relation", "apart", "holds"), [
    ("pair", 0.3, True), ("pair", 30.0, False), ("mirror", 1e-4, True), ("mirror", 0.3, False),
])  # fmt: skip
def test_where_a_branch_ends_is_known_as_well_as_both_answers_say(relation, apart, holds):
    # each says 1e-8 of the value; of another discretised problem it is off by 1e-3/links as well, times ``apart``
    asked = few("hinge", 0.37)
    first = scene_from(asked)

    def ending(scene, choices):
        image = scene.bodies != first.bodies or scene.contacts["contact"].between != first.contacts["contact"].between
        value = 0.31 * (1.0 + (1.0 + apart * image) * 1e-3 / choices.links)
        unit = np.sign(scene.stages[0].stations[0])
        lost = Critical("load", unit * value, 3.1e-9, Loss.FOLD, "", 0.0, -1.0, 1.7, None)
        return replace(cprbm_answer(scene, choices), critical=(lost,))

    (found,) = violations(asked, ending, COARSE, [BY_NAME[relation]])
    assert found.holds == holds
    if not holds:
        assert found.worst.probe == "critical"


# ------------------------------------------------------------------------------------------- images


def test_a_beam_that_is_brought_to_its_point_is_not_drawn_from_there():
    # beam1 and beam2 are drawn free of stress, their ends apart from the points that the assembly brings them to
    assert not list(BY_NAME["direction"].images(plain(cases.data("prestressed"))))
    assert [image.what for image in BY_NAME["direction"].images(plain(cases.data("five-bar")))] == [
        "beam1 reversed",
        "beam2 reversed",
    ]


def test_images_of_images_are_the_scene():
    """There and back again: the data that was, but for what is rounded."""
    for name, frame, back in (
        ("gripper", Frame(Q=MIRROR), Frame(Q=MIRROR)),
        ("five-bar", Frame(Q=turned_by(0.71)), Frame(Q=turned_by(-0.71))),
        ("prestressed", Frame(length=1e6, modulus=1e-9), Frame(length=1e-6, modulus=1e9)),
        ("gripper", Frame(Q=QUARTER, b=(0.3, -0.7)), Frame(Q=((0.0, 1.0), (-1.0, 0.0)), b=(0.7, 0.3))),
    ):
        data = plain(cases.data(name))
        again = back.image(frame.image(data, "").data, "").data
        same(again, data)


def same(one, other):
    """Numbers to round-off of the scene's size, all else to the letter."""
    if isinstance(other, dict):
        assert one.keys() == other.keys()
        for key in other:
            same(one[key], other[key])
    elif isinstance(other, list):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            same(a, b)
    elif isinstance(other, float):
        assert one == pytest.approx(other, rel=1e-12, abs=1e-15)
    else:
        assert one == other


def test_a_polynomial_s_image_is_where_its_points_go():
    """Points of the curve, mapped one by one, lie on the image; of a quarter turn, a mirror and a shift."""
    data = copied(plain(cases.data("gripper")))
    u = np.linspace(0.0, 1.0, 7)
    before = shape_of(scene_from(data).beams["beam2"].curve).point(u)
    for frame in (Frame(Q=QUARTER, b=(0.031, 0.017), length=3.0), Frame(Q=MIRROR, b=(-0.2, 0.1))):
        image = scene_from(frame.image(data, "").data).beams["beam2"].curve
        expected = np.array([frame.placed(list(point)) for point in before])
        np.testing.assert_allclose(shape_of(image).point(u), expected, rtol=0.0, atol=1e-14)


def test_a_reversed_beam_is_where_it_was():
    data = plain(cases.data("platform"))
    u = np.linspace(0.0, 1.0, 7)
    for beam in data["beams"]:
        one, other = scene_from(data).beams[beam], scene_from(reversed_beam(data, beam).data).beams[beam]
        np.testing.assert_allclose(
            shape_of(other.curve).point(u)[::-1], shape_of(one.curve).point(u), rtol=0.0, atol=1e-14
        )
