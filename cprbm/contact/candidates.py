"""Places of contact: joints, ends, and the rules for their use; the places and the closed set of a state.

Fixed places are the joints and ends of the first curve, and the ends of a second beam.  Corners of a second curve are
point contacts that stay at the corners, with the feet on the beam.

* An end of a beam is no place on the body to which a joint holds the end, nor on an edge along which this body slides.
* The first joint behind a weld on the body of the foot has the force of the second joint.  The share of clamp and
  contact is not unique there; a row for the sum of both gaps keeps the pressure even.
* A place may move everywhere but in an end link held by the body of the foot.  In such a link a corner is no place.

The side of two beams is the side at the least distance as drawn.  In self-contact a place lies before the foot, so
that no gap counts twice; only the beam's end is a place as well.

The formulation ``paper`` measures the gap of two beams by a fitted boundary (:mod:`cprbm.paper`), a law of its own.
The places of such a contact are places like others; the law writes their gaps and the border columns.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from cprbm.chain import Direction, Mechanism, unit_direction
from cprbm.contact.curve import Curve, CurveArrays, curve_arrays
from cprbm.contact.fixed import FREE, Sites, is_on_end_body, is_straight, places_at_feet
from cprbm.contact.gap import Law, Places, gap_frame
from cprbm.contact.pairs import Pair, contact_pairs
from cprbm.contact.settling import new_counters, settle
from cprbm_scene import BeamContact, FreeEnd, Scene, WeldedEnd
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.clearance import JOINED, ranges_apart
from cprbm_scene.freedoms import FREEDOMS, Freedoms
from cprbm_scene.statement import Body, SlidingBody

LEANING = 0.1
"""Gap beside a weld, over the layers of the sections there, that a lean could close: no material bears such a shear."""

TOUCHING = 1e-9
"""Gap, over the longest beam, below which curves touch: round-off of a scene's coordinates."""


@dataclass(frozen=True, eq=False)
class Geometry:
    """Curves and pairs of a mechanism's contacts.

    Attributes:
        curves, pairs, arrays, sites: as the modules of the package say.
        law: measures the gaps of some pairs; None without such pairs.
        joints_alone: whether the places are joints alone: no place moves or shares a force.
    """

    curves: list[Curve]
    pairs: list[Pair]
    arrays: CurveArrays
    sites: Sites
    law: Law | None = None
    joints_alone: bool = False

    @cached_property
    def points(self) -> Ints:
        """Points that no beam sweeps over: circles, corners, and ends of other beams.

        The rows (points, 4) are curve, beam, piece, and 1 for the piece's end.
        """
        first, last, found = self.arrays.first, self.arrays.last, list[tuple[int, ...]]()
        for pair in self.pairs:
            if self.sites.rigid[pair.second]:
                circle = [pair.second] if self.arrays.is_point[pair.second] else []
                found += [(k, pair.first, first[k], 0) for k in circle + [corner.curve for corner in pair.corners]]
            elif not pair.itself:
                for k, beam in ((pair.first, pair.second), (pair.second, pair.first)):
                    found += [(k, beam, first[k], 0), (k, beam, last[k], 1)]
        return np.array(found, dtype=np.int64).reshape(-1, 4)

    @cached_property
    def has_corners(self) -> bool:
        """True if corners of rigid curves are places."""
        return bool(on_edge(self.arrays, self.sites.possible).any())


