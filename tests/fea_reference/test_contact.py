"""Contacts whose force is known by hand."""

import numpy as np
import pytest

from cprbm_scene import Ending, scene_from
from fea_reference import Settings, answer
from fea_reference.contact import least_at_ends, touch
from fea_reference.contacts import contacts, motion_before_overlap, relative_motion, zones_of
from fea_reference.crossing import lines_cross
from fea_reference.facing import borders
from fea_reference.hermite import NeutralLine
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from fea_reference.zones import Gap, negative, overlap, survey_pair
from tests.fea_reference.cantilever import elastica

YOUNG, WIDTH, T = 2e9, 0.01, 0.002
EI = YOUNG * WIDTH * T**3 / 12
A, B = 0.1, 0.13
GAP = 1e-6


def clamped(y, length, point, tip=None):
    return {
        "curve": {"kind": "line", "start": [0.0, y], "end": [length, y]},
        "thickness": T,
        "width": WIDTH,
        "material": "m",
        "start": {"joint": "weld", "point": point},
        "end": {"joint": "weld", "point": tip} if tip else {"joint": "free"},
    }


def two_cantilevers(first, second, stations, *, thick=True):
    """The shorter one above, pressed down at its tip onto the inside of the longer one."""
    y = (T if thick else 0.0) + GAP
    return scene_from(
        {
            "name": "two",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.0, y], "V": [0.0, 0.0]}},
                "end": {"motion": "free", "points": {"tip": [A, y]}},
            },
            "beams": {"upper": clamped(y, A, "U", "tip"), "lower": clamped(0.0, B, "V")},
            "loads": {"P": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": [first, second], "thick": thick}},
            "stages": [{"name": "load", "steps": "P", "stations": list(stations)}],
            "probes": [
                {"of": "touch", "quantity": "force"},
                {"of": "touch", "quantity": "centre"},
                {"of": "touch", "quantity": "closing_load"},
                {"of": "tip", "quantity": "displacement"},
                {"of": "V", "quantity": "reaction"},
                {"of": "V", "quantity": "reaction_moment"},
                {"of": "lower", "quantity": "bending_stress", "points": 27},
            ],
        }
    )


@pytest.mark.parametrize("thick", [True, False])
@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
def test_two_cantilevers_share_the_load(order, thick):
    """Small deflections: (P − R) a³/3EI − R a³/3EI = gap, so R = P/2 − 3 EI gap/(2 a³).

    The upper's tip slopes more than the lower there, so the contact is at the tip, a zone at the one's end.
    """
    closing = 3 * EI * GAP / A**3
    P = 3 * closing
    settings = Settings(elements={"upper": 20, "lower": 26}, kinematics="stretch", penetration=1e-6)
    got = answer(two_cantilevers(*order, (0.5 * closing, P), thick=thick), settings)
    assert got.ending is Ending.COMPLETED, got.sentence
    assert got.stations[0].values["touch.force"][0] == 0.0
    values = got.stations[1].values
    assert values["touch.closing_load"][0] == pytest.approx(closing, rel=1e-5)
    R = P / 2 - closing / 2
    assert values["touch.force"][0] == pytest.approx(R, rel=5e-3)
    assert values["touch.centre"][0] == pytest.approx(A, rel=2e-2)
    assert values["V.reaction"][1] == pytest.approx(values["touch.force"][0], rel=1e-6)
    # The moment falls linearly from the clamp to the contact and vanishes beyond.
    s = np.linspace(0, B, 27)
    moment = values["lower.bending_stress"] * WIDTH * T**2 / 6
    lever = np.maximum(values["touch.centre"][0] - s, 0.0) if order[0] == "lower" else np.maximum(A - s, 0.0)
    assert moment == pytest.approx(-values["touch.force"][0] * lever, abs=1e-2 * R * A)


