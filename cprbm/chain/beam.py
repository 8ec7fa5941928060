"""A beam as a chain of rigid links and torsional springs.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
N, h       number of elements, length of an element; a joint (torsional spring) in the middle of each
s_j        arc length of node j: start, joints, end; link j runs from node j to node j + 1
P_j        node j at rest
L_j, ψ_j   length and angle of link j at rest
b_i        turn of the neutral line along element i at rest
k_i        stiffness of joint i, the inverse of ∫ ds/EI along the element
m_i        first moment ∫ (s − s_i) ds/EI of the element's flexibility about the middle
1/EA       mean of the axial compliance along a link; E is Young's modulus, A the area
1/GA_s     mean of the shear compliance along a link; G = E/2(1 + ν), A_s = 5/6 A
β_j        h²/12 times the mean of 1/EI along a link
=========  =====================================================================================

The plain chain has P_j on the neutral line.  The corrected chain has the nodes of the spline through the neutral line
(:mod:`cprbm.chain.spline`) and the fields m, β of :mod:`cprbm.chain.kernel`.
All numbers are in the units of the mechanism.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, Self

import numpy as np

from cprbm.chain.spline import NeutralLine, interpolation, polygon_line, spline_line
from cprbm_scene import Beam, Material
from cprbm_scene.answer import Array, Ints
from cprbm_scene.curve_records import shape_of

Theory = Literal["bending", "stretch", "shear"]

SHEAR_COEFFICIENT = 5.0 / 6.0
"""Share of a rectangular section that carries shear (Reissner), for a linear stress across the thickness."""

GAUSS_NODES, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(12)
SAMPLES_PER_ELEMENT = 64
"""Samples of an axis coordinate per element, from which borders evenly spaced along that axis are interpolated."""

NEWTON_STEPS = 2
"""Corrections of interpolated borders: the first leaves less than 1e-8 of the length, the second round-off."""


@dataclass(frozen=True, eq=False)
class ChainUnits:
    """Units of a mechanism: ``length`` (m), ``moment`` (N·m), and place of the ``origin`` (2,), m."""

    length: float
    moment: float
    origin: Array

    @property
    def force(self) -> float:
        """Unit of force, N."""
        return self.moment / self.length

    def place(self, point: object) -> Array:
        """A place in units, (..., 2), of coordinates in metres."""
        return np.asarray((np.asarray(point, dtype=float) - self.origin) / self.length)


@dataclass(frozen=True, eq=False)
class Section:
    """Rectangular section of a ``beam`` of a given ``length``; ``unit`` is the unit of length, m.

    ``young`` is Young's modulus, ``shearing`` G times the share of the area that carries shear, in units of moment and
    length.
    """

    beam: Beam
    length: float
    unit: float
    young: float
    shearing: float

    def thickness(self, s: Array) -> Array:
        """Thickness at arc lengths ``s`` (k,)."""
        return np.asarray(self.beam.thickness_at(s / self.length) / self.unit)

    def area(self, s: Array) -> Array:
        """Area at arc lengths ``s`` (k,)."""
        return np.asarray(self.thickness(s) * self.beam.width_at(s / self.length) / self.unit)

    def rigidity(self, s: Array) -> Array:
        """EI at arc lengths ``s`` (k,)."""
        return np.asarray(self.young * self.area(s) * self.thickness(s) ** 2 / 12.0)


@dataclass(frozen=True, eq=False)
class BeamChain:
    """Nodes (N + 2), links (N + 1) and joints (N) of a beam, as the module's symbols say.

    Attributes:
        name: of the scene's beam.
        section: sizes and rigidity along the beam.
        borders: arc lengths of the elements' ends (N + 1,).
        arcs: s (N + 2,); nodes: P (N + 2, 2).
        link_length, link_angle: L, ψ.
        stretch, shear: 1/EA and 1/GA_s of the links; zero in the theory ``bending``.
        lean: β of the links, zero for the plain chain and the two half links.
        half_lean: the same of the two half links times their length, zero elsewhere.
        stiffness, bend, skew: k, b, m of the joints; ``skew`` is zero for the plain chain.
        growth: links' lengths that grow with a joint's turn, before and behind it (N, 2); zero for the plain chain.
        end_angles: angles of the neutral line's tangent at rest at start and end.
        line: the neutral line by the nodes.
        knots: arc lengths between which sizes are linear.
        corrected: whether the chain has the corrections of fourth order.
    """

    name: str
    section: Section
    borders: Array
    arcs: Array
    nodes: Array
    link_length: Array
    link_angle: Array
    stretch: Array
    shear: Array
    lean: Array
    half_lean: Array
    stiffness: Array
    bend: Array
    skew: Array
    growth: Array
    end_angles: tuple[float, float]
    line: NeutralLine
    knots: Array
    corrected: bool

    @property
    def links(self) -> int:
        """Number of links."""
        return len(self.link_length)

    @property
    def length(self) -> float:
        """Arc length of the beam."""
        return float(self.arcs[-1])

    def angle_weights(self, s: Array) -> tuple[Ints, Array]:
        """Links (k, 4) and weights (k, 4) of their angles in the section's angle at arc lengths ``s``.

        The cubic through the nearest four angles, at borders of elements and at the beam's ends; of a plain
        chain the line through two.
        """
        places = np.concatenate([self.arcs[:1], 0.5 * (self.arcs[2:-1] + self.arcs[1:-2]), self.arcs[-1:]])
        order = min(4 if self.corrected else 2, len(places))
        first = np.clip(np.searchsorted(places, s) - order // 2, 0, len(places) - order)
        columns = first[:, None] + np.arange(order)
        at = places[columns]
        weights = np.ones(columns.shape)
        for i in range(order):
            for j in range(order):
                if i != j:
                    weights[:, i] *= (s - at[:, j]) / (at[:, i] - at[:, j])
        return columns, weights

    def rest_angle(self, s: Array) -> Array:
        """Angle of the neutral line's tangent at rest at arc lengths ``s`` (k,), continuous along the beam."""
        tangents = shape_of(self.section.beam.curve).tangent(s / self.length)
        exact = np.arctan2(tangents[:, 1], tangents[:, 0])
        links, weights = self.angle_weights(s)
        near = (weights * self.link_angle[links]).sum(axis=1)
        return np.asarray(near + np.remainder(exact - near + np.pi, 2.0 * np.pi) - np.pi)

    def flexibility(self, borders: Array, weight: Callable[[Array], Array]) -> Array:
        """Integrals (k,) of weight(s)/EI between ``borders`` (k + 1,)."""
        return _integrals(lambda s: weight(s) / self.section.rigidity(s), borders, self.knots)

    def layer(self, end: int) -> float:
        """Length √(EI/GA_s) at the start (0) or the end (1), within which a section at a weld warps little."""
        at, section = self.arcs[[-end]], self.section
        return float(np.sqrt(section.rigidity(at) / (section.area(at) * section.shearing)).item())

    def with_upright_section(self, end: int) -> Self:
        """The chain with the angle of shear tanh²(s/ℓ) Q/GA_s at the distance s from an end, ℓ = √2 times the layer.

        A link between s and s + L lacks ℓ [tanh((s + L)/ℓ) − tanh(s/ℓ)]/L of the shear compliance (docs/contact.md).
        """
        length = np.sqrt(2.0) * self.layer(end)
        grown = length * np.tanh(np.abs(self.arcs - self.arcs[-end]) / length)
        return replace(self, shear=self.shear * (1.0 - np.abs(np.diff(grown)) / np.diff(self.arcs)))

    def leaving_angle(self, end: str) -> float:
        """Angle at rest at which the neutral line leaves an end."""
        return self.end_angles[0] if end == "start" else self.end_angles[1] + np.pi


