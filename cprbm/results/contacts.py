"""Forces and places of contacts.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F, N     force of a closed place, unit normal from the foot to the place
C_A, C_B place on the first curve of a row, foot on the second; F N acts at C_A, −F N at C_B
=======  ====================================================================================
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import nan
from typing import NamedTuple

import numpy as np

from cprbm.chain.rows import END, ends_of
from cprbm.contact import STENCIL, Geometry, Places, curve_point, gap_frame
from cprbm.equilibrium.columns import contact_terms
from cprbm.results.view import View
from cprbm_scene import FreeEnd
from cprbm_scene.answer import Array, ContactState, PointForce, PointForces, frozen_array
from cprbm_scene.statement import EdgeContact
from cprbm_scene.stations import contact_states

NO_FORCE = np.zeros(2)


class Pressed(NamedTuple):
    """A closed place, in units: ``arcs`` on both curves of the pair, ``places`` and ``forces`` there.

    ``surface`` is the position between both neutral lines where the curves touch; ``moves`` marks a point contact;
    ``share`` is the offset of the place with the same force, beside a weld; ``on_first``: on the pair's first curve.
    """

    arcs: tuple[float, float]
    places: tuple[Array, Array]
    forces: tuple[Array, Array]
    surface: Array
    moves: bool
    share: int
    on_first: bool


class PinMoment(NamedTuple):
    """Moment of a contact on the end of a beam that is pinned on the edge."""

    beam: str
    end: str
    moment: float


def pressed(view: View, contact: str) -> list[Pressed]:
    """Closed places of a contact, ascending along the first beam."""
    geometry, contacts = view.solved.system.geometry, view.solved.state.contacts
    if geometry is None or contacts is None:
        return []
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    found = [_pressed(view, geometry, contacts.places, k) for k in np.flatnonzero(contacts.pressing(pair)).tolist()]
    return sorted(found, key=lambda each: each.arcs[0])


def _pressed(view: View, geometry: Geometry, places: Places, k: int) -> Pressed:
    arrays, z = geometry.arrays, view.z
    frame = gap_frame(z, arrays, places, k, np.empty((4, 2, STENCIL)))
    normal = np.array([frame.nx, frame.ny])
    piece, foot = int(places.piece[k]), int(places.foot[k])
    xi, eta = float(places.xi[k]), float(places.eta[k])
    arcs = tuple(float(arrays.arc[p] + at * arrays.span[p]) for p, at in ((piece, xi), (foot, eta)))
    weights = np.empty((2, STENCIL))
    at = tuple(np.array(curve_point(z, arrays, p, t, 0, weights)) for p, t in ((piece, xi), (foot, eta)))
    force = float(places.force[k]) * normal
    law = geometry.law
    if law is not None and law.measures(places)[k]:
        force = law.force(z, places, k)
        normal = force / np.hypot(*force) if force.any() else normal
    surface = at[0] - normal * (arrays.thickness[piece] + xi * arrays.thickening[piece])
    on_first = places.curve[k] == geometry.pairs[places.pair[k]].first
    # of a beam with itself the smaller arc length counts as the first
    ahead = arcs[0] <= arcs[1] if places.curve[k] == places.other[k] else on_first
    i, j = (0, 1) if ahead else (1, 0)
    forces = (force, -force)
    moves, share = bool(places.moves[k]), int(places.shares[k])
    return Pressed((arcs[i], arcs[j]), (at[i], at[j]), (forces[i], forces[j]), surface, moves, share, bool(on_first))


def pin_moments(view: View, contact: str) -> Iterator[PinMoment]:
    """Moments of a contact on ends pinned on the edge."""
    record = view.scene.contacts[contact]
    if not isinstance(record, EdgeContact):
        return
    angles = view.mechanism.beam_angles(record.beam)
    first = view.solved.system.rows.first
    for number, row in enumerate(view.mechanism.rows):
        mu = float(view.z[first + number])
        if row.name == f"{contact}.pin" and mu != 0.0:
            turning = dict(row.form.linear)
            for end, index in zip(END, angles[[0, -1]].tolist(), strict=True):
                if index in turning:
                    yield PinMoment(record.beam, end, -mu * turning[index])


def forces_of_contacts(view: View) -> Iterator[PointForce]:
    """Forces of all contacts on beams and bodies, and moments at own pins."""
    spread = frozenset[str]()
    geometry, contacts = view.solved.system.geometry, view.solved.state.contacts
    if geometry is not None and geometry.law is not None and contacts is not None:
        measured = geometry.law.measures(contacts.places)
        spread = frozenset(geometry.pairs[pair].name for pair in contacts.places.pair[measured].tolist())
    for name, contact in view.scene.contacts.items():
        if name in spread:
            yield from _spread_forces(view, name)
            continue
        targets = (contact.beams[0], getattr(contact, "body", contact.beams[-1]))
        for each in pressed(view, name):
            for target, s, place, force in zip(targets, each.arcs, each.places, each.forces, strict=True):
                yield PointForce(name, target, s if target in view.scene.beams else nan, place, force, 0.0)
        for pin in pin_moments(view, name):
            joint = ends_of(view.scene, pin.beam)[END.index(pin.end)]
            assert not isinstance(joint, FreeEnd)
            s, place = view.end(pin.beam, pin.end)
            yield PointForce(name, pin.beam, s, place, NO_FORCE, pin.moment)
            yield PointForce(name, view.scene.body_of(joint.point), nan, place, NO_FORCE, -pin.moment)


def _spread_forces(view: View, contact: str) -> Iterator[PointForce]:
    """Forces on nodes and moments on links of both beams of a contact that a law measures."""
    geometry, contacts = view.solved.system.geometry, view.solved.state.contacts
    assert geometry is not None
    assert contacts is not None
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    pull = contact_terms(geometry, view.z, contacts.places, contacts.pressing(pair))[1]
    for beam in view.scene.contacts[contact].beams:
        arcs, places = view.chain(beam).arcs, view.nodes(beam)
        nodes, angles = view.mechanism.beam_nodes(beam), view.mechanism.beam_angles(beam)
        forces = -pull[np.column_stack([nodes, nodes + 1])]
        for node in np.flatnonzero(forces.any(axis=1)).tolist():
            yield PointForce(contact, beam, float(arcs[node]), places[node], forces[node], 0.0)
        for link in np.flatnonzero(pull[angles]).tolist():
            s, place = 0.5 * (arcs[link] + arcs[link + 1]), 0.5 * (places[link] + places[link + 1])
            yield PointForce(contact, beam, float(s), place, NO_FORCE, -float(pull[angles[link]]))


def contact_force(view: View, contact: str) -> float:
    """Magnitude of the resultant on the first beam."""
    return float(np.hypot(*sum((each.forces[0] for each in pressed(view, contact)), NO_FORCE)))


def contact_centre(view: View, contact: str) -> list[float]:
    """Arc length of the resultant on the first beam; empty for an open contact."""
    found = pressed(view, contact)
    weights = [float(np.hypot(*each.forces[0])) for each in found]
    return [float(np.average([each.arcs[0] for each in found], weights=weights))] if sum(weights) > 0.0 else []


def contact_moment(view: View, contact: str) -> float:
    """Moment on the beam about the first pin on the edge; zero without such a pin."""
    record = view.scene.contacts[contact]
    if not isinstance(record, EdgeContact):
        return 0.0
    for end, joint in zip(END, ends_of(view.scene, record.beam), strict=True):
        if not isinstance(joint, FreeEnd) and joint.joint == "pin" and view.scene.body_of(joint.point) == record.body:
            about = view.end(record.beam, end)[1]
            arms = ((each.places[0] - about, each.forces[0]) for each in pressed(view, contact))
            held = sum(pin.moment for pin in pin_moments(view, contact))
            return float(held + sum(arm[0] * force[1] - arm[1] * force[0] for arm, force in arms))
    return 0.0


def touching_places(view: View) -> dict[str, Array]:
    """Positions (k, 2), m, of the closed contacts."""
    units, found = view.mechanism.units, {}
    for name in view.scene.contacts:
        places = [each.surface for each in pressed(view, name)]
        places += [view.end(pin.beam, pin.end)[1] for pin in pin_moments(view, name)]
        if places:
            found[name] = frozen_array(np.array(places) * units.length + units.origin)
    return found


def states_of_contacts(view: View, forces: PointForces, touching: Mapping[str, Array]) -> Mapping[str, ContactState]:
    """States of all contacts.

    A force that a clamp, or a moment at an own pin, shares with the contact beside it is indeterminate.
    """
    units = view.mechanism.units
    states = contact_states(view.scene.contacts, forces, touching, (units.length, units.force))
    shared = {name: _is_shared(view, name) for name in view.scene.contacts}
    return {name: replace(state, indeterminate=shared[name]) for name, state in states.items()}


def _is_shared(view: View, contact: str) -> bool:
    """True if a joint beside a weld or an own pin takes a part of the force."""
    found = pressed(view, contact)
    return any(each.share for each in found) or (bool(found) and any(True for _ in pin_moments(view, contact)))
