"""Statics of one station: deformed beams, moved bodies, and all forces with the scene's loads; SI.

======  ============================================================================================
symbol  meaning
======  ============================================================================================
s, x    undeformed arc length; position of the neutral line, as the complex number x + i·y
X, u    x at rest; displacement x - X
ψ       tangent angle of the neutral line
φ       rotation of the section from rest
F, M    force of the part beyond a cut on the part before, and moment about the cut
h, κ    largest distance of stated places; change of curvature M/(E·I)
======  ============================================================================================

Between two stated places u is the cubic through the stated displacements with the slopes e^{iψ} - X'.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comparisons.geometry import SHEAR_FACTOR, length
from comparisons.quantities import stage_of
from cprbm_scene import (
    Answer,
    Array,
    Beam,
    BeamMoment,
    BeamState,
    DistributedLoad,
    Force,
    Material,
    Moment,
    Scene,
    Stage,
    StationAnswer,
    WeldedEnd,
)
from cprbm_scene.curve_records import shape_of

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
_PLANE = (1.0, 1j)  # from two coordinates to a complex number
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(4)

PIECES = 200
"""Straight pieces of a beam's fine line."""

BESIDE = 1e-9
"""Distance, over the beam's length, below which a force acts at a cut."""

SAGITTA = 0.6
"""Distance of a chain's joints, where moments balance, from the smooth line, over h² κ: 1/8 on a circle, up to 0.21
measured where a force acts inside an element, and 0.46 at an end, to which the chain's moment is continued."""

Finding = tuple[float, str]
"""Excess of an error over the allowed error, and the complaint that holds unless the excess is zero or less."""


@dataclass(frozen=True)
class DeformedBeam:
    """A ``beam`` of the scene with its ``material`` and ``length`` (m) in a state.

    A beam that does not move (``moves``) keeps the line at rest.
    """

    beam: Beam
    material: Material
    length: float
    state: BeamState
    moves: bool = True

    def rest(self, s: Array) -> tuple[Complex, Complex]:
        """Positions X and unit tangents X' at arc lengths (k,)."""
        line, u = shape_of(self.beam.curve), s / self.length
        return np.asarray(line.point(u) @ _PLANE), np.asarray(line.tangent(u) @ _PLANE)

    def thickness(self, s: Array) -> Array:
        """Thickness at arc lengths (k,), m."""
        return np.asarray(self.beam.thickness_at(s / self.length))

    def stiffness(self, s: Array) -> tuple[Array, Array, Array]:
        """E·I (N·m²), EA and GA_s (N) at arc lengths (k,)."""
        EA = self.material.youngs_modulus * self.thickness(s) * self.beam.width_at(s / self.length)
        return EA * self.thickness(s) ** 2 / 12.0, EA, EA * SHEAR_FACTOR / (2.0 * (1.0 + self.material.poisson_ratio))

    @cached_property
    def places(self) -> Complex:
        """Stated positions (n,)."""
        return np.asarray(self.state.x + 1j * self.state.y)

    @cached_property
    def turned(self) -> Array:
        """Rotation φ at the stated places (n,), rad, continuous, up to full turns."""
        return self.state.section_angle - np.unwrap(np.angle(self.rest(self.state.s)[1]))

    @cached_property
    def displacement(self) -> Callable[..., Complex]:
        """Displacement u of the neutral line by arc length, or a derivative of the order in a second argument."""
        from scipy.interpolate import CubicHermiteSpline  # a command without an answer needs no SciPy

        displacement: Callable[..., Complex] = CubicHermiteSpline(
            self.state.s,
            self.places - self.rest(self.state.s)[0],
            np.exp(1j * self.state.angle) - self.rest(self.state.s)[1],
        )
        return displacement

    @cached_property
    def fine(self) -> tuple[Array, Complex]:
        """Arc lengths and places of a fine line, (PIECES + 1,) each."""
        s = np.linspace(0.0, self.length, PIECES + 1)
        return s, self.line(s)

    def line(self, s: Array) -> Complex:
        """Positions x at arc lengths (k,)."""
        return np.asarray(self.rest(s)[0] + self.moves * self.displacement(s))

    @cached_property
    def h(self) -> float:
        """Largest distance of two neighbouring stated places, m."""
        return float(np.diff(self.state.s).max())


