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

σ is the foot of the perpendicular, t·r = 0 (i).  A row stands at every joint of A that is close to B, at the
ends of A and, with the beams' parts exchanged, of B; and where D has a minimum within A that is deeper than
the steps of the lines' curvature.  There s moves with the minimum: the tangents are parallel, ψ_A − ψ_B = const
(ii).  The conditions hold for every z, which gives s and σ as functions of z; so

    ∂D/∂z_k = side·n·r_k
    ∂²D/∂z_k∂z_l = side·(n·r_kl − (t·r_k)·dψ_B/dz_l + n·C_A,sk·ds/dz_l − n·C_B,σk·dσ/dz_l)

with dψ_B/dz_l = ψ_B,l + ψ_B'·dσ/dz_l, and nothing divides by D.

Beams that lie on each other over a length share any pressure among A's joints.  A is the beam with the longer
elements: rows at the joints of both would ask one element for two curvatures, and rows closer than the other
beam's elements would follow the steps of its curvature.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from cprbm import smooth
from cprbm.contact import Blocks, Group
from cprbm.kinematics import Positions, State, positions, rest_state
from cprbm.model import Chain, Model
from scene import BeamContact, Scene
from scene.answer import Array, Flags, Ints

FOOT_ITERATIONS = 8
FOOT_TOLERANCE = 1e-13  # of t·r, units of length
CLOSEST_ITERATIONS = 50
LEAST_CURVATURE = 1e-3  # of D along A, 1/ℓ, below which its minimum has no place of its own
STEPS = 3.0  # a minimum is less convex than this many steps of the curvature: it belongs to a zone
REACH = 0.1  # minima and ends with gaps wider than this part of the longest beam are no constraints yet
JOINT_REACH = 2.0  # joints with gaps wider than this many h²·(|ψ_A'| + |ψ_B'| + 1/ℓ) are none
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot
SAME = 1e-3  # lengths that differ by less than this part are one
PLACE_TOLERANCE = 1e-13  # of a minimum's place, units of length
SETTLED = 1e-9  # slope of D at a minimum
BESIDE = 0.25  # a joint closer than this many h to another row leaves its place to that

ORDER = np.array([0, 5, 1, 6, 2, 3, 4, 7, 8, 9])  # (x, y, θθθ of A, the same of B) to (x, x, y, y, θ of A, θ of B)

Lines = tuple[smooth.SmoothLine, smooth.SmoothLine]


