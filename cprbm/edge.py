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
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from cprbm import smooth, wells
from cprbm.brought import Brought, brought
from cprbm.corner import Corner, corners_of
from cprbm.cutting import cut
from cprbm.faces import SAME, Face, Graph, Seen, faces_of, sides_of
from cprbm.first_contact import Blocks, Group
from cprbm.frame import Frame
from cprbm.kinematics import Positions, State, positions, rest_state
from cprbm.kinks import missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.moving import Moving, moving, position_curvature, position_slopes, tangent_slopes
from cprbm.outset import anchor
from cprbm.own_pins import ON_IT as PIN_ON_IT
from cprbm.own_pins import own_pins
from cprbm.pairs import THINNEST, Pressed
from cprbm.standing import Attachment
from cprbm.stops import AngleStop
from cprbm.summit import Summits, looked_at, summits
from cprbm.whole_edge import NEAREST, WholeEdge
from cprbm_scene import EdgeContact, Scene
from cprbm_scene.answer import Array, Flags, Ints

# local numbers (x, y, θθθ, m, φ) to (x of joints, y of joints, θθθ φ)
ALONE, WITH_BODY = np.arange(5), np.array([0, 5, 1, 6, 2, 3, 4, 7])
CLOSE = 1e-10  # units of length: a step whose square is nothing
LEAST_CURVATURE = 1e-6  # of D, 1/ℓ, below which its minimum has no place of its own
REACH = 0.1  # minima of D farther than this part of the longest beam are no constraints yet
ON_IT = 1e-9  # gap and slope of a clamped end that is in touch with the edge
ARCHING = 0.2  # of what the largest force bends one element by: where a zone ends within one it arches by less
JOINT_REACH = 2.0  # joints farther than this many h²·(κ + 1/ℓ), or h if that is less, are none
FLAT = 0.01  # of D″ times the length squared, as for zones
ACROSS = 0.5  # cosine of the angle of a piece's normal and the beam's beyond which it pushes along the beam
FACING = 1e-9  # by which a normal may miss those of the corner that it is of


