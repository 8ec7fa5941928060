"""Numbers of ``rare/expected.toml`` against closed forms and independent integrations."""

import numpy as np
import pytest
from scipy.optimize import brentq

import elastica_reference
from cprbm_scene import CircleContact
from cprbm_scene.frozendict import frozendict
from tests.cprbm.scenes import LENGTH
from tests.fea_reference.cantilever import elastica
from tests.references import ends_of_both, moment_beside_corner
from tests.scenes.rare_scenes import expectations, scene

EXPECTED = expectations()


def held(name, reference):
    """Whether the stated number is the reference to a hundredth of the stated tolerance."""
    expected = EXPECTED[name]
    return abs(reference - expected.value) <= 0.01 * expected.within


def last_value(answer, probe, component=0):
    assert answer.completed, answer.sentence
    return answer.stations[-1].values[probe][component]


def test_carried_round_a_tip():
    # a cantilever pressed aside by w at the height h: F = 3 EI w/h³, to the square of w/h
    post = scene("carried-round-a-tip").beams["post"]
    bending = 2.1e9 * post.width * post.thickness**3 / 12.0
    assert held("carried-round-a-tip", 3.0 * bending * 7e-5 / 0.053**3)


@pytest.mark.parametrize("name", [name for name in EXPECTED if name.startswith("end-slips-off-an-end")])
def test_end_slips_off_an_end(name):
    # small deflections of a cantilever loaded at its end: w = δ (3 u² − u³)/2 over u = x/L, so that the end is
    # ∫ ½ w'² dx = 3 δ²/(5 L) short of L, and the tip at rest stands at 0.0871 m
    length, pressed = 0.0913, 0.0037
    assert held(name, length - 3.0 * pressed**2 / (5.0 * length) - 0.0871)


def propped(P, length=0.2, EI=2e9 * 0.01 * 4e-4**3 / 12.0):
    """Deflection at the middle, shortening and slope at the end of a beam clamped and propped, P at its middle.

    EI w″ = −5P (L − x)/16 + P ⟨L/2 − x⟩, and the shortening is ½ ∫ w′² dx (Timoshenko, Strength of Materials).
    """
    x = np.linspace(0.0, length, 20001)
    bent = (-5.0 * P * (length - x) / 16.0 + P * np.maximum(0.5 * length - x, 0.0)) / EI
    slope = np.concatenate(([0.0], np.cumsum(0.5 * (bent[1:] + bent[:-1]) * np.diff(x))))
    w = np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(x))))
    drawn = 0.5 * float(np.sum(0.5 * (slope[1:] ** 2 + slope[:-1] ** 2) * np.diff(x)))
    return float(abs(w[10000])), drawn, float(abs(slope[-1]))


@pytest.mark.parametrize("name", [name for name in EXPECTED if name.startswith("off-a-corner")])
def test_off_a_corner(name):
    # the corner comes to the end where the shortening is e + T ψ/2; linear theory departs by a part of (w/L)²
    corner = scene(name).contacts["corner"].points[1]
    beyond = 0.2 - corner[0]
    slips = brentq(lambda P: propped(P)[1] - 0.5 * 4e-4 * propped(P)[2] - beyond, 1e-3, 1.0)
    stations = scene(name).stages[0].stations
    assert stations[-1] == pytest.approx(1.5 * slips, rel=1e-6)
    if EXPECTED[name].reference.startswith("linear theory"):
        assert held(name, slips)


def closing_angle():
    """Rotation of the end at which the strip of the scenes ``rolled-…-closed`` closes, rad.

    A moment alone bends the strip, in proportion to 1/width; trapezia over 8001 places.
    """
    strip = scene("rolled-nearly-closed").beams["beam"]
    length, width = strip.curve.end[0], strip.width
    s = np.linspace(0.0, length, 8001)
    bend = 1.0 / np.interp(s / length, width.at, width.values)

    def summed(f):
        return np.concatenate(([0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(s))))

    def gap(turn):
        angle = summed(bend)
        line = summed(np.exp(1j * turn * angle / angle[-1]))
        first, last = line[: len(s) // 3], line[-len(s) // 3 :: 4]
        return np.min(np.abs(first[:, None] - last)) - 0.000368

    return brentq(gap, 7.2, 7.7, xtol=1e-7)


def test_rolled_strips_stop_beside_the_closing_angle():
    closes = closing_angle()
    for name, beyond in (("rolled-nearly-closed", -0.05), ("rolled-hardly-closed", 0.005)):
        assert scene(name).stages[0].stations[0] - closes == pytest.approx(beyond, abs=1e-5), name


@pytest.mark.parametrize("name", ["ends-on-both-sides", "ends-on-both-sides-reversed"])
def test_ends_on_both_sides(name):
    reference = ends_of_both.pressed()
    assert abs(reference.angle) > 0.4
    assert held(name, 2.0 * reference.force)


@pytest.mark.parametrize("name", ["lying-on-a-half-plane", "lying-on-a-line"])
def test_lifted_off_a_floor(name):
    # the elastica of Bisshopp and Drucker under F L²/(E I) = 0.43
    assert held(name, LENGTH * elastica(0.43)[1])


def test_moment_beside_a_corner():
    assert held("moment-beside-a-corner", moment_beside_corner.pressed(-0.2081).force)


@pytest.mark.parametrize(
    "name", ["arch-over-an-end", "hard-on-a-small-circle", *(n for n in EXPECTED if n.startswith("zone-off-the-clamp"))]
)
def test_the_exact_elastica(name):
    expected = EXPECTED[name]
    answer = elastica_reference.answer(scene(name))
    assert held(name, last_value(answer, expected.of, expected.component))


def test_a_held_end_is_a_circle_of_half_the_thickness():
    question = scene("on-a-held-end")
    stub = question.beams["stub"]
    circle = CircleContact(
        kind="beam-circle", beam="beam", body="wall", center=stub.curve.start, radius=0.5 * stub.thickness
    )
    changes = {
        "beams": frozendict({"beam": question.beams["beam"]}),
        "contacts": frozendict({"lean": circle}),
    }
    answer = elastica_reference.answer(question.model_copy(update=changes))
    for name in ("on-a-held-end", "on-a-held-end-reversed"):
        assert held(name, last_value(answer, EXPECTED[name].of))
