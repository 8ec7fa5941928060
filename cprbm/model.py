"""A scene as chains of rigid links and torsional springs, in numbers without units.

Beams stand one behind the other: links, springs and joints of all beams share
one numbering each, so that every sum over the mechanism is one array.

==========  =====================================================================
N           elements of a beam; springs 1..N at their middles, links 0..N, and
            joints 0..N+1: the beam's start, the springs, the beam's end
h_i         arc length of element i; equal, unless a border was moved to where a contact ends, or a beam of
            the formulation ``paper`` is cut evenly along an axis, its springs at the middle along that
L_i         length of link i, between joints i and i+1
θ_i         tangent angle of link i; θ_i⁰ stress-free
k_i         stiffness of spring i: one over ∫ ds/(E·I) along its element, so E·I/h_i in an even beam
ℓ           unit of length: the longest beam, m
S           unit of energy and moment: the largest E·I/ℓ, N·m; S/ℓ that of force
==========  =====================================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm.curves import NeutralLine
from cprbm.excess import Excess, Halves, excess
from cprbm.once import once
from cprbm.outset import Outset, outset_of
from cprbm.pieces import CurvePieces, Pieces, pieces
from cprbm.polynomial import ComplexArray, Places
from cprbm.posture import Linear, points_of
from cprbm.section import Section
from cprbm.settings import Settings
from cprbm.standing import Attachment
from cprbm_scene import Scene
from cprbm_scene.answer import Array, Ints
from cprbm_scene.frozendict import frozendict

LARGE = 400  # joints


@dataclass(frozen=True, eq=False)
class Chain:
    """One beam's links, springs and joints, in units of length, and where they stand in the shared numbering.

    Attributes:
        name: the beam's name.
        line: its stress-free neutral line, metres.
        n: number of elements N.
        first_link, first_joint: of this beam in the shared numbering.
        h: mean element length.
        sizes: h_i (N,).
        borders: arc length of the elements' ends (N+1,).
        s: arc length of the joints (N+2,).
        lengths: of the links (N+1,), eq. (6).
        rest: stress-free link angles (N+1,).
        turns: stress-free turning of the neutral line along the elements, rad (N,).
        lean: (2, N+1), cos and sin of its stress-free tangent at the borders against the links there.
        pieces: of the neutral line, that the links carry; None of a straight one.
        at_borders: coordinates of the stress-free borders along and across the links that they lie on (2, N+1).
        section: thickness and E·I along the beam.
        youngs_modulus: E, Pa.
        start, end: what the ends are joined to; no end is None for a free one, a free start a body of its own.
        held: whether start and end are joined to anything in the scene.
    """

    name: str
    line: NeutralLine
    n: int
    first_link: int
    first_joint: int
    h: float
    sizes: Array
    borders: Array
    s: Array
    lengths: Array
    rest: Array
    turns: Array
    lean: Array
    pieces: Pieces | None
    at_borders: Array
    section: Section
    youngs_modulus: float
    start: Attachment
    end: Attachment | None
    held: tuple[bool, bool]

    @once
    def halves(self) -> Array:
        """Arc lengths of the joints and of the places half-way between them, (2N+3,)."""
        s = np.empty(2 * self.n + 3)
        s[::2] = self.s
        s[1::2] = 0.5 * (self.s[1:] + self.s[:-1])
        s.flags.writeable = False
        return s

    @once
    def excess(self) -> Excess | None:
        """By what the stress-free line lies off the arcs of the elements, where its curvature varies."""
        if not isinstance(self.pieces, CurvePieces):
            return None
        half = np.arange(2 * self.n)
        link, spring = (half + 1) // 2, half // 2
        return excess(
            Halves(
                pieces=self.pieces,
                unit_length=self.line.length / float(self.s[-1]),
                border=self.borders[link],
                end=self.s[spring + 1],
                link=link,
                begin=self.s[link],
                at=(self.at_borders[0] + 1j * self.at_borders[1])[link],
                lean=(self.lean[0] + 1j * self.lean[1])[link],
                rate=(self.turns / self.sizes)[spring],
            )
        )

    @once
    def in_halves(self) -> tuple[Ints, Array]:
        """Of :attr:`halves` the half of an element that each lies in, and how far from its border (2N+3,)."""
        half = self.breaks.searchsorted(self.halves, side="right")
        return half, self.halves - self.borders[(half + 1) // 2]

    @once
    def excess_at_halves(self) -> ComplexArray | None:
        """:attr:`excess` there (3, 2N+3)."""
        return None if self.excess is None else self.excess.seen(*self.in_halves)

    @once
    def at_home(self) -> Chain:
        """The same while bodies at its ends that drives lead are where they are drawn; itself, where there are none."""
        start, end = self.start.at_home, None if self.end is None else self.end.at_home
        return self if start is self.start and end is self.end else replace(self, start=start, end=end)

    @once
    def springs(self) -> Places:
        """Of the stress-free neutral line where springs stand, from its start, m."""
        return self.line.at(self.s[1:-1] * (self.line.length / float(self.s[-1])))

    @once
    def rest_turns(self) -> Array:
        """From each stress-free link to the next (N,)."""
        return np.asarray(self.rest[1:] - self.rest[:-1])

    @once
    def breaks(self) -> Array:
        """Arc lengths between the halves of the elements: springs and, within the beam, borders (2N−1,)."""
        return np.stack((self.s[1:-1], self.borders[1:]), axis=1).ravel()[:-1]

    @property
    def thickness(self) -> float:
        """The largest one; of beams that touch by their edges the same everywhere."""
        return float(self.section.thickness.max())

    @once
    def links(self) -> slice:
        """This beam's links in the shared numbering."""
        return slice(self.first_link, self.first_link + self.n + 1)

    def size_at(self, arc: Array) -> Array:
        """h of the elements at arc lengths ``arc`` (k,), units of length."""
        found: Array = self.sizes[np.minimum(np.maximum(self.borders.searchsorted(arc) - 1, 0), self.n - 1)]
        return found

    @once
    def joints(self) -> slice:
        """This beam's joints in the shared numbering."""
        return slice(self.first_joint, self.first_joint + self.n + 2)


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Where chains and what they begin at stand in the shared numbering, once for all states.

    Attributes:
        links, behind: of each chain, its links and the joints behind them.
        joints_back: of each chain, all its joints from the last to the first.
        next_joints: the joint behind each link (n_links,).
        hung: these, then ``moving``: on what lies beyond them, links and bodies feel forces (n_links + k,).
        roots: the first joint of each chain, then the marks (k,): these are points of bodies or of the ground.
        places: their x, then their y (2k,).
        moving, moved: the same of those that are on bodies.
    """

    links: tuple[slice, ...]
    behind: tuple[slice, ...]
    joints_back: tuple[slice, ...]
    next_joints: Ints
    hung: Ints
    roots: Ints
    places: Linear
    moving: Ints
    moved: Linear


@dataclass(frozen=True, eq=False)
class Model:
    """The mechanism without units.

    Attributes:
        outset: what does not hang on the mesh.
        chains: one per beam, in the scene's order.
        couplings: springs' stiffness between link i and i+1 in the shared numbering, zero between
            beams, (n_links−1,), units of S.
        rest_turns: θ⁰_{i+1} − θ⁰_i in the same places.
        lengths: of all links, units of length.
        rest: stress-free angles of all links.
    """

    outset: Outset
    chains: tuple[Chain, ...]
    couplings: Array
    rest_turns: Array
    lengths: Array
    rest: Array

    @property
    def free_bodies(self) -> tuple[str, ...]:
        """Names of the bodies that move, in the order of their (x, y, φ) in the unknowns."""
        return self.outset.free_bodies

    @property
    def references(self) -> Array:
        """Initial position of each free body's reference place (its first point), (B, 2), units of length."""
        return self.outset.references

    @once
    def unit_length(self) -> float:
        """ℓ, m."""
        return self.outset.unit_length

    @property
    def unit_moment(self) -> float:
        """S, N·m."""
        return self.outset.unit_moment

    @property
    def marks(self) -> Mapping[str, Attachment]:
        """Centres of circles and first places of edges on bodies that move, by contact; numbered behind all joints."""
        return self.outset.marks

    @once
    def n_links(self) -> int:
        """Links of all beams."""
        return len(self.lengths)

    @once
    def n_bodies(self) -> int:
        """B."""
        return len(self.free_bodies)

    @once
    def n_unknowns(self) -> int:
        """Link angles, and u, v, φ of the free bodies."""
        return self.n_links + 3 * self.n_bodies

    @once
    def n_joints(self) -> int:
        """Joints of all beams, ends included, and the marks behind them."""
        return self.first_mark + len(self.marks)

    @once
    def layout(self) -> Layout:
        """Where everything stands."""
        behind = tuple(slice(chain.joints.start + 1, chain.joints.stop) for chain in self.chains)
        firsts = [chain.first_joint for chain in self.chains]
        roots = np.array([*firsts, *range(self.first_mark, self.n_joints)], dtype=np.intp)
        held = [*(chain.start for chain in self.chains), *self.marks.values()]
        on_bodies = np.array([at.body >= 0 for at in held], dtype=bool)
        next_joints = np.concatenate([np.arange(each.start, each.stop) for each in behind])
        points = points_of([(at.body, at.point) for at in held], self.references)
        base, over = points.base.reshape(-1, 2).T, points.over.reshape(len(held), 2, -1).transpose(1, 0, 2)
        return Layout(
            links=tuple(chain.links for chain in self.chains),
            behind=behind,
            joints_back=tuple(slice(each.stop - 1, each.start - 2 if each.start > 1 else None, -1) for each in behind),
            next_joints=next_joints,
            hung=np.concatenate((next_joints, roots[on_bodies])),
            roots=roots,
            places=Linear(base.ravel(), over.reshape(2 * len(held), -1)),
            moving=roots[on_bodies],
            moved=Linear(
                base[:, on_bodies].ravel(),
                over[:, on_bodies].reshape(2 * int(on_bodies.sum()), 5 * self.n_bodies),
            ),
        )

    @once
    def hanging(self) -> Array | None:
        """Which links, starts and marks on bodies each joint hangs on: ones and noughts (n_joints, n_links + k).

        None where that is a large table.
        """
        if self.n_joints > LARGE:
            return None
        moving, found = self.layout.moving.tolist(), np.zeros((self.n_joints, len(self.layout.hung)))
        for chain in self.chains:
            found[chain.joints, chain.links] = np.tri(chain.n + 2, chain.n + 1, -1)
        ends = {chain.first_joint: chain.joints.stop for chain in self.chains}
        for column, root in enumerate(moving, start=self.n_links):
            found[root : ends.get(root, root + 1), column] = 1.0
        return found

    @once
    def stiffness(self) -> tuple[Array, Array]:
        """Diagonal (n_links,) and off-diagonal (n_links−1,) of the strain energy's Hessian."""
        diagonal = np.zeros(self.n_links)
        diagonal[1:] += self.couplings
        diagonal[:-1] += self.couplings
        off = -self.couplings
        diagonal.flags.writeable = off.flags.writeable = False
        return diagonal, off

    @once
    def nothing(self) -> tuple[Array, Array, Array]:
        """Noughts for a diagonal over θ (n_links,), what is beside it (n_links−1,) and all joints (n_joints,)."""
        found = np.zeros(self.n_links), np.zeros(self.n_links - 1), np.zeros(self.n_joints)
        for each in found:
            each.flags.writeable = False
        return found

    @once
    def stiffest(self) -> float:
        """The largest of the springs' stiffnesses."""
        return float(self.couplings.max())

    @once
    def first_mark(self) -> int:
        """Number of the first mark, which is that of all joints."""
        return self.n_links + len(self.chains)

    @once
    def unit_force(self) -> float:
        """S/ℓ, N."""
        return self.unit_moment / self.unit_length

    def mark_of(self, contact: str) -> int:
        """Number of a contact's mark among the joints; −1 where what the beam may touch does not move."""
        return self.first_mark + list(self.marks).index(contact) if contact in self.marks else -1

    def chain(self, name: str) -> Chain:
        """The chain of a beam."""
        return next(chain for chain in self.chains if chain.name == name)


