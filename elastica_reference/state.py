"""Equilibrium states, and their quantities along the beams."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol

import numpy as np
from scipy.interpolate import BarycentricInterpolator

from cprbm_scene import CircleContact
from cprbm_scene.answer import Array
from elastica_reference.equations import Equations
from elastica_reference.evaluation import Evaluation, Part
from elastica_reference.model import Model
from elastica_reference.spectral import rule
from elastica_reference.structure import Structure, Wrap
from elastica_reference.wrapping import bending

_AT_START = 1e-16  # times a piece's length


class Known(Protocol):
    """A state with (x, y, θ, m, Fx, Fy) (6, n) along beams, circles' centres (2,), and named unknowns."""

    def along(self, beam: str, s: Array) -> Array: ...  # noqa: D102
    def centre(self, contact: str) -> Array: ...  # noqa: D102
    def unknowns(self) -> Mapping[str, float | Array]: ...  # noqa: D102


@dataclass(frozen=True)
class Rest:
    """The stress-free state."""

    model: Model

    def along(self, beam: str, s: Array) -> Array:
        """(x, y, θ, m, Fx, Fy) (6, n) at arc lengths ``s`` (n,)."""
        line = self.model.strips[beam].line
        return np.concatenate([line.place(s), line.angle(s)[None], np.zeros((3, len(s)))])

    def centre(self, contact: str) -> Array:
        """A circle's centre (2,)."""
        record = self.model.scene.contacts[contact]
        assert isinstance(record, CircleContact)
        return np.array(record.center) / self.model.unit_length

    def unknowns(self) -> Mapping[str, float | Array]:
        """No unknowns: all are zero."""
        return {}


@dataclass(frozen=True)
class State:
    """An equilibrium.

    Attributes:
        equations: equations of the structure and loads.
        z: unknowns (n,); lam: λ.
        evaluation: all quantities at z, with a single column.
        residual: largest row.
    """

    equations: Equations
    z: Array
    lam: float
    evaluation: Evaluation
    residual: float

    @property
    def structure(self) -> Structure:
        """The closed contacts."""
        return self.equations.structure

    @property
    def forces(self) -> dict[str, float]:
        """P by contact, except wraps."""
        return {name: float(self.z[index]) for name, index in self.equations.layout.forces.items()}

    @property
    def places(self) -> dict[tuple[str, str], float]:
        """Places of contact by (contact, key) as in :class:`elastica_reference.layout.Layout`."""
        return {key: float(self.z[index]) for key, index in self.equations.layout.places.items()}

    def centre(self, contact: str) -> Array:
        """A circle's centre (2,)."""
        return self.evaluation.centres[contact][:, 0]

    def unknowns(self) -> Mapping[str, float | Array]:
        """Unknowns of bodies and drives and forces of contacts, by name."""
        where = self.equations.layout
        bodies: dict[str, float | Array] = {name: self.z[index] for name, index in where.bodies.items()}
        return {**bodies, **{name: float(self.z[index]) for name, index in where.drives.items()}, **self.forces}

    def along(self, beam: str, s: Array) -> Array:
        """(x, y, θ, m, Fx, Fy) (6, n) at arc lengths ``s`` (n,); at a contact the value beyond."""
        s = np.asarray(s, dtype=float)
        values = np.empty((6, len(s)))
        parts = self.evaluation.parts[beam]
        number = np.clip(np.searchsorted([float(part.a[0]) for part in parts], s, side="right") - 1, 0, None)
        for k in np.unique(number):
            here = number == k
            values[:, here] = _within(parts[k], s[here])
        for wrap in self.structure.wraps(beam):
            a, b = self.wrap_range(wrap)
            here = (s >= a) & ((s < b) | (wrap.to_end & (s >= b)))
            if here.any():
                values[:, here] = self._state_in_wrap(wrap, s[here])
        return values

    def wrap_range(self, wrap: Wrap) -> tuple[float, float]:
        """Arc lengths of the beginning and end of a wrap."""
        zone = self.evaluation.zones[wrap.contact]
        return float(zone.a[0]), float(zone.b[0])

    def _state_in_wrap(self, wrap: Wrap, s: Array) -> Array:
        """(x, y, θ, m, Fx, Fy) (6, n) within a wrap, by the formulas of :mod:`elastica_reference.wrapping`."""
        zone, g = self.evaluation.zones[wrap.contact], wrap.sense
        strip = self.equations.model.strips[wrap.beam]
        centre = self.evaluation.centres[wrap.contact][:, 0]
        arm = zone.place[:, 0] - centre
        rho = float(np.hypot(*arm))
        at = np.concatenate([zone.a, s])
        by = g * (at - at[0]) / rho
        theta = float(zone.angle[0]) + by
        m, dm, _ = bending(strip, g / rho, at)
        tau = np.stack([np.cos(theta), np.sin(theta)])
        n = np.stack([-tau[1], tau[0]])
        N = float(zone.first[:, 0] @ tau[:, 0]) - g / rho * (m - m[0])
        F = N * tau - dm * n  # F·n = −m'
        cos, sin = np.cos(by), np.sin(by)
        x, y = centre[0] + cos * arm[0] - sin * arm[1], centre[1] + sin * arm[0] + cos * arm[1]
        return np.stack([x, y, theta, m, F[0], F[1]])[:, 1:]

    def pressures(self, wrap: Wrap, s: Array) -> tuple[Array, float, float]:
        """Line pressure (n,) at places ``s`` (n,) in a wrap, and the point forces at both ends.

        Compression is positive. The force at a clamped end belongs to the support.
        """
        zone, g = self.evaluation.zones[wrap.contact], wrap.sense
        strip = self.equations.model.strips[wrap.beam]
        state = self._state_in_wrap(wrap, np.concatenate([zone.a, s, zone.b]))
        tau = np.stack([np.cos(state[2]), np.sin(state[2])])
        e = g * np.stack([tau[1], -tau[0]])
        rho = float(np.hypot(*(state[:2, 0] - self.evaluation.centres[wrap.contact][:, 0])))
        N = np.sum(tau * state[4:], axis=0)[1:-1]
        pressure = N / rho - g * bending(strip, g / rho, s)[2]
        begin, end = (zone.before - zone.first)[:, 0] @ e[:, 0], (zone.last - zone.after)[:, 0] @ e[:, -1]
        return np.asarray(pressure), float(begin), float(end)


