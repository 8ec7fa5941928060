"""Where a beam's end slips off the corner of something rigid, as far as a penalty tells.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
P       corner that presses on the beam's side, beside an end
ℓ       arc length from P's foot on the neutral line to that end, negative beyond
λ, s    value of what is stepped, and arc length of the branch
======  =====================================================================================

Beyond a beam's end a corner presses on its round face, by a force that turns away, or on nothing: what it held, it
pushes off, and the branch ends with the beam's side, at ℓ = 0.  A penalty acts along a zone.  Once that reaches the end
it bears less on the one side of the foot than on the other, and the branch folds back at some ℓ of the zone's width,
which goes to zero as the penalty grows.  As long as the zone is whole it knows nothing of the end: from the last place
at which it is, the branch is continued to ℓ = 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fea_reference.advance import advance
from fea_reference.branch import Branch, Place, onwards
from fea_reference.face import corners_of
from fea_reference.model import Model
from fea_reference.slipping import along_line
from fea_reference.state import State
from fea_reference.system import System
from fea_reference.touch import Face, Touch

_NEAR = 1.0  # elements: a zone that is no farther from an end is that end's
_AT = 10.0  # times how deep a corner is: as far from it a beam may lie on its sides
_ROUNDED = 1e-9  # lengths: the same for the corner itself
_BESIDE = 0.1  # of a zone's width: as near an end it is about to be cut short
_HALVINGS = 14
_DIFFERENCE = 1e-7  # arc length by which a rate is seen


@dataclass(frozen=True, slots=True)
class Stretch:
    """A stretch of a branch from a place on, of a ``length`` of arc."""

    branch: Branch
    begin: Place
    length: float


@dataclass(frozen=True, slots=True)
class Slip:
    """That an end slips off at a ``value``, foreseen from a ``place`` where ``one`` presses with a whole zone."""

    value: float
    one: Touch
    place: Place


def left_of_side(model: Model, one: Touch, z: State) -> float | None:
    """ℓ in state ``z``; None where a contact is not that of one corner with a side within an element of an end."""
    seen = _corner(model, one, z)
    if seen is None or np.abs(one.zeta - seen[1]).max() > _NEAR:
        return None
    return _left(model, one, z, *seen)


def slipped_off(model: Model, one: Touch, before: State, after: State) -> bool:
    """Whether a corner that presses on a beam's side in the state ``before`` has come past an end ``after``."""
    seen = _corner(model, one, before)
    return seen is not None and _left(model, one, before, *seen) > 0.0 > _left(model, one, after, *seen)


def left_a_corner(model: Model, before: System, after: System) -> bool:
    """Whether one of the corners that press on sides ``before`` has come past an end, and does not press on that."""
    for one in before.touches:
        if slipped_off(model, one, before.z, after.z):
            now, seen = _named(after, one.pair.name), _corner(model, one, before.z)
            there = None if now is None else _corner(model, now, after.z)
            if seen is None or there is None or there[0] != seen[0]:
                return True
    return False


def cut_short(model: Model, system: System) -> bool:
    """Whether the zone of a corner beside an end reaches that, so that its penalty ends the branch elsewhere."""
    pressing = (one for one in system.touches if left_of_side(model, one, system.z) is not None)
    return any(_cut_short(model, one, _BESIDE) for one in pressing)


def slips(model: Model, gone: Sequence[Stretch], end: System) -> Slip | None:
    """Which end, if any, slips off beyond what has ``gone`` of a branch, whose penalties have it ``end`` before."""
    for last in end.touches:
        if left_of_side(model, last, end.z) is None or not _cut_short(model, last, _BESIDE):
            continue
        name, place = last.pair.name, gone[-1].begin
        for stretch in reversed(gone):
            before = _named(stretch.begin.system, name)
            if before is None or _corner(model, before, stretch.begin.system.z) is None:
                break
            place = stretch.begin
            if not _cut_short(model, before):
                place = _whole(model, name, stretch)
                break
        return _foreseen(model, name, place)
    return None


def _foreseen(model: Model, name: str, place: Place) -> Slip | None:
    """The same from the ``place`` on at which a contact of that name is whole."""
    one, z = _named(place.system, name), place.system.z
    seen = None if one is None else _corner(model, one, z)
    if one is None or seen is None:
        return None
    here = _left(model, one, z, *seen)
    nearer = here - _left(model, one, advance(model, z, _DIFFERENCE * place.way), *seen)
    if not nearer > 0.0:
        return None
    return Slip(float(place.value + place.rate * _DIFFERENCE * here / nearer), one, place)


def _whole(model: Model, name: str, stretch: Stretch) -> Place:
    """The last place on a stretch, at whose beginning it is, at which a contact's zone is whole."""
    found, low, high = stretch.begin, 0.0, stretch.length
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        there = onwards(stretch.branch, stretch.begin, middle)
        one = None if there is None else _named(there.system, name)
        if there is None or one is None or not there.curvature > 0.0 or _cut_short(model, one):
            high = middle
        else:
            low, found = middle, there
    return found


def _named(system: System, name: str) -> Touch | None:
    """What a closed contact of that name is in a system."""
    return next((one for one in system.touches if one.pair.name == name and one.closed), None)


def _cut_short(model: Model, one: Touch, within: float = 0.0) -> bool:
    """Whether a contact's zone reaches an end of the beam, or would if it were longer by a share ``within``."""
    elements = model.beams[one.pair.first].elements
    first, last = float(one.zones.intervals.min()), float(one.zones.intervals.max())
    return bool(min(first, elements.stop - elements.start - last) <= within * (last - first))


def _corner(model: Model, one: Touch, z: State) -> tuple[int, int] | None:
    """The number of the corner that presses alone on the beam in a contact, and the nearer end ζ; None if none does."""
    face = one.pair
    if not isinstance(face, Face) or not one.closed:
        return None
    corners = corners_of(model, face, z)
    n = model.line(model.beams[face.first], z).n
    end = 0 if 2.0 * float(np.median(one.zeta)) < n else n
    if corners.size == 0 or end in face.own:
        return None
    places = one.x_m[0] + 1j * one.x_m[1]
    number = int(np.argmin(np.abs(corners - places.mean())))
    if np.abs(places - corners[number]).max() > _AT * one.penetration + _ROUNDED:
        return None
    return number, end


def _left(model: Model, one: Touch, z: State, number: int, end: int) -> float:
    """ℓ of that corner and end in state ``z``."""
    face = one.pair
    assert isinstance(face, Face)
    P, line = corners_of(model, face, z)[number], model.line(model.beams[face.first], z)
    s = along_line(line, np.array([[P.real], [P.imag]]), float(np.median(one.zeta)))
    return s if end == 0 else float(line.lengths.sum()) - s
