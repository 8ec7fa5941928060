"""What touches, overlaps and crosses, by the auditor's own fine lines; which way contacts push, and where.

Distances are of neutral lines less half of both thicknesses; a foot is a place that the other line's normal goes
through, or one of its ends.  Where beams lie as near as their thickness already at rest, beside a joint that both
have, is left out.  Lines that touch without thickness may not cross, but for what rounding and sinking leaves.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from scipy.spatial import cKDTree

from comparisons.audit import edges
from comparisons.audit.corners import Corners, corners_of, ends_of, leaning
from comparisons.audit.rest import Complex, coordinates
from comparisons.audit.seen import AnyBeam, Seen
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.statement import (
    BeamContact,
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    SelfContact,
)

DEEP = 0.05  # of the mean thickness: as deep as beams of any certificate may overlap
SUNK = 2e-3  # of the longest beam: the same of lines without thickness
APART = 0.05  # of the mean thickness: by which a contact may press across a gap
ALIGNED = 0.02  # 1 − cos: by which a force may lean from the normal
BESIDE = 3.0  # thicknesses beside a common joint in which an overlap is the joint's
RUBBING = 0.2  # sine: the same at a corner
NOTHING = 1e-6  # of a contact's largest force


Rigid = CircleContact | LineContact | HalfPlaneContact | FunctionContact


@dataclass(frozen=True)
class Feet:
    """Of places (k,) what faces them: distance, the normal from there, its arc length, whether that is an end."""

    distance: Array
    normal: Complex
    s: Array
    at_end: Flags


@dataclass(frozen=True)
class Space:
    """Between one beam and what it may touch: their names, gaps at arc lengths ``s`` (k,), those that count (k,).

    ``allowed`` is the depth to which they may overlap there.
    """

    between: str
    s: Array
    gap: Array
    counted: Flags
    allowed: float


def contacts(seen: Seen) -> Iterator[str]:
    """Everything that is wrong with gaps and contact forces."""
    for name, contact in seen.scene.contacts.items():
        if edges.areas(seen) and not isinstance(contact, SelfContact):
            yield from _of_areas(seen, name, contact)
        elif isinstance(contact, BeamContact):
            yield from _of_beams(seen, name, contact)
        elif isinstance(contact, SelfContact):
            yield from _of_itself(seen, name, contact)
        else:
            yield from _of_rigid(seen, name, contact)
    for (one, first), (other, second) in combinations(seen.beams.items(), 2):
        if name := _named(seen, one, other):
            for at, depth in _crossings(seen, first, second):
                yield f"{one} and {other} of {name} cross at {_told(at)}, by {depth:.2g} m"


def spaces(seen: Seen, name: str) -> Iterator[Space]:
    """What lies between the beams of a contact, or one and what is rigid; of areas nothing."""
    contact = seen.scene.contacts[name]
    if isinstance(contact, BeamContact):
        one, other = contact.between
        for a, b in ((one, other), (other, one)):
            yield _between_beams(seen, name, contact, a, b)
    elif isinstance(contact, SelfContact):
        yield _beside_itself(seen, contact)
    else:
        yield _off_rigid(seen, name, contact)


def _of_areas(seen: Seen, name: str, contact: BeamContact | Rigid) -> Iterator[str]:
    """Of edges: how deep they overlap, and forces that are off them, or pull, or rub."""
    yield from edges.pushes(seen, name)
    if isinstance(contact, BeamContact):
        for a, b, s, _, depth in edges.overlaps(seen):
            if {a, b} == set(contact.between):
                allowed = edges.DEEP * 0.5 * (seen.rests[a].beam.thickest + seen.rests[b].beam.thickest)
                yield from _deepest(Space(f"{a} and {b} of {name}", s, -depth, np.ones(len(s), dtype=bool), allowed))
        return
    A = edges.areas(seen)[contact.beam]
    t = A.rest.thickness(A.fine)
    for side in (0, -1):
        places = _still(seen, contact.body, A.edge(side))
        feet, rest = _surface(contact, places), _surface(contact, A.resting_edge(side))
        overlapping = rest.distance < -1e-12 * seen.longest
        counted = ~feet.at_end & ~_spread(A.fine, overlapping, float(t.max())) & ~_round_an_end(contact, places, feet)
        allowed = edges.DEEP * float(t.mean())
        what = f"{contact.beam} and what is rigid in {name}"
        yield from _deepest(Space(what, A.fine, feet.distance, counted, allowed))
    for on, s, places, forces in edges.pressing(seen, name):
        feet = _surface(contact, _still(seen, contact.body, places))
        off = np.abs(feet.distance) - edges.APART * A.rest.thickness(s)
        if off.size and off.max() > 0.0:
            worst = int(np.argmax(off))
            gap = feet.distance[worst]
            yield f"{name} presses {on} at {s[worst]:.4g} m with {abs(forces[worst]):.3g} N across a gap of {gap:.2g} m"


def _of_beams(seen: Seen, name: str, contact: BeamContact) -> Iterator[str]:
    one, other = contact.between
    for a, b in ((one, other), (other, one)):
        B = seen.beams[b]
        if contact.thick:
            yield from _deepest(_between_beams(seen, name, contact, a, b))
        yield from _pressing(seen, name, a, _feet(_pressed(seen, name, a)[1], B), B, thick=contact.thick)


def _between_beams(seen: Seen, name: str, contact: BeamContact, a: str, b: str) -> Space:
    """From places of a to b; of lines distances without a side."""
    A, B = seen.beams[a], seen.beams[b]
    s = A.fine
    feet = _feet(A.line(s)[0], B)
    T = 0.5 * (A.rest.thickness(s) + B.rest.thickness(feet.s)) if contact.thick else np.zeros(len(s))
    counted = ~feet.at_end & ~_beside_joint(seen, a, b, s)
    if contact.thick:
        counted &= ~_near_at_rest(seen, a, b, s)
    return Space(f"{a} and {b} of {name}", s, feet.distance - T, counted, DEEP * float(T.mean()))


def _beside_itself(seen: Seen, contact: SelfContact) -> Space:
    A = seen.beams[contact.beam]
    s = A.fine
    feet = _own_feet(A, s)
    T = 0.5 * (A.rest.thickness(s) + A.rest.thickness(feet.s)) if contact.thick else np.zeros(len(s))
    counted = ~feet.at_end & np.isfinite(feet.distance)
    return Space(f"{contact.beam} beside itself", s, feet.distance - T, counted, DEEP * float(T.mean()))


def _of_itself(seen: Seen, name: str, contact: SelfContact) -> Iterator[str]:
    A = seen.beams[contact.beam]
    at, _, _ = _pressed(seen, name, contact.beam)
    if contact.thick:
        yield from _deepest(_beside_itself(seen, contact))
    if at.size:
        yield from _pressing(seen, name, contact.beam, _own_feet(A, at), A, thick=contact.thick)


def _off_rigid(seen: Seen, name: str, contact: Rigid) -> Space:
    A, a = seen.beams[contact.beam], contact.beam
    s = A.fine
    feet, rest = faced(seen, contact, A.line(s)[0]), _surface(contact, A.rest.places(s))
    half = 0.5 * A.rest.thickness(s) if contact.thick else np.zeros(len(s))
    overlapping = rest.distance < half * (1.0 - 1e-9) - 1e-12 * seen.longest
    counted = ~feet.at_end & ~_spread(s, overlapping, BESIDE * float(A.rest.thickness(s).max()))
    counted &= ~_round_an_end(contact, _still(seen, contact.body, A.line(s)[0]), feet)
    allowed = DEEP * 2.0 * float(half.mean()) if contact.thick else SUNK * seen.longest
    return Space(f"{a} and what is rigid in {name}", s, feet.distance - half, counted, allowed)


def _of_rigid(seen: Seen, name: str, contact: Rigid) -> Iterator[str]:
    A, a = seen.beams[contact.beam], contact.beam
    first, moved, phi = seen.motion(contact.body)
    turn = complex(np.exp(1j * phi))
    yield from _deepest(_off_rigid(seen, name, contact))
    s, places, forces = _pressed(seen, name, a)
    on = np.zeros(len(s), dtype=bool)
    if s.size and not contact.thick and isinstance(contact, LineContact | FunctionContact):
        corners = _standing_out(contact).moved(first, moved, turn)
        sunk = SUNK * seen.longest
        number, beside = corners.standing(places, sunk)
        on = beside & corners.allow(forces, number)
        # a part of what presses there may be normal to the edge beside the corner
        yield from _on_corners(name, A, s, forces, np.where(beside & np.isin(number, number[on]), number, -1), sunk)
    yield from _pressing(seen, name, a, faced(seen, contact, places), None, thick=contact.thick, on_corners=on)


def faced(seen: Seen, contact: Rigid, places: Complex) -> Feet:
    """What a contact's rigid side is to places (k,), where its body has taken it."""
    feet = _surface(contact, _still(seen, contact.body, places))
    turn = complex(np.exp(1j * seen.motion(contact.body)[2]))
    return Feet(feet.distance, feet.normal * turn, feet.s, feet.at_end)


