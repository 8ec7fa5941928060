"""Penetration of a point contact for the force predicted by a Newton step.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
F, d    force and penetration of a point contact;  F* the force that the step predicts
c       ∂g, the stiffness-weighted mean of the contact's points
K       tangent of the system before the step
v       K⁻¹ c/(cᵀ K⁻¹ c): the motion of least energy that opens the contact by one
======  =====================================================================================

A step has an error of second order, thousands of times the penetration under a stiff penalty. From an excessive
penetration Newton's method reduces d by a third per iteration, as F ∝ d^(3/2), so that its iterations grow with the
stiffness. The penetration of F* is known, however. A contact too deep or open after a step is moved to this
penetration along v, with a negligible effect on other forces. The equations, and hence the equilibria, are unchanged.
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

_FALL = 1.5  # exponent of the penetration in the force
_WIDE = 4.0  # elements: largest width of a point contact's zone
_EVEN = 1e-2  # accepted relative difference between force and predicted force
_ROUNDS = 4
_TOUCHING = 1e-9  # thicknesses: negligible overlap
_STIFF = 100.0  # times the opening: largest motion of v; beside a clamp v costs too much energy
_MOST = 100.0  # times the previous force: a larger prediction belongs to a diverging step


@dataclass(frozen=True, slots=True)
class Depth:
    """A point contact: its ``depth`` at the force ``push``."""

    depth: float
    push: float

    def at(self, push: float) -> float:
        """Penetration at another force."""
        return float(self.depth * (push / self.push) ** (1.0 / _FALL))


def known_depths(
    system: System, depths: Mapping[Contact, float], before: Mapping[Contact, Array]
) -> dict[Contact, Depth]:
    """Depths of all contacts with known ``depths`` and point forces ``before`` (k,)."""
    known = {}
    for contact in system.touches:
        push = float(before[contact.pair].sum()) if contact.pair in before else 0.0
        deep = depths.get(contact.pair, 0.0) > _TOUCHING * contact.pair.scale
        if deep and push > 0.0:
            known[contact.pair] = Depth(depths[contact.pair], push)
    return known


def with_predicted_depths(
    model: Model,
    penalties: Mapping[Contact, Penalty],
    quadrature: int,
    system: System,
    z: State,
    predicted: Mapping[Contact, Array],
    known: dict[Contact, Depth],
) -> State:
    """State near ``z``, after a step from ``system``, in which point contacts have the ``predicted`` forces.

    The depths ``known`` are updated.
    """
    for contact in system.touches:
        if contact.pair not in known or not contact.closed or np.ptp(contact.zones.intervals) > _WIDE:
            continue
        push = min(float(predicted[contact.pair].sum()), _MOST * known[contact.pair].push)
        opening = None
        for _ in range(_ROUNDS if push > 0.0 else 0):
            there = touch(model, contact.pair, penalties[contact.pair], quadrature, z)
            pushing = there.push if there.closed else 0.0
            if abs(pushing - push) <= _EVEN * push or (there.closed and np.ptp(there.zones.intervals) > _WIDE):
                break
            if pushing > 0.0 and there.penetration > _TOUCHING * there.pair.scale:
                known[contact.pair] = Depth(there.penetration, pushing)
            opening = _opening(model, system, contact) if opening is None else opening
            if opening is None:
                break
            z = advance(model, z, (-there.zones.least - known[contact.pair].at(push)) * opening)
    return z


def _opening(model: Model, system: System, contact: Touch) -> Array | None:
    """v (size,); None where the opening needs large motions."""
    c = model.spread(contact.dofs, contact.mean)
    v = system.solve(c)
    if v is None:
        return None
    by = float(c @ v)
    return v / by if by * _STIFF > float(np.abs(v[model.moving]).max()) else None
