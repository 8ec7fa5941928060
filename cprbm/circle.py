"""Contact of a beam with a rigid circle from outside: the formulation ``auto``.

==========  ===================================================================================
C           smooth neutral line of the beam, :mod:`cprbm.smooth`; ψ its tangent angle
o, R        centre and radius of the circle
ρ, n        |C − o| and (C − o)/ρ
T           t/2, half the thickness at s, zero for a line
D           ρ − R − (T − T₀), distance of the neutral line from the circle, less what the beam is thicker at s than 2 T₀
            where it is thinnest; constraint c = T₀ − D ≤ 0
z           local numbers of the beam (5), and the centre's place where it moves (2)
P           (I − n nᵀ)/ρ, derivative of n over r = C − o
==========  ===================================================================================

A row stands where D has a minimum with a place of its own (:mod:`cprbm.wells`), at every joint that is close but not
beside such a minimum, where zones end on this mesh, and where the edge has a corner that stands out.  At a minimum s
moves with it, D_s = 0:

    D_z = n·r_z,     D_zz = n·C_zz + r_zᵀ P r_z − D_zs D_sz / D_ss     (last term only where s moves)
    D_s = n·C_s − T_s,     D_sz = n·C_sz + C_sᵀ P r_z,     D_ss = n·C_ss + C_sᵀ P C_s

Forces on joints can take any share of a line pressure; between two joints of a zone no further row is
needed, since the line is bent like the circle there.

Where an end of the beam is clamped on the circle, tangent to it, the spring next to the clamp cannot move:
rows at the springs beyond fix the curve, and its own row follows from theirs.  How clamp and circle share the
force there is no question of equilibrium; the pressure of the beam, even as the curve is, decides it.  The
two joints next to such a clamp have one row together, the sum of theirs, and so the same force each.  The same is so
where drives have brought both together, as long as they are (:mod:`cprbm.brought`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from cprbm import smooth, wells
from cprbm.brought import Brought, brought
from cprbm.first_contact import Blocks, Group
from cprbm.frame import Frame
from cprbm.kinematics import Positions, State
from cprbm.kinks import missed
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.moving import moving, position_curvature, position_slopes, tangent_slopes
from cprbm.once import once
from cprbm.pairs import THINNEST, Pressed
from cprbm.standing import Attachment
from cprbm_scene import CircleContact, Scene
from cprbm_scene.answer import Array, Flags, Ints

# local numbers (x, y, θθθ, centre) to (x of joints, y of joints, θθθ)
ALONE, WITH_CENTRE = np.arange(5), np.array([0, 5, 1, 6, 2, 3, 4])
BESIDE = np.array((-1, 0, 1))  # links whose angles enter, from that of a place
CLOSE = 1e-9  # units of length: a step whose square is nothing, as what it changes the distance by at a minimum
LEAST_CURVATURE = 1e-6  # of D, 1/ℓ, below which its minimum has no place of its own
REACH = 0.1  # minima of D farther than this part of the longest beam are no constraints yet
ON_IT = 1e-9  # gap of a clamped end, and how far its normal passes from the centre, where it is clamped on the circle
BESIDE_ROW = 1e-3  # a corner of the edge closer than this many h to a row has none of its own
ARCHING = 0.2  # of what the largest force bends one element by: where a zone ends within one it arches by less
JOINT_REACH = 2.0  # joints farther than this many h²·(1/R + 1/ℓ) are none
NOWHERE = np.zeros(0)
NEAREST_STEPS = 4  # of Newton's method to a circle's nearest place, from a sample beside it


class Sight(NamedTuple):
    """Some points of the beam as they are seen from the centre, (k,) each.

    Attributes:
        rho, x, y: ρ and both components of n.
        across: τ·C_s, τ being n turned clockwise.
        course, convexity: D_s and D_ss.
        leading: by how much D_s grows as the tangent leads, ±1: whether the circle is on the beam's right.
    """

    rho: Array
    x: Array
    y: Array
    across: Array
    course: Array
    convexity: Array
    leading: Array


@dataclass(frozen=True)
class Circle:
    """A beam and a rigid circle.

    Attributes:
        name: of the contact.
        a: the beam's chain.
        body: that the circle is fixed to, −1 for the ground; ``mark`` the number of its centre among the joints,
            if that is a body that moves.
        x, y, radius: of the circle, units of length; x and y at rest, see :meth:`placed`.
        offset: T₀, zero for a line; units of length.
        unit_length: ℓ, m.
        held: whether the beam's start and end cannot move against the circle.
        clamped: whether they are clamped in touch with it and tangent to it.
        brought: of those ends that drives may bring in touch with it.
        ends: arc lengths at which zones end on this mesh, where element borders are, and where the edge has a corner
            that stands out; rows stand there too.
        own_places: whether minima of D have rows of their own.
        kinks: of the beam where the contact is in points.
    """

    name: str
    a: Chain
    body: int
    mark: int
    x: float
    y: float
    radius: float
    offset: float
    unit_length: float
    held: tuple[bool, bool] = (False, False)
    clamped: tuple[bool, bool] = (False, False)
    brought: tuple[Brought | None, Brought | None] = (None, None)
    ends: tuple[float, ...] = ()
    own_places: bool = True
    kinks: Kinks = NO_KINKS

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The beam."""
        return (self.a,)

    def placed(self, at: Positions) -> Circle:
        """The same circle where it is in a state."""
        return self if self.body < 0 else replace(self, x=float(at.x[self.mark]), y=float(at.y[self.mark]))

    def brought_to(self, state: State) -> Circle:
        """The same with those ends held that drives have brought in touch with it."""
        if self.brought == (None, None):
            return self
        held, clamped = list(self.held), list(self.clamped)
        for k, end in enumerate(self.brought):
            if end is not None:
                turn, shift = end.seen(state.bodies)
                center = turn * complex(self.x, self.y) + shift
                held[k], along = _in_touch(replace(self, x=center.real, y=center.imag))[k]
                clamped[k] = along and end.end.welded
        return replace(self, held=(held[0], held[1]), clamped=(clamped[0], clamped[1]))

    @property
    def arching(self) -> float:
        """By how much a zone arches at most, of what the largest force can bend one element by."""
        return ARCHING

    def line(self, state: State, at: Positions) -> smooth.SmoothLine:
        """The beam's smooth line in a state."""
        return smooth.smooth_line(self.a, self.unit_length, state, at)

    def distance(self, points: smooth.Points) -> Array:
        """D at some points of the beam."""
        return self._less(np.hypot(points.x - self.x, points.y - self.y), points.s)

    def _less(self, rho: Array, s: Array) -> Array:
        """D at arc lengths ``s`` (k,), from ρ."""
        return rho - self.radius - (self.half(s) - self.offset) if self.tapered else rho - self.radius

    @once
    def tapered(self) -> bool:
        """Whether the beam touches by edges that are not as far from its neutral line everywhere."""
        return self.offset > 0.0 and not self.a.section.level

    def half(self, s: Array) -> Array:
        """T at arc lengths ``s``."""
        return 0.5 * self.a.section.thickness_at(s) if self.offset > 0.0 else np.zeros_like(s)

    def no_closer(self, state: State, at: Positions) -> float:
        """What D is not less than anywhere along the beam, from its joints in a state in which the circle is here.

        On a link of length L the line is no closer to the centre than its joints by L²/(4 ρ), ρ at these, and by what
        it is off the link: less than a quarter of an element times what the chain turns by at a spring.
        """
        x, y = at.x[self.a.joints] - self.x, at.y[self.a.joints] - self.y
        rho = float(np.sqrt((x * x + y * y).min()))
        turns = np.diff(state.theta[self.a.links])
        longest = float(self.a.sizes.max())
        sag = 0.25 * longest * float(np.abs(turns).max())
        thicker = float(self.half(self.a.s).max()) - self.offset
        return rho - min(0.5 * longest, longest**2 / (4.0 * max(rho, CLOSE))) - sag - self.radius - thicker

    def widening(self, s: Array) -> Array | float:
        """T_s at arc lengths ``s``."""
        return 0.5 * self.a.section.thinning_at(s) if self.tapered else 0.0

    def seen(self, A: smooth.Points) -> Sight:
        """Points of the beam as they are seen from the centre."""
        x, y = A.x - self.x, A.y - self.y
        rho = np.hypot(x, y)
        x, y = x / rho, y / rho
        cos, sin = np.cos(A.psi), np.sin(A.psi)
        facing, leaning = y * cos - x * sin, x * cos + y * sin
        across, course = A.speed * facing, A.speed * leaning
        return Sight(
            rho=rho,
            x=x,
            y=y,
            across=across,
            course=course - self.widening(A.s) if self.tapered else course,
            convexity=across * A.bend + leaning * A.gain + across * across / rho,
            leading=np.copysign(1.0, facing),
        )

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.brought_to(state).placed(at)._groups(state, at)

    def _groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        line = self.line(state, at)
        s, free = self._places(line)
        if not s.size:
            return ()
        A = line.at(s)
        rho, x, y, across_s, _, convexity, leading = self.seen(A)
        n, z = np.array((x, y)).T, moving(A)
        D_z = self._against(position_slopes(z, n), n)
        order = ALONE if self.body < 0 else WITH_CENTRE
        values = self.offset - self._less(rho, s)
        if self.kinks.places.size:
            beyond = missed(self.a, self.kinks, A)
            values -= np.where(free, leading * beyond.integral, 0.0)
            convexity = convexity + leading * beyond.bend

        def second(some: Ints) -> Array:
            """∂²D/∂z² (j, p, p) of places with some numbers (j,)."""
            its, normals = z.only(some), n[some]
            D_sz, found = tangent_slopes(its, normals), position_curvature(its, normals)
            if self.body >= 0:
                D_sz, found = np.pad(D_sz, ((0, 0), (0, 2))), np.pad(found, ((0, 0), (0, 2), (0, 2)))
            across = np.array((-normals[:, 1], normals[:, 0])).T
            q_z = self._against(position_slopes(its, across), across)
            found += q_z[:, :, None] * q_z[:, None, :] / rho[some, None, None]
            D_sz -= (across_s[some] / rho[some])[:, None] * q_z
            going = np.where(free[some], 1.0 / np.where(free[some], convexity[some], 1.0), 0.0)
            found -= going[:, None, None] * D_sz[:, :, None] * D_sz[:, None, :]
            return found[:, order[:, None], order]

        link = A.link
        joints = (self.a.first_joint + link)[:, None]
        if self.body >= 0:
            joints = np.stack((joints[:, 0], np.full(len(s), self.mark)), axis=1)
        slopes = -D_z[:, order]
        angles = self.a.first_link + np.minimum(np.maximum(link[:, None] + BESIDE, 0), self.a.n)
        keys = np.where(free, -1, self.a.s.searchsorted(s))
        if self.ends:
            at_ends = np.isin(s, self.ends)
            keys[at_ends] = self.a.n + 2 + np.arange(np.sum(at_ends))

        def curvature(multipliers: Array) -> Blocks:
            pressing = multipliers.nonzero()[0]
            return Blocks(joints[pressing], angles[pressing], -multipliers[pressing, None, None] * second(pressing))

        every = Group(self.name, values, joints, angles, slopes, curvature, tuple(keys.tolist()), s)
        together = self._beside_clamps(keys)
        if not together:
            return (every,)
        alone = np.ones(len(s), dtype=bool)
        alone[np.concatenate(together)] = False
        groups = [_summed(every, two) for two in together]
        return (*groups, _some(every, alone.nonzero()[0])) if alone.any() else tuple(groups)

    def _against(self, slopes: Array, along: Array) -> Array:
        """Slopes (k, 5) of parts along some directions (k, 2), with those over the centre's place where that moves."""
        return slopes if self.body < 0 else np.concatenate((slopes, -along), axis=1)

    def _beside_clamps(self, keys: Ints) -> list[Ints]:
        """For every end that is clamped on the circle, which two rows stand at the springs next to it."""
        found: list[Ints] = []
        if self.a.n <= 3:
            return found
        for clamped, outer, inner in zip(self.clamped, (1, self.a.n), (2, self.a.n - 1), strict=True):
            if clamped:
                rows = ((keys == outer) | (keys == inner)).nonzero()[0]
                if rows.size == 2:
                    found.append(rows if outer < inner else rows[::-1])
        return found

    def _places(self, line: smooth.SmoothLine) -> tuple[Array, Flags]:
        """Arc lengths of the rows, and which of them move with a minimum."""
        A = line.sampled
        seen, s = self.seen(A), A.s
        D = self._less(seen.rho, s) - self.offset
        near = _beside(self.a, self.radius) > D
        near[1::2] = False
        # of an end that cannot move against the circle the gap is no unknown
        near[0] &= not self.held[0]
        near[-1] &= not self.held[1]
        found = self._minima(line, seen, D) if D.min() < REACH else NOWHERE
        for place in found:
            near &= np.abs(s - place) > wells.BESIDE * self.a.size_at(place)
        places = np.concatenate((s[near], self.ends, found))
        return places, np.arange(len(places)) >= len(places) - len(found)

    def _minima(self, line: smooth.SmoothLine, seen: Sight, D: Array) -> Array:
        """Where D has minima of their own, from what is ``seen`` of the beam's samples and D there."""
        # at an end that is lowest the minimum lies within if the way to it rises
        first = np.inf if seen.course[0] < -ON_IT and not self.held[0] else -np.inf
        last = np.inf if seen.course[-1] > ON_IT and not self.held[1] else -np.inf
        lowest = wells.lowest(np.concatenate(((first,), D, (last,))), REACH) - 1
        # the two joints beside a clamp on the circle press together, a place of its own among them would part them
        first, last = [4 if clamped else -1 for clamped in self.clamped]
        lowest = lowest[self.own_places & (lowest > first) & (lowest < 2 * (self.a.n + 1) - last)]
        if not lowest.size:
            return NOWHERE
        found = wells.wells(self.a, D, seen.convexity[::2], lowest, LEAST_CURVATURE, self.kinks.places)
        if not found.samples.size:
            return NOWHERE
        places, settled = self._refined(line, seen, D, found.samples)
        if not found.parted.all():
            settled = settled & found.held(self.distance(line.at(places)) - self.offset)
        return places[settled]

    def _refined(self, line: smooth.SmoothLine, seen: Sight, D: Array, samples: Ints) -> tuple[Array, Flags]:
        """Newton's method on D_s = 0 from the lowest ``samples`` (k,) of D: s, and where it settled nearby."""
        A = line.sampled
        start = A.s[samples]
        # an end has no parabola through it
        inner = np.minimum(np.maximum(samples, 1), len(D) - 2)
        s = start + np.where(inner == samples, wells.lowest_of_parabola(A.s, D, inner), 0.0)

        def slope(s: Array) -> tuple[Array, Array]:
            A = line.at(s)
            return self._steep(A, self.seen(A))

        within = np.minimum(np.maximum((start - self.a.h, start + self.a.h), 0.0), self.a.s[-1])
        return wells.bottom(slope, s, within, LEAST_CURVATURE * seen.rho[samples], CLOSE)

    def _steep(self, A: smooth.Points, seen: Sight) -> tuple[Array, Array]:
        """ρ D_s and its derivative over s, the beam's kinks taken in.

        D has a bend as sharp as the circle, and is straight all round: beside a circle far smaller than an element
        Newton's method on D_s would go astray.  ρ D_s is straight along a straight beam, however small the circle.
        """
        slope, convexity = seen.course, seen.convexity
        if self.kinks.places.size:
            angle, bend = missed(self.a, self.kinks, A).tangent
            slope, convexity = slope + seen.leading * angle, convexity + seen.leading * bend
        going = seen.course + self.widening(A.s) if self.tapered else seen.course
        return seen.rho * slope, going * slope + seen.rho * convexity

    def lowest_near(self, line: smooth.SmoothLine, samples: Ints) -> Array:
        """D where it is least beside each of the beam's ``samples`` (k,)."""
        A = line.sampled
        low, high = A.s[np.maximum(samples - 1, 0)], A.s[np.minimum(samples + 1, len(A.s) - 1)]
        s, least = A.s[samples], np.full(len(samples), np.inf)
        for _ in range(NEAREST_STEPS):
            B = line.at(s)
            seen = self.seen(B)
            least = np.minimum(least, self._less(seen.rho, B.s))
            course = seen.course + self.widening(B.s)
            steep, bent = seen.rho * seen.course, course * seen.course + seen.rho * seen.convexity
            s = np.clip(s - steep / np.where(bent > 0.0, bent, np.inf), low, high)
        return np.asarray(np.minimum(least, self.distance(line.at(s))))

    def frame(self, state: State, at: Positions) -> Frame:
        """Where the centre is in a state, seen from which nothing turns."""
        here = self.placed(at)
        return Frame(np.array((here.x, here.y)), 0.0)

    @property
    def standing_out(self) -> tuple[Array, Array | None]:
        """Places that no beam goes through, (k, 2): the centre, on which no beam rests."""
        return np.zeros((1, 2)), None

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """D_ss at arc lengths ``s`` if the beam touched there along the circle: the curvature with which it parts."""
        A, here = self.line(state, at).at(s), self.placed(at)
        outward = (A.y - here.y) * np.cos(A.psi) - (A.x - here.x) * np.sin(A.psi)
        # where its edge lies along the circle, the beam leans against it by the angle whose sine is T_s
        level = np.sqrt(1.0 - self.widening(s) ** 2)
        return np.asarray(np.sign(outward) * A.bend + level / (self.radius + self.half(s)))

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the thickness, if it is not very thin, for a line the longest beam; units of
        length.
        """
        return max(2.0 * self.offset, THINNEST) if self.offset > 0.0 else 1.0

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edge touches that touches at arc lengths ``s``, (k, 2), units of length."""
        A, here = self.line(state, at).at(s), self.placed(at)
        rx, ry = A.x - here.x, A.y - here.y
        share = self.radius / np.hypot(rx, ry)
        return np.stack((here.x + share * rx, here.y + share * ry), axis=1)

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On the beam what lies at ``s``."""
        return ((1.0, s, self.line(state, at).at(s).psi),)

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap anywhere along the beam, units of length; negative where it overlaps."""
        line, here = self.line(state, at), self.placed(at)
        s, _ = here._places(line)
        D = here.distance(line.sampled)
        lowest = here.lowest_near(line, wells.lowest(D, np.inf))
        return float(np.min(np.concatenate((D, here.distance(line.at(s)), lowest)))) - self.offset