def contact_geometry(m: Mechanism) -> Geometry:
    """Geometry of a mechanism's contacts.

    Adds the nodes of rigid curves and the rows of beams pinned on their edge to the mechanism.
    """
    curves, pairs = contact_pairs(m)
    arrays = curve_arrays(curves)
    sites = _sites(m, curves, pairs, arrays)
    possible, outside = sites.possible, np.ones(len(sites.possible.pair), dtype=bool)
    arcs = arrays.arc[possible.piece] + possible.xi * arrays.span[possible.piece]
    for number, pair in enumerate(pairs):
        if isinstance(contact := m.scene.contacts[pair.name], BeamContact):
            beams = [m.scene.beams[beam] for beam in contact.between]
            # beside a shared end the beams are one body, without a contact
            ranges = ranges_apart(m.scene, beams, 0.5 * JOINED * contact.thick * sum(beam.thickest for beam in beams))
            for k, span in zip((pair.first, pair.second), ranges, strict=True):
                within = np.clip(arcs, *np.multiply(m.chains[curves[k].beam].length, span)) == arcs
                outside &= within | (possible.pair != number) | (possible.curve != k)
    return Geometry(curves, pairs, arrays, sites._replace(possible=taken(possible, outside)))


def hold_sections_upright(m: Mechanism, geometry: Geometry) -> None:
    """Keep the sections upright at welds beside touching beams, and on touching curved bodies: a theory of shear."""
    arrays, sites, found, z = geometry.arrays, geometry.sites, set[tuple[str, int]](), np.array(m.rest)
    contacts = open_contacts(geometry, z)
    pairs, curves = np.ones(len(geometry.pairs), dtype=bool), np.ones(len(geometry.curves), dtype=bool)
    places = places_at_feet(z, arrays, sites, contacts.sides, pairs, curves, contacts.counters)
    for k, gap in enumerate(replace(contacts, places=places).gaps(geometry, z)):
        curve, other = places.curve[k], places.other[k]
        for end, node in enumerate((arrays.first[curve], arrays.last[curve] + 1)):
            at_weld = sites.welded[curve, end] and places.piece[k] + places.xi[k] == node
            if not at_weld or is_straight(arrays, places.foot[k]) or not is_on_end_body(arrays, sites, places, k, end):
                continue
            beam, layer = geometry.curves[curve].beam, m.chains[geometry.curves[curve].beam].layer(end)
            if not sites.rigid[other]:
                layer += m.chains[geometry.curves[other].beam].layer(
                    int(sites.body[other, 0] != sites.body[curve, end])
                )
            if abs(gap) < LEANING * layer:
                found.add((beam, end))
    for beam, end in found:
        m.chains[beam] = m.chains[beam].with_upright_section(end)


def taken(places: Places, which: Flags | Ints) -> Places:
    """A selection of places, as copies."""
    return Places._make(column[which] for column in places)


def copied(places: Places) -> Places:
    """All places, as copies."""
    return Places._make(column.copy() for column in places)


def fixed_places(
    geometry: Geometry, z: Array, sides: Array, near: Flags, counters: Ints, *, welds: bool = False
) -> Places:
    """Fixed places of the pairs marked ``near`` (pairs,), at the nearest feet.

    Args:
        geometry: of the mechanism.
        z: the unknowns.
        sides: side of the first curve over the second and of the second over the first (pairs, 2); 0 for a beam itself.
        near: pairs that may touch.
        counters: count the searches.
        welds: whether ends at a weld on the rigid body of the foot are places.
    """
    return places_at_feet(z, geometry.arrays, geometry.sites, sides, near, geometry.sites.rigid & welds, counters)


def on_edge(arrays: CurveArrays, places: Places) -> Flags:
    """Whether the places lie on a rigid curve, with the feet on a beam."""
    return np.asarray(arrays.angle[places.piece] < 0)


def half_thicknesses(arrays: CurveArrays, places: Places) -> Array:
    """Half thickness at the places plus half thickness at the feet."""
    at_place = arrays.thickness[places.piece] + places.xi * arrays.thickening[places.piece]
    return np.asarray(at_place + arrays.thickness[places.foot] + places.eta * arrays.thickening[places.foot])