def _still(seen: Seen, body: str, places: Complex) -> Complex:
    """Where places (k,) would be, had their body not moved."""
    first, moved, phi = seen.motion(body)
    return np.asarray(first + (places - first - moved) / complex(np.exp(1j * phi)))


def _on_corners(name: str, beam: AnyBeam, s: Array, forces: Complex, number: Ints, sunk: float) -> Iterator[str]:
    """Of forces (k,) on a line those that rub together where a corner presses; ``number`` is −1 for none.

    What an edge presses within ``sunk`` of an end, m, is pressed at the end, and need not be normal to the line.
    """
    size = np.abs(forces)
    for corner in np.unique(number[number >= 0]):
        mine = (number == corner) & (size > NOTHING * size.max())
        at_end = (np.minimum(s[mine], beam.rest.length - s[mine]) <= sunk).any()
        tangents = np.exp(1j * beam.line(s[mine])[1])
        if mine.any() and not at_end and leaning(tangents, forces[mine]) > RUBBING:
            yield f"{name} rubs its beam at {s[mine][0]:.4g} m, where a corner presses"


def _pressed(seen: Seen, name: str, beam: str) -> tuple[Array, Complex, Complex]:
    """Arc lengths, places and forces (k,) of a contact on a beam."""
    acting = seen.acting[beam]
    mine = np.array([by == name for by in acting.by], dtype=bool) & (np.abs(acting.forces) > 0.0)
    s = acting.s[mine]
    return s, seen.beams[beam].line(s)[0], acting.forces[mine]


