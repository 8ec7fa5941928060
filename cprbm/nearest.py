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
from scipy.spatial import cKDTree

from cprbm import smooth, wells
from cprbm.contact import Group
from cprbm.crossing import cross
from cprbm.gathering import Touches, gathered
from cprbm.kinematics import Positions, State, positions, rest_state
from cprbm.kinks import kinked, missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.pairs import Pressed
from scene import BeamContact, Scene
from scene.answer import Array, Flags, Ints

FOOT_ITERATIONS = 8
CLOSE = 1e-9  # units of length: a step whose square is nothing
CLOSEST_ITERATIONS = 50
LEAST_CURVATURE = 1e-3  # of D, 1/ℓ: elements that end elsewhere on either beam leave as much in a zone
REACH = 0.1  # minima and ends with gaps wider than this part of the longest beam are no constraints yet
ARCHING = 1.0  # of what the largest force bends one element by: unlike elements of two beams arch by as much
JOINT_REACH = 2.0  # joints with gaps wider than this many h²·(|ψ_A'| + |ψ_B'| + 1/ℓ) are none
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot
SAME = 1e-3  # lengths that differ by less than this part are one
SETTLED = 1e-9  # slope of D at a minimum
BESIDE_END = 0.25  # a joint closer than this many h to where an end of B faces A leaves its place to that

DIP = 1.0 / 32.0  # twice what is derived there, for elements that are not even

STRETCH = 1e-3  # steps in which the length of A that faces one element of B is known
ON_IT = 1e-9  # gap and slope of two clamped ends, and how far they lie apart along the beams, where they touch
FEW = 8  # places whose nearest samples are found by looking at all
STRAIGHT = 0.1  # of an element: by less a line is off the chords between its samples
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(3)  # of the mean on either side of a border of B

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

    def only(self, these: Flags) -> Places:
        """Some of the places."""
        return Places(self.s[these], self.sigma[these], self.keys[these])