def sides_at_rest(geometry: Geometry, z: Array, counters: Ints) -> Array:
    """Sides (pairs, 2) of a state as drawn: of rigid curves by the scene, of two beams at the least distance.

    Parallel beams lie left and right of each other, antiparallel beams both left or both right.  A point on the other
    beam's neutral line has no side.
    """
    sides = np.array([(pair.side, pair.side) for pair in geometry.pairs], dtype=float).reshape(-1, 2)
    unknown = np.array([pair.side == 0 and not pair.itself for pair in geometry.pairs], dtype=bool)
    if not unknown.any():
        return sides
    places = fixed_places(geometry, z, np.ones(sides.shape), unknown, counters)
    gaps, curvatures = np.empty(len(places.pair)), np.empty(len(places.pair))
    settle(z, geometry.arrays, places, gaps, curvatures, counters, 0)
    arrays = geometry.arrays
    signed = np.where(places.at_point, np.inf, gaps + half_thicknesses(arrays, places))
    for number in np.flatnonzero(unknown):
        distance = np.where((places.pair == number) & (np.abs(signed) > TOUCHING), np.abs(signed), np.inf)
        if distance.min(initial=np.inf) == np.inf:
            sides[number] = 1.0
            continue
        best = int(np.argmin(distance))
        along = gap_frame(z, arrays, places, best).along
        role = int(places.curve[best] != geometry.sites.columns[number, 0])
        side = 1.0 if signed[best] >= 0.0 else -1.0
        sides[number, role], sides[number, 1 - role] = side, -side if along > 0.0 else side
    return sides


@dataclass(frozen=True, eq=False)
class Contacts:
    """Possible places of contact, marks of the closed places, sides of the pairs and of corners' curves, counters.

    ``given_up`` holds pairs and pieces at which a moving place failed; the pairs ``kept_open`` stay open.
    """

    places: Places
    closed: Flags
    sides: Array
    corner_sides: Array
    counters: Ints
    given_up: frozenset[tuple[int, int]] = frozenset()
    kept_open: frozenset[int] = frozenset()

    def of_pairs(self, pairs: frozenset[int]) -> Flags:
        """Places of some pairs."""
        return np.asarray((self.places.pair[:, None] == np.array(sorted(pairs), dtype=np.int64)).any(axis=1))

    def pressing(self, pair: int) -> Flags:
        """Closed places of a pair."""
        return np.asarray(self.closed & (self.places.pair == pair))

    def gaps(self, geometry: Geometry, z: Array) -> Array:
        """Gaps of all places at a state, the feet moved; the present feet stay."""
        return self.settled(geometry, z)[1]

    def settled(self, geometry: Geometry, z: Array) -> tuple[Places, Array, Array]:
        """All places at a state with moved feet, their gaps, and the gaps' curvatures."""
        places, (gaps, curvatures) = copied(self.places), np.empty((2, len(self.places.pair)))
        settle(z, geometry.arrays, places, gaps, curvatures, self.counters, 0)
        if geometry.law is not None:
            geometry.law.write_gaps(z, places, gaps)
        return places, gaps, curvatures


def touching_as_drawn(geometry: Geometry, z: Array, contacts: Contacts) -> frozenset[int]:
    """Pairs that touch in a state as drawn, at a weld on the rigid body of the foot too."""
    places = fixed_places(
        geometry, z, contacts.sides, np.ones(len(geometry.pairs), dtype=bool), contacts.counters, welds=True
    )
    gaps = replace(contacts, places=places).gaps(geometry, z)
    # a weld behind the end of the other beam is on neither side of the beam
    deepest = -TOUCHING - half_thicknesses(geometry.arrays, places)
    return frozenset(places.pair[(gaps > deepest) & (gaps < TOUCHING)].tolist())


def open_contacts(geometry: Geometry, z: Array) -> Contacts:
    """Contacts of a state as drawn, without any place."""
    counters = new_counters()
    nothing = taken(geometry.sites.possible, np.zeros(0, dtype=np.int64))
    sides = sides_at_rest(geometry, z, counters), np.zeros(len(geometry.curves))
    return Contacts(nothing, np.zeros(0, dtype=bool), *sides, counters)


