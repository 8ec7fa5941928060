"""From a scene to an answer: marching through the stations, load steps that cut and grow.

The march goes on even elements, on a coarse mesh where many are asked.  What is handed out at a station is solved
from there on the mesh that was asked, fitted to where contact is (:mod:`cprbm.refining`).
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq, root_scalar
from threadpoolctl import threadpool_limits

from cprbm.boundary import FittedBoundary
from cprbm.certifying import certify
from cprbm.contact import NO_ROWS
from cprbm.equilibrium import Equilibrium, Point, equilibrium, point_at
from cprbm.forces import contact_imbalance
from cprbm.kinematics import rest_state
from cprbm.mechanism import Mechanism, mechanism_of
from cprbm.probing import probed, shapes, touching
from cprbm.refining import all_zones, carried_over, coarser, fits, fitted, long_ones
from cprbm.settings import Settings
from scene import Answer, Certificate, Ending, Event, Scene, StationAnswer

GROWTH = 2.0
EVENT_TOLERANCE = 1e-10  # of the load step in which a contact closed
CLOSER = 8
SETTLE = 0.1  # of the way between stations: in shorter steps steady rows may settle which places there are
NEARLY = 0.05  # of a closing load: it lies no farther from that on even elements
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

    def run(self) -> tuple[Ending, str]:
        """March through every stage; the Ending and its sentence."""
        for stage in self.scene.stages:
            for target in stage.stations:
                begin = self.values.get(stage.steps, 0.0)
                ending, sentence, certificate = self._advance(stage.name, stage.steps, begin, target)
                if certificate is None:
                    last = f"the last good value of {stage.steps} is {self.values.get(stage.steps, 0.0):.6g}"
                    return ending, f"{ending.value}: {sentence}; {last}"
                station = self._station(stage.name, target, certificate)
                if station is None:
                    return Ending.STEP_TOO_SMALL, "the finer meshes do not follow the coarsest"
                self.reached.append(station)
        return Ending.COMPLETED, Ending.COMPLETED.value

    def _station(self, stage: str, value: float, certificate: Certificate) -> StationAnswer | None:
        """The answer at a station that the march has reached, on the mesh that was asked; None if that fails."""
        fitted = self._fitted(certificate)
        if fitted is None:
            if len(self.family) > 1:
                return None
            fitted = self.mechanism, self.point, certificate
        mechanism, point, certificate = fitted
        return StationAnswer(
            stage=stage,
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

    def _advance(self, stage: str, load: str, begin: float, target: float) -> tuple[Ending, str, Certificate | None]:
        """Go from one load value to the next, directly or in steps; the certificate at the target."""
        done, step, iterations = 0.0, 1.0, 0
        while True:
            step = min(step, 1.0 - done)
            fraction = 1.0 if done + step >= 1.0 else done + step
            value = target if fraction == 1.0 else begin + fraction * (target - begin)
            found = self._try(self.point, {**self.values, load: value}, settle=step <= SETTLE)
            iterations += found.iterations
            certificate, ending = certify(self.mechanism, self.settings, found)
            turned = float(np.max(np.abs(found.point.state.theta - self.point.state.theta)))
            if ending is Ending.COMPLETED and turned > self.settings.largest_turn:
                ending, sentence = (
                    Ending.STEP_TOO_SMALL,
                    f"a link turned by {turned:.2f} rad in one load step",
                )
            elif ending is Ending.COMPLETED and (crossed := self.mechanism.passed(self.point, found.point)):
                ending, sentence = Ending.BEAMS_CROSSED, f"in contact '{crossed}' the beam went across the circle"
            elif certificate.failures:
                sentence = certificate.failures[0] if found.converged else "Newton's method did not settle"
            if ending is Ending.COMPLETED:
                self._note_events(stage, load, found.point, value)
                self.point, done = found.point, fraction
                self.values[load] = value
                if fraction == 1.0:
                    return ending, "", replace(certificate, iterations=iterations)
                step *= GROWTH
                continue
            step *= 0.5
            if iterations > self.settings.iteration_limit:
                return Ending.STEP_TOO_SMALL, f"{iterations} iterations did not lead to {load} = {target:.6g}", None
            if step < self.settings.smallest_step:
                if not found.converged:
                    ending = Ending.STEP_TOO_SMALL
                return ending, sentence, None

    def _try(self, start: Point, values: dict[str, float], *, settle: bool) -> Equilibrium:
        problem, settings = self.mechanism.problem, self.settings
        return equilibrium(problem, values, start, settings.tolerance, settings.iterations, settle=settle)

    def _note_events(self, stage: str, load: str, after: Point, value: float) -> None:
        """Find where contacts closed in the load step that led to ``after``, if the scene asks."""
        for name in self.asked_events:
            if name in self.closed_at or not _presses(after, name) or _presses(self.point, name):
                continue
            closing = self._closing(name, load, value)
            if closing is not None:
                self.closed_at[name] = closing
                self.events.append(Event(stage, name, "closes", closing))

    def _closing(self, name: str, load: str, target: float) -> float | None:
        """The load at which the gap of an open contact becomes zero, the contact itself left out."""
        mechanism, point, begin = self.mechanism, self.point, self.values.get(load, 0.0)
        if len(self.family) > 1:
            asked = mechanism_of(self.scene, self.family[-1])
            mechanism, point = asked, carried_over(mechanism, point, asked, self.values)
        gap = _Gap(replace(mechanism, problem=mechanism.without(name)), name, self.values, load, self.settings)
        gap.known(begin, point)
        # without the contact the far end may be out of reach: come closer until it is not
        low, high = gap.overlap(begin), gap.overlap(target)
        for _ in range(CLOSER):
            if not np.isnan(high):
                break
            target = 0.5 * (begin + target)
            high = gap.overlap(target)
        if not low <= 0.0 <= high:
            return None
        tolerance = EVENT_TOLERANCE * abs(target - begin)
        try:
            closing = float(brentq(gap.overlap, begin, target, xtol=tolerance, rtol=8.9e-16))
        except ValueError:  # between the two the mechanism has no equilibrium without the contact
            return None
        return self._closing_fitted(gap, closing, 1e-3 * (target - begin), tolerance)

    def _closing_fitted(self, gap: _Gap, closing: float, step: float, tolerance: float) -> float:
        """The same on the mesh that is fitted to where the other contacts are then."""
        for _ in range(FITS):
            mechanism, point = gap.mechanism, gap.nearest(closing)
            fit = fitted(mechanism, point, all_zones(mechanism, point), self.family[-1])
            if fits(mechanism, fit):
                break
            target = mechanism_of(self.scene, self.family[-1], fit)
            gap = replace(gap, mechanism=replace(target, problem=target.without(gap.contact)), solved={})
            gap.known(closing, carried_over(mechanism, point, gap.mechanism, {**self.values, gap.load: closing}))
            found = root_scalar(gap.overlap, method="secant", x0=closing, x1=closing + step, xtol=tolerance)
            if not found.converged or not abs(found.root - closing) <= NEARLY * abs(closing):
                break  # on a mesh that fits a little less it is known already
            closing = float(found.root)
        return closing


@dataclass(frozen=True, slots=True)
class _Gap:
    """How far a contact that holds nothing apart is open or violated, as a function of the load.

    ``mechanism`` is without the contact; ``solved`` are the states that are known, by the load's value.
    """

    mechanism: Mechanism
    contact: str
    values: dict[str, float]
    load: str
    settings: Settings
    solved: dict[float, Point] = field(default_factory=dict)

    def known(self, value: float, point: Point) -> None:
        """Begin from a state near ``value``."""
        problem, values = self.mechanism.problem, {**self.values, self.load: value}
        self.solved[value] = point_at(problem, values, point.state, point.mu, np.zeros(0), NO_ROWS)

    def nearest(self, value: float) -> Point:
        """The state whose load is nearest."""
        return self.solved[min(self.solved, key=lambda other: abs(other - value))]

    def overlap(self, value: float) -> float:
        """Largest overlap at a value of the load, units of length; NaN where there is no equilibrium."""
        values = {**self.values, self.load: value}
        start, settings = self.nearest(value), self.settings
        found = equilibrium(self.mechanism.problem, values, start, settings.tolerance, settings.iterations)
        if not found.converged:
            return float("nan")
        self.solved[value] = found.point
        return max(self.mechanism.overlap(self.contact, found.point.state, found.point.at), -1.0)


def _presses(point: Point, contact: str) -> bool:
    return any(lam > 0.0 for lam, name in zip(point.lam, point.rows.contact, strict=True) if name == contact)
