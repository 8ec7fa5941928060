"""Bending moment and stress along a beam, eq. (7), with the kinks that contact forces make.

==========  ==============================================================================
m_i         moment of spring i: the mean of M over element i, whose change of curvature is even
s_c, V      place of a contact force on the beam and its part along the left normal
K(s)        ½ Σ V |s − s_c|, the kinks of M: dM/ds jumps by V at s_c
K̄_i         mean of K over element i
σ           E·t/2 · M/(EI)
==========  ==============================================================================

M − K is smooth: its means m_i − K̄_i stand for its values at the springs and are joined by straight
lines; K is added back where the stress is wanted.
"""

from __future__ import annotations

import numpy as np

from cprbm.energy import spring_moments
from cprbm.equilibrium import Point
from cprbm.forces import contact_forces
from cprbm.mechanism import Mechanism
from cprbm.model import Chain
from scene.answer import Array


def bending_stress(mechanism: Mechanism, point: Point, chain: Chain, points: int) -> Array:
    """σ (points,), Pa, at equal arc-length steps; beyond the outer springs the nearest two are continued."""
    moments = spring_moments(mechanism.problem.model, point.state)[chain.first_link : chain.first_link + chain.n]
    at, jumps = _kinks(mechanism, point, chain)
    smooth = moments - np.diff(_integral(at, jumps, chain.borders)) / chain.sizes
    # beyond the outer springs the nearest two are continued
    inner, slopes = chain.s[1:-1], np.diff(smooth) / np.diff(chain.s[1:-1])
    first = smooth[0] - slopes[0] * inner[0]
    last = smooth[-1] + slopes[-1] * (chain.s[-1] - inner[-1])
    s = np.linspace(0.0, chain.s[-1], points)
    moment = np.interp(s, chain.s, np.concatenate(([first], smooth, [last]))) + _kinked(at, jumps, s)
    return np.asarray(chain.stress_unit * moment / chain.rigidity)


def _sums(at: Array, jumps: Array, s: Array) -> tuple[Array, Array, Array]:
    """Σ sgn(s − s_c) V s_cᵏ at places ``s`` for k = 0, 1, 2."""
    order = np.argsort(at)
    powers = jumps[order] * at[order] ** np.arange(3)[:, None]
    below = np.concatenate((np.zeros((3, 1)), np.cumsum(powers, axis=1)), axis=1)
    zeroth, first, second = 2.0 * below[:, np.searchsorted(at[order], s)] - below[:, -1:]
    return zeroth, first, second


def _kinked(at: Array, jumps: Array, s: Array) -> Array:
    """K at places ``s``."""
    zeroth, first, _ = _sums(at, jumps, s)
    return np.asarray(0.5 * (s * zeroth - first))


def _integral(at: Array, jumps: Array, s: Array) -> Array:
    """∫K ds = ¼ Σ V (s − s_c)|s − s_c|."""
    zeroth, first, second = _sums(at, jumps, s)
    return np.asarray(0.25 * (s * (s * zeroth - 2.0 * first) + second))


def _kinks(mechanism: Mechanism, point: Point, chain: Chain) -> tuple[Array, Array]:
    """s_c and V of all contact forces on a beam, (k,) each."""
    places: list[float] = []
    jumps: list[float] = []
    if mechanism.boundaries:  # forces of a fitted boundary act on joints
        forces = contact_forces(mechanism.problem, point)
        theta = point.state.theta[chain.links]
        tangent = np.concatenate((theta[:1], 0.5 * (theta[1:] + theta[:-1]), theta[-1:]))
        normal = forces.fy[chain.joints] * np.cos(tangent) - forces.fx[chain.joints] * np.sin(tangent)
        pressed = np.flatnonzero(normal)
        return chain.s[pressed], normal[pressed]
    for group, lam in point.rows.shares(point.lam):
        pair = mechanism.pairs[group.contact]
        pressing = np.flatnonzero(lam)
        found = pair.pressed(point.state, point.at, chain, group.arc[pressing]) if pressing.size else None
        if found is None:
            continue
        sign, at, psi = found
        p = group.joints.shape[1]
        on_a = (group.joints >= pair.a.first_joint) & (group.joints < pair.a.first_joint + pair.a.n + 2)
        weights = -sign * lam[:, None] * on_a
        fx = np.sum(weights * group.slopes[:, :p], axis=1)[pressing]
        fy = np.sum(weights * group.slopes[:, p : 2 * p], axis=1)[pressing]
        places.extend(at)
        jumps.extend(fy * np.cos(psi) - fx * np.sin(psi))
    return np.array(places), np.array(jumps)
