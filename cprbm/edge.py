"""Contact of a beam with a rigid edge, fixed to the ground or to a body that moves: the formulation ``auto``.

==========  ===================================================================================
C           smooth neutral line of the beam, :mod:`cprbm.smooth`; ψ its tangent angle
m, φ        a place of the edge, and its body's rotation; zero for the ground
r           C − m
n, τ, k     normal, tangent and bend of the piece as C sees it, :mod:`cprbm.faces`, turned with the body
T           t/2, half the thickness at s, zero for a line
D           distance from the piece less T − T₀, what the beam is thicker at s than 2 T₀ where it is thinnest;
            constraint c = T₀ − D ≤ 0
J           turns by a right angle, counter-clockwise
z           local numbers of the beam (5), and m (2) and φ where the body moves
v_z         how C moves against the body: C_z for the beam, −I for m, −J r for φ
==========  ===================================================================================

Rows stand as for a circle (:mod:`cprbm.circle`): where D has a minimum with a place of its own (:mod:`cprbm.wells`),
at every joint that is close but not beside such a minimum, and where zones end on this mesh; each for the piece that
it is next to.  At a minimum s moves with it, D_s = 0:

    D_z = n·v_z,    D_zz = n·C_zz + k (τ·v_z)(τ·v_z)ᵀ + E − D_zs D_sz / D_ss        (last term only where s moves)
    E: J n·C_z and −J n between φ and the beam, φ and m; −n·r at φ
    D_s = n·C_s − T_s,    D_sz = n·C_sz + k (τ·C_s)(τ·v_z) + (J n·C_s at φ),    D_ss = n·C_ss + k (τ·C_s)²

A beam that is pinned to the edge's own body on the edge, or to a body that is itself pinned there, is in touch at its
end whatever happens (:mod:`cprbm.own_pins`).  There the edge holds the direction in which the beam leaves: a stop
(:mod:`cprbm.stops`), whose moment is what the pressure over a length that goes to nothing comes to.  The end is no row
then, nor is the first spring: where the first link lies along the edge, so does that.

What is rigid goes straight back from where the edge ends: its sides (:func:`cprbm.faces.sides_of`) are pieces like the
others, so that a beam that passes beyond an end and comes back behind it meets the side, and is nowhere behind what it
has passed.

A corner that stands out has one row where the beam is closest to it, at a place of its own always, whose normal is
between those of its pieces (:mod:`cprbm.corner`), or beyond them by no more than one element bends: a beam that lies on
a piece from the corner on dips behind it next to the corner by as much, and is held by the corner and by joints there
at once.  If the corner had a row only without that dip, and joints only without the corner, each would bring the other.
"""

from __future__ import annotations

import cmath
from dataclasses import dataclass, replace

import numpy as np

from cprbm import smooth, wells
from cprbm.brought import Brought, brought
from cprbm.contact import Blocks, Group
from cprbm.corner import Corner, corners_of
from cprbm.faces import SAME, Face, Seen, Straight, faces_of, sides_of
from cprbm.kinematics import Positions, State, positions, rest_state
from cprbm.kinks import missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.moving import moving, position_curvature, position_slopes, tangent_slopes
from cprbm.outset import anchor
from cprbm.own_pins import ON_IT as PIN_ON_IT
from cprbm.own_pins import own_pins
from cprbm.pairs import THINNEST, Pressed
from cprbm.standing import Attachment
from cprbm.stops import AngleStop
from scene import EdgeContact, Scene
from scene.answer import Array, Flags

# local numbers (x, y, θθθ, m, φ) to (x of joints, y of joints, θθθ φ)
ALONE, WITH_BODY = np.arange(5), np.array([0, 5, 1, 6, 2, 3, 4, 7])
CLOSE = 1e-13  # units of length: a step that is nothing
LEAST_CURVATURE = 1e-6  # of D, 1/ℓ, below which its minimum has no place of its own
REACH = 0.1  # minima of D farther than this part of the longest beam are no constraints yet
ON_IT = 1e-9  # gap and slope of a clamped end that is in touch with the edge
ARCHING = 0.2  # of what the largest force bends one element by: where a zone ends within one it arches by less
JOINT_REACH = 2.0  # joints farther than this many h²·(κ + 1/ℓ) are none
FLAT = 0.01  # of D″ times the length squared, as for zones
FACING = 1e-9  # by which a normal may miss those of the corner that it is of
NEAREST = 1e-9  # of ℓ: pieces whose distances differ by less are equally near