@dataclass(frozen=True, slots=True)
class Pair:
    """Two beams that may touch.

    Attributes:
        name: of the contact.
        a, b: their chains; ``b`` gives tangent and normal.
        side: +1 where A starts on the left of B, −1 on the right.
        across: +1 where B starts on the left of A, −1 on the right.
        offset: ½(t₁+t₂), zero for lines; units of length.
        unit_length: ℓ, m.
        clamps: for the start and the end of A and of B, whether it is clamped together with an end of the other.
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
    clamps: tuple[tuple[bool, bool], tuple[bool, bool]] = ((False, False), (False, False))
    own_places: bool = True
    kinks: tuple[Kinks, ...] = (NO_KINKS, NO_KINKS)
    fixed: bool = False

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

    def a_sampled(self, lines: Lines, these: Flags | Ints | slice) -> smooth.Points:
        """Some of A's samples, bent as its kinks say."""
        return kinked(self.a, self.kinks[0], lines[0].sampled.only(these))

    def b_sampled(self, lines: Lines, these: Flags | Ints | slice) -> smooth.Points:
        """Some of B's samples, bent as its kinks say."""
        return kinked(self.b, self.kinks[1], lines[1].sampled.only(these))

    def exchanged(self) -> Pair:
        """The same contact with the parts of A and B exchanged."""
        return replace(
            self,
            a=self.b,
            b=self.a,
            side=self.across,
            across=self.side,
            clamps=self.clamps[::-1],
            kinks=self.kinks[::-1],
        )

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
        return self.parting_at(lines, self.on_a(lines, s), sigma, D)

    def parting_at(self, lines: Lines, A: smooth.Points, sigma: Array, D: Array) -> Array:
        """D″ at points of A whose feet are at ``sigma``; between springs the curvature goes evenly."""
        facing = np.sign(np.cos(A.psi - self.on_b(lines, sigma).psi))
        bend_A, bend_B = (
            np.interp(places, line.chain.s[1:-1], line.sampled.bend[2:-2:2])
            for line, places in zip(lines, (A.s, sigma), strict=True)
        )
        return np.asarray(self.side * (facing * bend_A - bend_B / (1.0 - self.side * D * bend_B)))

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
            s = np.concatenate((smooth.halves(self.a), minima(self, lines, *_sampled(self, lines))[0]))
            D, _, foot = distance_along(self, lines, s)
            E, _, facing = distance_along(self.exchanged(), lines[::-1], self.b.s[[0, -1]])
            known[what] = np.where(foot, D, np.inf), np.where(facing, E, np.inf)
        D, E = known[what]
        return _not_gone_round(self, lines, D, gone), _not_gone_round(self.exchanged(), lines[::-1], E, gone)

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edges touch that touch at arc lengths ``s`` of A, (k, 2), units of length."""
        lines = self.lines(state, at)
        A, B = self.on_a(lines, s), self.on_b(lines, distance_along(self, lines, s)[1])
        share = self.a.thickness / (self.a.thickness + self.b.thickness)
        return np.stack((A.x + share * (B.x - A.x), A.y + share * (B.y - A.y)), axis=1)

    def slopes(self, state: State, at: Positions, s: Array) -> Array:
        """dD/ds at arc lengths ``s``."""
        lines = self.lines(state, at)
        sigma = distance_along(self, lines, s)[1]
        return np.asarray(self.side * np.sin(self.on_a(lines, s).psi - self.on_b(lines, sigma).psi))

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On A and on B what lies at ``s`` of A."""
        lines = self.lines(state, at)
        sigma = distance_along(self, lines, s)[1]
        return (1.0, s, self.on_a(lines, s).psi), (-1.0, sigma, self.on_b(lines, sigma).psi)

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
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
        inner = (along.keys > 0) & (along.keys <= self.a.n)
        found = []
        if np.any(inner):
            eased = self._eased()
            means = self._mean_rows(lines, at, along.only(inner))
            found += [(replace(rows, values=rows.values - eased), sigma) for rows, sigma in means]
        if not np.all(inner):
            places = along.only(~inner)
            found.append((self.rows_at(lines, at, places), places.sigma))
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
        touches = self.touches(lines, places.s, places.sigma, places.keys < 0)
        weights = np.ones((len(places.s), 1))
        return gathered(self.name, (self.a, self.b), at, touches, weights, places.keys, places.s)

    def _mean_rows(self, lines: Lines, at: Positions, joints: Places) -> list[tuple[Group, Array]]:
        """Rows of the mean gap around joints of A; those next to a clamp of both beams in one."""
        s, sigma, weights = self._around(lines, joints)
        (m, q), chains = s.shape, (self.a, self.b)
        touches = self.touches(lines, s.ravel(), sigma.ravel(), np.zeros(m * q, dtype=bool))
        number, alone, found = np.arange(m * q).reshape(m, q), np.ones(m, dtype=bool), []
        for key, beside in self._beside_clamps(joints.keys):
            alone[beside] = False
            tied = touches.only(number[beside].ravel())
            shares = weights[beside].reshape(1, -1) / len(beside)
            arc, other = np.mean(joints.s[beside], keepdims=True), np.mean(joints.sigma[beside], keepdims=True)
            rows = gathered(self.name, chains, at, tied, shares, np.array([key]), arc)
            found.append((replace(rows, reach=0.5 * float(np.ptp(joints.s[beside]))), other))
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
        A, B = self.a_sampled(lines, 2 * joints.keys), self.on_b(lines, sigma)
        ratio = (B.speed - B.bend * _seen_from(B, A)[1]) / (np.cos(A.psi - B.psi) * A.speed)  # ds/dσ
        borders = self.b.borders
        after = np.clip(np.searchsorted(borders, sigma), 1, self.b.n)
        # the length on A in steps, so that it does not change with the state where it is differentiated
        stretch = np.round(np.abs(ratio) / STRETCH) * STRETCH
        half = 0.5 * np.minimum(self.b.sizes[after - 1] * stretch, self.a.sizes[joints.keys - 1])[:, None]
        ahead, behind = borders[after] - sigma, borders[after - 1] - sigma
        cut = np.clip((np.where(ahead < -behind, ahead, behind) * ratio)[:, None], -half, half)
        x, w = 0.5 * (POINTS + 1.0), 0.5 * WEIGHTS
        off = np.concatenate((-half + (cut + half) * x, cut + (half - cut) * x), axis=1)
        weights = 0.5 * np.concatenate(((1.0 + cut / half) * w, (1.0 - cut / half) * w), axis=1)
        at_A = s[:, None] + off
        guess = (sigma[:, None] + off / ratio[:, None]).ravel()
        at_B = feet_near(self, lines, self.on_a(lines, at_A.ravel()), self.on_b(lines, guess))[1].reshape(at_A.shape)
        # beside an end of B, where it faces no element of B, the joint alone
        alone = ~np.all((at_B > 0.0) & (at_B < self.b.s[-1]), axis=1)[:, None]
        return np.where(alone, s[:, None], at_A), np.where(alone, sigma[:, None], at_B), weights

    def _beside_clamps(self, keys: Ints) -> list[tuple[int, Ints]]:
        """For every end of A that is clamped with B: the key of the row there, and which joints share it."""
        m = self.shared
        found = []
        for end, clamped in enumerate(self.clamps[0]):
            beside = (keys if end == 0 else self.a.n + 1 - keys) <= 2 * m
            # joints on both sides of the row's end lie close, or the beams part before
            if clamped and np.sum(beside) == 2 * m < self.a.n:
                these = np.flatnonzero(beside)
                found.append((self.a.n + 4 + end, these[:m] if end == 0 else these[m:]))
        return found

    def touches(self, lines: Lines, s: Array, sigma: Array, free: Flags) -> Touches:
        """The constraint at feet (s, σ); where ``free`` (k,) the place moves with the minimum."""
        A, B = self.on_a(lines, s), self.on_b(lines, sigma)
        m, k = len(s), smooth.LOCALS
        tangent = np.stack((np.cos(B.psi), np.sin(B.psi)), axis=1)
        normal = np.stack((-tangent[:, 1], tangent[:, 0]), axis=1)
        r = np.stack((A.x - B.x, A.y - B.y), axis=1)
        distance = np.sum(normal * r, axis=1)
        r_z = np.concatenate((smooth.position_slopes(A), -smooth.position_slopes(B)), axis=2)
        n_r = np.einsum("mi,mik->mk", normal, r_z)
        t_r = np.einsum("mi,mik->mk", tangent, r_z)
        facing = np.cos(A.psi - B.psi)
        of_foot = -B.speed + distance * B.bend
        # what D gains over s by the tangents' γ, the foot going along
        more_A, more_B = missed(self.a, self.kinks[0], s), missed(self.b, self.kinks[1], sigma)
        gained = np.sign(facing) * (more_A.integral + of_foot / (facing * A.speed) * more_B.integral)

        def bent() -> Array:
            # ds/dz and dσ/dz from (i) and (ii)
            zeros = np.zeros((m, k))
            psi_B = np.concatenate((zeros, smooth.angle_slopes(B)), axis=1)
            psi_A = np.concatenate((smooth.angle_slopes(A), zeros), axis=1)
            one, two = -(psi_A - psi_B), -(t_r + distance[:, None] * psi_B)
            determinant = np.where(free, A.bend * of_foot + B.bend * facing * A.speed, 1.0)
            s_z = np.where(free[:, None], of_foot[:, None] * one + B.bend[:, None] * two, 0.0) / determinant[:, None]
            sigma_z = (two - (facing * A.speed)[:, None] * s_z) / of_foot[:, None]
            turning = psi_B + B.bend[:, None] * sigma_z
            second = np.zeros((m, 2 * k, 2 * k))
            second[:, :k, :k] = smooth.position_curvature(A, normal)
            second[:, k:, k:] = -smooth.position_curvature(B, normal)
            n_A = np.concatenate((np.einsum("mi,mik->mk", normal, smooth.tangent_slopes(A)), zeros), axis=1)
            n_B = np.concatenate((zeros, np.einsum("mi,mik->mk", normal, smooth.tangent_slopes(B))), axis=1)
            second += -t_r[:, :, None] * turning[:, None, :]
            second += n_A[:, :, None] * s_z[:, None, :] - n_B[:, :, None] * sigma_z[:, None, :]
            # γ leaves a part of its own size uneven
            return np.asarray(-self.side * 0.5 * (second + np.swapaxes(second, 1, 2)))

        return Touches(
            values=self.offset - self.side * (distance + gained),
            slopes=-self.side * n_r,
            bent=bent,
            links=np.stack((A.link, B.link)),
        )


