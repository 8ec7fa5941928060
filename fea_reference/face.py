"""Frictionless penalty contact of a beam with a rigid edge on a body, integrated along the beam's neutral line.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, r    point of the neutral line; r = x − c − X, measured from the body's reference centre
y       R(−φ) r, the point in the frame of the body
d, n    distance of y from the edge and its gradient, rotated with the body;  τ is n turned clockwise
b       second derivative of d along τ
T, g    half of the beam's thickness at ζ, zero for a line; gap d − T
ε       penalty stiffness per unit length of the beam
δ       lead: the gap at which the pressure begins
k ×     a vector turned counter-clockwise
======  =====================================================================================

Energy Π_c = ∫ ½ ε ⟨δ − g⟩² ds over the beam's undeformed arc length. With the relative motion of the point against
the body, δu = δx − δX − δφ k × r,

    δg = n·δu,     δ²g = n·δ²x − 2 δφ n·k × (δx − δX) − n·r δφ² + b (τ·δu)²,

and by ζ alone g' = n·x' − T', g'' = n·x'' + b (τ·x')². The integral runs over the exact intervals with g < δ.
Intervals also end where n jumps, at a corner. There g is continuous, so that the gradient has no additional term. The
place moves with the beam, however, and adds −ε g (Δδg)²/Δg' to the second derivative, Δ being the value before minus
the value behind.

Point contacts: a corner on a beam's side, or a beam's end on the edge, penetrates with the root of its force over ε,
however few the elements. Its penalty follows from the requested penetration, as for pairs of beams. The neutral line
of a thick beam rounds a corner along an arc of half the thickness, too short for the elements.

An end jointed to the edge: the joint fixes the gap there, so that the place does not count. At a pinned end a stop
keeps the section from turning into the edge (:mod:`fea_reference.own_pins`). With shear the neutral line leans from a
held section by γ, into the edge over a length 2γ/κ, where κ lifts the beam off. A contact of width γ/κ beside the
joint, of second order in the thickness, would take over the whole shear force of the joint: with a lever arm near
zero, the distribution between both is indeterminate. Within √(EI/κ_s GA) of a held section, half a thickness, the
section transmits any pressure to the joint. Beside an end on a straight edge, without pressure from axial forces,
that length therefore belongs to the joint and the edge presses beyond. Along a straight edge the moment of a
prismatic beam is constant: contact forces act at the ends of the zone, as a force at the lift-off and as the stop's
moment at the pin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from cprbm_scene.answer import Array, Flags
from cprbm_scene.statement import EdgeContact, Scene
from fea_reference import swept
from fea_reference.element import layer
from fea_reference.hermite import Around, NeutralLine, as_plane, shapes
from fea_reference.model import BodyPart, Model, turned
from fea_reference.outline import Near, Outline
from fea_reference.own_pins import ends_on_edge
from fea_reference.rigid_touch import LAYERS, by_motions, on_bodies, rigid_touch
from fea_reference.state import Complex, State, summed
from fea_reference.swept import ClosestPlaces, cut_by_end, swept_over
from fea_reference.touch import THINNEST, Face, Penalty, Touch, gauss, gauss_places
from fea_reference.zones import SAMPLES_PER_ELEMENT, Gap, Zones, negative, no_zones

_SLENDER = 0.01  # lengths of the longest beam: substitute for the thickness of a beam in contact as a line
_REACH = 2.0  # elements: neighbourhood of a corner
_CROSSING_STEPS = 15
_ARRIVED = 1e-10  # elements
_AT_END = 1e-6  # elements
_BLUNT = 0.5  # sine of half the angle of a tip on which loose penalties hold a beam
_SHARPEST = 1e5
_LOOKED = 4  # Gauss points to determine the direction of a zone's pressure
_ALONG = 0.5  # of a motion: a smaller part across the beam counts as motion along the beam
_FACING = 0.1  # least cosine between the beam's normal and the direction of a tip that presses
_PARTS = 4  # subdivision of an element for the crossing check


def faces(scene: Scene, model: Model, penetration: float) -> tuple[Face, ...]:
    """The scene's contacts of a beam with an edge; ``penetration`` as in the settings."""
    contacts, units = [], model.units
    records = {name: record for name, record in scene.contacts.items() if isinstance(record, EdgeContact)}
    for name, contact, first, body, edge, h, stiffest in on_bodies(model, records, penetration):
        beam = model.beams[first]
        elements = beam.elements.stop - beam.elements.start
        width = max(h, 0.5 * beam.thickness, beam.length / LAYERS)
        outline, own = ends_on_edge(
            scene, contact, units.origin + units.length * model.bodies[body].centre, units.length
        )
        joints = own if outline.straight else {}
        sides = (layer(model.elements, e) for e in (beam.elements.start, beam.elements.stop - 1))
        begins, stops = (
            extent if which in joints else 0.0 for which, extent in zip(("start", "end"), sides, strict=True)
        )
        contacts.append(
            Face(
                name,
                first,
                body,
                outline,
                tuple(float(elements) if end == "end" else 0.0 for end in own),
                (begins, elements - stops),
                edge,
                2.0 * edge.nearest if contact.thick else _SLENDER,
                max(2.0 * edge.nearest, THINNEST) if contact.thick else 1.0,
                sharpness(outline) * beam.softest / width**4,
                stiffest,
            )
        )
    return tuple(contacts)


