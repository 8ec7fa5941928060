"""Bodies, pins, drives and loads: what holds a mechanism, and what moves it."""

import copy
import math
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cprbm_scene import Scene, SceneError, scene_from
from cprbm_scene.solving import requirements
from cprbm_scene.statement import BeamForce, DisplacementDrive, DistributedLoad
from tests.cprbm_scene.editing import edited, mistakes
from tests.cprbm_scene.scenes import DRIVEN, LINKAGE, LOADED, PUSH, SLIDES, SLIDING, SLOTTED, TURN, TURNED, WITH_FORCE

DRIVE = ("drives/phi", {"kind": "rotation", "body": "crank"})


def test_a_linkage_is_a_scene():
    scene = scene_from(LINKAGE)
    assert scene.pins["at_A"].points == ("A", "A1")
    driven = [("loads", {}), ("stages/0/steps", "phi"), DRIVE]
    assert not mistakes(*driven, base=LINKAGE)
    assert not mistakes(("probes/1", {"of": "O", "quantity": "reaction"}), base=LINKAGE)


def test_two_pins_between_two_bodies_hold_them_twice():
    edits = [
        ("bodies/plate", {"motion": "free", "points": {"A2": [0.0, 0.05], "B2": [0.15, 0.1]}}),
        ("pins/one", {"points": ["A1", "A2"]}),
        ("pins/two", {"points": ["B", "B2"]}),
    ]
    assert list(mistakes(*edits, base=LINKAGE)) == ["pins.two"]


THIN = {"thickness": 0.001, "width": 0.01, "material": "steel"}


HUNG = {
    "name": "hung",
    "theory": "bending",
    "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
    "bodies": {
        "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0], "S": [0.031, 0.047]}},
        "plate": {"motion": "free", "points": {"P": [0.0731, 0.0], "Q": [0.0731, 0.0193]}},
    },
    "beams": {
        "low": {
            "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0731, 0.0]},
            "start": {"joint": "pin", "point": "R"},
            "end": {"joint": "pin", "point": "P"},
            **THIN,
        },
        "high": {
            "curve": {"kind": "line", "start": [0.031, 0.047], "end": [0.0731, 0.0193]},
            "start": {"joint": "pin", "point": "S"},
            "end": {"joint": "pin", "point": "Q"},
            **THIN,
        },
    },
    "loads": {"F": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
    "stages": [{"name": "load", "steps": "F", "stations": [1.0]}],
    "probes": [{"of": "P", "quantity": "displacement"}],
}


BELOW = {"kind": "beam-half-plane", "beam": "low", "body": "ground", "point": [0.0, -0.013], "normal": [0.0, 1.0]}


def test_a_motion_that_bends_no_beam_is_told():
    # reference: a plate on two bars turns about the point in which their lines meet
    pole = 0.0731 + 0.0193 * (0.0731 - 0.031) / (0.047 - 0.0193)
    (found,) = mistakes(base=HUNG).values()
    assert f"turn about [{pole:.4g}, 0] m" in found
    # on bars side by side it goes along, across them
    even = [("bodies/ground/points/S", [0.0, 0.0193]), ("beams/high/curve/start", [0.0, 0.0193])]
    (found,) = mistakes(*even, base=HUNG).values()
    assert "move along [0, 1]" in found


@pytest.mark.parametrize(
    "edits",
    [
        [("beams/low/start/joint", "weld"), ("beams/low/end/joint", "weld")],
        [("drives", {"D": {"kind": "rotation", "body": "plate"}})],
        [("contacts", {"below": BELOW})],
    ],
)
def test_what_a_weld_a_drive_or_a_contact_may_hold_is_a_scene(edits):
    assert not mistakes(*edits, base=HUNG)


def test_a_contact_elsewhere_holds_no_loose_body():
    beam = {**THIN, "start": {"joint": "weld", "point": "S"}, "end": {"joint": "free"}}
    beam["curve"] = {"kind": "line", "start": [0.031, 0.047], "end": [0.031, 0.097]}
    edits = ("beams/other", beam), ("contacts", {"below": {**BELOW, "beam": "other"}})
    assert "turn about" in mistakes(*edits, base=HUNG)["bodies.plate"]


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


def test_a_pin_in_a_slot_leaves_the_rest_free():
    assert not mistakes(base=SLOTTED)
    assert not mistakes(("drives/t", TURN), base=SLOTTED)
    assert not mistakes(("loads/M", {"kind": "moment", "body": "BD"}), base=SLOTTED)
    # along the slot the other point has a motion of its own, across it the first has none
    along, across = ({**PUSH, "point": "D", "direction": direction} for direction in ([1.0, 0.0], [0.0, 1.0]))
    assert not mistakes(("drives/e", along), base=SLOTTED)
    assert "across the slide" in mistakes(("drives/e", across), base=SLOTTED)["drives.e.direction"]


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


def test_loads_of_beams_read_as_they_are_written():
    loads = scene_from(edited(("loads/q/along", [0, 0.25]), base=LOADED)).loads
    assert loads["F"] == BeamForce(kind="beam_force", beam="lower", at=0.3, direction=(0.0, -2.0))
    assert loads["q"] == DistributedLoad(kind="distributed", beam="upper", direction=(0.0, -1.0), along=(0.0, 0.25))
    assert scene_from(LOADED).loads["q"].along == (0.0, 1.0)


def test_ends_that_can_move_may_be_loaded():
    for beam, at in (("upper", 1.0), ("lower", 1.0)):
        assert not mistakes(("loads/F/beam", beam), ("loads/F/at", at), base=LOADED)
