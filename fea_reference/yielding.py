"""What it changes elsewhere that contacts in a point sink in.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
K, z    tangent and unknowns of an equilibrium
ε, F    penalty and push of a contact;  c = ∂g, the mean of its points by their stiffness
d       its depth, which goes with ε to the power −1/m while its push stays
======  =====================================================================================

With ε the equilibrium goes by K dz/d ln ε = F c, as the push is F if nothing moves.  All that is left until the penalty
is without end, where the contact is not deep at all, is m times that: the depth goes by −d/m, and what follows from it
goes evenly with the depth.  Where what may move is little, depths that are nothing beside the thickness are much
beside that motion, and pushes of contacts near each other say so first.  What is open and is pushed into by that has a
push to be foreseen, too: its overlap over the compliance cᵀ K⁻¹ c.
"""

from collections.abc import Iterable, Mapping

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.contacts import least_gap, touch
from fea_reference.model import Model
from fea_reference.system import System
from fea_reference.touch import Contact, Face, Penalty, Touch

FELT = 0.01
"""Of pushes and of the motion: by how much what sinks in may change them."""

ROUNDED = 2e-12
"""Of the longest beam: less deep, what places are rounded to is felt."""

POINT = 1.0
"""Elements: a zone no wider is a point."""

_FALLS = (1.5, 2.0)  # m between sides, and at a tip
_FAINT = 0.1  # of the largest push: a smaller one is measured by that
_STILL = 1e-4  # of what the largest push does to a beam at its length: motions below are measured by that
_BESIDE = 1e-6  # of the measure: how near a place is to the least gap that stands for it
_NEAR = 0.1  # lengths of the longest beam: what is farther nothing sinks into by loose penalties


def in_points(one: Touch) -> bool:
    """Whether a contact presses in points only: in zones that are no wider than an element each.

    What presses beside a joint that lies on it has no point: its push grows without end towards the joint.
    """
    if not one.closed or _beside_joint(one):
        return False
    first, last = one.zones.intervals.T
    begins = one.zones.begins
    return bool((last[np.append(begins[1:], True)] - first[begins]).max() < POINT)


def _beside_joint(one: Touch) -> bool:
    """Whether something rigid presses within an element of a joint that lies on it, and nowhere else."""
    return isinstance(one.pair, Face) and any(np.abs(one.zeta - end).max() < POINT for end in one.pair.own)


def felt(
    model: Model, system: System, penalties: Mapping[Contact, Penalty], waiting: Iterable[Contact], quadrature: int
) -> dict[Contact, float]:
    """By how much what each contact in points sinks in is felt, as a share of pushes and of the motion.

    Of an equilibrium; ``waiting`` are the contacts that are open in it, whose pushes are foreseen.
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
    """Contacts whose pushes are known: those that press one beam at one place by their sum alone.

    Of what presses beside a joint that lies on it only the moment about the joint is, which the motion tells.
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
    """Whether two contacts push the same beam to the same side at places that no element parts."""
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
    """Of each contact that is open: its least gap, what that goes by (size,), and its compliance.

    Not of what is least open beside a joint that lies on it, where gaps are rounded to nought.
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