def _pressing(
    seen: Seen,
    name: str,
    beam: str,
    feet: Feet,
    other: AnyBeam | None,
    *,
    thick: bool,
    on_corners: Flags | None = None,
) -> Iterator[str]:
    """Forces where nothing touches, and such as pull or rub; those ``on_corners`` have no normal of their own."""
    s, _, forces = _pressed(seen, name, beam)
    if not s.size:
        return
    size = np.abs(forces)
    T = np.zeros(len(s))
    if thick:
        across = seen.rests[beam].thickness(s)
        T = 0.5 * (across + (0.0 if other is None else other.rest.thickness(feet.s)))
    allowed = APART * (T if other is not None else 2.0 * T) + (0.0 if thick else SUNK * seen.longest)
    real = size > NOTHING * size.max()
    gap = np.where(real, np.abs(feet.distance - T) - allowed, -1.0)
    worst = int(np.argmax(gap))
    if gap[worst] > 0.0:
        off = feet.distance[worst] - T[worst]
        yield f"{name} presses {beam} at {s[worst]:.4g} m with {size[worst]:.3g} N across a gap of {off:.2g} m"
    if not thick and other is not None:
        return  # lines: which way a normal points is lost where they touch
    along = (forces * np.conj(feet.normal)).real / np.where(size > 0.0, size, 1.0)
    if on_corners is not None:
        real &= ~on_corners
    worst = int(np.argmin(np.where(real, along, 1.0)))
    if real[worst] and not along[worst] >= 1.0 - ALIGNED:
        how = "pulls" if along[worst] < 0.0 else "rubs"
        said = f"its force of {size[worst]:.3g} N is {along[worst]:.3f} along the normal"
        yield f"{name} {how} {beam} at {s[worst]:.4g} m: {said}"


def _deepest(space: Space) -> Iterator[str]:
    gap = np.where(space.counted, space.gap, np.inf)
    worst = int(np.argmin(gap))
    if gap[worst] < -space.allowed:
        yield f"{space.between} overlap by {-gap[worst]:.2g} m at {space.s[worst]:.4g} m"


