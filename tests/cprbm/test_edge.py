"""Contact with straight edges and graphs: derivatives, and beams that are pressed on them against closed forms."""

import numpy as np
import pytest
from pydantic import TypeAdapter

import cprbm
from cprbm import equilibrium as newton
from cprbm.contact import NO_ROWS
from cprbm.equilibrium import contact_gradient, contact_rows, local_rows, point_at
from cprbm.kinematics import State, pulled_back, rest_state
from cprbm.mechanism import mechanism_of
from scene import SceneError
from scene.reading import scene_from
from scene.statement import Contact
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
                {"of": "edge", "quantity": "moment"},
                {"of": "scene", "quantity": "potential_energy"},
            ],
        }
    )


def solved(scene, links):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    assert max(answer.stations[-1].certificate.force_balance, answer.stations[-1].certificate.moment_balance) < 1e-9
    return answer.stations[-1].values


def errors_of(links, **changes):
    """Of the tip's place, energy, moment, reaction, force and end."""
    values = solved(arch(**changes), links)
    begin, end = values["edge.ends"]
    if changes.get("end") == "end":
        begin, end = LENGTH - end, LENGTH - begin
    assert begin == pytest.approx(0.0, abs=1e-15)
    return np.array(
        [
            np.hypot(*(values["T.displacement"] + CURVED.drawn - CURVED.tip)) / LENGTH,
            abs(values["scene.potential_energy"][0] / CURVED.energy - 1.0),
            abs(values["edge.moment"][0] / CURVED.moment - 1.0),
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
    assert values["edge.moment"][0] == pytest.approx(CURVED.moment, rel=2.0 / 40**2)
    assert values["edge.force"][0] == pytest.approx(CURVED.force, rel=2.0 / 40**2)
    assert values["edge.ends"][1] == pytest.approx(CURVED.flat, abs=2.0 / 40**2 * LENGTH)
    assert values["scene.potential_energy"][0] == pytest.approx(CURVED.energy, rel=2.0 / 40**2)
    monkeypatch.setattr(newton, "MANY", 0)
    other = solved(arch(turn=0.7, edge="line"), 40)
    for name, value in values.items():
        assert other[name] == pytest.approx(value, rel=1e-7, abs=1e-9 * np.max(np.abs(value)))


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
    assert values["edge.moment"][0] == 0.0
    assert values["edge.force"][0] == pytest.approx(CURVED.force, rel=2.0 / 40**2)
    assert values["edge.ends"] == pytest.approx([CURVED.flat, CURVED.flat], abs=2.0 / 40**2 * LENGTH)


CORNER = [0.55 * LENGTH, -0.37 * LENGTH]
BENT = {
    "line": {"kind": "beam-line", "points": [[-0.01, 0.002], [0.03, 0.001], [0.9, -0.2]], "side": "left"},
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
}


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("kind", list(BENT))
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
    assert point.rows.size >= (1 if kind == "corner" else 4)
    keys = {key for _, key in point.rows.keys}
    assert (2 * (13 + 2) + 1 if kind == "corner" else -1) in keys  # a place of its own: the second corner's
    second = np.zeros((len(base), len(base)))
    for group, share in point.rows.shares(lam):
        blocks = group.curvature(share)
        J = local_rows(model, point.state, point.at, blocks.joints, blocks.angles)
        second += np.einsum("gkn,gkl,glm->nm", J, blocks.matrices, J)
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


def test_a_line_in_pieces_that_go_on_straight_is_one_line():
    scene = arch(edge="line")
    pieces = tuple((x * LENGTH, 0.0) for x in (-0.1, 0.2, 0.61, 0.7, 3.0))
    line = scene.contacts["edge"].model_copy(update={"points": pieces})
    whole, parts = (solved(each, 40) for each in (scene, scene.model_copy(update={"contacts": {"edge": line}})))
    for name, value in whole.items():
        assert parts[name] == pytest.approx(value, rel=1e-6, abs=1e-9 * np.max(np.abs(value)))


def test_the_papers_form_has_no_edges():
    with pytest.raises(SceneError, match=r"contacts\.edge\.kind: found 'beam-half-plane'.*'auto'"):
        cprbm.answer(arch(), cprbm.Settings(links=20, formulation="paper"))
