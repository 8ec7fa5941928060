"""A solved state for the results: unknowns with the forces of all rows, and lines of beams."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from cprbm.chain import BeamChain, Mechanism, hidden_angles
from cprbm.continuation.path import potential
from cprbm.equilibrium.newton import Solved
from cprbm.equilibrium.sharing import shared_multipliers
from cprbm.equilibrium.system import hidden_forces
from cprbm_scene import Scene
from cprbm_scene.answer import Array


@dataclass(frozen=True, eq=False)
class View:
    """A solved state.

    Attributes:
        solved: the state.
        loads: values (SI) of all loads.
        shearing: true in the theory ``shear``.
        closing: values (SI) of loads or drives at which contacts first closed.
    """

    solved: Solved
    loads: dict[str, float]
    shearing: bool
    closing: dict[str, float] = field(default_factory=dict)

    @property
    def mechanism(self) -> Mechanism:
        """Numbering and rows."""
        return self.solved.system.mechanism

    @property
    def scene(self) -> Scene:
        """The problem statement."""
        return self.mechanism.scene

    @cached_property
    def z(self) -> Array:
        """Unknowns, with the forces of repeated rows."""
        return shared_multipliers(self.solved)

    @cached_property
    def numbers(self) -> dict[str, int]:
        """Numbers of the rows by name."""
        return {row.name: number for number, row in enumerate(self.mechanism.rows)}

    def chain(self, beam: str) -> BeamChain:
        """Chain of a beam."""
        return self.mechanism.chains[beam]

    def nodes(self, beam: str) -> Array:
        """Positions (N + 2, 2) of a beam's nodes, in units."""
        index = self.mechanism.beam_nodes(beam)
        return np.column_stack([self.z[index], self.z[index + 1]])

    def line(self, beam: str, s: Array) -> Array:
        """Positions (k, 2) of the neutral line at arc lengths ``s``, in units."""
        return self.chain(beam).line.place(self.nodes(beam), s)

    def angles(self, beam: str, s: Array) -> Array:
        """Angles of the sections (k,) at arc lengths ``s``, with the flexibility beside loads at places of the beam."""
        chain = self.chain(beam)
        links, weights = chain.angle_weights(s)
        turned = (weights * (self.z[self.mechanism.beam_angles(beam)] - chain.link_angle)[links]).sum(axis=1)
        for row, mu in zip(self.mechanism.rows, self.hidden_forces, strict=True):
            if mu != 0.0 and row.unit_load is not None and row.unit_load.beam == beam:
                turned -= mu * hidden_angles(chain, s, row.unit_load)
        return np.asarray(chain.rest_angle(s) + turned)

    def multiplier(self, row: str) -> float:
        """μ of a row; zero without such a row."""
        number = self.numbers.get(row)
        return 0.0 if number is None else float(self.z[self.solved.system.rows.first + number])

    def place(self, point: str) -> Array:
        """Position (2,) of a named point, in units."""
        return np.array(
            [self.mechanism.point(point, direction).value(self.z) for direction in ((1.0, 0.0), (0.0, 1.0))]
        )

    def end(self, beam: str, end: str) -> tuple[float, Array]:
        """Arc length and position of a beam's end, in units."""
        return (0.0, self.nodes(beam)[0]) if end == "start" else (self.chain(beam).length, self.nodes(beam)[-1])

    @cached_property
    def hidden_forces(self) -> Array:
        """Multipliers (rows,) of loads at places of beams, across their links."""
        system = self.solved.system
        return hidden_forces(system, self.z, self.z[system.rows.first :])

    @cached_property
    def potential_energy(self) -> float:
        """Potential energy, J."""
        return potential(self.solved.system, self.solved.state) * self.mechanism.units.moment