def _feet(places: Complex, beam: AnyBeam) -> Feet:
    """On a beam's fine line."""
    s = beam.fine
    line = beam.line(s)[0]
    if not places.size:
        return Feet(np.zeros(0), places, np.zeros(0), np.zeros(0, dtype=bool))
    nearest = cKDTree(coordinates(line)).query(coordinates(places))[1]
    return _projected(places, line, s, np.asarray(nearest))


def _projected(places: Complex, line: Complex, s: Array, nearest: np.ndarray) -> Feet:
    """From the nearest of the line's places to the foot on one of the pieces beside it."""
    last = len(line) - 1
    best = Feet(np.full(len(places), np.inf), places * 0.0, np.zeros(len(places)), np.zeros(len(places), dtype=bool))
    for first in (np.maximum(nearest - 1, 0), np.minimum(nearest, last - 1)):
        step = line[first + 1] - line[first]
        share = ((places - line[first]) * np.conj(step)).real / np.maximum(np.abs(step) ** 2, np.finfo(float).tiny)
        held = np.clip(share, 0.0, 1.0)
        away = places - line[first] - held * step
        closer = np.abs(away) < best.distance
        ended = ((first == 0) & (share < 0.0)) | ((first == last - 1) & (share > 1.0))
        foot = s[first] + held * (s[first + 1] - s[first])
        normal = away / np.maximum(np.abs(away), np.finfo(float).tiny)
        best = Feet(
            np.where(closer, np.abs(away), best.distance),
            np.where(closer, normal, best.normal),
            np.where(closer, foot, best.s),
            np.where(closer, ended, best.at_end),
        )
    return best


def _own_feet(beam: AnyBeam, at: Array) -> Feet:
    """On another lap of the same beam: between the two the tangent has turned by more than a right angle."""
    s = beam.fine
    line, psi = beam.line(s)
    psi = np.unwrap(psi)
    places = beam.line(at)[0]
    turned = np.maximum.accumulate(np.abs(np.diff(psi, prepend=psi[0]))).sum()
    if not turned > 0.0:
        none = np.full(len(at), np.inf)
        return Feet(none, places * 0.0, none * 0.0, np.zeros(len(at), dtype=bool))
    own = np.interp(at, s, psi)
    away = np.abs(places[:, None] - line)
    away[np.abs(own[:, None] - psi) < 0.5 * np.pi] = np.inf
    nearest = away.argmin(axis=1)
    feet = _projected(places, line, s, nearest)
    none = ~np.isfinite(away[np.arange(len(at)), nearest])
    return Feet(np.where(none, np.inf, feet.distance), feet.normal, feet.s, feet.at_end)


def _surface(contact: CircleContact | LineContact | HalfPlaneContact | FunctionContact, places: Complex) -> Feet:
    """On what is rigid where it is at rest; distances are negative behind its surface."""
    nowhere = np.zeros(len(places), dtype=bool)
    if isinstance(contact, CircleContact):
        away = places - complex(*contact.center)
        size = np.abs(away)
        return Feet(size - contact.radius, away / size, 0.0 * size, nowhere)
    if isinstance(contact, HalfPlaneContact):
        normal = complex(*contact.normal) / abs(complex(*contact.normal))
        distance = ((places - complex(*contact.point)) * np.conj(normal)).real
        return Feet(distance, np.full(len(places), normal), 0.0 * distance, nowhere)
    corners, left = _corners(contact), _left(contact)
    steps = np.diff(corners)
    pieces = _pieces(contact, places, corners)  # (k, few)
    share = ((places[:, None] - corners[pieces]) * np.conj(steps[pieces])).real / np.abs(steps[pieces]) ** 2
    held = np.clip(share, 0.0, 1.0)
    away = places[:, None] - corners[pieces] - held * steps[pieces]
    rows, nearest = np.arange(len(places)), np.abs(away).argmin(axis=1)
    piece, share, held, away = (each[rows, nearest] for each in (pieces, share, held, away))
    side = (1j if left else -1j) * steps / np.abs(steps)
    across = (away * np.conj(side[piece])).real
    closed = bool(abs(corners[0] - corners[-1]) == 0.0)
    ended = ((piece == 0) & (share < 0.0)) | ((piece == len(steps) - 1) & (share > 1.0))
    corner = (held != share) & (np.abs(away) > 0.0)
    # where a corner is nearest, the mean of the pieces' normals beside it says on which side
    beside = np.where(share < 0.0, piece - 1, piece + 1)
    beside = beside % len(steps) if closed else np.clip(beside, 0, len(steps) - 1)
    across = np.where(corner, (away * np.conj(side[piece] + side[beside])).real, across)
    sign = np.where(across >= 0.0, 1.0, -1.0)
    size = np.abs(away)
    lying = size <= 1e-12 * np.abs(steps).max()
    normal = np.where(
        lying | ~corner & (size < 1e-9), side[piece], sign * away / np.maximum(size, np.finfo(float).tiny)
    )
    distance, ended = sign * size, ended & (not closed)
    # behind an end what is rigid has a side, square to the last piece
    first = (piece == 0) & (share < 0.0)
    end, beyond = np.where(first, corners[0], corners[-1]), np.where(first, -steps[0], steps[-1])
    beyond = beyond / np.abs(beyond)
    on_side = ended & (((places - end) * np.conj(side[piece])).real < 0.0)
    distance = np.where(on_side, ((places - end) * np.conj(beyond)).real, distance)
    return Feet(distance, np.where(on_side, beyond, normal), 0.0 * size, ended)


