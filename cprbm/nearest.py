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

What has come round an end of B to its other side may touch that: where parts lie clear beyond and the lines do not
cross, rows of the same kind stand with the other ``side``, and of what faces the ends with the other ``across``, as
each of them says by itself.  Lines without thickness do not tell their sides apart where they touch, and have one.

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

from cprbm import leaning, smooth
from cprbm.both import Both, Made, made
from cprbm.brought import as_drawn
from cprbm.closest import (
    SAME,
    Places,
    clear,
    clear_beyond,
    closest_places,
    crossing,
    minima,
    not_gone_round,
    on_either_side,
    sampled_distances,
)
from cprbm.feet import CLOSE, Lines, distance_along, distance_of, feet_from, feet_of_ridges, seen_from
from cprbm.first_contact import Group, Sides
from cprbm.gathering import Touches, gathered, single
from cprbm.kinematics import Positions, State
from cprbm.kinks import kinked, missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.moving import LOCALS, Moving, angle_slopes, moving, position_curvature, position_slopes, tangent_slopes
from cprbm.once import once
from cprbm.pairs import Pressed
from cprbm_scene import BeamContact, Scene
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.clearance import overlap_at_rest

ARCHING = 1.0  # of what the largest force bends one element by: unlike elements of two beams arch by as much
DIP = 1.0 / 32.0  # twice what is derived there, for elements that are not even
STRETCH = 1e-3  # steps in which the length of A that faces one element of B is known
DEEP = 0.125  # of what lies clear: chords that are off by less tell whether lines cross
BEHIND = 1 << 40  # between the keys of rows of the one side and of the other
GAUSS = np.polynomial.legendre.leggauss(3)
POINTS, WEIGHTS = 0.5 * (GAUSS[0] + 1.0), 0.25 * GAUSS[1]  # of the mean on either side of a border of B, half of it all


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
        seen: whether A lies where that tells ``side`` at rest, and B; else that is a guess, :mod:`cprbm.sighting`.
        behind: whether these are the other sides of both, which only what has come round an end can touch.
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
    seen: tuple[bool, bool] = (True, True)
    behind: bool = False

    @once
    def known_as(self) -> str:
        """What is found along lines is kept by that name."""
        return f"{self.name} {self.side:+.0f}{self.across:+.0f}{' from behind' * self.behind}"

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
        return leaning.facing(self.b, B, self.side, *seen_from(B, A)) if self.tapered else B

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
            seen=self.seen[::-1],
        )

    def sighted(self, sides: Sides) -> Pair:
        """The same with those ``sides`` that have been seen."""
        flipped = [theirs == -mine for mine, theirs in zip((self.side, self.across), sides, strict=True)]
        return self._flipped[2 * flipped[0] + flipped[1]] if any(flipped) else self

    @once
    def _flipped(self) -> tuple[Pair, ...]:
        """The contact, that with the other ``across``, with the other ``side``, and with both."""
        return tuple(replace(self, side=a * self.side, across=b * self.across) for a in (1, -1) for b in (1, -1))

    @once
    def other_sides(self) -> Pair:
        """The contact of what has come round an end to the other side."""
        nowhere = ((False, False), (False, False))
        return replace(
            self, side=-self.side, across=-self.across, clamps=nowhere, at_home=nowhere, behind=not self.behind
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
        A, B, wider = self.on_a(lines, s), self.on_b(lines, sigma), self.wider(s, sigma)
        found, behind = self.parting_at(lines, A, B, D), self.offset > 0.0 and clear_beyond(self, D, wider)
        if np.any(behind):
            found = np.where(behind, self.other_sides.parting_at(lines, A, B, -D - 2.0 * wider), found)
        return found

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
        lines = self.lines(state, at)
        found = np.concatenate(self._distances(lines, gone=-np.inf))
        beside = found[~np.isneginf(found)]
        if self.offset > 0.0 and beside.size < found.size:
            beside = np.concatenate((beside, *self.other_sides._distances(lines)))
        return float(np.min(beside, initial=np.inf)) - self.offset

    def gone_round(self, state: State, at: Positions) -> bool:
        """Whether a part of a beam lies beyond the other and has come there round an end."""
        return any(np.any(np.isneginf(distances)) for distances in self._distances(self.lines(state, at), gone=-np.inf))

    def crossed(self, state: State, at: Positions) -> bool:
        """Whether the neutral lines cross, by more than an eighth of what A lies clear by on the other side."""
        return crossing(self.lines(state, at), DEEP * clear(self))

    def _distances(self, lines: Lines, gone: float = np.inf) -> tuple[Array, Array]:
        """D along A and at the ends of B, infinite where there is no foot, ``gone`` where that is round an end."""
        known, what = lines[0].known, (self.known_as, "distances")
        if what not in known:
            sampled = sampled_distances(self, lines)
            ridges = feet_of_ridges(self, lines, *sampled)[0]
            s = np.concatenate((self.a.halves, minima(self, lines, *sampled)[0], ridges))
            ends = self.b.s[[0, -1]]
            D, sigma, foot = distance_along(self, lines, s)
            E, feet, facing = distance_along(self.exchanged(), lines[::-1], ends)
            if not self.offset:  # where a line comes round an end its samples say so
                raw = on_either_side(self, lines)[0]
                foot[: len(raw)] &= ~(np.isinf(sampled[0]) & np.isfinite(raw) & (raw > -clear(self)))
            D, E = np.where(foot, D, np.inf), np.where(facing, E, np.inf)
            known[what] = D, self.wider(s, sigma) + np.zeros_like(D), E, self.wider(feet, ends) + np.zeros_like(E)
        D, wider, E, wider_at_ends = known[what]
        return (
            not_gone_round(self, lines, D, wider, gone),
            not_gone_round(self.exchanged(), lines[::-1], E, wider_at_ends, gone),
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
        return A, self.on_b(lines, distance_of(self, lines, A)[1])

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.brought_to(state)._groups(state, at)

    def _groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        lines = self.lines(state, at)
        if self.a.h < self.b.h * (1.0 - SAME):
            turned = self.exchanged()
            return tuple(replace(rows, arc=other) for rows, other in turned._both_sides(lines[::-1], at))
        return tuple(rows for rows, _ in self._both_sides(lines, at))

    def _both_sides(self, lines: Lines, at: Positions) -> list[tuple[Group, Array]]:
        """Rows on the sides on which the beams lie at rest, and of what has come round an end."""
        along, across, gone = closest_places(self, lines)
        found = self._rows(lines, at, along, across)
        if gone and self.offset > 0.0:
            other = self.other_sides
            behind = other._rows(lines, at, *closest_places(other, lines)[:2])
            found += [(replace(rows, keys=_behind(rows.keys)), places) for rows, places in behind]
        return found

    def _rows(self, lines: Lines, at: Positions, along: Places, across: Places) -> list[tuple[Group, Array]]:
        """Rows at A's joints, at minima along A and at both beams' ends; with each group the places on B."""
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
        ratio = (B.pace - B.bend * seen_from(B, A)[1]) / (np.cos(A.psi - B.psi) * A.speed)  # ds/dσ
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
        at_B = feet_from(self, lines, *self.on_both(lines, at_A.ravel(), guess), CLOSE)[1].reshape(at_A.shape)
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


def _behind(keys: tuple[int, ...]) -> tuple[int, ...]:
    """Other keys of rows, again negative where a place moves."""
    return tuple([key + BEHIND if key >= 0 else key - 1 for key in keys])


def _between(slopes: Array) -> Array:
    """Those of what is between places of A and places of B (m, 10), from their own (2m, 5)."""
    m = len(slopes) // 2
    return np.concatenate((slopes[:m], -slopes[m:]), axis=1)


def _beside_any(corners: Array, sigma: Array, size: Array) -> Flags:
    """Which places ``sigma`` (k,) lie within a ``size`` (k,) of one of the ``corners`` (j,)."""
    return np.asarray(np.any(np.abs(sigma[:, None] - corners) <= size[:, None], axis=1))


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
        offset=0.5 * sum(thinnest) - overlap_at_rest(scene, contact) / model.unit_length if contact.thick else 0.0,
        unit_length=model.unit_length,
        tapered=contact.thick and (a.thickness, b.thickness) != thinnest,
        clamps=standing.clamps,
        at_home=standing.clamps if (a.at_home, b.at_home) == (a, b) else model.outset.at_home[name].clamps,
        kinks=fit.kinks.get(name, (NO_KINKS, NO_KINKS)),
        fixed=name in fit.fixed,
        seen=standing.seen,
    )
