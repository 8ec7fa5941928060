"""How far beams are, at least, from all that they may touch, told from a few of their joints.

==========  ==================================================================================
s_k, r_k    discs of a beam: round a joint, half of a stretch of the beam and one element wide
o, R        centre and radius of a circle
v, w        coordinates along a piece of an edge and towards its free side, :mod:`cprbm.faces`
f           height w of the piece between v = a and v = b; f̂ its top, σ₊ and σ₋ how steeply it rises and falls
C           clearance: no more than the distance of the neutral lines, or of one from what is rigid
==========  ==================================================================================

A beam does not stretch: each of its places is within one of its discs, whatever the state.  So C is the least over the
discs of

    circle:  |p_k − o| − R − r_k
    beams:   |p_k − p_l| − r_k − r_l
    piece:   max(w − f̂ − r_k,  g(v − b, σ₊),  g(a − v, σ₋)),  g(d, σ) = min(d − r_k, (d + σ (w − f̂))/√(1 + σ²) − r_k)

The last says that a disc is above all of a piece, or beside it: what has its foot on the piece from behind, where that
has the slope f′, lies within v − b ≤ σ₊ (f̂ − w) on the one side, and likewise on the other.

C changes by no more than the joints move against what they may touch; a link that turns by dθ moves those behind it by
L dθ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cprbm import circle, closest, edge
from cprbm.faces import Face, faces_of
from cprbm.kinematics import Positions, State
from cprbm.model import Chain, Model
from cprbm.outset import anchor
from cprbm_scene import BeamContact, CircleContact, EdgeContact, Scene, SelfContact
from cprbm_scene.answer import Array, Flags, Ints

DISCS = 8  # of a beam
SHARES = np.arange(DISCS + 1) / DISCS  # of its length, at which their stretches end
KNOWN = -1  # where positions keep clearances; no beam's first link has that number


@dataclass(frozen=True, slots=True)
class Circles:
    """Contacts ``number`` (k,) of ``beams`` (k,) with circles ``x``, ``y`` (k,) at rest, ``wide`` R + r (k, DISCS).

    ``moving`` are those of them (j,) on bodies that move, whose centres are the ``marks`` (j,).
    """

    number: Ints
    beams: Ints
    x: Array
    y: Array
    wide: Array
    moving: Ints
    marks: Ints

    def clearances(self, x: Array, y: Array, at: Positions) -> Array:
        """C (k,) from the discs' centres, (beams, DISCS) each."""
        ox, oy = self.x, self.y
        if self.moving.size:
            ox, oy = ox.copy(), oy.copy()
            ox[self.moving], oy[self.moving] = at.x[self.marks], at.y[self.marks]
        away = np.hypot(x[self.beams] - ox[:, None], y[self.beams] - oy[:, None])
        return np.asarray((away - self.wide).min(axis=1))


@dataclass(frozen=True, slots=True)
class Edges:
    """Contacts ``number`` (k,) with edges, by their pieces.

    Attributes:
        first: of each contact's pieces (k,).
        beams: of the pieces (f,); ``wide`` r (f, DISCS).
        base: (2, f), where v and w are zero; along, out: their directions (2, f); against the body if that moves.
        low, high, top: a, b and f̂ (f,); steep: σ₊ and σ₋ (2, f).
        moving: pieces on bodies that move (j,), those ``bodies`` (j,) and the edges' ``marks`` (j,).
    """

    number: Ints
    first: Ints
    beams: Ints
    wide: Array
    base: Array
    along: Array
    out: Array
    low: Array
    high: Array
    top: Array
    steep: Array
    moving: Ints
    bodies: Ints
    marks: Ints

    def clearances(self, x: Array, y: Array, state: State, at: Positions) -> Array:
        """C (k,) from the discs' centres, (beams, DISCS) each."""
        (bx, by), (tx, ty), (nx, ny) = self._placed(state, at)
        x, y = x[self.beams] - bx[:, None], y[self.beams] - by[:, None]
        v, w = tx[:, None] * x + ty[:, None] * y, nx[:, None] * x + ny[:, None] * y
        above = w - self.top[:, None]
        beyond = [v - self.high[:, None], self.low[:, None] - v]
        beside = [
            np.minimum(d, (d + steep[:, None] * above) / np.hypot(1.0, steep)[:, None])
            for d, steep in zip(beyond, self.steep, strict=True)
        ]
        clear = np.maximum(above, np.maximum(*beside)) - self.wide
        return np.asarray(np.minimum.reduceat(clear.min(axis=1), self.first))

    def _placed(self, state: State, at: Positions) -> tuple[Array, Array, Array]:
        """``base``, ``along`` and ``out`` in a state."""
        if not self.moving.size:
            return self.base, self.along, self.out
        phi = state.bodies[self.bodies, 2]
        cos, sin = np.cos(phi), np.sin(phi)
        turned = []
        for vectors in (self.base, self.along, self.out):
            vx, vy = vectors[:, self.moving]
            now = vectors.copy()
            now[:, self.moving] = cos * vx - sin * vy, sin * vx + cos * vy
            turned.append(now)
        turned[0][:, self.moving] += at.x[self.marks], at.y[self.marks]
        return turned[0], turned[1], turned[2]


