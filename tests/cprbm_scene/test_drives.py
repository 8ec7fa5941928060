"""Sliding bodies and drives: what a scene can say of them, and each wrong question by its key and a word."""

import copy
import math
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Scene, SceneError, scene_from
from cprbm_scene.requirements import requirements
from cprbm_scene.statement import DisplacementDrive
from tests.cprbm_scene.editing import REMOVED, edited, mistakes

SLIDES = {"motion": "slides", "along": [1.0, 0.0], "points": {"B": [0.051, 0.02625], "D": [0.051, -0.02625]}}
TURN = {"kind": "rotation", "body": "BD"}
PUSH = {"kind": "displacement", "point": "B", "direction": [3.0, 4.0]}
STAGE = [{"name": "drive", "steps": "d", "stations": [0.001]}]

DRIVEN = edited(("loads", {}), ("drives", {"d": PUSH}), ("stages", STAGE), ("claims", []))
TURNED = edited(("loads", {}), ("drives", {"d": TURN}), ("stages", STAGE), ("claims", []))
SLIDING = edited(("bodies/BD", SLIDES), ("drives/d", PUSH), base=DRIVEN)
WITH_FORCE = edited(
    ("loads", {"F": {"kind": "force", "point": "B", "direction": [1.0, 0.0]}}),
    ("stages/1", {"name": "load", "steps": "F", "stations": [1.0]}),
    base=edited(("bodies/BD", SLIDES), ("drives", {}), base=DRIVEN),
)
WITH_FORCE["stages"] = WITH_FORCE["stages"][1:]


def test_a_stage_steps_a_load_or_a_drive():
    scene = scene_from(DRIVEN)
    assert isinstance(scene.stepped(scene.stages[0]), DisplacementDrive)
    both = scene_from(
        edited(
            ("drives/d", TURN),
            ("loads", {"F": {"kind": "force", "point": "B", "direction": [1, 0]}}),
            ("stages/1", {"name": "load", "steps": "F", "stations": [1.0]}),
            base=DRIVEN,
        )
    )
    assert [both.stepped(stage).kind for stage in both.stages] == ["rotation", "force"]


def test_motions_are_told_apart_and_keep_their_points():
    scene = scene_from(SLIDING)
    assert {name: body.motion for name, body in scene.bodies.items()} == {"AC": "fixed", "BD": "slides"}
    assert set(scene.bodies["BD"].points) == {"B", "D"}


@pytest.mark.parametrize(
    ("base", "of", "quantity"),
    [(DRIVEN, "B", "reaction"), (TURNED, "BD", "reaction_moment"), (TURNED, "A", "reaction_moment")],
)
def test_the_reaction_of_a_drive_can_be_asked(base, of, quantity):
    assert not mistakes(("probes", [{"of": of, "quantity": quantity}]), base=base)


@pytest.mark.parametrize("base", [DRIVEN, TURNED, SLIDING, WITH_FORCE], ids=["point", "rotation", "slide", "force"])
def test_good_questions_have_no_mistakes(base):
    assert not mistakes(base=base)


def test_two_drives_of_one_point_in_two_directions_have_a_freedom_each():
    across = {"kind": "displacement", "point": "B", "direction": [1.0, 0.0]}
    assert not mistakes(("drives/e", across), ("drives/t", TURN), base=DRIVEN)


def test_drives_alone_can_hold_a_mechanism():
    """All three freedoms of what a beam carries, without a fixed body; with two of them solvers refuse the turn."""
    data = edited(("bodies/AC/motion", "free"), ("drives/e", {**PUSH, "direction": [1.0, 0.0]}), base=DRIVEN)
    data["probes"] = [{"of": "B", "quantity": "reaction"}]
    assert [kind for kind, _ in requirements(scene_from(data))] == ["support", "support"]
    assert not list(requirements(scene_from(edited(("drives/t", TURN), base=data))))


def test_a_driven_slide_needs_no_beam():
    """A body that only carries a circle may be driven: its slide and its drive hold it."""
    punch = {"motion": "slides", "along": [0.0, 1.0], "points": {"P": [0.026, 0.2]}}
    drive = {"kind": "displacement", "point": "P", "direction": [0.0, -1.0]}
    assert "a sliding body that no beam meets" in mistakes(("bodies/punch", punch), base=DRIVEN)["bodies.punch"]
    assert not mistakes(("bodies/punch", punch), ("drives/p", drive), base=DRIVEN)


SLOTTED = edited(("bodies/BD/turns", True), ("bodies/BD/about", "B"), base=SLIDING)


def test_a_pin_in_a_slot_leaves_the_rest_free():
    assert not mistakes(base=SLOTTED)
    assert not mistakes(("drives/t", TURN), base=SLOTTED)
    assert not mistakes(("loads/M", {"kind": "moment", "body": "BD"}), base=SLOTTED)
    # along the slot the other point has a motion of its own, across it the first has none
    along, across = ({**PUSH, "point": "D", "direction": direction} for direction in ([1.0, 0.0], [0.0, 1.0]))
    assert not mistakes(("drives/e", along), base=SLOTTED)
    assert "across the slide" in mistakes(("drives/e", across), base=SLOTTED)["drives.e.direction"]


