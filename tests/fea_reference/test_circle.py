"""A beam on a rigid circle: pressed at a point, and wrapped over a stretch, against exact answers."""

import numpy as np
import pytest
from scipy.optimize import brentq

from cprbm_scene import Ending, Profile, Scene, Stage
from cprbm_scene.statement import Force
from fea_reference import Settings, answer
from fea_reference.circle import circles, passes_through, touch
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.cprbm import test_circle as cprbm_circle
from tests.references.integrated import end_of

T, WIDTH = 0.01, 0.05
YOUNG = 12 / (WIDTH * T**3)  # so that EI = 1
FORCE, RADIUS = 6.0, 0.5


def wrapped(force, radius, direction=np.pi / 2):
    """An inextensible cantilever clamped tangent on top of a circle of neutral radius R, EI = L = 1.

    θ is the downward turning, ``direction`` β that of the dead tip force: a right angle is straight down.
    On the wrap the curvature is 1/R, so there is no shear and the tension T = F cos(β − θc) is constant.
    Beyond, θ'' = −F sin(β − θ) from θ = c/R and θ' = 1/R to a tip free of moment.

    Returns:
        Tip (2,), its angle, and the circle's force on the beam (2,).
    """

    def free(c):
        def slope(_, v):
            return [v[1], -force * np.sin(direction - v[0]), np.cos(v[0]), -np.sin(v[0])]

        return end_of(slope, (0, 1 - c), [c / radius, 1 / radius, 0, 0], rtol=1e-13, atol=1e-14)

    # From the longest wrap, which an endless beam would have, down to the first that leaves the tip no moment.
    longest = radius * (direction - np.arccos(1 - 1 / (2 * force * radius**2)))
    shorter = next(c for c in longest * (1 - np.geomspace(1e-12, 0.9, 80)) if c < 1 and free(c)[1] < 0)
    c = brentq(lambda c: free(c)[1], shorter, min(longest, 1.0), xtol=1e-15)
    angle, _, x, y = free(c)
    lift = c / radius
    # The first integral of the elastica, which the integration knows nothing of.
    energy = 2 * force * (np.cos(direction - angle) - np.cos(direction - lift))
    assert 1 / radius**2 == pytest.approx(energy, rel=1e-9)
    tip = np.array([radius * np.sin(lift) + x, radius * (np.cos(lift) - 1) + y])
    # The clamp holds the tension, and nothing across.
    clamp = np.array([-force * np.cos(direction - lift), 0.0])
    return tip, -angle, -clamp - force * np.array([np.cos(direction), -np.sin(direction)])


def on_circle(forces, radius=RADIUS, *, units=1.0, thick=True, body="ground", center=(0.0, None), circle=None):
    """A cantilever from the origin along x, its tip pressed down; a circle below it."""
    middle = (units * center[0], -units * radius if center[1] is None else units * center[1])
    return Scene.model_validate(
        {
            "name": "circle",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}},
                "end": {"motion": "free", "points": {"tip": (units, 0.0)}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": (0.0, 0.0), "end": (units, 0.0)},
                    "thickness": units * T,
                    "width": units * WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "root"},
                    "end": {"joint": "weld", "point": "tip"},
                }
            },
            "loads": {"P": {"kind": "force", "point": "tip", "direction": (0.0, -1.0)}},
            "contacts": {
                "contact": {
                    "kind": "beam-circle",
                    "beam": "beam",
                    "body": body,
                    "center": middle,
                    "radius": units * (circle or radius - (T / 2 if thick else 0.0)),
                    "thick": thick,
                }
            },
            "stages": ({"name": "load", "steps": "P", "stations": tuple(units**2 * force for force in forces)},),
            "probes": (
                {"of": "tip", "quantity": "displacement"},
                {"of": "end", "quantity": "rotation"},
                {"of": "contact", "quantity": "force"},
                {"of": "contact", "quantity": "centre"},
                {"of": "contact", "quantity": "closing_load"},
                {"of": "root", "quantity": "reaction"},
                {"of": "root", "quantity": "reaction_moment"},
            ),
        }
    )


def solved(scene, **settings):
    got = answer(scene, Settings(**{"kinematics": "bending", "elements": 80, **settings}))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got


@pytest.mark.parametrize(("force", "radius"), [(FORCE, RADIUS), (2.0, 0.8)])
def test_a_beam_wraps_round_a_circle(force, radius):
    tip, rotation, pushed = wrapped(force, radius)
    got = solved(on_circle((0.5 * force, force), radius))
    values = got.stations[-1].values
    assert values["tip.displacement"] + (1.0, 0.0) == pytest.approx(tip, abs=2e-6)
    assert values["end.rotation"][0] == pytest.approx(rotation, abs=2e-6)
    assert values["root.reaction_moment"][0] == pytest.approx(1 / radius, rel=1e-3)
    assert values["contact.force"][0] == pytest.approx(np.hypot(*pushed), rel=1e-5)
    assert values["root.reaction"] == pytest.approx(np.array([0.0, force]) - pushed, abs=2e-5 * force)
    places = got.stations[-1].touching["contact"]
    assert np.hypot(places[:, 0], places[:, 1] + radius) == pytest.approx(
        np.full(len(places), radius - T / 2), rel=1e-5
    )


