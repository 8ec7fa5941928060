"""Contact of a solid's edges, and what is refused."""

import numpy as np
import pytest

from cprbm_scene import SceneError, scene_from
from fea_reference import solid
from fea_reference.solid.rigid import Half
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, straight

FLOOR = {"kind": "beam-half-plane", "beam": "beam", "body": "ground"}
PROBES = (("floor", "force"), ("floor", "centre"), ("floor", "ends"), ("tip", "displacement"), ("root", "reaction"))


@pytest.mark.parametrize("poisson", [0.0, 0.35])
def test_a_beam_pressed_flat_on_a_wall(poisson):
    # An even load q on a bar whose whole edge lies on the wall: away from its end that is clamped the pressure is q
    length, thickness, q = 0.13, 0.011, 410.0
    scene = bar(
        straight(length),
        thickness,
        poisson=poisson,
        load={"kind": "distributed", "beam": "beam", "direction": [0.0, -1.0]},
        stations=(q,),
        contacts={"floor": {**FLOOR, "point": [0.0, -thickness / 2], "normal": [0.0, 1.0]}},
        probes=(*PROBES[:3], PROBES[4]),
        end={"joint": "free"},
    )
    ready = solid.prepared(scene, solid.Settings(elements=30))
    found = ready.answer()
    assert found.completed, found.sentence
    values = found.stations[0].values
    assert values["floor.force"][0] + values["root.reaction"][1] == pytest.approx(q * length, rel=1e-9)
    assert values["floor.ends"][1] == pytest.approx(length, rel=1e-6)
    (touch,) = (one for one in ready.march.system.touches if one.zeta.size and isinstance(one.pair.other, Half))
    pressure = -touch.gap * touch.pair.skin.at(touch.pair.skin.stiffness, touch.zeta)
    at = touch.pair.skin.at(touch.pair.skin.u, touch.zeta)
    away = (at > 0.4) & (at < 0.6)  # of what holds it, and of the end, whose lower half is pressed wider
    even = q * ready.march.model.units.length / ready.march.model.units.force / ready.settings.stiffness
    assert pressure[away] == pytest.approx(even, rel=2e-4)


def test_a_cantilever_that_leans_on_a_round_support():
    # a stiff, narrow circle under a slender cantilever at a: the force of a point support (beam tables),
    # R = P (3 L − a)/(2 a), for a load that moves nothing by more than 1e-3 of the length
    length, thickness, a, force = 0.41, 0.006, 0.27, 2.3e-4
    scene = bar(
        straight(length),
        thickness,
        load={"kind": "force", "point": "tip", "direction": [0.0, -1.0]},
        stations=(force,),
        contacts={
            "floor": {"kind": "beam-circle", "beam": "beam", "body": "ground", "center": [a, -0.023], "radius": 0.02}
        },
        probes=PROBES,
    )
    found = solid.answer(scene, solid.Settings(elements=41, across=1))
    assert found.completed, found.sentence
    values = found.stations[0].values
    assert values["floor.force"][0] == pytest.approx(force * (3 * length - a) / (2 * a), rel=2e-3)
    assert values["floor.centre"][0] == pytest.approx(a, rel=1e-3)
    # what the support leaves free bends as two spans: δ = P (L − a)² (4 L − a)/(12 E I)
    rigidity = YOUNG * WIDTH * thickness**3 / 12
    down = force * (length - a) ** 2 * (4 * length - a) / (12 * rigidity)
    assert values["tip.displacement"][1] == pytest.approx(-down, rel=4e-3)


