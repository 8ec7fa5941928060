"""Contact at a place: rows, and forces on beams and bodies.

=======  ==================================================================================================
symbol   meaning
=======  ==================================================================================================
r, τ, n  position on a neutral line, its unit tangent and left-hand normal
P, e     the contact's force, and the unit normal along which it acts on ``beam``
d        distance of two neutral lines in contact, half of both thicknesses
o, R, T  a circle's centre and radius; half the beam's thickness, with derivative T'
=======  ==================================================================================================

Two beams, the second touched between its ends:

    τ2·(r1 − r2) = 0,   e·(r1 − r2) = d,   and between the ends of the first τ1 × τ2 = 0,   e = ±n2             (1)

A circle:

    |r − o| = R + T,   and between the beam's ends e·τ = T',   e = (r − o)/|r − o|                             (2)

The internal force jumps by F(s+) = F(s−) − P e. At a joined end the force acts on the body, and at a free end it is
the internal force there.
"""

from collections.abc import Mapping

import numpy as np

from cprbm_scene import CircleContact
from elastica_reference.evaluation import Columns, EndAction, Evaluation
from elastica_reference.layout import Layout
from elastica_reference.structure import Meeting, Resting, Structure, Wrap


def touch_points(
    out: Evaluation, structure: Structure, where: Layout, z: Columns, at_ends: Mapping[tuple[str, str], Columns]
) -> None:
    """Add the rows of all contacts at places, and the force rows of all beams' ends.

    ``at_ends`` are loads (2, K) on ends, by beam and ``start`` or ``end``.
    """
    pushed = dict(at_ends)
    for name, touch in structure.touches.items():
        if isinstance(touch, Wrap):
            continue
        P = z[where.forces[name]]
        if isinstance(touch, Meeting):
            force = P * _two_beams(out, structure, touch)
            _jump(out, structure, name, touch.onto, -force)
        else:
            normal = _circle(out, structure, where, touch, z)
            force = P * normal
            contact = out.model.scene.contacts[name]
            assert isinstance(contact, CircleContact)
            out.act(contact.body, out.centres[name], -force)
        out.resultants[name] = force
        if touch.at is None:
            _jump(out, structure, name, touch.beam, force)
        else:
            key = (touch.beam, "start" if touch.at == 0.0 else "end")
            pushed[key] = pushed[key] + force if key in pushed else force
    _release_ends(out, pushed)


def _two_beams(out: Evaluation, structure: Structure, touch: Meeting) -> Columns:
    """Rows (1); returns e (2, K)."""
    state, other = _state(out, structure, touch), _state_between(out, structure, touch.contact, touch.onto)
    along = np.stack([np.cos(other[2]), np.sin(other[2])])
    normal = touch.side * np.stack([-along[1], along[0]])
    between = state[:2] - other[:2]
    out.rows.append(along[0] * between[0] + along[1] * between[1])
    out.rows.append(normal[0] * between[0] + normal[1] * between[1] - touch.apart)
    if touch.at is None:
        out.rows.append(np.sin(other[2] - state[2]))
    return normal


def _circle(out: Evaluation, structure: Structure, where: Layout, touch: Resting, z: Columns) -> Columns:
    """Rows (2); returns e (2, K)."""
    contact, strip = out.model.scene.contacts[touch.contact], out.model.strips[touch.beam]
    assert isinstance(contact, CircleContact)
    state = _state(out, structure, touch)
    between = state[:2] - out.centres[touch.contact]
    distance = np.sqrt(between[0] ** 2 + between[1] ** 2)
    normal = between / distance
    half, slope = np.zeros_like(distance), 0.0
    if contact.thick:
        s = np.full_like(distance, touch.at) if touch.at is not None else z[where.places[touch.contact, touch.beam]]
        at = float(s[0].real)
        slope = strip.half_thickness_slope(at)
        half = strip.half_thickness(np.array([at])) + slope * (s - at)
    out.rows.append(distance - contact.radius / out.model.unit_length - half)
    if touch.at is None:
        out.rows.append(normal[0] * np.cos(state[2]) + normal[1] * np.sin(state[2]) - slope)
    return np.asarray(normal)


def _state(out: Evaluation, structure: Structure, touch: Meeting | Resting) -> Columns:
    """(x, y, θ, m) at the place of contact of the first beam."""
    if touch.at is None:
        return _state_between(out, structure, touch.contact, touch.beam)
    parts = out.parts[touch.beam]
    return parts[0].start[:4] if touch.at == 0.0 else parts[-1].end


def _state_between(out: Evaluation, structure: Structure, contact: str, beam: str) -> Columns:
    return out.parts[beam][structure.piece_beyond(beam, contact)].start[:4]


def _jump(out: Evaluation, structure: Structure, contact: str, beam: str, force: Columns) -> None:
    """Rows for the jump of the internal force by a contact force (2, K) between a beam's ends."""
    k = structure.piece_beyond(beam, contact)
    out.rows += list(out.parts[beam][k].force - out.parts[beam][k - 1].end_force + force)


def _release_ends(out: Evaluation, pushed: dict[tuple[str, str], Columns]) -> None:
    """Transfer the forces of beams and contacts at ends to the bodies; a free end is in equilibrium."""
    for (beam, which), action in out.ends.items():
        strip = out.model.strips[beam]
        end = strip.start if which == "start" else strip.end
        force = action.force + pushed[beam, which] if (beam, which) in pushed else action.force
        if end.point is None:
            out.rows += list(force)
        else:
            out.act(out.model.scene.body_of(end.point), action.place, force, action.moment)
            out.ends[beam, which] = EndAction(action.place, force, action.moment)