def distance_along(pair: Pair, lines: Lines, s: Array) -> tuple[Array, Array, Flags]:
    """Signed distance D of A from B at arc lengths ``s``: D, σ (k,), and whether a foot exists (k,)."""
    return _distance_of(pair, lines, pair.on_a(lines, s))


def _distance_of(pair: Pair, lines: Lines, A: smooth.Points) -> tuple[Array, Array, Flags]:
    """The same of points of A."""
    G = lines[1].sampled
    if len(A.s) <= FEW:
        nearest = ((A.x[:, None] - G.x) ** 2 + (A.y[:, None] - G.y) ** 2).argmin(axis=1)
    else:
        _, nearest = cKDTree(np.stack((G.x, G.y), axis=1)).query(np.stack((A.x, A.y), axis=1))
    return feet_near(pair, lines, A, pair.b_sampled(lines, nearest))


def feet_near(pair: Pair, lines: Lines, A: smooth.Points, B: smooth.Points) -> tuple[Array, Array, Flags]:
    """D, σ and whether there is a foot, by Newton's method on (i) from points ``B`` of B."""
    sigma = B.s
    for _ in range(FOOT_ITERATIONS):
        along, across = _seen_from(B, A)
        # along the circle of curvature, where that is round the foot
        left = along / np.maximum(1.0 - B.bend * across, 0.2)
        step = left / (B.speed * (1.0 + (B.bend * left) ** 2 / 3.0))
        before = sigma
        sigma = np.minimum(np.maximum(before + np.minimum(np.maximum(step, -pair.b.h), pair.b.h), 0.0), pair.b.s[-1])
        if np.abs(sigma - before).max() < CLOSE:
            break
        B = pair.on_b(lines, sigma)
    foot = np.abs(along) <= PARALLEL * np.maximum(np.abs(across), pair.b.h)
    return pair.side * across, sigma, foot


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

    # D and feet at the joints are every other sample
    bends = np.abs(pair.a_sampled(lines, slice(None, None, 2)).bend) + np.abs(pair.on_b(lines, sigma[::2]).bend)
    near = D[::2] - pair.offset < JOINT_REACH * a.h**2 * (1.0 + bends)
    for places, apart in ((s, wells.BESIDE), (ends, BESIDE_END)):
        for place in places:
            near[1:-1] &= np.abs(a.s[1:-1] - place) > apart * a.size_at(place)
    for end in (0, -1):
        near[end] = reach > D[end] and not held_together(a, b, end, float(sigma[end]))
    joints = np.flatnonzero(near)
    return Places(
        np.concatenate((a.s[joints], s)),
        np.concatenate((sigma[::2][joints], turned)),
        np.concatenate((joints, a.n + 6 + np.arange(len(s)) if pair.fixed else np.full(len(s), -1))),
    )


