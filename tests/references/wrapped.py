"""A cantilever clamped tangent on top of a rigid circle, its tip pulled by a dead force: exact.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
L, EI    length, bending stiffness of the inextensible beam
r, t     radius of the circle, thickness of the beam: its edge touches the circle
R        r + t/2, radius of the neutral line where the beam lies on the circle
F, β     dead force at the tip; its direction, clockwise from the clamp's tangent (π/2: down)
s, θ     arc length from the clamp; tangent angle, clockwise; ψ = θ(L)
ϑ        θ − β + π/2, the same angle measured so that the force pulls at ϑ = π/2
c        wrap length, c = R θ(c): the beam lies on the circle for s ≤ c
κ        θ', curvature; ℓ = L − c, the free length; q = √(F/EI)
U        sin ϑ(L) − sin ϑ(c)
m, p     parameter of the elliptic integrals, m = 1 − p = (1 + sin ϑ(L))/2
v        amplitude of the free part, from the tip; RF Carlson's integral, E of the second kind
T, P     tension in the wrap; force at the point of lift-off
=======  ====================================================================================

Axes: origin at the clamp, x along the beam, y away from the circle, whose center is (0, −R).  Angles here
are clockwise, so that they are positive where the beam follows the circle; moments and rotations handed out
are counter-clockwise.

Source: L. D. Landau and E. M. Lifshitz, Theory of Elasticity, §19 (the elastica); elliptic integrals after
Bisshopp and Drucker (1945) as in :mod:`tests.references.elastica`; the contact of an elastica with a rigid
circle by the equilibrium of its two parts.

Derivation.  On the circle κ = 1/R is constant, so the bending moment EI/R is, so there is no shear force, so
the tension T is constant and the circle answers with the line pressure T/R.  The free part begins with the
same moment (nothing acts a moment at lift-off) and with the force F alone:

    EI κ' = −F cos ϑ,    ½ EI κ² = F (sin ϑ(L) − sin ϑ),    κ(L) = 0                       (1)
    at lift-off κ = 1/R:    U = EI / (2 F R²)                                              (2)

Its tension there is F sin ϑ(c) = T, its shear force F cos ϑ(c), which the wrap does not have: it is P, the
force of the circle at the point of lift-off.

    T = F sin ϑ(c) ≥ 0,    P = F cos ϑ(c) > 0                                              (3)

With 1 + sin ϑ = 2 m sin² φ as in Bisshopp and Drucker, and v the amplitude that complements φ
(F(v) = K − F(φ)), v = 0 at the tip and at lift-off

    tan² v = (U/2) / (p (1 − p − U/2)),    1 − m sin² v = p / (p + U/2)                    (4)
    q ℓ = sin v RF(cos² v, 1 − m sin² v, 1)                                                (5)
    q ∫ sin ϑ ds = q ℓ − 2 (E(v) − m sin φ sin v),    sin² φ = 1 − U / (2 m)                (6)
    F ∫ cos ϑ ds = EI κ(c)        (the moment of F about lift-off)                         (7)

The one unknown is p: R θ(c) + ℓ = L (8).  Its left side falls with p, since sin ϑ(L) = 1 − 2 p at fixed U, so
the solution is the only one.  A beam that is not wrapped has c = 0 and U = 1 − 2 p − sin ϑ(0) instead of (2).
The wrap begins (first beyond the clamp) where both hold (9).  It does so with P already as large as the shear
force that the clamp carried before: the contact force jumps there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import asin, atan2, cos, exp, hypot, log, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipj, ellipkm1, elliprf

from tests.references.small import rectangle_second_moment

Array = NDArray[np.float64]
_LEAST = -690.0  # of log p: the tip's tangent is the force's direction to the last digit


@dataclass(frozen=True)
class Wrapped:
    """The beam, the circle and the pull, in SI units and radians.

    Attributes:
        length: L, m.
        radius: r of the circle, m.
        thickness: t, m.
        width: m.
        youngs_modulus: Pa.
        force: F, N.
        pull: β, rad, in (0, 3π/2]; down is π/2.

    Every other attribute raises ValueError where the closed form does not hold: for F ≤ 0, a pull outside its
    range, a force too large for floating point, and, for a pull of more than π/2, where the beam is not pressed
    on the circle all the way from the clamp to lift-off (T < 0).
    """

    length: float
    radius: float
    thickness: float
    width: float
    youngs_modulus: float
    force: float
    pull: float = 0.5 * pi

    @property
    def stiffness(self) -> float:
        """EI, N·m²."""
        return self.youngs_modulus * rectangle_second_moment(self.thickness, self.width)

    @property
    def neutral_radius(self) -> float:
        """R, m."""
        return self.radius + 0.5 * self.thickness

    @cached_property
    def closing_load(self) -> float:
        """F at which the wrap begins, N (9)."""
        self._check()
        if self.pull > 0.5 * pi:
            raise ValueError("under a pull of more than π/2 a beam does not begin to wrap at its clamp")
        start, R = 0.5 * pi - self.pull, self.neutral_radius

        # U = EI/(2 F R²) makes q = 1/(R √(2 U)), and (5) then gives L/R
        def excess(log_p: float) -> float:
            p = exp(log_p)
            U = 1.0 - 2.0 * p - sin(start)
            return R * sqrt(2.0 * U) * _free_length(p, U) - self.length

        p = exp(brentq(excess, _LEAST, self._largest_log_p(start), xtol=1e-15, rtol=1e-15))
        return self.stiffness / (2.0 * R**2 * (1.0 - 2.0 * p - sin(start)))

    @property
    def wrapped(self) -> bool:
        """Whether the beam touches the circle beyond its clamp."""
        return self.pull > 0.5 * pi or self.force > self.closing_load

    @property
    def wrap_length(self) -> float:
        """c, m; zero where the beam is not wrapped."""
        return self.neutral_radius * self._lift_off_angle

    @property
    def tension(self) -> float:
        """T in the wrap (3), or at the clamp of a beam that is not wrapped, N."""
        return self.force * cos(self.pull - self._lift_off_angle)

    @property
    def line_pressure(self) -> float:
        """T/R along the wrap, N/m of the neutral line; zero without wrap."""
        return self.tension / self.neutral_radius if self.wrapped else 0.0

    @property
    def lift_off_force(self) -> float:
        """P (3), N; zero without wrap."""
        return self.force * sin(self.pull - self._lift_off_angle) if self.wrapped else 0.0

    @property
    def contact_force(self) -> Array:
        """Resultant (2,) of pressure and lift-off force on the beam, N."""
        if not self.wrapped:
            return np.zeros(2)
        angle = self._lift_off_angle
        # ∫ (T/R) (sin θ, cos θ) ds + P (sin θ, cos θ) at lift-off
        pressed = self.tension * np.array([1.0 - cos(angle), sin(angle)])
        return pressed + self.lift_off_force * np.array([sin(angle), cos(angle)])

    @property
    def contact_centre(self) -> float:
        """Mean arc length of the contact, weighted by the magnitudes of its forces, m.

        Raises:
            ValueError: there is no wrap.
        """
        if not self.wrapped:
            raise ValueError("a contact without force has no centre")
        c = self.wrap_length
        pressed = self.line_pressure * c
        return (0.5 * pressed * c + self.lift_off_force * c) / (pressed + self.lift_off_force)

    @property
    def reaction(self) -> Array:
        """Force (2,) of the clamp on the beam, N."""
        shear = 0.0 if self.wrapped else self.force * sin(self.pull)
        return np.array([-self.tension, shear])

    @property
    def reaction_moment(self) -> float:
        """Moment of the clamp on the beam, counter-clockwise, N·m."""
        return self.stiffness * (1.0 / self.neutral_radius if self.wrapped else self._lift_off_curvature)

    @property
    def rotation(self) -> float:
        """Of the tip, counter-clockwise, rad: −ψ."""
        p, _ = self._shape
        # π/2 − 2 asin √p is asin(1 − 2 p) with all digits
        return -(self.pull - 2.0 * asin(sqrt(p)))

    @property
    def tip(self) -> Array:
        """Position (2,) of the tip, m."""
        R, angle = self.neutral_radius, self._lift_off_angle
        lift_off = R * np.array([sin(angle), cos(angle) - 1.0])
        along = np.array([cos(self.pull), -sin(self.pull)])
        across = np.array([sin(self.pull), cos(self.pull)])
        lever = self.stiffness * self._lift_off_curvature / self.force  # (7)
        return lift_off + self._sag * along + lever * across

    @property
    def displacement(self) -> Array:
        """Of the tip (2,), m, from the straight beam."""
        return self.tip - np.array([self.length, 0.0])

    @property
    def strain_energy(self) -> float:
        """∫ ½ EI κ² ds, J: of the wrap, and of the free part by (1)."""
        p, _ = self._shape
        wrap = 0.5 * self.stiffness * self.wrap_length / self.neutral_radius**2
        free = self.length - self.wrap_length
        return wrap + self.force * ((1.0 - 2.0 * p) * free - self._sag)

    @property
    def potential_energy(self) -> float:
        """Strain energy less the work of F from the straight beam, J."""
        along = np.array([cos(self.pull), -sin(self.pull)])
        return self.strain_energy - self.force * float(self.displacement @ along)

    def curvature(self, s: Array) -> Array:
        """Change of curvature (n,) at the arc lengths ``s`` (n,) in [0, L], 1/m, counter-clockwise.

        κ of the free part is 2 q √m cn, by (1); the elliptic function's argument runs from the tip back.
        """
        p, _ = self._shape
        q = sqrt(self.force / self.stiffness)
        cn = ellipj(ellipkm1(p) - q * (self.length - s), 1.0 - p)[1]
        return -np.where(
            self.wrapped & (s <= self.wrap_length), 1.0 / self.neutral_radius, 2.0 * q * sqrt(1.0 - p) * cn
        )

    def bending_stress(self, points: int) -> Array:
        """E t/2 times the change of curvature (points,), Pa, at equal steps of arc length."""
        curvature = self.curvature(np.linspace(0.0, self.length, points))
        return 0.5 * self.youngs_modulus * self.thickness * curvature

    @property
    def _lift_off_angle(self) -> float:
        """θ(c), rad."""
        if not self.wrapped:
            return 0.0
        p, U = self._shape
        return self._angle(p, U)

    @property
    def _lift_off_curvature(self) -> float:
        """κ(c), 1/m, by (1)."""
        _, U = self._shape
        return sqrt(2.0 * self.force * U / self.stiffness)

    @property
    def _sag(self) -> float:
        """∫ sin ϑ ds over the free part (6), m."""
        p, U = self._shape
        sin_v, cos_v = _amplitude(p, U)
        m = 1.0 - p
        sin_phi = sqrt(1.0 - 0.5 * U / m)
        integral = _free_length(p, U) - 2.0 * (float(ellipeinc(atan2(sin_v, cos_v), m)) - m * sin_phi * sin_v)
        return integral * sqrt(self.stiffness / self.force)

    @cached_property
    def _shape(self) -> tuple[float, float]:
        """p and U."""
        self._check()
        p = self._wrapped_p() if self.wrapped else self._free_p()
        start = sin(0.5 * pi - self.pull)
        return p, self._wrapped_U if self.wrapped else 1.0 - 2.0 * p - start

    @property
    def _wrapped_U(self) -> float:
        return self.stiffness / (2.0 * self.force * self.neutral_radius**2)  # (2)

    def _angle(self, p: float, U: float) -> float:
        """θ(c) from sin ϑ(c) = 1 − 2 p − U."""
        return self.pull - 2.0 * asin(sqrt(min(1.0, p + 0.5 * U)))

    def _wrapped_p(self) -> float:
        """p of (8)."""
        U, R = self._wrapped_U, self.neutral_radius
        q = sqrt(self.force / self.stiffness)
        # θ(c) ≥ 0, and T ≥ 0 which is ϑ(c) ≥ 0
        least_sine = max(0.0, sin(0.5 * pi - self.pull))
        largest = 0.5 * (1.0 - U - least_sine)

        def excess(log_p: float) -> float:
            p = exp(log_p)
            return R * self._angle(p, U) + _free_length(p, U) / q - self.length

        if largest <= 0.0 or excess(log(largest)) > 0.0:
            raise ValueError("the beam is not pressed on the circle all the way from its clamp to lift-off")
        if excess(_LEAST) < 0.0:
            raise ValueError(f"a force of {self.force} N leaves p below the range of floating point")
        return exp(brentq(excess, _LEAST, log(largest), xtol=1e-15, rtol=1e-15))

    def _free_p(self) -> float:
        """p of a beam that is not wrapped: the free length is L."""
        q, start = sqrt(self.force / self.stiffness), 0.5 * pi - self.pull

        def excess(log_p: float) -> float:
            p = exp(log_p)
            return _free_length(p, 1.0 - 2.0 * p - sin(start)) / q - self.length

        return exp(brentq(excess, _LEAST, self._largest_log_p(start), xtol=1e-15, rtol=1e-15))

    def _largest_log_p(self, start: float) -> float:
        """Where U = 0: no turning at all; a hair less, so that U is positive."""
        return log(0.5 * (1.0 - sin(start)) * (1.0 - 1e-15))

    def _check(self) -> None:
        sizes = (self.length, self.radius, self.thickness, self.width, self.youngs_modulus, self.force)
        if not all(0.0 < size < float("inf") for size in sizes):
            raise ValueError(f"lengths, modulus and force must be positive, not {sizes}")
        if not 0.0 < self.pull <= 1.5 * pi:
            raise ValueError(f"the pull must lie in (0, 3π/2], not {self.pull}")


def _free_length(p: float, U: float) -> float:
    """q ℓ (5)."""
    sine, cosine = _amplitude(p, U)
    return sine * float(elliprf(cosine**2, p / (p + 0.5 * U), 1.0))


def _amplitude(p: float, U: float) -> tuple[float, float]:
    """sin v and cos v at lift-off (4), each with all its digits."""
    opposite, adjacent = sqrt(0.5 * U), sqrt(p * (1.0 - p - 0.5 * U))
    return opposite / hypot(opposite, adjacent), adjacent / hypot(opposite, adjacent)
