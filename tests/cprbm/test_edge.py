"""Contact with straight edges and graphs: derivatives, and beams that are pressed on them against closed forms."""

import numpy as np
import pytest

import cprbm
from cprbm import equilibrium as newton
from cprbm.contact import NO_ROWS
from cprbm.equilibrium import contact_gradient, contact_rows, local_rows, point_at
from cprbm.kinematics import State, pulled_back, rest_state
from cprbm.mechanism import mechanism_of
from scene.reading import scene_from
from tests.references.flattened import Flattened
from tests.together.pivots import LENGTH, MATERIALS, RIGIDITY, STRIP, THICKNESS, pin, weld

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
        beam = {"start": held, "end": free, "curve": curve | {"start": ends[0], "end": ends[1], "direction": "counterclockwise"}}
    else:
        beam = {"start": free, "end": held, "curve": curve | {"start": ends[1], "end": ends[0], "direction": "clockwise"}}
    moves = turn != 0.0
    push = {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}
    way = part * (CURVED.drawn[1] - CURVED.tip[1])
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
            "stages": [{"name": "push", "steps": "push", "stations": [way]}],
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
    print({n: (e * n**2).round(2).tolist() for n, e in errors.items()})
    for coarse, fine in ((20, 40), (40, 80), (80, 160)):
        assert np.all(errors[coarse][:4] / errors[fine][:4] > 3.3)
    for n, found in errors.items():
        assert np.all(found < 4.0 / n**2)


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("edge", list(EDGES))
def test_every_kind_of_edge_is_the_same_straight_one(edge, thick):
    # reference: tests.references.flattened
    assert np.all(errors_of(40, edge=edge, thick=thick) < 3.0 / 40**2)