@dataclass(frozen=True, slots=True)
class Places:
    """Where rows stand on one beam, and their feet on the other.

    Attributes:
        s, sigma: arc lengths on the one beam and on the other (k,).
        keys: of the rows (k,): a joint's number on A, beyond those the ends of B; negative where s moves.
    """

    s: Array
    sigma: Array
    keys: Ints


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
    """

    name: str
    a: Chain
    b: Chain
    side: float
    across: float
    offset: float
    unit_length: float

    def lines(self, state: State, at: Positions) -> Lines:
        """The smooth lines of A and B in a state."""
        return (
            smooth.smooth_line(self.a, self.unit_length, state, at),
            smooth.smooth_line(self.b, self.unit_length, state, at),
        )

    def exchanged(self) -> Pair:
        """The same contact with the parts of A and B exchanged."""
        return Pair(self.name, self.b, self.a, self.across, self.side, self.offset, self.unit_length)

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the mean thickness, for lines the longest beam; units of length."""
        return self.offset if self.offset > 0.0 else 1.0

    def deepest(self, state: State, at: Positions) -> float:
        """Largest overlap of the two beams anywhere along A and at the ends of B, units of length; zero if apart."""
        lines = self.lines(state, at)
        s = np.concatenate((smooth.halves(self.a), _minima(self, lines, *_sampled(self, lines))[0]))
        D, _, foot = distance_along(self, lines, s)
        E, _, facing = distance_along(self.exchanged(), lines[::-1], self.b.s[[0, -1]])
        return float(np.max(np.where(np.append(foot, facing), self.offset - np.append(D, E), 0.0), initial=0.0))

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edges touch that touch at arc lengths ``s`` of A, (k, 2), units of length."""
        lines = self.lines(state, at)
        A, B = lines[0].at(s), lines[1].at(distance_along(self, lines, s)[1])
        share = self.a.thickness / (self.a.thickness + self.b.thickness)
        return np.stack((A.x + share * (B.x - A.x), A.y + share * (B.y - A.y)), axis=1)

    def pressed(self, state: State, at: Positions, chain: Chain, s: Array) -> tuple[float, Array, Array] | None:
        """On ``chain``: the sign of the force, and places and tangent angles of what lies at ``s`` of A."""
        lines = self.lines(state, at)
        if chain is self.a:
            return 1.0, s, lines[0].at(s).psi
        if chain is self.b:
            sigma = distance_along(self, lines, s)[1]
            return -1.0, sigma, lines[1].at(sigma).psi
        return None

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        lines = self.lines(state, at)
        if self.a.h < self.b.h * (1.0 - SAME):
            turned = self.exchanged()
            return tuple(replace(rows, arc=other) for rows, other in turned._rows(lines[::-1]))
        return tuple(rows for rows, _ in self._rows(lines))

    def _rows(self, lines: Lines) -> list[tuple[Group, Array]]:
        """Rows at A's joints, at minima along A and at both beams' ends; with each group the places on B."""
        along, across = closest_places(self, lines)
        found = []
        if along.s.size:
            found.append((self._rows_at(lines, along), along.sigma))
        if across.s.size:
            rows = self.exchanged()._rows_at(lines[::-1], across)
            found.append((replace(rows, arc=across.sigma), across.s))
        return found

    def _rows_at(self, lines: Lines, places: Places) -> Group:
        """Rows at feet (s, σ) where the places are on A."""
        s, sigma, free = places.s, places.sigma, places.keys < 0
        A, B = lines[0].at(s), lines[1].at(sigma)
        m, k = len(s), smooth.LOCALS
        tangent = np.stack((np.cos(B.psi), np.sin(B.psi)), axis=1)
        normal = np.stack((-tangent[:, 1], tangent[:, 0]), axis=1)
        r = np.stack((A.x - B.x, A.y - B.y), axis=1)
        distance = np.sum(normal * r, axis=1)
        r_z = np.concatenate((smooth.position_slopes(A), -smooth.position_slopes(B)), axis=2)
        n_r = np.einsum("mi,mik->mk", normal, r_z)
        t_r = np.einsum("mi,mik->mk", tangent, r_z)
        slope = self.side * n_r

        # ds/dz and dσ/dz from (i) and (ii)
        zeros = np.zeros((m, k))
        psi_B = np.concatenate((zeros, smooth.angle_slopes(B)), axis=1)
        psi_A = np.concatenate((smooth.angle_slopes(A), zeros), axis=1)
        facing = np.cos(A.psi - B.psi)
        of_foot = -B.speed + distance * B.bend
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
        second *= self.side

        # local numbers of a row: joints of A and B, then θ (three of A, three of B)
        joints = np.stack((self.a.first_joint + A.link, self.b.first_joint + B.link), axis=1)
        angles = np.concatenate((_angles(self.a, A.link), _angles(self.b, B.link)), axis=1)

        def curvature(multipliers: Array) -> Blocks:
            pressing = np.flatnonzero(multipliers)
            matrices = -multipliers[pressing, None, None] * second[pressing][:, ORDER[:, None], ORDER]
            return Blocks(joints[pressing], angles[pressing], matrices)

        return Group(
            contact=self.name,
            values=self.offset - self.side * distance,
            joints=joints,
            angles=angles,
            slopes=-slope[:, ORDER],
            curvature=curvature,
            keys=tuple(places.keys.tolist()),
            arc=np.asarray(A.s),
        )


def _angles(chain: Chain, link: Ints) -> Ints:
    """Links i−1, i, i+1; beyond the beam's ends link i itself, whose share there is zero."""
    own = np.stack((np.maximum(link - 1, 0), link, np.minimum(link + 1, chain.n)), axis=1)
    return np.asarray(chain.first_link + own, dtype=np.intp)


