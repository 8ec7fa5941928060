"""The rotational hinge as a boundary-value problem of two inextensible elasticas with one point of contact.

===========  ==============================================================================================
symbol       meaning
===========  ==============================================================================================
R, (xc, ±yc) radius and centres of the two half circles; beam 1 is the lower half about (xc, +yc) from
             A = (xc − R, yc) to B = (xc + R, yc), beam 2 the mirror image about y = 0 from C to D
t, w, E      thickness, width, Young's modulus; EI = E w t³ / 12; L = π R each beam's length
M            moment on the rigid link BD, counter-clockwise; the link AC is fixed
s            arc length from A (beam 1), from C (beam 2)
x, y, θ      neutral line and its tangent angle; φ = θ(L) − θ0(L) the rotation of BD
κ0           initial curvature, +1/R for beam 1, −1/R for beam 2
m, F         bending moment and internal force (Fx, Fy): what the part beyond s does to the part before it
P, s1, s2    contact force, and the arc lengths at which the beams touch
e            unit vector along the common normal, from beam 2 to beam 1
===========  ==============================================================================================

Source: Euler's elastica with initial curvature; S. S. Antman, Nonlinear Problems of Elasticity, chapter 4
(planar rods, balance laws), restricted to no stretch and no shear.  The mechanism is that of Jin et al.,
Mechanism and Machine Theory 145 (2020) 103700, section 3.2.

Each beam, away from the contact:

    x' = cos θ,  y' = sin θ,  θ' = κ0 + m/EI,  m' = Fx sin θ − Fy cos θ,  F' = 0,  u' = m²/(2 EI)          (1)

At the contact the edges touch without friction, so the force acts along the common normal and through both
neutral lines: m does not jump, F does,

    F(s1+) = F(s1−) − P e  on beam 1,     F(s2+) = F(s2−) + P e  on beam 2                                 (2)

Unknowns: m(0), Fx(0), Fy(0) of both beams, P, s1, s2: nine.  Conditions:

    θ1(L) − θ10(L) = θ2(L) − θ20(L)                                             BD turns as one            (3)
    r1(L) − r2(L) = Q(φ) (B − D)                                                BD is rigid                (4)
    F1(L) + F2(L) = 0,   M − m1(L) − m2(L) − (r2(L) − r1(L)) × F2(L) = 0        equilibrium of BD          (5)
    (r1(s1) − r2(s2)) · τ1 = 0,  (r1(s1) − r2(s2)) · τ2 = 0,  (r1(s1) − r2(s2)) · e = t    contact         (6)

with τ the tangents and e the left-hand normal of beam 2 at s2 (both beams run to the right where they touch).
Without contact P, s1, s2 and (6) fall away; at the first touch P = 0 and M is unknown in its stead.

The equations are solved without dimension (lengths over R, forces over EI/R², moments over EI/R) by single
shooting with the Runge-Kutta method of order 8 (DOP853) and Newton's method; the derivative is taken by the
complex step, all columns in one integration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.spatial import cKDTree

from tests.references.integrated import end_of

Array = NDArray[np.float64]
_RTOL, _ATOL = 1e-13, 1e-14
_STEP = 1e-40  # of the complex step: far below round-off, no subtraction takes place
_FREE, _TOUCH = 6, 9  # numbers of unknowns
_LARGEST = 4.0  # of |M| R/(EI)


class SinglePointContactError(ValueError):
    """The hinge is not in equilibrium with no contact or one point of contact under this moment."""


@dataclass(frozen=True, slots=True)
class Hinge:
    """Dimensions in metres, ``youngs_modulus`` in Pa; centres of the arcs at (``xc``, ±``yc``)."""

    radius: float
    xc: float
    yc: float
    thickness: float
    width: float
    youngs_modulus: float

    @property
    def bending_stiffness(self) -> float:
        """EI = E w t³/12, N·m²."""
        return self.youngs_modulus * self.width * self.thickness**3 / 12.0

    @property
    def length(self) -> float:
        """Arc length of either beam, m."""
        return float(np.pi * self.radius)


PAPER = Hinge(radius=0.025, xc=0.026, yc=0.02625, thickness=0.002, width=0.008, youngs_modulus=2.3e9)


@dataclass(frozen=True, slots=True)
class HingeSolution:
    """Equilibrium under one moment; SI units, angles in radians.

    Attributes:
        moment: M on BD.
        displacement_B, displacement_D: (2,).
        rotation: of BD.
        contact_force: magnitude P; 0 where the beams are apart.
        contact_arc_lengths: (s1, s2), or None where the beams are apart.
        contact_point: (2,) where the edges touch, midway between the neutral lines, or None.
        smallest_gap: least distance of the neutral lines less the thickness; about 0 in contact.
        reaction_A, reaction_C: (2,) force of the ground on the beams.
        reaction_moment_A, reaction_moment_C: moment of the ground on the beams about A and C.
        potential_energy: strain energy less M φ.
        residual: largest violation of (3)-(6), without dimension.
    """

    hinge: Hinge
    moment: float
    displacement_B: Array
    displacement_D: Array
    rotation: float
    contact_force: float
    contact_arc_lengths: tuple[float, float] | None
    contact_point: Array | None
    smallest_gap: float
    reaction_A: Array
    reaction_C: Array
    reaction_moment_A: float
    reaction_moment_C: float
    potential_energy: float
    residual: float
    _unknowns: Array

    def curvature_change(self, beam: int, s: Array) -> Array:
        """Change of curvature m/EI (n,), 1/m, at arc lengths ``s`` (n,), m, of ``beam`` 1 or 2."""
        return self._state(beam, s)[3] / self.hinge.radius

    def bending_stress(self, beam: int, s: Array) -> Array:
        """E t/2 times the change of curvature (n,), Pa; positive turns the tangent counter-clockwise."""
        return 0.5 * self.hinge.youngs_modulus * self.hinge.thickness * self.curvature_change(beam, s)

    def shape(self, beam: int, s: Array) -> Array:
        """Neutral line (2, n), m, at arc lengths ``s`` (n,), m."""
        offset = np.array([[self.hinge.xc], [0.0]])
        return self.hinge.radius * self._state(beam, s)[:2] + offset

    def _state(self, beam: int, s: Array) -> Array:
        if beam not in (1, 2):
            raise ValueError(f"beam 1 or 2, not {beam}")
        places = np.asarray(s, dtype=float) / self.hinge.radius
        return _states(self.hinge, self._unknowns, places)[:, beam - 1]


@lru_cache(maxsize=64)
def solve(hinge: Hinge, moment: float) -> HingeSolution:
    """Equilibrium under ``moment`` (N·m), on the branch that starts at rest.

    Raises:
        ValueError: |M| R/(EI) is more than 4, beyond which this branch has not been examined.
        SinglePointContactError: the branch is lost, or there the beams would pull on each other, or overlap
            away from the point of contact.
    """
    moment_unit = hinge.bending_stiffness / hinge.radius
    target = moment / moment_unit
    if not abs(target) <= _LARGEST:
        raise ValueError(f"M must lie within ±{_LARGEST * moment_unit} N·m, not {moment}")
    touch = _first_touch(hinge, float(np.sign(target)) if target else 1.0)
    if touch is None or abs(target) <= abs(touch[0]):
        unknowns = _follow(hinge, np.zeros(_FREE), 0.0, target)
    else:
        unknowns = _follow(hinge, touch[1], touch[0], target)
    return checked(_solution(hinge, unknowns, target))


def closing_moment(hinge: Hinge, sign: float = 1.0) -> float:
    """The moment (N·m) of the given ``sign`` at which the edges first touch.

    Raises:
        SinglePointContactError: they do not touch before BD has turned by half a turn.
    """
    touch = _first_touch(hinge, float(np.sign(sign)))
    if touch is None:
        raise SinglePointContactError("the beams do not touch under a moment of this sign")
    return touch[0] * hinge.bending_stiffness / hinge.radius


# ---------------------------------------------------------------------------------------------- equations


def _start(hinge: Hinge) -> tuple[Array, Array]:
    """(x, y, θ) (3, 2) of the two beams' starts over R, x from xc; and κ0 (2,)."""
    height = hinge.yc / hinge.radius
    start = np.array([[-1.0, -1.0], [height, -height], [-0.5 * np.pi, 0.5 * np.pi]])
    return start, np.array([1.0, -1.0])