def sharpness(outline: Outline) -> float:
    """Factor by which the penalty of the sharpest tip has to exceed the penalty of a blunt tip.

    The overlap of a wedge goes with the cube of the sine of half its angle.
    """
    corners = outline.corners
    before, behind = (normals[:, corners.convex] for normals in corners.normals)
    # half of the angle between both sides; their normals turn by the supplement
    sine = np.sqrt(np.maximum(0.5 * (1.0 + (before * behind).sum(axis=0)), 0.0))
    return float(np.clip((_BLUNT / max(float(sine.min(initial=1.0)), 1e-9)) ** 3, 1.0, _SHARPEST))


def zones_of(model: Model, face: Face, z: State) -> Zones:
    """Zones of overlap of the beam with the edge in state ``z``."""
    return model.known.recall(z, ("lead", face, 0.0), lambda: _View(model, face, z).zones())[0]


def passes_through(model: Model, face: Face, before: State, after: State) -> bool:
    """True if the beam passed through the edge on the straight way between two states.

    A point of the beam that crosses from the free side must overlap the edge afterwards.
    """
    chain = face.outline.chain
    views, zones = [_View(model, face, z) for z in (before, after)], [zones_of(model, face, z) for z in (before, after)]
    even = np.arange(_PARTS * views[0].line.n + 1) / _PARTS
    old, new = (view.place(even) for view in views)
    near = face.outline.near(new)
    inside = (near.distance < 0.0) & (near.distance > -face.outline.extent)
    apart = ~np.isin(even, face.own)
    for a, b in zip(chain.T[:-1], chain.T[1:], strict=True):
        along = b - a
        old_side = along[0] * (old[1] - a[1]) - along[1] * (old[0] - a[0])
        new_side = along[0] * (new[1] - a[1]) - along[1] * (new[0] - a[0])
        path = new - old
        from_a, from_b = (path[0] * (at[1] - old[1]) - path[1] * (at[0] - old[0]) for at in (a, b))
        through = (old_side > 0.0) & (new_side < 0.0) & (from_a * from_b < 0.0) & apart & ~inside
        if through.any() and not _slid_along(views, zones, even[through], path[:, through]).all():
            return True
    return _swept_over_tip(face, views, zones)


def _slid_along(views: Sequence[_View], zones: Sequence[Zones], zeta: Array, way: Array) -> Flags:
    """True for places ``zeta`` (k,) that slid along the beam over a pressing tip, between two states.

    ``way`` (2, k) are the paths of the places in the body frame. A tip that presses before and after has penetrated
    the beam: neighbouring places enter on one side and leave on the other.
    """
    tips = [view.tips() for view in views]
    there = [swept.closest_places(view.line, at) for view, (at, _) in zip(views, tips, strict=True)]
    pressed = there[0].found & views[0].pressed_at(there[0], tips[0][1], zones[0])
    pressed &= there[1].found & views[1].pressed_at(there[1], tips[1][1], zones[1])
    low, high = (choose(there[0].zeta, there[1].zeta) for choose in (np.minimum, np.maximum))
    near = (zeta[:, None] > low - 1.0) & (zeta[:, None] < high + 1.0) & pressed
    ahead = views[1].back.conjugate() * (way[0] + 1j * way[1])
    across = np.abs((there[1].n.conj() * ahead[:, None]).real)
    return np.asarray((near & (across < _ALONG * np.abs(ahead)[:, None])).any(axis=1))


