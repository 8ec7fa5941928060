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
from shapely.geometry.base import BaseGeometry

from comparisons.audit.state import Complex, StationState, unit
from comparisons.geometry import length, points
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
"""Largest penetration, and largest gap under a force, over the mean thickness."""

SUNK = 2e-3
"""The same of lines without thickness, over the longest beam."""

ALIGNED, LINE_ALIGNED = 0.98, 0.8
"""Least cosine of the angle between a contact force and the normal, of thick beams and of lines."""

FAR, TINY = 1e3, 1e-300
"""Place of a lap that does not exist, over the longest beam, and a length below all lengths, m."""

GRAPH = 2001
"""Places of a rigid edge that is a function's graph."""

BESIDE = 3.0
"""Thicknesses beside an overlap at rest, such as a common joint, within which penetration is not judged."""

SMALL = 1e-6
"""Share of a contact's largest force below which places and directions of a force are not judged."""

BEHIND = 0.1
"""Depth of a rigid edge behind its line, over the longest beam."""


def contacts(state: StationState) -> Iterator[str]:
    """Contacts that penetrate, press across a gap, pull or rub, and contacts without a state."""
    at_rest = {name: beam.at_rest for name, beam in state.beams.items()}
    rest = replace(state, beams=at_rest, station=replace(state.station, bodies={}))
    for name, contact in state.scene.contacts.items():
        if name not in state.station.contacts:
            yield f"{name} has no contact state"
        for on in dict.fromkeys(contact.beams):
            if contact.thick or isinstance(contact, RigidContact):  # a distance of lines has no sign
                yield from _penetration(state, rest, name, on)
            yield from _pressing(state, name, on)


def _penetration(state: StationState, rest: StationState, name: str, on: str) -> Iterator[str]:
    """The deepest penetration of a beam."""
    contact, beam, s = state.scene.contacts[name], state.beams[on], state.beams[on].fine
    own, allowed = _surface(state, contact, on, s)
    gap, at = closest(state, contact, on, s)[0] - own, s[closest(rest, contact, on, s)[0] < own * (1.0 - 1e-6)]
    if at.size:
        behind = np.searchsorted(at, s)
        away = np.minimum(np.abs(s - at[np.maximum(behind - 1, 0)]), np.abs(at[np.minimum(behind, len(at) - 1)] - s))
        gap[away <= BESIDE * beam.beam.thickest] = np.inf
    worst = int(np.argmin(gap))
    if not gap[worst] >= -allowed[worst]:
        yield f"{on} penetrates its partner in {name} by {-gap[worst]:.2g} m at {s[worst]:.4g} m"


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
        away = np.asarray(x - complex(*contact.center))
        return np.abs(away) - contact.radius, turn * away / np.abs(away)
    edge, solid = _solid(contact, BEHIND * state.longest)
    foot = shapely.line_interpolate_point(edge, _along(edge, x))
    away = np.asarray(x - shapely.get_coordinates(foot) @ (1.0, 1j))
    sign = np.where(shapely.contains_properly(solid, shapely.points(x.real, x.imag)), -1.0, 1.0)
    return sign * np.abs(away), turn * sign * away / np.maximum(np.abs(away), TINY)


@cache
def _solid(contact: LineContact | FunctionContact, depth: float) -> tuple[shapely.LineString, BaseGeometry]:
    """The edge of a rigid contact at rest, and the rigid region behind the edge."""
    if isinstance(contact, LineContact):
        line, left = np.array(contact.points) @ (1.0, 1j), contact.side == "left"
    else:
        line = points(contact.curve, np.linspace(0.0, length(contact.curve), GRAPH)) @ (1.0, 1j)
        left = ((contact.side == "above") == (contact.axis == "x")) == (contact.range[1] > contact.range[0])
    edge = _curve(line)
    if not edge.is_closed:
        return edge, edge.buffer(-depth if left else depth, single_sided=True, join_style="mitre")
    ring = shapely.Polygon(edge)
    return edge, ring if ring.exterior.is_ccw != left else ring.buffer(depth).difference(ring)


def _along(curve: shapely.LineString, x: Complex) -> Array:
    """Distances along a curve of the closest points to places (k,)."""
    return np.asarray(shapely.line_locate_point(curve, shapely.points(x.real, x.imag)))


def _curve(line: Complex) -> shapely.LineString:
    return shapely.LineString(np.stack((line.real, line.imag), axis=1))


def _surface(state: StationState, contact: Contact, on: str, s: Array) -> tuple[Array, Array]:
    """Distances a of the own surface, and largest errors of a distance, (k,), m."""
    t = state.beams[on].thickness(s)
    return (0.5 * t, DEEP * t) if contact.thick else (0.0 * t, SUNK * state.longest + 0.0 * t)
