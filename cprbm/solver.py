"""From a scene to an answer: marching through the stations, load steps that cut and grow.

The march goes on even elements, on a coarse mesh where many are asked.  What is handed out at a station is solved
from there on the mesh that was asked, fitted to where contact is (:mod:`cprbm.refining`).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from threadpoolctl import threadpool_limits

from cprbm.assembling import brought, freed, released
from cprbm.boundary import FittedBoundary
from cprbm.certifying import certify
from cprbm.closing import Closings, Stood
from cprbm.contact import NO_ROWS
from cprbm.equilibrium import Equilibrium, Point, equilibrium, point_at
from cprbm.forces import contact_imbalance
from cprbm.kinematics import rest_state
from cprbm.mechanism import Mechanism, mechanism_of
from cprbm.probing import probed, shapes, touching
from cprbm.refining import all_zones, carried_over, coarser, fits, fitted, long_ones
from cprbm.settings import Settings
from scene import Answer, Certificate, Ending, Event, Scene, Stage, StationAnswer

GROWTH = 2.0
SETTLE = 0.1  # of the way between stations: in shorter steps steady rows may settle which places there are
AGAIN = 12  # iterations on a mesh that fits a little better
FITS = 6  # of the mesh to where contact is, at most
FOLLOWED = 0.2  # rad: the most that a finer mesh may turn a link by against the coarser


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """Solve a scene by the chained pseudo-rigid-body model.

    Args:
        scene: the problem statement.
        settings: numerical choices; by default 40 links per beam and contact where beams are closest.

    Returns:
        Certified answers at the scene's stations, or those reached before the solver's Ending says why it stopped.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    began = time.perf_counter()
    settings = settings or Settings()
    # small matrices: more than one thread of BLAS costs more than it brings
    with threadpool_limits(limits=1, user_api="blas"):
        march = _March(scene, coarser(settings))
        ending, sentence = march.run()
        if ending is not Ending.COMPLETED and len(march.family) > 1:
            # a coarse mesh may be too coarse: without it then
            march = _March(scene, (settings,))
            ending, sentence = march.run()
        notes = march.notes()
    return Answer(
        solver="cprbm",
        scene=scene.name,
        settings=settings.plain(),
        ending=ending,
        sentence=sentence,
        stations=tuple(march.reached),
        events=tuple(march.events),
        seconds=time.perf_counter() - began,
        notes=tuple(notes),
    )


@dataclass(frozen=True, slots=True)
class _Way:
    """What is stepped from one equilibrium that is wanted to the next: some values (SI) that go evenly.

    ``stage`` and ``load`` are the scene's; an assembly steps no load.
    """

    stage: str
    load: str
    begin: Mapping[str, float]
    target: Mapping[str, float]

    def at(self, fraction: float) -> dict[str, float]:
        """All values at a fraction of the way."""
        if fraction == 1.0:
            return dict(self.target)
        return {name: self.begin[name] + fraction * (end - self.begin[name]) for name, end in self.target.items()}

    @property
    def aim(self) -> str:
        """Where it leads, for people."""
        return f"{self.load} = {self.target[self.load]:.6g}" if self.load else "the end of this part"