def _facing_ends(pair: Pair, lines: Lines) -> Places:
    """The ends of B that face A within reach, and their feet on A; the keys follow A's joints."""
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    A, ends = lines[0].sampled, pair.b_sampled(lines, np.array([0, -1]))
    away = np.array([np.min(np.hypot(A.x - x, A.y - y)) for x, y in zip(ends.x, ends.y, strict=True)])
    near = np.flatnonzero(away < reach + a.h)
    if not near.size:
        return Places(np.zeros(0), np.zeros(0), near)
    E, foot, facing = _distance_of(pair.exchanged(), lines[::-1], ends.only(near))
    E = _not_gone_round(pair.exchanged(), lines[::-1], E)
    facing &= (foot > SAME * a.h) & (foot < a.s[-1] - SAME * a.h) & (reach > E)
    for i, end in enumerate(near):
        facing[i] &= not held_together(b, a, int(-end), float(foot[i]))
    return Places(ends.s[near][facing], foot[facing], a.n + 2 + near[facing])


def held_together(one: Chain, other: Chain, end: int, foot: float) -> bool:
    """Whether an end of ``one`` and what its foot on ``other`` lies on move with one body: their gap is no unknown."""
    mine = one.start if end == 0 else one.end
    if mine is None:
        return False
    first, last = other.s[1], other.s[-1] - other.s[-2]
    for its, away, half in ((other.start, foot, first), (other.end, other.s[-1] - foot, last)):
        if its is None or its.body != mine.body:
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


