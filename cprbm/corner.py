"""Corners of a rigid edge that stand out: each a circle without a radius.

==========  ===================================================================================
P           the corner, :mod:`cprbm.edge` where it is
n₋, n₊      normals of what comes before it and of what follows; those between them are its normals
C, ψ, C_s   smooth neutral line of the beam, its tangent angle, and its derivative over arc length
N           the beam's normal away from the edge
T           half the thickness, zero for a line
m, τ        N turned by the angle whose sine is T_s/|C_s|: away from P where C is closest to it; m turned clockwise
ρ           m·(C − P), negative where P is on the wrong side of the neutral line
D           ρ − (T − T₀) where τ·(C − P) = 0
g, M        τ·C_s and m·C_ss
a, b        m·C_sz and τ·v_z, over the local numbers z
==========  ===================================================================================

As seen from a place that is in front of it, a corner has the distance ρ = |C − P| with the bend 1/ρ.  A line touches it
with ρ = 0, where that says nothing; but the closest place of the beam moves with what it depends on, and then

    D_z = m·v_z,    D_zz = m·C_zz + E + (M b bᵀ − ρ a aᵀ − g (a bᵀ + b aᵀ))/(ρ M + g²)

which is what a circle has (:mod:`cprbm.circle`) with both sides multiplied by ρ; v_z and E as in :mod:`cprbm.edge`.
Where m goes from one piece's normal to the corner's, D and D_z are those of the piece.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cprbm.faces import SAME, Face, Seen
from cprbm_scene import LineContact
from cprbm_scene.answer import Array

JUTTING = 1e-9  # sine of the angle by which an edge turns at least where it stands out


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner at ``place``, between the unit normals ``before`` and ``behind``, in the frame of the edge's body.

    ``ends`` where the edge does, and one of both pieces is a side of what is rigid behind it.
    """

    place: tuple[float, float]
    before: tuple[float, float]
    behind: tuple[float, float]
    ends: bool

    @property
    def ahead(self) -> Array:
        """The normal in the middle (2,)."""
        both = np.array(self.before) + np.array(self.behind)
        return np.asarray(both / np.hypot(*both))

    def seen(self, q: Array) -> Seen:
        """The corner from places ``q`` (k, 2)."""
        r = q - np.array(self.place)
        rho = np.hypot(r[:, 0], r[:, 1])
        size = np.maximum(rho, np.finfo(float).tiny)
        on_it = (rho == 0.0)[:, None]
        return Seen(rho, np.where(on_it, self.ahead, r / size[:, None]), 1.0 / size, self.beyond(r) >= 0.0)

    def beyond(self, normals: Array) -> Array:
        """How far vectors (k, 2) are within the corner's normals, negative outside: the lesser of two sines."""
        (bx, by), (fx, fy) = self.before, self.behind
        size = np.maximum(np.hypot(normals[:, 0], normals[:, 1]), np.finfo(float).tiny)
        # along what comes before it, and against what follows
        ahead, back = by * normals[:, 0] - bx * normals[:, 1], fx * normals[:, 1] - fy * normals[:, 0]
        return np.asarray(np.minimum(ahead, back) / size)


def stands_out(line: LineContact) -> bool:
    """Whether a line stands out somewhere between its ends, told from its points alone."""
    points = np.array(line.points)
    along = np.diff(points, axis=0)
    along /= np.hypot(along[:, 0], along[:, 1])[:, None]
    if line.closed:
        along = np.concatenate((along, along[:1]))
    turning = along[:-1, 0] * along[1:, 1] - along[:-1, 1] * along[1:, 0]
    away = -turning if line.side == "left" else turning
    return bool(np.any(away > JUTTING))


def corners_of(pieces: Sequence[Face], sides: Sequence[Face]) -> tuple[Corner, ...]:
    """Where the pieces of an edge and the ``sides`` of what is behind it stand out."""
    found = []
    for face in (*pieces, *sides):
        begin = face.ends[0]
        if begin is None:
            continue
        for other in (*pieces, *sides):
            if other is not face and _same(other.ends[1], begin):
                ends = face in sides or other in sides
                found.append((begin, _normal(other, begin), _normal(face, begin), ends))
                break
    return tuple(
        Corner(
            place=(float(place[0]), float(place[1])),
            before=(float(before[0]), float(before[1])),
            behind=(float(behind[0]), float(behind[1])),
            ends=ends,
        )
        for place, before, behind, ends in found
        if before[0] * behind[1] - before[1] * behind[0] < -JUTTING
    )


def _normal(face: Face, place: Array) -> Array:
    return np.asarray(face.seen(place[None]).normal[0])


def _same(one: Array | None, other: Array) -> bool:
    return one is not None and bool(np.hypot(*(one - other)) <= SAME)
