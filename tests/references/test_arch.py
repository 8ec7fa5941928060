"""Arches beside the shallow arch in closed form, beside energy's curvatures, and which of two losses comes first."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from tests.references.arch import Arch
from tests.references.rod import carried
from tests.references.small import euler_load_pinned
from tests.references.stability import Loaded, curvatures

PROPPED = 4.493409457909064  # tan x = x


def shallow(support, q):
    """Largest P/a of a shallow arch of half-length one under the thrust q².

    y'' = A cos qx + B sin qx, P = −2 q B, y' = (A sin qx − B cos qx + B)/q with y'' = −a at a pin and y' = −a at a
    clamp, and ∫ y'² = a²/3 as at rest: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, chapter 7.
    """
    sin, cos = np.sin(q), np.cos(q)
    # A = u + v B
    u, v = (-1.0 / cos, -sin / cos) if support == "pinned" else (-q / sin, (cos - 1.0) / sin)
    x, w = np.polynomial.legendre.leggauss(30)
    x, w = 0.5 * (x + 1.0), 0.5 * w
    fixed, by_B = u * np.sin(q * x) / q, (v * np.sin(q * x) - np.cos(q * x) + 1.0) / q
    B = np.roots([w @ by_B**2, 2.0 * w @ (fixed * by_B), w @ fixed**2 - 1.0 / 3.0])
    return -2.0 * q * np.min(B.real)


CASES = [("pinned", np.pi, (3.3, 4.0)), ("clamped", PROPPED, (3.9, 4.45))]


@pytest.mark.parametrize(("support", "q", "span"), CASES)
def test_shallow_arches(support, q, span):
    # reference: the shallow arch, from which one of half-angle a departs by a² and more
    fold = minimize_scalar(lambda q: -shallow(support, q), bounds=span, method="bounded", options={"xatol": 1e-9})
    errors = []
    for a in (0.1, 0.05):
        arch = Arch(a, support)
        found = np.array([arch.bifurcation.force, arch.force_fold.force, arch.bifurcation.thrust * a / q**2]) * a
        errors.append(found - [shallow(support, q), -fold.fun, 1.0])
    assert np.all(np.abs(errors[1]) < [0.02, 0.02, 0.005])
    assert errors[0] / errors[1] == pytest.approx(np.full(3, 4.0), abs=0.1)


def test_thrust_of_the_sideways_deflection():
    # reference: Timoshenko and Gere, chapter 7: the arch deflects sideways under Euler's load of half its length
    arch = Arch(0.01, "pinned")
    assert arch.bifurcation.thrust * 0.01**2 == pytest.approx(euler_load_pinned(1.0, 1.0), rel=1e-4)


def whole(arch, state):
    """Both halves, and what the supports hold."""
    M, Fx, y, P = state.unknowns
    crown = np.array([0.0, y, 0.0, M])
    right, a = np.array([Fx, 0.5 * P]), arch.half_angle
    end, _ = carried(crown, right, 1.0, -a)
    # the left half is the right one's image: the same place below, angles and horizontal places of the other sign
    start = np.array([-end[0], end[1], -end[2], end[3]])
    pieces = [Loaded(start, np.array([Fx, -0.5 * P]), 1.0, -a), Loaded(crown, right, 1.0, -a)]
    held = [(2, (1.0, 0.0, 0.0)), (2, (0.0, 1.0, 0.0))]
    return pieces, held + ([(0, (0.0, 0.0, 1.0)), (2, (0.0, 0.0, 1.0))] if arch.support == "clamped" else [])


KINDS = [
    ("pinned", "bifurcation"),
    ("pinned", "force_fold"),
    ("pinned", "displacement_fold"),
    ("clamped", "bifurcation"),
    ("clamped", "force_fold"),
]


@pytest.mark.parametrize(("support", "kind"), KINDS)
def test_a_curvature_vanishes(support, kind):
    # reference: Ritz's method for all changes of the whole arch; under w the crown does not move down
    arch = Arch(0.79, support)
    pieces, held = whole(arch, getattr(arch, kind))
    if kind == "displacement_fold":
        held = [*held, (1, (0.0, 1.0, 0.0))]
    assert np.min(np.abs(curvatures(pieces, held))) < 1e-6


@pytest.mark.parametrize(("support", "first"), [("pinned", "bifurcation"), ("clamped", "force_fold")])
def test_what_comes_first(support, first):
    # reference: Ritz's method
    arch = Arch(0.79, support)
    critical = getattr(arch, first)
    for share, sign in ((0.97, 1.0), (1.0, 0.0)):
        found = curvatures(*whole(arch, arch.at(share * critical.force) if sign else critical))
        assert np.sign(np.round(found[0], 6)) == sign
        assert found[1] > 0.1
    if support == "pinned":
        assert curvatures(*whole(arch, arch.at(1.03 * critical.force)))[0] < 0.0
        assert arch.force_fold.force > critical.force
    else:
        assert arch.bifurcation.displacement > critical.displacement


@pytest.mark.parametrize("support", ["pinned", "clamped"])
def test_under_a_drive_it_deflects_sideways(support):
    # reference: Ritz's method; the crown does not move down
    arch = Arch(0.79, support)
    pieces, held = whole(arch, arch.bifurcation)
    found = curvatures(pieces, [*held, (1, (0.0, 1.0, 0.0))])
    assert found[0] == pytest.approx(0.0, abs=1e-6)
    assert found[1] > 0.1


def test_higher_arches_lose_more():
    # what a path kept symmetric overstates: a fifth at 60° to either side, three quarters at 90°
    overstated = [Arch(a, "pinned") for a in (np.pi / 3.0, np.pi / 2.0)]
    ratios = [arch.force_fold.force / arch.bifurcation.force for arch in overstated]
    assert ratios == pytest.approx([1.2, 1.73], abs=0.005)