def _swept_over_tip(face: Face, views: Sequence[_View], zones: Sequence[Zones]) -> bool:
    """True if the beam passed over a tip between two samples and does not press on the tip any more."""
    (before, after), tips = views, [view.tips() for view in views]
    if tips[0][0].size == 0:
        return False
    if cut_by_end((before.line, tips[0][0]), (after.line, tips[1][0]), face.edge.nearest).any():
        return True
    first, last, over = swept_over((before.line, tips[0][0]), (after.line, tips[1][0]))
    over &= (np.abs(first.zeta - np.reshape(face.own, (-1, 1))) > 1.0).all(axis=0)
    over &= last.distance_along(tips[1][1]) < 0.0
    if not over.any():
        return False
    # a point of a flank that runs across the beam is no tip, however deep the point lies below the beam
    facing = np.abs(np.cos(np.angle(first.n.conj() * tips[0][1]))) > _FACING
    over &= (first.d * last.d <= 0.0) | (facing & before.pressed_at(first, tips[0][1], zones[0]))
    return bool((over & ~after.pressed_at(last, tips[1][1], zones[1])).any())


def tip_depth(model: Model, face: Face, z: State) -> float:
    """Largest depth of a pressing tip in the beam; on a slender tip a small overlap means a deep cut."""
    view = _View(model, face, z)
    tips, out = view.tips()
    if tips.size == 0:
        return 0.0
    there = swept.closest_places(view.line, tips)
    depth = face.edge.at(there.zeta) - there.distance_along(out)
    deep = there.found & (depth > 0.0)
    deep &= (np.abs(there.zeta - np.reshape(face.own, (-1, 1))) > 1.0).all(axis=0)
    if not deep.any():
        return 0.0
    return float(depth[deep & view.pressed_at(there, out, zones_of(model, face, z))].max(initial=0.0))


def edge_distances(model: Model, face: Face, z: State, zeta: Array) -> Near:
    """Distance data of the edge at places ``zeta`` (k,) of the beam, with current normals."""
    view = _View(model, face, z)
    near = face.outline.near(view.place(zeta))
    return Near(near.distance, view.turned(near.normal), near.bend, near.corner)


def corners_of(model: Model, face: Face, z: State) -> Complex:
    """Positions (c,) of the edge's corners in state ``z``, as complex numbers."""
    body, points = model.bodies[face.body], face.outline.corners.points
    X, Y, phi = model.body_state(body, z)
    return np.asarray(complex(*body.centre) + complex(X, Y) + np.exp(1j * phi) * (points[0] + 1j * points[1]))


def touch(model: Model, face: Face, penalty: Penalty, quadrature: int, z: State) -> Touch:
    """Contact energy derivatives in state ``z``, with ``quadrature`` Gauss points per interval."""
    view = _View(model, face, z)
    ahead, kinks = model.known.recall(z, ("lead", face, penalty.lead), lambda: view.zones(penalty.lead))
    zones = replace(ahead, least=ahead.least + penalty.lead)
    places = gauss_places(zones, view.line, quadrature)
    y, rest = view.place_and_rest(places[1])
    near = face.outline.near(y)
    # the contact force needs the unrounded gap; for the interval ends rounded points suffice
    g = face.outline.exact_distance(y, rest, near) - face.edge.at(places[0])
    surface = g, view.turned(near.normal), near.bend, near.distance
    contact = rigid_touch(model, face, penalty, quadrature, z, zones, places, surface)
    ends = np.isin(zones.intervals, [end for end in (0.0, float(view.line.n)) if end not in face.own])
    # numbers and ends of the intervals that meet the next interval at a corner
    begins, ends_of_intervals = zones.intervals.T
    bends = [(i, float(end)) for i, end in enumerate(ends_of_intervals) if float(end) in kinks and end in begins]
    sharp = bool(ends.any()) or bool(bends) or bool(near.corner.any())
    corners = partial(_corner_terms, view, zones, bends, kinks, penalty, quadrature) if bends else None
    return replace(contact, extra_hessian=corners, sharp=sharp)