@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
def test_the_moment_has_its_kink_where_the_contact_is_and_not_at_a_node(order):
    """Statics: V's reaction alone bends the lower beam up to the contact, and nothing does beyond.

    With 7 elements the contact stands in the middle third of the sixth, and the stress is asked at places
    before and behind it.
    """
    P = 9 * EI * GAP / A**3
    scene = two_cantilevers(*order, (P,))
    values = answer(scene, Settings(elements={"upper": 20, "lower": 7}, kinematics="stretch")).stations[0].values
    force, root = values["V.reaction"][1], values["V.reaction_moment"][0]
    s = np.linspace(0, B, 27)
    moment = values["lower.bending_stress"] * WIDTH * T**2 / 6
    # Section forces are those of the piece before it, turned round.
    inner = s < 0.91 * A
    assert moment[inner] == pytest.approx((-root + force * s)[inner], abs=1e-6 * abs(root))
    assert moment[s > 1.001 * A] == pytest.approx(0.0, abs=1e-6 * abs(root))


def test_a_propped_cantilever():
    """Clamped, loaded in the middle, pinned at the far end: prop 5P/16, deflection 7 P L³/(768 EI)."""
    P, L = 1e-5 * EI, 1.0

    def half(start, end, x):
        return {
            "curve": {"kind": "line", "start": [x, 0.0], "end": [x + L / 2, 0.0]},
            "thickness": T,
            "width": WIDTH,
            "material": "m",
            "start": start,
            "end": end,
        }

    middle = {"joint": "weld", "point": "middle"}
    scene = scene_from(
        {
            "name": "propped",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"root": [0.0, 0.0], "prop": [L, 0.0]}},
                "block": {"motion": "free", "points": {"middle": [L / 2, 0.0]}},
            },
            "beams": {
                "left": half({"joint": "weld", "point": "root"}, middle, 0.0),
                "right": half(middle, {"joint": "pin", "point": "prop"}, L / 2),
            },
            "loads": {"P": {"kind": "force", "point": "middle", "direction": [0.0, -3.0]}},
            "stages": [{"name": "load", "steps": "P", "stations": [P]}],
            "probes": [
                {"of": "middle", "quantity": "displacement"},
                {"of": "prop", "quantity": "reaction"},
                {"of": "prop", "quantity": "reaction_moment"},
            ],
        }
    )
    got = answer(scene, Settings(elements=8, kinematics="stretch"))
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[0].values
    assert values["prop.reaction"][1] == pytest.approx(5 * P / 16, rel=1e-4)
    assert values["prop.reaction_moment"][0] == 0.0
    assert values["middle.displacement"][1] == pytest.approx(-7 * P * L**3 / (768 * EI), rel=1e-4)


def test_crossing_is_seen():
    def straight(*points):
        at = np.array(points, dtype=float).T
        none = np.zeros(len(points) - 1)
        return NeutralLine.through(at, np.zeros(len(points)), none + 1.0, np.zeros_like(at), none, none)

    level = straight((0, 0), (1, 0), (2, 0))
    assert lines_cross(level, straight((0.3, -1), (0.7, 0.5)))
    assert not lines_cross(level, straight((0.3, 0.1), (0.7, 0.5)))
    assert not lines_cross(level, straight((2.1, -1), (2.2, 0.5)))


C, DROP = 0.08, 0.005
CLOSING = DROP * 6 * EI / (C**2 * (3 * A - C))  # by small deflections


def pressed_at_the_tip(contact, station, probes, further=()):
    """A cantilever along x under a force at the tip, with ``further`` beams and a contact named ``touch``."""
    return scene_from(
        {
            "name": "pressed",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"V": [0.0, 0.0]}},
                "end": {"motion": "free", "points": {"tip": [B, 0.0]}},
            },
            "beams": {"upper": clamped(0.0, B, "V", "tip")} | dict(further),
            "loads": {"P": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {"touch": contact},
            "stages": [{"name": "load", "steps": "P", "stations": [station]}],
            "probes": probes,
        }
    )


@pytest.mark.parametrize("elements", [20, 40])
@pytest.mark.parametrize("gap", [1e-3 * T, 1e-4 * T])
def test_a_contact_closes_where_its_gap_is_zero(gap, elements):
    # reference: w = P a² (3 L − a)/6EI and w' = P a (2 L − a)/2EI at a peg, which is w + R w'²/2 away
    at, radius = 0.6 * B, 2.0 * T
    sinks, turns, away = at**2 * (3.0 * B - at) / (6.0 * EI), at * (2.0 * B - at) / (2.0 * EI), radius + 0.5 * T
    center = [at, -away - gap]
    peg = {"kind": "beam-circle", "beam": "upper", "body": "ground", "center": center, "radius": radius}
    scene = pressed_at_the_tip(peg, 5.0 * gap / sinks, [{"of": "touch", "quantity": "closing_load"}])
    found = answer(scene, Settings(elements=elements, kinematics="bending")).stations[-1].values["touch.closing_load"]
    closing = 2.0 * gap / (sinks + np.sqrt(sinks**2 + 2.0 * away * turns**2 * gap))
    assert found == pytest.approx(closing, rel=1e-9)


