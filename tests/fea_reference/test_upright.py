"""With shear, a beam clamped tangent on a circle, or on another beam, and pressed on it: little, so that all is linear.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
κ       curvature of the circle, or of the beam that is pressed on its like; EI = L = 1
F, Q    force across at the tip, shear force; of two beams the difference of both
c       as far as the beam lies
a, f    √(EI/GA); γ = f Q/GA
======  =====================================================================================

As far as the beam lies its line has the circle's angle, whence θ' = κ − (γ)' and (f Q)'' = Q/a²; of two like beams the
difference of their angles obeys the same.  Behind c, Q = F and M = F (1 − c); at c both go on.  In bending F acts at c.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from comparisons.answer_file import packed, unpacked
from comparisons.audit import audit
from cprbm_scene import Ending, Scene
from fea_reference import Settings, answer
from fea_reference.upright import shear_layers
from tests.fea_reference.on_an_edge import scene_of

STOUT = 0.07
KAPPA = 0.013
ROOT = math.sqrt(2.0)
PROBES = (("root", "reaction"), ("root", "reaction_moment"), ("edge", "force"), ("edge", "centre"))


def layer(thickness):
    """a, with a Poisson ratio of 0.3 and a shear factor of 5/6."""
    return thickness * math.sqrt(2.6 / 10.0)


def share_at_joint(force, a):
    """Q at the joint over F, where the beam has begun to lie: (f Q)'' = Q/a² from f Q = s² on, integrated."""
    begin = 1e-3 * a

    def slope(s, v):
        return [v[1], v[0] / (a * math.tanh(s / (ROOT * a))) ** 2]

    # next to the joint f is s²/(2 a²), and Q even: 2 and what follows is of the fourth order in s/a
    reach = solve_ivp(slope, (begin, 0.9), [begin**2, 2.0 * begin], "DOP853", rtol=1e-12, dense_output=True).sol

    def shear(c):
        return reach(c)[0] / math.tanh(c / (ROOT * a)) ** 2

    def missed(c):
        return force * (1.0 - c) - KAPPA + a**2 * force * reach(c)[1] / shear(c)

    c = brentq(missed, 2.0 * begin, 0.9)
    return 2.0 * a**2 / shear(c)


def on_circle(thickness, *forces):
    block = {"motion": "free", "points": {"tip": (1.0, 0.0)}}
    return scene_of(
        {"kind": "line", "start": (0.0, 0.0), "end": (1.0, 0.0)},
        {"joint": "weld", "point": "root"},
        {"joint": "weld", "point": "tip"},
        {
            "kind": "beam-circle",
            "body": "ground",
            "center": (0.0, -1.0 / KAPPA),
            "radius": 1.0 / KAPPA - 0.5 * thickness,
        },
        bodies={"ground": {"motion": "fixed", "points": {"root": (0.0, 0.0)}}, "block": block},
        loads={"P": {"kind": "force", "point": "tip", "direction": (0.0, -1.0)}},
        stages=(("P", forces),),
        probes=PROBES,
        thickness=thickness,
    )


def on_its_like(thickness, *forces):
    """The circle made a straight beam with a free end, the beam bent away from it."""
    plain = on_circle(thickness, *forces).model_dump()
    (beam,) = plain["beams"].values()
    tip = (math.sin(KAPPA) / KAPPA, (1.0 - math.cos(KAPPA)) / KAPPA)
    arc = {
        "kind": "arc",
        "center": (0.0, 1.0 / KAPPA),
        "start": (0.0, 0.0),
        "end": tip,
        "direction": "counterclockwise",
    }
    low = {"kind": "line", "start": (0.0, -thickness), "end": (1.1, -thickness)}
    other = {"curve": low, "start": {"joint": "weld", "point": "below"}, "end": {"joint": "free"}}
    plain["beams"] = {"beam": {**beam, "curve": arc}, "other": {**beam, **other}}
    plain["bodies"]["ground"]["points"]["below"] = (0.0, -thickness)
    plain["bodies"]["block"]["points"]["tip"] = tip
    plain["contacts"] = {"edge": {"kind": "beam-beam", "between": ("beam", "other")}}
    return Scene.model_validate(plain)


def found(scene, elements, kinematics="shear"):
    """Of every station the joint's reaction across, its moment, the contact's force and centre."""
    answered = answer(scene, Settings(elements=elements, kinematics=kinematics))
    assert answered.ending is Ending.COMPLETED, answered.sentence
    rows = []
    for station in answered.stations:
        values = station.values
        centre = values["edge.centre"]
        rows.append(
            [
                values["root.reaction"][1],
                values["root.reaction_moment"][0],
                values["edge.force"][0],
                centre[0] if centre.size else 0.0,
            ]
        )
    return np.array(rows)


def test_what_the_joint_bears_beside_a_circle_is_as_integrated():
    force = 1.07 * KAPPA
    joint = force * share_at_joint(force, layer(STOUT))
    contact = force - joint
    exact = np.array([joint, KAPPA, contact, (force - KAPPA) / contact])
    errors = np.array([found(on_circle(STOUT, force), n)[0] for n in (40, 80, 160)]) / exact - 1.0
    assert joint / force > 0.02
    assert np.all(np.abs(errors[-1]) < (0.05, 1e-3, 0.01, 0.01))
    # what is stated, of the contact's force and place and of the joint: twice the change to twice the elements
    stated = 2.0 * np.abs(errors[1] - errors[0])
    assert np.all(np.abs(errors[0] - errors[-1])[[0, 2, 3]] <= stated[[0, 2, 3]])


def test_on_its_like_it_bears_half_of_that():
    force = 1.07 * KAPPA
    share = share_at_joint(force, layer(STOUT))
    values = found(on_its_like(STOUT, force), 80)[0]
    assert values[[0, 2]] == pytest.approx([0.5 * force * (1.0 + share), 0.5 * force * (1.0 - share)], rel=0.02)


@pytest.mark.parametrize("scene", [on_circle, on_its_like])
@pytest.mark.parametrize("elements", [20, 160])
def test_nothing_presses_before_it_does_in_bending(scene, elements):
    below, above = found(scene(STOUT, 0.99 * KAPPA, 1.02 * KAPPA), elements)
    assert below[2] == 0.0
    assert above[2] >= 0.0
    assert below[0] == pytest.approx(0.99 * KAPPA, rel=1e-9)


def test_with_less_shear_the_contact_bears_what_it_does_in_bending():
    force = 1.13 * KAPPA
    shares = [share_at_joint(force, layer(t)) for t in (STOUT, STOUT / 3.0, STOUT / 9.0)]
    assert shares[0] > 5.0 * shares[1] > 25.0 * shares[2]
    thin, bending = (found(on_circle(STOUT / 9.0, force), 80, which)[0] for which in ("shear", "bending"))
    assert thin == pytest.approx(bending, rel=2e-3, abs=2e-3 * force)


def test_only_what_is_held_on_what_it_may_touch_stands_upright():
    assert shear_layers(on_circle(STOUT, 0.01), "beam") == pytest.approx((layer(STOUT), 0.0))
    both = on_its_like(STOUT, 0.01)
    assert shear_layers(both, "beam") == shear_layers(both, "other") == pytest.approx((layer(STOUT), 0.0))
    plain = on_circle(STOUT, 0.01).model_dump()
    plain["contacts"]["edge"]["radius"] -= 0.2 * STOUT
    assert shear_layers(Scene.model_validate(plain), "beam") == (0.0, 0.0)


def on_a_block(scene, stepped=()):
    """Below is held by a body of its own, and that by three drives, of which some are ``stepped`` afterwards."""
    plain = scene.model_dump()
    foot = plain["bodies"]["ground"]["points"].get("below", (0.31, -2.3))
    plain["bodies"]["ground"]["points"].pop("below", None)
    plain["bodies"]["held"] = {"motion": "free", "points": {"below": foot}}
    plain["drives"] = {
        "across": {"kind": "displacement", "point": "below", "direction": (0.83, 0.56)},
        "beside": {"kind": "displacement", "point": "below", "direction": (-0.31, 0.95)},
        "turn": {"kind": "rotation", "body": "held"},
    }
    if "body" in plain["contacts"]["edge"]:
        plain["contacts"]["edge"]["body"] = "held"
    plain["stages"] += tuple({"name": name, "steps": name, "stations": (1e-5,)} for name in stepped)
    return Scene.model_validate(plain)


@pytest.mark.parametrize("scene", [on_circle, on_its_like])
def test_what_drives_hold_where_it_is_is_as_good_as_the_ground(scene):
    own = scene(STOUT, 1.07 * KAPPA, 1.13 * KAPPA)
    held = on_a_block(own)
    assert shear_layers(held, "beam") == shear_layers(own, "beam") == pytest.approx((layer(STOUT), 0.0))
    assert found(held, 20) == pytest.approx(found(own, 20), rel=1e-7, abs=1e-9 * KAPPA)


@pytest.mark.parametrize("stepped", ["across", "beside", "turn"])
def test_what_a_stage_moves_is_not(stepped):
    assert shear_layers(on_a_block(on_circle(STOUT, 0.01), [stepped]), "beam") == (0.0, 0.0)


@pytest.mark.parametrize("unit", [1.3e-6, 1.0, 1.7e5])
@pytest.mark.parametrize(("gap", "held"), [(0.0, layer(STOUT)), (0.013, 0.0)])
def test_an_end_is_held_on_a_curved_edge_in_whatever_units(unit, gap, held):
    # y = −κx²/2 with the beam's lower face, or a gap, under it
    plain = on_circle(STOUT, 0.01).model_dump()
    (beam,) = plain["beams"].values()
    beam["curve"]["end"] = plain["bodies"]["block"]["points"]["tip"] = (unit, 0.0)
    beam["thickness"], beam["width"] = unit * beam["thickness"], unit * beam["width"]
    low = -(0.5 * STOUT + gap) * unit
    edge = {"kind": "beam-function", "beam": "beam", "body": "ground", "axis": "y", "side": "above"}
    edge |= {"coefficients": (low, 0.0, -0.5 * KAPPA / unit), "range": (-0.3 * unit, 1.4 * unit)}
    plain["contacts"] = {"edge": edge}
    assert shear_layers(Scene.model_validate(plain), "beam") == pytest.approx((unit * held, 0.0))


@pytest.mark.parametrize("scene", [on_circle, on_its_like])
def test_the_audit_knows_how_shear_begins(scene):
    asked = scene(STOUT, 1.13 * KAPPA)
    answered = answer(asked, Settings(elements=20))
    found = audit(asked, unpacked(packed({"fea": answered}))["fea"])
    assert not found.complaints
    assert found.unbalance < 1e-9
