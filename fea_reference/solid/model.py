"""Discretisation of a scene as a dimensionless solid.

Lengths are relative to the longest beam's L, forces to the largest E w t³/12 over L², moments and energies to the
same over L. The mesh has displacements q (2N,), node by node. The unknowns z are, in this order: the q of all untied
nodes; ψ of every pinned face; (X, Y, φ) of every moving body; a multiplier per row.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix

from cprbm_scene.answer import Array, Ints
from cprbm_scene.clearance import is_apart
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    DistributedLoad,
    Force,
    FreeEnd,
    Moment,
    PinnedEnd,
    Scene,
)
from fea_reference.solid.areas import longest
from fea_reference.solid.beam_loads import AreaLoad, on_area
from fea_reference.solid.beam_moments import CouplePart, couple
from fea_reference.solid.bodies import BodyPart, Tie, across, displaced, is_face_alone, turned
from fea_reference.solid.elements import Elements, Strained, build_elements, plane_stress, strain_elements
from fea_reference.solid.mesh import Mesh, Rectangle, build_mesh, plain_rectangle
from fea_reference.solid.rows import Row, assembly_rows, rows_of
from fea_reference.solid.settings import Settings
from fea_reference.solid.stops import StopPart, stops_of


@dataclass(frozen=True, slots=True)
class Units:
    """Dimensional units: ``length`` (m), ``bending`` stiffness (N·m²), ``origin`` (2,) (m), ``width`` (m)."""

    length: float
    bending: float
    origin: Array
    width: float

    @property
    def force(self) -> float:
        """Unit of force, N."""
        return self.bending / self.length**2

    @property
    def moment(self) -> float:
        """Unit of moment and energy, N·m or J."""
        return self.bending / self.length


@dataclass(frozen=True, slots=True)
class LoadPart:
    """A moment on a body (``direction`` is None), or a force along ``direction`` (2,) at its ``arm`` (2,)."""

    name: str
    body: int
    arm: Array
    direction: Array | None
    unit: float


@dataclass(frozen=True, slots=True)
class DrivePart:
    """Stepped parameter of a drive's row, in ``unit`` (m or rad)."""

    name: str
    unit: float


@dataclass(frozen=True, slots=True)
class SharePart:
    """The share of the assembly's unit ``moments`` (k,) on the rotations ``dofs`` (k,)."""

    dofs: Ints
    moments: Array
    name: str = "share of the assembly's moments"
    unit: float = 1.0


WAY = DrivePart("share of the way of ends to their points", 1.0)
"""Stepped parameter of the rows of assembled ends."""


@dataclass(frozen=True, slots=True)
class Model:
    """Discretised scene.

    ``free`` are the numbers (f,) of the unknown q, in order; ``lengths`` the beams' arc lengths.
    """

    units: Units
    mesh: Mesh
    elements: Elements
    lengths: tuple[float, ...]
    bodies: tuple[BodyPart, ...]
    ties: tuple[Tie, ...]
    rows: tuple[Row, ...]
    loads: tuple[LoadPart | AreaLoad | CouplePart | SharePart, ...]
    drives: tuple[DrivePart, ...]
    stops: tuple[StopPart, ...]
    free: Ints
    size: int

    @property
    def apart(self) -> tuple[Row, ...]:
        """The rows of ends drawn apart from their points, the last rows."""
        return tuple(row for row in self.rows if row.point)

    @property
    def stepped(self) -> tuple[LoadPart | AreaLoad | CouplePart | SharePart | DrivePart, ...]:
        """The stepped parameters in the order of the values: loads, then drives."""
        return (*self.loads, *self.drives)

    def displacements(self, z: Array) -> Array:
        """q (2N,) of all nodes."""
        q = np.empty(2 * len(self.mesh.places))
        q[self.free] = z[: self.free.size]
        u = q.reshape(-1, 2)
        for tie in self.ties:
            body = self.bodies[tie.body]
            if tie.psi is None:
                u[tie.nodes] = body.motion(tie.pin + tie.offsets, z)
            else:
                u[tie.nodes] = body.motion(tie.pin, z) + displaced(tie.offsets, z[tie.psi])
        return q

    def chain(self, z: Array) -> csr_matrix:
        """∂q/∂z (2N, size), the chain rule from nodes to unknowns."""
        rows, columns, values = [self.free], [np.arange(self.free.size)], [np.ones(self.free.size)]

        def enter(nodes: Ints, dof: int, slope: Array) -> None:
            rows.append(np.concatenate([2 * nodes, 2 * nodes + 1]))
            columns.append(np.full(2 * nodes.size, dof))
            values.append(
                np.broadcast_to(slope.T, (2, nodes.size)).ravel() if slope.ndim == 2 else np.repeat(slope, nodes.size)
            )

        for tie in self.ties:
            dofs = self.bodies[tie.body].dofs
            arms = tie.pin + (tie.offsets if tie.psi is None else np.zeros_like(tie.offsets))
            if dofs is not None:
                enter(tie.nodes, int(dofs[0]), np.array([1.0, 0.0]))
                enter(tie.nodes, int(dofs[1]), np.array([0.0, 1.0]))
                enter(tie.nodes, int(dofs[2]), across(turned(arms, z[dofs[2]])))
            if tie.psi is not None:
                enter(tie.nodes, tie.psi, across(turned(tie.offsets, z[tie.psi])))
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        return csr_matrix(entries, (2 * len(self.mesh.places), self.size))

    def turning(self, forces: Array, z: Array) -> list[tuple[int, float]]:
        """Unknowns and Σ f·∂²q for ``forces`` (2N,): the diagonal terms of rotating ties in the tangent."""
        terms = []
        f = forces.reshape(-1, 2)
        for tie in self.ties:
            dofs = self.bodies[tie.body].dofs
            arms = tie.pin + (tie.offsets if tie.psi is None else np.zeros_like(tie.offsets))
            if dofs is not None:
                terms.append((int(dofs[2]), -float((f[tie.nodes] * turned(arms, z[dofs[2]])).sum())))
            if tie.psi is not None:
                terms.append((tie.psi, -float((f[tie.nodes] * turned(tie.offsets, z[tie.psi])).sum())))
        return terms

    def strain_elements(self, q: Array) -> Strained:
        """The elements under displacements (2N,)."""
        return strain_elements(self.elements, q)


