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
q (c − a) and q ∫ x ds from its begin a to c, the nearer of its end and the cut.
With shear α differs from θ by the angle of (1 + N/EA, Q/GA_s); in the other theories α = θ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.results.contacts import forces_of_contacts
from cprbm.results.forces import end_force, stop_moment
from cprbm.results.view import View
from cprbm_scene.answer import Array, BeamState, PointForce, frozen_array
from cprbm_scene.statement import BeamForce, BeamMoment, DistributedLoad


@dataclass(frozen=True, eq=False)
class Cuts:
    """Cuts of one beam at arc lengths ``s`` (k,): ``places`` and ``n`` (k, 2); ``M``, ``angle``, ``section`` (k,)."""

    s: Array
    places: Array
    n: Array
    M: Array
    angle: Array
    section: Array

    @property
    def N(self) -> Array:
        """Normal force along the tangent."""
        return np.asarray(np.cos(self.angle) * self.n[:, 0] + np.sin(self.angle) * self.n[:, 1])

    @property
    def Q(self) -> Array:
        """Shear force along the left normal of the tangent."""
        return np.asarray(np.cos(self.angle) * self.n[:, 1] - np.sin(self.angle) * self.n[:, 0])


def cuts_of(view: View, beam: str, s: Array) -> Cuts:
    """Cuts of a beam; at a load they are limits from the end's side, at both ends limits from inside."""
    chain = view.chain(beam)
    places = view.line(beam, s)
    force, moment = end_force(view, beam, "start")
    moment += sum(
        stop_moment(view, name) for name, stop in view.scene.stops.items() if stop.beam == beam and stop.end == "start"
    )
    n = np.tile(-force, (len(s), 1))
    M = -moment - _cross(view.nodes(beam)[0] - places, force)
    for name, load in view.scene.loads.items():
        value = view.loads.get(name, 0.0)
        if value == 0.0 or getattr(load, "beam", None) != beam:
            continue
        if isinstance(load, DistributedLoad):
            more = _distributed(view, load, value, s, places)
        else:
            assert isinstance(load, BeamForce | BeamMoment)
            more = _at_place(view, load, value, s, places)
        n, M = n - more[0], M - more[1]
    for each in forces_of_contacts(view):
        if each.target == beam:
            more = _point(chain.length, each, s, places)
            n, M = n - more[0], M - more[1]
    section = view.angles(beam, s)
    angle = section
    if view.shearing:
        modulus, nu = chain.section.young, view.scene.materials[view.scene.beams[beam].material].poisson_ratio
        area = chain.section.area(s)
        shearing = 5.0 / 6.0 * area * 0.5 * modulus / (1.0 + nu)
        cos, sin = np.cos(section), np.sin(section)
        N, Q = cos * n[:, 0] + sin * n[:, 1], cos * n[:, 1] - sin * n[:, 0]
        angle = section + np.arctan2(Q / shearing, 1.0 + N / (modulus * area))
    return Cuts(s, places, n, M, angle, section)


def beam_state(view: View, beam: str) -> BeamState:
    """Internal forces at the start, the joints and the end of a beam, SI."""
    units, chain = view.mechanism.units, view.chain(beam)
    cuts = cuts_of(view, beam, chain.arcs)
    columns = (
        cuts.s * units.length,
        *(cuts.places * units.length + units.origin).T,
        cuts.angle,
        cuts.section,
        cuts.N * units.force,
        cuts.Q * units.force,
        cuts.M * units.moment,
        chain.borders * units.length,
    )
    return BeamState(*map(frozen_array, columns))


def bending_stress(view: View, beam: str, points: int) -> Array:
    """Signed stress (points,) of bending at equal steps of the arc length, Pa."""
    chain, units = view.chain(beam), view.mechanism.units
    cuts = cuts_of(view, beam, np.linspace(0.0, chain.length, points))
    curvature = cuts.M / chain.section.rigidity(cuts.s)
    stress = 0.5 * chain.section.young * chain.section.thickness(cuts.s) * curvature
    return np.asarray(stress * units.moment / units.length**3)


def combined_stress(view: View, beam: str, points: int) -> Array:
    """Largest magnitude (points,) of the stress of bending and normal force together, Pa."""
    chain, units = view.chain(beam), view.mechanism.units
    cuts = cuts_of(view, beam, np.linspace(0.0, chain.length, points))
    normal = np.abs(cuts.N / chain.section.area(cuts.s)) * units.force / units.length**2
    return np.asarray(np.abs(bending_stress(view, beam, points)) + normal)


def _at_place(view: View, load: BeamForce | BeamMoment, value: float, s: Array, places: Array) -> tuple[Array, Array]:
    """Force (k, 2) and moment (k,) about the cuts of a load at one place."""
    length, units = view.chain(load.beam).length, view.mechanism.units
    at = load.at * length
    force, moment = np.zeros(2), 0.0
    if isinstance(load, BeamMoment):
        moment = value / units.moment
    else:
        force = value / units.force * np.array(load.direction) / np.hypot(*load.direction)
    place = view.line(load.beam, np.array([at]))[0]
    return _point(length, PointForce("", load.beam, at, place, force, moment), s, places)


def _point(length: float, acting: PointForce, s: Array, places: Array) -> tuple[Array, Array]:
    """Force (k, 2) and moment (k,) about the cuts of a force and a moment at one place of a beam."""
    before = (s >= acting.s) & ((s < length) | (acting.s < length))
    return before[:, None] * acting.force, before * (_cross(acting.place - places, acting.force) + acting.moment)


def _distributed(view: View, load: DistributedLoad, value: float, s: Array, places: Array) -> tuple[Array, Array]:
    """Force (k, 2) and moment (k,) about the cuts of a distributed load."""
    chain, units = view.chain(load.beam), view.mechanism.units
    begin, end = load.along[0] * chain.length, load.along[1] * chain.length
    until = np.clip(s, begin, end)
    direction = np.array(load.direction) / np.hypot(*load.direction)
    q = value * units.length / units.force * direction
    integral = chain.line.integral(view.nodes(load.beam), np.append(until, begin))
    span = until - begin
    return span[:, None] * q, _cross(integral[:-1] - integral[-1] - span[:, None] * places, q)


def _cross(arms: Array, force: Array) -> Array:
    """Moments (k,) of a force at the ``arms`` (k, 2)."""
    return np.asarray(arms[:, 0] * force[1] - arms[:, 1] * force[0])