def beam_chain(
    name: str, beam: Beam, material: Material, links: int, theory: Theory, units: ChainUnits, *, corrected: bool
) -> BeamChain:
    """A beam cut into elements: of equal length, or of the plain chain evenly along the axis named by the beam.

    Args:
        name, beam, material: of the scene.
        links: number of elements N.
        theory: which compliances the links have.
        units: of the result.
        corrected: the corrections of fourth order, or the plain chain.
    """
    curve = shape_of(beam.curve)
    length = curve.length / units.length
    axis = None if corrected or beam.paper is None else beam.paper.uniform
    borders, middles = _borders(beam, links, length, axis)
    arcs = np.concatenate([[0.0], middles, [length]])
    young = material.youngs_modulus * units.length**3 / units.moment
    shearing = 0.5 * young / (1.0 + material.poisson_ratio) * SHEAR_COEFFICIENT
    section, knots = Section(beam, length, units.length, young, shearing), beam.knots * length
    per_area = _integrals(lambda s: 1.0 / section.area(s), arcs, knots) / np.diff(arcs)
    line, nodes = spline_line(arcs) if corrected else polygon_line(arcs), units.place(curve.point(arcs / length))
    nodes = interpolation(len(nodes)).solve(nodes) if corrected else nodes
    (dx, dy), tangents = np.diff(nodes, axis=0).T, curve.tangent(borders / length)
    angles = np.unwrap(np.arctan2(tangents[:, 1], tangents[:, 0]))
    chain = BeamChain(
        name=name,
        section=section,
        borders=borders,
        arcs=arcs,
        nodes=nodes,
        link_length=np.hypot(dx, dy),
        link_angle=np.unwrap(np.arctan2(dy, dx)),
        stretch=per_area / young * (theory != "bending"),
        shear=per_area / shearing * (theory == "shear"),
        lean=np.zeros(links + 1),
        half_lean=np.zeros(links + 1),
        stiffness=1.0 / _integrals(lambda s: 1.0 / section.rigidity(s), borders, knots),
        bend=np.diff(angles),
        skew=np.zeros(links),
        growth=np.zeros((links, 2)),
        end_angles=(float(angles[0]), float(angles[-1])),
        line=line,
        knots=knots,
        corrected=corrected,
    )
    return _corrected(chain) if corrected else chain


