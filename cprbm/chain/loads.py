"""Rows of loads.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F        value of a load
f        quantity with the load's energy −F f(z)
C(s)     neutral line, a sum of weights and nodes
=======  ====================================================================================

A force on a beam works on the displacement of C(s), a distributed load on the displacement's integral, and a moment
on the section's angle at s.  All three are linear in the unknowns of the chain.

The chain smears a load at a place over some links.  Between places less than three links apart a part of the
flexibility is missing, of order h³ for forces and h for moments.  The potential energy gets the part back; the
equilibrium of the rest of the beam is independent of the part.
"""

from __future__ import annotations

from math import hypot

import numpy as np
from scipy.sparse import csr_matrix

from cprbm.chain.beam import BeamChain
from cprbm.chain.mechanism import Form, Mechanism, Row, UnitLoad
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import BeamForce, BeamMoment, Force, Load, Moment

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(2)
"""Exact for the cubic weights of one link."""

HIDDEN_REACH = 4.0
"""Distance of two places, in links, from which the chain has all of the flexibility: weights reach two links."""


def load_row(m: Mechanism, name: str, load: Load) -> Row:
    """Row of a load."""
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
            return Row(name, form, driven=False, unit=per_moment, unit_load=_unit_moment(chain, at, links, weights))
        case BeamForce():
            chain, at = m.chains[load.beam], load.at * m.chains[load.beam].length
            weights = chain.line.weights(np.array([at]))
            form = _displaced(m, load.beam, weights, load.direction)
            return Row(name, form, driven=False, unit=per_force, unit_load=_unit_force(m, load, at, weights))
        case _:
            chain = m.chains[load.beam]
            weights = integrated_weights(chain, load.along[0] * chain.length, load.along[1] * chain.length)
            unit = per_force * m.units.length
            return Row(name, _displaced(m, load.beam, weights, load.direction), driven=False, unit=unit)


def integrated_weights(chain: BeamChain, begin: float, end: float) -> csr_matrix:
    """Weights (1, N + 2) of the nodes in the integral of C between two arc lengths."""
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


def _unit_moment(chain: BeamChain, at: float, links: Ints, weights: Array) -> UnitLoad:
    """A unit moment: the moment of a joint is the sum of the weights of all angles behind the joint."""
    behind = np.cumsum(np.bincount(links, weights, minlength=chain.links)[::-1])[::-1]
    return UnitLoad(chain.name, at, 0, np.asarray(behind[1:], dtype=float), np.zeros(chain.links))


def _unit_force(m: Mechanism, load: BeamForce, at: float, weights: csr_matrix) -> UnitLoad:
    """A unit force across the straight beam: moments of the nodes' weights about the joints, their sums as shear."""
    chain, size = m.chains[load.beam], hypot(*load.direction)
    nodal = np.zeros(chain.links + 1)
    nodal[weights.indices] = weights.data
    shear = np.cumsum(nodal[::-1])[::-1][1:]
    moments = np.cumsum((nodal * chain.arcs)[::-1])[::-1][2:] - chain.arcs[1:-1] * shear[1:]
    link = int(np.clip(np.searchsorted(chain.arcs, at) - 1, 0, chain.links - 1))
    angle = int(m.beam_angles(load.beam)[link])
    return UnitLoad(chain.name, at, 1, moments, shear, angle, (load.direction[0] / size, load.direction[1] / size))


def hidden_flexibility(m: Mechanism) -> Array:
    """Flexibility (rows, rows) of loads at places of beams, less the flexibility of the chains.

    A straight cantilever has the moments (a − s)^p before the place a of a load, p = 0 for a moment and 1 for a force,
    and the flexibility ∫ M M′ ds/EI.
    """
    hidden = np.zeros((len(m.rows), len(m.rows)))
    loads = [(number, row.unit_load) for number, row in enumerate(m.rows) if row.unit_load is not None]
    for i, one in loads:
        for j, other in loads:
            if one.beam == other.beam:
                hidden[i, j] = _exact(m.chains[one.beam], one, other) - _shown(m.chains[one.beam], one, other)
    return hidden


def hidden_angles(chain: BeamChain, s: Array, load: UnitLoad) -> Array:
    """Angles (k,) of the sections at arc lengths ``s`` under a unit load, less the angles of the chain."""
    hidden = np.zeros(len(s))
    near = np.flatnonzero(np.abs(s - load.at) < HIDDEN_REACH * chain.link_length.max())
    for k, links, weights in zip(near, *chain.angle_weights(s[near]), strict=True):
        turned = _unit_moment(chain, float(s[k]), links, weights)
        hidden[k] = _exact(chain, turned, load) - _shown(chain, turned, load)
    return hidden


def _exact(chain: BeamChain, one: UnitLoad, other: UnitLoad) -> float:
    until = min(one.at, other.at)
    places = np.union1d(chain.borders[chain.borders < until], until)

    def product(s: Array) -> Array:
        return np.asarray((one.at - s) ** one.power * (other.at - s) ** other.power)

    return float(chain.flexibility(places, product).sum()) if len(places) > 1 else 0.0


def _shown(chain: BeamChain, one: UnitLoad, other: UnitLoad) -> float:
    mixed = one.moments * (other.shear[:-1] + other.shear[1:]) + other.moments * (one.shear[:-1] + one.shear[1:])
    bent = one.moments @ (other.moments / chain.stiffness) - 0.5 * chain.skew @ mixed
    return float(bent + (chain.lean * chain.link_length + chain.half_lean) @ (one.shear * other.shear))
