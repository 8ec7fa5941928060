"""The march from rest through a scene's stations, contact by contact.

From one state to the next the load or drive grows by steps that Newton's method can take.  After each the state is
looked over: a contact that would pull opens, lines that overlap close a contact, a beam that would cut into a circle
beside the place where it touches lies along it.  Where that happened is found as an equilibrium at which the new
contact's force, or the old one's, is zero; from there it goes on.

What is beyond this is not answered: two beams that lie along each other, one contact at two places at once, a path
that comes to a fold or a bifurcation (there the determinant of the equations' derivative changes its sign).
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from exact.equations import Columns, Equations, Evaluation
from exact.gaps import Overlap, overlaps
from exact.model import Model, modelled
from exact.newton import Condition, LostError, checked, solve
from exact.probing import answered
from exact.restructure import NotCoveredError, closed, structured
from exact.settings import Settings
from exact.state import Known, Rest, State, start_of
from exact.structure import Meeting, Resting, Structure, Touch, Wrap
from scene import Answer, CircleContact, Ending, Event, Scene, Stage, StationAnswer
from scene.answer import Array

_PULLS = -1e-10  # of a contact's force, no dimension
_OVERLAP = 1e-10  # of the unit of length
_CHANGE = 1.0  # of an unknown in one step
_ON_CIRCLE = 1e-9  # of the unit of length and of a tangent, where an end is clamped on a circle
_NEAR_END = 0.2  # of a beam: a contact at its end that moves in appears within this
_FIRST_PLACES = (0.02, 0.01, 0.005)  # of a beam, where a contact that leaves a clamp is first looked for
_PRESSED = 101  # places along a wrap at which its pressure is looked at
_CHANGES = 40  # of structure between two stations


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """The exact answer to a scene in the theory of bending without stretch and shear.

    Args:
        scene: the question.
        settings: numerical choices.

    Returns:
        The stations up to where the solution holds; its ending is NOT_COVERED where one is missing.
    """
    chosen = settings or Settings()
    began = time.perf_counter()
    march = _March(modelled(scene), chosen)
    stations: list[StationAnswer] = []
    ending, sentence = Ending.COMPLETED, ""
    try:
        for stage in scene.stages:
            march.step(stage)
            for station in stage.stations:
                march.advance(station / march.unit)
                stations.append(
                    answered(march.model, march.state, stage.name, station, march.closed_at, march.iterations,
                             checked(march.state, chosen.further))
                )  # fmt: skip
                if stations[-1].certificate.failures:
                    raise NotCoveredError(stations.pop().certificate.failures[0])
    except NotCoveredError as error:
        ending, sentence = Ending.NOT_COVERED, f"{error}."
    return Answer(
        solver="exact",
        scene=scene.name,
        settings=chosen.plain(),
        ending=ending,
        sentence=sentence,
        stations=tuple(stations),
        events=tuple(march.events),
        seconds=time.perf_counter() - began,
    )


def _held_at(index: int, value: float) -> Condition:
    """That an unknown has a value."""
    return lambda z, found: z[index] - value


@dataclass
class _March:
    """Where the march stands: the state, the one before it in the same structure, and what has happened."""

    model: Model
    settings: Settings
    values: dict[str, float] = field(default_factory=dict)
    stage: str = ""
    stepped: str = ""
    unit: float = 1.0
    touches: Mapping[str, Touch] = field(default_factory=dict)
    places: dict[tuple[str, str], float] = field(default_factory=dict)
    before: State | None = None
    now: State | None = None
    lam: float = 0.0
    step_size: float = 0.0
    events: list[Event] = field(default_factory=list)
    closed_at: dict[str, float] = field(default_factory=dict)
    iterations: int = 0

    @property
    def state(self) -> State:
        """The last equilibrium."""
        assert self.now is not None
        return self.now

    @property
    def known(self) -> Known:
        """The last equilibrium, or the state of rest."""
        return Rest(self.model) if self.now is None else self.now

    def step(self, stage: Stage) -> None:
        """Begin a stage that steps a load or drive."""
        if self.stepped:
            self.values[self.stepped] = self.lam
        kind = self.model.scene.stepped(stage).kind
        units = {
            "moment": self.model.unit_moment,
            "force": self.model.unit_force,
            "displacement": self.model.unit_length,
            "rotation": 1.0,
        }
        self.stage, self.stepped, self.unit = stage.name, stage.steps, units[kind]
        self.lam, self.before, self.step_size = self.values.get(stage.steps, 0.0), None, 0.0

    def advance(self, target: float) -> None:
        """Go on to a value of what is stepped, no dimension.

        Raises:
            NotCoveredError: the path leads beyond what the equations cover.
        """
        whole = target - self.lam
        if self.now is None:
            self._accept(self._solved(structured(self.model, {}, {}), self.lam), {})
        elif self.now.equations.stepped != self.stepped:
            self._accept(self._solved(self.now.structure, self.lam), self.places)
        if whole == 0.0:
            return
        size = self.settings.largest_step * abs(whole)
        step = min(size, self.step_size or 0.2 * abs(whole))
        changes = 0
        while self.lam != target:
            goal = target if abs(target - self.lam) <= step else self.lam + math.copysign(step, whole)
            try:
                trial = self._attempt(goal)
                if not self._examined(trial, goal):
                    changes += 1
                    if changes > _CHANGES:
                        raise NotCoveredError("contacts open and close without end")
                step = min(1.5 * step, size)
            except LostError as error:
                step *= 0.4
                if step < self.settings.smallest_step * abs(whole):
                    raise NotCoveredError(
                        f"no equilibrium was found beyond {self.lam * self.unit:.6g} of {self.stepped}{error}"
                    ) from None
        self.step_size = step

    # ----------------------------------------------------------------------------------------- steps

    def _equations(self, structure: Structure) -> Equations:
        return Equations(self.model, structure, self.stepped, self.values, self.settings.nodes,
                         lambda beam, s: self.known.along(beam, s)[2])  # fmt: skip

    def _solved(
        self, structure: Structure, lam: float, z: Array | None = None, condition: Condition | None = None
    ) -> State:
        equations = self._equations(structure)
        if z is None:
            z = self._start(equations, self.known, self.places)
        return solve(equations, z, lam, self.settings.iterations, self.known, condition)

    def _start(self, equations: Equations, known: Known, guesses: Mapping[Any, float]) -> Array:
        return start_of(equations, known, self._values(known), guesses)

    def _values(self, known: Known) -> dict[str, Any]:
        """The unknowns of a state that have names of their own."""
        if not isinstance(known, State):
            return {}
        where = known.equations.layout
        bodies = {name: known.z[place] for name, place in where.bodies.items()}
        return {**bodies, **{name: known.z[index] for name, index in (*where.drives.items(), *where.forces.items())}}

    def _attempt(self, goal: float) -> State:
        """The equilibrium at the goal in the structure that is.

        Raises:
            LostError: it is too far.
        """
        now = self.state
        z = now.z
        if self.before is not None and self.before.lam != now.lam:
            z = z + (z - self.before.z) * ((goal - now.lam) / (now.lam - self.before.lam))
        trial = self._solved(now.structure, goal, z)
        if np.max(np.abs(trial.z - z)) > _CHANGE:
            raise LostError
        return trial

    def _accept(self, state: State, places: Mapping[tuple[str, str], float]) -> None:
        same = self.now is not None and self.now.structure == state.structure
        if same and self.now is not None and state.sign * self.now.sign < 0.0:
            raise NotCoveredError(
                f"the path comes to a fold or a bifurcation between {self.now.lam * self.unit:.6g} "
                f"and {state.lam * self.unit:.6g} of {self.stepped}"
            )
        self.before = self.now if same else None
        self.now, self.lam = state, state.lam
        self.touches = dict(state.structure.touches)
        self.places = {key: float(state.z[index]) for key, index in state.equations.layout.places.items()}
        self.iterations += 1

    # --------------------------------------------------------------------------------------- structure

    def _examined(self, trial: State, goal: float) -> bool:
        """Accept a trial if nothing is wrong with it, else go to where something changes and say False.

        Raises:
            LostError: what changes could not be found.
            NotCoveredError: it cannot be answered.
        """
        where = trial.equations.layout
        pulling = [name for name, index in where.forces.items() if trial.z[index] < _PULLS]
        if pulling:
            self._open(trial, pulling)
            return False
        if self._replaced(trial, goal):
            return False
        found = overlaps(
            self.model, trial, self.known, {k: v[:, 0] for k, v in trial.found.centres.items()},
            self._touched(trial), _OVERLAP,
        )  # fmt: skip
        if found:
            self._close(trial, found, goal)
            return False
        self._accept(trial, {})
        return True

    def _touched(self, state: State) -> dict[tuple[str, str], tuple[float, float]]:
        """By contact and beam, from where to where it touches."""
        where, found = state.equations.layout, {}
        for name, touch in state.structure.touches.items():
            if isinstance(touch, Wrap):
                found[name, touch.beam] = state.wrapped(touch)
                continue
            s = touch.at if touch.at is not None else float(state.z[where.places[name, touch.beam]])
            found[name, touch.beam] = (s, s)
            if isinstance(touch, Meeting):
                sigma = float(state.z[where.places[name, touch.onto]])
                found[name, touch.onto] = (sigma, sigma)
        return found

    def _between(self, state: State) -> State:
        """A state that lies on the way from where the march stands."""
        slack = 1e-9 * max(abs(self.lam), abs(state.lam), 1e-3)
        low, high = sorted((self.lam, self._goal))
        if not low - slack <= state.lam <= high + slack:
            raise LostError
        return state

    def _open(self, trial: State, pulling: list[str]) -> None:
        """Go to where the first of some contacts opens."""
        self._goal = trial.lam
        where = trial.equations.layout
        fractions = {}
        for name in pulling:
            index = where.forces[name]
            was = float(self.state.z[index])
            fractions[name] = was / (was - float(trial.z[index])) if was > 0.0 else 0.0
        name = min(fractions, key=lambda key: fractions[key])
        index, share = where.forces[name], fractions[name]
        z = self.state.z + share * (trial.z - self.state.z)
        lam = self.lam + share * (trial.lam - self.lam)
        at = self._between(self._solved(trial.structure, lam, z, _held_at(index, 0.0)))
        touches = {key: touch for key, touch in trial.structure.touches.items() if key != name}
        places = {
            key: float(at.z[at.equations.layout.places[key]]) for key in at.equations.layout.places if key[0] != name
        }
        structure = structured(self.model, touches, places)
        equations = self._equations(structure)
        z = start_of(equations, at, self._values(at), places)
        self._accept(solve(equations, z, at.lam, self.settings.iterations, at), places)

    def _replaced(self, trial: State, goal: float) -> bool:
        """Give places that have passed an end, a knot or each other, and circles that are cut, another structure."""
        where = trial.equations.layout
        touches, places = dict(trial.structure.touches), {k: float(trial.z[i]) for k, i in where.places.items()}
        changed = False
        for name, touch in trial.structure.touches.items():
            if isinstance(touch, Wrap):
                a, b = trial.wrapped(touch)
                pressure, begin, end = trial.pressures(touch, np.linspace(a, b, _PRESSED))
                scale = float(np.hypot(*trial.found.resultants[name][:, 0]))
                if b < a:
                    if touch.from_start or touch.to_end:
                        raise NotCoveredError(f"{touch.beam} leaves the circle of {name} at its clamp")
                    places = {key: value for key, value in places.items() if key[0] != name}
                    touches[name], places[name, touch.beam] = Resting(name, touch.beam, None), 0.5 * (a + b)
                    changed = True
                elif min(float(np.min(pressure)) * (b - a), begin, end) < -1e-6 * scale:
                    raise NotCoveredError(f"{touch.beam} does not press on the circle of {name} all along its wrap")
                continue
            if touch.at is None:
                s, length = places[name, touch.beam], self.model.strips[touch.beam].length
                if not 0.0 <= s <= length:
                    touches[name] = replace(touch, at=0.0 if s < 0.0 else length)
                    del places[name, touch.beam]
                    changed = True
                    continue
            if isinstance(touch, Meeting):
                sigma, length = places[name, touch.onto], self.model.strips[touch.onto].length
                if not 0.0 <= sigma <= length:
                    raise NotCoveredError(f"the place of {name} slides off the end of {touch.onto}")
            elif touch.at is None and self._cuts(trial, touch):
                s, sense = places.pop((name, touch.beam)), self._sense(trial, touch)
                touches[name] = Wrap(name, touch.beam, sense)
                delta = 1e-3 * self.model.strips[touch.beam].length
                places[name, "begin"], places[name, "end"] = s - delta, s + delta
                changed = True
        structure = structured(self.model, touches, places)
        if not changed and structure == trial.structure:
            return False
        equations = self._equations(structure)
        forces: dict[Any, float] = {name: float(trial.z[index]) for name, index in where.forces.items()}
        z = start_of(equations, self.known, self._values(trial), {**places, **forces})
        fresh = solve(equations, z, goal, self.settings.iterations, self.known)
        if self._replaceable(fresh):
            raise LostError
        self._accept(fresh, places)
        return True

    def _replaceable(self, state: State) -> bool:
        """Whether a contact of a state is still in the wrong form."""
        for name, touch in state.structure.touches.items():
            if isinstance(touch, Wrap):
                a, b = state.wrapped(touch)
                if b < a:
                    return True
            elif state.z[state.equations.layout.forces[name]] < _PULLS:
                return True
        return False

    def _cuts(self, state: State, touch: Resting) -> bool:
        """Whether a beam that touches a circle at one place cuts into it on both sides."""
        strip = self.model.strips[touch.beam]
        s = np.array([state.z[state.equations.layout.places[touch.contact, touch.beam]]])
        x, y, theta, m = state.along(touch.beam, s)[:4, 0]
        arm = np.array([x, y]) - state.found.centres[touch.contact][:, 0]
        rho = float(np.hypot(*arm))
        kappa = float((strip.line.curvature(s) + strip.compliance(s) * m)[0])
        away = kappa * (-np.sin(theta) * arm[0] + np.cos(theta) * arm[1]) / rho
        return bool(away + 1.0 / rho < -1e-9)

    def _sense(self, state: State, touch: Resting) -> float:
        s = np.array([state.z[state.equations.layout.places[touch.contact, touch.beam]]])
        x, y, theta = state.along(touch.beam, s)[:3, 0]
        arm = np.array([x, y]) - state.found.centres[touch.contact][:, 0]
        return float(np.sign(arm[0] * np.sin(theta) - arm[1] * np.cos(theta)))

    # ------------------------------------------------------------------------------------- closings

    def _close(self, trial: State, found: list[Overlap], goal: float) -> None:
        """Go to where the first of some overlaps begins."""
        self._goal = goal
        reached: list[tuple[float, State, Overlap]] = []
        for overlap in found:
            present = trial.structure.touches.get(overlap.contact)
            if present is not None:
                self._moved_in(trial, present, overlap, goal)
                return
            if overlap.onto is None and self._clamped_on(overlap) is not None:
                self._leave_clamp(trial, overlap)
                return
            reached.append((*self._first_touch(trial, overlap), overlap))
        lam, state, overlap = min(reached, key=lambda item: abs(item[0] - self.lam))
        self._note(overlap.contact, lam)
        self._accept(state, {})

    def _note(self, contact: str, lam: float) -> None:
        self.events.append(Event(self.stage, contact, "closed", lam * self.unit))
        self.closed_at.setdefault(contact, lam * self.unit)

    def _first_touch(self, trial: State, overlap: Overlap) -> tuple[float, State]:
        touch, own = closed(self.model, overlap)
        places = {**{k: float(trial.z[i]) for k, i in trial.equations.layout.places.items()}, **own}
        structure = structured(self.model, {**trial.structure.touches, overlap.contact: touch}, places)
        equations = self._equations(structure)
        z = start_of(equations, trial, self._values(trial), {**places, overlap.contact: 0.0})
        index = equations.layout.forces[overlap.contact]
        state = self._between(solve(equations, z, trial.lam, self.settings.iterations, trial, _held_at(index, 0.0)))
        return state.lam, state

    def _moved_in(self, trial: State, present: Touch, overlap: Overlap, goal: float) -> None:
        """A contact at a beam's end goes on between its ends; anywhere else it would be a second place."""
        at = None if isinstance(present, Wrap) else present.at
        length = self.model.strips[overlap.beam].length
        fits = at is not None and overlap.beam == present.beam and abs(overlap.s - at) < _NEAR_END * length
        if not fits:
            raise NotCoveredError(f"{overlap.contact} touches at a second place or along a length")
        assert not isinstance(present, Wrap)
        places = {k: float(trial.z[i]) for k, i in trial.equations.layout.places.items()}
        places[overlap.contact, overlap.beam] = overlap.s
        if overlap.onto is not None:
            places[overlap.contact, overlap.onto] = overlap.sigma
        structure = structured(
            self.model, {**trial.structure.touches, overlap.contact: replace(present, at=None)}, places
        )
        equations = self._equations(structure)
        z = start_of(equations, trial, self._values(trial), places)
        fresh = solve(equations, z, goal, self.settings.iterations, trial)
        s = float(fresh.z[fresh.equations.layout.places[overlap.contact, overlap.beam]])
        if self._replaceable(fresh) or not 0.0 <= s <= length:
            raise LostError
        self._accept(fresh, places)

    # ------------------------------------------------------------------------- a clamp on the circle

    def _clamped_on(self, overlap: Overlap) -> str | None:
        """Which end of the beam is clamped on the circle, tangent to it, near an overlap."""
        contact = self.model.scene.contacts[overlap.contact]
        assert isinstance(contact, CircleContact)
        strip = self.model.strips[overlap.beam]
        for which, end, s in (("start", strip.start, 0.0), ("end", strip.end, strip.length)):
            if end.point is None or not end.welded or self.model.scene.body_of(end.point) != contact.body:
                continue
            arm = self.model.rest(end.point) - np.array(contact.center) / self.model.unit_length
            half = 0.5 * float(strip.beam.thickness_at(np.array([s / strip.length]))[0]) if contact.thick else 0.0
            rho = (contact.radius + half) / self.model.unit_length
            theta = float(strip.line.angle(np.array([s]))[0])
            leans = abs(arm[0] * np.cos(theta) + arm[1] * np.sin(theta))
            near = abs(overlap.s - s) < 0.5 * strip.length
            if near and abs(np.hypot(*arm) - rho) < _ON_CIRCLE and leans < _ON_CIRCLE:
                return which
        return None

    def _leave_clamp(self, trial: State, overlap: Overlap) -> None:
        """Go to where a clamped end bends like the circle, and on along it or away from it."""
        which = self._clamped_on(overlap)
        strip, name = self.model.strips[overlap.beam], overlap.contact
        contact = self.model.scene.contacts[name]
        assert isinstance(contact, CircleContact)
        held = np.array([0.0 if which == "start" else strip.length])
        state = trial.along(strip.name, held)[:, 0]
        arm = state[:2] - trial.found.centres[name][:, 0]
        rho, sense = float(np.hypot(*arm)), float(np.sign(arm[0] * np.sin(state[2]) - arm[1] * np.cos(state[2])))
        wanted = float((strip.rigidity(held) * (sense / rho - strip.line.curvature(held)))[0])

        def bent(z: Columns, found: Evaluation) -> Columns:
            piece = found.pieces[strip.name][0 if which == "start" else -1]
            moment: Columns = piece[2][3] if which == "start" else piece[3][3]
            return moment - wanted

        at = self._between(self._solved(trial.structure, trial.lam, trial.z, bent))
        self._note(name, at.lam)
        self._accept(at, {})
        if self._wrapped_from(at, overlap, which or "start", sense):
            return
        self._leaves(at, overlap, which or "start")

    def _wrapped_from(self, at: State, overlap: Overlap, which: str, sense: float) -> bool:
        """Go on with a wrap from a clamp, if it presses."""
        name, strip = overlap.contact, self.model.strips[overlap.beam]
        if strip.beam.tapered:
            return False
        old = {k: float(at.z[i]) for k, i in at.equations.layout.places.items()}
        wrap = Wrap(name, strip.name, sense, from_start=which == "start", to_end=which == "end")
        for share in (0.25, 0.1, 0.03):
            length = share * abs(overlap.s - (0.0 if which == "start" else strip.length)) + 1e-6
            key = "end" if which == "start" else "begin"
            places = {**old, (name, key): length if which == "start" else strip.length - length}
            structure = structured(self.model, {**at.structure.touches, name: wrap}, places)
            equations = self._equations(structure)
            index = equations.layout.places[name, key]
            z, value = start_of(equations, at, self._values(at), places), places[name, key]
            try:
                state = solve(equations, z, at.lam, self.settings.iterations, at,
                              _held_at(index, value))  # fmt: skip
                self._between(state)
            except LostError:
                continue
            pressure, begin, end = state.pressures(wrap, np.linspace(*state.wrapped(wrap), _PRESSED))
            if min(float(np.min(pressure)), begin, end) < -1e-9:
                return False
            self._accept(state, places)
            return True
        return False

    def _leaves(self, at: State, overlap: Overlap, which: str) -> None:
        """Go on with a place of contact that travels away from a clamp."""
        name, strip = overlap.contact, self.model.strips[overlap.beam]
        old = {k: float(at.z[i]) for k, i in at.equations.layout.places.items()}
        touch = Resting(name, strip.name, None)
        for share in _FIRST_PLACES:
            s = share * strip.length if which == "start" else (1.0 - share) * strip.length
            places = {**old, (name, strip.name): s}
            structure = structured(self.model, {**at.structure.touches, name: touch}, places)
            equations = self._equations(structure)
            where = equations.layout
            index = where.places[name, strip.name]
            held = at.along(strip.name, np.array([0.0 if which == "start" else strip.length]))[:, 0]
            arm = held[:2] - at.found.centres[name][:, 0]
            shear = float(held[4:] @ arm / np.hypot(*arm))
            z = start_of(equations, at, self._values(at), {**places, name: abs(shear)})
            try:
                state = solve(equations, z, at.lam, self.settings.iterations, at,
                              _held_at(index, s))  # fmt: skip
                self._between(state)
            except LostError:
                continue
            if state.z[where.forces[name]] < 0.0:
                continue
            self._accept(state, places)
            return
        raise LostError(f", where {name} begins beside the clamp")