def test_two_bars_press_each_other_with_opposite_forces():
    # symmetric about the x-axis: both tips come together, and nothing moves along the normal's mirror
    data = bar(straight(0.3), 0.005, probes=PROBES[3:]).model_dump(mode="json", exclude={"file"}, exclude_none=True)
    gap = 0.0051
    for name, y in (("low", -gap / 2), ("high", gap / 2)):
        data["bodies"][f"{name}_block"] = {"motion": "free", "points": {f"{name}_tip": [0.3, y]}}
        data["bodies"]["ground"]["points"][f"{name}_root"] = [0.0, y]
        data["beams"][name] = {
            **data["beams"]["beam"],
            "curve": {"kind": "line", "start": [0.0, y], "end": [0.3, y]},
            "start": {"joint": "weld", "point": f"{name}_root"},
            "end": {"joint": "weld", "point": f"{name}_tip"},
        }
    del data["beams"]["beam"], data["bodies"]["block"], data["bodies"]["ground"]["points"]["root"]
    data["loads"] = {
        "P": {"kind": "distributed", "beam": "low", "direction": [0.0, 1.0], "along": [0.4, 0.9]},
    }
    data["stages"][0]["stations"] = [0.31]
    data["contacts"] = {"both": {"kind": "beam-beam", "between": ["low", "high"]}}
    data["probes"] = [{"of": of, "quantity": "displacement"} for of in ("low_tip", "high_tip")]
    data["probes"] += [{"of": of, "quantity": "reaction"} for of in ("low_root", "high_root")]
    data["probes"] += [{"of": "both", "quantity": "force"}]
    found = solid.answer(scene_from(data), solid.Settings(elements=12, across=1))
    assert found.completed, found.sentence
    values = found.stations[0].values
    # the upper bar is loaded by nothing but the contact, and lies on the lower one
    assert values["both.force"][0] == pytest.approx(-values["high_root.reaction"][1], rel=1e-2)
    assert np.abs(values["low_tip.displacement"][1]) > np.abs(values["high_tip.displacement"][1]) > 0.0
    total = values["low_root.reaction"][1] + values["high_root.reaction"][1]
    assert total == pytest.approx(-0.31 * 0.5 * 0.3, rel=1e-9)


def test_a_free_end_presses_into_another_beams_side():
    # of two cantilevers the upper, shorter one is loaded evenly: its tip comes down on the lower one's side.  Beam
    # tables: q a⁴/8 − R a³/3 = E I g + R a³/3
    a, thickness, gap, q = 0.19, 0.004, 0.0007, 0.37
    data = bar(straight(a), thickness, probes=PROBES[3:]).model_dump(mode="json", exclude={"file"}, exclude_none=True)
    data["bodies"] = {"ground": {"motion": "fixed", "points": {}}}
    for name, length, y in (("low", 0.31, -thickness - gap), ("high", a, 0.0)):
        data["bodies"]["ground"]["points"][f"{name}_root"] = [0.0, y]
        data["beams"][name] = {
            **data["beams"]["beam"],
            "curve": {"kind": "line", "start": [0.0, y], "end": [length, y]},
            "start": {"joint": "weld", "point": f"{name}_root"},
            "end": {"joint": "free"},
        }
    del data["beams"]["beam"]
    data["loads"] = {"P": {"kind": "distributed", "beam": "high", "direction": [0.0, -1.0]}}
    data["stages"][0]["stations"] = [q]
    data["contacts"] = {"tip": {"kind": "beam-beam", "between": ["high", "low"]}}
    data["probes"] = [{"of": "tip", "quantity": each} for each in ("force", "centre")]
    data["probes"] += [{"of": "low_root", "quantity": "reaction"}]
    found = solid.answer(scene_from(data), solid.Settings(elements=14, across=1))
    assert found.completed, found.sentence
    values = found.stations[0].values
    rigidity = YOUNG * WIDTH * thickness**3 / 12
    force = (q * a**4 / 8 - rigidity * gap) * 3 / (2 * a**3)
    assert values["tip.force"][0] == pytest.approx(force, rel=1e-2)
    assert values["tip.centre"][0] == pytest.approx(a, rel=2e-3)
    # equilibrium; nodes are in balance to 1e-9 of the largest force, or to round-off, which is a few 1e-8 of this one
    assert np.hypot(*values["low_root.reaction"]) == pytest.approx(values["tip.force"][0], rel=1e-7)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"contacts": {"floor": {**FLOOR, "point": [0.0, -0.1], "normal": [0.0, 1.0], "thick": False}}}, "lines"),
    ],
)
def test_what_the_solid_does_not_offer_is_refused_by_name(change, words):
    with pytest.raises(SceneError, match=words):
        solid.prepared(bar(straight(0.3), 0.005, probes=(("tip", "displacement"),), **change))


