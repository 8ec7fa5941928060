"""A scene made discrete: nodes, elements, bodies, joints and loads, all without units.

Lengths are over the longest beam, bending stiffnesses over the largest, so forces are over EI/length² and
moments over EI/length: the same scene in other units is the same problem to the last digits.

The unknowns z are, in this order: the nodes' (x, y, θ) and the elements' axial forces N, numbered by
scikit-fem; (X, Y, φ) of every free body, its displacement and rotation; one multiplier per joint row.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import CellBasis, ElementLineP0, ElementLineP1, ElementVector, MeshLine

from fea_reference.curves import length, sample
from fea_reference.element import Elements, reference
from fea_reference.hermite import Index, NeutralLine
from fea_reference.settings import Settings
from fea_reference.state import State
from scene.answer import Array
from scene.statement import BeamEnd, Force, FreeEnd, Moment, Scene, WeldedEnd

SHEAR_FACTOR = 5.0 / 6.0  # of a rectangle


@dataclass(frozen=True, slots=True)
class Units:
    """The scene's own: longest beam's ``length`` (m), ``bending`` stiffness (N·m²), ``origin`` (2,) (m)."""

    length: float
    bending: float
    origin: Array

    @property
    def force(self) -> float:
        """N."""
        return self.bending / self.length**2

    @property
    def moment(self) -> float:
        """N·m."""
        return self.bending / self.length


@dataclass(frozen=True, slots=True)
class BeamPart:
    """Where a beam's nodes and elements stand among all; ``length`` and ``thickness`` without units."""

    name: str
    nodes: slice
    elements: slice
    length: float
    thickness: float
    bending: float


@dataclass(frozen=True, slots=True)
class BodyPart:
    """A rigid body: reference ``centre`` (2,), ``points`` (2,) by name, its three unknowns if it is free."""

    name: str
    centre: Array
    points: dict[str, Array]
    dofs: Index | None


@dataclass(frozen=True, slots=True)
class JointPart:
    """A beam's end held at a body's point: x − X − R(φ) r = 0 and, if welded, θ − φ − θ⁰ = 0.

    ``dofs`` are the end node's, ``rows`` the multipliers' (2 or 3), ``arm`` is r.
    """

    point: str
    body: int
    dofs: Index
    rows: Index
    arm: Array
    angle: float


@dataclass(frozen=True, slots=True)
class LoadPart:
    """A moment on a body (``direction`` is None), or a force along ``direction`` (2,) at its ``arm`` (2,)."""

    name: str
    body: int
    arm: Array
    direction: Array | None
    unit: float


@dataclass(frozen=True, slots=True)
class Model:
    """Everything the mechanics needs to know of a scene; ``start`` is the undeformed state."""

    units: Units
    beams: tuple[BeamPart, ...]
    bodies: tuple[BodyPart, ...]
    joints: tuple[JointPart, ...]
    loads: tuple[LoadPart, ...]
    elements: Elements
    node_dofs: Index
    element_dofs: Index
    multipliers: Index
    size: int
    start: State

    def beam(self, name: str) -> BeamPart:
        """The beam of that name."""
        return next(beam for beam in self.beams if beam.name == name)

    def line(self, beam: BeamPart, z: State) -> NeutralLine:
        """A beam's neutral line in state ``z``."""
        dofs = self.node_dofs[:, beam.nodes]
        return NeutralLine.through(
            z[dofs[:2]],
            z[dofs[2]],
            self.elements.length[beam.elements],
            z.rest[dofs[:2]],
            self.elements.compliance[beam.elements],
            z[self.element_dofs[6, beam.elements]],
        )

    def body_state(self, body: BodyPart, z: State) -> Array:
        """(X, Y, φ) of a body, zero for the ground."""
        return np.zeros(3) if body.dofs is None else np.asarray(z[body.dofs])

    def place(self, body: BodyPart, point: str, z: State) -> Array:
        """Where a body's point is, (2,)."""
        return self.carried(body, body.points[point] - body.centre, z)

    def carried(self, body: BodyPart, arm: Array, z: State) -> Array:
        """Where what lay at ``arm`` (2,) from a body's centre is, (2,)."""
        X, Y, phi = self.body_state(body, z)
        return np.asarray(body.centre + np.array([X, Y]) + turned(arm, phi))


def turned(r: Array, phi: float) -> Array:
    """R(φ) r for a vector (2,)."""
    cos, sin = np.cos(phi), np.sin(phi)
    return np.array([cos * r[0] - sin * r[1], sin * r[0] + cos * r[1]])