WRONG = [
    (DRIVEN, ("drives/d/kind", "push"), "drives.d.kind", "one of 'displacement', 'rotation'"),
    (DRIVEN, ("drives/d/value", 1.0), "drives.d.value", "'kind', 'point', 'direction'"),
    (DRIVEN, ("drives/d/direction", [0, 0]), "drives.d.direction", "at least one number not zero"),
    (DRIVEN, ("drives/d/point", "X"), "drives.d.point", "names no point"),
    (TURNED, ("drives/d/body", "DB"), "drives.d.body", "'DB', which names no body"),
    (DRIVEN, ("drives/d/point", "A"), "drives.d.point", "of the fixed body 'AC'; a point that can move: 'B', 'D'"),
    (TURNED, ("drives/d/body", "AC"), "drives.d.body", "of the fixed body 'AC'; a body that can move: 'BD'"),
    (DRIVEN, ("drives/A", TURN), "drives.A", "bodies.AC.points.A has too"),
    (DRIVEN, ("stages/0/steps", "e"), "stages[0].steps", "names no load or drive"),
    (DRIVEN, ("drives/e", {**PUSH, "direction": [-6.0, -8.0]}), "drives.e", "driven already by drives.d"),
    (TURNED, ("drives/e", TURN), "drives.e", "driven already by drives.d"),
    (SLIDING, ("drives/e", {**PUSH, "point": "D"}), "drives.e", "driven already by drives.d"),
    (SLIDING, ("drives/d/direction", [0.0, 1.0]), "drives.d.direction", "across the slide of 'BD'"),
    (SLIDING, ("drives/d", TURN), "drives.d.body", "the rotation of 'BD', which slides"),
    (SLIDING, ("bodies/BD/along", [0, 0]), "bodies.BD.along", "at least one number not zero"),
    (SLIDING, ("bodies/BD/along", REMOVED), "bodies.BD.along", "required"),
    (SLIDING, ("bodies/BD/alon", [0, 0]), "bodies.BD.alon", "is 'along' meant"),
    (SLIDING, ("bodies/BD/turns", True), "bodies.BD.about", "nothing: of the points of a body that slides and turns"),
    (SLIDING, ("bodies/BD/turns", 1), "bodies.BD.turns", "1; true or false"),
    (SLIDING, ("bodies/BD/about", "B"), "bodies.BD.about", "'B', a point to turn about, of a body that does not turn"),
    (SLOTTED, ("bodies/BD/about", "A"), "bodies.BD.about", "'A', which names no point of this body"),
    (SLOTTED, ("drives/d/direction", [0.0, 1.0]), "drives.d.direction", "across the slide of 'BD'"),
    (SLIDING, ("bodies/BD/motion", "slide"), "bodies.BD.motion", "one of 'fixed', 'free', 'slides'"),
    (WITH_FORCE, ("loads/F/direction", [0.0, 1.0]), "loads.F.direction", "across the slide of 'BD'"),
    (WITH_FORCE, ("loads/F", {"kind": "moment", "body": "BD"}), "loads.F.body", "slides and does not turn"),
    (WITH_FORCE, ("drives/d", {**PUSH, "point": "D"}), "loads.F", "driven by drives.d"),
    (DRIVEN, ("loads/F", {"kind": "force", "point": "B", "direction": [0, 1]}), "loads.F", "driven by drives.d"),
    (TURNED, ("loads/M", {"kind": "moment", "body": "BD"}), "loads.M", "driven by drives.d"),
    (DRIVEN, ("probes/0", {"of": "D", "quantity": "reaction"}), "probes[0]", "'A', 'C', 'B'"),
    (DRIVEN, ("probes/0", {"of": "BD", "quantity": "reaction_moment"}), "probes[0]", "whose rotation is driven"),
]


@pytest.mark.parametrize(
    ("base", "edit", "key", "word"), WRONG, ids=[f"{key}-{i}" for i, (*_, key, _) in enumerate(WRONG)]
)
def test_a_wrong_question_is_named_by_its_key(base, edit, key, word):
    found = mistakes(edit, base=base)
    assert key in found, found
    assert word in found[key]


def test_a_force_across_a_driven_direction_is_no_mistake():
    across = {"kind": "force", "point": "B", "direction": [-4.0, 3.0]}
    assert not mistakes(("loads/F", across), base=DRIVEN)


BOTH = edited(("drives/t", TURN), ("bodies/slider", {**SLIDES, "points": {"E": [0.1, 0.0]}}), base=DRIVEN)
BOTH["drives"]["e"] = {"kind": "displacement", "point": "E", "direction": [1.0, 1.0]}
BOTH["loads"]["F"] = {"kind": "force", "point": "B", "direction": [-4.0, 3.0]}
VECTORS = [
    ("bodies", "BD", "points", "B"),
    ("bodies", "BD", "points", "D"),
    ("bodies", "slider", "points", "E"),
    ("bodies", "slider", "along"),
    ("drives", "d", "direction"),
    ("drives", "e", "direction"),
    ("loads", "F", "direction"),
]
NUMBERS = st.one_of(st.floats(allow_nan=False), st.sampled_from([0.0, 1.0, 5e-324, 1e-308, 1e154, 1.7e308, -1.7e308]))


def test_the_scene_that_is_edited_at_random_is_a_good_question():
    assert not mistakes(base=BOTH)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(st.tuples(st.sampled_from(VECTORS), st.tuples(NUMBERS, NUMBERS)), min_size=1, max_size=4))
def test_any_vector_gives_a_scene_or_mistakes(edits):
    data = copy.deepcopy(BOTH)
    for path, value in edits:
        place = data
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = list(value)
    with suppress(SceneError):
        assert isinstance(scene_from(data), Scene)


@pytest.mark.parametrize("exponent", [-290, -30, 30, 290])
def test_the_length_of_a_direction_means_nothing(exponent):
    factor = math.ldexp(1.0, exponent)
    direction = [3.0 * factor, 4.0 * factor]
    across = [-4.0 * factor, 3.0 * factor]
    edits = ("drives/d/direction", direction), ("bodies/slider/along", direction), ("loads/F/direction", across)
    assert not mistakes(*edits, base=BOTH)