def test_the_clamp_takes_nothing_of_the_pressure():
    """Beside the clamp the beam neither sinks in nor bulges: all of the resultant is the circle's."""
    tip, _, pushed = wrapped(FORCE, RADIUS)
    for n in (20, 60):
        values = solved(on_circle((FORCE,)), elements=n).stations[0].values
        assert values["contact.force"][0] == pytest.approx(np.hypot(*pushed), rel=5e-5)
        assert values["root.reaction"] == pytest.approx(np.array([0.0, FORCE]) - pushed, abs=1e-4 * FORCE)
        assert values["tip.displacement"] + (1.0, 0.0) == pytest.approx(tip, abs=1e-4)


def test_more_than_half_a_circle():
    """The tip is pulled down, then back below the circle, then up."""
    radius, back, up = 0.15, 400.0, 150.0
    scene = on_circle((200.0,), radius)
    pull = Force(kind="force", point="tip", direction=(-1.0, 0.0))
    stages = (
        *scene.stages,
        Stage(name="back", steps="Q", stations=(back,)),
        Stage(name="up", steps="P", stations=(0.0, -up)),
    )
    got = solved(scene.model_copy(update={"loads": {**scene.loads, "Q": pull}, "stages": stages}), elements=160)
    direction = np.pi + np.arctan2(up, back)
    tip, rotation, pushed = wrapped(np.hypot(back, up), radius, direction)
    assert rotation < -np.pi
    values = got.stations[-1].values
    assert values["tip.displacement"] + (1.0, 0.0) == pytest.approx(tip, abs=1e-5)
    assert values["end.rotation"][0] == pytest.approx(rotation, abs=1e-6)
    assert values["contact.force"][0] == pytest.approx(np.hypot(*pushed), rel=1e-4)


def test_the_search_for_the_zone_does_not_feel_the_mesh():
    """From the mesh with the stiffest penalty on, the number of iterations stays; below, the number grows little."""
    coarse, *fine = (solved(on_circle((FORCE,)), elements=n).stations[0].certificate.iterations for n in (40, 160, 640))
    assert max(fine) <= 1.1 * min(fine)
    assert max(fine) <= 1.5 * coarse


@pytest.mark.parametrize("thick", [True, False])
def test_a_small_circle_props_a_cantilever(thick):
    """Small loads on a line clamped at 0, touched at a, pressed by F at 1: R = F (3 − a)/(2 a) at rest on it."""
    a, force = 0.4, 1e-3
    below = -0.01 - (T / 2 if thick else 0.0)
    scene = on_circle((force,), thick=thick, center=(a, below), circle=0.01)
    values = solved(scene, penetration=1e-6 if thick else 1e-8).stations[0].values
    prop = force * (3 - a) / (2 * a)
    assert values["contact.force"][0] == pytest.approx(prop, rel=2e-3)
    assert values["contact.centre"][0] == pytest.approx(a, rel=1e-2)
    assert values["root.reaction"][1] == pytest.approx(force - prop, rel=1e-2)


def test_a_circle_that_a_beam_carries():
    """Two cantilevers of EI = 1 that start in touch: the circle at the upper one's tip takes half of its load."""
    a, radius, force = 0.6, 0.05, 1e-3
    y = radius + T / 2
    upper = {
        "curve": {"kind": "line", "start": (0.0, y), "end": (a, y)},
        "thickness": T,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": "weld", "point": "above"},
        "end": {"joint": "weld", "point": "tip"},
    }
    plain = on_circle((force,), body="end", center=(a, y), circle=radius).model_dump()
    plain["beams"] = {"upper": upper, "beam": {**plain["beams"]["beam"], "end": {"joint": "free"}}}
    plain["bodies"] = {
        "ground": {"motion": "fixed", "points": {"root": (0.0, 0.0), "above": (0.0, y)}},
        "end": {"motion": "free", "points": {"tip": (a, y)}},
    }
    values = solved(Scene.model_validate(plain), penetration=1e-6).stations[0].values
    assert values["contact.force"][0] == pytest.approx(force / 2, rel=3e-3)
    assert values["contact.centre"][0] == pytest.approx(a, rel=1e-3)
    assert values["root.reaction"][1] == pytest.approx(values["contact.force"][0], rel=1e-4)
    assert values["root.reaction_moment"][0] == pytest.approx(a * force / 2, rel=5e-3)