def _some(group: Group, these: Ints) -> Group:
    """Some of the rows (m,) of a group."""

    def curvature(multipliers: Array) -> Blocks:
        every = np.zeros(len(group.values))
        every[these] = multipliers
        return group.curvature(every)

    keys = tuple([group.keys[i] for i in these.tolist()])
    of = group.joints[these], group.angles[these], group.slopes[these]
    return Group(group.contact, group.values[these], *of, curvature, keys, group.arc[these])


def _summed(group: Group, these: Ints) -> Group:
    """One row, the sum of some rows (m,) of a group, with the key of the last."""
    p, slopes = group.joints.shape[1], group.slopes[these]
    parts = slopes[:, :p], slopes[:, p : 2 * p], slopes[:, 2 * p :]

    def curvature(multipliers: Array) -> Blocks:
        every = np.zeros(len(group.values))
        every[these] = multipliers[0]
        return group.curvature(every)

    return Group(
        contact=group.contact,
        values=np.sum(group.values[these], keepdims=True),
        joints=group.joints[these].reshape(1, -1),
        angles=group.angles[these].reshape(1, -1),
        slopes=np.concatenate([part.ravel() for part in parts])[None],
        curvature=curvature,
        keys=(group.keys[these[-1]],),
        arc=group.arc[these].sum(keepdims=True) / len(these),
    )


