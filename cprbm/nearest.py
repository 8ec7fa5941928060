"""Contact of two beams where they are closest, with no hints: the formulation ``auto``.

==========  ==================================================================================
C_A, C_B    smooth neutral lines of the two beams, :mod:`cprbm.smooth`; ψ their tangent angles
s, σ        arc lengths on A and B
r           C_A(s) − C_B(σ)
t, n        tangent and left normal of B at σ
D           side·n·r: distance of the neutral lines, negative where they have passed each other
g           D − ½(t₁+t₂), the gap of the edges; constraint c = −g ≤ 0
z           local numbers of A (5) and of B (5)
==========  ==================================================================================

σ is the foot of the perpendicular, t·r = 0 (i).  A row stands where D has a minimum within A with a place of its
own (:mod:`cprbm.wells`), at every joint of A that is close to B but not beside such a minimum or an end of B, at the
ends of A and, with the beams' parts exchanged, of B.  At a minimum s moves with it: the tangents are parallel,
ψ_A − ψ_B = const (ii).  The conditions hold for every z, which gives s and σ as functions of z; so

    ∂D/∂z_k = side·n·r_k
    ∂²D/∂z_k∂z_l = side·(n·r_kl − (t·r_k)·dψ_B/dz_l + n·C_A,sk·ds/dz_l − n·C_B,σk·dσ/dz_l)

with dψ_B/dz_l = ψ_B,l + ψ_B'·dσ/dz_l, and nothing divides by D.

Where thickness varies along the beams the edges lean against the neutral lines (:mod:`cprbm.leaning`).  A place on
either is then closest to a place on the other by |r| − ½t_A(s) − ½t_B(σ): with t and n turned by the angle by which the
edge of B leans, and ψ_A by that of A, all of the above holds as it stands.  D is side·n·r less what ½(t₁+t₂) is more
there than where both beams are thinnest.  Where an edge has a corner that stands out, a row stands too, and the feet of
what faces such a corner stay there.

Beams that lie on each other over a length share any pressure among A's joints.  A is the beam with the longer
elements: rows at the joints of both would ask one element for two curvatures.  At a joint stands the mean gap
over the length of one element of B, and so the force is spread over it: the curvature of B, even over each
element, becomes continuous in the mean, and the steps from one element to the next no longer press or pull.

Where both are clamped together, touching, equilibrium does not say how clamp and contact share the force: the
joints beside the clamp can hardly move, and two chains of unlike elements leave it at different slopes, by a
part of h².  The first m ≈ √N joints have one row together, the mean of theirs, and so an even pressure; the
slopes cost their force a part of 1/m², the pressure's own slope costs (m/N)².

A row is a weighted sum over places.  Its local numbers are the position of one joint of each beam and the angles
of the links around: positions of further joints follow from p_{i+1} = p_i + L_i (cos θ_i, sin θ_i).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from cprbm import leaning, smooth, wells
from cprbm.both import Both, Made, made
from cprbm.brought import as_drawn
from cprbm.contact import Group
from cprbm.crossing import cross
from cprbm.gathering import Touches, gathered, single
from cprbm.kinematics import Positions, State
from cprbm.kinks import kinked, missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.moving import LOCALS, Moving, angle_slopes, moving, position_curvature, position_slopes, tangent_slopes
from cprbm.once import once
from cprbm.pairs import Pressed
from scene import BeamContact, Scene
from scene.answer import Array, Flags, Ints

FOOT_ITERATIONS = 8
CORNER_ITERATIONS = 40  # where edges have corners that stand out, at each of which a step ends
NO_RIDGES = np.zeros(0)
CLOSE = 1e-10  # units of length: a step after which a place is known to round-off
LAST = 0.1  # of that: what the next step would be, shorter by as much again as the last was, where none is taken
CLOSEST_ITERATIONS = 50
PATIENCE = 4  # iterations of Newton's method, after which a minimum may be sought where B has ended
LIPSCHITZ = 1.2  # a way along B's tangent over the arc length of A that makes it, with something to spare
LEAST_CURVATURE = 1e-3  # of D, 1/ℓ: elements that end elsewhere on either beam leave as much in a zone
REACH = 0.1  # minima and ends with gaps wider than this part of the longest beam are no constraints yet
ARCHING = 1.0  # of what the largest force bends one element by: unlike elements of two beams arch by as much
JOINT_REACH = 2.0  # joints with gaps wider than this many h²·(|ψ_A'| + |ψ_B'| + 1/ℓ) are none
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot
SAME = 1e-3  # lengths that differ by less than this part are one
SETTLED = 1e-9  # slope of D at a minimum
STEEP = 1e-3  # slope of D where there is no minimum within CLOSE
BESIDE_END = 0.25  # a joint closer than this many h to where an end of B faces A leaves its place to that

DIP = 1.0 / 32.0  # twice what is derived there, for elements that are not even

STRETCH = 1e-3  # steps in which the length of A that faces one element of B is known
MANY = 27_000  # distances of samples, up to which all are looked at sooner than a tree is made
STRAIGHT = 0.1  # of an element: by less a line is off the chords between its samples
NEAR_END = 4.0  # times as far beyond, by where it leads it is told whether an end has come round another
OBLIQUE = 0.25  # sine of the angle between lines of which one leads past the other's end, whatever their bend
GAUSS = np.polynomial.legendre.leggauss(3)
POINTS, WEIGHTS = 0.5 * (GAUSS[0] + 1.0), 0.25 * GAUSS[1]  # of the mean on either side of a border of B, half of it all

Lines = tuple[smooth.SmoothLine, smooth.SmoothLine]


@dataclass(frozen=True, slots=True)
class Places:
    """Where rows stand on one beam, and their feet on the other.

    Attributes:
        s, sigma: arc lengths on the one beam and on the other (k,).
        keys: of the rows (k,): a joint's number on A, beyond those the ends of B, clamps, and places that are fixed;
            negative where s moves.
    """

    s: Array
    sigma: Array
    keys: Ints

    def joined(self, more: Places) -> Places:
        """With others."""
        return Places(
            np.concatenate((self.s, more.s)),
            np.concatenate((self.sigma, more.sigma)),
            np.concatenate((self.keys, more.keys)),
        )

    def only(self, these: Flags) -> Places:
        """Some of the places."""
        return Places(self.s[these], self.sigma[these], self.keys[these])


@dataclass(frozen=True)
class Pair:
    """Two beams that may touch.

    Attributes:
        name: of the contact.
        a, b: their chains; ``b`` gives tangent and normal.
        side: +1 where A starts on the left of B, −1 on the right.
        across: +1 where B starts on the left of A, −1 on the right.
        offset: ½(t₁+t₂) where the beams are thinnest, zero for lines; units of length.
        unit_length: ℓ, m.
        tapered: whether beams touch by edges that lean against their neutral lines, :mod:`cprbm.leaning`.
        clamps: for the start and the end of A and of B, whether it is clamped together with an end of the other.
        at_home: the same while the bodies that drives lead are where they are drawn.
        own_places: whether minima of D have rows of their own.
        kinks: of A and of B where the contact is in points.
        fixed: whether rows stand there, and no minimum has one of its own.
    """

    name: str
    a: Chain
    b: Chain
    side: float
    across: float
    offset: float
    unit_length: float
    tapered: bool = False
    clamps: tuple[tuple[bool, bool], tuple[bool, bool]] = ((False, False), (False, False))
    at_home: tuple[tuple[bool, bool], tuple[bool, bool]] = ((False, False), (False, False))
    own_places: bool = True
    kinks: tuple[Kinks, ...] = (NO_KINKS, NO_KINKS)
    fixed: bool = False

    @once
    def made(self) -> Made | None:
        """What both beams' lines have in every state."""
        return made(self.a, self.b, self.kinks)

    @once
    def kinked(self) -> bool:
        """Whether either beam has kinks."""
        return any(each.places.size for each in self.kinks)

    def lines(self, state: State, at: Positions) -> Lines:
        """The smooth lines of A and B in a state."""
        return (
            smooth.smooth_line(self.a, self.unit_length, state, at),
            smooth.smooth_line(self.b, self.unit_length, state, at),
        )

    def on_a(self, lines: Lines, s: Array) -> smooth.Points:
        """Points of A at arc lengths ``s`` (k,), bent as its kinks say."""
        return kinked(self.a, self.kinks[0], lines[0].at(s))

    def on_b(self, lines: Lines, sigma: Array) -> smooth.Points:
        """Points of B at arc lengths ``sigma`` (k,), bent as its kinks say."""
        return kinked(self.b, self.kinks[1], lines[1].at(sigma))

    def on_both(self, lines: Lines, s: Array, sigma: Array) -> tuple[smooth.Points, smooth.Points]:
        """Points of A at arc lengths ``s`` (k,) and of B at ``sigma`` (j,), bent as their kinks say."""
        what = self.made
        if what is None:
            return self.on_a(lines, s), self.on_b(lines, sigma)
        known, key = lines[0].known, (self.name, "both")
        both: Both | None = known[key][0] if key in known else None
        if both is None or both.made is not what:
            both = Both(*lines, what, np.concatenate((lines[0].arcs, lines[1].arcs), axis=1))
            known[key] = (both,)
        return both.at(s, sigma)

    def samples(self, lines: Lines) -> tuple[smooth.Points, smooth.Points]:
        """The same at the samples of A and of B, once in a state."""
        if not self.kinked:
            return lines[0].sampled, lines[1].sampled
        known, what = lines[0].known, (self.name, "kinked")
        if what not in known:
            known[what] = tuple(map(kinked, self.chains, self.kinks, (line.sampled for line in lines)))
        A, B = known[what]
        return A, B

    def foot(self, lines: Lines, A: smooth.Points, sigma: Array) -> smooth.Points:
        """Points of B at arc lengths ``sigma`` (k,) with the tangents of the edge that faces A."""
        return self.facing(A, self.on_b(lines, sigma))

    def facing(self, A: smooth.Points, B: smooth.Points) -> smooth.Points:
        """Points of B with the tangents of the edge that faces A."""
        return leaning.facing(self.b, B, self.side, *_seen_from(B, A)) if self.tapered else B

    def beside(self, A: smooth.Points, B: smooth.Points) -> smooth.Points:
        """Points of A with the tangents of the edge that faces B."""
        if not self.tapered:
            return A
        return leaning.leant(self.a, A, -self.side * np.sign(np.cos(A.psi - B.psi)))

    def facing_each_other(self, A: smooth.Points, B: smooth.Points) -> tuple[smooth.Points, smooth.Points]:
        """Points of A and their feet on B with the tangents of the edges that face each other."""
        if not self.tapered:
            return A, B
        B = self.facing(A, B)
        return self.beside(A, B), B

    def wider(self, s: Array, sigma: Array) -> Array | float:
        """By how much ½(t₁+t₂) is more than where both are thinnest, at arc lengths of A and of B."""
        return leaning.half_less(self.a, s) + leaning.half_less(self.b, sigma) if self.tapered else 0.0

    def exchanged(self) -> Pair:
        """The same contact with the parts of A and B exchanged."""
        return self._exchanged

    @once
    def _exchanged(self) -> Pair:
        return replace(
            self,
            a=self.b,
            b=self.a,
            side=self.across,
            across=self.side,
            clamps=self.clamps[::-1],
            at_home=self.at_home[::-1],
            kinks=self.kinks[::-1],
        )

    def brought_to(self, state: State) -> Pair:
        """The same with the bodies that drives lead as good as the ground, if all are where they are drawn."""
        if not as_drawn((self.a.start, self.a.end, self.b.start, self.b.end), state.bodies):
            return self
        return replace(self, a=self.a.at_home, b=self.b.at_home, clamps=self.at_home)

    @property
    def chains(self) -> tuple[Chain, ...]:
        """A and B."""
        return self.a, self.b

    @property
    def shared(self) -> int:
        """m, how many of A's joints beside a clamp of both beams have one row together."""
        return round(math.sqrt(self.a.n))

    @property
    def clamped(self) -> tuple[bool, bool]:
        """Whether A's start and end are clamped in touch with B."""
        return self.clamps[0]

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """Curvature D″ with which A parts from B, at arc lengths ``s``."""
        lines = self.lines(state, at)
        D, sigma, _ = distance_along(self, lines, s)
        return self.parting_at(lines, self.on_a(lines, s), self.on_b(lines, sigma), D)

    def parting_at(self, lines: Lines, A: smooth.Points, B: smooth.Points, D: Array) -> Array:
        """D″ at points of A and the feet of B that face them; between springs the curvature goes evenly."""
        s, sigma = A.s, B.s
        facing = np.sign(np.cos(A.psi - B.psi))
        bend_A, bend_B = (
            np.interp(places, line.chain.s[1:-1], line.sampled.bend[2:-2:2])
            for line, places in zip(lines, (s, sigma), strict=True)
        )
        if not self.tapered:
            return np.asarray(self.side * (facing * bend_A - bend_B / (1.0 - self.side * D * bend_B)))
        # dψ and dσ over ds by the tangents of the edges
        B = self.foot(lines, A, sigma)
        A = self.beside(A, B)
        pace_A, pace_B = A.pace / A.speed, B.pace / B.speed
        along = pace_A / (pace_B - self.side * (D + self.wider(s, sigma)) * bend_B)
        return np.asarray(self.side * pace_A * (facing * bend_A - along * bend_B))

    @property
    def arching(self) -> float:
        """By how much a zone arches at most, of what the largest force can bend one element by."""
        return ARCHING

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the mean thickness, for lines the longest beam; units of length."""
        return self.offset if self.offset > 0.0 else 1.0

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap of the two beams along A and at the ends of B, units of length; infinite where nothing faces A."""
        D, E = self._distances(self.lines(state, at))
        return float(np.min(np.append(D, E), initial=np.inf)) - self.offset

    def gone_round(self, state: State, at: Positions) -> bool:
        """Whether a part of a beam lies beyond the other and has come there round an end."""
        return any(np.any(np.isneginf(distances)) for distances in self._distances(self.lines(state, at), gone=-np.inf))

    def _distances(self, lines: Lines, gone: float = np.inf) -> tuple[Array, Array]:
        """D along A and at the ends of B, infinite where there is no foot, ``gone`` where that is round an end."""
        known, what = lines[0].known, (self.name, "distances")
        if what not in known:
            sampled = _sampled(self, lines)
            ridges = feet_of_ridges(self, lines, *sampled)[0]
            s = np.concatenate((self.a.halves, minima(self, lines, *sampled)[0], ridges))
            ends = self.b.s[[0, -1]]
            D, sigma, foot = distance_along(self, lines, s)
            E, feet, facing = distance_along(self.exchanged(), lines[::-1], ends)
            D, E = np.where(foot, D, np.inf), np.where(facing, E, np.inf)
            known[what] = D, s, sigma, self.wider(s, sigma), E, feet, self.wider(feet, ends)
        D, s, sigma, wider, E, feet, wider_at_ends = known[what]
        return (
            not_gone_round(self, lines, D, s, sigma, wider, gone),
            not_gone_round(self.exchanged(), lines[::-1], E, self.b.s[[0, -1]], feet, wider_at_ends, gone),
        )

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edges touch that touch at arc lengths ``s`` of A, (k, 2), units of length."""
        A, B = self._faced(state, at, s)
        sigma = B.s
        mine, other = self.a.section.thickness_at(s), self.b.section.thickness_at(sigma)
        share = mine / (mine + other)
        return np.stack((A.x + share * (B.x - A.x), A.y + share * (B.y - A.y)), axis=1)

    def slopes(self, state: State, at: Positions, s: Array) -> Array:
        """dD/ds at arc lengths ``s``."""
        A, B = self._faced(state, at, s)
        B = self.facing(A, B)
        return np.asarray(self.side * np.sin(self.beside(A, B).psi - B.psi))

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On A and on B what lies at ``s`` of A."""
        A, B = self._faced(state, at, s)
        return (1.0, s, A.psi), (-1.0, B.s, B.psi)

    def _faced(self, state: State, at: Positions, s: Array) -> tuple[smooth.Points, smooth.Points]:
        """Points of A at arc lengths ``s`` and their feet on B."""
        lines = self.lines(state, at)
        A = self.on_a(lines, s)
        return A, self.on_b(lines, _distance_of(self, lines, A)[1])

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.brought_to(state)._groups(state, at)

    def _groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        lines = self.lines(state, at)
        if self.a.h < self.b.h * (1.0 - SAME):
            turned = self.exchanged()
            return tuple(replace(rows, arc=other) for rows, other in turned._rows(lines[::-1], at))
        return tuple(rows for rows, _ in self._rows(lines, at))

    def _rows(self, lines: Lines, at: Positions) -> list[tuple[Group, Array]]:
        """Rows at A's joints, at minima along A and at both beams' ends; with each group the places on B."""
        along, across = closest_places(self, lines)
        found = self.rows_along(lines, at, along)
        if across.s.size:
            rows = self.exchanged().rows_at(lines[::-1], at, across)
            found.append((replace(rows, arc=across.sigma), across.s))
        return found

    def rows_along(self, lines: Lines, at: Positions, along: Places) -> list[tuple[Group, Array]]:
        """Rows at places of A; with each group the places on B."""
        if not along.s.size:
            return []
        inner = (along.keys > 0) & (along.keys <= self.a.n)
        if not inner.any():
            return [(self.rows_at(lines, at, along), along.sigma)]
        # what touches is worked out in one go: around the joints, and behind that at single places
        joints, single = along.only(inner), along.only(~inner)
        s, sigma, weights = self._around(lines, joints)
        touches = self.touches(
            lines,
            np.concatenate((s.ravel(), single.s)),
            np.concatenate((sigma.ravel(), single.sigma)),
            np.concatenate((np.zeros(s.size, dtype=bool), single.keys < 0)),
        )
        around = touches.only(slice(0, s.size)) if single.s.size else touches
        means, eased = self._mean_rows(at, joints, around, weights), self._eased()
        found = [(replace(rows, values=rows.values - eased), other) for rows, other in means] if eased else means
        if single.s.size:
            found.append((self._single(at, single, touches.only(slice(s.size, None))), single.sigma))
        return found

    def _eased(self) -> float:
        """By how much joints may dip where rows are fixed to places.

        Even curvature in the element of a place moves the line beside it, against the place, by up to V·h³/(64·E·I).
        """
        if not self.fixed:
            return 0.0
        jumps = (np.abs(kinks.behind - kinks.before).max(initial=0.0) for kinks in self.kinks)
        return sum(DIP * float(jump) * chain.h**3 for jump, chain in zip(jumps, self.chains, strict=True))

    def rows_at(self, lines: Lines, at: Positions, places: Places) -> Group:
        """Rows at single places."""
        return self._single(at, places, self.touches(lines, places.s, places.sigma, places.keys < 0))

    def _single(self, at: Positions, places: Places, touches: Touches) -> Group:
        return single(self.name, (self.a, self.b), touches, places.keys, places.s)

    def _mean_rows(self, at: Positions, joints: Places, touches: Touches, weights: Array) -> list[tuple[Group, Array]]:
        """Rows of the mean gap around joints of A, ``weights`` (m, q); those next to a clamp of both beams in one."""
        (m, q), chains = weights.shape, (self.a, self.b)
        number, alone, found = np.arange(m * q).reshape(m, q), np.ones(m, dtype=bool), []
        for key, beside in self._beside_clamps(joints.keys):
            alone[beside] = False
            tied = touches.only(number[beside].ravel())
            shares = weights[beside].reshape(1, -1) / len(beside)
            arc, other = np.mean(joints.s[beside], keepdims=True), np.mean(joints.sigma[beside], keepdims=True)
            rows = gathered(self.name, chains, at, tied, shares, np.array([key]), arc)
            found.append((replace(rows, reach=0.5 * float(np.ptp(joints.s[beside]))), other))
        if not found:
            return [(gathered(self.name, chains, at, touches, weights, joints.keys, joints.s), joints.sigma)]
        if np.any(alone):
            rest = joints.only(alone)
            own = touches.only(number[alone].ravel())
            found.append((gathered(self.name, chains, at, own, weights[alone], rest.keys, rest.s), rest.sigma))
        return found

    def _around(self, lines: Lines, joints: Places) -> tuple[Array, Array, Array]:
        """Places on A and on B and weights (m, 6) of the mean over one element of B around each joint of A.

        Gauss's points on either side of the border of B's elements that lies within, where the curvature steps.
        """
        s, sigma = joints.s, joints.sigma
        A, B = self.on_both(lines, s, sigma)
        if self.tapered:
            B = self.facing(A, B)
        ratio = (B.pace - B.bend * _seen_from(B, A)[1]) / (np.cos(A.psi - B.psi) * A.speed)  # ds/dσ
        borders = self.b.borders
        after = np.minimum(np.maximum(borders.searchsorted(sigma), 1), self.b.n)
        # the length on A in steps, so that it does not change with the state where it is differentiated
        stretch = np.rint(np.abs(ratio) / STRETCH) * STRETCH
        ahead, behind = borders[after] - sigma, borders[after - 1] - sigma
        cut = np.where(ahead < -behind, ahead, behind) * ratio
        if self.tapered:  # beside a corner of B's edge D is less even than at a border: a length that stays, cut midway
            cornered = _beside_any(self.b.section.corners, sigma, self.b.sizes[after - 1])
            stretch, cut = np.where(cornered, 1.0, stretch), np.where(cornered, 0.0, cut)
        half = 0.5 * np.minimum(self.b.sizes[after - 1] * stretch, self.a.sizes[joints.keys - 1])[:, None]
        cut = np.minimum(np.maximum(cut[:, None], -half), half)
        off = np.concatenate(((cut + half) * POINTS - half, (half - cut) * POINTS + cut), axis=1)
        share = cut / half
        weights = np.concatenate(((1.0 + share) * WEIGHTS, (1.0 - share) * WEIGHTS), axis=1)
        at_A = s[:, None] + off
        guess = (sigma[:, None] + off / ratio[:, None]).ravel()
        at_B = _feet_from(self, lines, *self.on_both(lines, at_A.ravel(), guess), CLOSE)[1].reshape(at_A.shape)
        # beside an end of B, where it faces no element of B, the joint alone
        alone = (at_B <= 0.0) | (at_B >= self.b.s[-1])
        if alone.any():
            these = alone.any(axis=1)
            at_A[these], at_B[these] = s[these, None], sigma[these, None]
        return at_A, at_B, weights

    def _beside_clamps(self, keys: Ints) -> list[tuple[int, Ints]]:
        """For every end of A that is clamped with B: the key of the row there, and which joints share it."""
        m = self.shared
        found: list[tuple[int, Ints]] = []
        for end, clamped in enumerate(self.clamps[0]):
            if not clamped:
                continue
            beside = (keys if end == 0 else self.a.n + 1 - keys) <= 2 * m
            # joints on both sides of the row's end lie close, or the beams part before
            if np.sum(beside) == 2 * m < self.a.n:
                these = np.flatnonzero(beside)
                found.append((self.a.n + 4 + end, these[:m] if end == 0 else these[m:]))
        return found

    def touches(self, lines: Lines, s: Array, sigma: Array, free: Flags) -> Touches:
        """The constraint at feet (s, σ); where ``free`` (k,) the place moves with the minimum."""
        A, B = self.facing_each_other(*self.on_both(lines, s, sigma))
        m = len(s)
        cos, sin = np.cos(B.psi), np.sin(B.psi)
        normals = np.empty((2 * m, 2))
        normals[:m, 0], normals[:m, 1] = -sin, cos
        normals[m:] = normals[:m]
        distance = cos * (A.y - B.y) - sin * (A.x - B.x)
        both = moving(A, B)
        n_r = _between(position_slopes(both, normals))
        # what D gains over s by the tangents' γ, the foot going along
        gained: Array | float = 0.0
        if self.kinked:
            more_A, more_B = missed(self.a, self.kinks[0], A), missed(self.b, self.kinks[1], B)
            facing = np.cos(A.psi - B.psi)
            back = (-B.pace + distance * B.bend) / (facing * A.pace)
            if self.tapered:  # no tangents of B's go along what stays at a corner
                back[leaning.at_corner(B)] = 0.0
            gained = np.sign(facing) * (more_A.integral + back * more_B.integral)

        def bent(some: Ints) -> Array:
            return self._bent(A.only(some), B.only(some), both.only(np.concatenate((some, m + some))), free[some])

        return Touches(
            values=self.offset + self.wider(s, sigma) - self.side * (distance + gained),
            slopes=-self.side * n_r,
            bent=bent,
            links=np.array((A.link, B.link)),
        )

    def _bent(self, A: smooth.Points, B: smooth.Points, both: Moving, free: Flags) -> Array:
        """∂²c/∂z² (m, 10, 10) at places of A and their feet on B, ``both`` of which move as that says."""
        m, k = len(A.s), LOCALS
        cos, sin = np.cos(B.psi), np.sin(B.psi)
        normals, tangents = np.empty((2, 2 * m, 2))
        normals[:m, 0], normals[:m, 1] = -sin, cos
        normals[m:] = normals[:m]
        tangents[:, 0], tangents[:, 1] = normals[:, 1], -normals[:, 0]
        distance = cos * (A.y - B.y) - sin * (A.x - B.x)
        facing, of_foot = np.cos(A.psi - B.psi), -B.pace + distance * B.bend
        # ds/dz and dσ/dz from (i) and (ii)
        psi_A, psi_B = psi_z = np.zeros((2, m, 2 * k))
        psi = leaning.angle_slopes(both, np.concatenate((A.lead, B.lead))) if self.tapered else angle_slopes(both)
        psi_z[0, :, :k], psi_z[1, :, k:] = psi[:m], psi[m:]
        t_r = _between(position_slopes(both, tangents))
        one, two = -(psi_A - psi_B), -(t_r + distance[:, None] * psi_B)
        determinant = np.where(free, A.bend * of_foot + B.bend * facing * A.pace, 1.0)
        s_z = np.where(free[:, None], of_foot[:, None] * one + B.bend[:, None] * two, 0.0) / determinant[:, None]
        sigma_z = (two - (facing * A.pace)[:, None] * s_z) / of_foot[:, None]
        turning = psi_B + B.bend[:, None] * sigma_z
        second = np.zeros((m, 2 * k, 2 * k))
        curved, n_s = position_curvature(both, normals), tangent_slopes(both, normals)
        second[:, :k, :k], second[:, k:, k:] = curved[:m], -curved[m:]
        second += -t_r[:, :, None] * turning[:, None, :]
        second[:, :k] += n_s[:m, :, None] * s_z[:, None, :]
        second[:, k:] -= n_s[m:, :, None] * sigma_z[:, None, :]
        # γ leaves a part of its own size uneven
        return np.asarray(-self.side * 0.5 * (second + second.transpose(0, 2, 1)))


