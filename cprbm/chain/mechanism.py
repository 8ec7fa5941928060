"""Numbering of a mechanism's unknowns, and its rows.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
z        unknowns: the chain of every beam, then bodies, then nodes that bodies carry, then multipliers
p, n, θ  of a chain: position of the first node; force, angle, and position behind it, of each link
q, φ     displacement of a moving body's first point, rotation of the body
f, μ     form of a row and its multiplier
=======  ====================================================================================

Joints, guides, drives, loads and stops are rows of one kind.  Either the value of a row is prescribed (joint, guide,
drive, stop at its limit): f(z) = f*.  Or its force is prescribed (load, stop within its limits): μ = μ*.
A row adds μ (f(z) − f*) to the Lagrangian, so that its force on the mechanism is −μ ∂f/∂z.
Positions are in units of the longest beam, from the middle of the mechanism; forces and moments follow from the largest
EI over that length.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from cprbm.chain.beam import BeamChain, ChainUnits, Theory, beam_chain
from cprbm.chain.form import X_AXIS, Y_AXIS, Direction, Form, carried_coordinate, node_coordinate, unknown
from cprbm_scene import Scene
from cprbm_scene.answer import Array, Ints
from cprbm_scene.geometry import arc_length

PER_LINK = 5
"""Unknowns of a link: force (2), angle, position of the node behind it (2)."""


@dataclass(frozen=True, slots=True)
class Row:
    """A row.

    Attributes:
        name: unique in the mechanism.
        form: f.
        driven: whether the value is prescribed at first.
        limit: whether the row is a stop: f ≥ 0, and the force only pushes.
        unit: f per unit (SI) of the load or drive that steps the row; of a load, μ per unit, with the sign of μ.
        softness: change of f by a unit of its own force that the chain does not show; the energy is −softness μ²/2.
        across: index of the angle and direction (2,) of a force on a beam, whose softness acts across the link alone.
    """

    name: str
    form: Form
    driven: bool = True
    limit: bool = False
    unit: float = 0.0
    softness: float = 0.0
    across: tuple[int, float, float] | None = None


@dataclass(eq=False)
class Mechanism:
    """Numbering of the unknowns, and rows; rows and carried nodes are added before the first solve.

    Attributes:
        scene, units, chains: the beams by name, in the scene's order.
        starts: index of the first unknown of every beam.
        bodies: index of the first unknown of every moving body.
        rows: in the order of their multipliers.
        rest: unknowns at rest, multipliers excluded.
    """

    scene: Scene
    units: ChainUnits
    chains: Mapping[str, BeamChain]
    starts: dict[str, int] = field(default_factory=dict)
    bodies: dict[str, int] = field(default_factory=dict)
    rows: list[Row] = field(default_factory=list)
    rest: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        for name, chain in self.chains.items():
            links = np.column_stack([np.zeros((chain.links, 2)), chain.link_angle, chain.nodes[1:]])
            self.starts[name] = self.allocate(np.concatenate([chain.nodes[0], links.ravel()]))
        for name, body in self.scene.bodies.items():
            if body.motion != "fixed":
                self.bodies[name] = self.allocate(np.zeros(3))

    def allocate(self, values: Iterable[float]) -> int:
        """Index of the first of new unknowns with these values at rest."""
        index = len(self.rest)
        self.rest.extend(float(value) for value in values)
        return index

    def beam_nodes(self, beam: str) -> Ints:
        """Indices (N + 2,) of the x of a beam's nodes."""
        return self.starts[beam] + PER_LINK * np.arange(self.chains[beam].links + 1)

    def beam_angles(self, beam: str) -> Ints:
        """Indices (N + 1,) of the angles of a beam's links."""
        return self.starts[beam] + PER_LINK - 1 + PER_LINK * np.arange(self.chains[beam].links)

    def reference(self, body: str) -> Array:
        """Place at rest of a body's first point, (2,)."""
        return self.units.place(next(iter(self.scene.bodies[body].points.values())))

    def carried(self, body: str, place: Array, direction: Direction) -> Form:
        """Coordinate along ``direction`` of what lies at ``place`` (2,) at rest and moves with a body."""
        if body not in self.bodies:
            return Form(float(np.dot(direction, place)))
        return carried_coordinate(self.bodies[body], self.reference(body), place, direction)

    def point(self, point: str, direction: Direction) -> Form:
        """Coordinate along ``direction`` of a named point."""
        return self.carried(self.scene.body_of(point), self.units.place(self.scene.place_of(point)), direction)

    def displacement(self, point: str, direction: Direction) -> Form:
        """Displacement of a named point along ``direction``."""
        form = self.point(point, direction)
        return form - Form(form.constant)

    def rotation(self, body: str) -> Form:
        """Rotation of a body."""
        return unknown(self.bodies[body] + 2) if body in self.bodies else Form()

    def angle(self, beam: str, link: int) -> Form:
        """Rotation of a beam's link, counted from the end for a negative number."""
        index = int(self.beam_angles(beam)[link])
        return unknown(index, self.rest[index])

    def attach_node(self, body: str, place: Array) -> int:
        """Index of the x of a new node that lies at ``place`` (2,) at rest and moves with a body."""
        node = self.allocate(place)
        for axis, direction in (("x", X_AXIS), ("y", Y_AXIS)):
            form = node_coordinate(node, direction) - self.carried(body, place, direction)
            self.rows.append(Row(f"{body}.node{node}.{axis}", form))
        return node

    def row(self, name: str) -> int:
        """Number of the row of this name."""
        return next(number for number, row in enumerate(self.rows) if row.name == name)


def mechanism_of(scene: Scene, links: Mapping[str, int], theory: Theory, *, corrected: bool) -> Mechanism:
    """Mechanism of a scene's beams and moving bodies, without rows.

    Args:
        scene: the problem statement.
        links: number of elements of every beam.
        theory: which compliances the links have.
        corrected: the chain of fourth order, or the plain chain of the paper.
    """
    units = _units(scene)
    chains = {
        name: beam_chain(name, beam, scene.materials[beam.material], links[name], theory, units, corrected=corrected)
        for name, beam in scene.beams.items()
    }
    return Mechanism(scene, units, chains)


def _units(scene: Scene) -> ChainUnits:
    """Units: the longest beam, the largest EI over that length, the middle of the beams' ends."""
    length = max(arc_length(beam.curve) for beam in scene.beams.values())
    rigidity = max(
        scene.materials[beam.material].youngs_modulus
        * float(np.max(beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3))
        / 12.0
        for beam in scene.beams.values()
    )
    ends = np.array([end for beam in scene.beams.values() for end in (beam.curve.start, beam.curve.end)])
    return ChainUnits(length, rigidity / length, ends.mean(axis=0))