def build(scene: Scene, settings: Settings, rectangle: Rectangle = plain_rectangle) -> Model:
    """Discretise a scene.

    Raises:
        SceneError: the settings do not fit the scene.
    """
    counts = settings.elements_of(scene.beams)
    length = longest(scene)
    mesh = build_mesh(scene, counts, settings.across, length, rectangle)
    beams = list(scene.beams.values())
    widest = max(float(beam.width_at(beam.knots).max()) for beam in beams)
    stiffest = max(
        scene.materials[beam.material].youngs_modulus
        * float((beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3).max())
        / 12.0
        for beam in beams
    )
    units = Units(length, stiffest, mesh.origin, widest)
    materials = [scene.materials[beam.material] for beam in beams]
    elasticity = np.stack([plane_stress(material.youngs_modulus, material.poisson_ratio) for material in materials])
    # E w per length of the mesh, whose weights contain w over the largest
    elements = build_elements(mesh, elasticity * widest * units.length / units.force)

    number = {name: i for i, name in enumerate(scene.bodies)}
    tied = np.zeros(len(mesh.places), dtype=bool)
    joints = []
    for i, beam in enumerate(beams):
        for which, end, u in (("start", beam.start, 0.0), ("end", beam.end, 1.0)):
            if not isinstance(end, FreeEnd):
                nodes = mesh.face(i, u)
                tied[nodes] = True
                joints.append((i, which, end, nodes))
    free = np.flatnonzero(~np.repeat(tied, 2))
    size = free.size
    psis: list[int | None] = []
    for i, which, end, _ in joints:
        turns = isinstance(end, PinnedEnd) and not (which == "end" and is_apart(scene, beams[i]))
        psis.append(size if turns else None)
        size += turns
    bodies = []
    for name, body in scene.bodies.items():
        points = {key: (np.array(at) - units.origin) / length for key, at in body.points.items()}
        moves = body.motion != "fixed"
        bodies.append(
            BodyPart(name, np.mean(list(points.values()), axis=0), points, np.arange(size, size + 3) if moves else None)
        )
        size += 3 * moves
    ties = []
    for (i, which, end, nodes), psi in zip(joints, psis, strict=True):
        b = number[scene.body_of(end.point)]
        middle = 0.5 * (mesh.places[nodes[0]] + mesh.places[nodes[-1]])
        if which == "end" and is_apart(scene, beams[i]):  # the end face is a separate body until the assembly
            b = len(bodies)
            bodies.append(BodyPart(f"end of {mesh.names[i]}", middle, {}, np.arange(size, size + 3)))
            size += 3
        ties.append(Tie(i, which, end.point, b, nodes, middle - bodies[b].centre, mesh.places[nodes] - middle, psi))
    rows = rows_of(scene, tuple(bodies), size)
    rows += assembly_rows(scene, ties, tuple(bodies), number, size + len(rows), WAY.name)
    return Model(
        units,
        mesh,
        elements,
        tuple(shape_of(beam.curve).length / length for beam in beams),
        tuple(bodies),
        tuple(ties),
        rows,
        (*_loads(scene, mesh, bodies, number, units), *_shares(scene, mesh, ties, bodies, units)),
        (
            *(
                DrivePart(name, units.length if isinstance(drive, DisplacementDrive) else 1.0)
                for name, drive in scene.drives.items()
            ),
            *([WAY] if any(row.point for row in rows) else []),
        ),
        stops_of(scene, bodies, ties),
        free,
        size + len(rows),
    )


def _loads(
    scene: Scene, mesh: Mesh, bodies: Sequence[BodyPart], number: dict[str, int], units: Units
) -> list[LoadPart | AreaLoad | CouplePart]:
    loads: list[LoadPart | AreaLoad | CouplePart] = []
    for name, load in scene.loads.items():
        match load:
            case Moment():
                loads.append(LoadPart(name, number[load.body], np.zeros(2), None, units.moment))
            case Force():
                b = number[scene.body_of(load.point)]
                direction = np.array(load.direction) / np.hypot(*load.direction)
                loads.append(LoadPart(name, b, bodies[b].arm(load.point), direction, units.force))
            case BeamForce() | DistributedLoad():
                loads.append(on_area(name, load, scene, mesh, units.force, units.length))
            case BeamMoment():
                from_end = isinstance(scene.beams[load.beam].start, FreeEnd)
                loads.append(couple(name, load, mesh, units.moment, from_end=from_end))
    return loads


def _shares(scene: Scene, mesh: Mesh, ties: Sequence[Tie], bodies: Sequence[BodyPart], units: Units) -> list[SharePart]:
    """The share of the assembly's moments, if there is an assembly."""
    if scene.assembly is None:
        return []
    on = [tie for tie in ties if is_face_alone(tie, scene) and mesh.names[tie.beam] in scene.assembly.moments]
    dofs = [int(dofs[2]) for tie in on if (dofs := bodies[tie.body].dofs) is not None]
    moments = [scene.assembly.moments[mesh.names[tie.beam]] / units.moment for tie in on]
    return [SharePart(np.array(dofs, dtype=np.intp), np.array(moments))]