def _sampled_anew(pair: Pair, lines: Lines) -> tuple[Array, Array]:
    A, G = lines[0].sampled, lines[1].sampled
    # far parts are left out by their distance from B's samples, which no foot can undercut by more than h
    rough, nearest = cKDTree(np.stack((G.x, G.y), axis=1)).query(
        np.stack((A.x, A.y), axis=1), distance_upper_bound=pair.offset + REACH + pair.a.h + pair.b.h
    )
    close = np.flatnonzero(np.isfinite(rough))
    D, sigma = np.full(len(A.s), np.inf), np.zeros(len(A.s))
    if close.size:
        distance, sigma[close], foot = feet_near(
            pair, lines, pair.a_sampled(lines, close), pair.b_sampled(lines, nearest[close])
        )
        D[close] = np.where(foot, distance, np.inf)
    return _not_gone_round(pair, lines, D), sigma


def _not_gone_round(pair: Pair, lines: Lines, D: Array, gone: float = np.inf) -> Array:
    """D, but ``gone`` where A lies beyond B and has not come there through it, but round an end."""
    beyond = D + pair.offset + STRAIGHT * (pair.a.h + pair.b.h) < 0.0
    if not np.any(beyond):
        return D
    A, B = (np.stack((line.sampled.x, line.sampled.y), axis=1) for line in lines)
    return D if cross(A, B) else np.where(beyond, gone, D)


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
    s, lowest = smooth.halves(pair.a), wells.lowest(D, pair.offset + REACH)
    if not lowest.size:
        return np.zeros(0), np.zeros(0)
    # the joints beside a common clamp press together, a place of its own among them would part them
    first, last = (4 * pair.shared if clamped else 0 for clamped in pair.clamped)
    lowest = lowest[pair.own_places & (lowest > first) & (lowest < 2 * (pair.a.n + 1) - last)]
    parting, near = np.full(pair.a.n + 2, np.inf), np.isfinite(D[::2])
    joints = pair.a_sampled(lines, 2 * np.flatnonzero(near))
    parting[near] = pair.parting_at(lines, joints, sigma[::2][near], D[::2][near])
    found = wells.wells(pair.a, D - pair.offset, parting, lowest, LEAST_CURVATURE, pair.kinks[0].places)
    if not found.samples.size:
        return np.zeros(0), np.zeros(0)
    here, feet = found.samples, sigma
    low, high, ahead = s[here - 1], s[here + 1], wells.ahead(s, D, here)
    beside = np.where(ahead > 0.0, here + 1, here - 1)
    share = np.where(ahead != 0.0, ahead / (s[beside] - s[here]), 0.0)
    s, sigma = s[here] + ahead, feet[here] + share * (feet[beside] - feet[here])
    for _ in range(CLOSEST_ITERATIONS):
        A, B = pair.on_a(lines, s), pair.on_b(lines, sigma)
        along, across = _seen_from(B, A)
        facing, shortened = np.cos(A.psi - B.psi), B.speed - B.bend * across
        # what is left to the foot, and the slope there
        left = along / shortened
        slope = pair.side * (np.sin(A.psi - B.psi) - facing * B.bend * left)
        towards = facing * A.speed / shortened  # dσ/ds
        convex = pair.side * facing * (A.bend - B.bend * towards)
        low, high = np.where(slope < 0.0, s, low), np.where(slope < 0.0, high, s)
        ahead = s - slope / np.where(convex > LEAST_CURVATURE, convex, np.inf)
        newton = (convex > LEAST_CURVATURE) & (ahead >= low) & (ahead <= high)
        step = np.where(newton, ahead, 0.5 * (low + high)) - s
        s, sigma = s + step, np.minimum(np.maximum(sigma + left + towards * step, 0.0), pair.b.s[-1])
        if np.all((np.abs(step) < CLOSE) & (np.abs(along) < CLOSE) & (np.abs(slope) < SETTLED)):
            break
    held = found.held(pair.side * across - pair.offset)
    settled = held & (convex > LEAST_CURVATURE) & (np.abs(slope) < SETTLED)
    return s[settled], sigma[settled]


