"""Edges of a beam whose thickness varies, as what touches it sees them.

======  ==============================================================================
C, ψ    smooth neutral line of the beam, :mod:`cprbm.smooth`, and its tangent angle
T       t/2, half the thickness at s
u       direction from the beam to what it faces
a       +1 where that lies on the beam's left, −1 on the right
λ       angle by which the edge there leans against the neutral line; ψ + λ is its tangent angle
======  ==============================================================================

The beam is the discs of radius T about the places of C.  What is outside is closest to the disc that it sees along u,
u·C_s = T_s (what faces the beam from there has |r| − T least), and so

    λ = a·asin(T_s/|C_s|),    λ_s = −tan λ·|C_s|_s/|C_s|,    ∂λ/∂z = −tan λ·|C_s|_z/|C_s|,

T being straight between places.  Where the edge has a corner that stands out, u lies anywhere between the two normals
there: the edge turns from one to the other as round an arc of next to no length.
"""

from __future__ import annotations

import numpy as np

from cprbm import moving, smooth
from cprbm.model import Chain
from cprbm.moving import Moving
from cprbm_scene.answer import Array, Flags

CORNER = 1e13  # 1/ℓ: the curvature of an edge at a corner


def half_less(chain: Chain, s: Array) -> Array:
    """T at arc lengths ``s`` (k,), less what the beam has where it is thinnest; units of length."""
    return np.asarray(0.5 * (chain.section.thickness_at(s) - chain.section.thickness.min()))


def leant(chain: Chain, points: smooth.Points, side: Array | float) -> smooth.Points:
    """Points of the beam with the tangents of its edge on a ``side`` a, and the speed along those."""
    return _leaning(points, side * _lean(points, chain.section.thinning_at(points.s)))


def facing(chain: Chain, points: smooth.Points, side: float, along: Array, across: Array) -> smooth.Points:
    """The same for feet of what lies at ``along`` and ``across`` (k,) from there; at a corner as that sees it."""
    found = leant(chain, points, side)
    ridges = chain.section.ridges
    on = np.flatnonzero(np.isin(points.s, ridges)) if ridges.size else np.zeros(0, dtype=np.intp)
    if not on.size:
        return found
    section = chain.section
    lean = found.psi - points.psi
    before = side * _lean(points, section.thinning_at(np.nextafter(points.s, 0.0)))[on]
    low, high = np.minimum(before, lean[on]), np.maximum(before, lean[on])
    seen = np.arctan(-along[on] / np.where(across[on] == 0.0, np.finfo(float).tiny, across[on]))
    within = on[(seen >= low) & (seen <= high)]
    lean[on] = np.clip(seen, low, high)
    found = _leaning(points, lean)
    bend = found.bend.copy()
    bend[within] = -side * CORNER
    return found._replace(bend=bend)


def _lean(points: smooth.Points, thinning: Array) -> Array:
    return np.asarray(np.arcsin(np.clip(0.5 * thinning / points.speed, -1.0, 1.0)))


def _leaning(points: smooth.Points, lean: Array) -> smooth.Points:
    return points._replace(
        psi=points.psi + lean,
        bend=points.bend - np.tan(lean) * points.gain / points.speed,
        pace=points.speed * np.cos(points.psi + lean - points.tangent),
    )


def at_corner(points: smooth.Points) -> Flags:
    """Which feet stay at a corner of the edge (k,)."""
    return np.asarray(np.abs(points.bend) >= CORNER)


def angle_slopes(z: Moving, lead: Array) -> Array:
    """∂(ψ + λ) over the local numbers of places whose edge leads the line's tangent by ``lead`` (k,), (k, 5)."""
    slopes = moving.angle_slopes(z)
    slopes[:, 2:] -= (np.tan(lead) * moving.turned_by(z).real)[:, None] * z.over_angles
    return slopes
