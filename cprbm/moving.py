"""How places of smooth lines move with the numbers around them.

==========  ==============================================================================
C, ψ        place of a beam's smooth line, and angle of its tangent; ′ is the derivative over s
z           local numbers: x and y of joint i, θ_{i−1}, θ_i, θ_{i+1}
δ, Θ, h     of the place's element: change of angle at its spring, turning Θ⁰ + δ, length
A, W, φ, R  of the arc from the element's border, :mod:`cprbm.smooth`; ξ = |off|/h, φ = Θξ
D           tangent at the border
p           joint i
==========  ==============================================================================

Places and vectors are numbers x + i·y.  At rest against the link a place is where the arc is; so, − before the border
and + after it,

    C_δ = D (±A_δ + i W_δ),    C′_δ = D (A′_δ ± i W′_δ),    C_δδ = D (±A_δδ + i W_δδ)
    C_θ = i (C − p),    C_δθ = i C_δ,    C_θθ = −(C − p),    C′_θ = i C′            (θ = θ_i)
    ψ_δ = Im(C̄′ C′_δ)/|C′|²,    ψ_θ = 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.once import once
from cprbm.polynomial import ComplexArray
from cprbm.smooth import ARCS, Points, series
from cprbm_scene.answer import Array, Ints

LOCALS = 5
BEFORE, AFTER = np.array(((-1.0, 1.0, 0.0), (0.0, -1.0, 1.0)))  # ∂δ over angles, before and after a border


@dataclass(frozen=True)
class Moving:
    """Some places (k,) of one line, or of several one behind the other.

    Attributes:
        carried: of their halves of elements, as the lines have it (9, k).
        sign: −1 before the border, +1 after it (k,).
        off: from the border, negative before it (k,).
        at, along: C and C′ (k,); arm: C − p; border: D.
        arc: |off| and φ (k,), and sin φ/φ and (1 − cos φ)/φ² with two derivatives over φ² each, (6, k).
        over_angles: ∂δ over (θ_{i−1}, θ_i, θ_{i+1}), (k, 3); over_turn: C_δ (k,).
    """

    carried: Array
    sign: Array
    off: Array
    at: ComplexArray
    along: ComplexArray
    arm: ComplexArray
    border: ComplexArray
    arc: tuple[Array, Array, Array]
    over_angles: Array
    over_turn: ComplexArray

    def only(self, these: Ints) -> Moving:
        """Some of the places, by their numbers."""
        u, phi, arc = self.arc
        return Moving(
            carried=self.carried[:, these],
            sign=self.sign[these],
            off=self.off[these],
            at=self.at[these],
            along=self.along[these],
            arm=self.arm[these],
            border=self.border[these],
            arc=(u[these], phi[these], arc[:, these]),
            over_angles=self.over_angles[these],
            over_turn=self.over_turn[these],
        )

    @once
    def along_over_turn(self) -> ComplexArray:
        """C′_δ (k,)."""
        u, phi, _ = self.arc
        _, R, R_1, _ = self.carried[5:]
        R_xi, cos, sin = R * u / self.carried[4], np.cos(phi), np.sin(phi)
        return np.asarray(self.border * (R_1 * cos - R_xi * sin + 1j * self.sign * (R_1 * sin + R_xi * cos)))

    @once
    def over_turn_twice(self) -> ComplexArray:
        """C_δδ (k,)."""
        u, phi, (S, S1, S2, V, V1, V2) = self.arc
        _, R, R_1, R_2 = self.carried[5:]
        q, xi = phi * phi, u / self.carried[4]
        P_1, P_2 = 2.0 * phi * S1, 2.0 * S1 + 4.0 * q * S2
        Q, Q_1, Q_2 = phi * V, V + 2.0 * q * V1, 6.0 * phi * V1 + 4.0 * phi * q * V2
        A = u * (R_2 * S + 2.0 * R_1 * xi * P_1 + R * xi * xi * P_2)
        W = u * (R_2 * Q + 2.0 * R_1 * xi * Q_1 + R * xi * xi * Q_2)
        return np.asarray(self.border * (self.sign * A + 1j * W))


def moving(*points: Points) -> Moving:
    """The places of one line, or of several one behind the other."""
    rows = [_rows(each) for each in points]
    every = rows[0] if len(rows) == 1 else np.concatenate(rows, axis=1)
    x, y, cos, sin, h, turning, R, R_1 = every[:8]
    sign, off, *vectors = every[9:]
    at, along = vectors[0] + 1j * vectors[1], vectors[2] + 1j * vectors[3]
    border, u = cos + 1j * sin, np.abs(off)
    phi = turning * u / h
    q = phi * phi
    S, S1, _, V, V1, _ = arc = series(ARCS, q)
    R_xi = R * u / h
    A = u * (R_1 * S + R_xi * (2.0 * phi * S1))
    W = u * (R_1 * phi * V + R_xi * (V + 2.0 * q * V1))
    return Moving(
        carried=every[:9],
        sign=sign,
        off=off,
        at=at,
        along=along,
        arm=at - (x + 1j * y),
        border=border,
        arc=(u, phi, arc),
        over_angles=np.where(sign[:, None] < 0.0, BEFORE, AFTER),
        over_turn=border * (sign * A + 1j * W),
    )


def _rows(points: Points) -> Array:
    rows = np.empty((15, points.s.size))
    rows[:9] = points.line.carried.take(points.half, axis=1)
    rows[9] = 1 - 2 * (points.half % 2)
    rows[10], rows[11], rows[12] = points.off, points.x, points.y
    np.multiply(points.speed, np.cos(points.tangent), out=rows[13])
    np.multiply(points.speed, np.sin(points.tangent), out=rows[14])
    return rows


def _over(z: Moving, on: ComplexArray, over_turn: ComplexArray, turned: ComplexArray) -> Array:
    """Derivatives over x, y and θ of vectors' parts along directions, ``on`` conjugated, from those over δ and of what
    turns with the link, (k, 5).
    """
    slopes = np.zeros((z.off.size, LOCALS))
    np.multiply((on * over_turn).real[:, None], z.over_angles, out=slopes[:, 2:])
    slopes[:, 3] -= (on * turned).imag
    return slopes


def _against(along: Array) -> ComplexArray:
    """Directions (k, 2) as conjugate numbers (k,)."""
    conjugate: ComplexArray = along[:, 0] - 1j * along[:, 1]
    return conjugate


def position_slopes(z: Moving, along: Array) -> Array:
    """∂(along·C) over the local numbers for directions ``along`` (k, 2): (k, 5)."""
    slopes = _over(z, _against(along), z.over_turn, z.arm)
    slopes[:, :2] = along
    return slopes


def tangent_slopes(z: Moving, along: Array) -> Array:
    """∂(along·C′) over the local numbers for directions ``along`` (k, 2): (k, 5)."""
    return _over(z, _against(along), z.along_over_turn, z.along)


def position_curvature(z: Moving, along: Array) -> Array:
    """Second derivatives of along·C over the local numbers for directions ``along`` (k, 2): (k, 5, 5)."""
    second, turns = np.zeros((z.off.size, LOCALS, LOCALS)), z.over_angles
    on = _against(along)
    second[:, 2:, 2:] = (on * z.over_turn_twice).real[:, None, None] * turns[:, :, None] * turns[:, None, :]
    over = -(on * z.over_turn).imag[:, None] * turns
    second[:, 3, 2:] += over
    second[:, 2:, 3] += over
    second[:, 3, 3] -= (on * z.arm).real
    return second


def angle_slopes(z: Moving) -> Array:
    """∂ψ over the local numbers, (k, 5)."""
    slopes = np.zeros((z.off.size, LOCALS))
    slopes[:, 2:] = (turned_by(z).imag)[:, None] * z.over_angles
    slopes[:, 3] += 1.0
    return slopes


def turned_by(z: Moving) -> ComplexArray:
    """C̄′ C′_δ/|C′|²: by how much C′ grows, and by what it turns with δ, (k,)."""
    return np.asarray(z.along_over_turn / z.along)
