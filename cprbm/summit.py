"""Where a graph that is sharper or narrower than a beam's elements comes closest to the beam.

==========  ===================================================================================
G           the graph at v, and n its normal towards the free side; κ its curvature, R = 1/κ
C, t, N     the beam at s as the graph's body sees it, its tangent and its normal
m           N or −N, whichever is towards the free side
D           m·(C − G), where t·(C − G) = 0 and G_v·N = 0: where both are closest to each other
==========  ===================================================================================

What is narrower than an element may be seen by no sample of the beam.  So it is the graph that looks: from each of
its own the beam is as far as it is, and where that is least, the place is near.  Newton's method on both of
these at once is then as sure as G is round, however sharp that is and however deep the beam lies in it.

The distance to second order is that to the circle of curvature: a corner (:mod:`cprbm.corner`) with the radius R, at
its centre G − R n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.faces import Graph
from cprbm.frame import Frame
from cprbm.kinks import missed
from cprbm.model import Kinks
from cprbm.smooth import Points, SmoothLine
from cprbm.sweeping import swath
from cprbm_scene.answer import Array, Flags

STEPS = 30  # of Newton's method
CLOSE = 1e-11  # units of length: its last step
SHARP = 0.5  # elements over R, from which on a graph is looked at from itself
NARROW = 4.0  # or if it is shorter than so many elements
ROUND = 1e-3  # 1/ℓ: what is less round has no circle of curvature that would be worth the name
PARTING = 0.5  # of κ, by which it is to be rounder at least than the beam beside it, that does not lie along it there


@dataclass(frozen=True, slots=True)
class Summits:
    """Places of a beam and of a graph that are closest to each other (k,).

    Attributes:
        s: arc lengths on the beam; v: the graph's variable.
        place: G; normal: n (k, 2), in the frame of the graph's body; radius: R.
    """

    s: Array
    v: Array
    place: Array
    normal: Array
    radius: Array

    def only(self, these: Flags) -> Summits:
        """Some of them."""
        return Summits(self.s[these], self.v[these], self.place[these], self.normal[these], self.radius[these])


NONE = Summits(np.zeros(0), np.zeros(0), np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))


def looked_at(graph: Graph, h: float) -> bool:
    """Whether a graph is sharper or narrower than elements of length ``h``, units of length."""
    return graph.sharpest * h > SHARP or graph.high - graph.low < NARROW * h


def summits(graph: Graph, line: SmoothLine, frame: Frame, kinks: Kinks, within: float) -> Summits:
    """Where a beam and a graph are closest to each other, and no farther than ``within``."""
    v, places, outwards = graph.samples
    seen = swath(line, places, frame.m, frame.phi)
    apart = np.sum(seen.normals * (seen.closest - places), axis=1) * _sides(seen.normals, outwards)
    low = np.flatnonzero((apart[:-2] >= apart[1:-1]) & (apart[2:] > apart[1:-1]) & (seen.away[1:-1] < within)) + 1
    if not low.size:
        return NONE
    chain, s, v, spacing = line.chain, seen.s[low], v[low], v[1] - v[0]
    nearby = np.clip(np.stack((s - chain.h, s + chain.h)), 0.0, chain.s[-1])
    around = np.clip(np.stack((v - spacing, v + spacing)), graph.low, graph.high)
    step = ahead = np.zeros(len(s))
    for _ in range(STEPS):
        A = line.at(s)
        beyond = missed(chain, kinks, A)
        C, t = _tangent(A, A.psi + beyond.angle, frame)
        N = np.stack((-t[:, 1], t[:, 0]), axis=1)
        G, G_v, G_vv = graph.at(v)
        turning = A.bend + beyond.bend
        r = C - G
        f, g = np.sum(t * r, axis=1), np.sum(G_v * N, axis=1)
        f_s, f_v = A.speed + turning * np.sum(N * r, axis=1), -np.sum(t * G_v, axis=1)
        g_s, g_v = turning * f_v, np.sum(G_vv * N, axis=1)
        both = f_s * g_v - f_v * g_s
        both = np.where(both == 0.0, np.inf, both)
        step, ahead = (f * g_v - g * f_v) / both, (f_s * g - g_s * f) / both
        moved, gone = np.clip(s - step, *nearby), np.clip(v - ahead, *around)
        step, ahead, s, v = moved - s, gone - v, moved, gone
        if max(np.abs(step).max(), np.abs(ahead).max()) < CLOSE:
            break
    A = line.at(s)
    _, t = _tangent(A, A.psi, frame)
    n, kappa = graph.normal(v), graph.curvature(v)
    facing = t[:, 0] * n[:, 1] - t[:, 1] * n[:, 0]
    settled = (np.abs(step) < CLOSE) & (np.abs(ahead) < CLOSE) & (s > 0.0) & (s < chain.s[-1])
    settled &= (
        (v > graph.low) & (v < graph.high) & (kappa > ROUND) & (kappa + np.sign(facing) * A.bend > PARTING * kappa)
    )
    found = Summits(s, v, graph.at(v)[0], n, 1.0 / np.where(settled, kappa, 1.0)).only(settled)
    # samples on both sides may lead to one place
    first = np.unique(np.round(found.v / (1e-6 * spacing)), return_index=True)[1]
    return found.only(np.isin(np.arange(len(found.s)), first))


def _sides(normals: Array, outwards: Array) -> Array:
    return np.where(np.sum(normals * outwards, axis=1) < 0.0, -1.0, 1.0)


def _tangent(A: Points, psi: Array, frame: Frame) -> tuple[Array, Array]:
    """Points of a beam and unit vectors of angle ``psi`` (k,) as the body sees them, (k, 2) each."""
    t = np.stack((np.cos(psi), np.sin(psi)), axis=1)
    return frame.inwards(np.stack((A.x, A.y), axis=1)), frame.turned(t, -frame.phi)
