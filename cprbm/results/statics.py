"""Forces of joints, slides, pivots, drives, pins, stops and contacts, and the internal forces of beams.

A row of the form f exerts −μ ∂f/∂z.  The internal forces follow from the forces on the part before a cut.
Forces are in the mechanism's units here.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
s        arc length of the cut, x its position on the deformed neutral line
F_i, x_i forces on the part before the cut and their positions; M_i moments
n, M     force and moment of the part beyond the cut
α, θ     angle of the neutral line's tangent, angle of the section's normal
F, h     normal force of a joint in a contact zone, distance of the joints
M̃        moment of the pressure in a contact zone, M of the forces at joints
=======  ====================================================================================

    n = −Σ F_i,    M = −Σ [(x_i − x) × F_i + M_i],    N = n·e(α),    Q = n·e′(α).

Equilibrium gives n and M at every place, whatever the section, with all kinks and jumps.  A distributed load q adds
q (c − a) and q ∫ x ds from the load's begin a to c, the nearer of the load's end and the cut.
With shear α differs from θ by the angle of (1 + N/EA, Q/GA_s); in the other theories α = θ.

In a contact zone a pressure F/h acts instead of the forces at joints, under which M has a kink at every joint.  A joint
turns by the mean of the moment over one link, the same mean for both: M̃ = M + F h/12 at a joint.  In a zone other
loads balance the pressure, so that M̃ is straight between two joints.  M̃ is M at the outermost forces, and at the end of
the beam beside an outermost joint.
"""

from collections.abc import Iterator
from functools import cache
from math import nan
from typing import NamedTuple

import numpy as np

from cprbm.chain import AXES, END, ends_of, unit_direction
from cprbm.contact import Geometry
from cprbm.equilibrium import contact_terms
from cprbm.results.view import View
from cprbm_scene import BeamContact, FreeEnd
from cprbm_scene.answer import Array, BeamState, PointForce, frozen_array
from cprbm_scene.statement import (
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    DistributedLoad,
    SlidingBody,
    TurningBody,
)

NO_FORCE = np.zeros(2)

APART, SHORT = 2, 4
"""Links between two closed joints of one zone, since near an end of the zone the spline opens single joints; closed
joints of a short zone, such as beside an own pin, in which the pressure changes from joint to joint."""


def stop_moment(view: View, name: str) -> float:
    """Moment of a stop on its beam."""
    return view.multipliers.get(f"{name}.most", 0.0) - view.multipliers.get(f"{name}.least", 0.0)


def pin_moments(view: View, contact: str) -> Iterator[tuple[str, str, float]]:
    """Moments of a contact on ends pinned on the edge: names of the beam and the end, moment."""
    rows = view.mechanism.rows
    for row, mu in zip(rows, view.z[len(view.z) - len(rows) :].tolist(), strict=True):
        if row.name == f"{contact}.pin" and mu != 0.0:
            beam, turning = view.scene.contacts[contact].beams[0], dict(row.form.linear)
            for end, index in zip(END, view.mechanism.beam_angles(beam)[[0, -1]].tolist(), strict=True):
                if index in turning:
                    yield beam, end, -mu * turning[index]


def _pull(view: View, row: str) -> Array:
    """Force (2,) on the first part of a joint or a pin, by its rows for x and y."""
    return -np.array([view.multipliers[f"{row}.{axis}"] for axis, _ in AXES])


def _joints(view: View) -> Iterator[PointForce]:
    for beam in view.scene.beams:
        for end, record in zip(END, ends_of(view.scene, beam), strict=True):
            if not isinstance(record, FreeEnd):
                force, moment = _pull(view, f"{beam}@{end}"), -view.multipliers.get(f"{beam}@{end}.turn", 0.0)
                yield from _at_end(view, record.point, beam, end, force, moment)


def _at_end(view: View, source: str, beam: str, end: str, force: Array, moment: float) -> Iterator[PointForce]:
    """Force and moment on a beam's end, and the same with the opposite sign on the body of the end's point."""
    joint = ends_of(view.scene, beam)[END.index(end)]
    assert not isinstance(joint, FreeEnd)
    s, place = view.end(beam, end)
    yield PointForce(source, beam, s, place, force, moment)
    yield PointForce(source, view.scene.body_of(joint.point), nan, place, -force, -moment)


def _guides(view: View) -> Iterator[PointForce]:
    for name, body in view.scene.bodies.items():
        if isinstance(body, TurningBody):
            yield PointForce(body.about, name, nan, view.place(body.about), _pull(view, f"{name}.pivot"), 0.0)
        elif isinstance(body, SlidingBody):
            along, place = unit_direction(body.along), view.place(body.pin or next(iter(body.points)))
            force = -view.multipliers[f"{name}.slide"] * np.array([-along[1], along[0]])
            yield PointForce(name, name, nan, place, force, -view.multipliers.get(f"{name}.level", 0.0))


