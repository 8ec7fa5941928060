"""Declared contacts and undeclared contact: penetration, forces across gaps, forces along the normal, crossings.

======  =================================================================================================
symbol  meaning
======  =================================================================================================
x       place of the beam's neutral line
g(x)    distance of x from the partner: the outline of a beam, of another lap, or of a rigid solid
a       distance of x from its own surface: half of the thickness
F, f    contact force on the beam, and its unit vector
======  =================================================================================================

A contact holds where g >= a everywhere, g = a where a force acts, and F acts along the normal of the partner.  A step
δ along the normal is the step that increases g most: (g(x + δ f) - g(x))/δ is the cosine of the angle between F and the
normal.  Lines without thickness touch a rigid solid that is smaller by SUNK all around: a distance from the surface
itself has no sign.  Where two beams touch as lines, neither penetration nor direction is judged.

Undeclared contact is an overlap of two outlines that are thinner by DEEP, or of two places of a beam that are farther
apart along the beam than LAP thicknesses.  On a radius of a thickness such places are 1.7 thicknesses apart.  No
crossing is a pair with a contact, with a touch or an overlap at rest, such as a common joint, or in the scene's
``may_cross``.  Beside a beam in a contact of lines only the lines count.

All distances carry the errors of fine polylines and of the solvers' penalties.
"""

from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry
from shapely.ops import split

from comparisons.audit.state import PIECES, Complex, Finding, StationState
from comparisons.formats import at_station
from comparisons.geometry import RigidEdge, edge_places, is_free_on_the_left
from cprbm_scene import ACTIVE, Array, CircleContact, Contact, RigidContact, Scene, SelfContact

Rigid = CircleContact | RigidEdge

DEEP, SUNK, ROUGH = 0.05, 2e-3, 1e-5
"""Largest penetration, and largest gap under a force: of thick beams over the thickness, also without a declared
contact; of lines over the longest beam.  At least the distance of a polygon from a circle as long counts."""

ALIGNED, LINE_ALIGNED = 0.98, 0.8
"""Least cosine of the angle between a contact force and the normal, of thick beams and of lines."""

BESIDE = 3.0
"""Thicknesses beside an overlap at rest, such as a common joint, within which penetration is not judged."""

SMALL = 1e-6
"""Share of a contact's largest force below which places and directions of a force are not judged; also the
counted share of thicknesses beside a beam in a contact of lines, and the distance of both ends of a closed edge over
the edge's size."""

LAP = 2.0
"""Thicknesses along a beam between two pieces from which on an overlap of both is a crossing."""

FAR, BEHIND = 1e3, 0.05
"""Length of the edge of a half-plane, also the distance of a missing lap, and depth of the rigid solid behind an edge,
over the longest beam."""


def contacts(state: StationState) -> Iterator[Finding]:
    """Penetrations of contacts, gaps under forces, and forces that pull or rub."""
    for name, contact in state.scene.contacts.items():
        for on in dict.fromkeys(contact.beams):
            if contact.thick or isinstance(contact, RigidContact):
                yield _penetration(state, name, on)
            yield from _pressing(state, name, on)


def _penetration(state: StationState, name: str, on: str) -> Finding:
    """The deepest penetration of a beam outside overlaps at rest."""
    contact, (s, x), t = state.scene.contacts[name], state.beams[on].fine, state.beams[on].beam.thickest
    own, allowed = _surface(state, contact, on, s)
    deep = own - _gap(state, contact, on, x, s) - (1.0 - SMALL) * allowed
    if (deep > 0.0).any():
        at_rest = own - _gap(state.at_rest, contact, on, state.beams[on].rest(s)[0], s) > 0.501 * allowed
        deep[np.min(np.abs(s[:, None] - s[at_rest]), axis=1, initial=np.inf) <= BESIDE * t] = -np.inf
    worst = int(np.argmax(deep))
    return (
        deep[worst],
        f"{on} at {s[worst]:.4g} m penetrates its partner in {name} by {deep[worst] + allowed[worst]:.2g} m",
    )


