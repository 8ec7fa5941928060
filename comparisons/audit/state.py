"""One station as the audit reads it: deformed beams, moved bodies, and all forces with the scene's loads; SI.

======  ============================================================================================
symbol  meaning
======  ============================================================================================
s, x    undeformed arc length; position of the neutral line, as the complex number x + i·y
X       x at rest
ψ       tangent angle of the neutral line
α       mean rotation of the sections from rest between two stated places
F, M    force of the part beyond a cut on the part before, and moment about the cut
======  ============================================================================================

Between two stated places x = e^{iα} X + d: the line at rest, turned, and the cubic d through the values and the slopes
e^{iψ} - e^{iα} X' of the difference at both places.  The cubic is exact where the beam moves as a rigid body.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comparisons.geometry import length
from cprbm_scene import Answer, Beam, Scene, StationAnswer
from cprbm_scene.answer import Array, BeamState
from cprbm_scene.geometry import points_on, tangents_on
from cprbm_scene.statement import DistributedLoad, Force, FreeEnd, Moment, WeldedEnd

Complex = NDArray[np.complex128]
Forces = NDArray[np.void]
"""Forces (k,) with the fields source, target, s, place, force, and moment about the place."""

_FIELDS = [
    ("source", "U64"),
    ("target", "U64"),
    ("s", float),
    ("place", complex),
    ("force", complex),
    ("moment", float),
]
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(4)

SHEAR_FACTOR = 5.0 / 6.0
"""Of a rectangle: shear area over area (Timoshenko)."""

BESIDE = 1e-9
"""Distance, over the beam's length, below which a force acts at a cut."""

FINE = 200
"""Least number of pieces of a fine line."""


@dataclass(frozen=True)
class DeformedBeam:
    """A ``beam`` of the scene in a state: Young's modulus ``E`` (Pa), Poisson's ratio ``nu`` and ``length`` (m)."""

    beam: Beam
    E: float
    nu: float
    length: float
    state: BeamState

    def rest(self, s: Array) -> tuple[Complex, Complex]:
        """Positions X and unit tangents X' at arc lengths (k,)."""
        u = np.clip(s / self.length, 0.0, 1.0)
        places, tangents = (along(self.beam.curve, u) @ (1.0, 1j) for along in (points_on, tangents_on))
        return np.asarray(places), np.asarray(tangents)

    def thickness(self, s: Array) -> Array:
        """Thickness at arc lengths (k,), m."""
        return np.asarray(self.beam.thickness_at(np.clip(s / self.length, 0.0, 1.0)))

    def stiffness(self, s: Array) -> tuple[Array, Array, Array]:
        """E·I (N·m²), EA and GA_s (N) at arc lengths (k,)."""
        t = self.thickness(s)
        EA = self.E * t * np.asarray(self.beam.width_at(np.clip(s / self.length, 0.0, 1.0)))
        return EA * t**2 / 12.0, EA, EA * SHEAR_FACTOR / (2.0 * (1.0 + self.nu))

    @cached_property
    def places(self) -> Complex:
        """Stated positions (n,)."""
        return np.asarray(self.state.x + 1j * self.state.y)

    @cached_property
    def turned(self) -> Array:
        """Rotation of the sections from rest at the stated places (n,), rad, continuous, up to full turns."""
        return self.state.section_angle - np.unwrap(np.angle(self.rest(self.state.s)[1]))

    def size(self, s: Array) -> Array:
        """Length of the longer element beside places (k,), m."""
        borders, sides = self.state.borders, BESIDE * self.length * np.array([[-1.0], [1.0]])
        element = np.clip(np.searchsorted(borders, s + sides) - 1, 0, len(borders) - 2)
        return np.asarray(np.diff(borders)[element].max(axis=0))

    def line(self, s: Array) -> Complex:
        """Positions x at arc lengths (k,)."""
        at, (X, tangents) = self.state.s, self.rest(self.state.s)
        piece = np.clip(np.searchsorted(at, s, side="right") - 1, 0, len(at) - 2)
        turn, h = np.exp(0.5j * (self.turned[1:] + self.turned[:-1]))[piece], np.diff(at)[piece]
        (d0, d1), (g0, g1) = (
            (of_line[piece] - turn * of_rest[piece], of_line[piece + 1] - turn * of_rest[piece + 1])
            for of_line, of_rest in ((self.places, X), (np.exp(1j * self.state.angle), tangents))
        )
        share, bend, twist = (s - at[piece]) / h, 3.0 * (d1 - d0) - h * (2.0 * g0 + g1), h * (g0 + g1) - 2.0 * (d1 - d0)
        return np.asarray(turn * self.rest(s)[0] + d0 + share * (h * g0 + share * (bend + share * twist)))

    def tangents(self, s: Array) -> Complex:
        """Unit tangents e^{iψ} at arc lengths (k,)."""
        sheared = self.turned + self.state.angle - self.state.section_angle
        return np.asarray(self.rest(s)[1] * np.exp(1j * np.interp(s, self.state.s, sheared)))

    @cached_property
    def fine(self) -> Array:
        """Arc lengths of a fine line, stated places included."""
        at = self.state.s
        pieces = 1 + FINE // len(at)
        return np.interp(np.arange(pieces * (len(at) - 1) + 1) / pieces, np.arange(len(at)), at)

    @cached_property
    def at_rest(self) -> DeformedBeam:
        """The beam at rest with the same places."""
        X, tangents = self.rest(self.state.s)
        angle = np.unwrap(np.angle(tangents))
        return replace(self, state=replace(self.state, x=X.real, y=X.imag, angle=angle, section_angle=angle))


