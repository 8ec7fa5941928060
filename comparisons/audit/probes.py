"""Probes of an answer: every probe value against the stated forces and the stated shape.

Stresses follow from the moment and the force of all that acts beyond the place, everywhere along the beam.  The strain
energy is ∫ M²/(2 E·I) + N²/(2 EA) + Q²/(2 GA_s) ds, M by all that acts beyond plus what the stated M
differs at the stated places.  Elements of even
curvature store less by Σ h³ Q²/(24 E·I).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.balance import LEVER, floors, nearby
from comparisons.audit.state import Forces, StationState, about, gauss
from cprbm_scene import Probe, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import DisplacementDrive, FixedBody, PinnedEnd, SelfContact

SAME = 1e-6
"""Error of a probe that is read or summed, over the summed parts."""

STRESS = 0.02
"""Error of a stress between two cuts, over the largest stress of the beam."""

ENERGY = 1e-3
"""Error of the energy besides the even curvature of elements, over strain energy and work."""

ROUND_OFF = 1e-12
"""Energy that round-off explains, over the natural energy E·I/L."""

NOTHING = np.array([np.nan])
"""Value of a probe that an answer lacks."""


def probes(state: StationState) -> Iterator[str]:
    """Probes that are not finite, or differ from the value of the stated forces and shape."""
    for probe in state.scene.probes:
        given = state.station.values.get(probe.name, NOTHING)
        value, allowed = _expected(state, probe) or (given, SAME)
        off = np.abs(given - value) - allowed if given.shape == value.shape else np.array([np.nan])
        worst = int(np.argmax(np.nan_to_num(off, nan=np.inf))) if off.size else 0
        if off.size and not off[worst] <= 0.0:
            right = f"{value[worst]:.8g}, which differs by more than the allowed error"
            yield f"{probe.name} is {given[worst : worst + 1]} where the stated forces and shape make {right}"


def _expected(state: StationState, probe: Probe) -> tuple[Array, Array | float] | None:
    """The value of a probe and the allowed error; None of quantities that are not recomputed."""
    of, scene, (force, moment) = probe.of, state.scene, floors(state)
    match probe.quantity:
        case "displacement":
            return _components(state.moved(of)), SAME * state.longest
        case "rotation":
            return np.array([state.rotation(of)]), SAME
        case "force":
            forces = np.sort(_of_source(state.on[scene.contacts[of].beams[0]], {of}), order="s")
            if isinstance(scene.contacts[of], SelfContact):
                forces = forces[: len(forces) // 2]  # both laps bear the same forces
            total = abs(forces["force"].sum())
            return np.array([total]), SAME * total + force
        case "moment":
            value = abs(_moment(state, of))
            return np.array([value]), SAME * value + moment
        case "reaction" | "reaction_moment":
            held = _of_source(state.forces, _holding(scene, of))
            size, value = np.abs(held["force"]).max(initial=0.0), float(held["moment"].sum())
            if probe.quantity == "reaction":
                return _components(complex(held["force"].sum())), SAME * size + force
            return np.array([value]), SAME * (abs(value) + size * state.longest) + moment
        case "potential_energy":
            strain, work, even = energies(state)
            return np.array([strain - work]), ENERGY * (strain + abs(work)) + 2.0 * even + ROUND_OFF * state.natural
        case "bending_stress" | "combined_stress":
            return _stress(state, probe)
    return None


def energies(state: StationState) -> tuple[float, float, float]:
    """Strain energy, work of the loads, and the energy that an even curvature of elements leaves out, J."""
    strain = even = 0.0
    for name, beam in state.beams.items():
        s, ds = gauss(beam.state.s)
        off = beam.state.M - state.beyond(name, beam.state.s)[1]
        M = state.beyond(name, s)[1] + np.interp(s, beam.state.s, off)
        N, Q = (np.interp(s, beam.state.s, stated) for stated in (beam.state.N, beam.state.Q))
        EI, EA, GA = beam.stiffness(s)
        density = M**2 / EI + N**2 / EA * (state.kinematics != "bending") + Q**2 / GA * (state.kinematics == "shear")
        strain += 0.5 * float(density @ ds)
        even += float((beam.size(s) ** 2 * Q**2 / (24.0 * EI)) @ ds)
    return strain, sum(state.values[load] * state.way_of(load) for load in state.scene.loads), even


def _stress(state: StationState, probe: Probe) -> tuple[Array, Array]:
    """Stress along a beam by all that acts beyond, and the allowed error, (points,) each."""
    beam = state.beams[probe.of]
    s = np.linspace(0.0, beam.length, probe.points)
    (F, M), near, (force, moment) = state.beyond(probe.of, s), nearby(state, probe.of, s), floors(state)
    EI, EA, _ = beam.stiffness(s)
    per_moment, per_force = 0.5 * beam.thickness(s) * beam.E / EI, beam.E / EA
    value, allowed = per_moment * M, per_moment * (LEVER * beam.size(s) * near[0] + near[1] + moment)
    if probe.quantity == "combined_stress":
        value = np.abs(value) + per_force * np.abs((F * np.conj(beam.tangents(s))).real)
        allowed += per_force * (near[0] + force)
    return value, allowed + STRESS * np.abs(value).max()


def _components(vector: complex) -> Array:
    return np.array((vector.real, vector.imag))


def _of_source(forces: Forces, sources: set[str]) -> Forces:
    """The forces of some sources."""
    return forces[np.isin(forces["source"], list(sources))]


def _moment(state: StationState, name: str) -> float:
    """Moment of a stop on its beam, or of a contact about the first pin that joins the beam and the touched body."""
    scene = state.scene
    on = scene.stops[name].beam if name in scene.stops else scene.contacts[name].beams[0]
    forces, beam = _of_source(state.on[on], {name}), scene.beams[on]
    if name in scene.stops:
        return float(forces["moment"].sum())
    body = getattr(scene.contacts[name], "body", "")
    pins = [end for end in (beam.start, beam.end) if isinstance(end, PinnedEnd) and scene.body_of(end.point) == body]
    return float(about(forces, state.point(pins[0].point)).sum()) if pins else 0.0


def _holding(scene: Scene, of: str) -> set[str]:
    """Sources that hold a point or body: joints, stops and pins of a fixed body, guides and drives."""
    sources = {of}
    for name, drive in scene.drives.items():
        if of == (drive.point if isinstance(drive, DisplacementDrive) else drive.body):
            sources.add(name)
    if of not in scene.bodies and isinstance(scene.bodies[scene.body_of(of)], FixedBody):
        sources |= {name for name, pin in scene.pins.items() if of in pin.points}
        ends = {name: getattr(scene.beams[stop.beam], stop.end) for name, stop in scene.stops.items()}
        sources |= {name for name, end in ends.items() if of == end.point}
    return sources
