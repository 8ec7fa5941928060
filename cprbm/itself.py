"""Contact of a beam with itself, where its parts are closest: the formulation ``auto``.

==========  ==================================================================================
s, σ        arc lengths of two places that face each other, s < σ
Θ, a        turning from the one to the other, and on which side of σ the place s lies, :mod:`cprbm.strands`
D           a·n(σ)·(C(s) − C(σ)); the gap is D − t, of a line D; where t varies it is as of two beams
==========  ==================================================================================

A beam that has turned far enough lies beside itself in strands, and two strands are two beams (:mod:`cprbm.nearest`)
whose lines are one: the same rows and derivatives, A at s and B at σ.  Each row's local numbers are those of two joints
and of the links round them, all on one chain, where what both say of one unknown adds up.  Forces at the two places are
opposite, so that what goes before s carries nothing of them, to the last digit.

Rows stand at the minima of D along the nearer place s, at the joints there where strands lie on each other, and where
an end of the beam faces a part of it.  Arc lengths of the contact are those of s.

Ends that meet head-on face no side of each other: each is before the other's end.  Round ends that touch are as far
apart as the beam is thick, and have a row for that,

    d = |r|,  r = C(L) − C(0),  e = r/d;    c = t − d,    ∂d/∂C(L) = e = −∂d/∂C(0),    ∂²d/∂C(L)² = (1 − e eᵀ)/d

until the one comes beside the other: there d is D.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from cprbm.closest import REACH, SAME, STRAIGHT, held_together, minima, places_along
from cprbm.crossing import own_crossings
from cprbm.feet import Lines, feet_near, feet_of_ridges
from cprbm.first_contact import Blocks, Group
from cprbm.gathering import gathered
from cprbm.kinematics import Positions, State
from cprbm.model import EVEN, NO_KINKS, Chain, Fit, Kinks, Model
from cprbm.nearest import ARCHING, Pair
from cprbm.pairs import Pressed
from cprbm.strands import NO_FACES, QUARTER, Faces, Strand, facing_samples, in_coil, sides, strands, turned_enough
from cprbm_scene import Scene, SelfContact
from cprbm_scene.answer import Array, Flags

LEVEL = 1.0 / 16.0  # h² times curvatures, 1/ℓ added: lines that lie on each other cross no more deeply; it is twice
# as much as chords of two arcs cross by, each over half an element

MEETING, MET = 2.0, 1e-6  # thicknesses: ends that have met and are closer are known to go past each other on the side
# where they are; those that are apart by less than the second have met
DEEPER = 2.0  # times the depth by which the line crosses itself, which is about that by which parts lie beyond others


@dataclass(frozen=True, slots=True)
class Tip:
    """The beam's end where it faces a part of the beam: from the left of that (``side`` +1) or the right, D, and s.

    ``turns`` is Θ/π to the nearest whole number, ``fresh`` the distance if it is not known from which side, else
    infinite.
    """

    side: float
    turns: int
    D: float
    s: float
    fresh: float

    @property
    def across(self) -> float:
        """a: about an even number of half turns both run the same way."""
        return -self.side if self.turns % 2 == 0 else self.side


@dataclass(frozen=True, slots=True)
class HeadOn:
    """The beam's ends before each other: d, e (2,), the ``thickness`` of both together, and a of the start."""

    distance: float
    along: Array
    thickness: float
    side: float


@dataclass(frozen=True, slots=True)
class Facing:
    """What faces what in a state.

    Attributes:
        lines: the beam's line, as A's and as B's.
        strands: parts that face others further along.
        tip: where the end does, if anywhere.
        faces: what is known of their sides from here on.
        fresh: the least distance of a coil's parts whose side is not known from before; infinite where there are none.
    """

    lines: Lines
    strands: tuple[Strand, ...]
    tip: Tip | None
    faces: Faces = NO_FACES
    fresh: float = np.inf