@dataclass(frozen=True, slots=True)
class Pairs:
    """Contacts ``number`` (k,) of beams ``one`` and ``other`` (k,), ``wide`` r + r (k, DISCS, DISCS)."""

    number: Ints
    one: Ints
    other: Ints
    wide: Array

    def clearances(self, x: Array, y: Array) -> Array:
        """C (k,) from the discs' centres, (beams, DISCS) each."""
        apart_x = x[self.one][:, :, None] - x[self.other][:, None, :]
        apart_y = y[self.one][:, :, None] - y[self.other][:, None, :]
        return np.asarray((np.hypot(apart_x, apart_y) - self.wide).min(axis=(1, 2)))


@dataclass(frozen=True, slots=True)
class Clearances:
    """Of all contacts of a model, in the scene's order; of a beam and itself nothing is known.

    Attributes:
        model: whose joints the discs are.
        names: of the contacts (m).
        joints: the discs' centres (beams, DISCS).
        reach: C beyond which a contact has no row (m,).
        half: C beyond which nothing overlaps (m,).
        beams: the one beam and the other of each contact (2, m), −1 where there is none.
        bodies: that what is rigid is fixed to (m,), −1 for the ground.
        circles, edges, pairs: the contacts by their kinds, None where there is none.
    """

    model: Model
    names: tuple[str, ...]
    joints: Ints
    reach: Array
    half: Array
    beams: Ints
    bodies: Ints
    circles: Circles | None
    edges: Edges | None
    pairs: Pairs | None

    def at(self, state: State, at: Positions) -> Array:
        """C of all contacts (m,)."""
        found: Array | None = at.known.get(KNOWN)
        if found is None:
            found = at.known[KNOWN] = self._at(state, at)
        return found

    def _at(self, state: State, at: Positions) -> Array:
        x, y = at.x[self.joints], at.y[self.joints]
        found = np.zeros(len(self.names)) - np.inf
        if self.circles is not None:
            found[self.circles.number] = self.circles.clearances(x, y, at)
        if self.edges is not None:
            found[self.edges.number] = self.edges.clearances(x, y, state, at)
        if self.pairs is not None:
            found[self.pairs.number] = self.pairs.clearances(x, y)
        return found

    def near(self, state: State, at: Positions) -> list[str]:
        """Names of the contacts that may have rows, in the scene's order."""
        return self._named(self.at(state, at) < self.reach) if self.names else []

    def may_pass(self, before: tuple[State, Positions], after: tuple[State, Positions]) -> list[str]:
        """Names of the contacts that something may go through between two states, the unknowns going evenly."""
        if not self.names:
            return []
        both = self.at(*before) + self.at(*after)
        return self._named(both - self._moved(before, after) < 2.0 * self.half)

    def _named(self, these: Flags) -> list[str]:
        return [self.names[i] for i in these.nonzero()[0].tolist()]

    def _moved(self, before: tuple[State, Positions], after: tuple[State, Positions]) -> Array:
        """The most by which beams move against what they may touch, (m,)."""
        (old, at), (new, _) = before, after
        model = self.model
        turned = np.abs(new.bodies[:, 2] - old.bodies[:, 2])
        shifted = np.hypot(*(new.bodies - old.bodies).T[:2])
        swung = np.add.reduceat(
            model.lengths * np.abs(new.theta - old.theta), [chain.first_link for chain in model.chains]
        )
        for c, chain in enumerate(model.chains):
            b = chain.start.body
            if b >= 0:
                swung[c] += shifted[b] + turned[b] * float(np.hypot(*chain.start.point))
        one, other = self.beams
        moved = swung[one] + np.where(other >= 0, swung[other], 0.0)
        carried = np.flatnonzero(self.bodies >= 0)
        if carried.size:
            body, beam = self.bodies[carried], one[carried]
            first = [chain.first_joint for chain in model.chains]
            place = model.references[body] + old.bodies[body, :2]
            away = np.hypot(at.x[first][beam] - place[:, 0], at.y[first][beam] - place[:, 1])
            lengths = np.array([float(chain.s[-1]) for chain in model.chains])
            away += lengths[beam] + swung[beam] + shifted[body]
            moved[carried] += shifted[body] + turned[body] * away
        return np.asarray(moved)