def build(scene: Scene, settings: Settings) -> Model:
    """Discretise a scene.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    counts = settings.elements_of(scene.beams)
    lengths = {name: length(beam.curve) for name, beam in scene.beams.items()}
    stiffness = {
        name: scene.materials[beam.material].youngs_modulus * beam.width * beam.thickness**3 / 12.0
        for name, beam in scene.beams.items()
    }
    first = next(iter(scene.beams.values()))
    units = Units(max(lengths.values()), max(stiffness.values()), np.array(first.curve.start))

    beams: list[BeamPart] = []
    arc, points, tangents, cells = [], [], [], []
    bending, compliance, shear_compliance = [], [], []
    node, cell, offset = 0, 0, 0.0
    for name, beam in scene.beams.items():
        n, material = counts[name], scene.materials[beam.material]
        own_length, own_bending = lengths[name] / units.length, stiffness[name] / units.bending
        fractions = np.linspace(0.0, 1.0, n + 1)
        where, angle = sample(beam.curve, fractions)
        arc.append(offset + own_length * fractions)
        points.append((where - units.origin) / units.length)
        tangents.append(angle)
        cells.append(node + np.stack([np.arange(n), np.arange(1, n + 1)]))
        # 1/EA and 1/GA follow from EI: I/A = t²/12, and G/E from Poisson's ratio.
        t = beam.thickness / units.length
        soft = t**2 / (12.0 * own_bending)
        bending.append(np.full(n, own_bending))
        compliance.append(np.full(n, 0.0 if settings.kinematics == "bending" else soft))
        shear_over_axial = 2.0 * (1.0 + material.poisson_ratio) / SHEAR_FACTOR
        shear_compliance.append(np.full(n, soft * shear_over_axial if settings.kinematics == "shear" else 0.0))
        beams.append(BeamPart(name, slice(node, node + n + 1), slice(cell, cell + n), own_length, t, own_bending))
        node, cell, offset = node + n + 1, cell + n, offset + own_length + 1.0

    # One coordinate, the arc length, for all beams one after the other; no element spans the gaps.
    mesh = MeshLine(np.concatenate(arc)[None, :], np.concatenate(cells, axis=1))
    basis = CellBasis(mesh, ElementVector(ElementLineP1(), 3) * ElementLineP0(), intorder=2)
    nodes, angles = np.concatenate(points), np.concatenate(tangents)
    elements = reference(
        mesh,
        nodes,
        angles,
        np.concatenate(bending),
        np.concatenate(compliance),
        np.concatenate(shear_compliance),
    )
    node_dofs = np.asarray(basis.nodal_dofs, dtype=np.int64)
    size = int(basis.N)

    bodies: list[BodyPart] = []
    for name, body in scene.bodies.items():
        places = {key: (np.array(at) - units.origin) / units.length for key, at in body.points.items()}
        free = body.motion == "free"
        dofs = np.arange(size, size + 3) if free else None
        bodies.append(BodyPart(name, np.mean(list(places.values()), axis=0), places, dofs))
        size += 3 if free else 0
    number = {body.name: i for i, body in enumerate(bodies)}

    first_row = size
    joints: list[JointPart] = []
    for part in beams:
        ends = scene.beams[part.name]
        for end, at in ((ends.start, part.nodes.start), (ends.end, part.nodes.stop - 1)):
            if isinstance(end, FreeEnd):
                continue
            joints.append(_joint(end, number[scene.body_of(end.point)], bodies, node_dofs[:, at], angles[at], size))
            size += joints[-1].rows.size

    loads: list[LoadPart] = []
    for name, load in scene.loads.items():
        match load:
            case Moment():
                loads.append(LoadPart(name, number[load.body], np.zeros(2), None, units.moment))
            case Force():
                i = number[scene.body_of(load.point)]
                arm = bodies[i].points[load.point] - bodies[i].centre
                direction = np.array(load.direction) / np.hypot(*load.direction)
                loads.append(LoadPart(name, i, arm, direction, units.force))

    start = np.zeros(size)
    start[node_dofs] = np.stack([nodes[:, 0], nodes[:, 1], angles])
    return Model(
        units,
        tuple(beams),
        tuple(bodies),
        tuple(joints),
        tuple(loads),
        elements,
        node_dofs,
        np.asarray(basis.element_dofs, dtype=np.int64),
        np.arange(first_row, size),
        size,
        State.of(start),
    )


def _joint(end: BeamEnd, body: int, bodies: list[BodyPart], dofs: Index, angle: float, row: int) -> JointPart:
    """The joint of an end that is not free; its rows begin at ``row``."""
    assert not isinstance(end, FreeEnd)
    rows = np.arange(row, row + (3 if isinstance(end, WeldedEnd) else 2))
    arm = bodies[body].points[end.point] - bodies[body].centre
    return JointPart(end.point, body, dofs, rows, arm, angle)
