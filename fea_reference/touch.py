"""What may touch, and what a contact is in one state: records that the kinds of contact share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from cprbm_scene.answer import Array, frozen_array
from fea_reference.edge import Edge
from fea_reference.facing import Facing, Tapers, facing
from fea_reference.hermite import Index, NeutralLine
from fea_reference.itself import Roles
from fea_reference.leaning import Chain
from fea_reference.outline import Outline
from fea_reference.zones import Zones

THINNEST = 1e-3
"""Of the longest beam: the least thickness by which a penetration of something rigid is measured.  It goes with the
elements, not with the thickness, and what touches as a line is measured by far more.
"""


SHALLOW = 0.05
"""Of a circle's radius: an overlap that a penalty may leave."""


@dataclass(frozen=True, slots=True)
class Pair:
    """Two beams that may touch, or one and itself.

    Attributes:
        first, second: their numbers; the first carries the integral.
        turned: whether the first is the scene's second.
        side: of the second on which the first lies; of a beam and itself its ``roles`` tell.
        side_m: of the first on which the second lies.
        distance: T, of the neutral lines when they touch where the beams are thickest.
        ends, ends_m: which ends of the first and of the second (0 and 1) may come to lie on the other's side: not those
            that a body holds beside it.
        carried: ends of the second beam whose zones the second carries the integral of, as ends of the first press too.
        free, free_m: first and last place ζ of the first and of the second between which the beams may touch: beside an
            end that both share they overlap as drawn.
        tapers: how the thickness varies, of beams that touch by their edges if it does.
        scale: what the penetration asked is a share of: the mean thickness, or a hundredth of the longest beam for
            lines, which have none.
        measure: what penetration is reported by: the same, but the longest beam for lines.
        loosest, stiffness, stiffest: the penalty with which to look for a zone that is far from where it was, to
            begin with, and to end with if the penetration asks for no more: each the softer beam's EI over the
            fourth power of a layer's width.  The widest is a share of the beam's length, so that finer elements make
            the search no harder, the thinnest a finer element's length, so that what it spoils vanishes with it.
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

    def sides(self, zeta: Array, zeta_m: Array, d: Array) -> Array:
        """The side at places ``zeta`` (k,) and ``zeta_m`` (k,), where n·(x − x_m) is ``d`` (k,)."""
        return np.full(zeta.shape, self.side) if self.roles is None else self.roles.sides(zeta, zeta_m, d)

    def faced(self, first: NeutralLine, second: NeutralLine, zeta: Array, guess: Array) -> Facing:
        """What places ``zeta`` (k,) of the first beam face on the second, sought from ``guess`` (k,)."""
        there = first.around(zeta)
        points = first.nodes[there.element] + there.way
        return facing(
            second, self.edge_m, points, guess, lambda zeta_m, d: self.sides(zeta, zeta_m, d), ended=self.ended
        )

    def apart(self, zeta: Array, zeta_m: Array) -> Array:
        """How far apart the neutral lines are when they touch at places ``zeta`` and ``zeta_m`` (k,)."""
        thinner = np.zeros(zeta.shape) if self.tapers is None else self.tapers.thinner(zeta, zeta_m)
        return np.asarray(self.distance - thinner)

    def about(self) -> Pair:
        """Two beams that have changed places."""
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
        """Whether places beyond an end of the second beam see that: those of the same one, but for a line's."""
        return self.roles is not None and self.roles.ended

    @property
    def edge_m(self) -> Edge | None:
        """How the second beam's thickness varies, if it does."""
        return None if self.tapers is None else self.tapers.second


@dataclass(frozen=True, slots=True)
class Circle:
    """A beam and a rigid circle that may touch.

    Attributes:
        first: number of the beam.
        body: number of the body that the circle is fixed to, at ``arm`` from its reference centre.
        radius: of the circle.
        edge: T, distance of the neutral line from the circle where they touch.
        scale: what penetration is measured by: the least thickness, or the longest beam for a line.
        loosest: the penalty to begin with, EI over the fourth power of the width of the layer in which the
            pressure builds up at a zone's end: a share of the beam's length (or the radius, if that is less), so
            that finer elements make the search for the zone no harder.
        stiffest: the penalty to end with, whatever the penetration: its layer is a fixed share of an
            element, so that what it spoils vanishes evenly with the element.
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
        """The penalty to begin with."""
        return self.loosest

    @property
    def deepest(self) -> float:
        """What the overlap of a penalty may be; deeper is on its way through."""
        return SHALLOW * self.radius + 0.5 * self.edge.nearest

    @property
    def measure(self) -> float:
        """What penetration is reported by: the same, if it is not very thin."""
        return max(self.scale, THINNEST)


@dataclass(frozen=True, slots=True)
class Face:
    """A beam and a rigid edge that may touch.

    Attributes:
        first: number of the beam.
        body: number of the body that the edge is fixed to.
        outline: the edge, in a frame about the body's reference centre.
        own: ends ζ of the beam that joints hold on the edge.
        within: from which place ζ to which the edge presses; with shear the joint does beside such an end.
        edge: T, distance of the neutral line from the edge where they touch.
        scale, measure: as of a pair.
        loosest, stiffest: as of a circle.
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
        """The penalty to begin with."""
        return self.loosest


