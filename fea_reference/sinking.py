"""How deep a contact in a point is to lie for the force that a Newton step foresees.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
F, d    push and depth of a contact in a point;  F* the push that the step foresees
c       ∂g, the mean of the contact's points by their stiffness
K       tangent of the system that the step was made from
v       K⁻¹ c/(cᵀ K⁻¹ c): the motions that open the contact by one and cost least
======  =====================================================================================

A step is right but for its square, and that is thousands of times what a contact under a stiff penalty is deep.  From
a depth too large by itself Newton's method comes back by a third at a time, as F goes with d to the power 3/2, so that
its iterations grow with the stiffness.  The depth that belongs to F* is known, however: what sinks in too far, or does
not touch at all, is moved by that along v, which changes the forces of all else by next to nothing.  The equations,
and with them the equilibria, are the same.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.advance import advance
from fea_reference.contacts import touch
from fea_reference.model import Model
from fea_reference.state import State
from fea_reference.system import System
from fea_reference.touch import Contact, Penalty, Touch

_FALL = 1.5  # the power of the depth with which the push goes
_WIDE = 4.0  # elements: a zone no wider may be a point
_EVEN = 1e-2  # by which a push may differ from the one foreseen
_ROUNDS = 4
_TOUCHING = 1e-9  # of the thickness: an overlap that is none
_STIFF = 100.0  # times the opening that anything moves: beside a clamp, where it would cost much
_MOST = 100.0  # times the push before: more is foreseen by a step that goes astray


@dataclass(frozen=True, slots=True)
class Depth:
    """A contact in a point that was ``depth`` deep when it pushed with ``push``."""

    depth: float
    push: float

    def at(self, push: float) -> float:
        """How deep it is when it pushes with another."""
        return float(self.depth * (push / self.push) ** (1.0 / _FALL))


def known_depths(
    system: System, depths: Mapping[Contact, float], before: Mapping[Contact, Array]
) -> dict[Contact, Depth]:
    """Of the contacts those whose ``depths`` and pushes ``before``, (k,) each, are known."""
    found = {}
    for one in system.touches:
        push = float(before[one.pair].sum()) if one.pair in before else 0.0
        deep = depths.get(one.pair, 0.0) > _TOUCHING * one.pair.scale
        if deep and push > 0.0:
            found[one.pair] = Depth(depths[one.pair], push)
    return found


def sunk(
    model: Model,
    penalties: Mapping[Contact, Penalty],
    quadrature: int,
    system: System,
    z: State,
    foreseen: Mapping[Contact, Array],
    known: dict[Contact, Depth],
) -> State:
    """The state near ``z``, to which a step from a ``system`` led, in which contacts in a point push as ``foreseen``.

    ``known`` are depths of contacts, which are brought up to date.
    """
    for one in system.touches:
        if one.pair not in known or not one.closed or np.ptp(one.zones.intervals) > _WIDE:
            continue
        push = min(float(foreseen[one.pair].sum()), _MOST * known[one.pair].push)
        opening = None
        for _ in range(_ROUNDS if push > 0.0 else 0):
            there = touch(model, one.pair, penalties[one.pair], quadrature, z)
            pushing = there.push if there.closed else 0.0
            if abs(pushing - push) <= _EVEN * push or (there.closed and np.ptp(there.zones.intervals) > _WIDE):
                break
            if pushing > 0.0 and there.penetration > _TOUCHING * there.pair.scale:
                known[one.pair] = Depth(there.penetration, pushing)
            opening = _opening(model, system, one) if opening is None else opening
            if opening is None:
                break
            z = advance(model, z, (-there.zones.least - known[one.pair].at(push)) * opening)
    return z


def _opening(model: Model, system: System, one: Touch) -> Array | None:
    """v, (size,)."""
    c = np.zeros(model.size)
    np.add.at(c, one.dofs, one.mean)
    v = system.solve(c)
    if v is None:
        return None
    by = float(c @ v)
    return v / by if by * _STIFF > float(np.abs(v[model.moving]).max()) else None