def _corner_terms(
    view: _View,
    zones: Zones,
    bends: list[tuple[int, float]],
    kinks: dict[float, np.int64],
    penalty: Penalty,
    quadrature: int,
) -> Array:
    """Second-derivative terms (m, m, k) of the moving places at corners."""
    size = 10 if view.moves else 7
    terms = np.zeros((size, size, len(zones.intervals) * quadrature))
    for i, end in bends:
        # the element that contains the interval: at a node the next interval has the same term
        e = np.array([min(int(zones.intervals[i].mean()), view.line.n - 1)])
        xi = np.array([end]) - e
        corner = kinks[end]
        normals = [side[:, corner] for side in view.face.outline.corners.normals]
        x, x1, _ = view.line.at(np.array([end]))
        steeper = [float((view.turned(n[:, None])[:, 0] * x1[:, 0]).sum()) for n in normals]
        # at a convex corner d is the larger of both distances behind the corner, else the smaller
        first = int(np.argmin(steeper) if view.face.outline.corners.convex[corner] else np.argmax(steeper))
        before, behind = normals[first], normals[1 - first]
        difference = view.turned((before - behind)[:, None])
        slope = steeper[first] - steeper[1 - first]
        gap = float(view.gap(np.array([end]))[0]) - penalty.lead
        by = by_motions(difference, shapes(xi), view.line, e, x - view.centre[:, None], moves=view.moves)[:, 0]
        terms[:, :, (i + 1) * quadrature - 1] = (
            -penalty.stiffness * gap / slope * float(view.line.lengths[e[0]]) * np.outer(by, by)
        )
    return terms