def _between(slopes: Array) -> Array:
    """Those of what is between places of A and places of B (m, 10), from their own (2m, 5)."""
    m = len(slopes) // 2
    return np.concatenate((slopes[:m], -slopes[m:]), axis=1)


def _beside_any(corners: Array, sigma: Array, size: Array) -> Flags:
    """Which places ``sigma`` (k,) lie within a ``size`` (k,) of one of the ``corners`` (j,)."""
    return np.asarray(np.any(np.abs(sigma[:, None] - corners) <= size[:, None], axis=1))


def distance_along(pair: Pair, lines: Lines, s: Array) -> tuple[Array, Array, Flags]:
    """Signed distance D of A from B at arc lengths ``s``: D, σ (k,), and whether a foot exists (k,)."""
    return _distance_of(pair, lines, pair.on_a(lines, s))


def _distance_of(pair: Pair, lines: Lines, A: smooth.Points) -> tuple[Array, Array, Flags]:
    """The same of points of A (k,)."""
    nearest = nearest_samples(lines[1].sampled, A, np.inf)[1]
    return _feet_from(pair, lines, A, pair.samples(lines)[1].only(nearest), CLOSE)[:3]


def past_foot(pair: Pair, lines: Lines, s: Array, sigma: Array) -> Array:
    """How far beyond their feet σ (k,) points of A at arc lengths ``s`` (k,) lie along B: nothing but at its ends."""
    A = pair.on_a(lines, s)
    return _seen_from(pair.foot(lines, A, sigma), A)[0]


