"""A mechanism as arrays, numbered once, and the solver's states.

A state has unknowns z, rows with a prescribed value, and targets of the rows: the value f*, or the
multiplier μ* of a row with prescribed force.  Repeated rows are left out
(:mod:`cprbm.equilibrium.solving`).
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm.chain import PER_LINK, Joints, Links, Mechanism, RowArrays, hidden_flexibility, link_arrays, row_arrays
from cprbm.contact import Contacts, Geometry, open_contacts
from cprbm.equilibrium.elimination import Beams, Border
from cprbm.equilibrium.linear import Numbers
from cprbm_scene.answer import Array, Flags, Ints


@dataclass(frozen=True, eq=False)
class System:
    """Arrays of a mechanism, constant during a solve.

    Attributes:
        mechanism: the numbering and the rows.
        links, joints, rows, beams, border: arrays of the kernels.
        angles, nodes: indices of all links' angles, and of the x and y of all nodes.
        carried: indices of the x of the nodes carried by bodies.
        turns, motions: indices of all angles, and of all angles and displacements, bodies included.
        metric: lengths of the links, the weights of their angles in a mode.
        limits: which rows are stops.
        hidden: flexibility (2 rows, 2 rows) of loads at places of beams without the chain's share, as of
            :func:`hidden_forces`.
        lengthening: whether links have an axial compliance.
        geometry: curves and pairs of the contacts.
    """

    mechanism: Mechanism
    links: Links
    joints: Joints
    rows: RowArrays
    beams: Beams
    border: Border
    angles: Ints
    nodes: Ints
    carried: Ints
    turns: Ints
    motions: Ints
    metric: Array
    limits: Flags
    hidden: Array
    lengthening: bool
    geometry: Geometry

    @property
    def size(self) -> int:
        """Number of unknowns, multipliers included."""
        return self.rows.first + len(self.rows.constant)

    @cached_property
    def numbers(self) -> Numbers:
        """The arrays for the kernels."""
        of_chains = self.links, self.joints, self.rows, self.beams, self.border
        return Numbers(*of_chains, self.angles, self.turns, self.motions)

    @cached_property
    def equations(self) -> Flags:
        """Which entries of a gradient are link equations and rows."""
        found = np.zeros(self.size, dtype=bool)
        found[self.links.first[:, None] + [2, 3]] = True
        found[self.rows.first :] = True
        return found

    @cached_property
    def arms(self) -> tuple[Ints, Array]:
        """Points on which forces act: index of the displacement along x (points,), place as drawn (points, 2)."""
        m, nodes = self.mechanism, np.concatenate([self.nodes[:, 0], self.carried])
        index = np.concatenate([nodes, list(m.bodies.values())]).astype(np.int64)
        drawn = np.reshape([m.reference(name) for name in m.bodies], (-1, 2))
        return index, np.concatenate([np.zeros((len(nodes), 2)), drawn])


@dataclass(frozen=True, eq=False)
class State:
    """Unknowns z, rows with a prescribed value, targets of all rows, repeated rows, and contacts."""

    z: Array
    driven: Flags
    target: Array
    repeated: Flags
    contacts: Contacts

    def multipliers(self, system: System) -> Array:
        """μ of all rows."""
        return self.z[system.rows.first :]


def system_of(mechanism: Mechanism, geometry: Geometry) -> System:
    """Number a mechanism with all rows, those of the contacts included."""
    links, joints = link_arrays(mechanism)
    rows = row_arrays(mechanism)
    beams = _beams(mechanism)
    nodes = np.concatenate([mechanism.beam_nodes(name) for name in mechanism.chains])
    angles = links.first + PER_LINK - 1
    rotations = [index + 2 for index in mechanism.bodies.values()]
    first = int(beams.first[-1] + 2 + PER_LINK * beams.links[-1])
    border = Border(first, rows.first - first + len(rows.constant) + beams.springs.size, rows.first - first)
    return System(
        mechanism=mechanism,
        links=links,
        joints=joints,
        rows=rows,
        beams=beams,
        border=border,
        angles=angles,
        nodes=np.stack([nodes, nodes + 1], axis=1),
        carried=np.arange(border.first + 3 * len(mechanism.bodies), rows.first, 2, dtype=np.int64),
        turns=np.concatenate([angles, rotations]).astype(np.int64),
        motions=np.concatenate([nodes, nodes + 1, angles, np.arange(border.first, rows.first)]).astype(np.int64),
        metric=links.length,
        limits=np.array([row.limit for row in mechanism.rows], dtype=bool),
        hidden=hidden_flexibility(mechanism),
        lengthening=bool(np.any(links.stretch)),
        geometry=geometry,
    )


def hidden_forces(system: System, z: Array, mu: Array) -> Array:
    """Multipliers (2 rows,) of loads at places of beams at a state: across the links, and of forces along the links."""
    parts = np.array(
        [
            0.0 if load is None else 1j if load.angle < 0 else complex(*load.direction) * np.exp(-1j * z[load.angle])
            for load in (row.unit_load for row in system.mechanism.rows)
        ]
    )
    return np.concatenate([parts.imag * mu, parts.real * mu])


def rest_state(system: System) -> State:
    """The state as drawn: ends drawn apart from their points violate rows."""
    rows = system.mechanism.rows
    z = np.concatenate([system.mechanism.rest, np.zeros(len(rows))])
    driven = np.array([row.driven for row in rows], dtype=bool)
    return State(z, driven, np.zeros(len(rows)), np.zeros(len(rows), dtype=bool), open_contacts(system.geometry, z))


def _beams(m: Mechanism) -> Beams:
    """Chains with springs of the size of their own bending stiffness."""
    counts = np.array([chain.links for chain in m.chains.values()], dtype=np.int64)
    turning = np.array([np.median(chain.stiffness) for chain in m.chains.values()])
    pulling = turning / counts / np.array([chain.length for chain in m.chains.values()]) ** 2
    first = np.array(list(m.starts.values()), dtype=np.int64)
    return Beams(first, counts, np.cumsum(counts) - counts, np.column_stack([pulling, pulling, turning]))