def _pieces(contact: LineContact | FunctionContact, places: Complex, corners: Complex) -> Ints:
    """Pieces (k, m) of a line among which the nearest of every place is: of a finely drawn graph those at its nearest
    corner, as all of them would be thousands for every place; of a line as it was given all, ascending.
    """
    last = len(corners) - 2
    if isinstance(contact, LineContact):
        return np.broadcast_to(np.arange(last + 1), (len(places), last + 1))
    nearest = cKDTree(coordinates(corners)).query(coordinates(places))[1]
    return np.stack((np.maximum(nearest - 1, 0), np.minimum(nearest, last)), axis=1)


def _left(contact: LineContact | FunctionContact) -> bool:
    """Whether the free side is to the left."""
    if isinstance(contact, LineContact):
        return contact.side == "left"
    # along growing x what is above lies to the left; along growing y what is at larger x to the right
    return ((contact.side == "above") == (contact.axis == "x")) == (contact.range[1] > contact.range[0])


def _standing_out(contact: LineContact | FunctionContact) -> Corners:
    """Corners and ends; of a graph its ends alone, with its own tangents there and not those of its chords."""
    points, left = _corners(contact), _left(contact)
    if isinstance(contact, LineContact):
        return corners_of(points if left else points[::-1])
    v = np.array(contact.range)
    slope = np.polynomial.polynomial.polyval(v, np.polynomial.polynomial.polyder(contact.coefficients))
    along = np.diff(v)[0] * (1.0 + 1j * slope if contact.axis == "x" else slope + 1j)
    along /= np.abs(along)
    ends = points[[0, -1]]
    return ends_of(ends, along) if left else ends_of(ends[::-1], -along[::-1])


def _corners(contact: LineContact | FunctionContact) -> Complex:
    """Of a line, or of a graph drawn as one."""
    if isinstance(contact, LineContact):
        return np.array([complex(*point) for point in contact.points])
    v = np.linspace(*contact.range, 4001)
    f = np.polynomial.polynomial.polyval(v, contact.coefficients)
    return np.asarray(v + 1j * f if contact.axis == "x" else f + 1j * v)


def _round_an_end(contact: RigidContact, places: Complex, feet: Feet) -> Flags:
    """Places (k,) of a beam's line that are behind an open line without having gone through it."""
    behind = feet.distance < 0.0
    if not isinstance(contact, LineContact | FunctionContact) or not behind.any():
        return np.zeros(len(places), dtype=bool)
    corners = _corners(contact)
    through = corners[0] == corners[-1] or len(_intersections(places, corners)[0]) > 0
    return np.zeros(len(places), dtype=bool) if through else behind


def _beside_joint(seen: Seen, a: str, b: str, s: Array) -> Flags:
    """Places of the beam a beside an end that is joined to where one of b's is."""
    A, B = seen.rests[a], seen.rests[b]
    reach = BESIDE * max(A.beam.thickest, B.beam.thickest)
    found = np.zeros(len(s), dtype=bool)
    others = B.places(np.array([0.0, B.length]))
    for end, place in zip((0.0, A.length), A.places(np.array([0.0, A.length])), strict=True):
        if np.min(np.abs(others - place)) < reach:
            found |= np.abs(s - end) < reach
    return found