def _drives(view: View) -> Iterator[PointForce]:
    for name, drive in view.scene.drives.items():
        if isinstance(drive, DisplacementDrive):
            force = -view.multipliers[name] * np.array(unit_direction(drive.direction))
            yield PointForce(name, view.scene.body_of(drive.point), nan, view.place(drive.point), force, 0.0)
        else:
            place = view.place(next(iter(view.scene.bodies[drive.body].points)))
            yield PointForce(name, drive.body, nan, place, NO_FORCE, -view.multipliers[name])


def _pins(view: View) -> Iterator[PointForce]:
    for name, pin in view.scene.pins.items():
        for point, sign in zip(pin.points, (1.0, -1.0), strict=True):
            yield PointForce(name, view.scene.body_of(point), nan, view.place(point), sign * _pull(view, name), 0.0)


def _stops(view: View) -> Iterator[PointForce]:
    for name, stop in view.scene.stops.items():
        if stop_moment(view, name) != 0.0:
            yield from _at_end(view, name, stop.beam, stop.end, NO_FORCE, stop_moment(view, name))


def _contacts(view: View) -> Iterator[PointForce]:
    """Forces of all contacts on beams and bodies, and moments at own pins."""
    geometry = view.solved.system.geometry
    for name, contact in view.scene.contacts.items():
        if geometry.law is not None and isinstance(contact, BeamContact):
            yield from _spread_forces(view, name, geometry)
            continue
        targets = (contact.beams[0], getattr(contact, "body", contact.beams[-1]))
        found = view.pressed[name]
        for arcs, places, forces in zip(found.arcs.tolist(), found.places, found.forces, strict=True):
            for target, s, place, force in zip(targets, arcs, places, forces, strict=True):
                yield PointForce(name, target, s if target in view.scene.beams else nan, place, force, 0.0)
        for beam, end, moment in pin_moments(view, name):
            yield from _at_end(view, name, beam, end, NO_FORCE, moment)


