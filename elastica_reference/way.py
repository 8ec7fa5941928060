"""State of load stepping through a scene, and steps between structures."""

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
from elastica_reference.restructure import NotCoveredError, structure_of
from elastica_reference.settings import Settings
from elastica_reference.stability import least_curvature
from elastica_reference.state import Known, Rest, State, start_of
from elastica_reference.structure import Meeting, Structure, Touch

_SLACK = 1e-8  # times λ: tolerance for a change slightly before its state
_CHANGE = 1.0  # largest change of an unknown in a step, absolute or relative


@dataclass
class Stepping:
    """State of load stepping.

    Attributes:
        model, settings: mechanism and numerical settings.
        values: dimensionless values of loads and drives stepped in earlier stages.
        stage, stepped, unit: the stage, its stepped load or drive, and the SI unit of the latter.
        now, before: the last equilibrium, and the previous one if of the same structure.
        lam: λ of the last equilibrium.
        events: closings of contacts; ``closed_at`` is the first closing value (SI) by contact.
        states: number of equilibria.
        curvature: least curvature of the energy in the last equilibrium.
        sides: sides for :func:`~elastica_reference.gaps.overlaps`, of contacts closed or opening in the last
            equilibrium.
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
        """Begin a stage in the present state.

        Raises:
            NotCoveredError: the equations are singular.
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
        """Equilibrium with given closed contacts.

        Args:
            touches: the contacts; places: their approximate places.
            near: start state, possibly of another structure.
            lam: λ, or its initial guess with a condition or a pinned quantity.
            forces: of contacts unknown in the start state.
            condition: additional condition, with λ as additional unknown.
            pinned: a contact whose force is zero, or a place with a fixed value, as additional condition.

        Raises:
            LostError: there is no equilibrium nearby.
            NotCoveredError: there are no equations for the structure.
        """
        structure = structure_of(self.model, touches, places)
        equations = Equations(self.model, structure, self.stepped, dict(self.values), self.settings.nodes)
        guesses: dict[Any, float] = {**places, **(forces or {})}
        z = start_of(equations, near, guesses)
        where = equations.layout
        if isinstance(pinned, str):
            z[where.forces[pinned]] = 0.0
            condition = _has_value(where.forces[pinned], 0.0)
        elif pinned is not None:
            condition = _has_value(where.places[pinned], places[pinned])
        return solve(equations, z, lam, self.settings.iterations, near, condition)

    def attempt(self, goal: float) -> State:
        """Equilibrium at λ = ``goal`` in the present structure.

        Raises:
            LostError: the equilibrium is too far.
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
        """Equilibrium at which a force or place has a given value, between here and λ = ``goal``, near λ = ``near``.

        Raises:
            LostError: there is none.
        """
        where = self.state.equations.layout
        index = where.forces[which] if isinstance(which, str) else where.places[which]
        state = solve(self.state.equations, self.state.z, near, self.settings.iterations, self.state,
                      _has_value(index, value))  # fmt: skip
        return self.between(state, goal)

    def between(self, state: State, goal: float) -> State:
        """The ``state``, provided that its λ lies between here and ``goal``.

        Raises:
            LostError: λ lies outside.
        """
        low, high = sorted((self.lam, goal))
        slack = _SLACK * max(abs(low), abs(high))
        if not low - slack <= state.lam <= high + slack:
            raise LostError
        return state

    def accept(self, state: State) -> None:
        """Make ``state`` the last equilibrium.

        Raises:
            LostError: the equations are singular.
            NotCoveredError: the state is no minimum of the energy.
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
            self.record_side(touch)
        self.states += 1

    def record_side(self, touch: Touch) -> None:
        """Record the side of a beam in contact with another, or just released."""
        if isinstance(touch, Meeting):
            self.sides[touch.contact, touch.beam, touch.onto] = touch.side

    def record_closing(self, contact: str, lam: float, goal: float) -> None:
        """Record the closing of a contact at λ, on the way to ``goal``; initial contacts close at the present value."""
        value = (lam if (lam - self.lam) * (goal - self.lam) > 0.0 else self.lam) * self.unit
        self.events.append(Event(self.stage, contact, "closed", value))
        self.closed_at.setdefault(contact, value)


def touches_of(structure: Structure, without: str) -> dict[str, Touch]:
    """Contacts of a structure except one."""
    return {name: touch for name, touch in structure.touches.items() if name != without}


def places_of(state: State, without: str) -> dict[tuple[str, str], float]:
    """Places of contact of a state, without the places of one contact."""
    return {key: value for key, value in state.places.items() if key[0] != without}


def _has_value(index: int, value: float) -> Condition:
    """Condition for the value of an unknown."""
    return lambda z, evaluation: z[index] - value
