"""Effect of the penetration of point contacts on other forces and motions.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K, z    tangent and unknowns of an equilibrium
ε, F    penalty and force of a contact;  c = ∂g, stiffness-weighted mean of its points
d       penetration, proportional to ε to the power −1/m at a constant force
======  =====================================================================================

For a change of ε the equilibrium changes by K dz/d ln ε = F c, since without motion the force is F. The total change
up to an infinite penalty, with zero penetration, is m times this rate: the penetration changes by −d/m, and its
effects are linear in the penetration. In a nearly rigid mechanism a penetration small against the thickness may be
large against the motion; the forces of neighbouring contacts are the first to show this. An open contact that would
overlap gets a predicted force, its overlap over the compliance cᵀ K⁻¹ c.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.contacts import least_gap, touch
from fea_reference.model import Model
from fea_reference.system import System
from fea_reference.touch import Contact, Face, Pair, Penalty, Touch

SIGNIFICANT = 0.01
"""Relative change of forces and motions by a penetration that is significant."""

ROUND_OFF_DEPTH = 2e-12
"""Lengths of the longest beam: smaller penetrations are affected by round-off of positions."""

POINT = 1.0
"""Elements of the coarser beam: largest width of a point contact's zone."""

_FALLS = (1.5, 2.0)  # m between sides, and at a tip
_FAINT = 0.1  # times the largest force: reference for smaller forces
_STILL = 1e-4  # times the deflection of a beam by the largest force at its length: reference for smaller motions
_BESIDE = 1e-6  # times the measure: range above the least gap for the contact's representative places
_NEAR = 0.1  # lengths of the longest beam: larger gaps do not close under loose penalties


def point_width(model: Model, contact: Touch) -> float:
    """Largest width of a point contact's zone, in elements of the first beam."""
    beams = (contact.pair.first, contact.pair.second) if isinstance(contact.pair, Pair) else (contact.pair.first,)
    lengths = [float(model.elements.length[model.beams[i].elements.start]) for i in beams]
    return POINT * max(lengths) / lengths[0]


def is_point_contact(model: Model, contact: Touch) -> bool:
    """True if a contact presses in points only, in zones no wider than an element.

    A contact beside a joint on its surface does not count: its force grows without bound towards the joint.
    """
    if not contact.closed or _beside_joint(contact):
        return False
    (first, last), begins = contact.zones.intervals.T, contact.zones.begins
    return bool((last[np.append(begins[1:], True)] - first[begins]).max() < point_width(model, contact))


def _beside_joint(contact: Touch) -> bool:
    """True if an edge presses only within an element of a joint on the edge."""
    return isinstance(contact.pair, Face) and any(np.abs(contact.zeta - end).max() < POINT for end in contact.pair.own)


def penetration_effects(
    model: Model, system: System, penalties: Mapping[Contact, Penalty], waiting: Iterable[Contact], quadrature: int
) -> dict[Contact, float]:
    """Relative effect of every point contact's penetration on forces and motions, by contact.

    ``waiting`` are the open contacts, whose forces are predicted.
    """
    sinking = [
        contact
        for contact in system.touches
        if contact.push > 0.0 and contact.penetration > ROUND_OFF_DEPTH and is_point_contact(model, contact)
    ]
    if not sinking:
        return {}
    pressing = [contact for contact in system.touches if contact.closed]
    largest = max(contact.push for contact in pressing)
    moved = float(np.hypot(*(system.z.values - model.start.values)[model.node_dofs[:2]]).max())
    motion = max(moved, _STILL * largest / min(beam.softest for beam in model.beams))
    beside = [
        *_open_contacts(
            model, system, (contact.pair for contact in system.touches if not contact.closed), penalties, quadrature
        ),
        *_open_contacts(model, system, waiting, penalties, quadrature),
    ]
    groups = _determinate_groups(model, pressing)
    effects = {}
    for contact in sinking:
        response = system.solve(model.spread(contact.dofs, -contact.gradient))
        if response is None:
            continue
        response *= _FALLS[contact.sharp]
        share = float(np.hypot(*response[model.node_dofs[:2]]).max()) / motion
        for group in groups:
            change = sum(float(other.predicted_forces(response).sum()) - other.push for other in group)
            change += _FALLS[contact.sharp] * contact.push if any(other is contact for other in group) else 0.0
            share = max(share, abs(change) / max(sum(other.push for other in group), _FAINT * largest))
        for gap, opening, compliance in beside:
            overlap = -(gap + float(opening @ response))
            if overlap > 0.0:
                share = max(share, overlap / compliance / (_FAINT * largest))
        effects[contact.pair] = share
    return effects


def _determinate_groups(model: Model, pressing: Iterable[Touch]) -> list[list[Touch]]:
    """Groups of contacts with determinate sums of forces: contacts at the same place form a group.

    Contacts beside a joint on their surface are left out: only their moment about the joint is determinate, which the
    motion reflects.
    """
    groups: list[list[Touch]] = []
    for contact in pressing:
        if _beside_joint(contact):
            continue
        for group in groups:
            if _at_one_place(model, group[0], contact):
                group.append(contact)
                break
        else:
            groups.append([contact])
    return groups


def _at_one_place(model: Model, contact: Touch, other: Touch) -> bool:
    """True if two contacts push to the same side within an element: on a beam, or at ends joined to the same point."""
    apart = max(contact.zeta.min(), other.zeta.min()) - min(contact.zeta.max(), other.zeta.max())
    near = apart < POINT if contact.pair.first == other.pair.first else _joined(model, contact) & _joined(model, other)
    return bool(near) and float(contact.force.sum(axis=1) @ other.force.sum(axis=1)) > 0.0


def _joined(model: Model, contact: Touch) -> set[str]:
    """Points of bodies joined to an end of the first beam within an element of the contact."""
    nodes = model.node_dofs[0, model.beams[contact.pair.first].nodes]
    near = {int(nodes[0]): contact.zeta.min(), int(nodes[-1]): nodes.size - 1 - contact.zeta.max()}
    return {joint.point for joint in model.joints if near.get(int(joint.dofs[0]), POINT) < POINT}


def _open_contacts(
    model: Model,
    system: System,
    waiting: Iterable[Contact],
    penalties: Mapping[Contact, Penalty],
    quadrature: int,
) -> list[tuple[float, Array, float]]:
    """Least gap, its derivative (size,) and its compliance for every open contact.

    Contacts nearest to a joint on their surface are left out, because the gap there is zero up to round-off.
    """
    contacts = []
    for pair in waiting:
        gap = least_gap(model, pair, system.z)
        if not 0.0 <= gap < _NEAR:
            continue
        there = touch(model, pair, Penalty(pair.stiffness, gap + _BESIDE * pair.measure), quadrature, system.z)
        if not there.closed or _beside_joint(there):
            continue
        opening = model.spread(there.dofs, there.mean)
        opened = system.solve(opening)
        if opened is not None and (compliance := float(opening @ opened)) > 0.0:
            contacts.append((gap, opening, compliance))
    return contacts