def _spread_forces(view: View, contact: str, geometry: Geometry) -> Iterator[PointForce]:
    """Forces on nodes and moments on links of both beams of a contact that a law measures."""
    contacts = view.solved.state.contacts
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    pull = contact_terms(geometry, view.z, contacts.places, contacts.pressing(pair))[1]
    for beam in view.scene.contacts[contact].beams:
        arcs, places = view.mechanism.chains[beam].arcs, view.nodes[beam]
        nodes, angles = view.mechanism.beam_nodes(beam), view.mechanism.beam_angles(beam)
        forces = -pull[np.column_stack([nodes, nodes + 1])]
        for node in np.flatnonzero(forces.any(axis=1)).tolist():
            yield PointForce(contact, beam, float(arcs[node]), places[node], forces[node], 0.0)
        for link in np.flatnonzero(pull[angles]).tolist():
            s, place = 0.5 * (arcs[link] + arcs[link + 1]), 0.5 * (places[link] + places[link + 1])
            yield PointForce(contact, beam, float(s), place, NO_FORCE, -float(pull[angles[link]]))


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
        cuts: function from a beam's name to the cuts at the samples.
    """

    def __init__(self, view: View) -> None:
        self.view = view
        self.forces = tuple(
            force for forces in (_joints, _guides, _drives, _pins, _stops, _contacts) for force in forces(view)
        )
        self.cuts = cache(self._cuts)

    def state(self, beam: str) -> BeamState:
        """Internal forces at the start, the joints and the end of a beam, SI."""
        units, samples, cuts = self.view.mechanism.units, self.view.samples[beam], self.cuts(beam)
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
        samples, units = self.view.samples[beam], self.view.mechanism.units
        at = samples.of_probe[points]
        return np.asarray(samples.stress[at] * self.cuts(beam).M[at] * units.moment / units.length**3)

    def combined_stress(self, beam: str, points: int) -> Array:
        """Largest magnitude (points,) of the stress of bending and normal force together, Pa."""
        samples, units = self.view.samples[beam], self.view.mechanism.units
        at = samples.of_probe[points]
        normal = np.abs(self.cuts(beam).N[at] / samples.area[at]) * units.force / units.length**2
        return np.asarray(np.abs(self.bending_stress(beam, points)) + normal)

    def _cuts(self, beam: str) -> Cuts:
        view, samples, units = self.view, self.view.samples[beam], self.view.mechanism.units
        s, places, length = samples.s[:, None], view.lines[beam], samples.chain.length
        acting = [each for each in (*self.forces, *_point_loads(view, beam)) if each.target == beam]
        n, M = np.zeros((len(s), 2)), np.zeros(len(s))
        if acting:
            _, _, at, where, force, moment = map(np.array, zip(*acting, strict=True))
            before = (s >= at) & ((s < length) | (at < length))
            n, M = -(before @ force), -(before * (cross(where - places[:, None], force) + moment)).sum(axis=1)
        for name, load in view.scene.loads.items():
            if isinstance(load, DistributedLoad) and load.beam == beam:
                span, integral = self._carried(load)
                q = view.loads.get(name, 0.0) * units.length / units.force * np.array(unit_direction(load.direction))
                n, M = n - span[:, None] * q, M - cross(integral - span[:, None] * places, q)
        angle = section = view.angles(beam)
        M = self._in_zones(beam, M)
        if view.scene.theory == "shear":
            N, Q = _turned(n, section)
            angle = section + np.arctan2(Q / samples.shearing, 1.0 + N / (samples.chain.section.young * samples.area))
        return Cuts(*_turned(n, angle), M, angle, section)

    def _in_zones(self, beam: str, M: Array) -> Array:
        """M̃ (k,) at the samples of a beam, from M (k,): of contacts with forces at joints of the beam."""
        view, samples = self.view, self.view.samples[beam]
        s, at, arcs, angles = samples.s, samples.nodes, samples.chain.arcs, view.angles(beam)[samples.nodes]
        h, normals = arcs[2] - arcs[1], np.stack([-np.sin(angles), np.cos(angles)], axis=1)
        for pair in view.solved.system.geometry.pairs:
            if view.scene.contacts[pair.name].beams[0] == beam and samples.chain.corrected and not pair.itself:
                found, turning = view.pressed[pair.name], M[at].copy()
                joints = ~found.moves & found.on_first
                zones = np.searchsorted(arcs, found.arcs[joints, 0] - 0.25 * h)
                turning[zones] += h / 12.0 * (found.forces[joints, 0] * normals[zones]).sum(axis=1)
                for zone in np.split(zones, np.flatnonzero(np.diff(zones) > APART) + 1):
                    if len(zone) > SHORT:
                        # a zone up to the first or last joint reaches to the end of the beam
                        low, high = zone[0] - (zone[0] == 1), zone[-1] + (zone[-1] == len(arcs) - 2)
                        values = np.concatenate([M[at][[low]], turning[low + 1 : high], M[at][[high]]])
                        straight = np.interp(s, arcs[low : high + 1], values)
                        M = np.where((s >= arcs[low]) & (s <= arcs[high]), straight, M)
        return M

    def _carried(self, load: DistributedLoad) -> tuple[Array, Array]:
        """Length (k,) of a distributed load before the cuts, and the integral (k, 2) of the position there."""
        samples = self.view.samples[load.beam]
        begin, end = (fraction * samples.chain.length for fraction in load.along)
        until, chain = np.clip(samples.s, begin, end), samples.chain
        places = np.unique([begin, *until, *chain.arcs[(chain.arcs > begin) & (chain.arcs < end)]])
        integral = np.cumsum(chain.line.integrals(places) @ self.view.nodes[load.beam], axis=0)
        return until - begin, np.concatenate([np.zeros((1, 2)), integral])[np.searchsorted(places, until)]


def _point_loads(view: View, beam: str) -> Iterator[PointForce]:
    """Loads at places of a beam."""
    units = view.mechanism.units
    for name, load in view.scene.loads.items():
        value = view.loads.get(name, 0.0)
        if value == 0.0 or not isinstance(load, BeamForce | BeamMoment) or load.beam != beam:
            continue
        at, line = load.at * view.mechanism.chains[beam].length, view.mechanism.chains[beam].line
        place = (line.weights(np.array([at])) @ view.nodes[beam])[0]
        moment = value / units.moment if isinstance(load, BeamMoment) else 0.0
        force = (
            value / units.force * np.array(unit_direction(load.direction)) if isinstance(load, BeamForce) else NO_FORCE
        )
        yield PointForce(name, beam, at, place, force, moment)


def _turned(n: Array, angle: Array) -> tuple[Array, Array]:
    """Components (k,) of forces (k, 2) along and across directions at the angles (k,)."""
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * n[:, 0] + sin * n[:, 1], cos * n[:, 1] - sin * n[:, 0]


def cross(arms: Array, force: Array) -> Array:
    """Moments (...) of forces (..., 2) at the ``arms`` (..., 2)."""
    return np.asarray(arms[..., 0] * force[..., 1] - arms[..., 1] * force[..., 0])