class _View:
    """A beam in front of an edge: places in the frame of the edge's body."""

    def __init__(self, model: Model, face: Face, z: State) -> None:
        self.face = face
        self.line: NeutralLine = model.line(model.beams[face.first], z)
        body: BodyPart = model.bodies[face.body]
        self.moves = body.dofs is not None
        X, Y, self.phi = model.body_state(body, z)
        self.centre = body.centre + np.array([X, Y])
        rest = np.zeros(2) if body.dofs is None else z.rest[body.dofs[:2]]
        q, error = summed(self.line.nodes, -complex(*self.centre) * np.ones_like(self.line.nodes))
        self.back = complex(np.cos(self.phi), -np.sin(self.phi))
        q, error = summed(q, error + self.line.rests - complex(*rest))
        self.nodes, self.rests = self.back * q, self.back * error  # all digits kept for a body without rotation

    def place(self, zeta: Array) -> Array:
        """Points y (2, k)."""
        return as_plane(self._place(self.line.around(zeta)))

    def place_and_rest(self, there: Around) -> tuple[Array, Array]:
        """Points y (2, k) and their round-off."""
        value, error = summed(self.nodes[there.element], self.back * there.way)
        return as_plane(value), as_plane(error + self.rests[there.element])

    def _place(self, there: Around) -> Complex:
        """Points y (k,) as complex numbers."""
        return np.asarray(self.nodes[there.element] + self.back * there.way)

    def turned(self, vectors: Array) -> Array:
        """Vectors (2, k) of the body's frame in current orientation."""
        return turned(vectors, self.phi)

    def gap(self, zeta: Array) -> Array:
        """Gap g (k,)."""
        return np.asarray(self.face.outline.near(self.place(zeta)).distance - self.face.edge.at(zeta))

    def tips(self) -> tuple[Complex, Complex]:
        """Current positions of tips and mean directions of their contact force, (t,) both, as complex numbers."""
        points, out = (vectors[0] + 1j * vectors[1] for vectors in self.face.outline.tips)
        return complex(*self.centre) + self.back.conjugate() * points, self.back.conjugate() * out

    def pressed_at(self, there: ClosestPlaces, out: Complex, zones: Zones) -> Flags:
        """True if the contact pushes the beam away from tips (t,), of current direction ``out``, within an element.

        ``zones`` are the zones of overlap.
        """
        pressed = np.zeros(out.size, dtype=bool)
        if not len(zones.intervals):
            return pressed
        places, weights = gauss(_LOOKED)
        width = zones.intervals[:, 1:] - zones.intervals[:, :1]
        zeta = (zones.intervals.mean(axis=1)[:, None] + 0.5 * width * places).ravel()
        near = self.face.outline.near(self.place(zeta))
        overlap = np.maximum(self.face.edge.at(zeta) - near.distance, 0.0) * (width * weights).ravel()
        n = self.turned(near.normal)
        pushes = overlap * (n[0] + 1j * n[1])
        for i, (at, normal) in enumerate(zip(there.zeta, there.normal_along(out), strict=True)):
            pressed[i] = (normal.conjugate() * pushes[np.abs(zeta - at) < 1.0].sum()).real > 0.0
        return pressed

    def zones(self, lead: float = 0.0) -> tuple[Zones, dict[float, np.int64]]:
        """Intervals with a gap below ``lead``, and the corners of the interval ends where n jumps.

        The least gap of the zones is reduced by ``lead``.
        """
        face, line = self.face, self.line

        def at(zeta: Array, none_m: Array) -> Gap:
            there = self._at(zeta, none_m)
            return there._replace(g=there.g - lead) if lead else there

        zeta = np.arange(SAMPLES_PER_ELEMENT * line.n + 1) / SAMPLES_PER_ELEMENT
        borders, kinks = self._borders(zeta)
        others = (*face.edge.inner, *borders.tolist())
        if others or face.within != (0.0, line.n):
            zeta = np.unique(np.concatenate([zeta, others, face.within]))
            zeta = zeta[(zeta >= face.within[0]) & (zeta <= face.within[1])]
        there = at(zeta, np.zeros_like(zeta))
        own = tuple(end for end in face.own if end in face.within)
        for end in own:
            # a joint makes the gap zero there, with a random nearest point: continue the values beside
            here, beside = (0, 1) if end == 0.0 else (-1, -2)
            there.g[here], there.slope[here], there.curvature[here] = (
                0.0,
                there.slope[beside],
                there.curvature[beside],
            )
        if not there.found.any():
            return no_zones(float(np.abs(there.g).min())), {}
        neighbours = there.found[:-1] & there.found[1:]
        if not there.found.all():
            keep = there.found
            neighbours = np.diff(np.flatnonzero(keep)) == 1
            zeta = zeta[keep]
            there = Gap(there.g[keep], there.slope[keep], there.curvature[keep], there.zeta_m[keep], keep[keep])
        floor = float(np.finfo(float).eps) * line.longest
        return negative(at, zeta, there, neighbours, others, own, floor), kinks

    def _at(self, zeta: Array, none_m: Array) -> Gap:
        face = self.face
        there = self.line.around(zeta)
        near = face.outline.near(as_plane(self._place(there)))
        # of a product with the rotated conjugate normal, the real part is n·v and the imaginary part −τ·v
        back = (near.normal[0] - 1j * near.normal[1]) * self.back
        ahead = back * there.ahead
        g, slope = near.distance - face.edge.nearest, ahead.real
        if face.edge.varies:
            g, slope = near.distance - face.edge.at(zeta), slope - face.edge.slope(zeta)
        return Gap(
            g,
            slope,
            (back * there.bent).real + near.bend * ahead.imag**2,
            none_m,
            near.distance > -face.outline.extent,
        )

    def _borders(self, even: Array) -> tuple[Array, dict[float, np.int64]]:
        """Places where n or b jumps, and the corners of the places where n jumps."""
        corners = self.face.outline.corners
        if corners.points.shape[1] == 0:
            return np.empty(0), {}
        y = self._place(self.line.around(even))
        apart = np.abs(y - (corners.points[0] + 1j * corners.points[1])[:, None])
        reach = 2.0 * max(self.face.edge.half) + _REACH * self.line.longest
        near = np.flatnonzero(apart.min(axis=1) < reach)
        if near.size == 0:
            return np.empty(0), {}
        start = even[apart[near].argmin(axis=1)]
        P = corners.points[:, near]
        across = (corners.bisectors, *corners.tangents)
        t = np.concatenate([tangents[:, near] for tangents in across], axis=1)
        every, crosses = self._crossing(np.concatenate([P] * 3, axis=1), t, np.concatenate([start] * 3))
        zeta, through = every[: near.size], crosses[: near.size]
        d = self.face.outline.near(self.place(zeta)).distance
        jumps = np.logical_and(through, corners.turn[near] * d > 0.0)
        return every[crosses], dict(zip(zeta[jumps].tolist(), near[jumps], strict=True))

    def _crossing(self, P: Array, t: Array, start: Array) -> tuple[Array, Array]:
        """Places (c,) where the line crosses the normals at P to t (2, c), starting at ``start`` (c,)."""
        zeta, step = start.copy(), np.zeros_like(start)
        at, along_t = P[0] + 1j * P[1], t[0] - 1j * t[1]
        for _ in range(_CROSSING_STEPS):
            there = self.line.around(zeta)
            ahead = (there.ahead * self.back * along_t).real
            off = ((self._place(there) - at) * along_t).real
            step = np.minimum(np.maximum(off / np.where(ahead == 0.0, 1.0, ahead), -1.0), 1.0)
            moved = np.minimum(np.maximum(zeta - step, 0.0), self.line.n)
            zeta, step = moved, zeta - moved
            if np.maximum.reduce(np.abs(step)) < _ARRIVED:
                break
        crosses = np.abs(((self._place(self.line.around(zeta)) - at) * along_t).real) < _ARRIVED
        for end in self.face.own:
            crosses &= np.abs(zeta - end) > _AT_END
        crosses &= (zeta >= self.face.within[0]) & (zeta <= self.face.within[1])
        return zeta, crosses