def _integrate(state: Any, force: Any, kappa0: Array, length: Any, at: Array | None = None) -> Any:
    """(1) over ``length`` (2, K) from ``state`` (5, 2, K) with ``force`` (2, 2, K): the state at the end.

    With ``at`` (n,) in [0, 1]: the states (5, 2, K, n) at these fractions of the length.
    """
    shape = state.shape

    def slope(_: float, flat: Any) -> Any:
        _, _, theta, m, _ = flat.reshape(shape)
        change = np.empty(shape, dtype=flat.dtype)
        np.cos(theta, out=change[0])
        np.sin(theta, out=change[1])
        change[2] = kappa0[:, None] + m
        change[3] = force[0] * change[1] - force[1] * change[0]
        change[4] = 0.5 * m * m
        change *= length
        return change.ravel()

    if at is None:
        # the compiled method knows no complex numbers: a real and an imaginary part for each
        kind = state.dtype
        begin = np.ascontiguousarray(state).ravel().view(float)
        end = end_of(lambda s, flat: slope(s, flat.view(kind)).view(float), (0.0, 1.0), begin, _RTOL, _ATOL)
        return end.view(kind).reshape(shape)
    run = solve_ivp(slope, (0.0, 1.0), state.ravel(), "DOP853", t_eval=at, rtol=_RTOL, atol=_ATOL)
    if not run.success:
        raise SinglePointContactError(f"the integration failed: {run.message}")
    return run.y.reshape(*shape, -1)