def test_settings_out_of_bounds_are_refused():
    with pytest.raises(SceneError, match="across"):
        solid.Settings(across=0)
    with pytest.raises(SceneError, match="stiffness"):
        solid.Settings(stiffness=-1.0)


def test_where_a_contact_closes_is_found_from_far_beyond_it():
    # P a² (3 L − a)/(6 E I) of a beam is the gap, and the one station is fifteen times as far
    length, thickness, a, gap = 0.1, 0.001, 0.06, 0.0015
    rigidity = YOUNG * WIDTH * thickness**3 / 12
    closing = 6 * rigidity * gap / (a**2 * (3 * length - a))
    scene = bar(
        straight(length),
        thickness,
        load={"kind": "force", "point": "tip", "direction": [0.0, -1.0]},
        stations=(15 * closing,),
        contacts={
            "floor": {
                "kind": "beam-circle",
                "beam": "beam",
                "body": "ground",
                "center": [a, -gap - thickness / 2 - 0.002],
                "radius": 0.002,
            }
        },
        probes=(("floor", "closing_load"),),
    )
    found = solid.answer(scene, solid.Settings(elements=40, across=1))
    assert found.completed, found.sentence
    # the beam leans by 2 gap/a where it meets the circle, and meets it beside its top by that share of the radius
    assert found.stations[0].values["floor.closing_load"][0] == pytest.approx(closing, rel=5e-3)


def test_an_obstacle_too_small_for_the_mesh_is_never_passed_unseen():
    # the radius is a tenth of the thickness: the beam ends beyond the obstacle, or the solver says why it ends
    scene = bar(
        straight(0.1),
        0.001,
        load={"kind": "force", "point": "tip", "direction": [0.0, -1.0]},
        stations=(0.2,),
        contacts={
            "floor": {
                "kind": "beam-circle",
                "beam": "beam",
                "body": "ground",
                "center": [0.06, -0.0021],
                "radius": 1e-4,
            }
        },
        probes=(("floor", "force"),),
    )
    found = solid.answer(scene, solid.Settings(elements=20, across=1))
    assert found.completed == any(station.values["floor.force"][0] > 0.0 for station in found.stations)
    # held by looser penalties on the way, it may come to the station, where those that are asked do not hold it
    said = ("passes through", "cannot be raised as requested")
    assert found.completed or any(words in found.sentence for words in said)


def test_a_beam_that_would_come_to_lie_on_a_circles_centre_is_held_by_it():
    # in a single step to the second station the circle's centre comes between the beam's edges, and neither edge faces
    # the centre; beam tables give the force on a point support at small loads, 1 + 3 (L − a)/(2 a) times the tip's
    # force, and the support is lower by the circle's radius at most
    length, a = 0.31, 0.2
    scene = bar(
        straight(length),
        0.017,
        poisson=0.35,
        load={"kind": "force", "point": "tip", "direction": [0.0, -1.0]},
        stations=(3.1, 41.0),
        contacts={
            "floor": {"kind": "beam-circle", "beam": "beam", "body": "ground", "center": [a, -0.06], "radius": 0.04}
        },
        probes=(("floor", "force"), ("tip", "displacement")),
    )
    found = solid.answer(scene, solid.Settings(elements=31, across=1))
    assert found.completed, found.sentence
    free, held = (station.values for station in found.stations)
    assert free["floor.force"][0] == 0.0
    assert 41.0 < held["floor.force"][0] < 41.0 * (1.0 + 1.5 * (length - a) / a)
    # unhindered it would sink by P L³/(3 E I), less what a beam that bends far comes short of
    unhindered = 41.0 * length**3 / (3.0 * YOUNG * WIDTH * 0.017**3 / 12.0)
    assert -held["tip.displacement"][1] < 0.5 * unhindered
