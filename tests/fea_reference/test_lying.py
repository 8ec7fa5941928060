"""Beams that lie on each other over a length."""

import numpy as np
import pytest

from comparisons import cases
from cprbm_scene import Ending, Scene
from fea_reference import Settings, answer
from fea_reference.contacts import contacts, resting_pressure, touch
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.fea_reference.lying import LENGTH, LOWER, RADIUS, UPPER, WIDTH, YOUNG, lying
from tests.references.lying import Lying, Strip
from tests.references.small import rectangle_second_moment
from tests.references.wrapped import Wrapped

FLATTENING = YOUNG * rectangle_second_moment(UPPER, WIDTH) / RADIUS / LENGTH  # a force at the tip, for the root alone
LOAD = 4.0 * FLATTENING


def solved(scene, elements, penetration=1e-4):
    got = answer(scene, Settings(elements=elements, kinematics="bending", penetration=penetration))
    assert got.ending is Ending.COMPLETED, got.sentence
    return got.stations[-1].values


def test_a_curved_beam_is_pressed_flat():
    """Like the closed form, even in the elements, in equilibrium, and the same whichever beam is named first."""
    runs = [solved(lying(("upper", "lower"), (LOAD,)), n, p) for n, p in ((20, 1e-4), (40, 1e-4 / 16))]
    forces, lasts = ([run[probe][-1] for run in runs] for probe in ("touch.force", "touch.ends"))
    for run in runs:
        assert run["U.reaction"] + run["V.reaction"] == pytest.approx([0.0, LOAD], abs=1e-8 * LOAD)
        assert np.hypot(*run["V.reaction"]) == pytest.approx(run["touch.force"][0], rel=1e-8)
        assert run["touch.ends"][0] == pytest.approx(0.0, abs=1e-9)
    assert np.ptp(forces) < 3e-4 * forces[-1]
    assert np.ptp(lasts) < 1e-5 * lasts[-1]
    exact = Lying(
        top=Strip(LENGTH, UPPER, WIDTH, YOUNG),
        bottom=Strip(1.1 * LENGTH, LOWER, WIDTH, YOUNG),
        curvature=1.0 / RADIUS,
        force=LOAD,
    )
    for run in runs:
        assert run["tip.displacement"] == pytest.approx(exact.displacement, abs=1e-5 * LENGTH)
        assert run["touch.force"][0] == pytest.approx(np.hypot(*exact.contact_force), rel=2e-4)
        assert run["touch.centre"][0] == pytest.approx(exact.contact_centre, rel=2e-4)
        assert run["touch.ends"][1] == pytest.approx(exact.lift_off[0], rel=1e-5)
    other = solved(lying(("lower", "upper"), (LOAD,)), 20)
    assert other["touch.ends"][1] == pytest.approx(exact.lift_off[1], rel=1e-5)
    assert other["touch.force"] == pytest.approx(runs[0]["touch.force"], rel=1e-6)


def test_the_curvatures_agree_where_beams_lie_on_each_other():
    """Parallel curves: 1/κ differ by the distance of the neutral lines, (t₁ + t₂)/2."""
    got = solved(lying(("upper", "lower"), (LOAD,)), 40)
    s = np.linspace(0.0, LENGTH, 41)
    upper = 1.0 / RADIUS + got["upper.bending_stress"] / (0.5 * YOUNG * UPPER)
    distance = 0.5 * (UPPER + LOWER)
    turned = np.concatenate([[0.0], np.cumsum(0.5 * (upper[1:] + upper[:-1]) * np.diff(s))])
    # Both bend clockwise, the lower about the nearer centre: straight across it has come less far.
    across = s + distance * turned
    lower = np.interp(across, np.linspace(0.0, 1.1 * LENGTH, 41), got["lower.bending_stress"] / (0.5 * YOUNG * LOWER))
    inside = (s > 0.1 * got["touch.ends"][1]) & (s < 0.9 * got["touch.ends"][1])
    assert upper[inside] == pytest.approx((lower / (1.0 - distance * lower))[inside], abs=2e-3 * np.abs(upper).max())


