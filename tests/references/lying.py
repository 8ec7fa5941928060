"""A curved beam clamped on top of a straight one, its tip pressed down by a dead force: it lies on the other.

=========  ==================================================================================
symbol     meaning
=========  ==================================================================================
A, B       the beam on top, stress-free an arc of curvature k > 0 away from B; the straight one below
L, t, EI   length, thickness, bending stiffness of each (L_A, ...); inextensible, shear-free
T          ½(t_A + t_B), normal distance of the neutral lines where the beams touch
F, β       dead force at A's tip and its direction, counter-clockwise from the clamps' tangent (−π/2: down)
s, σ       arc length of A and of B from the clamps
ψ, κ       tangent angle, counter-clockwise, and curvature dψ/ds; in the zone those of B
N, Q, M    tension, shear force and bending moment: the part beyond a cut exerts N t + Q n and M on this one
c, s_c     end of the zone on B and on A
q, P       pressure of the zone over dσ, from B on A; force at the point of lift-off
g          EI_A/(1 − Tκ)³, stiffness of A seen from B
=========  ==================================================================================

Axes: origin at B's clamp, x along the beams, A's clamp at (0, T); moments and rotations counter-clockwise.

Source: equilibrium of planar elastic rods (L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19) for
two rods that touch along parallel curves; frictionless, so that a contact force acts along the common normal
n, whose line meets both neutral lines: on each it is a force without moment.

Derivation.  In the zone σ < c the neutral lines are parallel curves:

    x_A = x_B + T n,    ds/dσ = 1 − Tκ,    κ_A = κ/(1 − Tκ)                                      (1)

Equilibrium of an element dσ of both, with κ_A ds = κ dσ:

    A:  N_A' = κ Q_A,    Q_A' = −κ N_A − q,    EI_A κ_A' = −(1 − Tκ) Q_A                         (2)
    B:  N_B' = κ Q_B,    Q_B' = −κ N_B + q,    EI_B κ'   = −Q_B                                  (3)

By (1) κ_A' = κ'/(1 − Tκ)², so that Q_A = −g κ'.  The sum of (2) and (3) is a constant force, and beyond the
zone only F is left, so it is F; across the beams

    (EI_B + g) κ' = −F·n,    Q_A = F·n g/(EI_B + g)                                              (4)

Beyond the zone B carries nothing and is straight, A is an elastica: EI_A κ_A' = −F·n.  Nothing acts a moment
at lift-off, so both curvatures are continuous there: B's is zero, and by (1) so is A's.  The shear forces are
not: Q_A jumps from (4) to F·n.  The difference is a force in the point of lift-off,

    P = −F·n EI_B/(EI_B + EI_A)   at σ = c,   where N_A = F·t and N_B = 0                        (5)

Two unknowns, c and κ(0), and two conditions, κ(c) = 0 at lift-off and κ_A(L_A) = k at the tip, which no moment
acts on (6).  Pressure by (2), with N_A integrated from (5):

    q = κ (F·t α − N_A) − F·n dα/dκ κ',    α = g/(EI_B + g),    dα/dκ = 3 T α (1 − α)/(1 − Tκ)   (7)

The clamp carries Q_A(0) and Q_B(0) of (4): no force of the contact is concentrated there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult, root

from tests.references.small import rectangle_second_moment

Array = NDArray[np.float64]
ACCURACY = 1e-13  # of the integration, relative and absolute, lengths over L_A
CONDITIONS = 1e-10  # largest error of (6), curvatures times L_A


@dataclass(frozen=True)
class Strip:
    """One beam: ``length``, ``thickness``, ``width`` in m, ``youngs_modulus`` in Pa."""

    length: float
    thickness: float
    width: float
    youngs_modulus: float

    @property
    def stiffness(self) -> float:
        """EI, N·m²."""
        return self.youngs_modulus * rectangle_second_moment(self.thickness, self.width)


@dataclass(frozen=True)
class Lying:
    """Both beams and the pull, in SI units and radians.

    Attributes:
        top, bottom: A and B.
        curvature: k of A, 1/m, positive.
        force: F, N.
        pull: β, rad.

    Every other attribute raises ValueError where no zone from the clamp to one lift-off point solves (4)-(6), or
    where it would have to pull: q < 0 or P < 0.
    """

    top: Strip
    bottom: Strip
    curvature: float
    force: float
    pull: float = -0.5 * pi

    @property
    def distance(self) -> float:
        """T, m."""
        return 0.5 * (self.top.thickness + self.bottom.thickness)

    @property
    def lift_off(self) -> tuple[float, float]:
        """s_c on A and c on B, m."""
        return float(self._zone.y[4, -1]) * self.top.length, float(self._zone.t[-1]) * self.top.length

    @property
    def lift_off_angle(self) -> float:
        """ψ(c), which is B's rotation beyond the zone, rad."""
        return float(self._zone.y[0, -1])

    @property
    def lift_off_force(self) -> float:
        """P (5), N; it acts on A along n(ψ(c))."""
        share = self.bottom.stiffness / (self.bottom.stiffness + self.top.stiffness)
        return -share * float(self._across(self.lift_off_angle))

    def pressure(self, sigma: Array) -> Array:
        """q (7) at arc lengths ``sigma`` (n,) of B within the zone, N per metre of B."""
        z = self._forces.sol(sigma / self.top.length)
        return self._pressed(z[0], z[1], z[2]) / self.top.length

    def along_top(self, sigma: Array) -> Array:
        """Arc lengths s (n,) on A that lie on B at ``sigma`` (n,) within the zone, m."""
        return np.asarray(self._zone.sol(sigma / self.top.length)[4]) * self.top.length

    @property
    def contact_force(self) -> Array:
        """Resultant (2,) of pressure and lift-off force on A, N."""
        psi = self.lift_off_angle
        return self._forces.y[4:6, -1] + self.lift_off_force * np.array([-sin(psi), cos(psi)])

    @property
    def contact_centre(self) -> float:
        """Mean arc length of the contact on A, weighted by the magnitudes of its forces, m."""
        pressed, moment = self._forces.y[6:, -1]
        P, (s_c, _) = self.lift_off_force, self.lift_off
        return float((moment * self.top.length + P * s_c) / (pressed + P))

    @property
    def reaction(self) -> tuple[Array, Array]:
        """Forces (2,) of the clamps on A and on B, N: the tangent there is (1, 0)."""
        kappa, tension = self._forces.y[1:3, 0]
        shear = self._across(0.0) * self._share(kappa)
        top = -np.array([tension, shear])
        return top, -self._pull - top

    @property
    def reaction_moment(self) -> tuple[float, float]:
        """Moments of the clamps on A and on B, counter-clockwise, N·m."""
        kappa = float(self._zone.y[1, 0]) / self.top.length
        top = kappa / (1.0 - self.distance * kappa) - self.curvature
        return -self.top.stiffness * top, -self.bottom.stiffness * kappa

    @property
    def rotation(self) -> float:
        """Of A's tip, rad: its angle less the stress-free one."""
        return float(self._free.y[0, -1]) - self.curvature * self.top.length

    @property
    def displacement(self) -> Array:
        """Of A's tip (2,), m."""
        k, turn = self.curvature, self.curvature * self.top.length
        rest = np.array([sin(turn) / k, (1.0 - cos(turn)) / k + self.distance])
        return self._free.y[2:4, -1] * self.top.length - rest

    @property
    def bottom_displacement(self) -> Array:
        """Of B's tip (2,), m."""
        place, psi = self._zone.y[2:4, -1] * self.top.length, self.lift_off_angle
        rest = np.array([self.bottom.length, 0.0])
        return place + (self.bottom.length - self.lift_off[1]) * np.array([cos(psi), sin(psi)]) - rest

    @property
    def potential_energy(self) -> float:
        """Strain energy less the work of F from the stress-free shapes, J."""
        return float(self._zone.y[5, -1] + self._free.y[4, -1]) - float(self._pull @ self.displacement)

    @property
    def _pull(self) -> Array:
        """F (2,), N."""
        return self.force * np.array([cos(self.pull), sin(self.pull)])

    def _along(self, psi: float | Array) -> Array:
        """F·t, N."""
        return np.asarray(self.force * np.cos(self.pull - psi))

    def _across(self, psi: float | Array) -> Array:
        """F·n, N."""
        return np.asarray(self.force * np.sin(self.pull - psi))

    # From here on lengths are over L_A and curvatures times L_A; forces and stiffnesses stay in SI.

    @property
    def _unit(self) -> float:
        """F·n times this over a stiffness is κ'."""
        return self.top.length**2

    def _thinner(self, kappa: float | Array) -> Array:
        """1 − Tκ."""
        return np.asarray(1.0 - self.distance / self.top.length * kappa)

    def _g(self, kappa: float | Array) -> Array:
        return self.top.stiffness / self._thinner(kappa) ** 3

    def _share(self, kappa: float | Array) -> Array:
        """α."""
        return self._g(kappa) / (self.bottom.stiffness + self._g(kappa))

    def _bending(self, psi: float | Array, kappa: float | Array) -> Array:
        """κ' (4)."""
        return -self._across(psi) * self._unit / (self.bottom.stiffness + self._g(kappa))

    def _pressed(self, psi: float | Array, kappa: float | Array, tension: float | Array) -> Array:
        """q (7) over the scaled σ, N."""
        share = self._share(kappa)
        slope = 3.0 * self.distance / self.top.length * share * (1.0 - share) / self._thinner(kappa)
        return (self._along(psi) * share - tension) * kappa - self._across(psi) * slope * self._bending(psi, kappa)

    def _integrated_zone(self, kappa: float, c: float) -> OptimizeResult:
        """ψ, κ, x_B, y_B, s and the strain energy from the clamp to c."""
        EI_A, EI_B, L, k = self.top.stiffness, self.bottom.stiffness, self.top.length, self.curvature * self.top.length

        def slopes(_: float, z: Array) -> list[float]:
            psi, kappa = z[:2]
            thinner = float(self._thinner(kappa))
            energy = 0.5 * (EI_B * kappa**2 + EI_A * thinner * (kappa / thinner - k) ** 2) / L
            return [kappa, float(self._bending(psi, kappa)), cos(psi), sin(psi), thinner, energy]

        return _integrated(slopes, (0.0, c), [0.0, kappa, 0.0, 0.0, 0.0, 0.0])

    def _integrated_free(self, zone: OptimizeResult) -> OptimizeResult:
        """ψ, κ, x, y of A and its strain energy from lift-off to the tip."""
        EI, L, k = self.top.stiffness, self.top.length, self.curvature * self.top.length

        def slopes(_: float, z: Array) -> list[float]:
            psi, kappa = z[:2]
            bending = -float(self._across(psi)) * self._unit / EI
            return [kappa, bending, cos(psi), sin(psi), 0.5 * EI * (kappa - k) ** 2 / L]

        psi, kappa, x, y, s, _ = zone.y[:, -1]
        T = self.distance / L
        start = [psi, kappa / float(self._thinner(kappa)), x - T * sin(psi), y + T * cos(psi), 0.0]
        return _integrated(slopes, (s, 1.0), start)

    @cached_property
    def _zone(self) -> OptimizeResult:
        """The solution of (6).

        Raises:
            ValueError: there is none, or it pulls.
        """
        L, k = self.top.length, self.curvature * self.top.length

        def conditions(z: Array) -> list[float]:
            zone = self._integrated_zone(z[0], z[1])
            return [float(zone.y[1, -1]), float(self._integrated_free(zone).y[1, -1]) - k]

        # small slopes: F times the free length unbends A, and F alone bends both within the zone
        free = self.top.stiffness * self.curvature / (-self._across(0.0) * L)
        if not 0.0 < free < 1.0:
            raise ValueError("the force does not press A on B over a length")
        c = 1.0 - float(free)
        kappa = self._across(0.0) * L**2 * c / (self.top.stiffness + self.bottom.stiffness)
        found = root(conditions, [float(kappa), c], tol=1e-14)
        kappa, c = found.x
        if not 0.0 < c < min(1.0, self.bottom.length / L) or np.max(np.abs(conditions(found.x))) > CONDITIONS:
            raise ValueError("no zone from the clamp to one lift-off point")
        return self._integrated_zone(kappa, c)

    @cached_property
    def _free(self) -> OptimizeResult:
        return self._integrated_free(self._zone)

    @cached_property
    def _forces(self) -> OptimizeResult:
        """ψ, κ, N_A, s, ∫ q n dσ (2), ∫ q dσ and ∫ q s dσ from the clamp to c."""

        def slopes(_: float, z: Array) -> list[float]:
            psi, kappa, tension, s = z[:4]
            q = float(self._pressed(psi, kappa, tension))
            pull = kappa * float(self._across(psi) * self._share(kappa))
            bending = float(self._bending(psi, kappa))
            return [kappa, bending, pull, float(self._thinner(kappa)), -q * sin(psi), q * cos(psi), q, q * s]

        zone = self._zone
        c, start = zone.t[-1], [0.0, zone.y[1, 0], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        gained = _integrated(slopes, (0.0, c), start).y[2, -1]  # of N_A, whatever it begins with
        start[2] = float(self._along(self.lift_off_angle)) - gained
        forces = _integrated(slopes, (0.0, c), start)
        q = self._pressed(*forces.sol(np.linspace(0.0, c, 201))[:3])
        if np.min(q) < 0.0 or self.lift_off_force < 0.0:
            raise ValueError("the beams would have to pull each other")
        return forces


def _integrated(
    slopes: Callable[[float, Array], list[float]], span: tuple[float, float], start: list[float]
) -> OptimizeResult:
    return solve_ivp(slopes, span, start, "DOP853", rtol=ACCURACY, atol=ACCURACY, dense_output=True)
