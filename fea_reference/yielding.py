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
from fea_reference.touch import Contact, Face, Penalty, Touch

FELT = 0.01
"""Relative change of forces and motions by a penetration that is significant."""

ROUNDED = 2e-12
"""Lengths of the longest beam: smaller penetrations are affected by round-off of positions."""

POINT = 1.0
"""Elements: largest width of a point contact's zone."""

_FALLS = (1.5, 2.0)  # m between sides, and at a tip
_FAINT = 0.1  # times the largest force: reference for smaller forces
_STILL = 1e-4  # times the deflection of a beam by the largest force at its length: reference for smaller motions
_BESIDE = 1e-6  # times the measure: distance from the least gap within which places represent it
_NEAR = 0.1  # lengths of the longest beam: larger gaps do not close under loose penalties


def in_points(one: Touch) -> bool:
    """True if a contact presses in points only, in zones no wider than an element.

    A contact beside a joint on its surface does not count: its force grows without bound towards the joint.
    """
    if not one.closed or _beside_joint(one):
        return False
    first, last = one.zones.intervals.T
    begins = one.zones.begins
    return bool((last[np.append(begins[1:], True)] - first[begins]).max() < POINT)


def _beside_joint(one: Touch) -> bool:
    """True if an edge presses only within an element of a joint on the edge."""
    return isinstance(one.pair, Face) and any(np.abs(one.zeta - end).max() < POINT for end in one.pair.own)


def felt(
    model: Model, system: System, penalties: Mapping[Contact, Penalty], waiting: Iterable[Contact], quadrature: int
) -> dict[Contact, float]:
    """Relative effect of every point contact's penetration on forces and motions, by contact.

    ``waiting`` are the open contacts, whose forces are predicted.
    """
    sinking = [one for one in system.touches if one.push > 0.0 and one.penetration > ROUNDED and in_points(one)]
    if not sinking:
        return {}
    pressing = [one for one in system.touches if one.closed]
    largest = max(one.push for one in pressing)
    places = model.node_dofs[:2]
    motion = float(np.abs((system.z.values - model.start.values)[places]).max())
    motion = max(motion, _STILL * largest / min(beam.softest for beam in model.beams))
    beside = [
        *_beside(model, system, (one.pair for one in system.touches if not one.closed), penalties, quadrature),
        *_beside(model, system, waiting, penalties, quadrature),
    ]
    told = _told(pressing)
    found = {}
    for one in sinking:
        right = np.zeros(model.size)
        np.add.at(right, one.dofs, -one.gradient)
        way = system.solve(right)
        if way is None:
            continue
        way *= _FALLS[one.sharp]
        share = float(np.abs(way[places]).max()) / motion
        for group in told:
            more = sum(float(other.foreseen(way).sum()) - other.push for other in group)
            more += _FALLS[one.sharp] * one.push if any(other is one for other in group) else 0.0
            known = sum(other.push for other in group)
            share = max(share, abs(more) / max(known, _FAINT * largest))
        for gap, opening, compliance in beside:
            overlap = -(gap + float(opening @ way))
            if overlap > 0.0:
                share = max(share, overlap / compliance / (_FAINT * largest))
        found[one.pair] = share
    return found


def _told(pressing: Iterable[Touch]) -> list[list[Touch]]:
    """Groups of contacts with determinate sums of forces: contacts of a beam at the same place form a group.

    Contacts beside a joint on their surface are left out: only their moment about the joint is determinate, which the
    motion reflects.
    """
    groups: list[list[Touch]] = []
    for one in pressing:
        if _beside_joint(one):
            continue
        for group in groups:
            if _at_one_place(group[0], one):
                group.append(one)
                break
        else:
            groups.append([one])
    return groups


def _at_one_place(one: Touch, other: Touch) -> bool:
    """True if two contacts push the same beam to the same side within an element."""
    if one.pair.first != other.pair.first:
        return False
    apart = max(one.zeta.min(), other.zeta.min()) - min(one.zeta.max(), other.zeta.max())
    return apart < POINT and float(one.force.sum(axis=1) @ other.force.sum(axis=1)) > 0.0


def _beside(
    model: Model,
    system: System,
    open_ones: Iterable[Contact],
    penalties: Mapping[Contact, Penalty],
    quadrature: int,
) -> list[tuple[float, Array, float]]:
    """Least gap, its derivative (size,) and its compliance for every open contact.

    Contacts nearest to a joint on their surface are left out, because the gap there is zero up to round-off.
    """
    found = []
    for pair in open_ones:
        gap = least_gap(model, pair, system.z)
        if not 0.0 <= gap < _NEAR:
            continue
        there = touch(model, pair, Penalty(pair.stiffness, gap + _BESIDE * pair.measure), quadrature, system.z)
        if not there.closed or _beside_joint(there):
            continue
        opening = np.zeros(model.size)
        np.add.at(opening, there.dofs, there.mean)
        opened = system.solve(opening)
        if opened is not None and (compliance := float(opening @ opened)) > 0.0:
            found.append((gap, opening, compliance))
    return found