def _corrected(chain: BeamChain) -> BeamChain:
    """The chain with the corrections of fourth order."""
    h, L = chain.borders[1] - chain.borders[0], chain.link_length
    lean, ends = h**2 / 12.0 * chain.flexibility(chain.arcs, np.ones_like) / np.diff(chain.arcs), np.zeros(len(L))
    ends[[0, -1]] = 1.0
    # half of an inner link belongs to either joint, an end link to the only joint
    grown = 0.5 * (1.0 + ends) * L
    return replace(
        chain,
        lean=lean * (1.0 - ends),
        half_lean=lean * L * ends,
        skew=chain.flexibility(chain.borders, lambda s: s) - chain.arcs[1:-1] / chain.stiffness,
        growth=np.column_stack([grown[:-1], grown[1:]]),
    )


def _borders(beam: Beam, count: int, length: float, axis: Literal["x", "y"] | None) -> tuple[Array, Array]:
    """Arc lengths of the borders (N + 1,) and of the joints (N,)."""
    even = np.linspace(0.0, 1.0, 2 * count + 1)
    if axis is not None:
        column, u = "xy".index(axis), np.linspace(0.0, 1.0, SAMPLES_PER_ELEMENT * count + 1)
        along = shape_of(beam.curve).point(u)[:, column]
        asked = along[0] + even * (along[-1] - along[0])
        even = np.interp(even, (along - along[0]) / (along[-1] - along[0]), u)
        for _ in range(NEWTON_STEPS):
            slope = shape_of(beam.curve).length * shape_of(beam.curve).tangent(even[1:-1])[:, column]
            even[1:-1] += (asked - shape_of(beam.curve).point(even)[:, column])[1:-1] / slope
    return even[::2] * length, even[1::2] * length


def _integrals(function: Callable[[Array], Array], borders: Array, knots: Array) -> Array:
    """Integrals (k,) of a function, smooth between ``knots``, over the intervals between ``borders`` (k + 1,)."""
    places = np.union1d(borders, knots[(knots > borders[0]) & (knots < borders[-1])])
    half = 0.5 * np.diff(places)
    middle = 0.5 * (places[1:] + places[:-1])
    parts = (function(middle[:, None] + half[:, None] * GAUSS_NODES) @ GAUSS_WEIGHTS) * half
    return np.asarray(np.add.reduceat(parts, np.searchsorted(places, borders[:-1])))
