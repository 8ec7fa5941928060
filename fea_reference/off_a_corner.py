"""Slip of a beam's end off a rigid corner, extrapolated to infinite penalty.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
P       corner that presses on the beam's side, near an end
ℓ       arc length from P's closest point of the neutral line to that end, negative beyond
λ, s    value of the stepped parameter, and arc length of the branch
======  =====================================================================================

Beyond the beam's end the corner presses on the round end face, with a force that turns away, or on nothing. The
branch therefore ends with the beam's side, at ℓ = 0. A penalty acts along a zone. A zone that reaches the end is cut
short on a side. The branch then folds at an ℓ of the zone's width, which vanishes for an infinite penalty. A complete
zone is not affected by the end. The branch is extrapolated to ℓ = 0 from the last point with a complete zone.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea_reference.advance import advance
from fea_reference.branch import Branch, BranchPoint, point_at
from fea_reference.face import corners_of
from fea_reference.model import Model
from fea_reference.slipping import arc_length_at
from fea_reference.state import State
from fea_reference.system import System
from fea_reference.touch import Face, Touch

_NEAR = 1.0  # elements: largest distance of a zone from its end
_AT = 10.0  # times the penetration of a corner: distance beyond which the contact is on the corner's sides
_ROUNDED = 1e-9  # lengths: additional tolerance for the corner
_BESIDE = 0.1  # zone widths: distance from an end at which the zone counts as cut short
_HALVINGS = 14
_DIFFERENCE = 1e-7  # arc length increment of finite differences


@dataclass(frozen=True, slots=True)
class Segment:
    """A segment of a branch: first point and arc ``length``."""

    branch: Branch
    begin: BranchPoint
    length: float


@dataclass(frozen=True, slots=True)
class Slip:
    """Slip of an end at ``value``, extrapolated from ``place``, where the ``contact`` has a complete zone."""

    value: float
    contact: Touch
    place: BranchPoint


def distance_to_end(model: Model, contact: Touch, z: State) -> float | None:
    """ℓ in state ``z``; None unless a single corner presses on the side within an element of an end."""
    corner_and_end = _corner(model, contact, z)
    if corner_and_end is None or np.abs(contact.zeta - corner_and_end[1]).max() > _NEAR:
        return None
    return _distance(model, contact, z, *corner_and_end)


def slipped_off(model: Model, contact: Touch, before: State, after: State) -> bool:
    """True if a corner that presses on a side in state ``before`` lies beyond the end in ``after``."""
    corner_and_end = _corner(model, contact, before)
    return corner_and_end is not None and _distance(model, contact, before, *corner_and_end) > 0.0 > _distance(
        model, contact, after, *corner_and_end
    )


def leaves_corner(model: Model, before: System, after: System) -> bool:
    """True if a pressing corner came past an end of the side, and the end is not in contact with it."""
    for contact in before.touches:
        if slipped_off(model, contact, before.z, after.z):
            now, corner_and_end = _closed_contact(after, contact.pair.name), _corner(model, contact, before.z)
            there = None if now is None else _corner(model, now, after.z)
            if corner_and_end is None or there is None or there[0] != corner_and_end[0]:
                return True
    return False


def cut_short(model: Model, system: System) -> bool:
    """True if a corner's zone beside an end is cut short, so that the penalty shifts the end of the branch."""
    pressing = (contact for contact in system.touches if distance_to_end(model, contact, system.z) is not None)
    return any(_cut_short(model, contact, _BESIDE) for contact in pressing)


def find_slip(model: Model, segments: Sequence[Segment], end: System) -> Slip | None:
    """The slip beyond the ``segments`` of a branch that penalties end early, at ``end``; None without a slip."""
    for last in end.touches:
        if distance_to_end(model, last, end.z) is None or not _cut_short(model, last, _BESIDE):
            continue
        name, place = last.pair.name, segments[-1].begin
        for stretch in reversed(segments):
            before = _closed_contact(stretch.begin.system, name)
            if before is None or _corner(model, before, stretch.begin.system.z) is None:
                break
            place = stretch.begin
            if not _cut_short(model, before):
                place = _last_complete(model, name, stretch)
                break
        return _extrapolated_slip(model, name, place)
    return None


def _extrapolated_slip(model: Model, name: str, place: BranchPoint) -> Slip | None:
    """The slip extrapolated from a ``place`` with a complete zone of the named contact; None if ℓ does not decrease."""
    contact, z = _closed_contact(place.system, name), place.system.z
    corner_and_end = None if contact is None else _corner(model, contact, z)
    if contact is None or corner_and_end is None:
        return None
    here = _distance(model, contact, z, *corner_and_end)
    nearer = here - _distance(model, contact, advance(model, z, _DIFFERENCE * place.way), *corner_and_end)
    if not nearer > 0.0:
        return None
    return Slip(float(place.value + place.rate * _DIFFERENCE * here / nearer), contact, place)


def _last_complete(model: Model, name: str, stretch: Segment) -> BranchPoint:
    """The last point of a segment with a complete zone; the zone is complete at its beginning."""
    complete, low, high = stretch.begin, 0.0, stretch.length
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        there = point_at(stretch.branch, stretch.begin, middle)
        contact = None if there is None else _closed_contact(there.system, name)
        if there is None or contact is None or not there.curvature > 0.0 or _cut_short(model, contact):
            high = middle
        else:
            low, complete = middle, there
    return complete


def _closed_contact(system: System, name: str) -> Touch | None:
    """The closed contact with this name; None if there is none."""
    return next((contact for contact in system.touches if contact.pair.name == name and contact.closed), None)


def _cut_short(model: Model, contact: Touch, within: float = 0.0) -> bool:
    """True if a zone reaches an end of the beam, or comes as near as a share ``within`` of its length."""
    elements = model.beams[contact.pair.first].elements
    first, last = float(contact.zones.intervals.min()), float(contact.zones.intervals.max())
    return bool(min(first, elements.stop - elements.start - last) <= within * (last - first))


def _corner(model: Model, contact: Touch, z: State) -> tuple[int, int] | None:
    """Number of the only corner that presses on the beam, and the nearer end ζ; None without such a corner."""
    face = contact.pair
    if not isinstance(face, Face) or not contact.closed:
        return None
    corners = corners_of(model, face, z)
    n = model.line(model.beams[face.first], z).n
    end = 0 if 2.0 * float(np.median(contact.zeta)) < n else n
    if corners.size == 0 or end in face.own:
        return None
    places = contact.x_m[0] + 1j * contact.x_m[1]
    number = int(np.argmin(np.abs(corners - places.mean())))
    if np.abs(places - corners[number]).max() > _AT * contact.penetration + _ROUNDED:
        return None
    return number, end


def _distance(model: Model, contact: Touch, z: State, number: int, end: int) -> float:
    """ℓ of the given corner and end in state ``z``."""
    face = contact.pair
    assert isinstance(face, Face)
    P, line = corners_of(model, face, z)[number], model.line(model.beams[face.first], z)
    s = arc_length_at(line, np.array([[P.real], [P.imag]]), float(np.median(contact.zeta)))
    return s if end == 0 else float(line.lengths.sum()) - s