def reach(chain: Chain, radius: float) -> float:
    """Gap of a beam and a circle of some radius beyond which there are no rows, units of length."""
    return max(REACH, _beside(chain, radius))


def _beside(chain: Chain, radius: float) -> float:
    """Gap beyond which joints have none."""
    return JOINT_REACH * chain.h**2 * (1.0 / radius + 1.0)


def circle_of(scene: Scene, model: Model, name: str, fit: Fit = EVEN) -> Circle:
    """One of the scene's contacts with a circle."""
    contact = scene.contacts[name]
    assert isinstance(contact, CircleContact)
    chain = model.chain(contact.beam)
    unit = model.unit_length
    offset = 0.5 * float(chain.section.thickness.min()) if contact.thick else 0.0
    x, y = contact.center[0] / unit, contact.center[1] / unit
    on = model.marks[name] if name in model.marks else Attachment(-1, (x, y), welded=False)
    start, end = (held is not None and held.frame == on.frame for held in (chain.start, chain.end))
    circle = Circle(
        name=name,
        a=chain,
        body=on.body,
        mark=model.mark_of(name),
        x=x,
        y=y,
        radius=contact.radius / unit,
        offset=offset,
        unit_length=unit,
        ends=_places_of_rows(chain, chain.s[-1] * fit.ends.get(name, np.zeros(0)), corners=contact.thick),
        kinks=fit.kinks.get(name, (NO_KINKS,))[0],
        held=(start, end),
        brought=(brought(chain.start, on, model.references), brought(chain.end, on, model.references)),
    )
    start, end = start and chain.start.welded, end and chain.end is not None and chain.end.welded
    if not (start or end):
        return circle
    (_, starts), (_, ends) = _in_touch(circle)
    return replace(circle, clamped=(start and starts, end and ends))


