"""Bending moment and stress along a beam, eq. (7), from its springs' moments and the contact forces between them.

==========  ==============================================================================
m_i         moment of spring i, that of all forces beyond it about joint i
s_i, h_i    arc length of that joint; length of the element, over which the beam turns evenly
s_c, V      place of a contact force on the beam and its part along the left normal
K(s)        ½ Σ V |s − s_c|, the kinks of M: dM/ds jumps by V at s_c
σ           E·t/2 · M/(E·I), with t and E·I of the place
==========  ==============================================================================

Equilibrium, not the curvature, says what m_i is: M at s_i, however the section varies.  A force within element i does
its work on spring i by the mean of its lever there, so that K has its mean over that element,

    K̄_i = K(s_i) + ½ Σ V ((u² + v²)/(2h_i) − |s_i − s_c|),      u + v = h_i on either side of s_c.

Between contacts the beam's own differential equation makes M as smooth as its shape, whatever the section does; across
a contact in a point M − K is.  So m_i − K̄_i are joined by polynomials through the nearest springs, and K is added back
where the stress is wanted.  What they miss is less than second order in h, and so the error of M, as that of the forces
and of the shape, goes evenly with N.

Where a distributed load begins or ends at s_q, d²M/ds² jumps by J, its part along the left normal.  The kinks of that,
¼ J (s − s_q)|s − s_q|, are taken out and added back likewise, by their own mean over each element.

At a moment on the beam M itself jumps, down by the moment: ½ M sgn(s − s_q) is taken out and added back likewise.

Where a beam lies on something, the pressure is shared by joints and what they carry next to the zone's end is no
force of the place.  Elements end where such zones do: there M is continued from the springs on the same side alone.
"""

from __future__ import annotations

import numpy as np

from cprbm.beam_loads import kinks
from cprbm.energy import spring_moments
from cprbm.mechanism import Mechanism
from cprbm.model import Chain
from cprbm.point import Point
from cprbm.zones import zones_of
from cprbm_scene.answer import Array, Flags

NEAREST = 4  # springs that a polynomial goes through


def bending_stress(mechanism: Mechanism, point: Point, chain: Chain, points: int) -> Array:
    """σ (points,), Pa, at equal arc-length steps; beyond the outer springs the nearest are continued."""
    s = np.linspace(0.0, chain.s[-1], points)
    curvature = bending_moment(mechanism, point, chain, s) / chain.section.rigidity_at(s)
    return np.asarray(0.5 * chain.youngs_modulus * chain.section.thickness_at(s) * curvature)


def bending_moment(mechanism: Mechanism, point: Point, chain: Chain, s: Array) -> Array:
    """M at arc lengths ``s`` (k,), without units; beyond the outer springs the nearest are continued."""
    moments = spring_moments(mechanism.problem.model, point.state)[chain.first_link : chain.first_link + chain.n]
    at, jumps = _kinks(mechanism, point, chain)
    forces, distributed = _loads(mechanism, point, chain)
    springs, known = _kinked(at, jumps, chain.s[1:-1]), _kinked(at, jumps, s)
    springs += _evened(chain, at, jumps)
    springs += _kinked(*forces, chain.s[1:-1]) + _evened(chain, *forces)
    known += _kinked(*forces, s)
    for c, J in zip(*distributed, strict=True):
        springs += 0.25 * J * np.diff(np.abs(chain.borders - c) ** 3) / (3.0 * chain.sizes)
        known += 0.25 * J * (s - c) * np.abs(s - c)
    for q, M in _moments(mechanism, point, chain):
        even = np.clip((chain.borders[1:] + chain.borders[:-1] - 2.0 * q) / chain.sizes, -1.0, 1.0)
        springs -= 0.5 * M * even
        known -= 0.5 * M * np.sign(s - q)
    return _joined(chain, moments - springs, _parted(mechanism, chain), s) + known


def _loads(mechanism: Mechanism, point: Point, chain: Chain) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """s_c and V of loads at places of a beam, s_q and J of the ends of distributed ones."""
    model = mechanism.problem.model
    found: dict[bool, list[tuple[Array, Array]]] = {False: [], True: []}
    for load, value in point.work.on_beams:
        if model.chains[load.chain] is chain:
            places, jumps = kinks(model, load, point.state, point.at)
            found[load.distributed].append((places, value * jumps))
    forces, distributed = (
        (np.concatenate([np.zeros(0), *(p for p, _ in each)]), np.concatenate([np.zeros(0), *(j for _, j in each)]))
        for each in (found[False], found[True])
    )
    return forces, distributed


def _moments(mechanism: Mechanism, point: Point, chain: Chain) -> list[tuple[float, float]]:
    """s_q and M of moments on a beam."""
    chains, found = mechanism.problem.model.chains, point.work.moments
    return [(load.s, value * load.moment) for load, value in found if chains[load.chain] is chain]