def _initial(hinge: Hinge, unknowns: Any) -> tuple[Any, Any, Array]:
    """State (5, 2, K), force (2, 2, K) at the starts, and κ0."""
    start, kappa0 = _start(hinge)
    columns = unknowns.shape[1]
    state = np.zeros((5, 2, columns), dtype=unknowns.dtype)
    state[:3] = start[:, :, None]
    state[3] = unknowns[[0, 3]]
    force = np.stack([unknowns[[1, 4]], unknowns[[2, 5]]])
    return state, force, kappa0


def _to_contact_and_end(hinge: Hinge, unknowns: Any) -> tuple[Any, Any, Any]:
    """States (5, 2, K) at the contact and at the end, and the forces (2, 2, K) at the end."""
    state, force, kappa0 = _initial(hinge, unknowns)
    P, arc = unknowns[6], unknowns[7:9]
    contact = _integrate(state, force, kappa0, arc)
    e = np.stack([-np.sin(contact[2, 1]), np.cos(contact[2, 1])])
    force = force + np.stack([-P * e, P * e], axis=1)  # (2)
    return contact, _integrate(contact, force, kappa0, np.pi - arc), force


def _residual(hinge: Hinge, unknowns: Any, moment: Any) -> Any:
    """(3)-(6), (6 or 9, K), of ``unknowns`` (6 or 9, K) under ``moment`` (K,)."""
    if unknowns.shape[0] == _FREE:
        state, force, kappa0 = _initial(hinge, unknowns)
        end = _integrate(state, force, kappa0, np.full((2, unknowns.shape[1]), np.pi))
        return np.stack(_link(hinge, end, force, moment))
    contact, end, force = _to_contact_and_end(hinge, unknowns)
    between = contact[:2, 0] - contact[:2, 1]
    cos, sin = np.cos(contact[2]), np.sin(contact[2])
    contact_rows = [
        between[0] * cos[0] + between[1] * sin[0],
        between[0] * cos[1] + between[1] * sin[1],
        between[1] * cos[1] - between[0] * sin[1] - hinge.thickness / hinge.radius,
    ]  # (6)
    return np.stack([*_link(hinge, end, force, moment), *contact_rows])


def _link(hinge: Hinge, end: Any, force: Any, moment: Any) -> list[Any]:
    """(3)-(5): what holds at BD."""
    x, y, theta, m, _ = end
    phi = theta[0] - 0.5 * np.pi
    between = 2.0 * hinge.yc / hinge.radius  # B − D = (0, 2 yc)
    return [
        theta[1] + 0.5 * np.pi - phi,  # (3)
        x[0] - x[1] + between * np.sin(phi),  # (4)
        y[0] - y[1] - between * np.cos(phi),
        force[0, 0] + force[0, 1],  # (5)
        force[1, 0] + force[1, 1],
        moment - m[0] - m[1] - ((x[1] - x[0]) * force[1, 1] - (y[1] - y[0]) * force[0, 1]),
    ]


