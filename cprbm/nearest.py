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

σ is the foot of the perpendicular, t·r = 0 (i).  A row stands at every local minimum of D along A:
either within A, where the tangents are parallel, ψ_A − ψ_B = const (ii), or at an end of A; and, with
the beams' parts exchanged, at the ends of B.  Both conditions hold for every z, which gives s and σ as
functions of z; so

    ∂D/∂z_k = side·n·r_k
    ∂²D/∂z_k∂z_l = side·(n·r_kl − (t·r_k)·dψ_B/dz_l + n·C_A,sk·ds/dz_l − n·C_B,σk·dσ/dz_l)

with dψ_B/dz_l = ψ_B,l + ψ_B'·dσ/dz_l, and nothing divides by D.
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
CLOSEST_ITERATIONS = 12
LEAST_CURVATURE = 1e-3  # of D along A, 1/ℓ, below which its minimum has no place of its own
REACH = 0.1  # gaps wider than this part of the longest beam are no constraints yet
PARALLEL = 1e-3  # a foot whose perpendicular misses by more (sine) is an end, not a foot

ORDER = np.array([0, 5, 1, 6, 2, 3, 4, 7, 8, 9])  # (x, y, θθθ of A, the same of B) to (x, x, y, y, θ of A, θ of B)

Lines = tuple[smooth.SmoothLine, smooth.SmoothLine]


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
    def clamped(self) -> tuple[bool, bool]:
        """Whether the beam's start and end are clamped in touch with the other: not told."""
        return (False, False)

    @property
    def ends(self) -> tuple[float, ...]:
        """Arc lengths of A at which zones end on this mesh: meshes are not fitted to them."""
        return ()

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """Curvature D″ with which A parts from B, at arc lengths ``s``."""
        lines = self.lines(state, at)
        D, sigma, _ = distance_along(self, lines, s)
        A, B = lines[0].at(s), lines[1].at(sigma)
        facing = np.sign(np.cos(A.psi - B.psi))
        return np.asarray(self.side * (facing * A.bend - B.bend / (1.0 - self.side * D * B.bend)))

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the mean thickness, for lines the longest beam; units of length."""
        return self.offset if self.offset > 0.0 else 1.0

    def deepest(self, state: State, at: Positions) -> float:
        """Largest overlap of the two beams anywhere along A, units of length; zero where they are apart."""
        lines = self.lines(state, at)
        places = closest_places(self, lines)
        D, _, foot = distance_along(self, lines, np.concatenate((smooth.halves(self.a), places.s, places.held_s)))
        return float(np.max(np.where(foot, self.offset - D, 0.0), initial=0.0))

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
        found = closest_places(self, lines)
        groups = []
        if found.s.size:
            groups.append(self._rows_at(lines, found.s, found.sigma, free=True))
        if found.held_s.size:
            groups.append(self._rows_at(lines, found.held_s, found.held_sigma, free=False))
        if found.across_s.size:
            rows = self.exchanged()._rows_at(lines[::-1], found.across_s, found.across_sigma, free=False)
            groups.append(replace(rows, arc=found.across_sigma))
        return tuple(groups)

    def _rows_at(self, lines: Lines, s: Array, sigma: Array, *, free: bool) -> Group:
        """Rows at feet (s, σ); ``free`` where s moves with the minimum, else it is held."""
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
        if free:
            determinant = A.bend * of_foot + B.bend * facing * A.speed
            one, two = -(psi_A - psi_B), -(t_r + distance[:, None] * psi_B)
            s_z = (of_foot[:, None] * one + B.bend[:, None] * two) / determinant[:, None]
            sigma_z = (A.bend[:, None] * two - (facing * A.speed)[:, None] * one) / determinant[:, None]
        else:
            s_z = np.zeros((m, 2 * k))
            sigma_z = -(t_r + distance[:, None] * psi_B) / of_foot[:, None]
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
            keys=(-1,) * m,
            arc=np.asarray(A.s),
        )


def _angles(chain: Chain, link: Ints) -> Ints:
    """Links i−1, i, i+1; beyond the beam's ends link i itself, whose share there is zero."""
    own = np.stack((np.maximum(link - 1, 0), link, np.minimum(link + 1, chain.n)), axis=1)
    return np.asarray(chain.first_link + own, dtype=np.intp)


@dataclass(frozen=True, slots=True)
class Places:
    """Where rows stand: minima within A (s, σ), ends of A, and ends of B with A's and B's parts exchanged."""

    s: Array
    sigma: Array
    held_s: Array
    held_sigma: Array
    across_s: Array
    across_sigma: Array


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


