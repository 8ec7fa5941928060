"""Internal forces of a beam, from the forces on the part before a cut.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        arc length of the cut, x its position on the deformed neutral line
F_i, x_i forces on the part before the cut and their positions; M_i moments
n, M     force and moment of the part beyond the cut
α, θ     angle of the neutral line's tangent, angle of the section's normal
=======  ====================================================================================

    n = −Σ F_i,    M = −Σ [(x_i − x) × F_i + M_i],    N = n·e(α),    Q = n·e′(α).

Equilibrium gives n and M at every place, whatever the section, with all kinks and jumps.  A distributed load q adds
q (c − a) and q ∫ x ds from the load's begin a to c, the nearer of the load's end and the cut.
With shear α differs from θ by the angle of (1 + N/EA, Q/GA_s); in the other theories α = θ.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from cprbm.results.forces import all_forces
from cprbm.results.view import View
from cprbm_scene.answer import Array, BeamState, PointForce, frozen_array
from cprbm_scene.statement import BeamForce, BeamMoment, DistributedLoad


class Cuts(NamedTuple):
    """Cuts of a beam at the samples: N, Q, M, α and θ (k,).

    Cuts at a load are limits from the end's side, cuts at both ends limits from inside.
    """

    N: Array
    Q: Array
    M: Array
    angle: Array
    section: Array


class Statics:
    """All forces of a state, and the cuts of the beams.

    Attributes:
        view: the state.
        forces: on beams and on bodies, fixed bodies included; loads excluded.
    """

    def __init__(self, view: View) -> None:
        self.view = view
        self.forces = tuple(all_forces(view))
        self._cuts = dict[str, Cuts]()

    def cuts(self, beam: str) -> Cuts:
        """Cuts of a beam at its samples."""
        if beam not in self._cuts:
            self._cuts[beam] = self._cut(beam)
        return self._cuts[beam]

    def state(self, beam: str) -> BeamState:
        """Internal forces at the start, the joints and the end of a beam, SI."""
        units, samples, cuts = self.view.mechanism.units, self.view.plan.samples[beam], self.cuts(beam)
        at, chain = samples.nodes, samples.chain
        columns = (
            chain.arcs * units.length,
            *(self.view.lines[beam][at] * units.length + units.origin).T,
            cuts.angle[at],
            cuts.section[at],
            cuts.N[at] * units.force,
            cuts.Q[at] * units.force,
            cuts.M[at] * units.moment,
            chain.borders * units.length,
        )
        return BeamState(*map(frozen_array, columns))

    def bending_stress(self, beam: str, points: int) -> Array:
        """Signed stress (points,) of bending at equal steps of the arc length, Pa."""
        samples, units = self.view.plan.samples[beam], self.view.mechanism.units
        at = samples.of_probe[points]
        return np.asarray(samples.stress[at] * self.cuts(beam).M[at] * units.moment / units.length**3)

    def combined_stress(self, beam: str, points: int) -> Array:
        """Largest magnitude (points,) of the stress of bending and normal force together, Pa."""
        samples, units = self.view.plan.samples[beam], self.view.mechanism.units
        at = samples.of_probe[points]
        normal = np.abs(self.cuts(beam).N[at] / samples.area[at]) * units.force / units.length**2
        return np.asarray(np.abs(self.bending_stress(beam, points)) + normal)

    def _cut(self, beam: str) -> Cuts:
        view, samples, units = self.view, self.view.plan.samples[beam], self.view.mechanism.units
        s, places, length = samples.s[:, None], view.lines[beam], samples.chain.length
        acting = [each for each in (*self.forces, *_point_loads(view, beam)) if each.target == beam]
        n, M = np.zeros((len(s), 2)), np.zeros(len(s))
        if acting:
            _, _, at, where, force, moment = map(np.array, zip(*acting, strict=True))
            before = (s >= at) & ((s < length) | (at < length))
            n, M = -(before @ force), -(before * (_cross(where - places[:, None], force) + moment)).sum(axis=1)
        for name, load in view.scene.loads.items():
            if isinstance(load, DistributedLoad) and load.beam == beam:
                span, integral = self._carried(load)
                q = view.loads.get(name, 0.0) * np.array(load.direction) / np.hypot(*load.direction)
                q *= units.length / units.force
                n, M = n - span[:, None] * q, M - _cross(integral - span[:, None] * places, q)
        section = view.angles(beam)
        angle = section
        if view.scene.theory == "shear":
            N, Q = _turned(n, section)
            angle = section + np.arctan2(Q / samples.shearing, 1.0 + N / (samples.chain.section.young * samples.area))
        return Cuts(*_turned(n, angle), M, angle, section)

    def _carried(self, load: DistributedLoad) -> tuple[Array, Array]:
        """Length (k,) of a distributed load before the cuts, and the integral (k, 2) of the position there."""
        samples = self.view.plan.samples[load.beam]
        begin, end = (fraction * samples.chain.length for fraction in load.along)
        until = np.clip(samples.s, begin, end)
        integral = samples.chain.line.integral(self.view.nodes(load.beam), np.append(until, begin))
        return until - begin, integral[:-1] - integral[-1]


def _point_loads(view: View, beam: str) -> Iterator[PointForce]:
    """Loads at places of a beam."""
    units = view.mechanism.units
    for name, load in view.scene.loads.items():
        value = view.loads.get(name, 0.0)
        if value == 0.0 or not isinstance(load, BeamForce | BeamMoment) or load.beam != beam:
            continue
        at = load.at * view.chain(beam).length
        place = view.chain(beam).line.place(view.nodes(beam), np.array([at]))[0]
        if isinstance(load, BeamMoment):
            yield PointForce(name, beam, at, place, np.zeros(2), value / units.moment)
        else:
            force = value / units.force * np.array(load.direction) / np.hypot(*load.direction)
            yield PointForce(name, beam, at, place, force, 0.0)


def _turned(n: Array, angle: Array) -> tuple[Array, Array]:
    """Components (k,) of forces (k, 2) along and across directions at the angles (k,)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * n[:, 0] + sin * n[:, 1], cos * n[:, 1] - sin * n[:, 0]


def _cross(arms: Array, force: Array) -> Array:
    """Moments (...) of forces (..., 2) at the ``arms`` (..., 2)."""
    return np.asarray(arms[..., 0] * force[..., 1] - arms[..., 1] * force[..., 0])