def feet_near(
    pair: Pair, lines: Lines, A: smooth.Points, sigma: Array, close: float = CLOSE
) -> tuple[Array, Array, Flags]:
    """D, σ and whether there is a foot, by Newton's method on (i) from the guess ``sigma`` to steps as ``close``."""
    return _feet_from(pair, lines, A, pair.on_b(lines, sigma), close)[:3]


def _feet_from(
    pair: Pair, lines: Lines, A: smooth.Points, B: smooth.Points, close: float
) -> tuple[Array, Array, Flags, smooth.Points]:
    """The same from points of B (k,), and the points of B to which D belongs."""
    sigma, h, end, last = B.s, pair.b.h, pair.b.s[-1], 0.0
    ridges = pair.b.section.ridges if pair.tapered else NO_RIDGES
    for iteration in range(FOOT_ITERATIONS if not ridges.size else CORNER_ITERATIONS):
        B = pair.on_b(lines, sigma) if iteration else B
        B = pair.facing(A, B) if pair.tapered else B
        along, across = _seen_from(B, A)
        # along the circle of curvature, where that is round the foot
        left = along / np.maximum(B.pace - B.bend * across, 0.2)
        turn = B.bend * left
        step = left / (1.0 + turn * turn / 3.0)
        before = sigma
        sigma = np.minimum(np.maximum(before + np.minimum(np.maximum(step, -h), h), 0.0), end)
        if ridges.size:
            sigma = _up_to(ridges, before, sigma)
        moved = float(np.maximum.reduce(np.abs(sigma - before)))
        if moved < close or (not ridges.size and moved * moved < LAST * close * last):
            break
        last = moved
    foot = np.abs(along) <= PARALLEL * np.maximum(np.abs(across), pair.b.h)
    return pair.side * across - (pair.wider(A.s, sigma) if pair.tapered else 0.0), sigma, foot, B