def clearances_of(scene: Scene, model: Model) -> Clearances:
    """Those of a scene's contacts."""
    joints, wide = (np.stack(each) for each in zip(*(_discs(chain) for chain in model.chains), strict=True))
    number = {chain.name: i for i, chain in enumerate(model.chains)}
    names = tuple(scene.contacts)
    reach, half = np.full(len(names), np.inf), np.full(len(names), np.inf)
    beams, bodies = np.full((2, len(names)), -1, dtype=np.intp), np.full(len(names), -1, dtype=np.intp)
    circles, edges, pairs = list[int](), list[int](), list[int]()
    faces: dict[int, tuple[Face, ...]] = {}
    for i, (name, contact) in enumerate(scene.contacts.items()):
        if isinstance(contact, SelfContact):
            beams[0, i] = number[contact.beam]
            continue
        mine = [model.chains[number[beam]] for beam in contact.beams]
        half[i] = sum(0.5 * chain.thickness for chain in mine) if contact.thick else 0.0
        beams[: len(mine), i] = [number[beam] for beam in contact.beams]
        bodies[i] = model.marks[name].body if name in model.marks else -1
        if isinstance(contact, BeamContact):
            pairs.append(i)
            reach[i] = half[i] + closest.reach(*mine)
        elif isinstance(contact, CircleContact):
            circles.append(i)
            reach[i] = half[i] + circle.reach(mine[0], contact.radius / model.unit_length)
        elif isinstance(contact, EdgeContact):
            edges.append(i)
            x, y = np.array(anchor(contact)) / model.unit_length if bodies[i] >= 0 else (0.0, 0.0)
            faces[i] = faces_of(contact, model.unit_length, (float(x), float(y)))
            reach[i] = half[i] + max(edge.reach(mine[0], face) for face in faces[i])
    one, other = beams[:, pairs]
    return Clearances(
        model=model,
        names=names,
        joints=joints,
        reach=reach,
        half=half,
        beams=beams,
        bodies=bodies,
        circles=_circles(scene, model, names, circles, beams[0], wide) if circles else None,
        edges=_edges(model, names, faces, beams[0], bodies, wide) if edges else None,
        pairs=Pairs(np.array(pairs), one, other, wide[one][:, :, None] + wide[other][:, None, :]) if pairs else None,
    )


def _discs(chain: Chain) -> tuple[Ints, Array]:
    """Joints (DISCS,) in the middle of as many stretches of a beam, and how wide their discs are."""
    ends = chain.s[-1] * SHARES
    middle = np.abs(chain.s - 0.5 * (ends[1:] + ends[:-1])[:, None]).argmin(axis=1)
    s = chain.s[middle]
    # the smooth line is a little longer than its chords, and elsewhere by less than an element
    return chain.first_joint + middle, np.maximum(s - ends[:-1], ends[1:] - s) + chain.sizes.max()


def _circles(
    scene: Scene, model: Model, names: Sequence[str], these: Sequence[int], beams: Ints, wide: Array
) -> Circles:
    found = [scene.contacts[names[i]] for i in these]
    rounds = np.array([(*c.center, c.radius) for c in found if isinstance(c, CircleContact)]) / model.unit_length
    moving = [k for k, i in enumerate(these) if names[i] in model.marks]
    return Circles(
        number=np.array(these),
        beams=beams[these],
        x=rounds[:, 0],
        y=rounds[:, 1],
        wide=wide[beams[these]] + rounds[:, 2:],
        moving=np.array(moving, dtype=np.intp),
        marks=np.array([model.mark_of(names[these[k]]) for k in moving], dtype=np.intp),
    )


def _edges(
    model: Model, names: Sequence[str], faces: dict[int, tuple[Face, ...]], beams: Ints, bodies: Ints, wide: Array
) -> Edges:
    of = np.repeat(list(faces), [len(mine) for mine in faces.values()])
    roofs = [face.roof for mine in faces.values() for face in mine]
    base, along, out = np.array([(roof.base, roof.along, roof.out) for roof in roofs]).transpose(1, 2, 0)
    low, high, top, rise, fall = np.array([(r.low, r.high, r.top, r.rise, r.fall) for r in roofs]).T
    moving = np.flatnonzero(bodies[of] >= 0)
    return Edges(
        number=np.array(list(faces)),
        first=np.concatenate(([0], np.cumsum([len(mine) for mine in faces.values()])[:-1])),
        beams=beams[of],
        wide=wide[beams[of]],
        base=base,
        along=along,
        out=out,
        low=low,
        high=high,
        top=top,
        steep=np.stack((rise, fall)),
        moving=moving,
        bodies=bodies[of[moving]],
        marks=np.array([model.mark_of(names[i]) for i in of[moving]], dtype=np.intp),
    )