def _pressing(state: StationState, name: str, on: str) -> Iterator[Finding]:
    """Gaps under forces, and forces that pull or rub."""
    contact, forces = state.scene.contacts[name], state.on[on][state.on[on]["source"] == name]
    size = np.abs(forces["force"])
    forces = forces[size > max(SMALL * size.max(initial=0.0), ACTIVE * state.largest[0])]
    if len(forces):
        s, way, x = forces["s"], forces["force"] / np.abs(forces["force"]), state.beams[on].line(forces["s"])
        (own, allowed), gap = _surface(state, contact, on, s), _gap(state, contact, on, x, s, way)
        off = np.abs(gap - own) - allowed
        worst = int(np.argmax(off))
        yield off[worst], f"{name} presses {on} at {s[worst]:.4g} m across a gap of {(gap - own)[worst]:.2g} m"
        if contact.thick or isinstance(contact, RigidContact):
            step, least = (0.2 * own, ALIGNED) if contact.thick else (2.5 * own, LINE_ALIGNED)
            cosine = (_gap(state, contact, on, x + step * way, s, way) - gap) / step
            yield (
                least - cosine.min(),
                f"{name} pulls or rubs {on} at {s[np.argmin(cosine)]:.4g} m, "
                f"with {cosine.min():.3f} of the force along the normal",
            )


def _surface(state: StationState, contact: Contact, on: str, s: Array) -> tuple[Array, Array]:
    """Distances a of the own surface, and largest errors of a distance, (k,), m."""
    t, sunk = state.beams[on].thickness(s), np.full(len(s), 2.0 * SUNK * state.longest)
    return (
        (0.5 * t, np.maximum(DEEP * t, ROUGH * state.longest))
        if contact.thick
        else (sunk * isinstance(contact, RigidContact), sunk)
    )


def _gap(state: StationState, contact: Contact, on: str, x: Complex, s: Array, way: Complex | complex = 0j) -> Array:
    """Distances g of places x (k,) from the partner of a beam, whose arc lengths there are s (k,).

    Of a beam that touches itself only the laps count from which unit vectors ``way`` (k,) lead away.
    """
    if isinstance(contact, RigidContact):
        return np.asarray(shapely.distance(shapely.points(x.real, x.imag), _solid(state, contact)))
    partner = state.beams[next((other for other in contact.beams if other != on), on)]
    at, line = partner.fine
    pieces, psi = np.diff(line), np.unwrap(np.angle(np.diff(line)))
    share = np.clip(((x[:, None] - line[:-1]) * np.conj(pieces)).real / np.abs(pieces) ** 2, 0.0, 1.0)
    away = np.abs(x[:, None] - line[:-1] - share * pieces)
    away -= 0.5 * contact.thick * partner.thickness(at[:-1] + share * np.diff(at))
    if isinstance(contact, SelfContact):  # another lap: between both laps the tangent turns by more than a right angle
        near = np.abs(np.interp(s, at[:-1], psi)[:, None] - psi) < 0.5 * np.pi
        away[near | (((line[:-1] - x[:, None]) * np.conj(np.reshape(way, (-1, 1)))).real > 0.0)] = FAR * state.longest
    return np.asarray(away.min(axis=1))


def _solid(state: StationState, contact: Rigid) -> shapely.Geometry:
    """The rigid solid of a contact at its present place, smaller by SUNK if beams touch as lines."""
    return shapely.transform(
        _solid_at_rest(contact, state.longest),
        lambda xy: state.carried(contact.body, np.asarray(xy @ (1.0, 1j))).view(float).reshape(-1, 2),
    )


@cache
def _solid_at_rest(contact: Rigid, longest: float) -> shapely.Geometry:
    depth, smaller = BEHIND * longest, 0.0 if contact.thick else SUNK * longest
    if isinstance(contact, CircleContact):
        disc, hole = shapely.Point(contact.center).buffer(contact.radius, quad_segs=PIECES), contact.side == "inside"
    else:
        places, left = edge_places(contact, FAR * longest, PIECES), is_free_on_the_left(contact)
        if np.abs(places[0] - places[-1]).max() >= SMALL * np.ptp(places, axis=0).max():
            return _behind(places, -depth if left else depth).buffer(-smaller)
        disc = shapely.Polygon(places)
        hole = disc.exterior.is_ccw == left
    return (disc.buffer(depth) - disc if hole else disc).buffer(-smaller)