def _up_to(ridges: Array, before: Array, after: Array) -> Array:
    """Places ``after`` (k,), but the first of the ``ridges`` (j,) where one lies between them and those ``before``."""
    fenced = np.concatenate(([-np.inf], ridges, [np.inf]))
    low = fenced[np.searchsorted(ridges, before, side="left")]
    high = fenced[np.searchsorted(ridges, before, side="right") + 1]
    return np.minimum(np.maximum(after, low), high)


def _seen_from(B: smooth.Points, A: smooth.Points) -> tuple[Array, Array]:
    """t·r and n·r of points of A in the frames of points of B, (k,) each."""
    rx, ry = A.x - B.x, A.y - B.y
    cos, sin = np.cos(B.psi), np.sin(B.psi)
    return cos * rx + sin * ry, cos * ry - sin * rx


def closest_places(pair: Pair, lines: Lines) -> tuple[Places, Places]:
    """Where rows stand on A, and on B with the beams' parts exchanged."""
    ends = _facing_ends(pair, lines)
    return places_along(pair, lines, *_sampled(pair, lines), ends.sigma), ends


def places_along(pair: Pair, lines: Lines, D: Array, sigma: Array, ends: Array) -> Places:
    """Where rows stand on A, from D and the feet at its samples (2N+3,), and from where ``ends`` of B face it."""
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    if pair.fixed:
        s = pair.kinks[0].places
        turned = distance_along(pair, lines, s)[1]
    else:
        s, turned = minima(pair, lines, D, sigma)

    near = np.zeros(a.n + 2, dtype=bool)
    facing = np.isfinite(D[::2]).nonzero()[0]
    if facing.size:
        A, B = _faced(pair, lines, D, sigma, facing)
        bends = np.abs(A.bend) + np.abs(B.bend)
        near[facing] = D[2 * facing] - pair.offset < JOINT_REACH * a.h**2 * (1.0 + bends)
    for places, apart in ((s, wells.BESIDE), (ends, BESIDE_END)):
        if places.size:
            away = np.abs(a.s[1:-1, None] - places)
            near[1:-1] &= (away > apart * a.size_at(places)).all(axis=1)
    for end in (0, -1):
        near[end] = reach > D[end] and not held_together(a, b, end, float(sigma[end]))
    joints = near.nonzero()[0]
    own = a.n + 6 + np.arange(len(s)) if pair.fixed else np.zeros(len(s), dtype=np.intp) - 1
    keys = np.concatenate((joints, own))
    found = Places(np.concatenate((a.s[joints], s)), np.concatenate((sigma[2 * joints], turned)), keys)
    return found.joined(_corners(pair, lines, D, sigma)) if pair.tapered and a.section.ridges.size else found


