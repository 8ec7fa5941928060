"""Contacts of an answer: no penetration, forces where surfaces touch, and forces that push along the normal.

======  =================================================================================================
symbol  meaning
======  =================================================================================================
x       place of the beam's neutral line
d       signed distance of x from the surface of the partner: another beam, another lap, or a rigid edge
n       unit normal of the partner at its closest point, towards x
a       distance of x from its own surface: half of the thickness, zero of a line without thickness
F       contact force on the beam
======  =================================================================================================

Beams are neutral lines with a thickness and round ends.  A contact holds where d >= a everywhere, d = a where a force
acts, and F·n = |F|.  All distances carry the errors of fine polylines and of the solvers' penalties.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import shapely

from comparisons.audit.state import Complex, StationState, unit
from comparisons.geometry import edge_places, is_free_on_the_left
from cprbm_scene.answer import Array
from cprbm_scene.contact_states import ACTIVE
from cprbm_scene.statement import (
    CircleContact,
    Contact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    SelfContact,
)

DEEP = 0.05
"""Largest penetration, and largest gap under a force, over the mean thickness; also of an undeclared contact."""

SUNK = 2e-3
"""The same of lines without thickness, over the longest beam."""

ALIGNED, LINE_ALIGNED = 0.98, 0.8
"""Least cosine of the angle between a contact force and the normal, of thick beams and of lines."""

FAR, TINY = 1e3, 1e-300
"""Place of a lap that does not exist, over the longest beam, and a length below all lengths, m."""

BEHIND = 0.2
"""Length of both sides behind an open edge, over the longest beam."""

GRAPH = 2001
"""Places of a rigid edge that is a function's graph."""

BESIDE = 3.0
"""Thicknesses beside an overlap at rest, such as a common joint, within which penetration is not judged."""

SMALL = 1e-6
"""Share of a contact's largest force below which places and directions of a force are not judged."""


def contacts(state: StationState) -> Iterator[str]:
    """Contacts that penetrate, press across a gap, pull or rub, and contacts without a state."""
    for name, contact in state.scene.contacts.items():
        if name not in state.station.contacts:
            yield f"{name} has no contact state"
        for on in dict.fromkeys(contact.beams):
            if contact.thick or isinstance(contact, RigidContact):  # a distance of lines has no sign
                yield from _penetration(state, name, on)
            yield from _pressing(state, name, on)


def _penetration(state: StationState, name: str, on: str) -> Iterator[str]:
    """The deepest penetration of a beam outside overlaps at rest."""
    contact, beam, s = state.scene.contacts[name], state.beams[on], state.beams[on].fine
    own, allowed = _surface(state, contact, on, s)
    gap = closest(state, contact, on, s)[0] - own
    if (gap >= -allowed).all():
        return
    at = s[closest(_at_rest(state), contact, on, s)[0] < own * (1.0 - 1e-6)]
    if at.size:
        behind = np.searchsorted(at, s)
        away = np.minimum(np.abs(s - at[np.maximum(behind - 1, 0)]), np.abs(at[np.minimum(behind, len(at) - 1)] - s))
        gap[away <= BESIDE * beam.beam.thickest] = np.inf
    worst = int(np.argmin(gap))
    if not gap[worst] >= -allowed[worst]:
        yield f"{on} penetrates its partner in {name} by {-gap[worst]:.2g} m at {s[worst]:.4g} m"


def _at_rest(state: StationState) -> StationState:
    """The beams and bodies of a station at rest."""
    beams = {name: beam.at_rest for name, beam in state.beams.items()}
    return replace(state, beams=beams, station=replace(state.station, bodies={}))


def _pressing(state: StationState, name: str, on: str) -> Iterator[str]:
    """Forces across a gap, and forces that pull or rub."""
    contact, forces = state.scene.contacts[name], state.on[on][state.on[on]["source"] == name]
    size = np.abs(forces["force"])
    forces = forces[size > max(SMALL * size.max(initial=0.0), ACTIVE * state.largest[0])]
    if not len(forces):
        return
    s, way = forces["s"], forces["force"] / np.abs(forces["force"])
    (own, allowed), (distance, normal) = _surface(state, contact, on, s), closest(state, contact, on, s)
    worst = int(np.argmax(np.abs(distance - own) - allowed))
    if not abs(distance - own)[worst] <= allowed[worst]:
        yield f"{name} presses {on} at {s[worst]:.4g} m across a gap of {(distance - own)[worst]:.2g} m"
    cosine = (way * np.conj(normal)).real
    if not contact.thick:
        # a line lies on the surface itself: the distance from a rigid edge grows along a force that pushes
        step, grown = 5.0 * SUNK * state.longest, np.full(len(s), np.inf)
        if isinstance(contact, RigidContact):
            grown = _to_rigid(state, contact, state.beams[on].line(s) + step * way)[0] - distance
        cosine = np.minimum(grown / step + ALIGNED - LINE_ALIGNED, 1.0)
    worst = int(np.argmin(cosine))
    if not cosine[worst] >= ALIGNED:
        how = "pulls" if cosine[worst] < 0.0 else "rubs"
        yield f"{name} {how} {on} at {s[worst]:.4g} m, with a force {cosine[worst]:.3f} along the normal"