@dataclass(frozen=True, slots=True)
class Itself:
    """A beam that may touch itself.

    Attributes:
        name: of the contact.
        a: the beam's chain.
        offset: t where the beam is thinnest, zero for a line; units of length.
        unit_length: ℓ, m.
        tapered: whether the beam touches itself by edges that lean against its line.
        own_places: whether minima of D have rows of their own.
        kinks: of the places s and σ where the contact is in points.
        known: from which sides parts faced each other in a state before.
    """

    name: str
    a: Chain
    offset: float
    unit_length: float
    tapered: bool = False
    own_places: bool = True
    kinks: tuple[Kinks, ...] = (NO_KINKS, NO_KINKS)
    known: Faces = NO_FACES

    @property
    def chains(self) -> tuple[Chain, ...]:
        """The beam, at s and at σ."""
        return self.a, self.a

    def brought_to(self, state: State) -> Itself:
        """The same."""
        return self

    @property
    def clamped(self) -> tuple[bool, bool]:
        """No end is clamped in touch with the beam: at rest it does not touch itself."""
        return False, False

    @property
    def thickness(self) -> float:
        """What an overlap is measured by: the thickness, for a line the longest beam; units of length."""
        return self.offset if self.offset > 0.0 else 1.0

    @property
    def arching(self) -> float:
        """By how much a zone arches at most, of what the largest force can bend one element by."""
        return ARCHING

    def _pair(self, strand: Strand) -> Pair:
        """Two strands as two beams."""
        return self._sided(strand.side, strand.across)

    def _sided(self, side: float, across: float) -> Pair:
        return Pair(
            name=self.name,
            a=self.a,
            b=self.a,
            side=side,
            across=across,
            offset=self.offset,
            unit_length=self.unit_length,
            tapered=self.tapered,
            own_places=self.own_places,
            kinks=self.kinks,
        )

    def facing(self, state: State, at: Positions) -> Facing:
        """What faces what in a state."""
        plain = replace(self._sided(1.0, 1.0), tapered=False)
        lines = plain.lines(state, at)
        G = lines[0].sampled
        if np.ptp(G.psi) <= QUARTER:
            return Facing(lines, (), None)
        depth = self._crosses(lines)
        tip = self._tip(plain, lines, depth)
        here, there = facing_samples(G.x, G.y)
        if here.size:
            A = plain.on_a(lines, G.s[here])
            distance, sigma, foot = feet_near(plain, lines, A, G.s[there])
            turn = plain.on_b(lines, sigma).psi - A.psi
            real = foot & turned_enough(turn) & (sigma > A.s)
            here, distance, sigma, turn = here[real], distance[real], sigma[real], turn[real]
        else:
            distance, sigma, turn = np.zeros((3, 0))
        s, side, coiled = G.s[here], sides(turn), in_coil(turn)
        side[coiled] = self.known.of(s[coiled], sigma[coiled], np.sign(distance[coiled]), crossed=depth > 0.0)
        seen = ~self._hidden(side * distance, depth)
        here, distance, sigma, turn = here[seen], distance[seen], sigma[seen], turn[seen]
        s, side, coiled = s[seen], side[seen], coiled[seen]
        new = coiled & ~self.known.know(s, sigma)[0]
        faces, fresh = Faces(s, sigma, side), float(np.min(np.abs(distance[new]), initial=np.inf))
        if self.tapered:
            distance, sigma = self._by_edges(lines, s, sigma, side)
        if tip is not None:
            faces, fresh = faces.joined(tip.s, float(G.s[-1]), -tip.side), min(fresh, tip.fresh)
        end = self._head_on(lines)
        if end is not None and end.distance < MEETING * end.thickness and self.known.know(*self._ends)[0][0]:
            faces = faces.joined(0.0, float(G.s[-1]), end.side)
        return Facing(lines, strands(G.s, here, sigma, distance, turn, side), tip, faces, fresh)

    @property
    def _ends(self) -> tuple[Array, Array]:
        """Arc lengths of the beam's ends, as of one place and what faces it."""
        return self.a.s[:1], self.a.s[-1:]

    def met(self, facing: Facing) -> Faces:
        """What is known of a state's faces from there on, that ends which have met head-on did so among it.

        From a state in which they touch they go past each other on the side where they are; from one where they are
        apart they may have gone through each other.
        """
        end = self._head_on(facing.lines)
        if end is None or end.distance > (1.0 + MET) * end.thickness or facing.faces.know(*self._ends)[0][0]:
            return facing.faces
        return facing.faces.joined(0.0, float(self.a.s[-1]), end.side)

    def _by_edges(self, lines: Lines, s: Array, sigma: Array, side: Array) -> tuple[Array, Array]:
        """aD and σ (k,) from those of the neutral lines."""
        signed, feet = np.zeros(len(s)), sigma.copy()
        for of in (-1.0, 1.0):
            mine, pair = np.flatnonzero(side == of), self._sided(of, of)
            if mine.size:
                D, feet[mine], _ = feet_near(pair, lines, pair.on_a(lines, s[mine]), sigma[mine])
                signed[mine] = of * D
        return signed, feet

    def _tip(self, plain: Pair, lines: Lines, depth: float) -> Tip | None:
        """The beam's end, if it faces a part of the beam: of several the nearest; ``depth`` is that of a crossing."""
        G, last = lines[0].sampled, len(lines[0].sampled.s) - 1
        d = np.hypot(G.x - G.x[last], G.y - G.y[last])
        low = np.flatnonzero((d[:-1] <= np.append(np.inf, d[:-2])) & (d[:-1] < d[1:]))
        low = low[turned_enough(G.psi[last] - G.psi[low])]
        if not low.size:
            return None
        turned = plain.exchanged()
        E = turned.on_a(lines, np.full(low.size, G.s[last]))
        distance, s, foot = feet_near(turned, lines, E, G.s[low])
        turn = E.psi - turned.on_b(lines, s).psi
        h = self.a.h
        real = foot & turned_enough(turn) & (s > SAME * h) & (s < self.a.s[-1] - SAME * h)
        side, coiled = sides(turn), in_coil(turn)
        # beside the end of a coil both run the same way: what is on the left of the one has it on the right
        seen = -self.known.of(s, E.s, -np.sign(distance), crossed=depth > 0.0)
        side = np.where(coiled, seen, side)
        real &= ~self._hidden(side * distance, depth)
        fresh = np.where(coiled & ~self.known.know(s, E.s)[0], np.abs(distance), np.inf)
        if self.tapered:
            distance, s = self._by_edges(lines[::-1], E.s, s, side)
        D = np.where(real, side * distance, np.inf)
        i = int(np.argmin(D))
        if not real[i]:
            return None
        return Tip(float(side[i]), round(float(turn[i] / np.pi)), float(D[i]), float(s[i]), float(fresh[i]))

    def _hidden(self, D: Array, depth: float) -> Flags:
        """Which places (k,), that see others from the wrong side at D, do so over a part of the beam in between.

        They have come there round an end: through the beam, it would cross itself by a ``depth`` like that.
        """
        return np.asarray(D + self.offset + 2.0 * STRAIGHT * self.a.h < -DEEPER * depth)

    def _crosses(self, lines: Lines) -> float:
        """How deeply the line crosses itself; nought where strands of a line only lie on each other."""
        G = lines[0].sampled
        here, there, depth = own_crossings(np.stack((G.x, G.y), axis=1))
        if not here.size or self.offset > 0.0:
            return float(np.max(depth, initial=0.0))
        bends = np.abs(G.bend[here]) + np.abs(G.bend[there]) + 1.0
        return float(np.max(depth, where=depth > LEVEL * self.a.h**2 * bends, initial=0.0))

    def crosses(self, state: State, at: Positions) -> bool:
        """Whether the beam has passed through itself."""
        return self._crosses(self._sided(1.0, 1.0).lines(state, at)) > 0.0

    def seen(self, known: Faces) -> Itself:
        """The same, with what is known from a state before."""
        return replace(self, known=known)

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        return self.rows(self.facing(state, at), at)

    def rows(self, facing: Facing, at: Positions) -> tuple[Group, ...]:
        """The constraints where parts of the beam face each other."""
        lines, tip = facing.lines, facing.tip
        near = tip is not None and self.offset + REACH > tip.D
        if tip is not None and near:
            near = not held_together(self.a, self.a, -1, tip.s)
        ends = np.array([tip.s]) if tip is not None and near else np.zeros(0)
        found = []
        for strand in facing.strands:
            pair = self._pair(strand)
            along = places_along(pair, lines, strand.D, strand.sigma, ends)
            for group, _ in pair.rows_along(lines, at, along) if along.s.size else ():
                found.append(self._own(group, strand.turns, strand.side))
        if tip is not None and near:
            of_tip = self._sided(1.0, tip.side).exchanged()
            touches = of_tip.touches(lines[::-1], self.a.s[[-1]], ends, np.zeros(1, dtype=bool))
            key = np.array([self.a.n + 3])
            rows = gathered(self.name, (self.a, self.a), at, touches.exchanged(), np.ones((1, 1)), key, ends)
            found.append(self._own(rows, tip.turns, tip.side))
        end = self._head_on(lines)
        if end is not None and end.distance < end.thickness + REACH and not held_together(self.a, self.a, -1, 0.0):
            found.append(self._between_ends(end))
        return tuple(found)

    def _head_on(self, lines: Lines) -> HeadOn | None:
        """How the beam's ends are before each other; None where one has a side of the other's before it, or no end."""
        G = lines[0].sampled
        if self.offset == 0.0 or not turned_enough(G.psi[-1:] - G.psi[:1])[0]:
            return None
        r = np.array((G.x[-1] - G.x[0], G.y[-1] - G.y[0]))
        psi = G.psi[[0, -1]]
        before = np.cos(psi) * r[0] + np.sin(psi) * r[1]
        distance = float(np.hypot(*r))
        if np.any(before >= 0.0) or distance == 0.0:
            return None
        thickness = self.offset + float(np.max(self._sided(1.0, 1.0).wider(G.s[:1], G.s[-1:])))
        on_left = np.sin(psi[1]) * r[0] - np.cos(psi[1]) * r[1] >= 0.0
        return HeadOn(distance, r / distance, thickness, 1.0 if on_left else -1.0)

    def _chord(self, at: Positions) -> Array:
        """C(L) − C(0) (2,)."""
        first, last = self.a.first_joint, self.a.joints.stop - 1
        return np.array((at.x[last] - at.x[first], at.y[last] - at.y[first]))

    def _between_ends(self, end: HeadOn) -> Group:
        """The row that holds ends apart which are before each other."""
        joints, none = np.array([[self.a.first_joint, self.a.joints.stop - 1]]), np.zeros((1, 0), dtype=np.intp)
        ends = np.array((-1.0, 1.0))
        # over x of both joints, then y: of C(L) − C(0)
        over = np.kron((np.eye(2) - np.outer(end.along, end.along)) / end.distance, np.outer(ends, ends))

        def curvature(multipliers: Array) -> Blocks:
            pressing = np.flatnonzero(multipliers)
            return Blocks(joints[pressing], none[pressing], -multipliers[pressing, None, None] * over)

        return Group(
            contact=self.name,
            values=np.array([end.thickness - end.distance]),
            joints=joints,
            angles=none,
            slopes=-np.kron(end.along, ends)[None],
            curvature=curvature,
            keys=(self.a.n + 4,),
            arc=np.zeros(1),
            itself=True,
        )

    def _own(self, group: Group, turns: int, side: float) -> Group:
        """A group of one strand, with keys of its own."""
        number = 2 * (turns + 4) + (side > 0.0)
        keys = tuple(key if key < 0 else key + number * (self.a.n + 8) for key in group.keys)
        return replace(group, keys=keys, itself=True)

    def least_gap(self, state: State, at: Positions) -> float:
        """Least gap anywhere, units of length; of a beam that crosses itself that of its neutral line at most."""
        return self._least(self.facing(state, at))

    def _least(self, facing: Facing) -> float:
        least = np.inf if facing.tip is None else facing.tip.D
        for strand in facing.strands:
            pair = self._pair(strand)
            s, sigma = minima(pair, facing.lines, strand.D, strand.sigma)
            D = feet_near(pair, facing.lines, pair.on_a(facing.lines, s), sigma)[0] if s.size else np.zeros(0)
            ridges = feet_of_ridges(pair, facing.lines, strand.D, strand.sigma)[1]
            least = min(least, float(np.min(strand.D)), float(np.min(np.append(D, ridges), initial=np.inf)))
        least = min(least, self._ends_apart(facing.lines))
        depth = self._crosses(facing.lines)
        return float(min(least, -depth) if depth > 0.0 else least) - self.offset

    def _ends_apart(self, lines: Lines) -> float:
        """The distance of the beam's ends, less by what they are thicker; also where no foot of theirs was seen."""
        G = lines[0].sampled
        if self.offset == 0.0 or not turned_enough(G.psi[-1:] - G.psi[:1])[0]:
            return np.inf
        wider = np.max(self._sided(1.0, 1.0).wider(G.s[:1], G.s[-1:]))
        return float(np.hypot(G.x[-1] - G.x[0], G.y[-1] - G.y[0]) - wider)

    def passed(
        self,
        start: tuple[State, Positions],
        way: Iterable[tuple[State, Positions]],
        end: tuple[State, Positions],
        allowed: float,
    ) -> bool:
        """Whether the beam went through itself on a ``way`` from a ``start``, where its faces are known, to an ``end``.

        The way is known to ``allowed``.  Parts that begin to face each other at less than that, edge from edge, may
        have met in it: such as ends of which neither lies inside the other.  Ends that have met may slip off each other
        where the branch itself ends: they go by no more than what the beam is thick.
        """
        met = self._head_on(self._sided(1.0, 1.0).lines(*start))
        if met is not None and met.distance <= (1.0 + MET) * met.thickness:
            before, after = (self._chord(at) for _, at in (start, end))
            if np.hypot(*(after - before)) > met.thickness:
                return True
        here, close = self, self.offset + allowed
        for state, at in way:
            facing = here.facing(state, at)
            if facing.fresh < close or here._least(facing) + self.offset < -allowed:
                return True
            here = here.seen(facing.faces)
        facing = here.facing(*end)
        dip = LEVEL * self.a.h**2 * (2.0 * np.max(np.abs(facing.lines[0].sampled.bend)) + 1.0)
        return bool(facing.fresh < close or here._least(facing) + self.offset < -dip)

    def _faced(self, facing: Facing, s: Array) -> tuple[Array, Array]:
        """What faces the beam at arc lengths ``s`` most closely: a and σ (k,)."""
        samples, lines = self.a.halves, facing.lines
        side, sigma, least = np.ones(len(s)), s.copy(), np.full(len(s), np.inf)
        for strand in facing.strands:
            pair, on = self._pair(strand), np.isfinite(strand.D)
            first, last = samples[on][[0, -1]]
            near = np.flatnonzero((s >= first - self.a.h) & (s <= last + self.a.h))
            if not near.size:
                continue
            guess = np.interp(s[near], samples[on], strand.sigma[on])
            D, feet, foot = feet_near(pair, lines, pair.on_a(lines, s[near]), guess)
            nearer = foot & (feet > s[near]) & (least[near] > D)
            better = near[nearer]
            side[better], sigma[better], least[better] = strand.side, feet[nearer], D[nearer]
        if facing.tip is not None:
            at_tip = (np.abs(s - facing.tip.s) <= SAME * self.a.h) & (least >= facing.tip.D - SAME * self.a.h)
            sigma = np.where(at_tip, self.a.s[-1], sigma)
            side = np.where(at_tip, facing.tip.across, side)
        if self._head_on(facing.lines) is not None:
            sigma = np.where((s == 0.0) & np.isinf(least), self.a.s[-1], sigma)
        return side, sigma

    def touching(self, state: State, at: Positions, s: Array) -> Array:
        """Where the edges touch that touch at arc lengths ``s``, (k, 2), units of length."""
        facing = self.facing(state, at)
        sigma = self._faced(facing, s)[1]
        A, B = facing.lines[0].at(s), facing.lines[1].at(sigma)
        mine, other = self.a.section.thickness_at(s), self.a.section.thickness_at(sigma)
        share = mine / (mine + other)
        return np.stack((A.x + share * (B.x - A.x), A.y + share * (B.y - A.y)), axis=1)

    def pressed(self, state: State, at: Positions, s: Array) -> tuple[Pressed, ...]:
        """On the beam at s and at σ what lies at ``s``."""
        facing = self.facing(state, at)
        sigma = self._faced(facing, s)[1]
        plain = self._sided(1.0, 1.0)
        return (1.0, s, plain.on_a(facing.lines, s).psi), (-1.0, sigma, plain.on_b(facing.lines, sigma).psi)

    def parting(self, state: State, at: Positions, s: Array) -> Array:
        """Curvature D″ with which the strands part, at arc lengths ``s``."""
        facing = self.facing(state, at)
        side, sigma = self._faced(facing, s)
        parting = np.zeros(len(s))
        for of in (-1.0, 1.0):
            mine, pair = side == of, self._sided(of, of)
            A, B = pair.on_a(facing.lines, s[mine]), pair.on_b(facing.lines, sigma[mine])
            D = of * (np.cos(B.psi) * (A.y - B.y) - np.sin(B.psi) * (A.x - B.x)) - pair.wider(s[mine], sigma[mine])
            parting[mine] = pair.parting_at(facing.lines, A, B, D)
        return parting


def itself_of(scene: Scene, model: Model, name: str, fit: Fit = EVEN) -> Itself:
    """One of the scene's contacts of a beam with itself."""
    contact = scene.contacts[name]
    assert isinstance(contact, SelfContact)
    chain = model.chain(contact.beam)
    return Itself(
        name=name,
        a=chain,
        offset=float(chain.section.thickness.min()) if contact.thick else 0.0,
        unit_length=model.unit_length,
        tapered=contact.thick and float(chain.section.thickness.min()) != chain.thickness,
        kinks=fit.kinks.get(name, (NO_KINKS, NO_KINKS)),
    )
