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
    new_contacts = []
    for contact in system.touches:
        if contact.push > 0.0 or zones_of(model, contact.pair, system.z).least > CLOSED * contact.pair.scale:
            continue
        if isinstance(contact.pair, Face) and contact.pair.own:
            continue  # beside an end jointed to the edge every place is near
        near = Penalty(penalties[contact.pair].stiffness, _LEAD * contact.pair.scale)
        there = touch(model, contact.pair, near, quadrature, system.z)
        if there.stiffness.any():
            gradient = model.spread(there.dofs, there.mean)
            opened = system.solve(gradient)
            if opened is not None and sense * float(gradient @ rate) < 0.0:
                new_contacts.append((there, gradient, opened))
    while new_contacts:
        C, moved = (
            np.stack([contact for _, contact, _ in new_contacts], axis=1),
            np.stack([contact for _, _, contact in new_contacts], axis=1),
        )
        G = C.T @ moved
        if not np.linalg.svd(G, compute_uv=False).min() > _NOTHING * np.abs(moved).max():
            break
        p = -np.linalg.solve(G, C.T @ rate)
        pushing = sense * p > 0.0
        if pushing.all():
            touches = {item[0].pair: item[0] for item in new_contacts}
            others = tuple(touches.get(contact.pair, contact) for contact in system.touches)
            return PathTangent(
                rate + moved @ p,
                {pair: float(push) for pair, push in zip(touches, p, strict=True)},
                replace(system, touches=others),
            )
        new_contacts = [item for item, pushes in zip(new_contacts, pushing, strict=True) if pushes]
    return PathTangent(rate, {}, system)