@dataclass(frozen=True)
class StationState:
    """One station: ``values`` are those of all loads and drives there, ``kinematics`` the solver's theory."""

    scene: Scene
    station: StationAnswer
    beams: dict[str, DeformedBeam]
    values: dict[str, float]
    kinematics: str

    @cached_property
    def longest(self) -> float:
        """Length of the longest beam, m."""
        return max(beam.length for beam in self.beams.values())

    @cached_property
    def natural(self) -> float:
        """Largest E·I over the longest beam: the scale of moments and energies, N·m."""
        return max(float(beam.stiffness(beam.state.s)[0].max()) for beam in self.beams.values()) / self.longest

    @cached_property
    def largest(self) -> tuple[float, float]:
        """Largest force, N, and moment, N·m; a force counts as a moment with a lever of 1e-3 of the longest beam."""
        force = float(np.max(np.abs(self.forces["force"]), initial=0.0))
        moments = np.concatenate([self.forces["moment"], *(beam.state.M for beam in self.beams.values())])
        return force, max(float(np.max(np.abs(moments))), 1e-3 * force * self.longest, BESIDE * self.natural)

    def rotation(self, body: str) -> float:
        """Rotation of a body, rad."""
        return float(self.station.bodies[body][2]) if body in self.station.bodies else 0.0

    def carried(self, body: str, X: complex) -> complex:
        """Present position of a place X of a body."""
        first = complex(*next(iter(self.scene.bodies[body].points.values())))
        u, v, phi = self.station.bodies.get(body, (0.0, 0.0, 0.0))
        return complex(first + complex(u, v) + np.exp(1j * phi) * (X - first))

    def point(self, name: str) -> complex:
        """Present position of a body's point."""
        return self.carried(self.scene.body_of(name), complex(*self.scene.place_of(name)))

    def moved(self, name: str) -> complex:
        """Displacement of a body's point."""
        return self.point(name) - complex(*self.scene.place_of(name))

    @cached_property
    def forces(self) -> Forces:
        """All forces, loads included."""
        stated = self.station.forces
        place, force = stated.place @ (1.0, 1j), stated.force @ (1.0, 1j)
        rows = list(zip(stated.source, stated.target, stated.s, place, force, stated.moment, strict=True))
        for name in self.scene.loads:
            load = self.load(name)
            load["place"] += self._displacements(load)
            load["force"], load["moment"] = self.values[name] * load["force"], self.values[name] * load["moment"]
            rows += load.tolist()
        return np.array(rows, dtype=_FIELDS)

    @cached_property
    def on(self) -> dict[str, Forces]:
        """The forces on every beam and moving body."""
        return {name: self.forces[self.forces["target"] == name] for name in (*self.beams, *self.station.bodies)}

    def load(self, name: str) -> Forces:
        """Forces and moments of a load of value one, with their places at rest."""
        load, s, weights = self.scene.loads[name], np.array([np.nan]), np.ones(1)
        if isinstance(load, Moment | Force):
            target = load.body if isinstance(load, Moment) else self.scene.body_of(load.point)
            point = next(iter(self.scene.bodies[target].points)) if isinstance(load, Moment) else load.point
            X = np.array([complex(*self.scene.place_of(point))])
        else:
            target, beam = load.beam, self.beams[load.beam]
            if isinstance(load, DistributedLoad):
                begin, end = (share * beam.length for share in load.along)
                inner = beam.state.s[(beam.state.s > begin) & (beam.state.s < end)]
                s, weights = gauss(np.concatenate(([begin], inner, [end])))
            else:
                s = np.array([load.at * beam.length])
            X = beam.rest(s)[0]
        direction = getattr(load, "direction", None)
        force, moment = (weights * unit(direction), 0.0 * weights) if direction else (0j * weights, weights)
        return np.array([(name, target, *row) for row in zip(s, X, force, moment, strict=True)], dtype=_FIELDS)

    def _displacements(self, load: Forces) -> Complex:
        """Displacements of a load's places."""
        target, X = str(load["target"][0]), load["place"]
        present = self.beams[target].line(load["s"]) if target in self.beams else self.carried(target, X[0])
        return np.asarray(present - X)

    def way_of(self, name: str) -> float:
        """Work of a load of value one: displacement along the direction, or rotation."""
        load = self.load(name)
        way, moment = self._displacements(load) @ np.conj(load["force"]), float(load["moment"].sum())
        target = str(load["target"][0])
        if not moment or target not in self.beams:
            return float(way.real) + moment * self.rotation(target)
        # the angle of a direction is known up to full turns: the held end says how many the answer counts
        beam, record = self.beams[target], self.beams[target].beam
        at_end = isinstance(record.end, WeldedEnd) or isinstance(record.start, FreeEnd)
        held, turned = (record.end, beam.turned[-1]) if at_end else (record.start, beam.turned[0])
        ahead = turned - self.rotation(self.scene.body_of(getattr(held, "point", "")))
        full = np.round(ahead / (2.0 * np.pi)) * 2.0 * np.pi
        # within an element the moment turns the section further than both ends
        i, s = np.searchsorted(beam.state.s[1:-1], load["s"][0], side="right"), load["s"][0]
        h, (EI, _, _) = s - beam.state.s[i], beam.stiffness(load["s"])
        return float(beam.turned[i] + h * (beam.state.M[i] - 0.5 * h * beam.state.Q[i]) / EI[0] - full)

    def beyond(self, name: str, s: Array) -> tuple[Complex, Array]:
        """Force F and moment M of all that acts beyond cuts at arc lengths (k,) of a beam, (k,) each."""
        beam, forces = self.beams[name], np.sort(self.on[name], order="s")
        start, side = complex(beam.places[0]), BESIDE * beam.length
        parts = (forces["force"], about(forces, start))
        F, M = (np.append(np.cumsum(part[::-1])[::-1], 0.0) for part in parts)
        first = np.searchsorted(forces["s"], np.minimum(s + side, beam.length - side))
        return F[first], M[first] - (np.conj(beam.line(s) - start) * F[first]).imag