def _near_at_rest(seen: Seen, a: str, b: str, s: Array) -> Flags:
    """Places of a that overlap b at rest, and what is beside them."""
    A, B = seen.rests[a], seen.rests[b]
    line = B.places(seen.beams[b].fine)
    places = A.places(s)
    nearest = cKDTree(coordinates(line)).query(coordinates(places))[1]
    feet = _projected(places, line, seen.beams[b].fine, np.asarray(nearest))
    T = 0.5 * (A.thickness(s) + B.thickness(feet.s))
    return _spread(s, ~feet.at_end & (feet.distance < T * (1.0 - 1e-6)), float(T.max()))


def _spread(s: Array, flags: Flags, reach: float) -> Flags:
    """Places within a reach of flagged ones."""
    if not flags.any():
        return flags
    at = s[flags]
    beside = np.searchsorted(at, s)
    low, high = at[np.maximum(beside - 1, 0)], at[np.minimum(beside, len(at) - 1)]
    return np.asarray((np.abs(s - low) <= reach) | (np.abs(high - s) <= reach))


def _named(seen: Seen, one: str, other: str) -> str:
    """The contact of two beams; empty if there is none."""
    for name, contact in seen.scene.contacts.items():
        if isinstance(contact, BeamContact) and set(contact.between) == {one, other}:
            return name
    return ""


def _crossings(seen: Seen, first: AnyBeam, second: AnyBeam) -> Iterator[tuple[complex, float]]:
    """Where lines cross, and by how much the least deep of both parts of either is beyond the other.

    An end that stands on the other line is beyond it by what it has sunk in, however far that goes on to both sides.
    """
    a, b = (beam.line(beam.fine)[0] for beam in (first, second))
    at, places = _intersections(a, b)
    other_at, other_places = _intersections(b, a)
    depths, other_depths = _beyond(a, at, second), _beyond(b, other_at, first)
    allowed = SUNK * seen.longest
    joints = [beam.line(np.array([0.0, beam.rest.length]))[0] for beam in (first, second)]
    shared = [p for p in joints[0] if np.min(np.abs(joints[1] - p)) < 1e-6 * seen.longest]
    for place, depth in zip(places, depths, strict=True):
        if other_places.size:
            depth = min(depth, other_depths[int(np.argmin(np.abs(other_places - place)))])
        if depth > allowed and all(abs(place - p) > allowed for p in shared):
            yield complex(place), float(depth)


def _beyond(line: Complex, at: np.ndarray, other: AnyBeam) -> list[float]:
    """At each crossing (k,), behind places ``at`` of a line, the less of what its parts beside are from the other."""
    ends = np.concatenate(([0], at + 1, [len(line)]))
    depths = [np.max(np.abs(_feet(line[i:j], other).distance)) if j > i else 0.0 for i, j in pairwise(ends)]
    return [float(min(pair)) for pair in pairwise(depths)]


def _intersections(a: Complex, b: Complex) -> tuple[np.ndarray, Complex]:
    """Pieces of the line a that cross b, ascending, and where."""
    u, v = np.diff(a), np.diff(b)
    reach = 0.5 * (np.abs(u).max() + np.abs(v).max())
    trees = [cKDTree(coordinates(m)) for m in (0.5 * (a[1:] + a[:-1]), 0.5 * (b[1:] + b[:-1]))]
    pairs = trees[0].sparse_distance_matrix(trees[1], reach, output_type="ndarray")
    i, j = pairs["i"], pairs["j"]
    cross = (np.conj(u[i]) * v[j]).imag
    off = b[j] - a[i]
    safe = np.where(cross == 0.0, 1.0, cross)
    share, other = (np.conj(off) * v[j]).imag / safe, (np.conj(off) * u[i]).imag / safe
    hit = (cross != 0.0) & (share >= 0.0) & (share < 1.0) & (other >= 0.0) & (other < 1.0)
    order = np.argsort(i[hit], kind="stable")
    at = i[hit][order]
    return at, np.asarray(a[at] + share[hit][order] * u[at])


def _told(place: complex) -> str:
    return f"({place.real:.4g}, {place.imag:.4g}) m"