def _corners(pair: Pair, lines: Lines, D: Array, sigma: Array) -> Places:
    """Where corners of A's edge stand out within reach, unless a joint has a row there, and their feet on B."""
    a = pair.a
    s, E, feet, number = feet_of_ridges(pair, lines, D, sigma)
    near = (pair.offset + REACH > E) & (np.min(np.abs(s[:, None] - a.s), axis=1) > SAME * a.h)
    # behind the keys of places that are fixed
    return Places(s[near], feet[near], a.n + 6 + len(pair.kinks[0].places) + number[near])


def feet_of_ridges(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array, Array, Ints]:
    """Corners of A's edge that stand out and face B: s, D, σ and which they are (k,), from D and σ at A's samples."""
    ridges, known = pair.a.section.ridges if pair.tapered else NO_RIDGES, np.isfinite(D)
    samples = pair.a.halves
    behind = np.searchsorted(samples, ridges)
    number = np.flatnonzero(known[behind - 1] & known[behind])
    if not number.size:
        return NO_RIDGES, NO_RIDGES, NO_RIDGES, number
    s = ridges[number]
    E, feet, foot = feet_near(pair, lines, pair.on_a(lines, s), np.interp(s, samples[known], sigma[known]))
    return s[foot], E[foot], feet[foot], number[foot]


