"""The way through a scene: where it stands, what acts there, and how it goes from one structure to the next."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from cprbm_scene import Event, Stage
from cprbm_scene.answer import Array
from elastica_reference.equations import Equations
from elastica_reference.model import Model
from elastica_reference.newton import Condition, LostError, solve
from elastica_reference.restructure import NotCoveredError, structured
from elastica_reference.settings import Settings
from elastica_reference.stability import least_curvature
from elastica_reference.state import Known, Rest, State, start_of
from elastica_reference.structure import Meeting, Structure, Touch

_SLACK = 1e-8  # of λ, by which a change may seem to lie before the state that it changes
_CHANGE = 1.0  # of an unknown in one step, or its own size


@dataclass
class Way:
    """Where the way stands.

    Attributes:
        model, settings: of what, and how closely.
        values: of the loads and drives that earlier stages have stepped, no dimension.
        stage, stepped, unit: the stage, what it steps, and the unit of that in SI.
        now, before: the last equilibrium, and the one before it if that had the same structure.
        lam: λ there.
        events: contacts that have closed; ``closed_at`` by contact where it did so first, SI.
        states: number of equilibria.
        curvature: least one of the energy at the last of them.
        sides: as :func:`~elastica_reference.gaps.overlaps` asks, of contacts that touch or open
            at the last of them.
    """

    model: Model
    settings: Settings
    values: dict[str, float] = field(default_factory=dict)
    stage: str = ""
    stepped: str = ""
    unit: float = 1.0
    now: State | None = None
    before: State | None = None
    lam: float = 0.0
    events: list[Event] = field(default_factory=list)
    closed_at: dict[str, float] = field(default_factory=dict)
    states: int = 0
    curvature: float = math.nan
    sides: dict[tuple[str, str, str], float] = field(default_factory=dict)

    @property
    def state(self) -> State:
        """The last equilibrium."""
        assert self.now is not None
        return self.now

    @property
    def known(self) -> Known:
        """The last equilibrium, or the state of rest."""
        return Rest(self.model) if self.now is None else self.now

    def begin(self, stage: Stage) -> None:
        """Begin a stage, in the state that is.

        Raises:
            NotCoveredError: it is no equilibrium of the equations.
        """
        if self.stepped:
            self.values[self.stepped] = self.lam
        units = {
            "moment": self.model.unit_moment,
            "force": self.model.unit_force,
            "beam_force": self.model.unit_force,
            "distributed": self.model.unit_force / self.model.unit_length,
            "displacement": self.model.unit_length,
            "rotation": 1.0,
        }
        self.stage, self.stepped = stage.name, stage.steps
        self.unit = units[self.model.scene.stepped(stage).kind]
        self.lam, self.before = self.values.get(stage.steps, 0.0), None
        touches: Mapping[str, Touch] = {} if self.now is None else self.now.structure.touches
        places = {} if self.now is None else self.now.places
        try:
            self.accept(self.restructured(touches, places, self.known, self.lam))
        except LostError:
            raise NotCoveredError(f"the equations are singular where {stage.name} begins") from None

    def restructured(
        self,
        touches: Mapping[str, Touch],
        places: Mapping[tuple[str, str], float],
        near: Known,
        lam: float,
        *,
        forces: Mapping[str, float] | None = None,
        condition: Condition | None = None,
        pinned: tuple[str, str] | str | None = None,
    ) -> State:
        """The equilibrium with some closed contacts.

        Args:
            touches: the contacts; places: about where.
            near: a state to begin with, perhaps of another structure.
            lam: λ, or about where with a condition or with something pinned.
            forces: of contacts that the state does not know.
            condition: one more, for which λ is free.
            pinned: a contact's force that shall be zero, or a place that shall stay where it is said; likewise.

        Raises:
            LostError: there is none nearby.
            NotCoveredError: there are no equations for it.
        """
        structure = structured(self.model, touches, places)
        equations = Equations(self.model, structure, self.stepped, dict(self.values), self.settings.nodes)
        guesses: dict[Any, float] = {**places, **(forces or {})}
        z = start_of(equations, near, guesses)
        where = equations.layout
        if isinstance(pinned, str):
            z[where.forces[pinned]] = 0.0
            condition = _held_at(where.forces[pinned], 0.0)
        elif pinned is not None:
            condition = _held_at(where.places[pinned], places[pinned])
        return solve(equations, z, lam, self.settings.iterations, near, condition)

    def attempt(self, goal: float) -> State:
        """The equilibrium at λ = ``goal`` in the structure that is.

        Raises:
            LostError: it is too far.
        """
        now = self.state
        z: Array = now.z
        if self.before is not None and self.before.lam != now.lam:
            z = z + (z - self.before.z) * ((goal - now.lam) / (now.lam - self.before.lam))
        trial = solve(now.equations, z, goal, self.settings.iterations, now)
        if np.max(np.abs(trial.z - z) / np.maximum(1.0, np.abs(z))) > _CHANGE:
            raise LostError
        return trial

    def at(self, which: tuple[str, str] | str, value: float, near: float, goal: float) -> State:
        """The equilibrium between here and λ = ``goal``, about at λ = ``near``, where a force or a place has a value.

        Raises:
            LostError: there is none.
        """
        where = self.state.equations.layout
        index = where.forces[which] if isinstance(which, str) else where.places[which]
        found = solve(self.state.equations, self.state.z, near, self.settings.iterations, self.state,
                      _held_at(index, value))  # fmt: skip
        return self.between(found, goal)

    def between(self, state: State, goal: float) -> State:
        """A state that lies on the way from here to λ = ``goal``.

        Raises:
            LostError: it does not.
        """
        low, high = sorted((self.lam, goal))
        slack = _SLACK * max(abs(low), abs(high))
        if not low - slack <= state.lam <= high + slack:
            raise LostError
        return state

    def accept(self, state: State) -> None:
        """Go to a state.

        Raises:
            LostError: the equations are singular there.
            NotCoveredError: it is no minimum of the energy.
        """
        same = self.now is not None and self.now.structure == state.structure
        self.curvature = least_curvature(state)
        if self.curvature < 0.0:
            raise NotCoveredError(
                f"the path comes to a fold or a bifurcation between {self.lam * self.unit:.6g} "
                f"and {state.lam * self.unit:.6g} of {self.stepped}"
            )
        self.before = self.now if same and self.now is not None and self.now.lam != state.lam else None
        self.now, self.lam, self.sides = state, state.lam, {}
        for touch in state.structure.touches.values():
            self.note_side(touch)
        self.states += 1

    def note_side(self, touch: Touch) -> None:
        """Note on which side a beam lies that touches another, or has just ceased to."""
        if isinstance(touch, Meeting):
            self.sides[touch.contact, touch.beam, touch.onto] = touch.side

    def note_closed(self, contact: str, lam: float, goal: float) -> None:
        """Note that a contact closes at λ, on the way to ``goal``; what touches from the first closes there."""
        value = (lam if (lam - self.lam) * (goal - self.lam) > 0.0 else self.lam) * self.unit
        self.events.append(Event(self.stage, contact, "closed", value))
        self.closed_at.setdefault(contact, value)


def touches_of(structure: Structure, without: str) -> dict[str, Touch]:
    """A structure's contacts but one."""
    return {name: touch for name, touch in structure.touches.items() if name != without}


def places_of(state: State, without: str) -> dict[tuple[str, str], float]:
    """A state's places of contact but those of one contact."""
    return {key: value for key, value in state.places.items() if key[0] != without}


def _held_at(index: int, value: float) -> Condition:
    """That an unknown has a value."""
    return lambda z, found: z[index] - value
