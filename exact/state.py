"""A solved state, and what it is along the beams."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from exact.equations import Equations, Evaluation
from exact.model import Model, Strip
from exact.spectral import Piece, rule
from exact.structure import Structure, Wrap
from scene.answer import Array


class Known(Protocol):
    """Something that knows (x, y, θ, m, Fx, Fy) (6, n) along every beam, and the values of z of the same name."""

    def along(self, beam: str, s: Array) -> Array: ...  # noqa: D102


@dataclass(frozen=True)
class Rest:
    """The stress-free state."""

    model: Model

    def along(self, beam: str, s: Array) -> Array:
        """(x, y, θ, m, Fx, Fy) (6, n) at arc lengths ``s`` (n,)."""
        line = self.model.strips[beam].line
        return np.concatenate([line.place(s), line.angle(s)[None], np.zeros((3, len(s)))])


@dataclass(frozen=True)
class State:
    """An equilibrium.

    Attributes:
        equations: what it solves.
        z: unknowns (n,); lam: λ.
        found: everything at z, one column each.
        residual: largest row.
        sign: of the determinant of the equations' derivative.
    """

    equations: Equations
    z: Array
    lam: float
    found: Evaluation
    residual: float
    sign: float

    @property
    def structure(self) -> Structure:
        """Which contacts are closed."""
        return self.equations.structure

    def along(self, beam: str, s: Array) -> Array:
        """(x, y, θ, m, Fx, Fy) (6, n) at arc lengths ``s`` (n,); at a contact what is beyond it."""
        s = np.asarray(s, dtype=float)
        values = np.empty((6, len(s)))
        pieces = self.found.pieces[beam]
        begins = np.array([float(np.real(p[0][0])) for p in pieces])
        number = np.clip(np.searchsorted(begins, s, side="right") - 1, 0, len(pieces) - 1)
        for k in np.unique(number):
            here = number == k
            a, b, start, end, solved = pieces[k]
            values[:, here] = _within(float(a[0]), float(b[0]), start[:, 0], end[:, 0], solved, s[here])
        strip = self.equations.model.strips[beam]
        for name, zone in self.found.wraps.items():
            touch = self.structure.touches[name]
            if touch.beam != beam:
                continue
            assert isinstance(touch, Wrap)
            a, b = float(zone[0][0]), float(zone[1][0])
            here = (s >= a) & (s < b if not touch.to_end else s <= b)
            if here.any():
                values[:, here] = self._wrapped(strip, touch, s[here])
        return values

    def _wrapped(self, strip: Strip, wrap: Wrap, s: Array) -> Array:
        a, _, place, angle, _, _, first, _ = self.found.wraps[wrap.contact]
        centre = self.found.centres[wrap.contact][:, 0]
        arm = place[:, 0] - centre
        rho, g = float(np.hypot(*arm)), wrap.sense
        by = g * (s - float(a[0])) / rho
        cos, sin = np.cos(by), np.sin(by)
        theta = float(angle[0]) + by
        EI = strip.rigidity(s)
        m = EI * (g / rho - strip.line.curvature(s))
        across = EI * strip.line.curvature_slope(s)  # F·n = −m'
        tau = np.stack([np.cos(theta), np.sin(theta)])
        n = np.stack([-tau[1], tau[0]])
        at_a = np.array([float(a[0])])
        m_a = float((strip.rigidity(at_a) * (g / rho - strip.line.curvature(at_a)))[0])
        tau_a = np.array([np.cos(angle[0]), np.sin(angle[0])])
        N = float(first[:, 0] @ tau_a) - g / rho * (m - m_a)
        F = N * tau + across * n
        x, y = centre[0] + cos * arm[0] - sin * arm[1], centre[1] + sin * arm[0] + cos * arm[1]
        return np.stack([x, y, theta, m, F[0], F[1]])

    def wrapped(self, wrap: Wrap) -> tuple[float, float]:
        """Arc lengths at which a wrap begins and ends."""
        a, b = self.found.wraps[wrap.contact][:2]
        return float(a[0]), float(b[0])

    def pressures(self, wrap: Wrap, s: Array) -> tuple[Array, float, float]:
        """Line pressure (n,) at places ``s`` (n,) in a wrap, and the forces at its two ends; positive where they press.

        An end that is held has no force of its own: what is there is the support's.
        """
        strip = self.equations.model.strips[wrap.beam]
        _, _, _, _, before, after, first, last = self.found.wraps[wrap.contact]
        state = self._wrapped(strip, wrap, s)
        tau = np.stack([np.cos(state[2]), np.sin(state[2])])
        rho = float(np.hypot(*(state[:2, 0] - self.found.centres[wrap.contact][:, 0])))
        N = np.sum(tau * state[4:], axis=0)
        # p = N/ρ − (F·e)' with F·e = g m' and m'' = −EI κ0''
        step = 1e-5 * strip.length
        bend = (strip.line.curvature_slope(s + step) - strip.line.curvature_slope(s - step)) / (2.0 * step)
        pressure = N / rho + wrap.sense * strip.rigidity(s) * bend
        ends = []
        for inner, outer, sign in ((first, before, 1.0), (last, after, -1.0)):
            angle = float(state[2, 0 if sign > 0.0 else -1])
            e = wrap.sense * np.array([np.sin(angle), -np.cos(angle)])
            ends.append(float(sign * (outer - inner)[:, 0] @ e))
        return np.asarray(pressure), ends[0], ends[1]


@lru_cache(maxsize=8)
def _through(p: int) -> tuple[Array, Array]:
    """The ends and Gauss's points of (0, 1), and the weights of interpolation through them."""
    points = np.concatenate(([0.0], rule(p).points, [1.0]))
    return points, BarycentricInterpolator(points).wi