def distance_along(pair: Pair, lines: Lines, s: Array) -> tuple[Array, Array, Flags]:
    """Signed distance D of A from B at arc lengths ``s``: D, σ (k,), and whether a foot exists (k,)."""
    A = lines[0].at(s)
    grid = smooth.halves(pair.b)
    G = lines[1].at(grid)
    _, nearest = cKDTree(np.stack((G.x, G.y), axis=1)).query(np.stack((A.x, A.y), axis=1))
    return _feet(pair, lines[1], A, grid[nearest])


def _feet(pair: Pair, line: smooth.SmoothLine, A: smooth.Points, sigma: Array) -> tuple[Array, Array, Flags]:
    """D, σ and whether there is a foot, by Newton's method on (i) from the guess ``sigma``."""
    for _ in range(FOOT_ITERATIONS):
        B = line.at(sigma)
        along, across = _seen_from(B, A)
        step = along / (B.speed * np.maximum(1.0 - B.bend * across, 0.2))
        sigma = np.minimum(np.maximum(sigma + np.minimum(np.maximum(step, -pair.b.h), pair.b.h), 0.0), pair.b.s[-1])
        if np.max(np.abs(along)) < FOOT_TOLERANCE:
            break
    B = line.at(sigma)
    along, across = _seen_from(B, A)
    foot = np.abs(along) <= PARALLEL * np.maximum(np.abs(across), pair.b.h)
    return pair.side * across, sigma, foot


def _seen_from(B: smooth.Points, A: smooth.Points) -> tuple[Array, Array]:
    """t·r and n·r of points of A in the frames of points of B, (k,) each."""
    rx, ry = A.x - B.x, A.y - B.y
    cos, sin = np.cos(B.psi), np.sin(B.psi)
    return cos * rx + sin * ry, cos * ry - sin * rx


def closest_places(pair: Pair, lines: Lines) -> tuple[Places, Places]:
    """Where rows stand on A, and on B with the beams' parts exchanged."""
    a, b, reach = pair.a, pair.b, pair.offset + REACH
    D, sigma = _sampled(pair, lines)
    s, turned = _minima(pair, lines, D, sigma)
    across_s, across_sigma = b.s[[0, -1]], np.zeros(2)
    E, across_sigma, facing = distance_along(pair.exchanged(), lines[::-1], across_s)
    inside = (across_sigma > SAME * a.h) & (across_sigma < a.s[-1] - SAME * a.h)
    ends = facing & inside & (reach > E)
    for i, end in enumerate((0, -1)):
        ends[i] &= not _held_together(b, a, end, float(across_sigma[i]))

    # D and feet at the joints are every other sample
    bends = np.abs(lines[0].at(a.s).bend) + np.abs(lines[1].at(sigma[::2]).bend)
    near = D[::2] - pair.offset < JOINT_REACH * a.h**2 * (1.0 + bends)
    for place in np.concatenate((s, across_sigma[ends])):
        near[1:-1] &= np.abs(a.s[1:-1] - place) > BESIDE * a.h
    for end in (0, -1):
        near[end] = reach > D[end] and not _held_together(a, b, end, float(sigma[end]))
    joints = np.flatnonzero(near)
    return (
        Places(
            np.concatenate((a.s[joints], s)),
            np.concatenate((sigma[::2][joints], turned)),
            np.concatenate((joints, np.full(len(s), -1))),
        ),
        Places(across_s[ends], across_sigma[ends], a.n + 2 + np.flatnonzero(ends)),
    )