@dataclass(frozen=True, slots=True, eq=False)
class Kinks:
    """Where contacts press a beam in points, and how its curvature goes there, :mod:`cprbm.kinks`.

    Attributes:
        places: arc lengths (k,), units of length ℓ.
        before, behind: slopes of the change of curvature on either side (k,), 1/ℓ².
    """

    places: Array
    before: Array
    behind: Array

    @property
    def largest(self) -> float:
        """The largest of the slopes."""
        return float(np.max(np.abs((self.before, self.behind)), initial=0.0))


NO_KINKS = Kinks(np.zeros(0), np.zeros(0), np.zeros(0))


@dataclass(frozen=True, slots=True)
class Fit:
    """A mesh that is fitted to contact.

    Attributes:
        borders: for beams whose elements are not even, where they end, (N+1,) from 0 to 1 of the length.
        ends: for contacts on them, where they begin and end within the first beam, (k,) shares of its length.
        kinks: for contacts in points, those of each of their beams.
        fixed: contacts whose places do not move with the distance's minimum.
    """

    borders: Mapping[str, Array]
    ends: Mapping[str, Array]
    kinks: Mapping[str, tuple[Kinks, ...]] = frozendict()
    fixed: frozenset[str] = frozenset()


EVEN = Fit(frozendict(), frozendict())