def _parted(mechanism: Mechanism, chain: Chain) -> Array:
    """Where M is continued from either side: ends of zones that are ends of elements, arc lengths (k,), ascending."""
    ends = [shares for name, shares in mechanism.fit.ends.items() if mechanism.pairs[name].a is chain]
    return np.sort(chain.s[-1] * np.concatenate([np.zeros(0), *ends]))


def _joined(chain: Chain, values: Array, ends: Array, s: Array) -> Array:
    """At arc lengths ``s`` (n,) what has ``values`` at the springs (N,), from the nearest on the same side of ``ends``.

    Newton's polynomials through up to NEAREST of them, fewer where there are no more between two ends.
    """
    springs = chain.s[1:-1]
    element = np.clip(np.searchsorted(chain.borders, s, side="right") - 1, 0, chain.n - 1)
    side = np.searchsorted(ends, springs)
    first, behind = np.searchsorted(side, side[element]), np.searchsorted(side, side[element], side="right")
    begin = np.clip(np.searchsorted(springs, s) - NEAREST // 2, first, np.maximum(behind - NEAREST, first))
    taken = begin[:, None] + np.arange(NEAREST)
    known = taken < behind[:, None]
    places, slopes = springs[np.minimum(taken, chain.n - 1)], values[np.minimum(taken, chain.n - 1)]
    found, product = np.zeros(len(s)), np.ones(len(s))
    for order in range(NEAREST):
        found += np.where(known[:, order], slopes[:, 0] * product, 0.0)
        product *= s - places[:, order]
        apart = places[:, order + 1 :] - places[:, : NEAREST - order - 1]
        slopes = np.diff(slopes, axis=1) / np.where(apart > 0.0, apart, 1.0)
    return found


def _kinked(at: Array, jumps: Array, s: Array) -> Array:
    """K at places ``s``."""
    order = np.argsort(at)
    powers = jumps[order] * at[order] ** np.arange(2)[:, None]
    below = np.concatenate((np.zeros((2, 1)), np.cumsum(powers, axis=1)), axis=1)
    # Σ sgn(s − s_c) V s_cᵏ
    zeroth, first = 2.0 * below[:, np.searchsorted(at[order], s)] - below[:, -1:]
    return np.asarray(0.5 * (s * zeroth - first))


def _evened(chain: Chain, at: Array, jumps: Array) -> Array:
    """K̄ − K at the springs (N,)."""
    element = np.clip(np.searchsorted(chain.borders, at, side="right") - 1, 0, chain.n - 1)
    u, h = at - chain.borders[element], chain.sizes[element]
    more = (u**2 + (h - u) ** 2) / (2.0 * h) - np.abs(u - 0.5 * h)
    return np.asarray(np.bincount(element, weights=0.5 * jumps * more, minlength=chain.n), dtype=float)


def _lies(mechanism: Mechanism, point: Point, contact: str, chain: Chain, arc: Array) -> Flags:
    """Which of a contact's forces at ``arc`` (k,) are those of zones that end where the elements of ``chain`` do."""
    pair, lies = mechanism.pairs[contact], np.zeros(len(arc), dtype=bool)
    if contact in mechanism.fit.ends and pair.a is chain:
        size = chain.size_at(arc)
        for zone in zones_of(pair, point):
            lies |= zone.long & (arc > zone.begin - size) & (arc < zone.end + size)
    return lies


def _kinks(mechanism: Mechanism, point: Point, chain: Chain) -> tuple[Array, Array]:
    """s_c and V of all contact forces on a beam but those of zones at whose ends M is parted, (k,) each."""
    places: list[float] = []
    jumps: list[float] = []
    for group, lam in point.rows.shares(point.lam):
        if group.holds_angles:
            continue  # a moment at an end is the moment there
        pair = mechanism.pairs[group.contact]
        pressing = np.flatnonzero(lam)
        arc, (fx, fy) = group.arc[pressing], group.on_first(pair.a)
        if not pressing.size or all(of is not chain for of in pair.chains):
            continue
        lies = _lies(mechanism, point, group.contact, chain, arc)
        for of, (sign, at, psi) in zip(pair.chains, pair.pressed(point.state, point.at, arc), strict=True):
            if of is not chain:
                continue
            # what lies on the first of two places does not on the second, whose elements end elsewhere
            alone = ~lies if sign > 0.0 else np.ones(len(arc), dtype=bool)
            across = fy[pressing] * np.cos(psi) - fx[pressing] * np.sin(psi)
            places.extend(at[alone])
            jumps.extend((-sign * lam[pressing] * across)[alone])
    return np.array(places), np.array(jumps)
