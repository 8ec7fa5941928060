"""A solved state for the results: unknowns with the forces of all rows, lines of beams, closed places of contacts.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F, N     force of a closed place, unit normal from the foot to the place
C_A, C_B place on the first curve of a row, foot on the second; F N acts at C_A, −F N at C_B
=======  ====================================================================================

The :class:`Samples` are the same at all stations.
"""

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from cprbm.chain import Mechanism, hidden_angles
from cprbm.contact import taken, touching_points
from cprbm.equilibrium import Solved, hidden_forces, shared_multipliers
from cprbm_scene import Scene
from cprbm_scene.answer import Array, Flags, Ints

LINE_POINTS = 2
"""Points of a shape per link."""


class Samples:
    """Places of a beam at which a state is read.

    Attributes:
        chain: of the beam.
        shape, nodes: places of the shape; of the start, the joints and the end.
        of_probe: places of a probe of stress by the number of points.
        s: arc lengths (k,), in units.
        line: weights (k, N + 2) of the nodes in the positions.
        rest: angles (k,) of the neutral line at rest.
        links, weights: links (k, 4) and weights (k, 4) of their turns in the angles of the sections.
        hidden: angles (2 rows, k) under unit loads, less the angles of the chain; zero under forces along the beam.
        area, shearing: area of the section and GA_s (k,).
        stress: stress of bending (k,) under the unit moment, E t/(2 EI).
    """

    def __init__(self, m: Mechanism, beam: str) -> None:
        self.chain = chain = m.chains[beam]
        count = LINE_POINTS * chain.links + 1
        self.shape, self.nodes = slice(count), slice(0, count, LINE_POINTS)
        line = np.interp(np.arange(count) / LINE_POINTS, np.arange(chain.links + 1), chain.arcs)
        stresses = (probe for probe in m.scene.probes if probe.of == beam and probe.quantity.endswith("stress"))
        points = sorted({probe.points for probe in stresses})
        ends = count + np.cumsum(points, dtype=np.int64)
        self.of_probe = {size: slice(end - size, end) for size, end in zip(points, ends.tolist(), strict=True)}
        self.s = s = np.concatenate([line, *(np.linspace(0.0, chain.length, size) for size in points)])
        self.line, self.rest = chain.line.weights(s), chain.rest_angle(s)
        self.links, self.weights = chain.angle_weights(s)
        self.hidden = np.zeros((2 * len(m.rows), len(s)))
        for number, row in enumerate(m.rows):
            if row.unit_load is not None and row.unit_load.beam == beam:
                self.hidden[number] = hidden_angles(chain, s, row.unit_load)
        section = chain.section
        self.area = section.area(s)
        self.shearing = self.area * section.shearing
        self.stress = 0.5 * section.young * section.thickness(s) / section.rigidity(s)


class Pressed(NamedTuple):
    """Closed places of a contact, in units, ascending along the first beam.

    Attributes:
        arcs: arc lengths on both curves of the pair (k, 2); of a beam with itself the smaller counts as the first.
        places, forces: positions and forces there (k, 2, 2).
        surface: positions (k, 2) between both neutral lines where the curves touch.
        moves: marks of point contacts (k,).
        shares: offsets of the places with the same force, beside a weld (k,).
        on_first: whether the place is on the pair's first curve (k,).
    """

    arcs: Array
    places: Array
    forces: Array
    surface: Array
    moves: Flags
    shares: Ints
    on_first: Flags


@dataclass(frozen=True, eq=False)
class View:
    """A solved state.

    Attributes:
        solved: the state.
        samples: of the mechanism's beams.
        loads: values (SI) of all loads.
        closing: values (SI) of the stepped load or drive at which contacts first closed.
    """

    solved: Solved
    samples: dict[str, Samples]
    loads: dict[str, float]
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
    def nodes(self) -> dict[str, Array]:
        """Positions (N + 2, 2) of the nodes of all beams, in units."""
        m = self.mechanism
        return {beam: np.asarray(self.z[m.beam_nodes(beam)[:, None] + [0, 1]]) for beam in m.chains}

    @cached_property
    def lines(self) -> dict[str, Array]:
        """Positions (k, 2) of the samples of all beams, in units."""
        return {beam: samples.line @ self.nodes[beam] for beam, samples in self.samples.items()}

    def angles(self, beam: str) -> Array:
        """Angles (k,) of the sections at a beam's samples, with the flexibility beside loads at places of the beam."""
        system, samples = self.solved.system, self.samples[beam]
        turns = self.z[self.mechanism.beam_angles(beam)] - samples.chain.link_angle
        hidden = hidden_forces(system, self.z, self.z[system.rows.first :]) @ samples.hidden
        return np.asarray(samples.rest + (samples.weights * turns[samples.links]).sum(axis=1) - hidden)

    @cached_property
    def multipliers(self) -> dict[str, float]:
        """μ of all rows by name."""
        rows = self.mechanism.rows
        return {row.name: mu for row, mu in zip(rows, self.z[len(self.z) - len(rows) :].tolist(), strict=True)}

    def displacement(self, point: str) -> Array:
        """Displacement (2,) of a named point, in units."""
        return np.array([form.value(self.z) for form in self.mechanism.motions[point]])

    def place(self, point: str) -> Array:
        """Position (2,) of a named point, in units."""
        return self.mechanism.units.place(self.scene.place_of(point)) + self.displacement(point)

    def end(self, beam: str, end: str) -> tuple[float, Array]:
        """Arc length and position of a beam's end, in units."""
        chain, at = self.mechanism.chains[beam], 0 if end == "start" else -1
        return float(chain.arcs[at]), self.nodes[beam][at]

    @cached_property
    def pressed(self) -> dict[str, Pressed]:
        """Closed places of all contacts."""
        geometry, contacts, z = self.solved.system.geometry, self.solved.state.contacts, self.z
        arrays, law, which = geometry.arrays, geometry.law, np.flatnonzero(contacts.closed)
        at, normals = touching_points(z, arrays, contacts.places, which)
        places = taken(contacts.places, which)
        force = places.force[:, None] * normals
        if law is not None:
            for k in np.flatnonzero(law.measures(places) & (places.force != 0.0)).tolist():
                force[k] = law.force(z, contacts.places, int(which[k]))
                normals[k] = force[k] / np.hypot(*force[k])
        half = arrays.thickness[places.piece] + places.xi * arrays.thickening[places.piece]
        surface, forces = at[:, 0] - normals * half[:, None], np.stack([force, -force], axis=1)
        pieces, params = np.stack([places.piece, places.foot], axis=1), np.stack([places.xi, places.eta], axis=1)
        arcs = arrays.arc[pieces] + params * arrays.span[pieces]
        on_first = np.asarray(places.curve == geometry.sites.columns[places.pair, 0])
        backward = np.where(places.curve == places.other, arcs[:, 0] > arcs[:, 1], ~on_first)
        for both in (arcs, at, forces):
            both[backward] = both[backward, ::-1]
        every = Pressed(arcs, at, forces, surface, places.moves, places.shares, on_first)
        names, order = list(self.scene.contacts), np.argsort(arcs[:, 0], kind="stable")
        number = np.array([names.index(pair.name) for pair in geometry.pairs])[places.pair[order]]
        return {name: Pressed(*(column[order[number == k]] for column in every)) for k, name in enumerate(names)}