def _facing_ends(pair: Pair, lines: Lines) -> Places:
    """The ends of B that face A within reach, and their feet on A; the keys follow A's joints."""
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    (A, B), ends = pair.samples(lines), b.s[[0, -1]]
    away = np.hypot(A.x - B.x[[0, -1], None], A.y - B.y[[0, -1], None])
    nearest = away.argmin(axis=1)
    near = (away[[0, 1], nearest] < reach + a.h).nonzero()[0]
    if near.size and not pair.tapered:
        # what is beyond an end of A has its foot there
        beyond = _seen_from(A.only(nearest[near]), B.only(near * (2 * b.n + 2)))[0]
        first, last = nearest[near] == 0, nearest[near] == len(A.s) - 1
        near = near[~((first & (beyond <= 0.0)) | (last & (beyond >= 0.0)))]
    if not near.size:
        return Places(np.zeros(0), np.zeros(0), near)
    turned = pair.exchanged()
    at_B = B.only(near * (2 * b.n + 2))
    E, foot, facing, _ = _feet_from(turned, lines[::-1], at_B, A.only(nearest[near]), CLOSE)
    E = not_gone_round(turned, lines[::-1], E, ends[near], foot, pair.wider(foot, ends[near]))
    facing &= (foot > SAME * a.h) & (foot < a.s[-1] - SAME * a.h) & (reach > E)
    for i, end in enumerate(near):
        facing[i] &= not held_together(b, a, int(-end), float(foot[i]))
    return Places(ends[near][facing], foot[facing], a.n + 2 + near[facing])