def test_it_closes_where_the_gap_does():
    """A gap g under the point a closes at F = 6 g / (a² (3 − a)), EI = L = 1."""
    a, gap = 0.5, 1e-4
    closing = 6 * gap / (a**2 * (3 - a))
    scene = on_circle((0.5 * closing, 2 * closing), center=(a, -0.001 - T / 2 - gap), circle=0.001)
    below, above = (station.values for station in solved(scene).stations)
    assert below["contact.force"][0] == 0.0
    # At the first touch the slope is not zero: the circle of 1e-3 is met a little to the right.
    assert above["contact.closing_load"][0] == pytest.approx(closing, rel=1e-3)


def test_the_units_do_not_matter():
    one, other = (solved(on_circle((FORCE,), units=units)).stations[0].values for units in (1.0, 1e-3))
    assert other["tip.displacement"] * 1e3 == pytest.approx(one["tip.displacement"], rel=1e-9)
    assert other["contact.force"] * 1e6 == pytest.approx(one["contact.force"], rel=1e-5)


def test_doubling_the_rule_changes_nothing():
    once, twice = (solved(on_circle((FORCE,)), quadrature=q).stations[0].values for q in (6, 12))
    assert once["contact.force"] == pytest.approx(twice["contact.force"], rel=1e-6)
    assert once["tip.displacement"] == pytest.approx(twice["tip.displacement"], rel=1e-9)


@pytest.mark.parametrize("thickness", [T, Profile(at=(0.0, 0.4, 1.0), values=(0.6 * T, T, 0.7 * T))])
@pytest.mark.parametrize("body", ["ground", "end"])
@pytest.mark.parametrize("depth", [1e-5, 1e-3])
def test_the_contacts_derivatives(body, depth, thickness):
    """Gradient and tangent of ½ ε ∫ ⟨−g⟩² ds by differences, also over the motion of a free body."""
    scene = on_circle((1.0,), body=body, center=(0.4, -0.2), circle=0.2 - T / 2 + depth)
    beam = scene.beams["beam"].model_copy(update={"thickness": thickness})
    scene = scene.model_copy(update={"beams": {"beam": beam}})
    model = build(scene, Settings(elements=9))
    (circle,) = circles(scene, model, 1e-4)
    rng = np.random.default_rng(5)
    z = model.start.values + 0.02 * depth * rng.standard_normal(model.size)

    def gathered(z):
        one = touch(model, circle, Penalty(1.0), 12, State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        g = ((one.x - one.x_m) * one.normal).sum(axis=0) - circle.edge.at(one.zeta)
        return 0.5 * float(np.hypot(*one.force) @ -g), gradient, hessian

    value, gradient, hessian = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    moving = np.concatenate([model.node_dofs.ravel(), model.element_dofs[6], model.bodies[1].dofs])
    for _ in range(4):
        v = np.zeros(model.size)
        v[moving] = rng.standard_normal(moving.size)
        h = 1e-4 * depth
        ahead, behind = gathered(z + h * v), gathered(z - h * v)
        assert gradient @ v == pytest.approx((ahead[0] - behind[0]) / (2 * h), rel=1e-5)
        slope = (ahead[1] - behind[1]) / (2 * h)
        assert hessian @ v == pytest.approx(slope, abs=1e-4 * np.abs(slope).max())


def test_a_circle_is_not_stepped_over():
    """A circle far smaller than the step of the tip, in its way."""
    scene = on_circle((FORCE,), center=(0.9, -0.2), circle=0.002)
    model = build(scene, Settings(elements=20))
    (circle,) = circles(scene, model, 1e-4)
    turned = model.start.values.copy()
    turned[model.node_dofs[1]] = -turned[model.node_dofs[0]]
    assert passes_through(model, circle, model.start, State.of(turned))
    assert not passes_through(model, circle, model.start, model.start)
    got = solved(scene, elements=40, kinematics="stretch")
    assert got.stations[0].values["contact.force"][0] > 0.0


def test_a_tip_that_would_cut_through_a_circle_in_one_step_comes_to_lie_on_it():
    """Without contact the tip is on the other side at this load; the place and the force are those of other meshes."""
    length = cprbm_circle.BEAM["length"]
    center = [0.94 * length, -(0.31 * length + cprbm_circle.BEAM["thickness"] / 2.0)]
    scene = cprbm_circle.scene_of([77.0], radius=0.143 * length, center=center, angle=-1.684)
    found = [answer(scene, Settings(elements=n, kinematics="bending")) for n in (40, 320)]
    coarse, fine = (one.stations[0].values for one in found)
    assert coarse["circle.ends"][0] > 0.98 * length
    assert coarse["circle.force"] == pytest.approx(fine["circle.force"], rel=1e-4)
