"""Records of contacts: what may touch, its penalty, and the evaluated contact in a state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from cprbm_scene.answer import Array, frozen_array
from fea_reference.edge import Edge
from fea_reference.facing import Facing, Tapers, facing
from fea_reference.hermite import Around, Index, NeutralLine
from fea_reference.itself import Roles
from fea_reference.leaning import Chain
from fea_reference.outline import Outline
from fea_reference.zones import Zones

THINNEST = 1e-3
"""Lengths of the longest beam: least thickness for the relative penetration on a rigid body. The penetration depends
on the elements rather than on the thickness, and lines have a far larger measure.
"""


SHALLOW = 0.05
"""Radii of a circle: greatest penetration under a penalty."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two beams that may touch, or a beam in self-contact.

    Attributes:
        first, second: numbers of the beams; the contact integral runs along the first.
        turned: True if the first is the scene's second.
        side: side of the second beam on which the first lies; for self-contact see ``roles``.
        side_m: side of the first beam on which the second lies.
        distance: T, distance of the neutral lines in contact where the beams are thickest.
        ends, ends_m: ends (0 and 1) of the first and second beam that may touch the other's side. Ends that a body
            holds beside the other beam are excluded.
        carried: ends of the second beam whose zones are integrated along the second, if ends of the first press, too.
        free, free_m: range of places ζ of the first and second beam with contact; near a shared end the beams overlap
            in the reference configuration.
        tapers: thickness variation; None for constant thickness.
        scale: reference length of the requested penetration: the mean thickness, or a hundredth of the longest beam
            for lines.
        measure: reference length of the reported penetration: the same, but the longest beam for lines.
        loosest, stiffness, stiffest: penalties to search for a distant zone, to start with, and to end with if the
            penetration allows. All are the softer beam's EI over the fourth power of a layer's width. The widest
            layer is a share of the beam's length, so that the search does not depend on the mesh. The thinnest is the
            length of a finer element, so that its error vanishes on refinement.
    """

    name: str
    first: int
    second: int
    turned: bool
    side: float
    side_m: float
    distance: float
    scale: float
    measure: float
    loosest: float
    stiffness: float
    stiffest: float
    ends: tuple[int, ...] = ()
    ends_m: tuple[int, ...] = ()
    carried: tuple[int, ...] = ()
    free: tuple[float, float] = (0.0, np.inf)
    free_m: tuple[float, float] = (0.0, np.inf)
    roles: Roles | None = None
    tapers: Tapers | None = None

    def sides(self, zeta: Array, zeta_m: Array, d: Array) -> Array | float:
        """Sides (k,), or of all places, at ``zeta`` (k,) and ``zeta_m`` (k,), with ``d`` (k,) = n·(x − x_m)."""
        return self.side if self.roles is None else self.roles.sides(zeta, zeta_m, d)

    def places_facing(self, first: NeutralLine, second: NeutralLine, zeta: Array, guess: Array) -> Facing:
        """Places of the second beam facing ``zeta`` (k,) of the first, with initial guesses ``guess`` (k,)."""
        there = first.around(zeta)
        points = first.nodes[there.element] + there.way
        return facing(
            second, self.edge_m, points, guess, lambda zeta_m, d: self.sides(zeta, zeta_m, d), ended=self.ended
        )

    def apart(self, zeta: Array, zeta_m: Array) -> Array:
        """Distance (k,) of the neutral lines in contact at places ``zeta`` and ``zeta_m`` (k,)."""
        thinner = np.zeros(zeta.shape) if self.tapers is None else self.tapers.thinner(zeta, zeta_m)
        return np.asarray(self.distance - thinner)

    def exchanged(self) -> Pair:
        """The pair with exchanged beams."""
        return replace(
            self,
            first=self.second,
            second=self.first,
            turned=not self.turned,
            side=self.side_m,
            side_m=self.side,
            ends=self.ends_m,
            ends_m=self.ends,
            carried=(),
            free=self.free_m,
            free_m=self.free,
            tapers=None if self.tapers is None else Tapers(self.tapers.second, self.tapers.first),
        )

    @property
    def ended(self) -> bool:
        """True if places beyond an end of the second beam face this end: self-contact of a thick beam."""
        return self.roles is not None and self.roles.ended

    @property
    def edge_m(self) -> Edge | None:
        """Thickness variation of the second beam, or None."""
        return None if self.tapers is None else self.tapers.second


@dataclass(frozen=True, slots=True)
class Circle:
    """A beam and a rigid circle that may touch.

    Attributes:
        first: number of the beam.
        body: number of the circle's body; the centre is at ``arm`` from the body's reference centre.
        radius: of the circle.
        edge: T, distance of the neutral line from the circle in contact.
        scale: reference length of the penetration: the least thickness, or the longest beam for a line.
        loosest: initial penalty, EI over the fourth power of the width of the layer in which the pressure builds up
            at a zone's end. The width is a share of the beam's length, or the radius if smaller, so that the search
            does not depend on the mesh.
        stiffest: final penalty, whatever the penetration. Its layer is a fixed share of an element, so that its error
            vanishes smoothly on refinement.
    """

    name: str
    first: int
    body: int
    arm: tuple[float, float]
    radius: float
    edge: Edge
    scale: float
    loosest: float
    stiffest: float

    @property
    def stiffness(self) -> float:
        """The initial penalty."""
        return self.loosest

    @property
    def deepest(self) -> float:
        """Greatest penetration under a penalty; a deeper circle is being passed through."""
        return SHALLOW * self.radius + 0.5 * self.edge.nearest

    @property
    def measure(self) -> float:
        """Reference length of the reported penetration."""
        return max(self.scale, THINNEST)


@dataclass(frozen=True, slots=True)
class Face:
    """A beam and a rigid edge that may touch.

    Attributes:
        first: number of the beam.
        body: number of the edge's body.
        outline: the edge, in a frame about the body's reference centre.
        own: ends ζ of the beam that joints hold on the edge.
        within: range of places ζ with pressure of the edge; with shear the joint transmits the pressure beside its
            end.
        edge: T, distance of the neutral line from the edge in contact.
        scale, measure: as for a pair.
        loosest, stiffest: as for a circle.
    """

    name: str
    first: int
    body: int
    outline: Outline
    own: tuple[float, ...]
    within: tuple[float, float]
    edge: Edge
    scale: float
    measure: float
    loosest: float
    stiffest: float

    @property
    def stiffness(self) -> float:
        """The initial penalty."""
        return self.loosest


LACKING = 1e-3
"""Share of a zone's force: largest missing force at the zone's end."""

Rigid = Circle | Face
Places = tuple[Array, Around, Array]
Contact = Pair | Rigid


@dataclass(frozen=True, slots=True)
class Penalty:
    """Penalty of a contact: the line pressure is ``stiffness`` ⟨``lead`` − g⟩.

    Attributes:
        stiffness: ε.
        lead: the gap at which the pressure begins; a known pressure acts at zero gap, as beside a clamp.
    """

    stiffness: float
    lead: float = 0.0


@dataclass(frozen=True, slots=True)
class Touch:
    """A contact in a state, evaluated at its k Gauss points.

    ``stiffness`` (k,) is the penalty times the length of a point, and ``gap`` (k,) the gap minus the lead. ``gap_by``
    (m, k) and ``gap_by_twice`` (m, m, k) are the gap's derivatives by the unknowns of the first line, then of the
    second or a moving body, evaluated at the first call. ``chain`` continues to all unknowns, at c =
    k/points_per_place places, as ``points_per_place`` consecutive points lie in the same elements.

    ``zeta`` (k,) and ``zeta_m`` (k,) are places on the first and second beam, the latter empty for a rigid body.
    ``x`` and ``x_m`` (2, k) are points of the first neutral line and of the second or the edge. ``normal`` (2, k)
    points to the first beam.

    ``missing`` is the force left out at ends of the second beam, and ``missing_share`` its largest share of a zone's
    force. ``extra_hessian`` (m, m, k) are further second derivatives of the energy at some points. ``sharp`` is True
    for a contact at a tip or end.
    """

    pair: Contact
    zones: Zones
    chain: Chain
    points_per_place: int
    stiffness: Array
    gap: Array
    gap_by: Callable[[], Array]
    gap_by_twice: Callable[[], Array]
    zeta: Array
    zeta_m: Array
    x: Array
    x_m: Array
    normal: Array
    missing: float = 0.0
    missing_share: float = 0.0
    extra_hessian: Callable[[], Array] | None = None
    sharp: bool = False

    @property
    def pushes(self) -> Array:
        """Contact forces (k,) of the points on the first beam, along the normal."""
        return -self.stiffness * self.gap

    @property
    def force(self) -> Array:
        """Contact forces (2, k) on the first beam."""
        return self.pushes * self.normal

    @property
    def dofs(self) -> Index:
        """Unknowns (M, c) of the contact's energy."""
        return self.chain.dofs

    @property
    def gradient(self) -> Array:
        """Derivative (M, c) of the contact energy by the unknowns."""
        return self.chain.gradient(self.local_gradient)

    @property
    def local_gradient(self) -> Array:
        """Derivative (m, c) of the contact energy by the unknowns of the lines and the body."""
        return self._summed(-self.pushes * self.gap_by())

    @property
    def mean(self) -> Array:
        """Derivative (M, c) of the stiffness-weighted mean gap by the unknowns."""
        return self.chain.gradient(self._summed(self.stiffness / self.stiffness.sum() * self.gap_by()))

    def hessian(self, pushes: Array) -> Array:
        """Second derivative (M, M, c) of the contact energy by the unknowns, for point forces ``pushes`` (k,)."""
        by = self.gap_by()
        local = (self.stiffness * by)[:, None] * by - pushes * self.gap_by_twice()
        if self.extra_hessian is not None:
            local += self.extra_hessian()
        return self.chain.hessian(self._summed(local), self._summed(-pushes * by))

    def predicted_forces(self, step: Array) -> Array:
        """Point forces (k,) after a ``step`` (size,) of the unknowns, to first order."""
        by = self.gap_by()
        local = np.repeat(self.chain.local(step), self.points_per_place, axis=1)
        return np.asarray(self.pushes - self.stiffness * (by * local).sum(axis=0))

    def _summed(self, at_points: Array) -> Array:
        return np.asarray(at_points.reshape(*at_points.shape[:-1], -1, self.points_per_place).sum(axis=-1))

    @property
    def penetration(self) -> float:
        """Largest penetration."""
        return max(0.0, -self.zones.least)

    @property
    def push(self) -> float:
        """Resultant of the point forces with sign, negative for a held contact in tension."""
        return float(self.pushes.sum())

    @property
    def closed(self) -> bool:
        """True if there is any zone."""
        return self.zeta.size > 0


@cache
def gauss(points: int) -> tuple[Array, Array]:
    """Gauss points in [−1, 1] and weights, (points,) both."""
    places, weights = np.polynomial.legendre.leggauss(points)
    return frozen_array(places), frozen_array(weights)


def gauss_places(zones: Zones, line: NeutralLine, quadrature: int) -> Places:
    """Gauss points ζ (k,) of all intervals, the line there, and their arc lengths (k,)."""
    points, weights = gauss(quadrature)
    half = 0.5 * (zones.intervals[:, 1:] - zones.intervals[:, :1])
    zeta = (zones.intervals[:, :1] + half * (points + 1.0)).ravel()
    there = line.around(zeta)
    return zeta, there, (half * weights).ravel() * line.lengths[there.element]


def count_points_per_place(quadrature: int, *elements: Index) -> int:
    """Number of consecutive points in the same ``elements`` (k,): those of an interval, or a single point.

    An interval lies within an element up to round-off of its ends.
    """
    same = all((e.reshape(-1, quadrature) == e[::quadrature, None]).all() for e in elements)
    return quadrature if same else 1