@dataclass(frozen=True, slots=True)
class Frame:
    """Where an edge's body is: m (2,), and φ."""

    m: Array
    phi: float

    def inwards(self, places: Array) -> Array:
        """Places (k, 2) as the body sees them."""
        return self.turned(places - self.m, -self.phi)

    def outwards(self, places: Array) -> Array:
        """Places (k, 2) on the body as they are."""
        return self.m + self.turned(places, self.phi)

    @staticmethod
    def turned(vectors: Array, angle: float) -> Array:
        """Vectors (k, 2) turned counter-clockwise."""
        cos, sin = np.cos(angle), np.sin(angle)
        return np.asarray(vectors @ np.array([[cos, sin], [-sin, cos]]))


@dataclass(frozen=True, slots=True)
class Edge:
    """A beam and a rigid edge.

    Attributes:
        name: of the contact.
        a: the beam's chain.
        body: that the edge is fixed to, −1 for the ground; ``mark`` the number of m among the joints, and ``turning``
            that of φ among the unknowns, if that is a body that moves.
        pieces: its own; ``faces`` are these, and where it has ends the sides of what is rigid behind it.
        tips: where faces begin and end (k, 2): nothing is deeper behind the edge than it is far from the nearest.
        corners: between the faces, but for those at which the beam is pinned.
        offset: T₀, zero for a line; units of length.
        unit_length: ℓ, m.
        drawn: m at rest.
        ends_at_rest: the beam's start and end, as they are drawn.
        held: whether the beam's start and end cannot move against the edge's body.
        pins: stops where these are pinned on the edge.
        ruled: whether the first and the last link cannot move either, or lie along the edge where it presses them.
        clamped: whether the start and the end are clamped in touch with the edge and along it.
        brought: of those ends that drives may bring there.
        ends: arc lengths at which zones end on this mesh, where element borders are; rows stand there too.
        own_places: whether minima of D have rows of their own.
        kinks: of the beam where the contact is in points.
    """

    name: str
    a: Chain
    body: int
    mark: int
    turning: int
    pieces: tuple[Face, ...]
    faces: tuple[Face, ...]
    tips: Array
    corners: tuple[Corner, ...]
    offset: float
    unit_length: float
    drawn: tuple[float, float]
    ends_at_rest: smooth.Points
    held: tuple[bool, bool]
    pins: tuple[AngleStop | None, AngleStop | None]
    ruled: tuple[bool, bool]
    clamped: tuple[bool, bool] = (False, False)
    brought: tuple[Brought | None, Brought | None] = (None, None)
    ends: tuple[float, ...] = ()
    own_places: bool = True
    kinks: Kinks = NO_KINKS

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The beam."""
        return (self.a,)

    def brought_to(self, state: State) -> Edge:
        """The same with those ends held that drives have brought in touch with it."""
        if self.brought == (None, None):
            return self
        held, ruled, clamped = list(self.held), list(self.ruled), list(self.clamped)
        for k, end in enumerate(self.brought):
            if end is not None:
                turn, shift = end.seen(state.bodies)
                at = turn * complex(*self.drawn) + shift
                frame = Frame(np.array((at.real, at.imag)), cmath.phase(turn))
                held[k], along = self._in_touch(frame)[k]
                ruled[k] = held[k] and end.end.welded
                clamped[k] = along and end.end.welded
        return replace(self, held=(held[0], held[1]), ruled=(ruled[0], ruled[1]), clamped=(clamped[0], clamped[1]))

    @property
    def arching(self) -> float:
        """By how much a zone arches at most, of what the largest force can bend one element by."""
        return ARCHING

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the thickness, if it is not very thin, for a line the longest beam; units of
        length.
        """
        return max(2.0 * self.offset, THINNEST) if self.offset > 0.0 else 1.0

    def line(self, state: State, at: Positions) -> smooth.SmoothLine:
        """The beam's smooth line in a state."""
        return smooth.smooth_line(self.a, self.unit_length, state, at)

    def frame(self, state: State, at: Positions) -> Frame:
        """Where the edge is in a state."""
        if self.body < 0:
            return Frame(np.zeros(2), 0.0)
        return Frame(np.array([at.x[self.mark], at.y[self.mark]]), float(state.bodies[self.body, 2]))

    def _half(self, s: Array) -> Array:
        """T at arc lengths ``s``."""
        return 0.5 * self.a.section.thickness_at(s) if self.offset > 0.0 else np.zeros_like(s)

    def _widening(self, s: Array) -> Array:
        """T_s at arc lengths ``s``."""
        return 0.5 * self.a.section.thinning_at(s) if self.offset > 0.0 else np.zeros_like(s)

    def _seen(self, face: Face | Corner, A: smooth.Points, frame: Frame) -> Seen:
        """A piece from points of the beam, with D in the place of the distance and n as it is turned."""
        return self._of(face.seen(frame.inwards(np.stack((A.x, A.y), axis=1))), A, frame)

    def _of(self, seen: Seen, A: smooth.Points, frame: Frame) -> Seen:
        """The same of a piece that is ``seen`` as the body sees points of the beam."""
        return replace(
            seen,
            distance=seen.distance - (self._half(A.s) - self.offset),
            normal=frame.turned(seen.normal, frame.phi),
        )

    def next_to(self, face: Face, q: Array) -> Flags:
        """Which places ``q`` (k, 2), as the body sees them, face a piece: before it, or behind it and none nearer."""
        if isinstance(face, Straight) and not np.any(beside := face.within(q)):
            return beside
        return self._facing(face, q, face.seen(q))

    def _facing(self, face: Face, q: Array, mine: Seen) -> Flags:
        """The same of a piece that has been seen from ``q``."""
        facing = mine.within & (mine.distance >= 0.0)
        if np.all(facing == mine.within):  # there is none behind it
            return np.asarray(facing)
        nearest = mine.within.copy()
        for other in self.faces:
            if other is not face:
                seen = other.seen(q)
                nearest &= ~seen.within | (np.abs(mine.distance) <= np.abs(seen.distance) + NEAREST)
        # beside a tip, above all one where the beam is pinned, a place is by round-off alone beside a piece, or none
        for tip in self.tips:
            nearest &= np.abs(mine.distance) <= np.hypot(*(q - tip).T) + NEAREST
        return np.asarray(facing | nearest)

    def _next_to(self, face: Face, A: smooth.Points, frame: Frame) -> Flags:
        """Which points of the beam face a piece."""
        return self.next_to(face, frame.inwards(np.stack((A.x, A.y), axis=1)))

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.brought_to(state)._groups(state, at)

    def _groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        line, frame = self.line(state, at), self.frame(state, at)
        found = [group for pin in self.pins if pin is not None for group in self._stopped(pin, state, at)]
        placed = [self._places(face, line, frame) for face in self.faces]
        own = np.concatenate([s[free] for s, free in placed])
        standing = [self._closest(corner, line, frame, own) for corner in self.corners]
        for number, (s, free) in enumerate(placed):
            if s.size:
                found.append(self._pressing(number, line, frame, s, free))
        for number, s in enumerate(standing):
            if s.size:
                found.append(self._cornering(number, line, frame, s))
        return tuple(found)

    def _beside(self, s: Array, places: Array) -> Flags:
        """Which arc lengths ``s`` (k,) are so close to some ``places`` (j,) that what presses is left to those."""
        reach = wells.BESIDE * self.a.size_at(places)
        return np.asarray(np.any(np.abs(s[:, None] - places) <= reach, axis=1))

    def _stopped(self, pin: AngleStop, state: State, at: Positions) -> tuple[Group, ...]:
        # rows of this contact, whose own have no keys below −1
        first = -2 if pin.arc == 0.0 else -4
        return tuple(replace(group, keys=tuple(first - key for key in group.keys)) for group in pin.groups(state, at))

    def _pressing(self, number: int, line: smooth.SmoothLine, frame: Frame, s: Array, free: Flags) -> Group:
        """Rows at arc lengths ``s`` (k,) against one piece."""
        A = line.at(s)
        seen = self._seen(self.faces[number], A, frame)
        n, k = seen.normal, seen.bend
        D_z, along, D_sz, second = self._slopes(A, n, frame)
        g, beyond, leading = self._across(A, n), missed(self.a, self.kinks, A), self._leading(A, n)
        second += k[:, None, None] * along[:, :, None] * along[:, None, :]
        D_sz += (k * g)[:, None] * along
        D_ss = self._convexity(A, n, k) + leading * beyond.bend
        going = np.where(free, 1.0 / np.where(free, D_ss, 1.0), 0.0)
        second -= going[:, None, None] * D_sz[:, :, None] * D_sz[:, None, :]
        values = self.offset - seen.distance - np.where(free, leading * beyond.integral, 0.0)
        return self._group(A, values, D_z, second, self._keys(number, s, free))

    def _cornering(self, number: int, line: smooth.SmoothLine, frame: Frame, s: Array) -> Group:
        """Rows at arc lengths ``s`` (k,) against one corner."""
        A, corner = line.at(s), self.corners[number]
        m = self._away(corner, A, frame)
        D_z, b, a, second = self._slopes(A, m, frame)
        g, beyond, leading = self._across(A, m), missed(self.a, self.kinks, A), self._leading(A, m)
        rho = np.sum(m * self._from(corner, A, frame), axis=1)
        M = self._convexity(A, m, np.zeros(len(s))) + leading * beyond.bend
        mixed = a[:, :, None] * b[:, None, :]
        turned = (
            M[:, None, None] * b[:, :, None] * b[:, None, :]
            - rho[:, None, None] * a[:, :, None] * a[:, None, :]
            - g[:, None, None] * (mixed + mixed.transpose(0, 2, 1))
        )
        second += turned / (rho * M + g**2)[:, None, None]
        values = self._half(s) - rho - leading * beyond.integral
        own = len(self.faces) * self._own_keys + number
        return self._group(A, values, D_z, second, (own,) * len(s))

    def _slopes(self, A: smooth.Points, n: Array, frame: Frame) -> tuple[Array, Array, Array, Array]:
        """n·v_z, τ·v_z and n·C_sz (k, p), and n·C_zz + E (k, p, p), over the local numbers."""
        tau = np.stack((n[:, 1], -n[:, 0]), axis=1)
        z = moving(A)
        C_z, C_sz = position_slopes(z), tangent_slopes(z)
        second = position_curvature(z, n)
        v_z = C_z
        if self.body >= 0:
            r, turned = np.stack((A.x, A.y), axis=1) - frame.m, -tau  # J n
            swung = np.stack((r[:, 1], -r[:, 0]), axis=1)  # −J r
            moves = np.tile(-np.eye(2), (len(A.s), 1, 1))
            v_z = np.concatenate((C_z, moves, swung[:, :, None]), axis=2)
            C_sz = np.pad(C_sz, ((0, 0), (0, 0), (0, 3)))
            second = np.pad(second, ((0, 0), (0, 3), (0, 3)))
            swinging = np.einsum("mi,mik->mk", turned, np.concatenate((C_z, moves), axis=2))
            second[:, 7, :7] += swinging
            second[:, :7, 7] += swinging
            second[:, 7, 7] -= np.sum(n * r, axis=1)
        n_z, along = np.einsum("mi,mik->mk", n, v_z), np.einsum("mi,mik->mk", tau, v_z)
        n_sz = np.einsum("mi,mik->mk", n, C_sz)
        if self.body >= 0:
            n_sz[:, 7] -= self._across(A, n)  # J n·C_s
        return n_z, along, n_sz, second

    def _group(self, A: smooth.Points, values: Array, D_z: Array, second: Array, keys: tuple[int, ...]) -> Group:
        """Rows with these values, slopes −D_z (k, p) and second derivatives −``second`` (k, p, p)."""
        link = A.link
        joints = (self.a.first_joint + link)[:, None]
        angles = self.a.first_link + np.stack((np.maximum(link - 1, 0), link, np.minimum(link + 1, self.a.n)), axis=1)
        order = ALONE
        if self.body >= 0:
            joints = np.stack((joints[:, 0], np.full(len(link), self.mark)), axis=1)
            angles = np.concatenate((angles, np.full((len(link), 1), self.turning)), axis=1)
            order = WITH_BODY
        second = second[:, order[:, None], order]

        def curvature(multipliers: Array) -> Blocks:
            pressing = np.flatnonzero(multipliers)
            weights = -multipliers[pressing, None, None]
            return Blocks(joints[pressing], angles[pressing], weights * second[pressing])

        return Group(
            contact=self.name,
            values=values,
            joints=joints,
            angles=np.asarray(angles, dtype=np.intp),
            slopes=-D_z[:, order],
            curvature=curvature,
            keys=keys,
            arc=A.s,
        )

    @property
    def _own_keys(self) -> int:
        """Keys of one piece."""
        return self.a.n + 2 + len(self.ends)

    def _keys(self, number: int, s: Array, free: Flags) -> tuple[int, ...]:
        keys = np.searchsorted(self.a.s, s)
        at_ends = np.isin(s, self.ends)
        keys[at_ends] = self.a.n + 2 + np.searchsorted(np.sort(self.ends), s[at_ends])
        return tuple(np.where(free, -1, keys + number * self._own_keys).tolist())

    @staticmethod
    def _leading(A: smooth.Points, n: Array) -> Array:
        """By how much D_s grows as the tangent leads, ±1: whether the edge is on the beam's right or left."""
        return np.where(n[:, 1] * np.cos(A.psi) > n[:, 0] * np.sin(A.psi), 1.0, -1.0)

    @staticmethod
    def _across(A: smooth.Points, n: Array) -> Array:
        """τ·C_s."""
        return np.asarray(A.speed * (n[:, 1] * np.cos(A.psi) - n[:, 0] * np.sin(A.psi)))

    def _slope(self, A: smooth.Points, n: Array) -> Array:
        """D_s."""
        return np.asarray(A.speed * (n[:, 0] * np.cos(A.psi) + n[:, 1] * np.sin(A.psi)) - self._widening(A.s))

    def _convexity(self, A: smooth.Points, n: Array, k: Array) -> Array:
        """D_ss."""
        cos, sin = np.cos(A.psi), np.sin(A.psi)
        facing, leaning = n[:, 1] * cos - n[:, 0] * sin, n[:, 0] * cos + n[:, 1] * sin
        return np.asarray(facing * A.speed * A.bend + leaning * A.gain + k * self._across(A, n) ** 2)

    def _ruled(self, s: Array) -> Flags:
        """What lies on the first or the last link, where that is ruled."""
        start, end = self.ruled
        return np.asarray((start & (s <= self.a.s[1])) | (end & (s >= self.a.s[-2])))

    def _places(self, face: Face, line: smooth.SmoothLine, frame: Frame) -> tuple[Array, Flags]:
        """Arc lengths of the rows against one piece, and which of them move with a minimum."""
        A = line.sampled
        s, q = A.s, frame.inwards(np.stack((A.x, A.y), axis=1))
        seen = face.seen(q)
        mine = self._facing(face, q, seen)
        if not mine.any() and face not in self.pieces:  # a side has no end that is between two samples alone
            return np.zeros(0), np.zeros(0, dtype=bool)
        seen = self._of(seen, A, frame)
        D = seen.distance - self.offset
        near = np.zeros(len(s), dtype=bool)
        near[::2] = D[::2] < _beside(self.a, face)
        near &= mine & ~self._ruled(s)
        # an end that the edge's own body holds cannot move against it: its gap is no unknown
        near[[0, -1]] &= ~np.array(self.held)
        # at an end that is lowest the minimum lies within if the way to it rises
        slope = self._slope(A, seen.normal)
        fence = [
            np.inf if inwards and not fixed else -np.inf
            for inwards, fixed in zip((slope[0] < 0.0, slope[-1] > 0.0), self.held, strict=True)
        ]
        lowest = wells.lowest(np.concatenate((fence[:1], D, fence[1:])), REACH) - 1
        lowest = lowest[self.own_places & ~self._ruled(s[lowest])]
        parting = self._convexity(A, seen.normal, seen.bend)[::2]
        found = wells.wells(self.a, D, parting, lowest, LEAST_CURVATURE, self.kinks.places)
        places = self._minima(face, line, frame, found, D, parting)
        for place in places:
            near &= np.abs(s - place) > wells.BESIDE * self.a.size_at(place)
        ends = np.array(self.ends)
        if ends.size:
            ends = ends[self._next_to(face, line.at(ends), frame) & ~self._ruled(ends)]
        fixed = np.concatenate((s[near], ends))
        return np.concatenate((fixed, places)), np.arange(len(fixed) + len(places)) >= len(fixed)

    def _minima(
        self, face: Face, line: smooth.SmoothLine, frame: Frame, found: wells.Wells, D: Array, parting: Array
    ) -> Array:
        """Arc lengths of the minima of D against one piece, from what may be a well."""
        places, settled = self._refined(face, line, frame, self.a.halves[found.samples])
        if not settled.any():
            return places[:0]
        B = line.at(places)
        settled &= found.held(self._seen(face, B, frame).distance - self.offset)
        settled &= self._next_to(face, B, frame) & ~self._ruled(places)
        return places[settled & ~self._lying(places, D, parting)]

    def _lying(self, places: Array, D: Array, parting: Array) -> Flags:
        """At which ``places`` (k,) the beam lies on the edge from an own pin on: it is the end of a zone.

        Args:
            places: minima of D.
            D: at the samples (2N+3,).
            parting: D″ at the joints (N+2,).
        """
        s, joints = self.a.halves, self.a.s
        lying = np.zeros(len(places), dtype=bool)
        for end in joints[[0, -1]][[pin is not None for pin in self.pins]]:
            for i, place in enumerate(places):
                low, high = sorted((float(end), float(place)))
                h = float(np.max(self.a.size_at(place + np.array([-0.5, 0.5]) * self.a.sizes.min())))
                bent = np.max(np.abs(parting[(joints >= low - 2.0 * h) & (joints <= high + 2.0 * h)]))
                arched = np.max(D[(s > low) & (s < high)], initial=-np.inf)
                lying[i] |= arched < bent * max(h**2, FLAT * (high - low) ** 2)
        return lying

    def _refined(self, face: Face, line: smooth.SmoothLine, frame: Frame, s: Array) -> tuple[Array, Flags]:
        """Newton's method on D_s = 0; the flags say where it settled at a minimum nearby."""

        def slope(s: Array) -> tuple[Array, Array]:
            A = line.at(s)
            beyond = missed(self.a, self.kinks, A)
            seen = self._seen(face, A, frame)
            leading = self._leading(A, seen.normal)
            D_ss = self._convexity(A, seen.normal, seen.bend) + leading * beyond.bend
            return self._slope(A, seen.normal) + leading * beyond.angle, D_ss

        return wells.bottom(slope, s, self._around(s), LEAST_CURVATURE, CLOSE)

    def _around(self, s: Array) -> Array:
        """Between which places (2, k) of the beam a minimum is sought from ``s`` (k,)."""
        return np.clip(np.stack((s - self.a.h, s + self.a.h)), 0.0, self.a.s[-1])

    def _from(self, corner: Corner, A: smooth.Points, frame: Frame) -> Array:
        """C − P (k, 2)."""
        return np.asarray(np.stack((A.x, A.y), axis=1) - frame.outwards(np.array([corner.place])))

    def _away(self, corner: Corner, A: smooth.Points, frame: Frame) -> Array:
        """m (k, 2)."""
        cos, sin = np.cos(A.psi), np.sin(A.psi)
        ahead = frame.turned(corner.ahead[None], frame.phi)[0]
        sign = np.where(ahead[1] * cos > ahead[0] * sin, 1.0, -1.0)
        lean = np.clip(self._widening(A.s) / A.speed, -1.0, 1.0)
        level = sign * np.sqrt(1.0 - lean**2)
        return np.stack((lean * cos - level * sin, lean * sin + level * cos), axis=1)

    def _closest(self, corner: Corner, line: smooth.SmoothLine, frame: Frame, taken: Array) -> Array:
        """Arc lengths where the beam is closest to a corner that it faces; none beside places that are ``taken``."""
        A = line.sampled
        away = np.hypot(*self._from(corner, A, frame).T)
        s = A.s[wells.lowest(away - self._half(A.s), REACH)]
        if not s.size:
            return s

        def slope(s: Array) -> tuple[Array, Array]:
            A = line.at(s)
            beyond = missed(self.a, self.kinks, A)
            m, r = self._away(corner, A, frame), self._from(corner, A, frame)
            g, leading, rho = self._across(A, m), self._leading(A, m), np.sum(m * r, axis=1)
            F_s = g**2 + rho * (self._convexity(A, m, np.zeros(len(s))) + leading * beyond.bend)
            return g * (m[:, 1] * r[:, 0] - m[:, 0] * r[:, 1]) + leading * rho * beyond.angle, F_s

        s, settled = wells.bottom(slope, s, self._around(s), LEAST_CURVATURE, CLOSE)
        settled &= (s > 0.0) & (s < self.a.s[-1]) & ~self._ruled(s) & ~self._beside(s, taken)
        s = np.unique(s[settled])
        if not s.size:
            return s
        A = line.at(s)
        m, r = self._away(corner, A, frame), self._from(corner, A, frame)
        faced = corner.beyond(frame.turned(m, -frame.phi)) >= -FACING - np.abs(A.bend) * self.a.size_at(s)
        faced &= (np.sum(m * r, axis=1) >= 0.0) | self._inside(corner, frame.turned(r, -frame.phi))
        return np.asarray(s[faced])

    def _inside(self, corner: Corner, r: Array) -> Flags:
        """Which places, ``r`` (k, 2) from a corner as the body sees it, are in what is rigid there.

        They are behind both of the corner's pieces and, as beyond a thin one they are in the open again, nearer to the
        corner than to what else there is.  A sharp corner's normals are those of lines, too, that pass it on one side.
        """
        inside: Flags = np.asarray((r @ np.array(corner.before) < 0.0) & (r @ np.array(corner.behind) < 0.0))
        if not inside.any():
            return inside
        place, depth = np.array(corner.place), np.hypot(r[:, 0], r[:, 1]) - NEAREST
        q = r + place
        for face in self.faces:
            if not any(end is not None and np.hypot(*(end - place)) <= SAME for end in face.ends):
                seen = face.seen(q)
                inside &= ~seen.within | (np.abs(seen.distance) >= depth)
        for tip in self.tips:
            inside &= np.hypot(*(q - tip).T) >= depth
        return inside

    def _nearest(self, A: smooth.Points, frame: Frame) -> tuple[Array, Array, Array]:
        """Of the pieces that some points face, the nearest: D (k,), infinite where there is none, n (k, 2), k (k,)."""
        least, normal, bend = np.full(len(A.s), np.inf), np.zeros((len(A.s), 2)), np.zeros(len(A.s))
        q = frame.inwards(np.stack((A.x, A.y), axis=1))
        for face in self.faces:
            seen = face.seen(q)
            facing = self._facing(face, q, seen)
            if not facing.any():
                continue
            seen = self._of(seen, A, frame)
            nearer = facing & (seen.distance < least)
            least = np.where(nearer, seen.distance, least)
            normal, bend = np.where(nearer[:, None], seen.normal, normal), np.where(nearer, seen.bend, bend)
        for corner in self.corners:
            seen = self._seen(corner, A, frame)
            nearer = seen.within & (seen.distance < least)
            least = np.where(nearer, seen.distance, least)
            normal, bend = np.where(nearer[:, None], seen.normal, normal), np.where(nearer, seen.bend, bend)
        return least, normal, bend

    def _in_touch(self, frame: Frame) -> tuple[tuple[bool, bool], tuple[bool, bool]]:
        """Of the beam's start and of its end, as drawn, whether it touches the edge there, and lies along it too."""
        ends = self.ends_at_rest
        distance, n, _ = self._nearest(ends, frame)
        touches = np.abs(distance - self.offset) <= ON_IT
        along = touches & (np.abs(self._slope(ends, n)) <= ON_IT)
        return (bool(touches[0]), bool(along[0])), (bool(touches[1]), bool(along[1]))

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """D_ss at arc lengths ``s`` if the beam touched there along the edge: the curvature with which it parts."""
        A = self.line(state, at).at(s)
        _, n, bend = self._nearest(A, self.frame(state, at))
        return np.asarray(self._leading(A, n) * A.bend + bend)

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edge touches that touches at arc lengths ``s``, (k, 2), units of length."""
        A = self.line(state, at).at(s)
        distance, n, _ = self._nearest(A, self.frame(state, at))
        away = np.where(np.isfinite(distance), distance + self._half(s) - self.offset, 0.0)
        return np.stack((A.x, A.y), axis=1) - away[:, None] * n

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On the beam what lies at ``s``."""
        return ((1.0, s, self.line(state, at).at(s).psi),)

    def no_closer(self, state: State, at: Positions) -> float:
        """What the least gap is at least, units of length, by the samples alone.

        Along the beam a distance changes by no more than the way, and half of the thickness by less.  A corner that
        stands out may be all between two samples, and of an edge that has one nothing is known by them.
        """
        if self.corners:
            return -np.inf
        A = self.line(state, at).sampled
        apart = float(np.max(np.diff(A.s)))
        return float(self._nearest(A, self.frame(state, at))[0].min()) - self.offset - 2.0 * apart

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap anywhere along the beam, units of length; negative where it overlaps."""
        line, frame = self.line(state, at), self.frame(state, at)
        least = [self._nearest(line.sampled, frame)[0].min()]
        for face in self.faces:
            s, _ = self._places(face, line, frame)
            if s.size:
                least.append(self._nearest(line.at(s), frame)[0].min())
        for corner in self.corners:
            A = line.at(self._closest(corner, line, frame, np.zeros(0)))
            rho = np.sum(self._away(corner, A, frame) * self._from(corner, A, frame), axis=1)
            least.append((rho - (self._half(A.s) - self.offset)).min(initial=np.inf))
        return float(min(least)) - self.offset


def reach(chain: Chain, face: Face) -> float:
    """Gap of a beam and a piece of an edge beyond which there are no rows, units of length."""
    return max(REACH, _beside(chain, face))


def _beside(chain: Chain, face: Face) -> float:
    """Gap beyond which joints have none."""
    return JOINT_REACH * chain.h**2 * (face.sharpest + 1.0)


def edge_of(scene: Scene, model: Model, name: str, fit: Fit = EVEN) -> Edge:
    """One of the scene's contacts with an edge."""
    contact = scene.contacts[name]
    assert isinstance(contact, EdgeContact)
    chain = model.chain(contact.beam)
    offset = 0.5 * float(chain.section.thickness.min()) if contact.thick else 0.0
    on = model.marks[name] if name in model.marks else Attachment(-1, (0.0, 0.0), welded=False)
    body = on.body
    x, y = np.array(anchor(contact)) / model.unit_length if body >= 0 else (0.0, 0.0)
    pins = own_pins(scene, model, name)
    held = (chain.start.frame == on.frame, chain.end is not None and chain.end.frame == on.frame)
    welded = (chain.start.welded, chain.end is not None and chain.end.welded)
    pieces = faces_of(contact, model.unit_length, (float(x), float(y)))
    sides = sides_of(pieces)
    state = rest_state(model)
    line = smooth.smooth_line(chain, model.unit_length, state, positions(model, state))
    pinned = _pinned_at(scene, model, contact, pins, (float(x), float(y)))
    edge = Edge(
        name=name,
        a=chain,
        body=body,
        mark=model.mark_of(name),
        turning=model.n_links + 3 * body + 2,
        pieces=pieces,
        faces=(*pieces, *sides),
        tips=_tips((*pieces, *sides)),
        corners=_corners(pieces, sides, pinned, offset),
        offset=offset,
        unit_length=model.unit_length,
        drawn=(float(x), float(y)),
        ends_at_rest=line.at(chain.s[[0, -1]]),
        held=(held[0] or pins[0] is not None, held[1] or pins[1] is not None),
        pins=pins,
        ruled=(
            pins[0] is not None or (held[0] and welded[0]),
            pins[1] is not None or (held[1] and welded[1]),
        ),
        ends=tuple((chain.s[-1] * fit.ends.get(name, np.zeros(0))).tolist()),
        kinks=fit.kinks.get(name, (NO_KINKS,))[0],
        brought=(brought(chain.start, on, model.references), brought(chain.end, on, model.references)),
    )
    start, end = held[0] and welded[0], held[1] and welded[1]
    if not (start or end):
        return edge
    (_, starts), (_, ends) = edge._in_touch(Frame(np.array(edge.drawn), 0.0))
    return replace(edge, clamped=(start and starts, end and ends))