@pytest.mark.parametrize("elements", [20, 40, 80])
@pytest.mark.parametrize("angle", [16.0, 28.0, 60.0])
def test_beams_do_not_press_where_they_overlap_beside_an_end_that_they_share(angle, elements):
    # reference: the elastica of Bisshopp and Drucker, P L²/EI = 0.2: the legs of a V meet nowhere else
    x, y = (float(B * f(np.radians(angle))) for f in (np.cos, np.sin))
    lower = clamped(0.0, B, "V") | {"curve": {"kind": "line", "start": [0.0, 0.0], "end": [x, -y]}}
    scene = pressed_at_the_tip(
        {"kind": "beam-beam", "between": ["upper", "lower"]},
        0.2 * EI / B**2,
        [{"of": "touch", "quantity": "force"}, {"of": "tip", "quantity": "displacement"}],
        {"lower": lower},
    )
    found = answer(scene, Settings(elements=elements, kinematics="bending"))
    assert found.ending is Ending.COMPLETED, found.sentence
    along, across, _ = elastica(0.2)
    values = found.stations[-1].values
    assert values["touch.force"] == [0.0]
    assert values["tip.displacement"] == pytest.approx([B * (along - 1.0), -B * across], rel=1e-5)


def end_under_side(order):
    """The lower beam is the shorter one, DROP below, and ends under the upper's inside."""
    base = two_cantilevers(*order, (1.02 * CLOSING,), thick=False)
    lower = base.beams["lower"]
    line = lower.curve.model_copy(update={"start": (0.0, GAP - DROP), "end": (C, GAP - DROP)})
    points = {"U": (0.0, GAP), "V": (0.0, GAP - DROP)}
    ground = base.bodies["ground"].model_copy(update={"points": points})
    return base.model_copy(
        update={
            "beams": {**base.beams, "lower": lower.model_copy(update={"curve": line})},
            "bodies": {**base.bodies, "ground": ground},
        }
    )


@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
def test_a_beams_end_presses_along_the_others_normal(order):
    """The lower's free end under the upper's side: without friction the force is normal to the upper there.

    The upper is as at first touch, clamped and under a force P at its tip, x = A: its slope at x = C is
    P (A C − C²/2)/EI, and ∫ ½ w'² dx longer than C is its arc to there.  The lower's own normal is along y.
    """
    k = CLOSING / EI
    got = answer(end_under_side(order), Settings(elements=30, penetration=1e-6))
    assert got.ending is Ending.COMPLETED, got.sentence
    values = got.stations[0].values
    reaction = values["V.reaction"]
    assert np.hypot(*reaction) == pytest.approx(values["touch.force"][0], rel=1e-9)
    assert reaction[0] / reaction[1] == pytest.approx(k * (A * C - C**2 / 2), rel=0.05)
    longer = 0.5 * k**2 * (A**2 * C**3 / 3 - A * C**4 / 4 + C**5 / 20)
    assert values["touch.centre"][0] == pytest.approx(C + longer * (order[0] == "upper"), rel=2e-4)


def first_at_first(monkeypatch):
    """The beam named first carries the integral, whichever has an end over the other's inside."""
    monkeypatch.setattr("fea_reference.contact.has_end_over", lambda first, second: False)
    monkeypatch.setattr("fea_reference.contact.end_distance", lambda first, second: np.inf)


def test_beams_change_places_where_an_end_of_the_second_touches(monkeypatch):
    settings = Settings(elements=30, penetration=1e-6)
    expected = answer(end_under_side(("upper", "lower")), settings).stations[0].values
    first_at_first(monkeypatch)
    found = answer(end_under_side(("upper", "lower")), settings).stations[0].values
    for probe, value in expected.items():
        np.testing.assert_allclose(found[probe], value, rtol=0.0, atol=1e-9 * np.abs(value).max(), err_msg=probe)


