"""Equilibrium of an answer: sums on every beam and body, action and reaction, and free-body cuts.

A beam is cut at every stated place.  N, Q and M there are the resultant of all that acts beyond the cut, whatever the
discretisation.  Allowances are errors of an element of size h: a force near a cut has a lever that is known to a part
of h, a chain's joints lie h² M/(8 E·I) beside its smooth line.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from comparisons.audit.state import BESIDE, StationState, about
from cprbm_scene.answer import Array
from cprbm_scene.statement import PinnedEnd, TurningBody

CLOSED = 1e-7
"""Largest sum of forces or moments in equilibrium, over the largest force or moment."""

LOADED = 1e-3
"""The same of moments on a beam with loads: a load between two places displaces the line, and its own lever."""

ROUND_OFF = 2e-14
"""Relative error of a turning between neighbouring places: a hundred units in the last place."""

NEAR, LEVER = 2.6, 1.0
"""A force within NEAR elements of a cut has a lever that is known to LEVER elements."""

POLYGON = 0.15
"""Distance of a chain's joints, where moments balance, from the smooth line, over h² M/(E·I): 1/8 on a circle."""

AT_END = 0.01
"""Error of a moment that is continued to an end of the beam, over the beam's largest moment, besides (2 h/L)²."""


def sums(state: StationState) -> Iterator[str]:
    """Beams, bodies, contacts and joints whose forces do not cancel, and pinned ends that carry a moment."""
    scene, forces, moving = state.scene, state.forces, state.station.bodies
    pivots = {body.about for body in scene.bodies.values() if isinstance(body, TurningBody)}
    at_ground = {point for name, body in scene.bodies.items() if name not in moving for point in body.points}
    parts = dict(state.on)
    for source in np.setdiff1d(forces["source"], [*pivots, *at_ground]):
        pair = forces[forces["source"] == source]
        if len(set(pair["target"])) > 1:
            parts[f"{source}, action and reaction,"] = pair
    for name, part in parts.items():
        if len(part):
            force, moment = floors(state, name if name in scene.beams else None)
            turning, places = about(part, complex(part["place"][0])), part["place"]
            if not abs(part["force"].sum()) <= force:
                yield f"ΣF of {name} is {abs(part['force'].sum()):.2g} N, of {np.abs(part['force']).max():.2g} N"
            if not abs(turning.sum()) <= moment + force * np.abs(places - places[0]).max():
                yield f"ΣM of {name} is {abs(turning.sum()):.2g} N·m, of {np.abs(turning).max():.2g} N·m"
    for name, beam in scene.beams.items():
        for end in (beam.start, beam.end):
            if isinstance(end, PinnedEnd):
                moment = np.abs(state.on[name]["moment"][state.on[name]["source"] == end.point]).max(initial=0.0)
                if not moment <= floors(state)[1]:
                    yield f"the pinned end of {name} at {end.point} carries a moment of {moment:.2g} N·m"


CutErrors = tuple[tuple[Array, Array], tuple[Array, Array]]
"""Errors of the stated force and of the stated moment at the cuts of a beam, each with the allowed error, (n,)."""


def cuts(state: StationState, errors: Mapping[str, CutErrors]) -> Iterator[str]:
    """Places where N, Q or M differ from the resultant of all that acts beyond, by the ``errors`` of every beam."""
    for name, of_beam in errors.items():
        for what, (off, allowed) in zip(("force in N", "moment in N·m"), of_beam, strict=True):
            worst = int(np.argmax(off - allowed))
            if not off[worst] <= allowed[worst]:
                where = f"{name} at {state.beams[name].state.s[worst]:.4g} m"
                yield f"{where} states a {what} that is {off[worst]:.2g} off all that acts beyond"


def cut_errors(state: StationState, name: str) -> CutErrors:
    """Errors at the cuts of a beam."""
    beam = state.beams[name]
    s, stated, (F, M) = beam.state.s, beam.state.N + 1j * beam.state.Q, state.beyond(name, beam.state.s)
    small = np.minimum(np.append(np.inf, np.diff(s)), np.append(np.diff(s), np.inf))
    h, EI, (force, moment), near = beam.size(s), beam.stiffness(s)[0], floors(state, name), nearby(state, name, s)
    rounding = ROUND_OFF * EI / small * (1.0 + (np.abs(beam.places).max() + beam.length) / small)
    allowed = moment + rounding + LEVER * h * near[0] + near[1] + POLYGON * h**2 * np.abs(beam.state.M * F) / EI
    allowed[[0, -1]] += (AT_END + (2.0 * h / beam.length)[[0, -1]] ** 2) * np.abs(beam.state.M).max()
    at_cut = nearby(state, name, s, 1e3 * BESIDE * beam.length / h)[0]
    off = np.abs(stated * np.exp(1j * beam.state.angle) - F)
    return (off, force + at_cut + rounding / small), (np.abs(beam.state.M - M), allowed)


def nearby(state: StationState, name: str, s: Array, reach: Array | float = NEAR) -> tuple[Array, Array]:
    """Sums of the forces of contacts and loads, and of loads' moments, within ``reach`` elements of places, (k,)."""
    beam, scene, source = state.beams[name], state.scene, state.on[name]["source"]
    forces = state.on[name][np.isin(source, [*scene.contacts, *scene.loads])]
    h = np.maximum(beam.size(s)[:, None], beam.size(forces["s"]))
    near = np.abs(forces["s"] - s[:, None]) < np.broadcast_to(reach, s.shape)[:, None] * h
    of_loads = np.isin(forces["source"], list(scene.loads))
    return near @ np.abs(forces["force"]), near @ (np.abs(forces["moment"]) * of_loads)


def floors(state: StationState, name: str | None = None) -> tuple[float, float]:
    """Largest force, N, and moment, N·m, that an equilibrium may leave over, of all or of a beam that bears loads."""
    force, moment = state.largest
    h = min(beam.length / len(beam.state.s) for beam in state.beams.values())
    rounding = ROUND_OFF * state.natural * (state.longest / h) ** 2
    loaded = name is not None and np.isin(state.on[name]["source"], list(state.scene.loads)).any()
    closed = LOADED if loaded else CLOSED
    return CLOSED * max(force, moment / state.longest) + rounding / h, closed * moment + rounding