def build(scene: Scene, settings: Settings, fit: Fit = EVEN, known: Outset | None = None) -> Model:
    """Cut every beam into elements, eqs. (2)-(3), and leave the units behind.

    Args:
        scene: the question.
        settings: how many elements.
        fit: where the elements end.
        known: what of the scene no mesh changes, if that is worked out already.

    Raises:
        SceneError: the numbers of links do not fit the scene's beams.
    """
    settings.check(scene)
    own = outset_of(scene) if known is None else known
    unit_length = own.unit_length
    chains: list[Chain] = []
    first_link = first_joint = 0
    for name, line in own.lines.items():
        n = settings.links_of(name)
        edges = line.length * (fit.borders[name] if name in fit.borders else _borders(own.bent.get(name, ()), n))
        springs = 0.5 * (edges[1:] + edges[:-1])
        s = np.empty(n + 2)
        s[0], s[1:-1], s[-1] = 0.0, springs, line.length
        chords, directions = line.chords(s)
        tangents = line.angle(edges)
        leaning = tangents - directions
        carried = pieces(line, s, directions)
        chains.append(
            Chain(
                name=name,
                line=line,
                n=n,
                first_link=first_link,
                first_joint=first_joint,
                h=line.length / n / unit_length,
                sizes=(edges[1:] - edges[:-1]) / unit_length,
                borders=edges / unit_length,
                s=s / unit_length,
                lengths=chords / unit_length,
                rest=directions,
                turns=tangents[1:] - tangents[:-1],
                lean=np.array((np.cos(leaning), np.sin(leaning))),
                pieces=carried,
                at_borders=_at_borders(carried, edges, s[:-1], unit_length),
                section=own.sections[name],
                youngs_modulus=own.moduli[name],
                start=own.starts[name],
                end=own.ends[name],
                held=(name not in own.loose, own.ends[name] is not None),
            )
        )
        first_link += n + 1
        first_joint += n + 2
    couplings = np.zeros(first_link - 1)
    for chain in chains:
        couplings[chain.first_link : chain.first_link + chain.n] = 1.0 / chain.section.flexibility(chain.borders)
    rest = np.concatenate([chain.rest for chain in chains])
    return Model(
        outset=own,
        chains=tuple(chains),
        couplings=couplings,
        rest_turns=rest[1:] - rest[:-1],
        lengths=np.concatenate([chain.lengths for chain in chains]),
        rest=rest,
    )


