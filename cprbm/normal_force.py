"""The normal force along a beam: what all that acts beyond a place pulls along the beam there.

==========  ==============================================================================
F(s)        force on what follows s by what went before, and so less all that acts beyond
f_c, s_c    forces on the beam and their places: of contacts, of loads, and at its end
ψ           tangent angle of the smooth line, :mod:`cprbm.smooth`
N           −F·t with t = (cos ψ, sin ψ), positive in tension
==========  ==============================================================================

Forces jump at their places and not at the joints that their rows go by.  Along a zone of contact they are those of its
joints, across the beam, so that N goes on evenly there.
"""

from __future__ import annotations

import numpy as np

from cprbm import smooth
from cprbm.beam_loads import spread_from
from cprbm.closure import closure_forces
from cprbm.mechanism import Mechanism
from cprbm.model import Chain
from cprbm.point import Point
from cprbm_scene.answer import Array


def normal_force(mechanism: Mechanism, point: Point, chain: Chain, points: int) -> Array:
    """N (points,) at equal arc-length steps, in units of force."""
    s = np.linspace(0.0, chain.s[-1], points)
    psi = smooth.smooth_line(chain, mechanism.problem.model.unit_length, point.state, point.at).at(s).psi
    force = force_beyond(mechanism, point, chain, s)
    return np.asarray(force[:, 0] * np.cos(psi) + force[:, 1] * np.sin(psi))


def force_beyond(mechanism: Mechanism, point: Point, chain: Chain, s: Array) -> Array:
    """Force of the part beyond arc lengths ``s`` (k,) on the part before, -F, (k, 2), in units of force."""
    model, force = mechanism.problem.model, np.zeros((len(s), 2))
    for places, forces in _forces(mechanism, point, chain):
        force += (places[None, :] > s[:, None]) @ forces
    for load, value in point.work.on_beams:
        if load.distributed and model.chains[load.chain] is chain:
            force += value * spread_from(load, s)[:, None] * load.density
    # the force at the end acts beyond all places
    last = chain.joints.stop - 1
    fx, fy = closure_forces(model, mechanism.problem.closure, point.mu)
    return np.asarray(force - (fx[last], fy[last]))


def _forces(mechanism: Mechanism, point: Point, chain: Chain) -> list[tuple[Array, Array]]:
    """Places (k,) and forces (k, 2) on a beam, of contacts and of loads at places."""
    model, found = mechanism.problem.model, []
    for group, lam in point.rows.shares(point.lam):
        pressing = np.flatnonzero(lam)
        if group.holds_angles or not pressing.size:
            continue
        pair, (fx, fy) = mechanism.pairs[group.contact], group.on_first(mechanism.pairs[group.contact].a)
        pressed = pair.pressed(point.state, point.at, group.arc[pressing])
        on_one = -lam[:, None] * np.stack((fx, fy), axis=1)
        for of, (sign, places, _) in zip(pair.chains, pressed, strict=True):
            if of is chain:
                found.append((np.asarray(places), sign * on_one[pressing]))
    for load, value in point.work.on_beams:
        if not load.distributed and model.chains[load.chain] is chain:
            found.append((load.s, value * load.forces))
    return found