def _faced(pair: Pair, lines: Lines, D: Array, sigma: Array, joints: Ints) -> tuple[smooth.Points, smooth.Points]:
    """Some joints of A, by their numbers (k,), and their feet, ``D`` and ``sigma`` being those of A's samples."""
    known, what = lines[0].faced, pair.name
    if what not in known or known[what][0] is not D:
        known[what] = D, pair.samples(lines)[0].only(2 * joints), pair.on_b(lines, sigma[2 * joints])
    return known[what][1:]


def held_together(one: Chain, other: Chain, end: int, foot: float) -> bool:
    """Whether an end of ``one`` and what its foot on ``other`` lies on move with one body: their gap is no unknown."""
    mine = one.start if end == 0 else one.end
    if mine is None:
        return False
    first, last = other.s[1], other.s[-1] - other.s[-2]
    for its, away, half in ((other.start, foot, first), (other.end, other.s[-1] - foot, last)):
        if its is None or its.frame != mine.frame:
            continue
        # a welded end moves with the body as far as its half element hardly bends
        if away <= (half if its.welded and mine.welded else SAME * half):
            return True
    return False


def _sampled(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    """D at the joints of A and half-way between them, infinite where it is out of reach, and σ, (2N+3,) each."""
    known, what = lines[0].known, (pair.name, "samples")
    if what not in known:
        known[what] = _sampled_anew(pair, lines)
    D, sigma = known[what]
    return D, sigma


def nearest_samples(G: smooth.Points, A: smooth.Points, within: float) -> tuple[Array, Ints]:
    """Distance from points of ``A`` (k,) to the nearest of ``G`` (m,), infinite beyond ``within``; its number."""
    return nearest_places((G.x, G.y), (A.x, A.y), within)


def nearest_places(G: tuple[Array, Array], A: tuple[Array, Array], within: float) -> tuple[Array, Ints]:
    """The same of places by their x and y, (m,) and (k,) each."""
    if G[0].size * A[0].size <= MANY:
        apart, across = A[0][:, None] - G[0], A[1][:, None] - G[1]
        apart *= apart
        across *= across
        apart += across
        number = apart.argmin(axis=1)
        distance = np.sqrt(np.minimum.reduce(apart, axis=1))
        return np.where(distance < within, distance, np.inf), number
    from scipy.spatial import cKDTree  # loaded where beams with many links may touch each other

    # places follow each other along lines: a tree that is not levelled is soon made and soon gone through
    tree = cKDTree(np.array(G).T, balanced_tree=False, compact_nodes=False)
    distance, number = tree.query(np.array(A).T, distance_upper_bound=within)
    return np.asarray(distance), np.asarray(number)


def _sampled_anew(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    A, G = pair.samples(lines)
    # far parts are left out by their distance from B's samples, which no foot can undercut by more than h
    rough, nearest = nearest_samples(G, A, pair.offset + reach(pair.a, pair.b))
    close = np.isfinite(rough).nonzero()[0]
    sigma = np.zeros(len(A.s))
    D = sigma + np.inf
    if not close.size:
        return D, sigma
    at_A, at_B = A.only(close), G.only(nearest[close])
    distance, sigma[close], foot, at_B = _feet_from(pair, lines, at_A, at_B, CLOSE)
    D[close[foot]] = distance[foot]
    D = not_gone_round(pair, lines, D, A.s, sigma, pair.wider(A.s, sigma))
    if not pair.tapered:  # else these are points of edges
        joints = ((close % 2 == 0) & np.isfinite(D[close])).nonzero()[0]
        lines[0].faced[pair.name] = D, at_A.only(joints), at_B.only(joints)
    return D, sigma


def not_gone_round(
    pair: Pair, lines: Lines, D: Array, s: Array, sigma: Array, wider: Array | float, gone: float = np.inf
) -> Array:
    """D, but ``gone`` where A lies beyond B and has not come there through it, but round an end.

    What lies beyond by less than lines are off their chords, as where they overlap, has come round an end if it leads
    past that at an angle.  What goes through B by no more than that beside an end counts as round it: of that the row
    of the end tells, and chords beside a side that touches an end may cross there.  Of an end of A beside one of B no
    other row tells: there it counts as through it, but farther beyond if it leads past the end.

    Args:
        pair, lines: the beams.
        D: at places of A (k,), infinite where there is no foot.
        s, sigma: these places and their feet (k,).
        wider: by how much they are thicker there than where they are thinnest (k,).
        gone: what D is there.
    """
    off, beyond_it = STRAIGHT * (pair.a.h + pair.b.h), -(D + 2.0 * wider + pair.offset)
    if not (beyond_it > 0.0).any():
        return D
    came_round = beyond_it > off
    if came_round.any():
        came_round &= not cross(*(_without_ends(line.sampled, off) for line in lines))
    end, own_end = pair.b.s[-1], (s == 0.0) | (s == pair.a.s[-1])
    beside = (beyond_it > np.where(own_end, off, 0.0)) & (beyond_it <= np.where(own_end, NEAR_END * off, off))
    beside &= np.minimum(sigma, end - sigma) < off * (1.0 + 1.0 / OBLIQUE)
    if beside.any():
        turned = pair.on_a(lines, s[beside]).psi - pair.on_b(lines, sigma[beside]).psi
        rise, within = pair.side * np.sin(turned), np.where(own_end[beside], 0.0, off)
        oblique = np.abs(rise) > OBLIQUE
        reached = sigma[beside] - D[beside] * np.cos(turned) / np.where(oblique, rise, 1.0)
        outside = (reached < within) | (reached > end - within)
        came_round[beside] = np.where(oblique, outside, came_round[beside])
    return np.where(came_round, gone, D)


def _without_ends(sampled: smooth.Points, off: float) -> Array:
    """Places of a line (k, 2) that begins and ends ``off`` from its ends."""
    s = np.clip(sampled.s, off, max(off, sampled.s[-1] - off))
    return np.stack((np.interp(s, sampled.s, sampled.x), np.interp(s, sampled.s, sampled.y)), axis=1)


def minima(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array]:
    """(s, σ) of the minima of D within A that have a place of their own, from its samples.

    Newton's method on dD/ds = 0 and on (i), kept between the samples beside the lowest: where the curvature jumps
    it alone would not settle.
    """
    known, what = lines[0].known, (pair.name, "minima" if pair.own_places else "none")
    if what not in known or known[what][0] is not D:
        known[what] = D, *_minima_anew(pair, lines, D, sigma)
    _, s, sigma = known[what]
    return s, sigma


def _minima_anew(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array]:
    s, lowest = pair.a.halves, wells.lowest(D, pair.offset + REACH)
    if not lowest.size:
        return np.zeros(0), np.zeros(0)
    # the joints beside a common clamp press together, a place of its own among them would part them
    first, last = [4 * pair.shared if clamped else 0 for clamped in pair.clamped]
    lowest = lowest[pair.own_places & (lowest > first) & (lowest < 2 * (pair.a.n + 1) - last)]
    if not lowest.size:
        return np.zeros(0), np.zeros(0)
    parting, near = np.zeros(pair.a.n + 2) + np.inf, np.isfinite(D[::2]).nonzero()[0]
    parting[near] = pair.parting_at(lines, *_faced(pair, lines, D, sigma, near), D[2 * near])
    found = wells.wells(pair.a, D - pair.offset, parting, lowest, LEAST_CURVATURE, pair.kinks[0].places)
    if not found.samples.size:
        return np.zeros(0), np.zeros(0)
    before, here, behind = found.samples - 1, found.samples, found.samples + 1
    low, high = s[before], s[behind]
    ahead = wells.lowest_of_parabola(s, D, here)
    beside = np.where(ahead > 0.0, behind, before)
    share = ahead / (s[beside] - s[here])
    # where no parabola goes through, the middle one's foot
    sigma = np.where(ahead == 0.0, sigma[here], sigma[here] + share * (sigma[beside] - sigma[here]))
    s = s[here] + ahead
    ridges = pair.b.section.ridges if pair.tapered else NO_RIDGES
    end, latest = pair.b.s[-1], np.zeros(len(s))
    for iteration in range(CLOSEST_ITERATIONS):
        A, B = pair.facing_each_other(*pair.on_both(lines, s, sigma))
        along, across = _seen_from(B, A)
        turned = A.psi - B.psi
        facing, shortened = np.cos(turned), B.pace - B.bend * across
        # what is left to the foot, and the slope there
        left = along / shortened
        slope = pair.side * (np.sin(turned) - facing * B.bend * left)
        towards = facing * A.pace / shortened  # dσ/ds
        bends = pair.side * facing * (A.bend - B.bend * towards)
        convex, falls = bends > LEAST_CURVATURE, slope < 0.0
        low, high = np.where(falls, s, low), np.where(falls, high, s)
        ahead = s - slope / np.where(convex, bends, np.inf)
        newton = convex & (ahead >= low) & (ahead <= high)
        step = (ahead if newton.all() else np.where(newton, ahead, 0.5 * (low + high))) - s
        ahead = np.minimum(np.maximum(sigma + left + towards * step, 0.0), end)
        if ridges.size:
            ahead = np.where(leaning.at_corner(B), sigma, _up_to(ridges, sigma, ahead))
        moved = np.maximum(np.abs(step), np.abs(ahead - sigma))
        s, sigma = s + step, ahead
        inner = (sigma > 0.0) & (sigma < end)
        # what Newton's method would leave after one more step is nothing
        known = newton & inner & (moved * moved < LAST * CLOSE * latest)
        if known.all():
            break
        there = known | ((np.abs(step) < CLOSE) & (np.abs(along) < CLOSE) & (np.abs(slope) < SETTLED))
        if not ridges.size:  # no slope as steep as that goes through zero in so little
            there |= (high - low < CLOSE) & (np.abs(slope) > STEEP)
            if iteration > PATIENCE:
                there |= _beyond_ends(pair.b, B.s, along, high - low) & (shortened > 0.0)
        if there.all():
            break
        latest = moved
    held = found.held(pair.side * across - pair.wider(s, sigma) - pair.offset)
    # beyond an end of B there is no foot: what lies there faces that end, which has a row of its own
    settled = held & convex & (known | ((np.abs(slope) < SETTLED) & (inner | (np.abs(along) < SETTLED))))
    return s[settled], sigma[settled]


def _beyond_ends(b: Chain, sigma: Array, along: Array, within: Array) -> Flags:
    """Which places of A lie so far beyond an end of B that no other place ``within`` as much (k,) of A has a foot."""
    out = np.where(sigma <= 0.0, -along, np.where(sigma >= b.s[-1], along, -np.inf))
    return np.asarray(out > LIPSCHITZ * within)


def reach(one: Chain, other: Chain) -> float:
    """Gap of two beams beyond which there are no rows, units of length."""
    return REACH + one.h + other.h


def pair_of(scene: Scene, model: Model, name: str, fit: Fit = EVEN) -> Pair:
    """One of the scene's contacts, its sides those of the stress-free state."""
    contact = scene.contacts[name]
    assert isinstance(contact, BeamContact)
    a, b = (model.chain(beam) for beam in contact.between)
    thinnest = float(a.section.thickness.min()), float(b.section.thickness.min())
    standing = model.outset.standing[name]
    return Pair(
        name=name,
        a=a,
        b=b,
        side=standing.side,
        across=standing.across,
        offset=0.5 * sum(thinnest) if contact.thick else 0.0,
        unit_length=model.unit_length,
        tapered=contact.thick and (a.thickness, b.thickness) != thinnest,
        clamps=standing.clamps,
        at_home=standing.clamps if (a.at_home, b.at_home) == (a, b) else model.outset.at_home[name].clamps,
        kinks=fit.kinks.get(name, (NO_KINKS, NO_KINKS)),
        fixed=name in fit.fixed,
    )
