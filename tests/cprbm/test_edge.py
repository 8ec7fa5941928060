"""Contact with straight edges and graphs: derivatives, and beams that are pressed on them against closed forms."""

import math

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, scene_from
from cprbm_scene.statement import PaperRigid, Related
from tests.cprbm.scenes import cantilever_data, force
from tests.references.flattened import Flattened
from tests.together.pivots import LENGTH, MATERIALS, RIGIDITY, STRIP, THICKNESS, weld

RADIUS = 0.9 * LENGTH
CURVED = Flattened(LENGTH, RIGIDITY, RADIUS, 2.9 * RIGIDITY / LENGTH**2)
HALF = {"kind": "beam-half-plane", "point": [0.0, 0.0], "normal": [0.0, 2.0]}
LINE = {"kind": "beam-line", "points": [[-0.01, 0.0], [3.0 * LENGTH, 0.0]], "side": "left"}
GRAPH = {"kind": "beam-function", "axis": "x", "coefficients": [0.0, 0.0], "range": [-0.01, 3.0 * LENGTH]}
EDGES = {"half-plane": HALF, "line": LINE, "function": GRAPH | {"side": "above"}}


def turned(place, angle):
    cos, sin = np.cos(angle), np.sin(angle)
    return [float(cos * place[0] - sin * place[1]), float(sin * place[0] + cos * place[1])]


