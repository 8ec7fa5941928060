"""Readings of contacts: resultant, centre, moment, touching places, and where the contact of a beam begins and ends.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
F_i, d_i force of the place i of a zone, distance from the outermost place, ascending
q        contact force per length in the zone
P        force at the zone's end
d        distance of a joint's border inside the zone from the outermost place
x        distance of the zone's end from that border
=======  ====================================================================================

A zone ends in a force P, with q behind.  Forces act at joints, so that the outermost joints share P and show neither P
nor the end.  The beam away from the end feels only the resultant force and moment of the outermost m joints,

    Σ F_i = P + q x,    Σ F_i (d − d_i) = P x + q x²/2.

With q from the joints further in,

    P² = (Σ F_i)² − 2 q Σ F_i (d − d_i),    x = 2 Σ F_i (d − d_i)/(Σ F_i + P).

On ``wrapped`` the end is right to 4e-3 links in zones of more than ten joints.  A moving place at the end of a zone is
the end.

Clamp and contact share the force of a zone beside a weld, and a moment at an own pin is part of the contact: such a
zone begins at the beam's end.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import sqrt

import numpy as np

from cprbm.chain.rows import END, ends_of
from cprbm.results.forces import NO_FORCE, pin_moments
from cprbm.results.view import View
from cprbm_scene import FreeEnd
from cprbm_scene.answer import Array, ContactState, PointForces, frozen_array
from cprbm_scene.statement import EdgeContact
from cprbm_scene.stations import contact_states

ZONE = 3
"""Closed joints from which a contact has a length: two neighbours share the force of a point."""

JOINTS = 8
"""Outermost places that share P, m, in a zone of at least twice as many without a clamp."""

INNER = 3
"""Joints further in that tell q."""

APART = 10.0
"""Distance, in links, of two places of a zone; farther places are another zone."""

NEGLIGIBLE = 1e-4
"""Force of a joint, over the largest force, that errors of the discretisation leave on a flat edge."""


def contact_force(view: View, contact: str) -> float:
    """Magnitude of the resultant on the first beam."""
    return float(np.hypot(*sum((each.forces[0] for each in view.pressed[contact]), NO_FORCE)))


def contact_centre(view: View, contact: str) -> list[float]:
    """Arc length of the resultant on the first beam; empty for an open contact."""
    found = view.pressed[contact]
    weights = [float(np.hypot(*each.forces[0])) for each in found]
    return [float(np.average([each.arcs[0] for each in found], weights=weights))] if sum(weights) > 0.0 else []


def contact_moment(view: View, contact: str) -> float:
    """Moment on the beam about the first pin on the edge; zero without such a pin."""
    record = view.scene.contacts[contact]
    if not isinstance(record, EdgeContact):
        return 0.0
    for end, joint in zip(END, ends_of(view.scene, record.beam), strict=True):
        if not isinstance(joint, FreeEnd) and joint.joint == "pin" and view.plan.owners[joint.point] == record.body:
            about = view.end(record.beam, end)[1]
            arms = ((each.places[0] - about, each.forces[0]) for each in view.pressed[contact])
            held = sum(moment for _, _, moment in pin_moments(view, contact))
            return float(held + sum(arm[0] * force[1] - arm[1] * force[0] for arm, force in arms))
    return 0.0


def touching_places(view: View) -> dict[str, Array]:
    """Positions (k, 2), m, of the closed contacts."""
    units, found = view.mechanism.units, {}
    for name, pressed in view.pressed.items():
        places = [each.surface for each in pressed]
        places += [view.end(beam, end)[1] for beam, end, _ in pin_moments(view, name)]
        if places:
            found[name] = frozen_array(np.array(places) * units.length + units.origin)
    return found


def states_of_contacts(view: View, forces: PointForces, touching: Mapping[str, Array]) -> Mapping[str, ContactState]:
    """States of all contacts.

    The force of a contact beside a clamp is indeterminate, and beside a moment at an own pin.
    """
    units = view.mechanism.units
    states = contact_states(view.scene.contacts, forces, touching, (units.length, units.force))
    return {name: replace(state, indeterminate=_is_shared(view, name)) for name, state in states.items()}


def _is_shared(view: View, contact: str) -> bool:
    """True if a joint beside a weld or an own pin takes a part of the force."""
    found = view.pressed[contact]
    return any(each.share for each in found) or (bool(found) and any(True for _ in pin_moments(view, contact)))


def contact_ends(view: View, contact: str) -> list[float]:
    """Arc lengths on the first beam at which the first zone begins and the last zone ends; empty without contact."""
    geometry, found = view.solved.system.geometry, view.pressed[contact]
    pins = [view.end(beam, end)[0] for beam, end, _ in pin_moments(view, contact)]
    if geometry is None or (not found and not pins):
        return []
    heavy = NEGLIGIBLE * max((float(np.hypot(*each.forces[0])) for each in found), default=0.0)
    found = [each for each in found if np.hypot(*each.forces[0]) >= heavy]
    arcs = [each.arcs[0] for each in found] + pins
    low, high = min(arcs), max(arcs)
    pair = next(k for k, each in enumerate(geometry.pairs) if each.name == contact)
    of_joints = all(each.on_first or each.moves for each in found) and not geometry.pairs[pair].itself
    if (len(found) < ZONE and not pins) or not of_joints:
        return [low, high]
    length = float(geometry.curves[geometry.pairs[pair].first].arcs[-1])
    clamps = [0.0 if each.share > 0 else length for each in found if each.share]
    clamps += pins
    held = [*clamps, *(each.arcs[0] for each in found if each.moves)]
    span = float(geometry.arrays.span[geometry.arrays.first[geometry.pairs[pair].first] + 1])
    places = np.array([each.arcs[0] for each in found])
    forces = np.array([float(np.hypot(*each.forces[0])) for each in found])
    begin, end = min([low, *clamps]), max([high, *clamps])
    return [
        begin if begin in held else low + _inward(places - low, forces, span, even=end in clamps),
        end if end in held else high - _inward(high - places[::-1], forces[::-1], span, even=begin in clamps),
    ]


def _inward(apart: Array, forces: Array, span: float, *, even: bool) -> float:
    """Distance of the zone's end from the outermost place, into the zone.

    Args:
        apart: d_i, ascending.
        forces: F_i.
        span: length of a link.
        even: whether a clamp holds the other end of the zone, with even forces beside.
    """
    count = int(np.argmax(np.append(np.diff(apart) > APART * span, True))) + 1
    if count < ZONE:
        return 0.0
    m = min(JOINTS, max(1, count - INNER) if even else count // 2)
    border = 0.5 * float(apart[m - 1] + apart[m])
    q = float(forces[m : max(m + 1, min(m + INNER, count if even else count - m))].mean()) / span
    force, moment = float(forces[:m].sum()), float(forces[:m] @ (border - apart[:m]))
    square = force * force - 2.0 * q * moment
    return border - 2.0 * moment / (force + sqrt(square)) if square > 0.0 else 0.0