def about(forces: Forces, place: complex) -> Array:
    """Moment of every force about a place, (k,), N·m."""
    return np.asarray((np.conj(forces["place"] - place) * forces["force"]).imag + forces["moment"])


def gauss(knots: Array) -> tuple[Array, Array]:
    """Places and weights of Gauss's rule between ascending knots."""
    middle, half = 0.5 * (knots[1:] + knots[:-1])[:, None], 0.5 * np.diff(knots)[:, None]
    return (middle + half * _GAUSS).ravel(), (half * _WEIGHTS).ravel()


def unit(direction: tuple[float, float]) -> complex:
    """The unit vector of a direction."""
    return complex(*direction) / abs(complex(*direction))


def states_of(scene: Scene, answer: Answer) -> Iterator[StationState]:
    """Every station that states internal forces of all beams; loads and drives keep their last value."""
    kinematics = str(answer.settings.get("kinematics", "bending"))
    for station in answer.stations:
        if not station.beams.keys() >= scene.beams.keys():
            continue
        values, beams = dict.fromkeys((*scene.loads, *scene.drives), 0.0), {}
        for stage in scene.stages[: [stage.name for stage in scene.stages].index(station.stage) + 1]:
            values[stage.steps] = station.value if stage.name == station.stage else stage.stations[-1]
        for name, beam in scene.beams.items():
            E, nu = scene.materials[beam.material].youngs_modulus, scene.materials[beam.material].poisson_ratio
            beams[name] = DeformedBeam(beam, E, nu, length(beam.curve), station.beams[name])
        yield StationState(scene, station, beams, values, kinematics)
