"""All pieces of a rigid edge and its corners, from many places at once.

A beam is looked at from all of its samples, by every piece and every corner of an edge: in the same few calls, however
many these are.  What the pieces say is in :mod:`cprbm.faces`, the corners in :mod:`cprbm.corner`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.corner import Corner
from cprbm.faces import SAME, Face, Graph, Seen, Straight
from cprbm.once import once
from cprbm_scene.answer import Array, Flags, Ints

NEAREST = 1e-9  # of ℓ: pieces whose distances differ by less are equally near


@dataclass(frozen=True, eq=False)
class WholeEdge:
    """The faces of an edge, where these begin and end (t, 2), and its corners.

    The first ``own`` faces are its own pieces, the others the sides of what is rigid behind these.
    """

    faces: tuple[Face, ...]
    own: int
    tips: Array
    corners: tuple[Corner, ...]

    @once
    def _bent(self) -> list[int]:
        """Which faces are no straight ones."""
        return [f for f, face in enumerate(self.faces) if not isinstance(face, Straight)]

    @once
    def _straight(self) -> tuple[Array, Array, Array, Array, Array]:
        """Origin, τ and n (F, 2), low and high (F,) of the straight faces; noughts for the others."""
        found = np.zeros((len(self.faces), 8))
        for row, face in zip(found, self.faces, strict=True):
            if isinstance(face, Straight):
                row[:] = *face.origin, *face.tau, *face.normal, face.low, face.high
        return found[:, :2], found[:, 2:4], found[:, 4:6], found[:, 6], found[:, 7]

    def seen(self, q: Array) -> Seen:
        """All faces from places ``q`` (k, 2): D (F, k), n (F, k, 2), k (F, k), and whether it is the face (F, k)."""
        distance, n, within = _of_straight(q, tuple(each[:, None] for each in self._straight))
        bend = np.zeros(distance.shape)
        for f in self._bent:
            its = self.faces[f].seen(q)
            distance[f], n[f], bend[f], within[f] = its.distance, its.normal, its.bend, its.within
        return Seen(distance, n, bend, within)

    def each(self, number: Ints, q: Array) -> Seen:
        """Of places ``q`` (k, 2) each one face, by its ``number`` (k,)."""
        distance, normal, within = _of_straight(q, tuple(each[number] for each in self._straight))
        bend = np.zeros(len(number))
        for f in self._bent:
            mine = np.flatnonzero(number == f)
            if mine.size:
                its = self.faces[f].seen(q[mine])
                distance[mine], normal[mine], bend[mine], within[mine] = its.distance, its.normal, its.bend, its.within
        return Seen(distance, normal, bend, within)

    def facing(self, q: Array, seen: Seen) -> Flags:
        """Which places ``q`` (k, 2) face which pieces (F, k): before it, or behind it and none nearer.

        Sides that do not meet go on for ever, and those of a sharp wedge pass behind what is before the edge: behind a
        side is only what is behind the edge's own pieces, too, by the nearest of them.
        """
        facing = seen.within & (seen.distance >= 0.0)
        behind = np.flatnonzero((seen.within & ~facing).any(axis=0))
        if not behind.size:
            return np.asarray(facing)
        within, depth = seen.within[:, behind], np.abs(seen.distance[:, behind])
        least = np.where(within, depth, np.inf).min(axis=0)
        # beside a tip, above all one where the beam is pinned, a place is by round-off alone beside a piece, or none
        for tip in self.tips:
            least = np.minimum(least, np.hypot(*(q[behind] - tip).T))
        sunk = within & (depth <= least + NEAREST)
        if sunk[self.own :].any():
            sunk[self.own :] &= ~self._before(q[behind], seen.distance[:, behind], within)
        facing[:, behind] |= sunk
        return np.asarray(facing)

    def _before(self, q: Array, distance: Array, within: Flags) -> Flags:
        """Which places ``q`` (k, 2) are before the nearest of the edge's own pieces, seen at D and if it is the piece.

        Where that is a corner that stands out, before one of its pieces, continued; where it is an end of the edge,
        before the side that goes back from there, too.
        """
        away = np.abs(distance[: self.own])
        for face, row, beside in zip(self.faces, away, within[: self.own], strict=False):
            ends = [np.hypot(*(q - end).T) for end in face.ends if end is not None]
            if ends:
                row[~beside] = np.minimum.reduce(ends)[~beside]
        least = away.min(axis=0) + NEAREST
        before = ((away <= least) & (distance[: self.own] > NEAREST)).any(axis=0)
        for side, D in zip(self.faces[self.own :], distance[self.own :], strict=True):
            assert isinstance(side, Straight)
            before |= (D > NEAREST) & (np.hypot(*(q - np.array(side.origin)).T) <= least)
        return np.asarray(before)

    @once
    def ahead(self) -> Array:
        """The corners' normals in the middle (C, 2)."""
        return np.array([corner.ahead for corner in self.corners]).reshape(-1, 2)

    @once
    def places(self) -> Array:
        """The corners' places (C, 2)."""
        return np.array([corner.place for corner in self.corners]).reshape(-1, 2)

    @once
    def chains(self) -> tuple[tuple[Array, Array], ...]:
        """Of each corner the edge from there on, (k, 2) against its course and (j, 2) along it."""
        return tuple(
            (self._chain(np.array(corner.place), 1), self._chain(np.array(corner.place), 0)) for corner in self.corners
        )

    def beside(self, graph: Graph, v: float) -> tuple[Array, Array]:
        """The edge from a place of one of its graphs, at ``v``: (k, 2) against its course and (j, 2) along it."""
        samples, places, _ = graph.samples
        here, k = graph.at(np.array([v]))[0], int(samples.searchsorted(v))
        lower, upper = np.concatenate((here, places[:k][::-1])), np.concatenate((here, places[k:]))
        begins = np.hypot(*(graph.course[0] - places[0])) <= SAME
        before, behind = (lower, upper) if begins else (upper, lower)
        return (
            np.concatenate((before, self._chain(graph.course[0], 1)[1:])),
            np.concatenate((behind, self._chain(graph.course[-1], 0)[1:])),
        )

    def _chain(self, place: Array, side: int) -> Array:
        """The edge from a ``place`` on: along it from the faces' ends of ``side`` 0, back along it from those of 1."""
        found, at = [place[None]], place
        for _ in self.faces:
            face = next((each for each in self.faces if _is_at(each.ends[side], at)), None)
            if face is None:
                break
            found.append((face.course if side == 0 else face.course[::-1])[1:])
            end = face.ends[1 - side]
            if end is None or _is_at(end, place):
                break
            at = end
        return np.concatenate(found)


def _is_at(end: Array | None, place: Array) -> bool:
    return end is not None and bool(np.hypot(*(end - place)) <= SAME)


def _of_straight(q: Array, faces: tuple[Array, ...]) -> tuple[Array, Array, Flags]:
    """D and n of straight faces from places ``q`` (k, 2), and whether it is the face.

    Of the ``faces`` origin, τ and n (..., 2), low and high (...), as broadcast with the places.
    """
    origin, tau, normal, low, high = faces
    r = q - origin
    along = r[..., 0] * tau[..., 0] + r[..., 1] * tau[..., 1]
    distance = r[..., 0] * normal[..., 0] + r[..., 1] * normal[..., 1]
    n = np.empty(r.shape)
    n[:] = normal
    return distance, n, (along >= low) & (along <= high)