def round_a_stiff_beam(between: tuple[str, str], load: float) -> Scene:
    """The wrapped beam's circle made a beam: an arc four times as thick and a thousand times as hard."""
    plain = cases.opened("wrapped").model_dump()
    thickness, angle = 0.004, 1.6
    centre, radius = np.array(plain["contacts"]["contact"]["center"]), 0.0711 - 0.5 * thickness
    start, end = (tuple(map(float, centre + radius * np.array([np.sin(a), np.cos(a)]))) for a in (0.0, angle))
    plain["materials"] = {**plain["materials"], "hard": {"youngs_modulus": 2e14, "poisson_ratio": 0.29}}
    points = {**plain["bodies"]["ground"]["points"], "D": start}
    plain["bodies"] = {**plain["bodies"], "ground": {"motion": "fixed", "points": points}}
    arc = {
        "curve": {
            "kind": "arc",
            "center": tuple(map(float, centre)),
            "start": start,
            "end": end,
            "direction": "clockwise",
        },
        "thickness": thickness,
        "width": 0.0097,
        "material": "hard",
        "start": {"joint": "weld", "point": "D"},
        "end": {"joint": "free"},
    }
    plain["beams"] = {**plain["beams"], "arc": arc}
    plain["contacts"] = {"contact": {"kind": "beam-beam", "between": between}}
    plain["stages"] = ({"name": "load", "steps": "F", "stations": (load,)},)
    return Scene.model_validate(plain)


def test_a_beam_wraps_round_a_stiff_beam_as_round_a_circle():
    """The closed form is for a rigid circle; the arc gives way by some 1e-5 of the tip's displacement."""
    load = 97.0
    exact = Wrapped(length=0.0973, radius=0.0711, thickness=0.00103, width=0.0097, youngs_modulus=2.07e11, force=load)
    found = [solved(round_a_stiff_beam(("arc", "beam"), load), n) for n in (40, 80)]
    # Arc lengths on the arc's own neutral line are shorter.
    share = (0.0711 - 0.002) / exact.neutral_radius
    for got in found:
        assert got["T.displacement"] == pytest.approx(exact.displacement, rel=1e-4)
        assert got["contact.force"][0] == pytest.approx(np.hypot(*exact.contact_force), rel=5e-4)
        assert got["contact.ends"] == pytest.approx([0.0, share * exact.wrap_length], abs=5e-5 * exact.length)
        assert got["contact.centre"][0] == pytest.approx(share * exact.contact_centre, abs=5e-4 * exact.length)
        assert got["C.reaction"] == pytest.approx(exact.reaction, abs=1e-3 * load)


@pytest.mark.parametrize("elements", [0.01, 0.9, 3.0])
def test_beams_that_part_at_their_clamps_press_no_more_than_their_penalty(elements):
    """A pressure that axial forces give is none where the beams part at once, by 3 s²/(8 R) at s from their clamps.

    A pressure that begins at a gap of that size would have a zone up to there, and would hold itself.
    """
    scene, settings = lying(("upper", "lower"), (0.0,)), Settings(elements=40, kinematics="bending")
    model = build(scene, settings)
    (pair,) = contacts(scene, model, settings.penetration)
    upper, lower = model.beam("upper"), model.beam("lower")
    radius = 4.0 * RADIUS / model.units.length
    z = model.start.values.copy()
    x, y, _ = dofs = model.node_dofs[:, lower.nodes]
    angle = z[x] / radius
    z[dofs] = radius * np.sin(angle), z[y] + radius * (1.0 - np.cos(angle)), angle
    z[model.element_dofs[6, upper.elements]] = -1.0  # pushed the upper leans into the hollow lower, if it lies there
    s = elements * float(model.elements.length[upper.elements.start])
    one = touch(model, pair, Penalty(pair.stiffness, 1.5 * s**2 / radius), 6, State.of(z))
    assert np.ptp(one.zones.intervals) == pytest.approx(elements, rel=0.02)
    pressure = resting_pressure(model, one, State.of(z))
    assert pressure > 0.0 if elements > 1.0 else pressure == 0.0