def pair_of(scene: Scene, model: Model, name: str, fit: Fit = EVEN) -> Pair:
    """One of the scene's contacts, its sides read from the stress-free state."""
    contact = scene.contacts[name]
    assert isinstance(contact, BeamContact)
    a, b = (model.chain(beam) for beam in contact.between)
    state = rest_state(model)
    at = positions(model, state)
    half = 0.5 * (a.thickness + b.thickness) if contact.thick else 0.0
    pair = Pair(name, a, b, 1.0, 1.0, half, model.unit_length)
    lines = pair.lines(state, at)
    pair = replace(pair, side=_side(pair, lines), across=_side(pair.exchanged(), lines[::-1]))
    clamps = _clamped(pair, lines), _clamped(pair.exchanged(), lines[::-1])
    return replace(pair, clamps=clamps, kinks=fit.kinks.get(name, pair.kinks), fixed=name in fit.fixed)


def _clamped(pair: Pair, lines: Lines) -> tuple[bool, bool]:
    """For the start and the end of A, whether it is clamped beside an end of B, touching and parallel."""
    ends = pair.a.s[[0, -1]]
    D, sigma, foot = distance_along(pair, lines, ends)
    turn = np.sin(pair.on_a(lines, ends).psi - pair.on_b(lines, sigma).psi)
    at_end = np.minimum(sigma, pair.b.s[-1] - sigma)
    touching = foot & (np.abs(D - pair.offset) <= ON_IT) & (np.abs(turn) <= ON_IT) & (at_end <= ON_IT)
    start, end = (
        bool(touching[i]) and held_together(pair.a, pair.b, e, float(sigma[i])) for i, e in enumerate((0, -1))
    )
    return start, end


def _side(pair: Pair, lines: Lines) -> float:
    """+1 where A lies on the left of B at their closest places, else −1."""
    D, _, foot = distance_along(pair, lines, smooth.halves(pair.a))
    size = np.where(foot, np.abs(D), np.inf)
    if not np.isfinite(size.min()):
        size = np.abs(D)
    return 1.0 if D[int(np.argmin(size))] >= 0.0 else -1.0
