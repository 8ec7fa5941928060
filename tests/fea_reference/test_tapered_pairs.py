"""Two beams whose thickness varies, or one and itself, that touch by their edges."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from cprbm_scene import Answer, Ending, Scene, scene_from
from fea_reference import Settings, answer
from fea_reference.contact import pairs, touch
from fea_reference.edge import Edge
from fea_reference.facing import Tapers
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.fea_reference.differences import check
from tests.fea_reference.meeting_itself import HALF, START, arch, half

YOUNG, WIDTH, LENGTH = 2e9, 0.01, 0.1
THICK, THIN = 0.003, 0.0012
FORCE = YOUNG * WIDTH * THIN**3 / 12.0 / LENGTH**2
HARD = 1e6  # times as stiff: as good as rigid
RADIUS = 0.025  # of the two arcs


def profile(*values: float) -> dict[str, Any]:
    return {"at": np.linspace(0.0, 1.0, len(values)).tolist(), "values": list(values)}


def beam(curve: dict[str, Any], thickness: Any, start: dict[str, Any], end: dict[str, Any], material: str = "m"):
    return {
        "curve": curve,
        "thickness": thickness,
        "width": WIDTH,
        "material": material,
        "start": start,
        "end": end,
    }


def weld(point: str) -> dict[str, Any]:
    return {"joint": "weld", "point": point}


def whole(scene: Scene, elements: Any) -> Answer:
    got = answer(scene, Settings(elements=elements, kinematics="bending", penetration=1e-5))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got


def solved(scene: Scene, elements: Any = 40):
    return whole(scene, elements).stations[-1].values


def pressed(contact: dict[str, Any], load: float, thickness: Any, points: dict[str, Any], **beams: Any) -> Scene:
    """A level cantilever, pressed down at its tip on something below it."""
    level = {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]}
    return scene_from(
        {
            "name": "tapered",
            "theory": "bending",
            "materials": {
                "m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3},
                "hard": {"youngs_modulus": HARD * YOUNG, "poisson_ratio": 0.3},
            },
            "bodies": {
                "ground": {"motion": "fixed", "points": {"R": [0.0, 0.0], **points}},
                "end": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {"beam": beam(level, thickness, weld("R"), weld("T")), **beams},
            "loads": {"P": {"kind": "force", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {"c": contact},
            "stages": [{"name": "load", "steps": "P", "stations": [load]}],
            "probes": [
                *({"of": "c", "quantity": quantity} for quantity in ("force", "centre", "ends", "closing_load")),
                {"of": "T", "quantity": "displacement"},
                {"of": "R", "quantity": "reaction"},
                {"of": "R", "quantity": "reaction_moment"},
            ],
        }
    )


def on_a_beam(other: dict[str, Any], load: float, thickness: Any) -> Scene:
    """The cantilever on a stiff beam that is clamped where it starts."""
    points = {"S": other["curve"]["start"]}
    return pressed({"kind": "beam-beam", "between": ["beam", "other"]}, load, thickness, points, other=other)


def on_what_is_rigid(contact: dict[str, Any], load: float, thickness: Any) -> Scene:
    return pressed({"beam": "beam", "body": "ground", **contact}, load, thickness, {})


def alike(found: Any, wanted: Any, share: float) -> None:
    """The same forces, displacements and zone on the cantilever, as shares of their sizes."""
    for probe in ("c.force", "c.closing_load", "T.displacement", "R.reaction", "R.reaction_moment"):
        assert found[probe] == pytest.approx(wanted[probe], abs=share * np.abs(wanted[probe]).max()), probe
    assert found["c.centre"] == pytest.approx(wanted["c.centre"], abs=share * LENGTH)
    assert found["c.ends"] == pytest.approx(wanted["c.ends"], abs=share * LENGTH)


NOTCHED = {"at": [0.0, 0.613, 1.0], "values": [THICK, THIN, THICK]}


@pytest.mark.parametrize(
    ("sizes", "load"),
    [(profile(THICK, THIN), 8.0), (profile(THIN, 0.8 * THIN, THICK), 8.0), (NOTCHED, 2.0)],
)
def test_on_a_stiff_arc_as_on_a_circle(sizes, load):
    """Reference: contact with a rigid circle, which sees the lean of the beam's edge by itself.

    The tapered beam is the one that is projected upon, as the arc's ends lie over its inside; one touches in its notch.
    """
    center, radius, load = np.array([0.06, -0.0125]), 0.01, load * FORCE
    start, end = ((center + 0.009 * np.array([np.cos(a), np.sin(a)])).tolist() for a in (2.5, 0.6))
    curve = {"kind": "arc", "center": center.tolist(), "start": start, "end": end, "direction": "clockwise"}
    other = beam(curve, 0.002, weld("S"), {"joint": "free"}, "hard")
    circle = {"kind": "beam-circle", "center": center.tolist(), "radius": radius}
    wanted = solved(on_what_is_rigid(circle, load, sizes), 160)
    found = solved(on_a_beam(other, load, sizes), {"beam": 80, "other": 16})
    alike(found, wanted, 1e-4)


def test_on_a_stiff_wedge_as_on_a_plane():
    """Reference: contact with a rigid half-plane. Circles that grow evenly along a line touch a plane that leans."""
    start, end, load, sizes = np.array([0.03, -0.012]), np.array([0.14, -0.012]), 40.0 * FORCE, (0.004, 0.008)
    curve = {"kind": "line", "start": start.tolist(), "end": end.tolist()}
    sine = 0.5 * (sizes[1] - sizes[0]) / (end[0] - start[0])
    normal = np.array([-sine, np.sqrt(1.0 - sine**2)])
    plane = {"kind": "beam-half-plane", "point": (start + 0.5 * sizes[0] * normal).tolist(), "normal": normal.tolist()}
    other = beam(curve, profile(*sizes), weld("S"), {"joint": "free"}, "hard")
    wanted = solved(on_what_is_rigid(plane, load, THIN))
    found = solved(on_a_beam(other, load, THIN), {"beam": 40, "other": 12})
    alike(found, wanted, 1e-4)
    assert abs(found["R.reaction"][0]) == pytest.approx(found["c.force"][0] * abs(sine), rel=1e-4)


@pytest.mark.parametrize("load", [0.3, 0.8])
def test_on_a_corner_of_an_edge_as_on_a_circle(load):
    """Reference: contact with a rigid circle. Where a beam is thickest its edge is an arc about the knot."""
    start, end = [0.045, -0.005], [0.08, -0.0055]
    other = beam(
        {"kind": "line", "start": start, "end": end},
        profile(0.001, 0.005, 0.0008),
        weld("S"),
        {"joint": "free"},
        "hard",
    )
    knot = (0.5 * (np.array(start) + end)).tolist()
    circle = {"kind": "beam-circle", "center": knot, "radius": 0.0025}
    wanted = solved(on_what_is_rigid(circle, load * FORCE, THIN), 160)
    found = solved(on_a_beam(other, load * FORCE, THIN), {"beam": 80, "other": 12})
    alike(found, wanted, 1e-4)


def two_arcs(values: tuple[float, ...], *, alone: bool) -> Scene:
    """Half circles that bulge towards each other, pushed together along the mirror; or one and a half-plane there."""
    y, beams, ends = RADIUS + 0.5 * max(values), {}, {}
    for name, sign, turn in (("over", 1.0, "counterclockwise"), ("under", -1.0, "clockwise"))[: 1 if alone else 2]:
        start, end = [-RADIUS, sign * y], [RADIUS, sign * y]
        curve = {"kind": "arc", "center": [0.0, sign * y], "start": start, "end": end, "direction": turn}
        beams[name] = beam(curve, profile(*values), weld(f"A_{name}"), weld(f"B_{name}"))
        ends[name] = (start, end)
    plane = {"kind": "beam-half-plane", "beam": "over", "body": "ground", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
    return scene_from(
        {
            "name": "mirror",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {f"A_{name}": both[0] for name, both in ends.items()}},
                "end": {
                    "motion": "slides",
                    "along": [1.0, 0.0],
                    "points": {f"B_{name}": both[1] for name, both in ends.items()},
                },
            },
            "beams": beams,
            "drives": {"d": {"kind": "displacement", "point": "B_over", "direction": [-1.0, 0.0]}},
            "contacts": {"c": plane if alone else {"kind": "beam-beam", "between": ["over", "under"]}},
            "stages": [{"name": "push", "steps": "d", "stations": [0.004]}],
            "probes": [
                *({"of": "c", "quantity": quantity} for quantity in ("force", "centre", "closing_load")),
                {"of": "A_over", "quantity": "reaction"},
                {"of": "A_over", "quantity": "reaction_moment"},
            ],
        }
    )


@pytest.mark.parametrize("values", [(0.0012, 0.0006), (0.0012, 0.0011, 0.0006)])
def test_mirrored_beams_touch_as_on_the_mirror(values):
    """Reference: contact with a rigid half-plane; either edge leans."""
    found, wanted = solved(two_arcs(values, alone=False), 40), solved(two_arcs(values, alone=True), 80)
    for probe in ("c.force", "c.closing_load", "A_over.reaction", "A_over.reaction_moment"):
        assert found[probe] == pytest.approx(wanted[probe], abs=1e-3 * np.abs(wanted[probe]).max()), probe
    assert found["c.centre"] == pytest.approx(wanted["c.centre"], abs=1e-3 * RADIUS)


def test_a_tapered_neck_is_a_half_against_a_wall():
    """Reference: contact with a rigid line, of one half of the arch; the line goes up and down with the top."""
    t, clamps = 1e-3, [0.0118, 0.0105]
    below = START * np.tan(0.1) - 0.003
    wall = {"kind": "beam-line", "beam": "half", "body": "apex", "points": [[0.0, -0.2], [0.0, below]], "side": "left"}
    wanted = whole(half(profile(t, 0.6 * t), clamps, wall), 60)
    found = whole(arch(profile(t, 0.6 * t, t), clamps, thick=True, backwards=True), 80)
    for one, other in zip(found.stations, wanted.stations, strict=True):
        assert one.values["neck.force"][0] > 0.0
        # as even necks on these elements: half a beam has a softer penalty, whose error its energy shows
        assert one.values["neck.force"] == pytest.approx(other.values["mirror.force"], rel=3e-3)
        assert one.values["neck.centre"] == pytest.approx(other.values["mirror.centre"], abs=1e-3 * HALF)
        assert one.values["B.reaction"] == pytest.approx(-other.values["A.reaction"], rel=2e-3, abs=1e-6)
        energy = 2.0 * other.values["scene.potential_energy"]
        assert one.values["scene.potential_energy"] == pytest.approx(energy, rel=5e-4)


EDGES = {
    "even": ((0.0, 1.0), (1.0, 1.0)),
    "straight": ((0.0, 1.0), (1.0, 0.4)),
    "ridge": ((0.0, 0.49, 1.0), (0.5, 1.0, 0.3)),
    "round": (np.linspace(0.0, 1.0, 27), 0.7 + 0.3 * np.cos(13.0 * np.linspace(0.0, 1.0, 27))),
}


def deep(first: str, second: str):
    """The arcs' model, every unknown disturbed, the upper one pushed down on the lower, and their pair."""
    model = build(two_arcs((0.0016, 0.0015), alone=False), Settings(elements={"over": 13, "under": 10}))
    rng = np.random.default_rng(1)
    z = model.start.values + 1e-4 * rng.standard_normal(model.size)
    z[model.element_dofs[6]] = rng.standard_normal(model.element_dofs.shape[1])
    z[model.node_dofs[1, model.beams[0].nodes]] -= 8e-4 / model.units.length
    (pair,) = pairs(two_arcs((0.0016, 0.0015), alone=False), model)
    edges = []
    for name, one in ((first, pair.first), (second, pair.second)):
        at, half_thickness = EDGES[name]
        elements = model.beams[one].elements.stop - model.beams[one].elements.start
        edges.append(Edge(tuple(elements * np.array(at)), tuple(0.5 * pair.distance * np.array(half_thickness))))
    return model, z, replace(pair, tapers=Tapers(edges[0], edges[1]))


