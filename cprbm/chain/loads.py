"""Flexibility that a chain lacks beside loads at places of a beam.

The chain smears a load at a place over some links.  Between places less than three links apart a part of the
flexibility is missing, of order h³ for forces and h for moments.  The potential energy gets the part back; the
equilibrium of the rest of the beam is independent of the part.
"""

import numpy as np
from scipy.sparse import csr_matrix

from cprbm.chain.beam import BeamChain
from cprbm.chain.mechanism import Direction, Mechanism, UnitLoad
from cprbm_scene.answer import Array, Ints

HIDDEN_REACH = 4.0
"""Distance of two places, in links, from which the chain has all of the flexibility: weights reach two links."""


def unit_moment(chain: BeamChain, at: float, links: Ints, weights: Array) -> UnitLoad:
    """A unit moment: the moment of a joint is the sum of the weights of all angles behind the joint."""
    behind = np.cumsum(np.bincount(links, weights, minlength=chain.links)[::-1])[::-1]
    return UnitLoad(chain.name, at, 0, np.asarray(behind[1:], dtype=float), np.zeros(chain.links))


def unit_force(m: Mechanism, beam: str, direction: Direction, at: float, weights: csr_matrix) -> UnitLoad:
    """A unit force across the straight beam: moments of the nodes' weights about the joints, their sums as shear."""
    chain = m.chains[beam]
    nodal = np.zeros(chain.links + 1)
    nodal[weights.indices] = weights.data
    shear = np.cumsum(nodal[::-1])[::-1][1:]
    moments = np.cumsum((nodal * chain.arcs)[::-1])[::-1][2:] - chain.arcs[1:-1] * shear[1:]
    link = int(np.clip(np.searchsorted(chain.arcs, at) - 1, 0, chain.links - 1))
    return UnitLoad(beam, at, 1, moments, shear, int(m.beam_angles(beam)[link]), direction)


def hidden_flexibility(m: Mechanism) -> Array:
    """Flexibility (2 rows, 2 rows) of loads across and of forces along beams at places, less that of the chains.

    A straight cantilever has the moments (a − s)^p and the shear forces p before the place a of a load, p = 0 for a
    moment and 1 for a force, and the flexibility ∫ (M M′/EI + Q Q′/GA_s) ds.  Along the beam a force has ∫ N N′/EA ds.
    """
    hidden = np.zeros((2, len(m.rows), 2, len(m.rows)))
    loads = [(number, row.unit_load) for number, row in enumerate(m.rows) if row.unit_load is not None]
    for i, one in loads:
        for j, other in loads:
            if one.beam == other.beam:
                chain = m.chains[one.beam]
                hidden[0, i, 0, j] = _hidden(chain, one, other)
                hidden[1, i, 1, j] = _of_forces(chain, one, other, chain.stretch)
    return hidden.reshape(2 * len(m.rows), -1)


def hidden_angles(chain: BeamChain, s: Array, load: UnitLoad) -> Array:
    """Angles (k,) of the sections at arc lengths ``s`` under a unit load, less the angles of the chain."""
    hidden = np.zeros(len(s))
    near = np.flatnonzero(np.abs(s - load.at) < HIDDEN_REACH * chain.link_length.max())
    for k, links, weights in zip(near, *chain.angle_weights(s[near]), strict=True):
        hidden[k] = _hidden(chain, unit_moment(chain, float(s[k]), links, weights), load)
    return hidden


def _hidden(chain: BeamChain, one: UnitLoad, other: UnitLoad) -> float:
    """Flexibility of two unit loads, less the flexibility of the chain."""
    at, exact = min(one.at, other.at), _of_forces(chain, one, other, chain.shear)
    if at > 0.0:
        exact += chain.flexibility(
            np.append(chain.borders[chain.borders < at], at),
            lambda s: (one.at - s) ** one.power * (other.at - s) ** other.power,
        ).sum()
    mixed = one.moments * (other.shear[:-1] + other.shear[1:]) + other.moments * (one.shear[:-1] + one.shear[1:])
    bent = one.moments @ (other.moments / chain.stiffness) - 0.5 * chain.skew @ mixed
    return float(exact - bent - (chain.lean * chain.link_length + chain.half_lean) @ (one.shear * other.shear))


def _of_forces(chain: BeamChain, one: UnitLoad, other: UnitLoad, compliance: Array) -> float:
    """Flexibility of two unit forces by a compliance (links,) of the links, less the flexibility of the chain."""
    gives = compliance * chain.link_length
    exact = np.interp(min(one.at, other.at), chain.arcs, np.append(0.0, np.cumsum(gives)))
    return float(one.power * other.power * exact - gives @ (one.shear * other.shear))