def _within(a: float, b: float, start: Array, end: Array, solved: Piece, s: Array) -> Array:
    """(x, y, θ, m, Fx, Fy) (6, n) inside a piece."""
    gauss, h = rule(len(solved.theta)), b - a
    x = start[0] + h * (gauss.integrals @ np.cos(solved.theta))
    y = start[1] + h * (gauss.integrals @ np.sin(solved.theta))
    inner = np.stack([x, y, solved.theta, solved.moment])
    values = np.concatenate([start[:4, None], inner, end[:4, None]], axis=1)
    points, weights = _through(len(solved.theta))
    through = BarycentricInterpolator(points, values.T, wi=weights)
    xi = (s - a) / h if h != 0.0 else np.zeros_like(s)
    return np.concatenate([through(xi).T, np.tile(start[4:, None], (1, len(s)))])


def start_of(equations: Equations, known: Known, values: Mapping[str, Any], guesses: Mapping[Any, float]) -> Array:
    """Unknowns (n,) of a structure, read off a state with perhaps another.

    Args:
        equations: of the structure.
        known: the state along the beams.
        values: the bodies' and drives' unknowns by name.
        guesses: P by contact and places by (contact, key).
    """
    where = equations.layout
    z = np.zeros(where.size)
    for name, freedoms in where.bodies.items():
        z[freedoms] = values.get(name, 0.0)
    for name, index in (*where.drives.items(), *where.forces.items()):
        z[index] = values.get(name, guesses.get(name, 0.0))
    for key, index in where.places.items():
        z[index] = guesses[key]
    for beam, pieces in where.pieces.items():
        begins = _begins(equations, beam, z)
        for state, begin in zip(pieces, begins, strict=True):
            z[state] = known.along(beam, np.array([begin]))[:, 0]
    return z


def _begins(equations: Equations, beam: str, z: Array) -> list[float]:
    """Arc lengths at which a beam's pieces begin."""
    where, touches = equations.layout, equations.structure.touches
    begins: list[float] = [0.0]
    for item in equations.structure.order.get(beam, ()):
        if not isinstance(item, str):
            begins.append(item)
            continue
        touch = touches[item]
        if isinstance(touch, Wrap):
            if touch.from_start:
                begins = []
            if not touch.to_end:
                begins.append(float(z[where.places[item, "end"]]))
        else:
            begins.append(float(z[where.places[item, beam]]))
    return begins