@lru_cache(maxsize=8)
def _through(p: int) -> tuple[Array, Array]:
    """The ends and Gauss points of (0, 1), and the weights of barycentric interpolation."""
    points = np.concatenate(([0.0], rule(p).points, [1.0]))
    return points, BarycentricInterpolator(points).wi


def _within(part: Part, s: Array) -> Array:
    """(x, y, θ, m, Fx, Fy) (6, n) inside a piece, constant beyond its ends."""
    solved, start, end = part.solved, part.start[:, 0], part.end[:, 0]
    a, h = float(part.a[0]), float(part.b[0] - part.a[0])
    gauss = rule(len(solved.theta))
    x = start[0] + h * (gauss.integrals @ np.cos(solved.theta))
    y = start[1] + h * (gauss.integrals @ np.sin(solved.theta))
    inner = np.stack([x, y, solved.theta, solved.moment])
    values = np.concatenate([start[:4, None], inner, end[:, None]], axis=1)
    points, weights = _through(len(solved.theta))
    through = BarycentricInterpolator(points, values.T, wi=weights)
    xi = np.clip((s - a) / h, 0.0, 1.0) if h != 0.0 else np.zeros_like(s)
    xi = np.where(np.abs(xi) < _AT_START, 0.0, xi)  # the interpolation divides by the distance from its points
    return np.concatenate([through(xi).T, start[4:, None] - part.spread[:, :1] * (h * xi)])


def start_of(equations: Equations, known: Known, guesses: Mapping[Any, float]) -> Array:
    """Initial unknowns (n,) of a structure, interpolated from a state of possibly another structure.

    Args:
        equations: of the structure.
        known: the state along the beams.
        guesses: P by contact and places by (contact, key).
    """
    values = known.unknowns()
    where = equations.layout
    z = np.zeros(where.size)
    for name, freedoms in where.bodies.items():
        z[freedoms] = values.get(name, 0.0)
    for name, index in (*where.drives.items(), *where.forces.items()):
        z[index] = values.get(name, guesses.get(name, 0.0))
    for key, index in where.places.items():
        z[index] = guesses[key]
    for beam, pieces in where.pieces.items():
        begins = equations.begins(beam, z)
        for state, begin in zip(pieces, begins, strict=True):
            z[state] = known.along(beam, np.array([begin]))[:, 0]
    return z