def _behind(places: Array, depth: float) -> BaseGeometry:
    """The solid up to a depth behind an open edge (k, 2), on the left of the edge where ``depth`` is positive.

    Behind a needle the strip along one flank reaches out of the other flank.  The edge, straight beyond both ends,
    divides the strip, and parts beside the free side of the edge alone are no solid.
    """
    strip = shapely.LineString(places).buffer(depth, single_sided=True)
    size, onward = abs(depth) + np.hypot(*np.ptp(places, axis=0)), np.diff(places, axis=0)
    onward /= np.hypot(*onward.T)[:, None]
    whole = np.concatenate([places[:1] - size * onward[:1], places, places[-1:] + size * onward[-1:]])
    middle, beside = 0.5 * (places[1:] + places[:-1]), SMALL * depth * onward[:, ::-1] * [-1.0, 1.0]
    parts = shapely.get_parts(split(strip, shapely.LineString(whole)))
    solid, free = (shapely.intersects(parts, shapely.multipoints(middle + way * beside)) for way in (1.0, -1.0))
    return shapely.union_all(parts[solid | ~free])


def crossings(scene: Scene, states: Sequence[StationState]) -> Iterator[str]:
    """A sentence for every pair of shapes with undeclared contact: the pair, the load, and two ways to go on.

    Args:
        scene: the question.
        states: of an answer, in order.
    """
    touching = ((*of.beams, *(() if isinstance(of, SelfContact) else (name,))) for name, of in scene.contacts.items())
    named = (*scene.may_cross, *(beams[:2] for beams in touching))
    known = {frozenset(pair) for pair in named}.union(*(_overlaps(state.at_rest, 1.0 + DEEP) for state in states[:1]))
    for state in states:
        for pair in _overlaps(state, 1.0 - DEEP) - known:
            known.add(pair)
            one, *others = sorted(pair, key=[*scene.beams, *scene.contacts].index)
            where = f"from {at_station(scene, state.stage.name, state.station.value)} on, and no"
            if others:
                yield (
                    f"{one} and {others[0]} pass through each other {where} contact names them: add a contact of {one} "
                    f'and {others[0]}, or may_cross = [["{one}", "{others[0]}"]] if they lie in different planes.'
                )
            else:
                yield (
                    f"{one} passes through itself {where} contact permits it: add a contact of the kind beam-self, or "
                    f'may_cross = [["{one}", "{one}"]] if the laps lie in different planes.'
                )


def _overlaps(state: StationState, share: float) -> set[frozenset[str]]:
    """Pairs of beams, or of a beam and a rigid solid, and beams, that overlap with a share of all thicknesses."""
    rows: list[tuple[str, object, float, float, float]] = [
        (name, _solid(state, of), 0.0, 0.0, 0.0)
        for name, of in state.scene.contacts.items()
        if isinstance(of, RigidContact)
    ]
    for name, beam in state.beams.items():
        s, line = beam.fine
        ends = np.stack((line[:-1], line[1:]), axis=1).view(float).reshape(-1, 2, 2)
        thickness = beam.thickness(0.5 * (s[1:] + s[:-1]))
        pieces = zip(np.asarray(shapely.linestrings(ends)), 0.5 * thickness, s[:-1], s[1:], strict=True)
        rows += [(name, *piece) for piece in pieces]
    names, shapes, half, start, end = (np.array(column) for column in zip(*rows, strict=True))
    i, j = shapely.STRtree(shapes).query(shapes, predicate="dwithin", distance=share * (half + half.max()))
    lines = [beam for contact in state.scene.contacts.values() if not contact.thick for beam in contact.beams]
    counted = np.where(np.isin(names[i], lines) | np.isin(names[j], lines), SMALL, share)
    apart = (names[i] < names[j]) | (names[i] == names[j]) & (start[j] - end[i] > LAP * (half[i] + half[j]))
    near = apart & (shapely.distance(shapes[i], shapes[j]) < counted * (half[i] + half[j]))
    return {frozenset(pair) for pair in zip(names[i][near].tolist(), names[j][near].tolist(), strict=True)}