@pytest.mark.parametrize("first", ["even", "straight", "ridge"])
@pytest.mark.parametrize("second", ["straight", "ridge", "round"])
def test_the_contacts_derivatives(first, second):
    """Gradient and tangent of ½ ε ∫ ⟨−g⟩² ds against differences; no force and no moment are left over."""
    model, z, pair = deep(first, second)

    def gathered(z):
        one = touch(model, pair, Penalty(1.0), 12, State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        # of the circles about both places, as they are drawn
        g = np.hypot(*(one.x - one.x_m)) - pair.tapers.first.at(one.zeta) - pair.tapers.second.at(one.zeta_m)
        return 0.5 * float(one.stiffness @ g**2), gradient, hessian, one

    value, gradient, hessian, one = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    check(model, gathered, z, times=2, rel=1e-6, tangent=1e-5)
    force = gradient[model.node_dofs]
    at = z[model.node_dofs]
    scale = np.abs(one.gradient).sum()
    assert np.abs(force[:2].sum(axis=1)).max() < 1e-12 * scale
    assert abs((at[0] * force[1] - at[1] * force[0] + force[2]).sum()) < 1e-12 * scale


def test_a_place_faces_the_nearest_circle():
    """Reference: the least distance from many circles about the second beam's neutral line."""
    for second in ("straight", "ridge", "round"):
        model, z, pair = deep("even", second)
        line, line_m = (model.line(model.beams[i], State.of(z)) for i in (pair.first, pair.second))
        one = touch(model, pair, Penalty(1.0), 6, State.of(z))
        every = np.union1d(np.linspace(0.0, 10.0, 200_001), pair.tapers.second.knots)
        x_m, T_m = line_m.at(every)[0], pair.tapers.second.at(every)
        for zeta, gap in list(zip(one.zeta, one.gap, strict=True))[::7]:
            away = np.hypot(*(line.at(np.array([zeta]))[0] - x_m)) - T_m
            assert gap == pytest.approx(away.min() - pair.tapers.first.at(np.array([zeta]))[0], abs=1e-8)