def test_beams_change_places_where_an_end_of_the_second_comes_to_press(monkeypatch):
    settings = Settings(elements=30, penetration=1e-6)
    expected = answer(end_under_side(("upper", "lower")), settings).stations[0].values
    first_at_first(monkeypatch)
    monkeypatch.setattr("fea_reference.contact.least_at_ends", lambda model, pair, z: np.inf)
    got = answer(end_under_side(("upper", "lower")), settings)
    assert got.ending is Ending.COMPLETED, got.sentence
    found = got.stations[0].values
    for probe in ("touch.force", "V.reaction", "tip.displacement"):
        np.testing.assert_allclose(found[probe], expected[probe], rtol=1e-7, err_msg=probe)


def leaning(end):
    """The lower beam drawn straight from below up to its ``end``; both beams' model and their pair."""
    scene = end_under_side(("upper", "lower"))
    lower = scene.beams["lower"]
    line = lower.curve.model_copy(update={"start": (0.3 * C, GAP - 3.0 * DROP), "end": end})
    ground = scene.bodies["ground"].model_copy(update={"points": {"U": (0.0, GAP), "V": line.start}})
    beams = {**scene.beams, "lower": lower.model_copy(update={"curve": line})}
    bodies = {**scene.bodies, "ground": ground}
    scene, settings = scene.model_copy(update={"beams": beams, "bodies": bodies}), Settings(elements=7)
    model = build(scene, settings)
    (pair,) = contacts(scene, model, settings.penetration)
    return model, pair


@pytest.mark.parametrize("beyond", [False, True])
def test_the_gap_of_an_end_is_its_distance_from_the_side_that_faces_it(monkeypatch, beyond):
    """The lower leans as drawn: its end is DROP below the upper's side, or beyond the upper's end and faces none.

    Its start, which the ground holds far from the upper's own, is 3 DROP below in either case.
    """
    first_at_first(monkeypatch)
    model, pair = leaning((1.1 * A if beyond else C, GAP - DROP))
    found = least_at_ends(model, pair, model.start) * model.units.length
    assert found == pytest.approx(3.0 * DROP if beyond else DROP, rel=1e-12)


def test_what_an_integral_along_the_wrong_beam_leaves_out_is_the_energy_by_the_ends_way(monkeypatch):
    """The lower, straight, slides along itself with its end inside the upper: no gap changes, nothing pushes along it.

    The zone grows all the same, and with it the energy: what that changes by per length is left out.
    """
    first_at_first(monkeypatch)
    model, pair = leaning((C, GAP - DROP))
    nodes = model.node_dofs[:2, model.beams[pair.second].nodes]
    along = np.array([0.7 * C, 2.0 * DROP]) / np.hypot(0.7 * C, 2.0 * DROP)
    lifted = np.array([0.0, 1.07 * DROP / model.units.length])

    def slid(way):
        z = model.start.values.copy()
        z[nodes] += (lifted + way * along)[:, None]
        return touch(model, pair, Penalty(1.3), 6, State.of(z))

    back, here, ahead = (slid(way) for way in (-1e-5, 0.0, 1e-5))
    assert here.closed
    change = [0.5 * float(one.stiffness @ one.gap**2) for one in (back, ahead)]
    assert here.missing == pytest.approx((change[1] - change[0]) / 2e-5, rel=1e-5)


def test_an_integral_along_the_wrong_beam_is_not_certified(monkeypatch):
    first_at_first(monkeypatch)
    monkeypatch.setattr("fea_reference.contact.least_at_ends", lambda model, pair, z: np.inf)
    monkeypatch.setattr("fea_reference.march.March.exchange_beams", lambda march: None)
    got = answer(end_under_side(("upper", "lower")), Settings(elements=30, penetration=1e-6))
    assert got.ending is Ending.NOT_CERTIFIED
    assert "an end of lower presses on the side of upper" in got.sentence