def _sites(m: Mechanism, curves: list[Curve], pairs: list[Pair], arrays: CurveArrays) -> Sites:
    """Fixed places and bodies, numbered in the scene's order; all bodies at rest have the number of the first."""
    still = _bodies_at_rest(m.scene)
    order = list(m.scene.bodies)
    number = {name: order.index(still[0] if name in still else name) for name in order}
    slides = {name: _slide(body, at_rest=name in still) for name, body in m.scene.bodies.items()}
    slide = np.full((len(curves), 2, 2), np.nan)
    body = np.full((len(curves), 2), FREE, dtype=np.int64)
    welded = np.zeros((len(curves), 2), dtype=bool)
    for k, curve in enumerate(curves):
        if not curve.beam:
            body[k], slide[k] = number[curve.body], slides[curve.body]
            continue
        beam = m.scene.beams[curve.beam]
        for side, joint in enumerate((beam.start, beam.end)):
            if not isinstance(joint, FreeEnd):
                name = m.scene.body_of(joint.point)
                body[k, side], slide[k, side] = number[name], slides[name]
                welded[k, side] = isinstance(joint, WeldedEnd)
    rigid = np.array([not curve.beam for curve in curves], dtype=bool)
    columns = np.array([(pair.first, pair.second) for pair in pairs], dtype=np.int64).reshape(-1, 2)
    return Sites(_possible(arrays, rigid, pairs), columns, body, slide, rigid, welded, welded)


def _slide(body: Body, *, at_rest: bool) -> Direction:
    """Direction in which a body slides; zero at rest, NaN for every other motion."""
    if at_rest:
        return 0.0, 0.0
    return unit_direction(body.along) if isinstance(body, SlidingBody) and body.pin is None else (np.nan, np.nan)


def _bodies_at_rest(scene: Scene) -> list[str]:
    """Fixed bodies, and bodies with all motions held by drives that no stage steps."""
    freedoms, stepped = Freedoms(scene), {stage.steps for stage in scene.stages}
    held = [
        freedoms.owner(drive)
        for name, drive in scene.drives.items()
        if name not in stepped and scene.holds(drive, scene.stages[0].name)
    ]
    return [name for name in scene.bodies if len(freedoms.guide(name)) + held.count(name) >= FREEDOMS]


def _possible(arrays: CurveArrays, rigid: Flags, pairs: list[Pair]) -> Places:
    """All fixed places of all pairs, with the first piece of the other curve for a foot."""
    rows, pieces = [], arrays.last - arrays.first + 1
    for number, pair in enumerate(pairs):
        rows += [(number, pair.first, pair.second, node) for node in range(pieces[pair.first] + 1)]
        rows += [(number, corner.curve, pair.first, 0) for corner in pair.corners]
        if not pair.itself and not rigid[pair.second]:
            rows += [(number, pair.second, pair.first, node) for node in (0, int(pieces[pair.second]))]
    return places_at(arrays, np.array(rows, dtype=np.int64).reshape(-1, 4))


def places_at(arrays: CurveArrays, rows: Ints) -> Places:
    """Places at nodes, with the first piece of the other curve for a foot.

    ``rows`` (k, 4) are the numbers of the pair, of both curves and of the node.
    """
    pair, curve, other, node = rows.T
    at_end, zeros = node > arrays.last[curve] - arrays.first[curve], np.zeros(len(node))
    return Places(
        pair=pair,
        curve=curve,
        piece=arrays.first[curve] + node - at_end,
        xi=at_end.astype(float),
        other=other,
        foot=arrays.first[other].copy(),
        eta=zeros.copy(),
        at_point=np.zeros(len(node), dtype=bool),
        side=zeros.copy(),
        moves=arrays.angle[arrays.first[curve]] < 0,
        shares=np.zeros(len(node), dtype=np.int64),
        force=zeros,
    )
