"""Contact with straight edges and graphs: derivatives, and beams that are pressed on them against closed forms."""

import math

import numpy as np
import pytest
from pydantic import TypeAdapter

import cprbm
from cprbm import newton
from cprbm.first_contact import NO_ROWS, Local, over_unknowns
from cprbm.kinematics import State, positions, pulled_back, rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import contact_gradient, contact_rows, point_at
from cprbm_scene import Ending, scene_from
from cprbm_scene.statement import Contact, PaperRigid, Related
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
def test_an_arc_pressed_flat_from_its_own_pin_on_converges_with_order_two(changes):
    # reference: tests.references.flattened, c/L = 0.6
    errors = {n: errors_of(n, **changes) for n in (20, 40, 80, 160)}
    for coarse, fine in ((20, 40), (40, 80), (80, 160)):
        assert np.all(errors[coarse][:2] / errors[fine][:2] > 3.3)
    for n, found in errors.items():  # where borders are within a fiftieth of an element leaves these uneven
        assert np.all(found < 2.0 / n**2)


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("edge", list(EDGES))
def test_every_kind_of_edge_is_the_same_straight_one(edge, thick):
    # reference: tests.references.flattened
    assert np.all(errors_of(40, edge=edge, thick=thick) < 2.0 / 40**2)


def test_an_edge_and_a_pin_on_a_body_that_turns(monkeypatch):
    # reference: tests.references.flattened, seen from the wheel; and both forms of Newton's system give one answer
    values = solved(arch(turn=0.7, edge="line"), 40)
    assert values["edge.moment"][0] == pytest.approx(CURVED.about_start, rel=2.0 / 40**2)
    assert values["edge.force"][0] == pytest.approx(CURVED.force, rel=2.0 / 40**2)
    assert values["edge.ends"][1] == pytest.approx(CURVED.flat, abs=2.0 / 40**2 * LENGTH)
    assert values["scene.potential_energy"][0] == pytest.approx(CURVED.energy, rel=2.0 / 40**2)
    monkeypatch.setattr(newton, "MANY", 0)
    other = solved(arch(turn=0.7, edge="line"), 40)
    for name, value in values.items():
        assert other[name] == pytest.approx(value, rel=1e-7, abs=1e-9 * np.max(np.abs(value)))


def test_an_edge_that_is_drawn_beyond_its_beam_by_rounding_holds_it_along_itself():
    # what is held at an angle to the edge needs a force beside the pin that grows with the square of N
    told = []
    for beyond in (0.0, 1.6e-6):
        scene = arch()
        edge = scene.contacts["edge"].model_copy(update={"normal": (-beyond, 1.0), "point": (0.0, 0.0)})
        told.append(solved(scene.model_copy(update={"contacts": {"edge": edge}}), 80))
    for probe, values in told[0].items():
        assert told[1][probe] == pytest.approx(values, rel=1e-4, abs=1e-5 * np.max(np.abs(values)))


@pytest.mark.parametrize("bent", [-0.31, 0.0, 0.43], ids=["jutting", "straight", "hollow"])
def test_no_place_is_deeper_behind_an_edge_than_it_is_far_from_it(bent):
    # reference: the distance to the edge's own segments.  Beside a tip, above all where the beam is pinned, round-off
    # says which piece a place is beside: it is not as deep then as the other end's side is far away
    scene, turn = arch(edge="line"), 0.37
    corners = np.array(
        [turned(place, turn) for place in ([0.0, 0.0], [0.7 * LENGTH, 0.0], [1.3 * LENGTH, bent * LENGTH])]
    )
    line = scene.contacts["edge"].model_copy(update={"points": tuple(map(tuple, corners.tolist()))})
    edge = mechanism_of(scene.model_copy(update={"contacts": {"edge": line}}), cprbm.Settings(links=13)).pairs["edge"]
    assert edge.pins[0] is not None
    corners /= edge.unit_length
    begin, along = corners[:-1], np.diff(corners, axis=0)
    rng = np.random.default_rng(5)
    for far in (0.0, 1e-17, 3e-16, 1e-13, 1e-4, 0.07):
        q = np.repeat(corners, 70, axis=0)
        q += far * rng.standard_normal(q.shape)
        share = np.clip(np.sum((q[:, None] - begin) * along, axis=2) / np.sum(along**2, axis=1), 0.0, 1.0)
        away = np.min(np.linalg.norm(q[:, None] - begin - share[:, :, None] * along, axis=2), axis=1)
        for face, facing in zip(edge.faces, edge.whole.facing(q, edge.whole.seen(q)), strict=True):
            assert np.all(-face.seen(q).distance[facing] <= away[facing] + 2e-9)


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


STEEP = 1500.0  # 1/m
CORNER = [0.55 * LENGTH, -0.37 * LENGTH]
BENT = {
    "line": {"kind": "beam-line", "points": [[-0.01, 0.002], [0.03, 0.001], [0.9, -0.2]], "side": "left"},
    "hollow": {"kind": "beam-line", "points": [[-0.01, 0.002], [0.03, -0.02], [0.9, -0.2]], "side": "left"},
    "corner": {"kind": "beam-line", "points": [[-0.01, -0.2], CORNER, [0.07, -0.2]], "side": "left"},
    "function": {
        "kind": "beam-function",
        "axis": "x",
        "coefficients": [0.001, 0.05, -1.5],
        "range": [0.001, 0.9],
        "side": "above",
    },
    "sideways": {
        "kind": "beam-function",
        "axis": "y",
        "coefficients": [0.02, -2.0, 3.0],
        "range": [-0.3, 0.1],
        "side": "above",
    },
    "half-plane": {"kind": "beam-half-plane", "point": [0.02, 0.001], "normal": [0.1, 1.0]},
    # far narrower and sharper than an element, its top where the corner is
    "bump": {
        "kind": "beam-function",
        "axis": "x",
        "coefficients": [CORNER[1] - STEEP * CORNER[0] ** 2, 2.0 * STEEP * CORNER[0], -STEEP],
        "range": [CORNER[0] - 0.006, CORNER[0] + 0.006],
        "side": "above",
    },
}


