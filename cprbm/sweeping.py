"""What a beam sweeps over between two states: places of something rigid that it has gone through from side to side.

==========  ==================================================================================
P           a place of what is rigid, in the frame of its body
C, N        the beam's neutral line in that frame, and its normal
s*, ρ       arc length where C is closest to P, and how far it is there
ε           by how much C may lie behind P where it rests on what is rigid: what an element's bend leaves between rows
L           the closed way along the beam before, the path of its end, the beam after back, and the path of its start
==========  ==================================================================================

What a beam has swept over its way L goes round.  However short P's body is along the beam, and wherever between two
samples it lies, it is seen: the closest place s* is a place of L, so that a line through it and the samples beside it
has P on the side that the beam has.

A line that rests on P has it on neither side.  So it is moved behind the beam by a little there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.smooth import SmoothLine
from cprbm_scene.answer import Array, Flags

STEPS = 4  # of Newton's method to the closest place, from the nearest sample
RESTING = 0.25  # of an element times what it turns by: twice the sag of an even bend
ROUND_OFF = 1e-9  # units of length


@dataclass(frozen=True, slots=True)
class Swath:
    """A beam in one state as places (k,) of what is rigid see it.

    Attributes:
        course: the beam's samples (n, 2), in the body's frame.
        beside: numbers of the samples between which the closest places are, the first of them (k,).
        closest: these (k, 2), in the body's frame; normals of the beam there (k, 2).
        s: s* (k,); away: ρ (k,); resting: ε (k,).
    """

    course: Array
    beside: Array
    closest: Array
    normals: Array
    s: Array
    away: Array
    resting: Array


def swath(line: SmoothLine, places: Array, origin: Array, turn: float) -> Swath:
    """The beam as ``places`` (k, 2) see it whose body has its ``origin`` (2,) and is turned by ``turn``, rad."""
    A = line.sampled
    cos, sin = np.cos(turn), np.sin(turn)
    inwards = np.array([[cos, -sin], [sin, cos]])
    course = (np.array((A.x, A.y)).T - origin) @ inwards
    nearest = np.argmin(np.hypot(*(course[:, None] - places).transpose(2, 0, 1)), axis=0)
    low, high = A.s[np.maximum(nearest - 1, 0)], A.s[np.minimum(nearest + 1, len(A.s) - 1)]
    s = A.s[nearest]
    x, y = (origin + places @ inwards.T).T
    B = line.at(s)
    for _ in range(STEPS):
        rx, ry, c, n = B.x - x, B.y - y, np.cos(B.psi), np.sin(B.psi)
        slope = B.speed * (c * rx + n * ry)
        bent = B.speed**2 * (1.0 + B.bend / B.speed * (c * ry - n * rx))
        before, s = s, np.minimum(np.maximum(s - slope / np.where(bent > 0.0, bent, B.speed**2), low), high)
        B = line.at(s)
        if np.array_equal(s, before):
            break
    closest = (np.array((B.x, B.y)).T - origin) @ inwards
    normals = np.array((-np.sin(B.psi), np.cos(B.psi))).T @ inwards
    size = line.chain.size_at(s)
    return Swath(
        course=course,
        beside=np.minimum(np.maximum(A.s.searchsorted(s, side="right") - 1, 0), len(A.s) - 2),
        closest=closest,
        normals=normals,
        s=s,
        away=np.hypot(*(closest - places).T),
        resting=RESTING * size**2 * np.abs(B.bend) + ROUND_OFF,
    )


def swept(before: Swath, after: Swath, ends: Array, places: Array, ahead: Array | None) -> Flags:
    """Which ``places`` (k, 2) the beam has gone through from a state ``before`` to one ``after``.

    Args:
        before, after: the beam as the places see it.
        ends: the beam's start and end on the way, both states among them (2, j, 2), in the body's frame.
        places: P.
        ahead: directions (k, 2) out of what is rigid at the places, by which sides are told where the beam rests on
            one; None where it never does.
    """
    gone, seen = after.away > 0.0, places
    if ahead is not None:
        gone = after.away > after.resting
        if not gone.any():
            return np.asarray(gone)
        sides = np.where(np.sum(before.normals * ahead, axis=1) < 0.0, -1.0, 1.0)
        behind = np.where(before.away <= before.resting, 2.0 * before.resting, 0.0) * sides
        seen = places - behind[:, None] * before.normals
    turned = _along(before, seen) - _along(after, seen)
    turned += _turned(ends[1] - seen[:, None]) - _turned(ends[0] - seen[:, None])
    return np.asarray(gone & (np.abs(turned) > np.pi))


def _along(beam: Swath, seen: Array) -> Array:
    """The angle by which places ``seen`` (k, 2) turn that look along a beam (k,)."""
    one, other = beam.course[beam.beside] - seen, beam.course[beam.beside + 1] - seen
    middle = beam.closest - seen
    bent = _angle(one, middle) + _angle(middle, other) - _angle(one, other)
    return np.asarray(_turned(beam.course - seen[:, None]) + bent)


def _turned(rays: Array) -> Array:
    """The angle (k,) from the first to the last of some rays (k, n, 2), step by step."""
    return np.asarray(_angle(rays[:, :-1], rays[:, 1:]).sum(axis=1))


def _angle(one: Array, other: Array) -> Array:
    """The angle from one vector (..., 2) to another, in (−π, π]."""
    across = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
    return np.asarray(np.arctan2(across, np.sum(one * other, axis=-1)))