LACKING = 1e-3
"""Of what a zone presses with: more may not be left out at its end."""

Rigid = Circle | Face
Contact = Pair | Rigid


@dataclass(frozen=True, slots=True)
class Penalty:
    """What presses a contact apart: the line pressure is ``stiffness`` ⟨``lead`` − g⟩.

    Attributes:
        stiffness: ε.
        lead: the gap at which the pressure begins.  It lets a pressure that is known beforehand act where the
            gap is zero, as it does beside a clamp.
    """

    stiffness: float
    lead: float = 0.0


@dataclass(frozen=True, slots=True)
class Touch:
    """A contact at its k Gauss points.

    ``stiffness`` (k,) is the penalty's times the length that a point stands for, ``gap`` (k,) that to where the
    pressure begins, ``gap_by`` (m, k) and ``gap_by_twice`` (m, m, k) its derivatives by what the lines go by: that of
    the first beam, then that of the second's or the unknowns of the body of what is rigid, if it moves.  ``chain``
    leads on to all unknowns, for every ``alike`` points that lie in the same elements: at c = k/alike places.
    Places ``zeta`` (k,) on the first beam and ``zeta_m`` on the second (empty for what is rigid), points ``x`` of the
    first beam's neutral line and ``x_m`` of the second's or of the rigid edge (2, k), the ``normal`` (2, k) away
    from what it touches.
    ``missing`` is the force that ends of the second beam leave out, and what it is of its zone's own push at most, what
    it ``lacks``; ``bent`` (m, m, k) what else the energy's second derivatives have, at some of the points.  Where a
    contact is ``sharp``, something with an edge of its own presses.
    """

    pair: Contact
    zones: Zones
    chain: Chain
    alike: int
    stiffness: Array
    gap: Array
    gap_by: Array
    gap_by_twice: Array
    zeta: Array
    zeta_m: Array
    x: Array
    x_m: Array
    normal: Array
    missing: float = 0.0
    lacks: float = 0.0
    bent: Array | None = None
    sharp: bool = False

    @property
    def pushes(self) -> Array:
        """What each point pushes the first beam away with, (k,)."""
        return -self.stiffness * self.gap

    @property
    def force(self) -> Array:
        """On the first beam, (2, k)."""
        return self.pushes * self.normal

    @property
    def dofs(self) -> Index:
        """Unknowns (M, c) on which the contact's energy depends."""
        return self.chain.dofs

    @property
    def gradient(self) -> Array:
        """Of the penalty's energy by the unknowns, (M, c)."""
        return self.chain.gradient(self._summed(-self.pushes * self.gap_by))

    @property
    def mean(self) -> Array:
        """Of the points' gaps by their stiffness, by the unknowns, (M, c)."""
        return self.chain.gradient(self._summed(self.stiffness / self.stiffness.sum() * self.gap_by))

    def hessian(self, pushes: Array) -> Array:
        """Of the penalty's energy by the unknowns, (M, M, c), if the points push with ``pushes`` (k,)."""
        local = self.stiffness * self.gap_by[:, None] * self.gap_by[None, :] - pushes * self.gap_by_twice
        if self.bent is not None:
            local += self.bent
        return self.chain.hessian(self._summed(local), self._summed(-pushes * self.gap_by))

    def foreseen(self, step: Array) -> Array:
        """What the points will push with after a ``step`` (size,) of the unknowns, to first order, (k,)."""
        local = np.repeat(self.chain.local(step, len(self.gap_by)), self.alike, axis=1)
        return np.asarray(self.pushes - self.stiffness * (self.gap_by * local).sum(axis=0))

    def _summed(self, at_points: Array) -> Array:
        return np.asarray(at_points.reshape(*at_points.shape[:-1], -1, self.alike).sum(axis=-1))

    @property
    def penetration(self) -> float:
        """Largest depth of overlap."""
        return max(0.0, -self.zones.least)

    @property
    def push(self) -> float:
        """The resultant with its sign: negative while a held contact pulls."""
        return float(self.pushes.sum())

    @property
    def closed(self) -> bool:
        """Whether the beams touch anywhere."""
        return self.zeta.size > 0


@cache
def gauss(points: int) -> tuple[Array, Array]:
    """Places in [−1, 1] and weights of Gauss' rule, (points,) each."""
    places, weights = np.polynomial.legendre.leggauss(points)
    return frozen_array(places), frozen_array(weights)


def together(quadrature: int, *elements: Index) -> int:
    """How many points that follow each other are in the same ``elements`` (k,) each: those of an interval, or one.

    An interval lies within one element, but for what its ends are rounded to.
    """
    same = all((e.reshape(-1, quadrature) == e[::quadrature, None]).all() for e in elements)
    return quadrature if same else 1
