"""Path tangent at a closing: the new contacts resist from there on.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K, r    tangent, and path tangent dz/dλ, without the new contacts
C       derivatives of their gaps by the unknowns, one column per contact
p       rates of the contact forces
======  =====================================================================================

At zero gap a contact has neither a zone nor a force, and r leads straight through. With gaps held at zero the path
tangent is r + K⁻¹ C p, with Cᵀ K⁻¹ C p = −Cᵀ r, where every p presses; a contact in tension is released.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.contacts import CLOSED, touch, zones_of
from fea_reference.model import Model
from fea_reference.system import System
from fea_reference.touch import Contact, Face, Penalty

_LEAD = 1e-6  # thicknesses: largest gap of places that count as touching
_NOTHING = 1e-12  # times the largest compliance: contacts below are linearly dependent


@dataclass(frozen=True, slots=True)
class PathTangent:
    """Path tangent ``rate`` (size,), rates of the contact forces ``pushes``, and the ``system`` with these contacts."""

    rate: Array
    pushes: Mapping[Contact, float]
    system: System


def path_tangent(
    model: Model, system: System, penalties: Mapping[Contact, Penalty], quadrature: int, rate: Array, sense: float
) -> PathTangent:
    """Path tangent in ``sense`` (±1) of λ with the new contacts; ``rate`` (size,) is the tangent without them."""
    found = []
    for one in system.touches:
        if one.push > 0.0 or zones_of(model, one.pair, system.z).least > CLOSED * one.pair.scale:
            continue
        if isinstance(one.pair, Face) and one.pair.own:
            continue  # beside an end jointed to the edge every place is near
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
            return PathTangent(
                rate + moved @ p,
                {pair: float(push) for pair, push in zip(touches, p, strict=True)},
                replace(system, touches=others),
            )
        found = [each for each, pushes in zip(found, pushing, strict=True) if pushes]
    return PathTangent(rate, {}, system)