# --------------------------------------------------------------------------------------------- solving


def _newton(equations: Callable[[Any], Any], guess: Array) -> Array | None:
    """Root of ``equations`` ((n, K) to (n, K)) near ``guess`` (n,), or None."""
    unknowns = guess.copy()
    n = len(guess)
    last = np.inf
    for _ in range(12):
        values = equations(unknowns[:, None] + 1j * _STEP * np.eye(n))
        residual, jacobian = values[:, 0].real, values.imag / _STEP
        size = float(np.abs(residual).max())
        if not np.isfinite(size) or size > 50.0:
            return None
        # quadratic convergence ends in round-off: stop where a further step no longer helps
        if size < 1e-11 and size >= 0.5 * last:
            return unknowns
        last = size
        try:
            unknowns = unknowns - np.linalg.solve(jacobian, residual)
        except np.linalg.LinAlgError:
            return None
    return None


def _follow(hinge: Hinge, unknowns: Array, moment: float, target: float) -> Array:
    """The equilibrium at ``target``, continued from ``unknowns`` at ``moment``; a failed step is halved."""
    step = float(np.clip(target - moment, -0.25, 0.25))
    before: tuple[Array, float] | None = None
    while moment != target:
        step = float(np.clip(target - moment, -abs(step), abs(step)))
        goal = target if abs(target - moment) <= abs(step) else moment + step
        guess = unknowns
        if before is not None:
            guess = unknowns + (unknowns - before[0]) * ((goal - moment) / (moment - before[1]))
        found = _newton(lambda u, goal=goal: _residual(hinge, u, goal), guess)
        if found is None or np.abs(found - guess).max() > 1.0:
            step *= 0.5
            if abs(step) < 1e-3:
                lost = moment * hinge.bending_stiffness / hinge.radius
                raise SinglePointContactError(f"the branch is lost at M = {lost} N·m")
            continue
        before, unknowns, moment = (unknowns, moment), found, goal
        step *= 1.5
        step = float(np.clip(step, -0.5, 0.5))
    return unknowns


@lru_cache(maxsize=64)
def _first_touch(hinge: Hinge, sign: float) -> tuple[float, Array] | None:
    """Moment without dimension and nine unknowns (P = 0) at the first touch, or None within half a turn."""
    unknowns, moment, step = np.zeros(_FREE), 0.0, 0.1 * sign
    while True:
        unknowns, moment = _follow(hinge, unknowns, moment, moment + step), moment + step
        gap, arc = closest(hinge, unknowns)
        if gap <= 0.0:
            break
        if abs(_end_rotation(hinge, unknowns)) > np.pi:
            return None

    def equations(u: Any) -> Any:
        # the seventh unknown stands for M here, P is zero
        nine = u.copy()
        nine[6] = 0.0
        return _residual(hinge, nine, u[6])

    found = _newton(equations, np.array([*unknowns, moment, *arc]))
    if found is None or not 0.0 < found[6] * sign <= abs(moment):
        raise SinglePointContactError("the first touch was not found")
    touch = found.copy()
    touch[6] = 0.0
    return float(found[6]), touch


def _end_rotation(hinge: Hinge, unknowns: Array) -> float:
    return float(_states(hinge, unknowns, np.array([np.pi]))[2, 0, 0] - 0.5 * np.pi)


def _states(hinge: Hinge, unknowns: Array, s: Array) -> Array:
    """States (5, 2, n) of both beams at arc lengths ``s`` (n,) over R."""
    column = unknowns[:, None]
    if len(unknowns) == _FREE:
        state, force, kappa0 = _initial(hinge, column)
        return _sampled(state, force, kappa0, s)
    contact, _, after = _to_contact_and_end(hinge, column)
    state, force, kappa0 = _initial(hinge, column)
    out = np.empty((5, 2, len(s)))
    for beam, arc in enumerate(unknowns[7:9]):
        first = s <= arc
        before = _sampled(state, force, kappa0, s[first])
        beyond = _sampled(contact, after, kappa0, s[~first] - arc)
        out[:, beam, first] = before[:, beam]
        out[:, beam, ~first] = beyond[:, beam]
    return out


