"""Where a branch goes on from when something has just come to touch: what touches holds it back from there on.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K, r    tangent, and the rate dz/dλ along the branch, of the system that only touches
C       gradients of the gaps by the unknowns, one column for each contact
p       rates of the pushes
======  =====================================================================================

At the end of a gap the contact has neither a zone nor a force, and the rate r leads straight through it.  With the gaps
held it is r + K⁻¹ C p, with Cᵀ K⁻¹ C p = −Cᵀ r, where every p presses; what would pull is free to go.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.contacts import CLOSED, touch, zones_of
from fea_reference.model import Model
from fea_reference.system import System
from fea_reference.touch import Contact, Face, Penalty

_LEAD = 1e-6  # of the thickness: how near a place is to what it touches that is taken to touch, too
_NOTHING = 1e-12  # of the largest: an opening that nothing moves by


@dataclass(frozen=True, slots=True)
class Onward:
    """The ``rate`` (size,) with what touches held, rates of its ``pushes``, and the ``system`` with where it does."""

    rate: Array
    pushes: Mapping[Contact, float]
    system: System


def onward(
    model: Model, system: System, penalties: Mapping[Contact, Penalty], quadrature: int, rate: Array, sense: float
) -> Onward:
    """How the branch goes on in a ``sense`` (±1) of the value, whose ``rate`` (size,) without what touches is known."""
    found = []
    for one in system.touches:
        if one.push > 0.0 or zones_of(model, one.pair, system.z).least > CLOSED * one.pair.scale:
            continue
        if isinstance(one.pair, Face) and one.pair.own:
            continue  # beside an end that a joint holds on it all is near
        near = Penalty(penalties[one.pair].stiffness, _LEAD * one.pair.scale)
        there = touch(model, one.pair, near, quadrature, system.z)
        gradient = np.zeros(model.size)
        if there.stiffness.any():
            np.add.at(gradient, there.dofs, there.mean)
            opened = system.solve(gradient)
            if opened is not None and sense * float(gradient @ rate) < 0.0:
                found.append((there, gradient, opened))
    while found:
        C, moved = np.stack([one for _, one, _ in found], axis=1), np.stack([one for _, _, one in found], axis=1)
        G = C.T @ moved
        if not np.linalg.svd(G, compute_uv=False).min() > _NOTHING * np.abs(moved).max():
            break
        p = -np.linalg.solve(G, C.T @ rate)
        pushing = sense * p > 0.0
        if pushing.all():
            touches = {each[0].pair: each[0] for each in found}
            others = tuple(touches.get(one.pair, one) for one in system.touches)
            return Onward(
                rate + moved @ p,
                {pair: float(push) for pair, push in zip(touches, p, strict=True)},
                replace(system, touches=others),
            )
        found = [each for each, pushes in zip(found, pushing, strict=True) if pushes]
    return Onward(rate, {}, system)