@dataclass(frozen=True, slots=True)
class Edge:
    """A beam and a rigid edge.

    Attributes:
        name: of the contact.
        a: the beam's chain.
        body: that the edge is fixed to, −1 for the ground; ``mark`` the number of m among the joints, and ``turning``
            that of φ among the unknowns, if that is a body that moves.
        pieces: its own; ``faces`` are these, and where it has ends the sides of what is rigid behind it.
        whole: these; where they begin and end, nothing being deeper behind the edge than it is far from the nearest
            such tip; and the corners between them, but for those at which the beam is pinned.
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
    whole: WholeEdge
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
    def corners(self) -> tuple[Corner, ...]:
        """The corners at which the beam is not pinned."""
        return self.whole.corners

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

    @property
    def standing_out(self) -> tuple[Array, Array | None]:
        """Places that no beam goes through, corners and where it bulges, and out of what is rigid, (k, 2) each."""
        bulging = [face.bulging for face in self.pieces]
        places = np.concatenate([self.whole.places, *(each for each, _ in bulging)])
        return places, np.concatenate([self.whole.ahead, *(each for _, each in bulging)])

    def _half(self, s: Array) -> Array:
        """T at arc lengths ``s``."""
        return 0.5 * self.a.section.thickness_at(s) if self.offset > 0.0 else np.zeros_like(s)

    def _widening(self, s: Array) -> Array:
        """T_s at arc lengths ``s``."""
        return 0.5 * self.a.section.thinning_at(s) if self.offset > 0.0 else np.zeros_like(s)

    def _look(self, line: smooth.SmoothLine, frame: Frame) -> tuple[Array, Seen]:
        """The beam's samples as the body sees them (k, 2), and every face from there, worked out once in a state."""
        known, what = line.known, (self.name, "faces")
        if what not in known:
            A = line.sampled
            q = frame.inwards(np.array((A.x, A.y)).T)
            seen = self.whole.seen(q)
            known[what] = q, seen.distance, seen.normal, seen.bend, seen.within
        q, distance, normal, bend, within = known[what]
        return q, Seen(distance, normal, bend, within)

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.brought_to(state)._groups(state, at)

    def _groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        line, frame = self.line(state, at), self.frame(state, at)
        found = [group for pin in self.pins if pin is not None for group in self._stopped(pin, state, at)]
        tops, deep = self._summits(line, frame)
        number, s, free = self._places(line, frame, tops)
        corner, at_corners, cuts = self._closest(line, frame, s[free])
        cuts += deep
        if cuts:
            # what has gone through a sharp corner is held by that, and not by its sides that it lies behind there
            across = self._sideways(number, line.at(s), frame)
            kept = ~(across & np.any([(low <= s) & (s <= high) for low, high in cuts], axis=0))
            number, s, free = number[kept], s[kept], free[kept]
        if s.size:
            found.append(self._pressing(number, line, frame, s, free))
        if at_corners.size:
            own = len(self.faces) * self._own_keys + corner
            places, ahead = self.whole.places[corner], self.whole.ahead[corner]
            found.append(self._cornering(places, ahead, np.zeros(len(own)), line, frame, at_corners, own))
        corner, at_ends = self._end_on(line, frame)
        if at_ends.size:
            found.append(self._capping(corner, line, frame, at_ends))
        for _, top in tops:
            centres = top.place - top.radius[:, None] * top.normal
            keys = np.full(len(top.s), -1)
            found.append(self._cornering(centres, top.normal, top.radius, line, frame, top.s, keys))
        return tuple(found)

    def on_corner(self, key: int) -> bool:
        """Whether a row, by its ``key``, is that of a corner that presses on the beam's side."""
        return 0 <= key - len(self.faces) * self._own_keys < len(self.corners)

    def by_corner(self, key: int) -> bool:
        """The same, or that of a corner that presses on an end."""
        return key >= len(self.faces) * self._own_keys

    def _beside(self, s: Array, places: Array) -> Flags:
        """Which arc lengths ``s`` (k,) are so close to some ``places`` (j,) that what presses is left to those."""
        reach = wells.BESIDE * self.a.size_at(places)
        return np.asarray(np.any(np.abs(s[:, None] - places) <= reach, axis=1))

    def _stopped(self, pin: AngleStop, state: State, at: Positions) -> tuple[Group, ...]:
        # rows of this contact, whose own have no keys below −1
        first = -2 if pin.arc == 0.0 else -4
        return tuple(replace(group, keys=tuple(first - key for key in group.keys)) for group in pin.groups(state, at))

    def _pressing(self, number: Ints, line: smooth.SmoothLine, frame: Frame, s: Array, free: Flags) -> Group:
        """Rows at arc lengths ``s`` (k,) against the pieces of some ``number`` (k,)."""
        A = line.at(s)
        seen = self._each(number, A, frame)
        n, z = seen.normal, moving(A)
        D_z, beyond = self._slopes(A, z, n, frame), missed(self.a, self.kinks, A)

        def bent() -> Array:
            along, D_sz, second = self._second(A, z, n, frame)
            g, k = self._across(A, n), seen.bend
            second += k[:, None, None] * along[:, :, None] * along[:, None, :]
            D_sz += (k * g)[:, None] * along
            D_ss = self._convexity(A, n, k) + self._leading(A, n) * beyond.bend
            going = np.where(free, 1.0 / np.where(free, D_ss, 1.0), 0.0)
            second -= going[:, None, None] * D_sz[:, :, None] * D_sz[:, None, :]
            return second

        values = self._half(s) - seen.distance - np.where(free, self._leading(A, n) * beyond.integral, 0.0)
        return self._group(A, values, D_z, bent, self._keys(number, s, free))

    def _cornering(
        self, places: Array, ahead: Array, radius: Array, line: smooth.SmoothLine, frame: Frame, s: Array, keys: Ints
    ) -> Group:
        """Rows with some ``keys`` (k,) at arc lengths ``s`` (k,), each against what is round about a place (k, 2).

        ``ahead`` (k, 2) is out of what is rigid there, of a ``radius`` (k,), nought of a corner.
        """
        A = line.at(s)
        m, z = self._away(ahead, A, frame), moving(A)
        rho = np.sum(m * self._from(places, A, frame), axis=1)
        beyond, leading = missed(self.a, self.kinks, A), self._leading(A, m)

        def bent() -> Array:
            b, a, second = self._second(A, z, m, frame)
            g, M = self._across(A, m), self._convexity(A, m, np.zeros(len(s))) + leading * beyond.bend
            mixed = a[:, :, None] * b[:, None, :]
            turned = (
                M[:, None, None] * b[:, :, None] * b[:, None, :]
                - rho[:, None, None] * a[:, :, None] * a[:, None, :]
                - g[:, None, None] * (mixed + mixed.transpose(0, 2, 1))
            )
            return np.asarray(second + turned / (rho * M + g**2)[:, None, None])

        values = self._half(s) - (rho - radius) - leading * beyond.integral
        return self._group(A, values, self._slopes(A, z, m, frame), bent, tuple(keys.tolist()))

    def _capping(self, number: Ints, line: smooth.SmoothLine, frame: Frame, s: Array) -> Group:
        """Rows of the beam's ends ``s`` (k,), which are round, against the corners of some ``number`` (k,)."""
        A = line.at(s)
        r, z = self._from(self.whole.places[number], A, frame), moving(A)
        rho = np.hypot(r[:, 0], r[:, 1])
        n = r / rho[:, None]

        def bent() -> Array:
            along, _, second = self._second(A, z, n, frame)
            return np.asarray(second + along[:, :, None] * along[:, None, :] / rho[:, None, None])

        last = len(self.faces) * self._own_keys + len(self.corners)
        keys = last + 2 * number + (s > 0.0)
        return self._group(A, self._half(s) - rho, self._slopes(A, z, n, frame), bent, tuple(keys.tolist()))

    def _slopes(self, A: smooth.Points, z: Moving, along: Array, frame: Frame) -> Array:
        """Of v_z its part along some directions (k, 2), over the local numbers (k, p)."""
        slopes = position_slopes(z, along)
        if self.body < 0:
            return slopes
        x, y = A.x - frame.m[0], A.y - frame.m[1]
        swung = along[:, 0] * y - along[:, 1] * x  # −J r
        return np.concatenate((slopes, -along, swung[:, None]), axis=1)

    def _second(self, A: smooth.Points, z: Moving, n: Array, frame: Frame) -> tuple[Array, Array, Array]:
        """τ·v_z and n·C_sz (k, p), and n·C_zz + E (k, p, p), over the local numbers."""
        tau = np.stack((n[:, 1], -n[:, 0]), axis=1)
        along, n_sz, second = self._slopes(A, z, tau, frame), tangent_slopes(z, n), position_curvature(z, n)
        if self.body >= 0:
            n_sz, second = np.pad(n_sz, ((0, 0), (0, 3))), np.pad(second, ((0, 0), (0, 3), (0, 3)))
            swinging = -along[:, :7]  # −τ is J n
            second[:, 7, :7] += swinging
            second[:, :7, 7] += swinging
            second[:, 7, 7] -= np.sum(n * (np.stack((A.x, A.y), axis=1) - frame.m), axis=1)
            n_sz[:, 7] -= self._across(A, n)  # J n·C_s
        return along, n_sz, second

    def _group(
        self, A: smooth.Points, values: Array, D_z: Array, bent: Callable[[], Array], keys: tuple[int, ...]
    ) -> Group:
        """Rows with these values, slopes −D_z (k, p) and second derivatives −``bent`` (k, p, p)."""
        link = A.link
        joints = (self.a.first_joint + link)[:, None]
        angles = self.a.first_link + np.stack((np.maximum(link - 1, 0), link, np.minimum(link + 1, self.a.n)), axis=1)
        order = ALONE
        if self.body >= 0:
            joints = np.stack((joints[:, 0], np.full(len(link), self.mark)), axis=1)
            angles = np.concatenate((angles, np.full((len(link), 1), self.turning)), axis=1)
            order = WITH_BODY

        @cache
        def second() -> Array:
            return bent()[:, order[:, None], order]

        def curvature(multipliers: Array) -> Blocks:
            pressing = np.flatnonzero(multipliers)
            weights = -multipliers[pressing, None, None]
            return Blocks(joints[pressing], angles[pressing], weights * second()[pressing])

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

    def _keys(self, number: Ints, s: Array, free: Flags) -> tuple[int, ...]:
        keys = np.searchsorted(self.a.s, s)
        if self.ends:
            at_ends = np.isin(s, self.ends)
            keys[at_ends] = self.a.n + 2 + np.searchsorted(np.sort(self.ends), s[at_ends])
        return tuple(np.where(free, -1, keys + number * self._own_keys).tolist())

    def _each(self, number: Ints, A: smooth.Points, frame: Frame) -> Seen:
        """Of points of the beam each one piece, by its ``number`` (k,), n as it is turned."""
        seen = self.whole.each(number, frame.inwards(np.array((A.x, A.y)).T))
        return replace(seen, normal=frame.turned(seen.normal, frame.phi))

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

    def _places(
        self, line: smooth.SmoothLine, frame: Frame, tops: Sequence[tuple[int, Summits]]
    ) -> tuple[Ints, Array, Flags]:
        """Which pieces rows stand against, the rows' arc lengths, and which of them move with a minimum, (k,) each.

        Where narrow graphs are closest to the beam, at their ``tops``, those have rows of their own.
        """
        A = line.sampled
        q, seen = self._look(line, frame)
        mine, D = self.whole.facing(q, seen), seen.distance - self._half(A.s)
        near = np.zeros(D.shape, dtype=bool)
        near[:, ::2] = D[:, ::2] < np.array([_beside(self.a, face) for face in self.faces])[:, None]
        near &= mine
        if any(self.ruled):
            near &= ~self._ruled(A.s)
        # an end that the edge's own body holds cannot move against it: its gap is no unknown
        near[:, [0, -1]] &= ~np.array(self.held)
        numbers, places = self._minima(line, frame, seen, D, mine)
        for number, top in tops:
            own = (numbers != number) | np.all(
                np.abs(places[:, None] - top.s) > self.a.size_at(places)[:, None], axis=1
            )
            numbers, places = numbers[own], places[own]
            for place in top.s:
                near[number] &= np.abs(A.s - place) > wells.BESIDE * self.a.size_at(place)
        for number, place in zip(numbers, places, strict=True):
            near[number] &= np.abs(A.s - place) > wells.BESIDE * self.a.size_at(place)
        on, at = near.nonzero()
        fixed, on_ends = A.s[at], np.zeros(0, dtype=np.intp)
        if self.ends:
            ends = np.array(self.ends)
            faced = self._facing(line.at(ends), frame)
            if any(self.ruled):
                faced &= ~self._ruled(ends)
            on_ends, at = faced.nonzero()
            fixed = np.concatenate((fixed, ends[at]))
        return (
            np.concatenate((on, on_ends, numbers)),
            np.concatenate((fixed, places)),
            np.arange(len(fixed) + len(places)) >= len(fixed),
        )

    def _facing(self, A: smooth.Points, frame: Frame) -> Flags:
        """Which points of the beam (k,) face which pieces (F, k)."""
        q = frame.inwards(np.array((A.x, A.y)).T)
        return self.whole.facing(q, self.whole.seen(q))

    def _minima(self, line: smooth.SmoothLine, frame: Frame, seen: Seen, D: Array, mine: Flags) -> tuple[Ints, Array]:
        """Where D has minima of their own: against which pieces, and arc lengths (k,).

        Args:
            line, frame: the beam and the edge.
            seen, D: the pieces from the beam's samples, and D there (F, 2N+3).
            mine: which samples face which pieces (F, 2N+3).
        """
        A, none = line.sampled, np.zeros(0, dtype=np.intp)
        low = self._lowest(A, D, mine, frame.turned(seen.normal[:, [0, -1]].reshape(-1, 2), frame.phi))
        numbers, found, partings = [none], list[wells.Wells](), dict[int, Array]()
        for number in np.flatnonzero(low.any(axis=1)).tolist():
            n = frame.turned(seen.normal[number], frame.phi)
            partings[number] = self._convexity(A, n, seen.bend[number])[::2]
            samples = np.flatnonzero(low[number])
            found.append(wells.wells(self.a, D[number], partings[number], samples, LEAST_CURVATURE, self.kinks.places))
            numbers.append(np.full(len(found[-1].samples), number))
        of = np.concatenate(numbers)
        if not of.size:
            return of, np.zeros(0)
        places, settled = self._refined(of, line, frame, A.s[np.concatenate([each.samples for each in found])])
        if not settled.any():
            return none, np.zeros(0)
        B, k = line.at(places), np.arange(len(places))
        q = frame.inwards(np.array((B.x, B.y)).T)
        there = self.whole.seen(q)
        gap, first = there.distance[of, k] - self._half(places), 0
        for each in found:
            its = slice(first, first + len(each.samples))
            settled[its] &= each.held(gap[its])
            first = its.stop
        settled &= self.whole.facing(q, there)[of, k] & ~self._ruled(places)
        if self.pins != (None, None):
            for number, parting in partings.items():
                own = of == number
                settled[own] &= ~self._lying(places[own], D[number], parting)
        return of[settled], places[settled]

    def _lowest(self, A: smooth.Points, D: Array, mine: Flags, normals: Array) -> Flags:
        """Which samples are lowest against which pieces (F, 2N+3); ``normals`` of the samples at both ends (2F, 2)."""
        # at an end that is lowest the minimum lies within if the way to it rises
        ends = A.only(np.tile([0, len(A.s) - 1], len(D)))
        slope = self._slope(ends, normals).reshape(-1, 2)
        held = np.array(self.held)
        rises = np.array((slope[:, 0] < 0.0, slope[:, 1] > 0.0)).T & ~held
        fence = np.where(rises, np.inf, -np.inf)
        fenced = np.concatenate((fence[:, :1], D, fence[:, 1:]), axis=1)
        low: Flags = np.asarray((fenced[:, :-2] >= D) & (fenced[:, 2:] > D) & (REACH > D))
        if any(self.ruled):
            low &= ~self._ruled(A.s)
        # a side has no end that is between two samples alone
        sides = slice(len(self.pieces), None)
        low[sides] &= np.any(mine[sides], axis=1, keepdims=True)
        return low & self.own_places

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

    def _refined(self, number: Ints, line: smooth.SmoothLine, frame: Frame, s: Array) -> tuple[Array, Flags]:
        """Newton's method on D_s = 0; the flags say where it settled at a minimum nearby."""
        twice = np.concatenate((number, number))

        def slope(s: Array) -> tuple[Array, Array]:
            A = line.at(s)
            beyond, seen = missed(self.a, self.kinks, A), self._each(twice[: len(s)], A, frame)
            leading = self._leading(A, seen.normal)
            D_ss = self._convexity(A, seen.normal, seen.bend) + leading * beyond.bend
            return self._slope(A, seen.normal) + leading * beyond.angle, D_ss

        return wells.bottom(slope, s, self._around(s), LEAST_CURVATURE, CLOSE)

    def _around(self, s: Array) -> Array:
        """Between which places (2, k) of the beam a minimum is sought from ``s`` (k,)."""
        return np.clip(np.stack((s - self.a.h, s + self.a.h)), 0.0, self.a.s[-1])

    @staticmethod
    def _from(places: Array, A: smooth.Points, frame: Frame) -> Array:
        """C − P (k, 2), each point of the beam from one of some ``places`` (k, 2) as the body sees them."""
        return np.asarray(np.array((A.x, A.y)).T - frame.outwards(places))

    def _away(self, ahead: Array, A: smooth.Points, frame: Frame) -> Array:
        """m (k, 2) of the same, ``ahead`` (k, 2) being out of what is rigid."""
        cos, sin = np.cos(A.psi), np.sin(A.psi)
        ahead = frame.turned(ahead, frame.phi)
        sign = np.where(ahead[:, 1] * cos > ahead[:, 0] * sin, 1.0, -1.0)
        lean = np.clip(self._widening(A.s) / A.speed, -1.0, 1.0)
        level = sign * np.sqrt(1.0 - lean**2)
        return np.stack((lean * cos - level * sin, lean * sin + level * cos), axis=1)

    def _far(self, places: Array, ahead: Array, A: smooth.Points, frame: Frame) -> Array:
        """ρ (k,) of the same."""
        return np.asarray(np.sum(self._away(ahead, A, frame) * self._from(places, A, frame), axis=1))

    def _summits(
        self, line: smooth.SmoothLine, frame: Frame
    ) -> tuple[list[tuple[int, Summits]], list[tuple[float, float]]]:
        """Where narrow graphs are closest to the beam, by the graph, and between which arc lengths it cuts them off."""
        known, what = line.known, (self.name, "summits")
        if what not in known:
            tops, deep = list[tuple[int, Summits]](), list[tuple[float, float]]()
            for number, face in enumerate(self.pieces):
                if isinstance(face, Graph) and looked_at(face, self.a.h):
                    found, cuts = self._summits_of(face, line, frame)
                    deep += cuts
                    if found.s.size:
                        tops.append((number, found))
            known[what] = tops, deep
        tops, deep = known[what]
        return tops, deep

    def _summits_of(
        self, face: Graph, line: smooth.SmoothLine, frame: Frame
    ) -> tuple[Summits, list[tuple[float, float]]]:
        found = summits(face, line, frame, self.kinks, REACH + self.offset)
        held, cuts = np.zeros(len(found.s), dtype=bool), list[tuple[float, float]]()
        A = line.at(found.s)
        rho = self._far(found.place, found.normal, A, frame)
        for i in range(len(found.s)):
            held[i] = rho[i] >= -NEAREST
            if not held[i]:
                chains = self.whole.beside(face, float(found.v[i]))
                through = self._cut_off(chains, line, A.only(np.array([i])), found.normal[i], frame)
                if through is not None:
                    held[i] = True
                    cuts.append(through)
        held &= ~self._ruled(found.s)
        return found.only(held), cuts

    def _sideways(self, number: Ints, A: smooth.Points, frame: Frame) -> Flags:
        """Which points of the beam have a piece, by its ``number`` (k,), that pushes along it rather than across."""
        n = self._each(number, A, frame).normal
        return np.asarray(np.abs(n[:, 1] * np.cos(A.psi) - n[:, 0] * np.sin(A.psi)) < ACROSS)

    def _closest(
        self, line: smooth.SmoothLine, frame: Frame, taken: Array
    ) -> tuple[Ints, Array, list[tuple[float, float]]]:
        """Corners that the beam faces, arc lengths where it is closest to them, and between which it cuts some off.

        There are none beside those ``taken`` but such.
        """
        none = np.zeros(0, dtype=np.intp), np.zeros(0), list[tuple[float, float]]()
        if not self.corners:
            return none
        A, places = line.sampled, frame.outwards(self.whole.places)
        D = np.hypot(A.x - places[:, :1], A.y - places[:, 1:]) - self._half(A.s)
        # an end may be the lowest sample, and the closest place beside it
        fenced = np.pad(D, ((0, 0), (1, 1)), constant_values=np.inf)
        before, inner, behind = fenced[:, :-2], D, fenced[:, 2:]
        number, sample = ((before >= inner) & (behind > inner) & (inner < REACH)).nonzero()
        if not number.size:
            return none
        twice, s = np.concatenate((number, number)), A.s[sample]

        def slope(s: Array) -> tuple[Array, Array]:
            A, corner = line.at(s), twice[: len(s)]
            beyond = missed(self.a, self.kinks, A)
            m, r = self._away(self.whole.ahead[corner], A, frame), self._from(self.whole.places[corner], A, frame)
            g, leading, rho = self._across(A, m), self._leading(A, m), np.sum(m * r, axis=1)
            F_s = g**2 + rho * (self._convexity(A, m, np.zeros(len(s))) + leading * beyond.bend)
            return g * (m[:, 1] * r[:, 0] - m[:, 0] * r[:, 1]) + leading * rho * beyond.angle, F_s

        s, settled = wells.bottom(slope, s, self._around(s), LEAST_CURVATURE, CLOSE)
        settled &= (s > 0.0) & (s < self.a.s[-1]) & ~self._ruled(s)
        # samples on both sides may lead to one place
        s, corner = s[settled], number[settled]
        if not s.size:
            return none
        order = np.lexsort((s, corner))
        s, corner = s[order], corner[order]
        other = np.append(True, (np.diff(s) != 0.0) | (np.diff(corner) != 0))
        s, corner = s[other], corner[other]
        A = line.at(s)
        m, r = self._away(self.whole.ahead[corner], A, frame), self._from(self.whole.places[corner], A, frame)
        normals, r_here = frame.turned(m, -frame.phi), frame.turned(r, -frame.phi)
        rho, beside, through = np.sum(m * r, axis=1), self._beside(s, taken), dict[int, tuple[float, float]]()
        inside = np.zeros(len(s), dtype=bool)
        facing = np.array(
            [
                self.corners[number].beyond(normals[i : i + 1])[0] >= -FACING - np.abs(A.bend[i]) * self.a.size_at(s[i])
                for i, number in enumerate(corner.tolist())
            ]
        )
        for i in np.flatnonzero(facing & (rho < -NEAREST)).tolist():
            inside[i] = self._inside(self.corners[corner[i]], r_here[i : i + 1])[0]
            chains = self.whole.chains[corner[i]]
            found = self._cut_off(chains, line, A.only(np.array([i])), normals[i], frame)
            if found is not None:
                through[i] = found
        faced = facing & ~beside & ((rho >= -NEAREST) | inside)
        faced[list(through)] = True
        return corner[faced], s[faced], list(through.values())

    def _end_on(self, line: smooth.SmoothLine, frame: Frame) -> tuple[Ints, Array]:
        """Corners to which an end of the beam is closest, beyond which they are, and which of both ends that is."""
        if not self.corners or self.offset == 0.0:
            return np.zeros(0, dtype=np.intp), np.zeros(0)
        A = line.sampled
        number, end = np.indices((len(self.corners), 2)).reshape(2, -1)
        ends = A.only((len(A.s) - 1) * end)
        r = self._from(self.whole.places[number], ends, frame)
        rho = np.hypot(r[:, 0], r[:, 1])
        outwards = np.where(end == 0, 1.0, -1.0) * (r[:, 0] * np.cos(ends.psi) + r[:, 1] * np.sin(ends.psi))
        beyond = (outwards > 0.0) & (rho < REACH + self.offset) & (rho > NEAREST)
        beyond &= ~np.array(self.held)[end] & ~self._ruled(ends.s)
        seen = frame.turned(r, -frame.phi)
        for i in np.flatnonzero(beyond).tolist():
            beyond[i] = self.corners[number[i]].beyond(seen[i : i + 1])[0] >= 0.0
        return number[beyond], ends.s[beyond]

    def _cut_off(
        self,
        chains: tuple[Array, Array],
        line: smooth.SmoothLine,
        closest: smooth.Points,
        normal: Array,
        frame: Frame,
    ) -> tuple[float, float] | None:
        """Between which arc lengths the beam cuts a place off, to which it is ``closest`` at one point; or None.

        ``chains`` are the edge on both sides of the place, ``normal`` (2,) is m as the body sees it.  What is cut off
        is the lesser part of what is rigid.
        """
        A = line.sampled
        beyond = -(np.concatenate(chains) - frame.inwards(np.array([[closest.x[0], closest.y[0]]]))) @ normal
        if -beyond.min() > beyond.max():
            return None
        k = int(A.s.searchsorted(closest.s[0]))
        course = np.array((np.insert(A.x, k, closest.x[0]), np.insert(A.y, k, closest.y[0]))).T
        found = cut(frame.inwards(course), np.insert(A.s, k, closest.s[0]), *chains)
        if found is None:
            return None
        # what leans is crossed beside the place that is closest to its corner
        beside = float(self.a.size_at(closest.s)[0])
        return found if found[0] - beside <= closest.s[0] <= found[1] + beside else None

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
            own = any(end is not None and np.hypot(*(end - place)) <= SAME for end in face.ends)
            if own and isinstance(face, Graph):
                # what is behind its tangent at the corner may be in front of it elsewhere
                seen = face.seen(q)
                inside &= ~seen.within | (seen.distance < 0.0)
            elif not own:
                seen = face.seen(q)
                inside &= ~seen.within | (np.abs(seen.distance) >= depth)
        for tip in self.whole.tips:
            inside &= np.hypot(*(q - tip).T) >= depth
        return inside

    def _nearest(self, A: smooth.Points, frame: Frame) -> tuple[Array, Array, Array]:
        """Of the pieces that some points face, the nearest: D (k,), infinite where there is none, n (k, 2), k (k,)."""
        q = frame.inwards(np.array((A.x, A.y)).T)
        seen = self.whole.seen(q)
        return self._nearest_of(A, q, seen, frame)

    def _nearest_of(self, A: smooth.Points, q: Array, seen: Seen, frame: Frame) -> tuple[Array, Array, Array]:
        """The same, ``q`` (k, 2) being the points as the body sees them, and ``seen`` what that sees of the pieces."""
        views = [Seen(seen.distance, seen.normal, seen.bend, self.whole.facing(q, seen))]
        for corner in self.corners:
            its = corner.seen(q)
            views.append(Seen(its.distance[None], its.normal[None], its.bend[None], its.within[None]))
        away = np.concatenate([np.where(each.within, each.distance, np.inf) for each in views])
        k = np.arange(len(q))
        which = away.argmin(axis=0)
        least, there = away[which, k], np.isfinite(away[which, k])
        normal = np.where(there[:, None], np.concatenate([each.normal for each in views])[which, k], 0.0)
        bend = np.where(there, np.concatenate([each.bend for each in views])[which, k], 0.0)
        return least - (self._half(A.s) - self.offset), frame.turned(normal, frame.phi), bend

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
        stands out may be all between two samples: both are no farther from what is rigid than they are apart then.
        """
        line, frame = self.line(state, at), self.frame(state, at)
        q, seen = self._look(line, frame)
        least = self._nearest_of(line.sampled, q, seen, frame)[0]
        if self.corners:
            around = np.where(seen.within, np.abs(seen.distance), np.inf).min(axis=0)
            for tip in self.whole.tips:
                around = np.minimum(around, np.hypot(*(q - tip).T))
            least = np.minimum(least, around - (self._half(line.sampled.s) - self.offset))
        apart = float(np.max(np.diff(line.sampled.s)))
        # between two samples it is no less than half of what both have together less than the way from one to the other
        bound = 0.5 * float(np.min(least[1:] + least[:-1])) - self.offset - apart
        if bound > 0.0 or not self.corners:
            return bound
        # what it may have cut off is no farther beyond than from the nearest sample
        away = np.hypot(*(q[:, None] - self.standing_out[0]).transpose(2, 0, 1)).min(axis=0) + apart
        thickest = float(self._half(line.sampled.s).max())
        return min(bound, -float(np.max(away, where=away < REACH + thickest + apart, initial=0.0)) - thickest - NEAREST)

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap anywhere along the beam, units of length; negative where it overlaps."""
        line, frame = self.line(state, at), self.frame(state, at)
        tops, _ = self._summits(line, frame)
        s = self._places(line, frame, tops)[1]
        least = [self._nearest_of(line.sampled, *self._look(line, frame), frame)[0].min()]
        if s.size:
            least.append(self._nearest(line.at(s), frame)[0].min())
        corner, s, _ = self._closest(line, frame, np.zeros(0))
        if s.size:
            A = line.at(s)
            rho = self._far(self.whole.places[corner], self.whole.ahead[corner], A, frame)
            least.append((rho - (self._half(s) - self.offset)).min())
        for _, top in tops:
            A = line.at(top.s)
            rho = self._far(top.place, top.normal, A, frame)
            least.append((rho - (self._half(top.s) - self.offset)).min())
        return float(min(least)) - self.offset


def reach(chain: Chain, face: Face) -> float:
    """Gap of a beam and a piece of an edge beyond which there are no rows, units of length."""
    return max(REACH, _beside(chain, face))


def _beside(chain: Chain, face: Face) -> float:
    """Gap beyond which joints have none."""
    return JOINT_REACH * min(chain.h**2 * (face.sharpest + 1.0), chain.h)


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
        whole=WholeEdge(
            (*pieces, *sides), len(pieces), _tips((*pieces, *sides)), _corners(pieces, sides, pinned, offset)
        ),
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
