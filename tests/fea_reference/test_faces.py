"""A beam on rigid lines, half-planes and functions: derivatives, and exact answers by shooting."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from cprbm_scene import Ending
from fea_reference import Settings, answer
from fea_reference.face import faces, passes_through, touch
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.fea_reference.on_an_edge import T, cantilever_over, scene_of
from tests.fea_reference.test_circle import wrapped
from tests.references.integrated import end_of

HALF_PLANE = {"kind": "beam-half-plane", "point": (0.0, 0.0), "normal": (0.0, 2.0)}
ROOF = {"kind": "beam-line", "points": ((0.2, -0.1), (0.4, 0.0), (0.55, -0.001), (0.8, -0.2)), "side": "left"}
SHELF = {"kind": "beam-line", "points": ((0.8, -0.2), (0.45, 0.0), (0.3, -0.08)), "side": "right"}
BLOCK = {**ROOF, "points": ((0.55, -0.001), (0.8, -0.2), (0.4, -0.4), (0.2, -0.1), (0.4, 0.0), (0.55, -0.001))}
VALLEY = {"kind": "beam-line", "points": ((0.2, 0.0), (0.5, -0.008), (0.8, 0.0)), "side": "left"}
HILL = {"kind": "beam-function", "axis": "x", "coefficients": (-0.05, 0.2, -0.2), "range": (0.1, 0.9), "side": "above"}
SIDEWAYS = {"kind": "beam-function", "axis": "y", "coefficients": (1.0, 2.0), "range": (-0.6, 0.0), "side": "below"}


def lowered(contact, by):
    """The same edge, ``by`` further down."""
    moved = dict(contact)
    if "points" in contact:
        moved["points"] = tuple((x, y - by) for x, y in contact["points"])
    if "point" in contact:
        moved["point"] = (0.0, -by)
    if contact.get("axis") == "x":
        moved["coefficients"] = (contact["coefficients"][0] - by, *contact["coefficients"][1:])
    if contact.get("axis") == "y":
        moved["range"], moved["coefficients"] = (-0.6, -by), (1.0 + 2.0 * by, 2.0)
    return moved


@pytest.mark.parametrize("contact", [HALF_PLANE, ROOF, BLOCK, SHELF, VALLEY, HILL, SIDEWAYS])
@pytest.mark.parametrize("thick", [True, False])
@pytest.mark.parametrize("body", ["ground", "block"])
@pytest.mark.parametrize("kinematics", ["bending", "shear"])
def test_the_derivatives(contact, thick, body, kinematics):
    """Gradient and tangent of ½ ε ∫ ⟨−g⟩² ds, moving ends of the zone and moving places at corners and all."""
    gap = 0.5 * T + 1e-4 if thick else 1e-4
    scene = cantilever_over({**lowered(contact, gap), "thick": thick}, body=body)
    model = build(scene, Settings(elements=9, kinematics=kinematics))
    face = faces(scene, model, 1e-4)[0]
    z = model.start.values + 1e-3 * np.random.default_rng(1).standard_normal(model.size)
    z[model.element_dofs[6]] = np.random.default_rng(2).standard_normal(9)
    z[model.node_dofs[1]] -= 0.013

    def gathered(z):
        one = touch(model, face, Penalty(1.0), 14, State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        return 0.5 * float((one.stiffness * one.gap**2).sum()), gradient, hessian

    value, gradient, hessian = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    rng = np.random.default_rng(7)
    for _ in range(3):
        v = np.zeros(model.size)
        v[model.moving] = rng.standard_normal(model.moving.size)
        v[model.element_dofs[6]] = rng.standard_normal(9)
        h = 1e-6
        ahead, behind = gathered(z + h * v), gathered(z - h * v)
        assert gradient @ v == pytest.approx((ahead[0] - behind[0]) / (2 * h), rel=1e-5, abs=1e-12)
        slope = (ahead[1] - behind[1]) / (2 * h)
        assert hessian @ v == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())


def peeled(drop, kappa):
    """An arc, EI = L = 1, pinned to a straight edge that it lies flat on from the pin to c, its tip ``drop`` lower.

    Beyond c, θ'' = F cos θ from θ = θ' = 0, for the flat part has no shear force, to θ' = κ⁰ at the tip, which has no
    moment.  The edge gives F at c and, at the pin, the moment κ⁰ that keeps the flat part flat.

    Returns:
        F, c, tip (2,), strain energy.
    """

    def free(force, length):
        def slope(_, v):
            theta, bent = v[:2]
            return [bent, force * np.cos(theta), np.cos(theta), np.sin(theta), 0.5 * (bent - kappa) ** 2]

        return end_of(slope, (0, length), np.zeros(5), rtol=1e-13, atol=1e-14)

    def unflat(force):
        return brentq(lambda length: free(force, length)[1] - kappa, 1e-6, 1.3 * kappa / force, xtol=1e-15)

    height = (1.0 - np.cos(kappa)) / kappa - drop
    force = brentq(lambda force: free(force, unflat(force))[3] - height, 1.3 * kappa, 20.0 * kappa, xtol=1e-13)
    length = unflat(force)
    _, _, x, y, energy = free(force, length)
    return force, 1.0 - length, np.array([1.0 - length + x, y]), energy + 0.5 * kappa**2 * (1.0 - length)


KAPPA, DROP = 1.0, 0.4


def on_its_pin(
    angle=0.0, *, contact=None, elements=20, kinematics="bending", thick=False, drop=DROP, thickness=T, joint="pin"
):
    """An arc pinned to the edge that it is tangent to at the pin, which stands at an ``angle``, or is turned there.

    A drive moves the tip down to the edge; the tip slides along the edge and turns.  The drive's body turns, too.
    """
    away = 0.5 * thickness if thick else 0.0
    cos, sin = math.cos(angle), math.sin(angle)

    def at(x, y):
        return (cos * x - sin * y, sin * x + cos * y)

    tip = at(math.sin(KAPPA) / KAPPA, (1.0 - math.cos(KAPPA)) / KAPPA)
    edge = contact or {"kind": "beam-line", "points": (at(0.0, -away), at(2.0, -away)), "side": "left"}
    scene = scene_of(
        {"kind": "arc", "center": at(0.0, 1 / KAPPA), "start": (0.0, 0.0), "end": tip, "direction": "counterclockwise"},
        {"joint": joint, "point": "root"},
        {"joint": "weld", "point": "tip"},
        {"body": "link", "thick": thick, **edge},
        bodies={
            "link": {"motion": "turns", "about": "root", "points": {"root": (0.0, 0.0)}},
            "block": {"motion": "free", "points": {"tip": tip}},
            "ground": {"motion": "fixed", "points": {"base": (0.0, -1.0)}},
        },
        drives={
            "phi": {"kind": "rotation", "body": "link"},
            "d": {"kind": "displacement", "point": "tip", "direction": at(0.0, -1.0)},
        },
        stages=(("d", (0.5 * drop, drop)),),
        probes=(
            ("tip", "displacement"),
            ("edge", "force"),
            ("edge", "ends"),
            ("edge", "moment"),
            ("link", "reaction_moment"),
            ("root", "reaction"),
            ("scene", "potential_energy"),
        ),
        thickness=thickness,
    )
    return np.array(tip), answer(scene, Settings(elements=elements, kinematics=kinematics))


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_beam_lies_on_the_edge_that_it_is_pinned_to(thick, side):
    away = 0.5 * T if thick else 0.0
    points = ((0.0, -away), (2.0, -away))
    contact = {"kind": "beam-line", "points": points if side == "left" else points[::-1], "side": side}
    force, c, tip, strain = peeled(DROP, KAPPA)
    drawn, found = on_its_pin(contact=contact, elements=40, thick=thick)
    assert found.ending is Ending.COMPLETED, found.sentence
    assert [event.contact for event in found.events] == ["edge"]
    values = found.stations[-1].values
    moved = tip - drawn
    assert values["tip.displacement"] == pytest.approx(moved, abs=2e-5)
    assert values["scene.potential_energy"][0] == pytest.approx(strain, rel=2e-5)
    assert values["edge.force"][0] == pytest.approx(force, rel=1e-3)
    assert values["edge.ends"] == pytest.approx([0.0, c], abs=1e-3)
    # the ground balances the tip's force, and about the pin the edge does
    assert values["edge.moment"][0] == pytest.approx(force * tip[0], rel=1e-4)
    assert values["link.reaction_moment"][0] == pytest.approx(force * tip[0], rel=1e-4)
    assert values["root.reaction"] == pytest.approx([0.0, force], rel=1e-4, abs=1e-6)


def test_beside_its_pin_the_error_goes_with_the_square_of_the_element():
    force, c, tip, strain = peeled(DROP, KAPPA)
    errors = []
    for elements in (10, 20, 40, 80):
        _, found = on_its_pin(elements=elements)
        values = found.stations[-1].values
        errors.append(
            [
                abs(values["scene.potential_energy"][0] - strain),
                abs(values["link.reaction_moment"][0] - force * tip[0]),
                abs(values["edge.moment"][0] - force * tip[0]),
                abs(values["edge.force"][0] - force),
                abs(values["edge.ends"][1] - c),
            ]
        )
    errors = np.array(errors)
    fallen = np.log2(errors[0] / errors[-1]) / 3.0
    assert np.all(fallen[:3] > 1.8), fallen
    assert np.all(fallen[3:] > 1.3), fallen


@pytest.mark.parametrize("kinematics", ["bending", "shear"])
def test_an_edge_may_stand_at_any_angle(kinematics):
    _, level = on_its_pin(kinematics=kinematics)
    _, steep = on_its_pin(2.2, kinematics=kinematics)
    for quantity in ("scene.potential_energy", "edge.force", "edge.moment", "edge.ends"):
        one, other = (found.stations[-1].values[quantity] for found in (level, steep))
        assert other == pytest.approx(one, rel=1e-7, abs=1e-12)


@pytest.mark.parametrize(
    "contact",
    [
        {"kind": "beam-half-plane", "point": (5.0, 0.0), "normal": (0.0, 0.1)},
        {"kind": "beam-line", "points": ((2.0, 0.0), (0.0, 0.0), (-1.0, 0.3)), "side": "right"},
        {"kind": "beam-line", "points": ((-2.0, -1.0), (0.0, 0.0), (0.2, 0.0), (3.0, 0.0)), "side": "left"},
        {"kind": "beam-function", "axis": "x", "coefficients": (0.0, 0.0), "range": (-0.5, 3.0), "side": "above"},
    ],
)
def test_the_same_edge_said_in_other_ways(contact):
    _, line = on_its_pin()
    _, other = on_its_pin(contact=contact)
    assert other.ending is Ending.COMPLETED, other.sentence
    for quantity in ("scene.potential_energy", "edge.force", "edge.moment", "edge.ends"):
        first, second = (found.stations[-1].values[quantity] for found in (line, other))
        assert second == pytest.approx(first, rel=1e-9, abs=1e-12)


def test_a_beam_that_is_drawn_beyond_its_own_edge_by_rounding_lies_along_it():
    # reference: peeled() on the edge itself, from which an edge that turns by so little is as far
    beyond, (force, c, _, strain) = 7.3e-6, peeled(DROP, KAPPA)
    contact = {"kind": "beam-half-plane", "point": (0.0, 0.0), "normal": (-math.sin(beyond), math.cos(beyond))}
    for elements in (20, 80):
        _, found = on_its_pin(contact=contact, elements=elements)
        assert found.ending is Ending.COMPLETED, found.sentence
        values = found.stations[-1].values
        assert values["scene.potential_energy"][0] == pytest.approx(strain, rel=2e-4)
        assert values["edge.force"][0] == pytest.approx(force, rel=1e-2)
        assert values["edge.ends"] == pytest.approx([0.0, c], abs=1e-2)


def test_an_edge_on_another_body_that_stands_still_holds_the_pin_too():
    # reference: peeled(); bodies that do not move are one
    force, _, tip, strain = peeled(DROP, KAPPA)
    drawn = (math.sin(KAPPA) / KAPPA, (1.0 - math.cos(KAPPA)) / KAPPA)
    scene = scene_of(
        {"kind": "arc", "center": (0.0, 1 / KAPPA), "start": (0.0, 0.0), "end": drawn, "direction": "counterclockwise"},
        {"joint": "pin", "point": "root"},
        {"joint": "weld", "point": "tip"},
        {"body": "bench", "thick": False, "kind": "beam-half-plane", "point": (0.3, 0.0), "normal": (0.0, 1.0)},
        bodies={
            "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
            "bench": {"motion": "fixed", "points": {"leg": (0.3, -1.0)}},
            "block": {"motion": "free", "points": {"tip": drawn}},
        },
        drives={"d": {"kind": "displacement", "point": "tip", "direction": (0.0, -1.0)}},
        stages=(("d", (DROP,)),),
        probes=(("tip", "displacement"), ("edge", "force"), ("scene", "potential_energy")),
    )
    values = answer(scene, Settings(elements=40, kinematics="bending")).stations[-1].values
    assert values["tip.displacement"] == pytest.approx(tip - drawn, abs=2e-5)
    assert values["scene.potential_energy"][0] == pytest.approx(strain, rel=2e-5)
    assert values["edge.force"][0] == pytest.approx(force, rel=1e-3)


def over_a_corner(force, a, b):
    """A cantilever along x, EI = L = 1, over a corner at (a, −b): a dead force at its tip, and N across the beam there.

    Returns:
        arc length to the corner, N, tip (2,).
    """

    def slope(pull):
        # EI θ' = M, M' = −(F × t) with the force F on what follows
        return lambda _, v: [v[1], pull[0] * np.sin(v[0]) - pull[1] * np.cos(v[0]), np.cos(v[0]), np.sin(v[0])]

    def marched(guess):
        s, N, M, theta = guess
        push = N * np.array([-np.sin(theta), np.cos(theta)])
        after = np.array([0.0, -force])
        before = end_of(slope(after + push), (0, s), [0, M, 0, 0])
        return before, end_of(slope(after), (s, 1), before)

    def missed(guess):
        at, tip = marched(guess)
        return [at[2] - a, at[3] + b, tip[1], at[0] - guess[3]]

    found, _, flag, _ = fsolve(missed, [a, 2.0 * force, -0.5, -0.3], full_output=True, xtol=1e-13)
    assert flag == 1
    return found[0], found[1], marched(found)[1][2:]


@pytest.mark.parametrize(
    "points",
    [
        ((0.2, -0.3), (0.5, -0.02), (0.8, -0.3)),  # a roof
        ((0.0, -0.02), (0.5, -0.02)),  # the end of a shelf
        ((0.5, -0.6), (0.5, -0.02), (0.7, -0.5)),  # a sharp edge
        ((0.5, -0.02), (0.8, -0.3), (0.2, -0.3), (0.5, -0.02)),  # a block, round
    ],
)
def test_a_corner_presses_on_the_side_of_a_beam(points):
    s, N, tip = over_a_corner(3.0, 0.5, 0.02)
    scene = cantilever_over({"kind": "beam-line", "points": points, "side": "left", "thick": False}, force=3.0)
    found = answer(scene, Settings(elements=40, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    assert values["edge.force"][0] == pytest.approx(N, rel=1e-3)
    assert values["edge.ends"] == pytest.approx([s, s], abs=1e-2)
    assert values["tip.displacement"] == pytest.approx(tip - [1.0, 0.0], abs=2e-4)


SLOPE, GAP, PRESSED = 0.5, 0.1, 0.15


@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("moving", ["wall", "floor"])
def test_a_tip_presses_on_a_floor(thick, moving):
    """A straight beam that is clamped aslant goes down, or the floor comes up, until its tip slides on that."""
    floor = -math.sin(SLOPE) - GAP - (0.5 * T if thick else 0.0)
    still, way = ("floor", -1.0) if moving == "wall" else ("wall", 1.0)
    points = {"wall": {"root": (0.0, 0.0)}, "floor": {"foot": (0.0, floor)}}
    scene = scene_of(
        {"kind": "line", "start": (0.0, 0.0), "end": (math.cos(SLOPE), -math.sin(SLOPE))},
        {"joint": "weld", "point": "root"},
        {"joint": "free"},
        {"kind": "beam-line", "body": "floor", "points": ((0.2, floor), (1.5, floor)), "side": "left", "thick": thick},
        bodies={
            still: {"motion": "fixed", "points": points[still]},
            moving: {"motion": "slides", "along": (0.0, 1.0), "points": points[moving]},
        },
        drives={"d": {"kind": "displacement", "point": next(iter(points[moving])), "direction": (0.0, way)}},
        stages=(("d", (GAP + PRESSED,)),),
        probes=(("edge", "force"), ("edge", "ends"), ("edge", "closing_load"), ("scene", "potential_energy")),
    )

    def tip(force):
        """θ, θ', y and the energy at the tip under a force upwards: θ'' = −R cos θ."""

        def free(bent):
            def slope(_, v):
                return [v[1], -force * np.cos(v[0]), np.sin(v[0]), 0.5 * v[1] ** 2]

            return end_of(slope, (0, 1), [-SLOPE, bent, 0, 0])

        return free(brentq(lambda bent: free(bent)[1], 0.0, 2.0 * force, xtol=1e-14))

    force = brentq(lambda force: tip(force)[2] + math.sin(SLOPE) - PRESSED, 1e-3, 10.0, xtol=1e-13)
    found = answer(scene, Settings(elements=20, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    assert values["edge.closing_load"][0] == pytest.approx(GAP, abs=1e-8)
    assert values["edge.force"][0] == pytest.approx(force, rel=1e-4)
    assert values["scene.potential_energy"][0] == pytest.approx(tip(force)[3], rel=1e-4)
    assert values["edge.ends"] == pytest.approx([1.0, 1.0], abs=1e-3)


@pytest.mark.parametrize("thick", [False, True])
def test_a_function_holds_like_the_circle_that_it_follows(thick):
    """Taylor's polynomial of a circle's top, against the exact wrap."""
    radius, force = 0.5 + (0.5 * T if thick else 0.0), 6.0
    tip, _, resultant = wrapped(force, radius)
    own = radius - 0.5 * T if thick else radius
    # √(ρ² − x²) − ρ by the binomial series, to where it is exact on the wrap
    series, term = [], own
    for k in range(16):
        series += [term, 0.0]
        term *= -(0.5 - k) / ((k + 1) * own**2)
    series[0] -= radius
    contact = {
        "kind": "beam-function",
        "axis": "x",
        "coefficients": tuple(series[:21]),
        "range": (-0.02, 0.33),
        "side": "above",
        "thick": thick,
    }
    scene = cantilever_over(contact, force=force)
    found = answer(scene, Settings(elements=80, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    values = found.stations[-1].values
    assert values["tip.displacement"] == pytest.approx(tip - [1.0, 0.0], abs=2e-4)
    assert values["edge.force"][0] == pytest.approx(np.hypot(*resultant), rel=2e-2)


def test_what_goes_through_an_edge_is_seen():
    scene = cantilever_over({"kind": "beam-line", "points": ((0.3, -0.1), (0.6, -0.1)), "side": "left", "thick": False})
    model = build(scene, Settings(elements=20))
    face = faces(scene, model, 1e-4)[0]

    def lowered(by):
        z = model.start.values.copy()
        z[model.node_dofs[1]] -= by
        return State.of(z)

    assert not passes_through(model, face, model.start, lowered(0.05))
    assert not passes_through(model, face, model.start, lowered(0.12))  # sunk in, and held for it
    assert passes_through(model, face, model.start, lowered(0.3))
    beside = cantilever_over({"kind": "beam-line", "points": ((1.3, -0.1), (1.6, -0.1)), "side": "left"})
    assert not passes_through(model, faces(beside, model, 1e-4)[0], model.start, lowered(0.3))


def test_what_slides_over_a_tip_that_it_has_sunk_onto_goes_through_nothing():
    # by construction: a straight beam moved along itself, some of whose places go in on one side of the tip and come
    # out of the other; and moved as far, from before a tip that it is far below, through that
    def moved(place, height, by):
        points = ((place - 0.1, height - 0.1), (place, height), (place + 0.1, height - 0.1))
        scene = cantilever_over({"kind": "beam-line", "points": points, "side": "left", "thick": False})
        model = build(scene, Settings(elements=20))
        face = faces(scene, model, 1e-4)[0]
        states = []
        for way in by:
            z = model.start.values.copy()
            z[model.node_dofs[0]] += way
            states.append(State.of(z))
        return passes_through(model, face, *states)

    assert not moved(0.5, 1e-4, (-3e-4, 3e-4))
    assert not moved(0.5, 1e-4, (3e-4, -3e-4))
    assert not moved(0.5, 1e-4, (-0.11, 0.13))  # some elements farther
    assert moved(1.1, 0.05, (0.0, 0.4))


def test_a_strip_that_buckles_against_a_wall_does_not_feel_joints_of_the_wall():
    """Reference: the wall in one piece."""
    forces = []
    for inner in ((), ((0.3, 0.03), (0.61, 0.03))):
        scene = scene_of(
            {"kind": "spline", "points": ((0.0, 0.0), (0.25, 1e-3), (0.5, 2e-3), (0.75, 1e-3), (1.0, 0.0))},
            {"joint": "weld", "point": "root"},
            {"joint": "weld", "point": "tip"},
            {"kind": "beam-line", "body": "ground", "points": ((-1.0, 0.03), *inner, (2.0, 0.03)), "side": "right"},
            bodies={
                "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
                "slider": {"motion": "slides", "points": {"tip": (1.0, 0.0)}, "along": (1.0, 0.0)},
            },
            drives={"v": {"kind": "displacement", "point": "tip", "direction": (-1.0, 0.0)}},
            stages=(("v", (3e-3,)),),
            probes=(("edge", "force"), ("tip", "reaction")),
        )
        solved = answer(scene, Settings(elements=12))
        assert solved.completed, solved.sentence
        forces.append(solved.stations[-1].values["edge.force"])
    assert forces[0] > 0.0
    assert forces[1] == pytest.approx(forces[0], rel=1e-9)
