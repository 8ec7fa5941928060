"""A station as the auditor sees it: beams from their inner state, bodies from their motion, loads from the scene."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from comparisons.audit.areas import AreaOfBeam
from comparisons.audit.elements import ElementsOfBeam
from comparisons.audit.links import Links
from comparisons.audit.rest import Complex, Rest
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import Area, Array, Statics
from cprbm_scene.statement import BeamForce, BeamMoment, DistributedLoad, Force, FreeEnd, Moment, WeldedEnd

AnyBeam = Links | ElementsOfBeam | AreaOfBeam
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True)
class Acting:
    """Forces on one beam or body: who exerts them, arc lengths (k,), places and forces (k,), moments (k,); SI."""

    by: tuple[str, ...]
    s: Array
    places: Complex
    forces: Complex
    moments: Array

    def about(self, place: complex) -> Array:
        """Moment of each about a place, N·m (k,)."""
        return np.asarray((np.conj(self.places - place) * self.forces).imag + self.moments)


@dataclass(frozen=True)
class Seen:
    """One station of an answer.

    ``values`` are those of all loads and drives there; ``statics`` what acts besides the loads, as the answer says.
    """

    scene: Scene
    station: StationAnswer
    statics: Statics
    rests: dict[str, Rest]
    values: dict[str, float]
    kinematics: str

    @cached_property
    def beams(self) -> dict[str, AnyBeam]:
        """Every beam in its state."""
        found: dict[str, AnyBeam] = {}
        for name, rest in self.rests.items():
            inside, shape = self.statics.inside[name], self.station.shapes[name]
            if isinstance(inside, Area):
                found[name] = AreaOfBeam(rest, inside, shape)
            elif inside.made_of == "links":
                found[name] = Links(rest, inside, shape)
            else:
                found[name] = ElementsOfBeam(rest, inside, shape, self.kinematics)
        return found

    @property
    def longest(self) -> float:
        """Length of the longest beam, m."""
        return max(rest.length for rest in self.rests.values())

    def motion(self, body: str) -> tuple[complex, complex, float]:
        """Of a body its first point at rest, how that moves, and the rotation."""
        first = complex(*next(iter(self.scene.bodies[body].points.values())))
        u, v, phi = self.statics.bodies.get(body, (0.0, 0.0, 0.0))
        return first, complex(u, v), float(phi)

    def carried(self, body: str, place: complex) -> complex:
        """Where a body has taken what lay at a ``place``."""
        first, moved, phi = self.motion(body)
        return first + moved + complex(np.exp(1j * phi)) * (place - first)

    def point(self, name: str) -> complex:
        """Where a body's point is."""
        return self.carried(self.scene.body_of(name), complex(*self.scene.place_of(name)))

    @cached_property
    def acting(self) -> dict[str, Acting]:
        """What acts on every beam and body that moves, the scene's loads included."""
        return {name: self._acting(name) for name in (*self.scene.beams, *self.statics.bodies)}

    def _acting(self, name: str) -> Acting:
        mine = np.array([on == name for on in self.statics.on], dtype=bool)
        of, empty = self.statics, np.zeros(0)
        loads = [load for load in self._loads() if load[0] == name]
        by = (*(b for b, here in zip(of.by, mine, strict=True) if here), *(one[1] for one in loads for _ in one[2]))
        return Acting(
            by,
            np.concatenate([empty, of.s[mine], *(one[2] for one in loads)]),
            np.concatenate([empty, of.places[mine] @ (1.0, 1j), *(one[3] for one in loads)]),
            np.concatenate([empty, of.forces[mine] @ (1.0, 1j), *(one[4] for one in loads)]),
            np.concatenate([empty, of.moments[mine], *(one[5] for one in loads)]),
        )

    def _loads(self) -> Iterator[tuple[str, str, Array, Complex, Complex, Array]]:
        """On what each load acts, its name, arc lengths, places, forces and moments."""
        none = np.zeros(1)
        still = np.zeros(1, dtype=complex)
        for name, load in self.scene.loads.items():
            value = self.values[name]
            match load:
                case Moment():
                    at = self.carried(load.body, self.motion(load.body)[0])
                    yield load.body, name, none + np.nan, still + at, still, none + value
                case Force():
                    at, force = self.point(load.point), value * _unit(load.direction)
                    yield self.scene.body_of(load.point), name, none + np.nan, still + at, still + force, none
                case BeamForce():
                    s = none + load.at * self.rests[load.beam].length
                    at_s = self.beams[load.beam].line(s)[0]
                    yield load.beam, name, s, at_s, still + value * _unit(load.direction), none
                case BeamMoment():
                    s = none + load.at * self.rests[load.beam].length
                    yield load.beam, name, s, self.beams[load.beam].line(s)[0], still, none + value
                case DistributedLoad():
                    s, weights = self.spread(load)
                    pressure = np.asarray(value * weights * _unit(load.direction))
                    yield load.beam, name, s, self.beams[load.beam].line(s)[0], pressure, 0.0 * s

    def spread(self, load: DistributedLoad) -> tuple[Array, Array]:
        """Arc lengths (k,) at which a distributed load is summed, and the lengths that they stand for."""
        beam, L = self.beams[load.beam], self.rests[load.beam].length
        begin, end = (share * L for share in load.along)
        knots = np.union1d(beam.inside.borders, beam.cuts[0])
        knots = np.concatenate(([begin], knots[(knots > begin) & (knots < end)], [end]))
        middle, half = 0.5 * (knots[1:] + knots[:-1])[:, None], 0.5 * np.diff(knots)[:, None]
        return (middle + half * _NODES).ravel(), (half * _WEIGHTS).ravel()

    @cached_property
    def energy(self) -> tuple[float, float]:
        """Strain energy and the loads' work from rest, J."""
        strain, work = sum(beam.strain_energy for beam in self.beams.values()), 0.0
        for name in self.scene.loads:
            work += self.values[name] * self.way_of(name)
        return strain, work

    def way_of(self, name: str) -> float:
        """What a load of value one has done since rest: how far its place has gone along it, or turned."""
        load = self.scene.loads[name]
        match load:
            case Moment():
                return self.motion(load.body)[2]
            case Force():
                moved = self.point(load.point) - complex(*self.scene.place_of(load.point))
                return float((moved * np.conj(_unit(load.direction))).real)
            case BeamForce() | DistributedLoad():
                if isinstance(load, BeamForce):
                    s, weights = np.array([load.at * self.rests[load.beam].length]), np.ones(1)
                else:
                    s, weights = self.spread(load)
                moved_s = self.beams[load.beam].line(s)[0] - self.rests[load.beam].places(s)
                return float((moved_s * np.conj(_unit(load.direction))).real @ weights)
            case BeamMoment():
                s = np.linspace(0.0, load.at * self.rests[load.beam].length, 2000)
                beam, rest = self.beams[load.beam], self.rests[load.beam]
                turned = np.unwrap(beam.line(s)[1]) - rest.angles(s)
                _, begun = beam.ends[0]
                return float(turned[-1] - turned[0] + begun) - self._full_turns(load.beam)

    def _full_turns(self, name: str) -> float:
        """By how many full turns, rad, a beam's angles are ahead of the body that holds an end of it, a weld if any.

        A direction is known up to these, and from where the angles of a curve are counted each solver chooses.
        """
        record, beam = self.scene.beams[name], self.beams[name]
        s = np.linspace(0.0, self.rests[name].length, 2000)
        turned = np.unwrap(beam.line(s)[1]) - self.rests[name].angles(s)
        _, begun = beam.ends[0]
        held = [
            (isinstance(end, WeldedEnd), begun + gone - self.motion(self.scene.body_of(end.point))[2])
            for end, gone in ((record.start, 0.0), (record.end, float(turned[-1] - turned[0])))
            if not isinstance(end, FreeEnd)
        ]
        _, ahead = max(held, key=lambda each: each[0])
        return float(2.0 * np.pi * np.round(ahead / (2.0 * np.pi)))


def _unit(direction: tuple[float, float]) -> complex:
    return complex(*direction) / abs(complex(*direction))


def values_at(scene: Scene, station: StationAnswer) -> dict[str, float]:
    """Values of all loads and drives at a station: zero before a stage has stepped them, then their last."""
    values = dict.fromkeys((*scene.loads, *scene.drives), 0.0)
    for stage in scene.stages:
        if stage.name == station.stage:
            return {**values, stage.steps: station.value}
        values[stage.steps] = stage.stations[-1]
    return values


def seen_of(scene: Scene, answer: Answer, rests: dict[str, Rest]) -> Iterator[Seen]:
    """Every station that says what acts there."""
    kinematics = str(answer.settings.get("kinematics", "bending"))
    for station in answer.stations:
        if station.statics is not None:
            yield Seen(scene, station, station.statics, rests, values_at(scene, station), kinematics)