@pytest.mark.parametrize("depth", 10.0 ** np.arange(-9.0, -3.0, 0.37))
@pytest.mark.parametrize("angle", [0.07, 0.3, 1.1])
def test_a_tip_s_zone_ends_where_its_gap_does(depth, angle):
    """A straight beam's tip, ``depth`` inside another straight beam that it meets at an ``angle``.

    The gap grows by sin(angle) per length, and the zone is (depth/sin(angle)) long, with all digits of that.
    """
    n = 80
    s = np.arange(n + 1) / n
    level = NeutralLine.through(
        np.stack([s, 0.0 * s]), 0.0 * s, np.full(n, 1 / n), np.zeros((2, n + 1)), np.zeros(n), np.zeros(n)
    )
    way = np.array([np.cos(angle), -np.sin(angle)])
    points = np.array([[0.612], [-depth]]) - way[:, None] * (1.0 - s)
    steep = NeutralLine.through(
        points, np.full(n + 1, -angle), np.full(n, 1 / n), np.zeros((2, n + 1)), np.zeros(n), np.zeros(n)
    )
    found = overlap(steep, level, 0.0, survey_pair(steep, level, 1.0, 0.0), 0.0, [borders(level, None, 1.0)])
    begin, end = found.intervals.min(), found.intervals.max()
    assert end == n
    assert n - begin == pytest.approx(n * depth / np.sin(angle), rel=1e-6, abs=4e-14 * n)


@pytest.mark.parametrize("depth", [1e-2, 1e-5, 1e-9, 1e-12])
def test_a_zone_between_two_places_is_found_although_the_gap_falls_at_neither(depth):
    """g = 4 (ζ − ¼) (ζ − ¾)² − depth rises at 0 and at 1 and overlaps about ζ = ¾ by ``depth``.

    Its roots there are where (ζ − ¾)² = depth/(4 ζ − 1).
    """

    def at(zeta, guess):
        u, v = zeta - 0.25, zeta - 0.75
        slope, curvature = 4 * v**2 + 8 * u * v, 16 * v + 8 * u
        return Gap(4 * u * v**2 - depth, slope, curvature, guess, np.ones(zeta.shape, dtype=bool))

    places = np.array([0.4, 1.0])
    there = at(places, places)
    assert (there.g > 0.0).all()
    assert (there.slope > 0.0).all()
    found = negative(at, places, there, np.array([True]))
    ((low, high),) = found.intervals
    assert found.least == pytest.approx(-depth, rel=1e-6)
    assert 0.75 - low == pytest.approx(np.sqrt(depth / (4 * low - 1)), rel=1e-4)
    assert high - 0.75 == pytest.approx(np.sqrt(depth / (4 * high - 1)), rel=1e-4)


@pytest.mark.parametrize("order", [("upper", "lower"), ("lower", "upper")])
def test_what_moves_by_less_than_is_clear_does_not_overlap(order):
    # reference: the distance of two places changes by no more than both move; nodes move by up to half of that each
    apart, settings = 0.019, Settings(elements=23)
    upper = {**clamped(apart, A, "U", "tip"), "curve": {"kind": "line", "start": [0.03, apart], "end": [A, apart]}}
    lower = {**clamped(0.0, B, "V"), "curve": {"kind": "line", "start": [-0.02, 0.0], "end": [0.161, 0.0]}}
    scene = scene_from(
        {
            "name": "apart",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": YOUNG, "poisson_ratio": 0.3}},
            "bodies": {
                "ground": {"motion": "fixed", "points": {"U": [0.03, apart], "V": [-0.02, 0.0]}},
                "end": {"motion": "free", "points": {"tip": [A, apart]}},
            },
            "beams": {"upper": upper, "lower": lower},
            "loads": {"P": {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": list(order), "thick": False}},
            "stages": [{"name": "load", "steps": "P", "stations": [1.0]}],
            "probes": [{"of": "touch", "quantity": "force"}],
        }
    )
    model = build(scene, settings)
    (pair,) = contacts(scene, model, settings.penetration)
    room = motion_before_overlap(model, pair, model.start)
    assert 0.4 * apart < room * model.units.length < (1.0 + 1e-9) * apart
    rng = np.random.default_rng(7)
    for _ in range(20):
        values = model.start.values.copy()
        for beam in model.beams:
            angle = rng.uniform(-np.pi, np.pi)
            values[model.node_dofs[:2, beam.nodes]] += 0.5 * room * np.array([[np.cos(angle)], [np.sin(angle)]])
        moved = State.of(values)
        assert relative_motion(model, pair, model.start, moved) <= room * (1.0 + 1e-9)
        assert zones_of(model, pair, moved).least >= -1e-12