@dataclass(frozen=True)
class StationState:
    """A station of a ``stage``, with the ``values`` of all loads, and of the drives that hold a known value.

    ``kinematics`` is the solver's theory.
    """

    scene: Scene
    station: StationAnswer
    beams: dict[str, DeformedBeam]
    values: dict[str, float]
    stage: Stage
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
        moments = [
            np.abs(of).max(initial=0.0) for of in (self.forces["moment"], *(b.state.M for b in self.beams.values()))
        ]
        return force, float(max(*moments, 1e-3 * force * self.longest, BESIDE * self.natural))

    @cached_property
    def at_rest(self) -> "StationState":
        """All lines and bodies at rest."""
        return replace(
            self,
            beams={name: replace(beam, moves=False) for name, beam in self.beams.items()},
            station=replace(self.station, bodies={}),
        )

    def rotation(self, body: str) -> float:
        """Rotation of a body, rad; zero of a fixed body."""
        return float(self.station.bodies[body][2]) if body in self.station.bodies else 0.0

    def carried(self, body: str, X: Complex) -> Complex:
        """Present positions of places X (k,) of a body."""
        first = complex(*next(iter(self.scene.bodies[body].points.values())))
        u, v, phi = self.station.bodies.get(body, (0.0, 0.0, 0.0))
        return np.asarray(first + complex(u, v) + np.exp(1j * phi) * (X - first))

    def point(self, name: str) -> complex:
        """Present position of a body's point."""
        return complex(self.carried(self.scene.body_of(name), np.array([self.scene.place_of(name)]) @ _PLANE)[0])

    def moved(self, name: str) -> complex:
        """Displacement of a body's point."""
        return self.point(name) - complex(*self.scene.place_of(name))

    @cached_property
    def forces(self) -> Forces:
        """All forces, loads included."""
        stated = self.station.forces
        places, forces = stated.place @ _PLANE, stated.force @ _PLANE
        rows = [*zip(stated.source, stated.target, stated.s, places, forces, stated.moment, strict=True)]
        return np.array([*rows, *(row for name in self.scene.loads for row in self.load(name)[0])], dtype=_FIELDS)

    @cached_property
    def on(self) -> dict[str, Forces]:
        """The forces on every beam and moving body."""
        return {name: self.forces[self.forces["target"] == name] for name in (*self.beams, *self.station.bodies)}

    def lever(self, name: str) -> float:
        """Moment of the largest force on a beam with the distance of a chain's joints from the smooth line, N·m."""
        beam, largest = self.beams[name], float(np.max(np.abs(self.on[name]["force"]), initial=0.0))
        return largest * SAGITTA * beam.h**2 * float(np.max(np.abs(beam.state.M) / beam.stiffness(beam.state.s)[0]))

    def ripple(self, name: str) -> float:
        """Moment of the loads on half of an element: contacts lift a loaded beam by forces at places, N·m."""
        beam, loads = self.beams[name], np.isin(self.on[name]["source"], list(self.scene.loads))
        return float(loads @ np.abs(self.on[name]["force"]) * beam.h**2 / (8.0 * beam.length))

    def load(self, name: str) -> tuple[list[tuple[object, ...]], float]:
        """Rows of a load's forces at the present places, and the work of the load with the value one, J."""
        load, value, s, weights = self.scene.loads[name], self.values[name], np.array([np.nan]), np.ones(1)
        if isinstance(load, Moment | Force):
            target = load.body if isinstance(load, Moment) else self.scene.body_of(load.point)
            X = np.array([(0.0, 0.0) if isinstance(load, Moment) else self.scene.place_of(load.point)]) @ _PLANE
            x, turned = self.carried(target, X), self.rotation(target)
        else:
            target, beam = load.beam, self.beams[load.beam]
            if isinstance(load, DistributedLoad):
                s, weights = gauss(np.unique(np.clip(beam.state.s / beam.length, *load.along)) * beam.length)
            else:
                s = np.array([load.at * beam.length])
            X, x, turned = beam.rest(s)[0], beam.line(s), self._turned(target, float(s[0]))
        way = 0j if isinstance(load, Moment | BeamMoment) else unit(load.direction)
        work = (weights @ (x - X) * np.conj(way)).real + (0.0 if way else turned)
        weights = value * weights
        return [(name, target, *row) for row in zip(s, x, weights * way, weights * (not way), strict=True)], float(work)

    def _turned(self, name: str, s: float) -> float:
        """Rotation φ of a beam's section; the held end says how many full turns the answer counts."""
        beam = self.beams[name]
        end, i = (beam.beam.end, -1) if isinstance(beam.beam.end, WeldedEnd) else (beam.beam.start, 0)
        ahead = beam.turned[i] - self.rotation(self.scene.owners.get(getattr(end, "point", ""), ""))
        # within an element a moment turns the section further than both ends
        before = int(np.searchsorted(beam.state.s[1:-1], s, side="right"))
        h, M, Q = s - beam.state.s[before], beam.state.M[before], beam.state.Q[before]
        turned = beam.turned[before] + h * (M - 0.5 * h * Q) / beam.stiffness(np.array([s]))[0][0]
        return float(turned - 2.0 * np.pi * np.round(ahead / (2.0 * np.pi)))

    def beyond(self, name: str, s: Array) -> tuple[Complex, Array]:
        """Force F and moment M of all forces beyond cuts at arc lengths (k,) of a beam, (k,) each."""
        beam, forces = self.beams[name], np.sort(self.on[name], order="s")
        start, side = complex(beam.places[0]), BESIDE * beam.length
        first = np.searchsorted(forces["s"], np.minimum(s + side, beam.length - side))
        F, M = (np.append(np.cumsum(of[::-1])[::-1], 0.0)[first] for of in (forces["force"], about(forces, start)))
        return F, M - (np.conj(beam.line(s) - start) * F).imag

    def unbalance(self, name: str) -> Array:
        """Stated moment less the moment of all that acts beyond, at the stated places of a beam, (n,), N·m."""
        return self.beams[name].state.M - self.beyond(name, self.beams[name].state.s)[1]


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
    for station in answer.stations:
        if station.beams.keys() >= scene.beams.keys():
            beams = {
                name: DeformedBeam(beam, scene.materials[beam.material], length(beam.curve), station.beams[name])
                for name, beam in scene.beams.items()
            }
            yield StationState(
                scene,
                station,
                beams,
                values=scene.values_at(station.stage, station.value),
                stage=stage_of(scene, station.stage),
                kinematics=str(answer.settings.get("kinematics", scene.theory)),
            )