def closest(state: StationState, contact: Contact, on: str, s: Array) -> tuple[Array, Complex]:
    """Distances d and normals n of a contact's partner at arc lengths ``s`` (k,) of a beam."""
    x = state.beams[on].line(s)
    if isinstance(contact, RigidContact):
        return _to_rigid(state, contact, x)
    if isinstance(contact, SelfContact):
        # another lap: between both laps the tangent turns by more than a right angle
        beam, at = state.beams[on], np.union1d(state.beams[on].fine, s)
        psi, away = np.unwrap(np.angle(beam.tangents(at))), np.abs(x[:, None] - beam.line(at))
        away[np.abs(np.interp(s, at, psi)[:, None] - psi) < 0.5 * np.pi] = np.inf
        foot = at[away.argmin(axis=1)]
        place = np.where(np.isfinite(away.min(axis=1)), beam.line(foot), FAR * state.longest)
    else:
        beam = state.beams[next(other for other in contact.between if other != on)]
        line = beam.line(beam.fine)
        at, steps = _along(_curve(line), x), np.append(0.0, np.cumsum(np.abs(np.diff(line))))
        place, foot = (
            np.interp(at, steps, line.real) + 1j * np.interp(at, steps, line.imag),
            np.interp(at, steps, beam.fine),
        )
    away = x - place
    half = 0.5 * beam.thickness(foot) if contact.thick else 0.0
    return np.abs(away) - half, away / np.maximum(np.abs(away), TINY)


def _to_rigid(state: StationState, contact: RigidContact, x: Complex) -> tuple[Array, Complex]:
    """The same of a rigid edge that its body carries, at places x (k,)."""
    turn = np.exp(1j * state.rotation(contact.body))
    x = np.asarray((x - state.carried(contact.body, 0j)) / turn)
    if isinstance(contact, HalfPlaneContact):
        n = unit(contact.normal)
        return ((x - complex(*contact.point)) * np.conj(n)).real, np.full(len(x), turn * n)
    if isinstance(contact, CircleContact):
        from_centre = x - complex(*contact.center)
        return np.abs(from_centre) - contact.radius, turn * from_centre / np.abs(from_centre)
    edge = _edge(contact, BEHIND * state.longest)
    at, beside = _along(edge, x), 1e-9 * edge.length
    feet = (shapely.line_interpolate_point(edge, at + shift) for shift in (-beside, 0.0, beside))
    before, foot, after = (np.asarray(shapely.get_coordinates(places) @ (1.0, 1j)) for places in feet)
    behind = ((np.conj(after - before) * (x - foot)).imag < 0.0) & (at > 0.0) & (at < edge.length)
    sign = np.where(behind, -1.0, 1.0)
    return sign * np.abs(x - foot), turn * sign * (x - foot) / np.maximum(np.abs(x - foot), TINY)


@cache
def _edge(contact: LineContact | FunctionContact, depth: float) -> shapely.LineString:
    """A rigid edge at rest with the free side on the left, and both sides that go straight back from an open edge."""
    line = np.asarray(edge_places(contact, depth, GRAPH) @ (1.0, 1j))
    line = line if is_free_on_the_left(contact) else line[::-1]
    ends = line[0] - line[1], line[-1] - line[-2]
    sides = line[0] + 1j * depth * ends[0] / abs(ends[0]), line[-1] - 1j * depth * ends[1] / abs(ends[1])
    if line[0] == line[-1]:
        sides = line[-2], line[1]
    return _curve(np.concatenate((sides[:1], line, sides[1:])))


def _along(curve: shapely.LineString, x: Complex) -> Array:
    """Distances along a curve of the closest points to places (k,)."""
    return np.asarray(shapely.line_locate_point(curve, shapely.points(x.real, x.imag)))


def _curve(line: Complex) -> shapely.LineString:
    return shapely.LineString(np.stack((line.real, line.imag), axis=1))


def _surface(state: StationState, contact: Contact, on: str, s: Array) -> tuple[Array, Array]:
    """Distances a of the own surface, and largest errors of a distance, (k,), m."""
    t = state.beams[on].thickness(s)
    return (0.5 * t, DEEP * t) if contact.thick else (0.0 * t, SUNK * state.longest + 0.0 * t)