def _pinned_at(
    scene: Scene,
    model: Model,
    contact: EdgeContact,
    pins: tuple[AngleStop | None, AngleStop | None],
    origin: tuple[float, float],
) -> Array:
    """Where the beam is pinned on the edge, (k, 2), units of length from an ``origin`` (2,)."""
    curve = scene.beams[contact.beam].curve
    places = [place for pin, place in zip(pins, (curve.start, curve.end), strict=True) if pin is not None]
    return np.asarray(np.array(places, dtype=float).reshape(-1, 2) / model.unit_length - np.array(origin))


def _tips(faces: tuple[Face, ...]) -> Array:
    """Where the ``faces`` begin and end, each place once, (k, 2)."""
    found: list[Array] = []
    for tip in (end for face in faces for end in face.ends if end is not None):
        if not any(np.hypot(*(tip - other)) <= SAME for other in found):
            found.append(tip)
    return np.array(found).reshape(-1, 2)


def _corners(pieces: tuple[Face, ...], sides: tuple[Face, ...], pinned: Array, offset: float) -> tuple[Corner, ...]:
    """The corners but for those at which the beam is ``pinned`` (k, 2): they hold it as its pin does."""
    return tuple(
        corner
        for corner in corners_of(pieces, sides)
        if not np.any(np.hypot(*(pinned - np.array(corner.place)).T) <= offset + PIN_ON_IT)
    )