def _borders(marks: tuple[float, ...], n: int) -> Array:
    """Where even elements of a beam end, (n+1,) from 0 to 1; and at ``marks``, where its curvature jumps."""
    even = np.arange(n + 1)
    if marks:
        numbers = np.array((0.0, *(round(n * mark) for mark in marks), n), dtype=float)
        if np.all(numbers[1:] - numbers[:-1] >= 1.0):
            return np.interp(even, numbers, (0.0, *marks, 1.0))
    return even / n


def _at_borders(carried: Pieces | None, borders: Array, begins: Array, unit_length: float) -> Array:
    """``at_borders`` of a chain whose links begin at arc lengths ``begins``, m as the ``borders``."""
    t = (borders - begins) / unit_length
    if carried is None:
        return np.array((t, np.zeros(t.shape)))
    piece = carried.seen(np.arange(len(t)), borders / unit_length, t, unit_length)
    return np.array((piece.at.real, piece.at.imag))


def attached(scene: Scene, model: Model, point: str) -> Attachment:
    """A body's ``point``, as something that nothing welds.

    Raises:
        KeyError: no body has a point of that name.
    """
    owner = scene.body_of(point)
    x, y = np.array(scene.place_of(point)) / model.unit_length
    body = model.free_bodies.index(owner) if owner in model.free_bodies else -1
    if body >= 0:
        x, y = (x, y) - model.references[body]
    return Attachment(body, (float(x), float(y)), welded=False)
