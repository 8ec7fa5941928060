"""Numbering of a mechanism's unknowns, forms of the unknowns, and rows.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
z        unknowns: the chain of every beam, then bodies, then nodes carried by bodies, then multipliers
p, n, θ  of a chain: position of the first node; force, angle and position of the rear node, of every link
q, φ     displacement of a moving body's first point X₀, rotation of the body
f, μ     form and multiplier of a row
c, a_i   constant of a form, coefficient of z_i
A, B     coefficients of cos φ − 1 and sin φ
=======  ====================================================================================

    f(z) = c + Σ a_i z_i + Σ [A (cos φ − 1) + B sin φ]

A body carries the point X to X + q + (R(φ) − 1)(X − X₀).  The point's coordinate along d is a form with
A = d·(X − X₀) and B = d·J(X − X₀), J the quarter turn.

Joints, guides, drives, loads and stops are rows of the same kind.  Either the value of a row is prescribed (joint,
guide, drive, stop at a limit): f(z) = f*.  Or the force of a row is prescribed (load, stop within the limits): μ = μ*.
A row adds μ (f(z) − f*) to the Lagrangian and exerts the force −μ ∂f/∂z on the mechanism.
Positions are in units of the longest beam, from the middle of the mechanism; units of force and moment follow from
the largest EI over this length.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from cprbm.chain.beam import BeamChain, ChainUnits, Theory, beam_chain
from cprbm_scene import Scene
from cprbm_scene.answer import Array, Ints
from cprbm_scene.curve_records import shape_of

PER_LINK = 5
"""Unknowns of a link: force (2), angle, position of the node behind it (2)."""

Direction = tuple[float, float]
AXES: tuple[tuple[str, Direction], ...] = (("x", (1.0, 0.0)), ("y", (0.0, 1.0)))


@dataclass(frozen=True, slots=True)
class Form:
    """A form; ``linear`` holds (index, a), ``turning`` (index of φ, A, B)."""

    constant: float = 0.0
    linear: tuple[tuple[int, float], ...] = ()
    turning: tuple[tuple[int, float, float], ...] = ()

    def __add__(self, other: Form) -> Form:
        return Form(self.constant + other.constant, self.linear + other.linear, self.turning + other.turning)

    def __sub__(self, other: Form) -> Form:
        return self + other * -1.0

    def __mul__(self, factor: float) -> Form:
        return Form(
            self.constant * factor,
            tuple((i, a * factor) for i, a in self.linear),
            tuple((i, A * factor, B * factor) for i, A, B in self.turning),
        )

    def value(self, z: Array) -> float:
        """f(z)."""
        turned = (-2.0 * A * np.sin(0.5 * z[i]) ** 2 + B * np.sin(z[i]) for i, A, B in self.turning)
        return float(self.constant + sum(a * float(z[i]) for i, a in self.linear) + sum(turned))


def node_coordinate(index: int, direction: Direction) -> Form:
    """Coordinate along ``direction`` of the node whose x is the unknown ``index``."""
    return Form(linear=((index, direction[0]), (index + 1, direction[1])))


@dataclass(frozen=True, eq=False)
class UnitLoad:
    """A unit moment or a unit force across a straight beam, at a place.

    Attributes:
        beam, at: the beam's name and the arc length.
        power: of the distance from the place in the moment along the beam: 0 of a moment, 1 of a force.
        moments, shear: of the chain's joints (N,) and links (N + 1,) before the place.
        angle: index of the link's angle, −1 of a moment; direction: of the force.
    """

    beam: str
    at: float
    power: int
    moments: Array
    shear: Array
    angle: int = -1
    direction: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Row:
    """A row.

    Attributes:
        name: unique in the mechanism.
        form: f.
        driven: whether the value is prescribed at first.
        limit: whether the row is a stop: f ≥ 0, and the force only pushes.
        unit: f per unit (SI) of the load or drive that steps the row; of a load, μ per unit, with the sign of μ.
        unit_load: of a force or moment at a place of a beam.
    """

    name: str
    form: Form
    driven: bool = True
    limit: bool = False
    unit: float = 0.0
    unit_load: UnitLoad | None = None


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
    chains: dict[str, BeamChain]
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
        """Index of the first of new unknowns with given values at rest."""
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
        """Coordinate along ``direction`` of a place on a body, at ``place`` (2,) at rest."""
        if body not in self.bodies:
            return Form(float(np.dot(direction, place)))
        index, d, arm = self.bodies[body], np.array(direction), place - self.reference(body)
        turning = ((index + 2, float(d @ arm), float(d[1] * arm[0] - d[0] * arm[1])),)
        return Form(float(d @ place), node_coordinate(index, direction).linear, turning if np.any(arm) else ())

    def point(self, point: str, direction: Direction) -> Form:
        """Coordinate along ``direction`` of a named point."""
        return self.carried(self.scene.body_of(point), self.units.place(self.scene.place_of(point)), direction)

    def displacement(self, point: str, direction: Direction) -> Form:
        """Displacement of a named point along ``direction``."""
        form = self.point(point, direction)
        return form - Form(form.constant)

    @cached_property
    def motions(self) -> dict[str, list[Form]]:
        """Displacements along x and y of all named points."""
        return {point: [self.displacement(point, along) for _, along in AXES] for point in self.scene.owners}

    def rotation(self, body: str) -> Form:
        """Rotation of a body."""
        return Form(linear=((self.bodies[body] + 2, 1.0),) if body in self.bodies else ())

    def angle(self, beam: str, link: int) -> Form:
        """Rotation of a beam's link, counted from the end for a negative number."""
        index = int(self.beam_angles(beam)[link])
        return Form(-self.rest[index], ((index, 1.0),))

    def attach_node(self, body: str, place: Array) -> int:
        """Index of the x of a new node on a body, at ``place`` (2,) at rest."""
        node = self.allocate(place)
        for axis, direction in AXES:
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
    """Units: the longest beam, the largest EI over this length, the middle of the beams' ends."""
    length = max(shape_of(beam.curve).length for beam in scene.beams.values())
    rigidity = max(
        scene.materials[beam.material].youngs_modulus
        * float(np.max(beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3))
        / 12.0
        for beam in scene.beams.values()
    )
    ends = np.array([end for beam in scene.beams.values() for end in (beam.curve.start, beam.curve.end)])
    return ChainUnits(length, rigidity / length, ends.mean(axis=0))