class _March:
    """The state while marching: where we are, under which loads, and what was reached.

    ``family`` are the meshes from the one that is marched on to the one that is asked.
    """

    def __init__(self, scene: Scene, family: tuple[Settings, ...]) -> None:
        self.scene, self.family, self.settings = scene, family, family[0]
        self.mechanism = mechanism_of(scene, self.settings)
        self.values: dict[str, float] = {}
        problem = self.mechanism.problem
        state = rest_state(problem.model)
        closed = np.zeros(problem.closure.rows)
        self.point = point_at(problem, {}, state, closed, np.zeros(0), NO_ROWS)
        self.reached: list[StationAnswer] = []
        self.events: list[Event] = []
        self.closed_at: dict[str, float] = {}
        self.asked_events = [p.of for p in scene.probes if p.quantity == "closing_load"]
        # where contacts stood open in this stage, of those that have not closed yet
        self.opened: dict[str, list[Stood]] = {}

    def run(self) -> tuple[Ending, str]:
        """Assemble, and march through every stage; the Ending and its sentence."""
        if self.scene.assembly is not None:
            ending, sentence = self._assemble()
            if ending is not Ending.COMPLETED:
                return ending, sentence
        for stage in self.scene.stages:
            here = self.values.get(stage.steps, 0.0), self.point
            self.opened = {name: [here] for name in self.asked_events if name not in self.closed_at}
            for target in stage.stations:
                begin = {**self.values, stage.steps: self.values.get(stage.steps, 0.0)}
                way = _Way(stage.name, stage.steps, begin, {**begin, stage.steps: target})
                ending, sentence, certificate = self._advance(way)
                if certificate is None:
                    last = f"the last good value of {stage.steps} is {self.values.get(stage.steps, 0.0):.6g}"
                    return ending, f"{ending.value}: {sentence}; {last}"
                station = self._station(stage, target, certificate)
                if station is None:
                    return Ending.STEP_TOO_SMALL, "the finer meshes do not follow the coarsest"
                self.reached.append(station)
        return Ending.COMPLETED, Ending.COMPLETED.value

    def _assemble(self) -> tuple[Ending, str]:
        """Bring the beams' ends to their points; the Ending and its sentence."""
        whole = self.mechanism
        for begun in (freed, brought, released):
            part = begun(self.scene, whole, self.point)
            self.mechanism, self.point = part.mechanism, part.start
            ending, sentence, certificate = self._advance(_Way("assembly", "", part.begin, part.target))
            if certificate is None:
                return ending, f"{ending.value}: as {part.sentence}, {sentence}"
        self.mechanism, self.values = whole, {}
        self.closed_at |= {name: 0.0 for name in self.asked_events if _presses(self.point, name)}
        return Ending.COMPLETED, ""

    def _station(self, stage: Stage, value: float, certificate: Certificate) -> StationAnswer | None:
        """The answer at a station that the march has reached, on the mesh that was asked; None if that fails."""
        fitted = self._fitted(certificate)
        if fitted is None:
            if len(self.family) > 1:
                return None
            fitted = self.mechanism, self.point, certificate
        mechanism, point, certificate = fitted
        # what is open on the march's mesh may be closed on this one
        self._note_closings(stage.name, stage.steps, point, value)
        return StationAnswer(
            stage=stage.name,
            value=value,
            values=probed(self.scene, mechanism, point, self.closed_at),
            shapes=shapes(mechanism, point),
            touching=touching(mechanism, point),
            certificate=certificate,
        )

    def _fitted(self, certificate: Certificate) -> tuple[Mechanism, Point, Certificate] | None:
        """The present state on the mesh that was asked, its borders where zones of contact end."""
        mechanism, point, iterations = self.mechanism, self.point, certificate.iterations
        asked, now = self.family[-1], self.settings
        for settings in (*self.family[1:-1], *[asked] * FITS):
            zones = all_zones(mechanism, point)
            if settings is not asked and not long_ones(zones):
                continue  # a few places need no mesh between the coarsest and the finest
            fit = fitted(mechanism, point, zones, settings)
            if settings is now and fits(mechanism, fit):
                break
            target = mechanism_of(self.scene, settings, fit)
            start = carried_over(mechanism, point, target, self.values)
            # the first mesh, or one for other zones, may settle which places there are; the next ones know them
            first = mechanism is self.mechanism or mechanism.fit.ends.keys() != fit.ends.keys()
            most = settings.iterations if first else min(settings.iterations, AGAIN)
            for settle in (False, True) if first and now is asked else (now is not asked,):
                solved = equilibrium(target.problem, self.values, start, settings.tolerance, most, settle=settle)
                iterations += solved.iterations
                if solved.converged:
                    break
            turned = float(np.max(np.abs(solved.point.state.theta - start.state.theta)))
            if not solved.converged or turned > FOLLOWED:
                if now is asked:  # on a mesh that fits a little less it stands already
                    break
                return None
            mechanism, point, now, found = target, solved.point, settings, solved
        if mechanism is not self.mechanism:
            certificate, ending = certify(mechanism, asked, found)
            if ending is not Ending.COMPLETED:
                return None
        return mechanism, point, replace(certificate, iterations=iterations)

    def notes(self) -> list[str]:
        """What a reader should know besides the numbers."""
        said = [
            f"contact '{name}' never closed at a station"
            for name in self.scene.contacts
            if not any(name in station.touching for station in self.reached)
        ]
        for name, boundary in self.mechanism.boundaries.items():
            if not isinstance(boundary, FittedBoundary):
                continue
            own = contact_imbalance(self.mechanism.problem, self.point, name)
            said.append(
                f"in contact '{name}' forces on the fitted boundary's points and on the joints that press it leave a "
                f"moment of {own:.1e} of the largest; the formulation has no rotational invariance"
            )
            beyond = boundary.range_left(self.point.state, self.point.at)
            if np.any(beyond > 0.0):
                farthest = float(beyond.max()) * self.mechanism.problem.model.unit_length
                said.append(
                    f"in contact '{name}' {np.sum(beyond > 0.0)} of {len(beyond)} related joints lie beyond the fitted "
                    f"boundary's ends, by up to {farthest:.2g} m, where it is continued; none of them presses"
                )
        return said

    def _advance(self, way: _Way) -> tuple[Ending, str, Certificate | None]:
        """Go all the way, directly or in steps; the certificate at its end."""
        done, step, iterations = 0.0, 1.0, 0
        while True:
            step = min(step, 1.0 - done)
            fraction = 1.0 if done + step >= 1.0 else done + step
            values = way.at(fraction)
            found = self._try(self.point, values, settle=step <= SETTLE)
            iterations += found.iterations
            certificate, ending = certify(self.mechanism, self.settings, found)
            turned = float(np.max(np.abs(found.point.state.theta - self.point.state.theta)))
            if ending is Ending.COMPLETED and turned > self.settings.largest_turn:
                ending, sentence = (
                    Ending.STEP_TOO_SMALL,
                    f"a link turned by {turned:.2f} rad in one load step",
                )
            elif ending is Ending.COMPLETED and (crossed := self.mechanism.passed(self.point, found.point)):
                ending, sentence = (
                    Ending.BEAMS_CROSSED,
                    f"in contact '{crossed}' the beam went across what it may touch",
                )
            elif certificate.failures:
                sentence = certificate.failures[0] if found.converged else "Newton's method did not settle"
            if ending is Ending.COMPLETED:
                if self.opened:
                    self._note_closings(way.stage, way.load, found.point, values[way.load])
                self.point, self.values, done = found.point, values, fraction
                for name, opened in self.opened.items():
                    if not _presses(self.point, name):
                        opened.append((values[way.load], self.point))
                if fraction == 1.0:
                    return ending, "", replace(certificate, iterations=iterations)
                step *= GROWTH
                continue
            step *= 0.5
            if iterations > self.settings.iteration_limit:
                return Ending.STEP_TOO_SMALL, f"{iterations} iterations did not lead to {way.aim}", None
            if step < self.settings.smallest_step:
                if not found.converged:
                    ending = Ending.STEP_TOO_SMALL
                return ending, sentence, None

    def _try(self, start: Point, values: dict[str, float], *, settle: bool) -> Equilibrium:
        problem, settings = self.mechanism.problem, self.settings
        return equilibrium(problem, values, start, settings.tolerance, settings.iterations, settle=settle)

    def _note_closings(self, stage: str, load: str, after: Point, value: float) -> None:
        """Note which contacts have closed on the way to ``after``, and where, if the scene asks."""
        for name in [name for name in self.opened if _presses(after, name)]:
            closings = Closings(self.scene, self.family[-1], self.mechanism, self.asked, load, self.values)
            closing = closings.first(name, self.opened[name], value)
            if closing is not None:
                del self.opened[name]
                self.closed_at[name] = closing
                self.events.append(Event(stage, name, "closes", closing))

    @cached_property
    def asked(self) -> Mechanism:
        """The scene on even elements of the mesh that was asked."""
        return self.mechanism if len(self.family) == 1 else mechanism_of(self.scene, self.family[-1])


def _presses(point: Point, contact: str) -> bool:
    return any(lam > 0.0 for lam, name in zip(point.lam, point.rows.contact, strict=True) if name == contact)
