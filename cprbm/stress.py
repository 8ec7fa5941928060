"""Bending moment and stress along a beam, eq. (7), with the kinks that contact forces make.

==========  ==============================================================================
m_i         moment of spring i: the mean of M over element i by weights 1/(E·I), for the beam turns by M/(E·I)
s̄_i         the mean of s by the same weights, the element's middle where E·I is even
s_c, V      place of a contact force on the beam and its part along the left normal
K(s)        ½ Σ V |s − s_c|, the kinks of M: dM/ds jumps by V at s_c
K̄_i         the mean of K, likewise
σ           E·t/2 · M/(E·I), with t and E·I of the place
==========  ==============================================================================

M − K is smooth, whatever the section does: its means m_i − K̄_i stand for its values at s̄_i and are joined by straight
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
    section, borders = chain.section, chain.borders
    weight = section.flexibility(borders)
    inner = section.yielding(borders, np.asarray, np.zeros(0)) / weight
    smooth = moments - section.yielding(borders, lambda s: _kinked(at, jumps, s), at) / weight
    # beyond the outer springs the nearest two are continued
    slopes = np.diff(smooth) / np.diff(inner)
    first = smooth[0] - slopes[0] * inner[0]
    last = smooth[-1] + slopes[-1] * (chain.s[-1] - inner[-1])
    s = np.linspace(0.0, chain.s[-1], points)
    known = np.concatenate(([0.0], inner, chain.s[-1:]))
    moment = np.interp(s, known, np.concatenate(([first], smooth, [last]))) + _kinked(at, jumps, s)
    return np.asarray(0.5 * chain.youngs_modulus * section.thickness_at(s) * moment / section.rigidity_at(s))


def _kinked(at: Array, jumps: Array, s: Array) -> Array:
    """K at places ``s``."""
    order = np.argsort(at)
    powers = jumps[order] * at[order] ** np.arange(2)[:, None]
    below = np.concatenate((np.zeros((2, 1)), np.cumsum(powers, axis=1)), axis=1)
    # Σ sgn(s − s_c) V s_cᵏ
    zeroth, first = 2.0 * below[:, np.searchsorted(at[order], s)] - below[:, -1:]
    return np.asarray(0.5 * (s * zeroth - first))


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