def _in_touch(circle: Circle) -> tuple[tuple[bool, bool], tuple[bool, bool]]:
    """Of the beam's start and of its end, whether it touches the circle at rest, and lies along it too."""
    s, line = circle.a.s[[0, -1]], circle.a.line
    here = line.at(s * circle.unit_length)
    x, y = (line.x0 + here.x) / circle.unit_length - circle.x, (line.y0 + here.y) / circle.unit_length - circle.y
    away = np.hypot(x, y)
    towards = x * here.tangent.real + y * here.tangent.imag - away * circle.widening(s)
    gap = away - circle.radius - circle.half(s)
    touches = np.abs(gap) <= ON_IT
    along = touches & (np.abs(towards) <= ON_IT)
    return (bool(touches[0]), bool(along[0])), (bool(touches[1]), bool(along[1]))


def _places_of_rows(chain: Chain, ends: Array, *, corners: bool) -> tuple[float, ...]:
    """The ``ends`` of zones, and where an edge with ``corners`` has some that stand out, unless there is a row."""
    taken = np.concatenate((ends, chain.s))
    ridges = chain.section.ridges if corners else np.zeros(0)
    apart = np.min(np.abs(ridges[:, None] - taken), axis=1) > BESIDE_ROW * chain.h
    return (*ends.tolist(), *ridges[apart].tolist())
