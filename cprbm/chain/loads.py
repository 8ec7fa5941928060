"""Rows of loads.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F        value of a load
f        what the load works on: its energy is −F f(z)
C(s)     neutral line, a sum of weights and nodes
=======  ====================================================================================

A force on a beam works on the displacement of C(s), a distributed load on the integral of that, and a moment on the
section's angle at s.  All three are linear in the unknowns of the chain.
"""

from __future__ import annotations

from math import hypot

import numpy as np
from scipy.sparse import csr_matrix

from cprbm.chain.beam import BeamChain
from cprbm.chain.form import Form
from cprbm.chain.mechanism import Mechanism, Row
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import BeamForce, BeamMoment, Force, Load, Moment

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(2)
"""Exact for the cubic weights of one link."""


def load_row(m: Mechanism, name: str, load: Load) -> Row:
    """Row of one load."""
    per_force, per_moment = -1.0 / m.units.force, -1.0 / m.units.moment
    match load:
        case Moment():
            return Row(name, m.rotation(load.body), driven=False, unit=per_moment)
        case Force():
            size = hypot(*load.direction)
            form = m.displacement(load.point, (load.direction[0] / size, load.direction[1] / size))
            return Row(name, form, driven=False, unit=per_force)
        case BeamMoment():
            chain, at = m.chains[load.beam], load.at * m.chains[load.beam].length
            links, weights = (each[0] for each in chain.angle_weights(np.array([at])))
            form = _weighted(m.beam_angles(load.beam), chain.link_angle, links, weights)
            softness = _moment_softness(chain, at, links, weights)
            return Row(name, form, driven=False, unit=per_moment, softness=softness)
        case BeamForce():
            chain, at = m.chains[load.beam], load.at * m.chains[load.beam].length
            weights, size = chain.line.weights(np.array([at])), hypot(*load.direction)
            link = int(np.clip(np.searchsorted(chain.arcs, at) - 1, 0, chain.links - 1))
            across = (int(m.beam_angles(load.beam)[link]), load.direction[0] / size, load.direction[1] / size)
            form = _displaced(m, load.beam, weights, load.direction)
            softness = _force_softness(chain, at, weights)
            return Row(name, form, driven=False, unit=per_force, softness=softness, across=across)
        case _:
            chain = m.chains[load.beam]
            weights = integrated_weights(chain, load.along[0] * chain.length, load.along[1] * chain.length)
            unit = per_force * m.units.length
            return Row(name, _displaced(m, load.beam, weights, load.direction), driven=False, unit=unit)


def integrated_weights(chain: BeamChain, begin: float, end: float) -> csr_matrix:
    """Weights (1, N + 2) of the nodes in the integral of C from one arc length to another."""
    inner = chain.arcs[(chain.arcs > begin) & (chain.arcs < end)]
    places = np.concatenate([[begin], inner, [end]])
    half = 0.5 * np.diff(places)
    s = 0.5 * (places[1:] + places[:-1])[:, None] + half[:, None] * GAUSS_NODES
    return csr_matrix((half[:, None] * GAUSS_WEIGHTS).reshape(1, -1)) @ chain.line.weights(s.ravel())


def _displaced(m: Mechanism, beam: str, weights: csr_matrix, direction: tuple[float, float]) -> Form:
    """Weighted displacement of a beam's nodes along a direction."""
    size, nodes = hypot(*direction), m.beam_nodes(beam)
    rest, used, factors = m.chains[beam].nodes, weights.indices, weights.data
    parts = [_weighted(nodes + axis, rest[:, axis], used, factors) * (direction[axis] / size) for axis in (0, 1)]
    return parts[0] + parts[1]


def _weighted(indices: Ints, rest: Array, used: Ints, factors: Array) -> Form:
    """Weighted change of the ``used`` unknowns from their values at rest."""
    return Form(
        -float(rest[used] @ factors),
        tuple((int(indices[i]), float(a)) for i, a in zip(used, factors, strict=True) if a != 0.0),
    )


def _moment_softness(chain: BeamChain, at: float, links: Ints, weights: Array) -> float:
    """Turn at ``at`` under a unit moment there, less the turn that the chain shows.

    The moment acts before the place, and turns the beam by ∫ ds/EI; joint i of the chain has the share W_i, the sum of
    the weights of all angles behind it.
    """
    behind = np.cumsum(np.bincount(links, weights, minlength=chain.links)[::-1])[::-1][1:]
    share = np.clip((at - chain.borders[:-1]) / np.diff(chain.borders), 0.0, 1.0)
    return float((share - behind**2) @ (1.0 / chain.stiffness))


def _force_softness(chain: BeamChain, at: float, weights: csr_matrix) -> float:
    """Displacement across a straight beam at ``at`` under a unit force there, less the one that the chain shows.

    A cantilever has the moment (at − s) before the place, ∫ M² ds/EI.  The chain has the moments of the weights about
    the joints, and their sums as shear forces of the links.
    """
    arcs, joints = chain.arcs, chain.arcs[1:-1]
    nodal = np.zeros(len(arcs))
    nodal[weights.indices] = weights.data
    shear = np.cumsum(nodal[::-1])[::-1][1:]
    moments = np.cumsum((nodal * arcs)[::-1])[::-1][2:] - joints * shear[1:]
    shown = moments @ (moments / chain.stiffness - chain.skew * (shear[:-1] + shear[1:]))
    shown += float((chain.lean * chain.link_length + chain.half_lean) @ shear**2)
    places = np.union1d(chain.borders[chain.borders < at], at)
    return float(chain.flexibility(places, lambda s: (at - s) ** 2).sum() - shown)