@pytest.mark.parametrize("kind", BENT)
@pytest.mark.parametrize("moves", [False, True])
def test_rows_and_blocks_are_derivatives(kind, moves):
    # reference: central differences, at random states and with a pair whose places are where they happen to be
    scene = arch(turn=0.7 if moves else 0.0)
    contact = {**BENT[kind], "beam": "beam", "body": "wheel" if moves else "wall", "thick": True}
    edge = TypeAdapter(Contact).validate_python(contact, strict=False)
    scene = scene.model_copy(update={"contacts": {"edge": edge}})
    problem = mechanism_of(scene, cprbm.Settings(links=13)).problem
    model = problem.model
    n = model.n_links
    random = np.random.default_rng(5)
    rest = rest_state(model)
    base = np.concatenate((rest.theta, rest.bodies.ravel()))
    base[:n] = -0.9 * np.cos(np.linspace(0.0, 2.5, n)) + 0.02 * random.standard_normal(n)
    base[n:] += 0.01 * random.standard_normal(len(base) - n)
    mu = random.standard_normal(problem.closure.rows)

    def at(q, lam, rows):
        state = State(q[:n], q[n:].reshape(-1, 3))
        return point_at(problem, {}, state, mu, lam, rows)

    start = at(base, np.zeros(0), NO_ROWS)
    lam = 0.5 + random.random(start.rows.size)
    point = at(base, lam, start.rows)
    assert point.rows.size >= (1 if kind in {"corner", "bump"} else 4)
    keys = {key for _, key in point.rows.keys}
    # a place of its own: the second corner's
    assert (4 * (13 + 2) + 1 if kind == "corner" else -1) in keys
    second = np.zeros((len(base), len(base)))
    for group, share in point.rows.shares(lam):
        blocks = group.curvature(share)
        for joints, angles, matrix in zip(blocks.joints, blocks.angles, blocks.matrices, strict=True):
            k = len(matrix)
            J = over_unknowns(model, point.state, point.at, [Local(joints[None], angles[None], np.eye(k))])
            second += J.T @ matrix @ J
    fx, fy, _ = point.rows.forces(lam, model.n_joints, model.n_unknowns)
    _, _, over_theta, over_phi = pulled_back(model, point.state, point.at, fx, fy)
    exact = contact_rows(model, point)
    for _ in range(4):
        d = random.standard_normal(len(base))
        ahead, behind = at(base + 1e-6 * d, lam, point.rows), at(base - 1e-6 * d, lam, point.rows)
        assert ahead.rows.keys == behind.rows.keys == point.rows.keys
        assert exact @ d == pytest.approx((ahead.rows.values - behind.rows.values) / 2e-6, rel=1e-6, abs=1e-7)
        product = second @ d
        product[:n] += over_theta * d[:n]
        product[n + 2 :: 3] += over_phi * d[n + 2 :: 3]
        bent = (contact_gradient(model, ahead) - contact_gradient(model, behind)) / 2e-6
        assert product == pytest.approx(bent, rel=1e-5, abs=1e-5 * np.max(np.abs(bent)))


@pytest.mark.parametrize("kind", BENT)
def test_the_samples_alone_never_take_a_beam_for_farther_than_it_is(kind):
    contact = TypeAdapter(Contact).validate_python({**BENT[kind], "beam": "beam", "body": "wall"}, strict=False)
    mechanism = mechanism_of(arch().model_copy(update={"contacts": {"edge": contact}}), cprbm.Settings(links=13))
    model, edge = mechanism.problem.model, mechanism.pairs["edge"]
    random, rest = np.random.default_rng(11), rest_state(mechanism.problem.model)
    found = []
    for _ in range(40):
        theta = rest.theta * random.uniform(-1.0, 1.5) + random.uniform(-1.0, 1.0)
        state = State(theta + 0.1 * random.standard_normal(model.n_links), rest.bodies)
        at = positions(model, state)
        found.append((edge.no_closer(state, at), edge.least_gap(state, at)))
    bound, least = np.array(found).T
    assert np.all(bound <= least)
    assert edge.corners or np.median(least - bound) < 4.0 / 13 / 2  # so that it is worth asking


def test_a_line_in_pieces_that_go_on_straight_is_one_line():
    scene = arch(edge="line")
    pieces = tuple((x * LENGTH, 0.0) for x in (-0.1, 0.2, 0.61, 0.7, 3.0))
    line = scene.contacts["edge"].model_copy(update={"points": pieces})
    whole, parts = (solved(each, 40) for each in (scene, scene.model_copy(update={"contacts": {"edge": line}})))
    for name, value in whole.items():
        assert parts[name] == pytest.approx(value, rel=1e-6, abs=1e-9 * np.max(np.abs(value)))


@pytest.mark.parametrize("changes", [{}, {"edge": "line", "end": "end", "thick": True}])
def test_the_papers_form_is_of_first_order_beside_an_own_pin_where_auto_is_of_second(changes):
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
    auto = {n: errors_of(n, **changes)[1] for n in (20, 40, 80)}
    for n in (20, 40):
        assert 1.9 < lacks[n] / lacks[2 * n] < 2.1
        assert auto[n] / auto[2 * n] > 3.3


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