def closest_places(pair: Pair, lines: Lines) -> Places:
    """All local minima of D along A within reach, and the ends of B that face A."""
    none = np.zeros(0)
    reach = pair.offset + REACH
    s, grid = smooth.halves(pair.a), smooth.halves(pair.b)
    A, G = lines[0].at(s), lines[1].at(grid)
    # far parts are left out by their distance from B's samples, which no foot can undercut by more than h
    limit = reach + pair.a.h + pair.b.h
    rough, nearest = cKDTree(np.stack((G.x, G.y), axis=1)).query(
        np.stack((A.x, A.y), axis=1), distance_upper_bound=limit
    )
    close = np.flatnonzero(np.isfinite(rough))
    across_s = across_sigma = none
    for end in (0, -1):
        if np.min((A.x - G.x[end]) ** 2 + (A.y - G.y[end]) ** 2) < limit * limit:
            at_end, foot_of_end = _facing_end(pair, lines, grid[[end]], reach)
            across_s, across_sigma = np.append(across_s, at_end), np.append(across_sigma, foot_of_end)
    if not close.size:
        return Places(none, none, none, none, across_s, across_sigma)
    D, sigma = np.full(len(s), np.inf), np.zeros(len(s))
    distance, sigma[close], foot = _feet(pair, lines[1], lines[0].at(s[close]), grid[nearest[close]])
    D[close] = np.where(foot, distance, np.inf)
    padded = np.concatenate(([np.inf], D, [np.inf]))
    lowest = (padded[:-2] >= D) & (padded[2:] > D) & (reach > D)
    inner = lowest.copy()
    inner[[0, -1]] = False
    held_s, held_sigma = s[lowest & ~inner], sigma[lowest & ~inner]
    free_s, free_sigma = none, none
    if np.any(inner):
        free_s, free_sigma, minimum = _refined(pair, lines, s[inner], sigma[inner])
        held_s = np.concatenate((held_s, s[inner][~minimum]))
        held_sigma = np.concatenate((held_sigma, sigma[inner][~minimum]))
        free_s, free_sigma = free_s[minimum], free_sigma[minimum]
    return Places(free_s, free_sigma, held_s, held_sigma, across_s, across_sigma)


def _facing_end(pair: Pair, lines: Lines, end: Array, reach: float) -> tuple[Array, Array]:
    """An end of B (1,) and its foot within A, or nothing where it faces no part of A."""
    E, foot, has_foot = distance_along(pair.exchanged(), lines[::-1], end)
    facing = has_foot & (foot > 0.0) & (foot < pair.a.s[-1]) & (reach > E)
    return end[facing], foot[facing]


def _refined(pair: Pair, lines: Lines, s: Array, sigma: Array) -> tuple[Array, Array, Flags]:
    """Newton on (i) and (ii) from a sampled minimum; the last array says where it ended in a minimum nearby."""
    s0, reach = s, pair.a.h
    for _ in range(CLOSEST_ITERATIONS):
        A, B = lines[0].at(s), lines[1].at(sigma)
        along, across = _seen_from(B, A)
        facing = np.cos(A.psi - B.psi)
        crossing = np.sin(A.psi - B.psi) * facing  # zero where the tangents are parallel, either way
        of_foot = -B.speed + across * B.bend
        # d²D/ds² along the feet, over the speed
        convex = pair.side * facing * (A.bend + B.bend * facing * A.speed / of_foot) > LEAST_CURVATURE
        # (ii) and (i) over (s, σ)
        J11, J12, J21, J22 = A.bend, -B.bend, facing * A.speed, of_foot
        determinant = J11 * J22 - J12 * J21
        safe = np.where(np.abs(determinant) > LEAST_CURVATURE, determinant, np.inf)
        ds = -(J22 * crossing - J12 * along) / safe
        dsigma = -(J11 * along - J21 * crossing) / safe
        s = np.minimum(np.maximum(s + np.clip(ds, -reach, reach), 0.0), pair.a.s[-1])
        sigma = np.minimum(np.maximum(sigma + np.clip(dsigma, -reach, reach), 0.0), pair.b.s[-1])
        if np.all(np.abs(ds) + np.abs(dsigma) < 1e-13):
            break
    settled = (np.abs(ds) < 1e-9) & (np.abs(determinant) > LEAST_CURVATURE)
    return s, sigma, convex & settled & (np.abs(s - s0) <= reach)


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