def arch(*, edge="half-plane", joint="pin", end="start", thick=False, turn=0.0, part=1.0):
    """An arc from the origin upwards, its start held on the edge below, its tip pushed down.

    With ``thick`` the edge lies half of the thickness below.  With a ``turn`` edge and pin are on a wheel that is
    driven by so much, and all is drawn turned back by that.  The tip goes ``part`` of the way.
    """
    tip, angle = CURVED.drawn, -turn
    below = -0.5 * THICKNESS if thick else 0.0
    contact = {**EDGES[edge]}
    if edge == "half-plane":
        contact |= {"point": turned([0.3 * LENGTH, below], angle), "normal": turned([0.0, 2.0], angle)}
    if edge == "line":
        contact["points"] = [turned([x, below], angle) for x, _ in LINE["points"]]
    if edge == "function":
        contact["coefficients"] = [below, 0.0]
    held, free = {"joint": joint, "point": "R"}, weld("T")
    curve = {"kind": "arc", "center": turned([0.0, RADIUS], angle)}
    ends = [[0.0, 0.0], turned(tip, angle)]
    if end == "start":
        beam = {
            "start": held,
            "end": free,
            "curve": curve | {"start": ends[0], "end": ends[1], "direction": "counterclockwise"},
        }
    else:
        beam = {
            "start": free,
            "end": held,
            "curve": curve | {"start": ends[1], "end": ends[0], "direction": "clockwise"},
        }
    moves = turn != 0.0
    push = {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}
    way = part * (turned(tip, angle)[1] - CURVED.tip[1])
    wheel = {"motion": "turns", "about": "R", "points": {"R": [0.0, 0.0]}}
    return scene_from(
        {
            "name": "arch",
            "theory": "bending",
            "materials": MATERIALS,
            "bodies": {
                "wall": {"motion": "fixed", "points": {"far": [-LENGTH, -LENGTH]} if moves else {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": ends[1]}},
            }
            | ({"wheel": wheel} if moves else {}),
            "beams": {"beam": {**STRIP, **beam}},
            "contacts": {"edge": {**contact, "beam": "beam", "body": "wheel" if moves else "wall", "thick": thick}},
            "drives": {"push": push} | ({"turn": {"kind": "rotation", "body": "wheel"}} if moves else {}),
            "stages": [{"name": "push", "steps": "push", "stations": [way]}]
            + ([{"name": "turn", "steps": "turn", "stations": [turn]}] if moves else []),
            "probes": [
                {"of": "T", "quantity": "displacement"},
                {"of": "T", "quantity": "reaction"},
                {"of": "edge", "quantity": "force"},
                {"of": "edge", "quantity": "ends"},
                {"of": "scene", "quantity": "potential_energy"},
            ]
            + ([{"of": "edge", "quantity": "moment"}] if joint == "pin" else []),
        }
    )


def solved(scene, links, formulation="auto"):
    answer = cprbm.answer(scene, cprbm.Settings(links=links, formulation=formulation))
    assert answer.completed, answer.sentence
    assert max(answer.stations[-1].certificate.force_balance, answer.stations[-1].certificate.moment_balance) < 1e-9
    return answer.stations[-1].values


def errors_of(links, formulation="auto", **changes):
    """Of the tip's place, energy, moment, reaction, force and end."""
    values = solved(arch(**changes), links, formulation)
    begin, end = values["edge.ends"]
    if changes.get("end") == "end":
        begin, end = LENGTH - end, LENGTH - begin
    assert begin == pytest.approx(0.0, abs=1e-15)
    return np.array(
        [
            np.hypot(*(values["T.displacement"] + CURVED.drawn - CURVED.tip)) / LENGTH,
            abs(values["scene.potential_energy"][0] / CURVED.energy - 1.0),
            abs(values["edge.moment"][0] / CURVED.about_start - 1.0),
            np.hypot(*(values["T.reaction"] - [0.0, -CURVED.force])) / CURVED.force,
            abs(values["edge.force"][0] / CURVED.force - 1.0),
            abs(end - CURVED.flat) / LENGTH,
        ]
    )


@pytest.mark.parametrize("changes", [{}, {"edge": "line", "end": "end"}])
def test_an_arc_pressed_flat_from_its_own_pin_on_converges_with_order_four(changes):
    # reference: tests.references.flattened, c/L = 0.6
    errors = {n: errors_of(n, **changes) for n in (20, 40, 80)}
    for n, found in errors.items():
        assert found[0] < 0.02 / n**4
        # the places of joints beside the end of the zone leave these uneven; the reference has nine digits
        assert np.all(found[1:4] < np.maximum(0.05 / n**4, 1e-8))
        # pin and contact share the force beside the pin
        assert np.all(found[4:] < 2.0 / n**2)


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("edge", list(EDGES))
def test_every_kind_of_edge_is_the_same_straight_one(edge, thick):
    # reference: tests.references.flattened
    assert np.all(errors_of(40, edge=edge, thick=thick) < 2.0 / 40**2)


def test_an_edge_that_is_drawn_beyond_its_beam_by_rounding_holds_it_along_itself():
    # what is held at an angle to the edge needs a force beside the pin that grows with the square of N
    told = []
    for beyond in (0.0, 1.6e-6):
        scene = arch()
        edge = scene.contacts["edge"].model_copy(update={"normal": (-beyond, 1.0), "point": (0.0, 0.0)})
        told.append(solved(scene.model_copy(update={"contacts": {"edge": edge}}), 40))
    for probe, values in told[0].items():
        assert told[1][probe] == pytest.approx(values, rel=1e-4, abs=1e-5 * np.max(np.abs(values)))


def test_before_it_lies_flat_the_moment_at_the_pin_is_the_forces():
    # reference: statics: the moment of the tip's force about the pin, which is all that holds
    values = solved(arch(part=0.3), 40)
    lever = CURVED.drawn[0] + values["T.displacement"][0]
    assert values["edge.moment"][0] == pytest.approx(-lever * values["T.reaction"][1], rel=1e-9)
    assert values["edge.moment"][0] < 0.9 * CURVED.moment
    assert values["edge.ends"] == pytest.approx([0.0, 0.0])
    assert values["edge.force"][0] == 0.0


def test_clamped_along_the_edge_the_clamp_has_what_the_pin_had():
    # reference: tests.references.flattened; a clamp presses nothing, so that the beam touches where it lifts off
    values = solved(arch(joint="weld"), 40)
    assert values["edge.force"][0] == pytest.approx(CURVED.force, rel=2.0 / 40**2)
    assert values["edge.ends"] == pytest.approx([CURVED.flat, CURVED.flat], abs=2.0 / 40**2 * LENGTH)


def test_a_line_in_pieces_that_go_on_straight_is_one_line():
    scene = arch(edge="line")
    pieces = tuple((x * LENGTH, 0.0) for x in (-0.1, 0.2, 0.61, 0.7, 3.0))
    line = scene.contacts["edge"].model_copy(update={"points": pieces})
    whole, parts = (solved(each, 40) for each in (scene, scene.model_copy(update={"contacts": {"edge": line}})))
    for name, value in whole.items():
        # pin and contact share the force beside the pin
        shared = 2.0 / 40**2 if name in ("edge.force", "edge.ends") else 1e-6
        assert parts[name] == pytest.approx(value, rel=shared, abs=1e-9 * np.max(np.abs(value)))


@pytest.mark.parametrize("changes", [{}, {"edge": "line", "end": "end", "thick": True}])
def test_the_papers_form_is_of_first_order_beside_an_own_pin(changes):
    # reference: tests.references.flattened. Of the first element only 3/4 of the arc is taken out: the chord from the
    # pin to the first spring is half as long as the next. Its energy (3/4)², and its moment from the pin's joint
    lacks, force = {}, {}
    for n in (20, 40, 80):
        values = solved(arch(**changes), n, "paper")
        lacks[n] = 1.0 - values["scene.potential_energy"][0] / CURVED.energy
        force[n] = values["edge.force"][0] - CURVED.force
        flat = 0.5 * RIGIDITY / RADIUS**2 * LENGTH / n / CURVED.energy
        assert lacks[n] == pytest.approx((1.0 - 0.75**2) * flat, rel=1.0 / n)
        assert force[n] == pytest.approx(0.75 * RIGIDITY / RADIUS / (0.5 * LENGTH / n), rel=2.0 / n**1.5)
        assert values["edge.moment"][0] == pytest.approx(CURVED.about_start, rel=0.1 / n)
    for n in (20, 40):
        assert 1.9 < lacks[n] / lacks[2 * n] < 2.1


def test_the_papers_form_is_of_second_order_away_from_own_pins():
    # reference: tests.references.flattened: a clamp presses nothing, so that the beam touches where it lifts off
    errors = {}
    for n in (20, 40, 80):
        values = solved(arch(joint="weld", edge="function"), n, "paper")
        errors[n] = abs(values["scene.potential_energy"][0] / CURVED.energy - 1.0)
        assert values["edge.force"][0] == pytest.approx(CURVED.force, rel=6.0 / n**2)
    assert min(errors[20] / errors[40], errors[40] / errors[80]) > 3.3


def test_the_papers_form_on_a_body_that_turns_is_that_on_the_ground():
    # the push, and then the turn, of which the mechanism knows nothing
    turned = arch(turn=0.7, edge="line")
    still, moved = (solved(scene, 20, "paper") for scene in (arch(edge="line"), turned))
    for name in ("edge.force", "edge.moment", "edge.ends", "scene.potential_energy"):
        assert moved[name] == pytest.approx(still[name], rel=1e-8, abs=1e-12)


def test_the_papers_form_says_why_it_is_of_first_order_and_since_when():
    said = cprbm.answer(arch(), cprbm.Settings(links=20, formulation="paper")).notes
    assert len(said) == 1
    assert "in contact 'edge', from push" in said[0]
    assert "first order" in said[0]
    assert not cprbm.answer(arch(joint="weld"), cprbm.Settings(links=20, formulation="paper")).notes


def test_related_joints_are_all_that_the_papers_form_holds():
    # none of them next to the pin, the beam goes through the edge there, and that ends the answer
    scene = arch(part=0.3)
    hints = PaperRigid(related={"beam": Related(x=(0.5 * LENGTH, LENGTH))})
    few = scene.model_copy(update={"contacts": {"edge": scene.contacts["edge"].model_copy(update={"paper": hints})}})
    assert solved(scene, 20, "paper")["edge.force"][0] > 0.0
    answer = cprbm.answer(few, cprbm.Settings(links=20, formulation="paper"))
    assert answer.ending is Ending.BEAMS_CROSSED
    assert "in contact 'edge'" in answer.sentence


def beside(contact):
    """A cantilever whose tip a slider presses down and back, by something that faces it aslant."""
    return scene_from(
        {
            "name": "beside",
            "theory": "bending",
            "materials": MATERIALS,
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "slider": {"motion": "slides", "along": [0.0, 1.0], "points": {"S": [1.3 * LENGTH, 0.0]}},
            },
            "beams": {
                "beam": {
                    **STRIP,
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "start": weld("R"),
                    "end": {"joint": "free"},
                }
            },
            "contacts": {"edge": {**contact, "beam": "beam", "body": "slider"}},
            "drives": {"push": {"kind": "displacement", "point": "S", "direction": [0.0, -1.0]}},
            "stages": [{"name": "push", "steps": "push", "stations": [0.31 * LENGTH, 0.57 * LENGTH]}],
            "probes": [{"of": "edge", "quantity": "force"}, {"of": "scene", "quantity": "potential_energy"}],
        }
    )


@pytest.mark.parametrize("kind", ["line", "function"])
def test_beyond_an_edges_end_a_beam_meets_the_side_of_what_is_rigid_behind_it(kind):
    # the edge leads up and away from its end; from there its side goes back at right angles, over the beam
    half = math.sqrt(0.75)
    end = [1.3 * LENGTH, 0.0]
    line = {"kind": "beam-line", "points": [end, [1.6 * LENGTH, 0.6 * half * LENGTH]], "side": "right"}
    slope = 2.0 * half
    graph = {"kind": "beam-function", "axis": "x", "coefficients": [-slope * end[0], slope], "side": "below"}
    graph["range"] = [end[0], 1.6 * LENGTH]
    plane = {"kind": "beam-half-plane", "point": end, "normal": [-0.5, -half]}
    by_side = cprbm.answer(beside(line if kind == "line" else graph), cprbm.Settings(links=20))
    by_plane = cprbm.answer(beside(plane), cprbm.Settings(links=20))
    assert by_side.completed
    assert by_plane.completed
    for one, other in zip(by_side.stations, by_plane.stations, strict=True):
        assert other.values["edge.force"][0] > 0.0
        for probe, values in other.values.items():
            assert one.values[probe] == pytest.approx(values, rel=1e-9)


def test_a_thick_arc_that_is_unloaded_beside_its_weld_on_an_edge_comes_back_as_drawn():
    """The second joint shares the first joint's force, and a point of contact takes the second joint's place."""
    tip, data = [0.04, 0.04], cantilever_data(force(-0.2, -1.0), [0.1, 0.5, 1.0, 2.0, 4.0])
    arc = {"kind": "arc", "center": [0.0, 0.04], "start": [0.0, 0.0], "end": tip, "direction": "counterclockwise"}
    data["beams"]["beam"] |= {"curve": arc, "thickness": 6e-3, "width": 0.01}
    data["bodies"]["tip"]["points"]["T"] = tip
    scene = scene_from(
        data
        | {
            "theory": "shear",
            "materials": {"m": {"youngs_modulus": 26e6, "poisson_ratio": 0.45}},
            "contacts": {"k": HALF | {"beam": "beam", "body": "wall", "point": [0.0, -3e-3]}},
            "stages": [*data["stages"], {"name": "out", "steps": "P", "stations": [1.0, 0.2, 0.0]}],
        }
    )
    assert np.all(np.abs(solved(scene, 40)["T.displacement"]) < 1e-12 * tip[0])
