"""Section 3.4's minimum of energy as the paper writes it: links, a fitted curve, related joints, limits of an angle.

=========  ====================================================================================================
symbol     meaning
=========  ====================================================================================================
b, i, j    a beam (1, 2); a link, 0..N; a joint (the i-th spring, or the end N + 1), the place behind link j − 1
θ_bi       tangent angle of a link; θ_b0 = π/2 is clamped, and z = (θ_11..θ_1N, θ_21..θ_2N) are the unknowns
ℓ_i        length of a link: L/N, and half of it for i = 0 and i = N
k          stiffness of a spring, E·I·N/L, of equation (3), I = w·t³/12
δ_bi       turn of a spring, θ_bi − θ_b,i−1: the beams are straight when they are free
P_bj       place of a joint, (x_bj, y_bj), by equation (6) from (∓t/2, 0)
α, σ       turn of the crank, and its sense: σ = 1 counter-clockwise, σ = −1 clockwise
B, C       the pins: A + R(σα)·(∓BD, AD)
q_j        offset point of beam 2 towards beam 1, by equations (9) and (10)
g_s        polynomial of degree d in y, fitted to the offset points of beam 2's related joints
c_j        x_1j − g_s(y_1j) ≤ 0 for the related joints of beam 1, equation (11) along x
=========  ====================================================================================================

This is written for the study alone, in NumPy, and shares nothing with the solvers.  Every function takes arrays with
any axes before the last, real or complex: a gradient at z + i·ε·e differs from that at z by the Hessian's column.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]  # real, or complex for a derivative by a complex step

Limits = Literal["none", "pin", "one side", "flipped", "away", "arm", "fixed", "vertical"]


@dataclass(frozen=True, slots=True)
class Mechanism:
    """Lengths in m, modulus in Pa; ``base`` is the distance of the clamped ends from the line of symmetry."""

    beam: float
    thickness: float
    width: float
    youngs_modulus: float
    base: float
    OA: float
    AD: float
    BD: float

    @property
    def bending_stiffness(self) -> float:
        """E·I, N·m²."""
        return self.youngs_modulus * self.width * self.thickness**3 / 12.0


# section 3.4 and figure 16 of the paper
PAPER = Mechanism(
    beam=0.060, thickness=0.001, width=0.008, youngs_modulus=2.0e11, base=0.0005, OA=0.010, AD=0.040, BD=0.020
)


@dataclass(frozen=True, slots=True)
class Reading:
    """What the text leaves open.

    ``reach`` (m) bounds the related joints by their height before the beams are bent; ``clamped`` says whether the
    joint next to the clamp, which cannot move, is among them.  ``degree`` None stands for no fitted curve: the joints
    of beam 1 keep the distance t from the nearest link of beam 2.
    """

    degree: int | None = 4
    reach: float = 0.025
    clamped: bool = True
    limits: Limits = "pin"
    limit: float = np.pi / 4.0
    sense: Literal[1, -1] = 1


@dataclass(frozen=True)
class Problem:
    """The discretised problem; z has 2N components, rad, and α is in rad from 0."""

    mechanism: Mechanism
    reading: Reading
    links: int = 40

    @cached_property
    def lengths(self) -> Array:
        """ℓ_i, (N + 1,)."""
        lengths = np.full(self.links + 1, self.mechanism.beam / self.links)
        lengths[[0, -1]] /= 2.0
        return lengths

    @cached_property
    def related(self) -> Array:
        """Numbers of the related joints, the same for both beams."""
        heights = (np.arange(1, self.links + 1) - 0.5) * self.mechanism.beam / self.links
        joints = 1 + np.flatnonzero(heights <= self.reading.reach)
        return joints if self.reading.clamped else joints[1:]

    @cached_property
    def moves_contact(self) -> Array:
        """Which components of z the contact depends on: all behind the last related joint are left out."""
        if self.reading.degree is None:
            return np.arange(2 * self.links)
        last = min(int(self.related[-1]), self.links)
        return np.concatenate((np.arange(last), self.links + np.arange(last)))

    @property
    def stiffness(self) -> float:
        """k, N·m/rad."""
        return self.mechanism.bending_stiffness * self.links / self.mechanism.beam

    @property
    def straight(self) -> Array:
        """z of the free beams."""
        return np.full(2 * self.links, np.pi / 2.0)

    def tangents(self, z: Array) -> Array:
        """θ_bi, (…, 2, N + 1)."""
        theta = np.full((*z.shape[:-1], 2, self.links + 1), np.pi / 2.0, dtype=z.dtype)
        theta[..., 1:] = z.reshape(*z.shape[:-1], 2, self.links)
        return theta

    def places(self, z: Array) -> tuple[Array, Array]:
        """x_bj and y_bj, j = 0..N + 1, (…, 2, N + 2): equation (6)."""
        theta = self.tangents(z)
        x = np.zeros((*z.shape[:-1], 2, self.links + 2), dtype=z.dtype)
        y = np.zeros_like(x)
        x[..., 1:] = np.cumsum(self.lengths * np.cos(theta), axis=-1)
        y[..., 1:] = np.cumsum(self.lengths * np.sin(theta), axis=-1)
        x += np.array([[-self.mechanism.base], [self.mechanism.base]])
        return x, y

    def energy(self, z: Array) -> tuple[Array, Array]:
        """PE = Σ ½ k δ², J, (…), and its gradient, (…, 2N): equation (4)."""
        delta = np.diff(self.tangents(z), axis=-1)
        moment = self.stiffness * delta
        gradient = moment.copy()
        gradient[..., :-1] -= moment[..., 1:]
        return 0.5 * np.sum(moment * delta, axis=(-2, -1)), gradient.reshape(z.shape)

    def pins(self, alpha: complex) -> Array:
        """B and C, (2, 2), m."""
        m, turn = self.mechanism, self.reading.sense * alpha
        c, s = np.cos(turn), np.sin(turn)
        arm = np.array([[-m.BD, m.AD], [m.BD, m.AD]])
        return np.asarray(np.array([0.0, m.OA]) + arm @ np.array([[c, s], [-s, c]]))

    def closure(self, z: Array, alpha: complex) -> tuple[Array, Array]:
        """Ends less pins, m, (…, 4), and the Jacobian, (…, 4, 2N): x and y of beam 1, then of beam 2."""
        x, y = self.places(z)
        theta, n, pins = self.tangents(z)[..., 1:], self.links, self.pins(alpha)
        jacobian = np.zeros((*z.shape[:-1], 4, 2 * n), dtype=z.dtype)
        for b in (0, 1):
            own = slice(b * n, (b + 1) * n)
            jacobian[..., 2 * b, own] = -self.lengths[1:] * np.sin(theta[..., b, :])
            jacobian[..., 2 * b + 1, own] = self.lengths[1:] * np.cos(theta[..., b, :])
        ends = np.stack((x[..., -1], y[..., -1]), axis=-1) - pins
        return ends.reshape(*z.shape[:-1], 4), jacobian

    def limited(self, alpha: complex) -> Array:
        """Least and most θ_1N and θ_2N that the limit of the angle leaves, rad, (2, 2); ±∞ where it leaves all.

        ``pin``: the beam leaves its pin within ``limit`` of the line to the other pin, on ``one side`` only where that
        is said; ``away``: of the opposite line; ``flipped``: beam 1 of the line to the other pin and beam 2 of the
        opposite one, which an acute angle of two lines allows as well; ``arm``: of the normal to BC towards the pivot;
        ``fixed`` and ``vertical``: of the line to the other pin and of the vertical as they are at α = 0.
        """
        turn, limit = self.reading.sense * alpha, self.reading.limit
        free = np.array([[-np.inf, np.inf], [-np.inf, np.inf]])
        within = np.array([-limit, limit])
        match self.reading.limits:
            case "none":
                found = free
            case "pin":
                found = np.array([[np.pi], [0.0]]) + turn + within
            case "one side":
                found = np.array([[np.pi + turn - limit, np.inf], [-np.inf, turn + limit]])
            case "flipped":
                found = np.full((2, 1), np.pi) + turn + within
            case "away":
                found = np.array([[0.0], [np.pi]]) + turn + within
            case "arm":
                found = np.full((2, 1), 0.5 * np.pi) + turn + within
            case "fixed":
                found = np.array([[np.pi], [0.0]]) + within
            case "vertical":
                found = np.full((2, 1), 0.5 * np.pi) + within
        return np.asarray(found)

    def contact(self, z: Array) -> tuple[Array, Array]:
        """c_j ≤ 0, m, (…, m), and the Jacobian, (…, m, 2N), of the related joints."""
        return self._nearest(z) if self.reading.degree is None else self._fitted(z, self.reading.degree)

    def _joints(self, z: Array, b: int) -> tuple[Array, Array, Array, Array]:
        """Places of a beam's related joints, (…, m), and their derivatives, (…, m, 2N)."""
        x, y = self.places(z)
        theta, n = self.tangents(z)[..., b, 1:], self.links
        before = self.related[:, None] > np.arange(1, n + 1)
        dx, dy = (np.zeros((*z.shape[:-1], len(self.related), 2 * n), dtype=z.dtype) for _ in range(2))
        own = slice(b * n, (b + 1) * n)
        dx[..., own] = np.where(before, (-self.lengths[1:] * np.sin(theta))[..., None, :], 0.0)
        dy[..., own] = np.where(before, (self.lengths[1:] * np.cos(theta))[..., None, :], 0.0)
        return x[..., b, self.related], y[..., b, self.related], dx, dy

    def _offset(self, z: Array) -> tuple[Array, Array, Array, Array]:
        """q_j of beam 2 with derivatives: P_2j + t·(−sin, cos) of θ_j−1 + ½(θ_j − θ_j−1)."""
        x, y, dx, dy = self._joints(z, 1)
        theta, n, t = self.tangents(z)[..., 1, :], self.links, self.mechanism.thickness
        mean = 0.5 * (theta[..., self.related] + theta[..., self.related - 1])
        dmean = np.zeros((len(self.related), 2 * n + 1))
        rows = np.arange(len(self.related))
        dmean[rows, n + self.related - 1] += 0.5
        dmean[rows[self.related > 1], n + self.related[self.related > 1] - 2] += 0.5  # θ_20 is clamped
        dmean = dmean[:, :-1]
        sine, cosine = np.sin(mean), np.cos(mean)
        return (
            x - t * sine,
            y + t * cosine,
            dx - t * cosine[..., None] * dmean,
            dy - t * sine[..., None] * dmean,
        )

    def _fitted(self, z: Array, degree: int) -> tuple[Array, Array]:
        """x_1j − g_s(y_1j); the powers are of (y − ½Y)/½Y, Y the greatest height of a related joint at the start.

        The fit is p = (VᵀV)⁻¹Vᵀx with V the powers at q_j; with r = x − Vp its derivative is
        dp = (VᵀV)⁻¹[dVᵀ r + Vᵀ(dx − dV p)].
        """
        half = 0.5 * float(self.related[-1]) * self.mechanism.beam / self.links
        exponents = np.arange(degree + 1)

        def powers(y: Array) -> tuple[Array, Array]:
            u = (y[..., None] - half) / half
            slopes = exponents[1:] * u ** exponents[:-1] / half
            return u**exponents, np.concatenate((np.zeros_like(u), slopes), axis=-1)

        xq, yq, dxq, dyq = self._offset(z)
        V, dV = powers(yq)
        VT = np.swapaxes(V, -1, -2)
        A = VT @ V
        p = np.linalg.solve(A, VT @ xq[..., None])[..., 0]
        r = xq - np.einsum("...mk,...k->...m", V, p)
        slope = np.einsum("...mk,...k->...m", dV, p)
        right = np.einsum("...mk,...m,...mv->...kv", dV, r, dyq) + VT @ (dxq - slope[..., None] * dyq)
        dp = np.linalg.solve(A, right)
        x, y, dx, dy = self._joints(z, 0)
        W, dW = powers(y)
        slope = np.einsum("...mk,...k->...m", dW, p)
        return x - np.einsum("...mk,...k->...m", W, p), dx - slope[..., None] * dy - W @ dp

    def _nearest(self, z: Array) -> tuple[Array, Array]:
        """t − n·(P_1j − P_2i), n the left normal (−sin θ_2i, cos θ_2i) of the link i of beam 2 that is nearest."""
        t, n = self.mechanism.thickness, self.links
        x, y = self.places(z)
        theta = self.tangents(z)[..., 1, :]
        first = z.reshape(-1, 2 * n)[0].real  # one link for each joint, whatever the axes before
        i = self._nearest_links(first)
        px, py, dpx, dpy = self._joints(z, 0)
        away, along = px - x[..., 1, i], py - y[..., 1, i]
        sine, cosine = np.sin(theta[..., i]), np.cos(theta[..., i])
        links = np.arange(1, n + 1)
        before = i[:, None] > links
        dbx = np.where(before, (-self.lengths[1:] * np.sin(theta[..., 1:]))[..., None, :], 0.0)
        dby = np.where(before, (self.lengths[1:] * np.cos(theta[..., 1:]))[..., None, :], 0.0)
        own = (i[:, None] == links).astype(float)
        jacobian = sine[..., None] * dpx - cosine[..., None] * dpy
        jacobian[..., n:] += (cosine * away + sine * along)[..., None] * own
        jacobian[..., n:] -= sine[..., None] * dbx - cosine[..., None] * dby
        return t + sine * away - cosine * along, jacobian

    def _nearest_links(self, z: Array) -> Array:
        """Numbers of the links; off a bend, where two are as near, they change on its bisector: the gap has no step."""
        x, y = self.places(z)
        joints = np.stack((x[1], y[1]), axis=-1)
        along = np.diff(joints, axis=0)
        apart = np.stack((x[0, self.related], y[0, self.related]), axis=-1)[:, None, :] - joints
        share = np.sum(apart[:, :-1] * along, axis=-1) / np.sum(along**2, axis=-1)
        off = apart[:, :-1] - np.clip(share, 0.0, 1.0)[..., None] * along
        i = np.argmin(np.sum(off**2, axis=-1), axis=-1)
        rows = np.arange(len(i))
        # off a bend both links have its joint as their nearest place, and round-off chooses
        bend = np.where(share[rows, i] > 1.0, i + 1, i)
        bent = (share[rows, i] > 1.0) | (share[rows, i] < 0.0)
        unit = along / np.linalg.norm(along, axis=-1, keepdims=True)
        before, after = np.maximum(bend - 1, 0), np.minimum(bend, self.links)
        behind = np.sum(apart[rows, bend] * (unit[before] + unit[after]), axis=-1) > 0.0
        return np.asarray(np.where(bent, np.where(behind, after, before), i))