def _held_together(one: Chain, other: Chain, end: int, foot: float) -> bool:
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
    s, grid = smooth.halves(pair.a), smooth.halves(pair.b)
    A, G = lines[0].at(s), lines[1].at(grid)
    # far parts are left out by their distance from B's samples, which no foot can undercut by more than h
    rough, nearest = cKDTree(np.stack((G.x, G.y), axis=1)).query(
        np.stack((A.x, A.y), axis=1), distance_upper_bound=pair.offset + REACH + pair.a.h + pair.b.h
    )
    close = np.flatnonzero(np.isfinite(rough))
    D, sigma = np.full(len(s), np.inf), np.zeros(len(s))
    if close.size:
        distance, sigma[close], foot = _feet(pair, lines[1], lines[0].at(s[close]), grid[nearest[close]])
        D[close] = np.where(foot, distance, np.inf)
    return D, sigma


def _minima(pair: Pair, lines: Lines, D: Array, sigma: Array) -> tuple[Array, Array]:
    """(s, σ) of the minima of D within A that are deeper than the steps of the curvature, from its samples.

    Newton's method on dD/ds = 0, kept between the samples beside the lowest: where the curvature jumps it alone
    would not settle.
    """
    s = smooth.halves(pair.a)
    lowest = np.flatnonzero((D[:-2] >= D[1:-1]) & (D[2:] > D[1:-1]) & (pair.offset + REACH > D[1:-1])) + 1
    low, high, s, sigma = s[lowest - 1], s[lowest + 1], s[lowest], sigma[lowest]
    if not s.size:
        return s, sigma
    for _ in range(CLOSEST_ITERATIONS):
        A, B = lines[0].at(s), lines[1].at(sigma)
        facing = np.cos(A.psi - B.psi)
        slope = pair.side * np.sin(A.psi - B.psi)
        towards = facing * A.speed / (B.speed - B.bend * _seen_from(B, A)[1])  # dσ/ds
        convex = pair.side * facing * (A.bend - B.bend * towards)
        low, high = np.where(slope < 0.0, s, low), np.where(slope < 0.0, high, s)
        ahead = s - slope / np.where(convex > LEAST_CURVATURE, convex, np.inf)
        newton = (convex > LEAST_CURVATURE) & (ahead >= low) & (ahead <= high)
        step = np.where(newton, ahead, 0.5 * (low + high)) - s
        if np.max(np.abs(step)) < PLACE_TOLERANCE:
            break
        s = s + step
        _, sigma, _ = _feet(pair, lines[1], lines[0].at(s), sigma + towards * step)
    steps = smooth.curvature_step(lines[0], A.link) + smooth.curvature_step(lines[1], B.link)
    deep = convex > np.maximum(LEAST_CURVATURE, STEPS * steps)
    settled = np.abs(slope) < SETTLED
    return s[deep & settled], sigma[deep & settled]


def pair_of(scene: Scene, model: Model, name: str) -> Pair:
    """One of the scene's contacts, its sides read from the stress-free state."""
    contact = scene.contacts[name]
    assert isinstance(contact, BeamContact)
    a, b = (model.chain(beam) for beam in contact.between)
    state = rest_state(model)
    at = positions(model, state)
    half = 0.5 * (a.thickness + b.thickness) if contact.thick else 0.0
    pair = Pair(name, a, b, 1.0, 1.0, half, model.unit_length)
    lines = pair.lines(state, at)
    return replace(pair, side=_side(pair, lines), across=_side(pair.exchanged(), lines[::-1]))


def _side(pair: Pair, lines: Lines) -> float:
    """+1 where A lies on the left of B at their closest places, else −1."""
    D, _, foot = distance_along(pair, lines, smooth.halves(pair.a))
    size = np.where(foot, np.abs(D), np.inf)
    if not np.isfinite(size.min()):
        size = np.abs(D)
    return 1.0 if D[int(np.argmin(size))] >= 0.0 else -1.0