def _sampled(state: Any, force: Any, kappa0: Array, s: Array) -> Array:
    """States (5, 2, n) at distances ``s`` (n,) >= 0 from ``state`` (5, 2, 1)."""
    longest = float(s.max(initial=0.0))
    if longest == 0.0:
        return np.repeat(state, len(s), axis=2)
    places, back = np.unique(s / longest, return_inverse=True)
    length = np.full((2, 1), longest)
    return np.asarray(_integrate(state, force, kappa0, length, at=places)[:, :, 0, :][:, :, back])


def closest(hinge: Hinge, unknowns: Array) -> tuple[float, Array]:
    """Least distance of the neutral lines less t, over R, and the arc lengths (2,) there."""
    s = np.linspace(0.0, np.pi, 801)
    states = _states(hinge, unknowns, s)
    distance, index = cKDTree(states[:2, 1].T).query(states[:2, 0].T)
    i = int(np.argmin(distance))
    best = np.array([s[i], s[index[i]]])
    # samples alone leave an error of the order of their spacing squared: finish by Newton on the feet
    for _ in range(4):
        feet = _states(hinge, unknowns, best)
        p1, p2 = feet[:, 0, 0], feet[:, 1, 1]
        kappa = np.array([1.0 + p1[3], -1.0 + p2[3]])
        between = p1[:2] - p2[:2]
        tau = np.array([[np.cos(p[2]), np.sin(p[2])] for p in (p1, p2)])
        normal = np.array([[-b, a] for a, b in tau])
        gradient = np.array([between @ tau[0], -between @ tau[1]])
        mixed = -tau[0] @ tau[1]
        hessian = np.array(
            [
                [1.0 + kappa[0] * between @ normal[0], mixed],
                [mixed, 1.0 - kappa[1] * between @ normal[1]],
            ]
        )
        step = np.linalg.solve(hessian, gradient)
        if np.abs(step).max() > 0.1:
            break
        best = np.clip(best - step, 0.0, np.pi)
    return float(np.linalg.norm(between)) - hinge.thickness / hinge.radius, best


# --------------------------------------------------------------------------------------------- the answer


def _solution(hinge: Hinge, unknowns: Array, moment: float) -> HingeSolution:
    R, EI = hinge.radius, hinge.bending_stiffness
    force_unit, moment_unit = EI / R**2, EI / R
    end = _states(hinge, unknowns, np.array([np.pi]))[:, :, 0]
    height = hinge.yc / R
    phi = float(end[2, 0] - 0.5 * np.pi)
    gap, _ = closest(hinge, unknowns)
    arcs, point, P = None, None, 0.0
    if len(unknowns) == _TOUCH:
        contact, _, _ = _to_contact_and_end(hinge, unknowns[:, None])
        P = float(unknowns[6])
        arcs = (float(unknowns[7] * R), float(unknowns[8] * R))
        point = contact[:2, :, 0].mean(axis=1) * R + np.array([hinge.xc, 0.0])
    return HingeSolution(
        hinge=hinge,
        moment=moment * moment_unit,
        displacement_B=(end[:2, 0] - [1.0, height]) * R,
        displacement_D=(end[:2, 1] - [1.0, -height]) * R,
        rotation=phi,
        contact_force=P * force_unit,
        contact_arc_lengths=arcs,
        contact_point=point,
        smallest_gap=gap * R,
        reaction_A=-unknowns[1:3] * force_unit,
        reaction_C=-unknowns[4:6] * force_unit,
        reaction_moment_A=-float(unknowns[0]) * moment_unit,
        reaction_moment_C=-float(unknowns[3]) * moment_unit,
        potential_energy=float(end[4].sum() - moment * phi) * moment_unit,
        residual=float(np.abs(_residual(hinge, unknowns[:, None], np.array([moment]))).max()),
        _unknowns=unknowns,
    )


def checked(solution: HingeSolution) -> HingeSolution:
    """The solution itself, if the beams push on each other and overlap nowhere.

    Raises:
        SinglePointContactError: they do not.
    """
    if solution.contact_force < 0.0:
        raise SinglePointContactError(f"the beams would pull on each other with {-solution.contact_force} N")
    if solution.smallest_gap < -1e-9 * solution.hinge.radius:
        overlap = -solution.smallest_gap
        raise SinglePointContactError(f"the beams overlap by {overlap} m away from the point of contact")
    return solution
