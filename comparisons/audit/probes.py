"""Probes of an answer against the stated forces and the stated shape, and the energy along the path.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
Π       strain energy less the work of the loads
g, x    dΠ/dx and x of the stepped loads or drive: -u and P, or F and d
h       step between two stations
======  ==========================================================================

Stresses follow from the moment and the force of all forces beyond the place, everywhere along the beam.  The strain
energy is ∫ M²/(2 E·I) + N²/(2 EA) + Q²/(2 GA_s) ds.  M is the moment of all forces beyond, corrected by the difference
of the stated M, which is linear between the stated places.  Elements of even curvature store less by Σ l³ Q²/(24 E·I),
with l of the element.

Between two stations of one branch the trapezoidal rule gives ΔΠ = h (g₀ + g₁)/2.  The allowance is the difference of
both products, and twice the error term h Δδ/12, with the mean change δ of g per step at both stations.  Of two stations
alone only a loss of energy counts: a reaction may rise and fall.  A silent jump to another state loses energy that no
work accounts for.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from comparisons.audit.state import Finding, StationState, about, gauss, unit
from comparisons.audit.statics import floors, moment_errors
from comparisons.quantities import arc_lengths
from cprbm_scene.answer import Answer, Array
from cprbm_scene.statement import DisplacementDrive, PinnedEnd, Probe, Scene, SelfContact

SAME, STRESS = 1e-6, 0.02
"""Error of a probe that is read or summed, over the summed parts; error of a stress between two cuts, over the largest
stress of the beam."""

ENERGY, EVEN = 5e-3, 1.2
"""Error of the energy over strain energy and work, and over the energy that an even curvature leaves out: of 198
answers to random scenes at N = 40 one misses more than 2.2e-3 of strain energy and work."""

FITTED = 2e-3
"""Difference of energies, over the energies, between meshes that are fitted from station to station."""

CONTINUOUS = 0.01
"""Energy gained beyond a critical point, over the energy: a continuous bifurcation releases none."""

ROUND_OFF = 1e-9
"""Energy that round-off explains, over the natural energy E·I/L."""


def probes(state: StationState) -> Iterator[Finding]:
    """Differences of probes from the values of the stated forces and shape; infinite if a probe is not finite."""
    for probe in state.scene.probes_in(state.station.stage):
        given = state.station.values.get(probe.name, np.array([np.nan]))
        value, allowed = _expected(state, probe) or (given, SAME)
        off = np.abs(given - value) - allowed if given.shape == value.shape else np.array([np.nan])
        if off.size:
            i = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
            yield (
                off[i],
                f"{probe.name} is {given[i : i + 1]} where the stated forces and shape make {value[i : i + 1]}",
            )


def _expected(state: StationState, probe: Probe) -> tuple[Array, Array | float] | None:
    """The value of a probe and the allowed error; None of quantities that are not recomputed."""
    of, forces, (force, moment) = probe.of, state.forces, floors(state)
    match probe.quantity:
        case "displacement":
            return np.array([state.moved(of)]).view(float), SAME * state.longest
        case "rotation":
            return np.array([state.rotation(of)]), SAME
        case "force":
            contact = state.scene.contacts[of]
            on = np.sort(forces[(forces["source"] == of) & (forces["target"] == contact.beams[0])], order="s")["force"]
            # both laps of a beam that touches itself bear the same forces
            value = abs(on[: len(on) // 2 if isinstance(contact, SelfContact) else None].sum())
            return np.array([value]), SAME * value + force
        case "moment":
            value = _moment(state, of)
            return np.array([value]), SAME * value + moment
        case "reaction" | "reaction_moment":
            held = forces[np.isin(forces["source"], _holding(state.scene, of))]
            size, value = np.abs(held["force"]).max(initial=0.0), float(held["moment"].sum())
            if probe.quantity == "reaction":
                return np.array([held["force"].sum()]).view(float), SAME * size + force
            return np.array([value]), SAME * (abs(value) + size * state.longest) + moment
        case "potential_energy":
            strain, work, even = _energies(state)
            error = ENERGY * (strain + abs(work)) + EVEN * even + ROUND_OFF * state.natural
            return np.array([strain - work]), error
        case "bending_stress" | "combined_stress":
            return _stress(state, probe)
    return None


def _stress(state: StationState, probe: Probe) -> tuple[Array, Array]:
    """Stress along a beam by the forces beyond, and the allowed error, (points,) each."""
    beam, s = state.beams[probe.of], arc_lengths(state.scene, probe)
    (F, M), (EI, EA, _), E = state.beyond(probe.of, s), beam.stiffness(s), beam.material.youngs_modulus
    per_moment, per_force = 0.5 * beam.thickness(s) * E / EI, E / EA
    value, allowed = per_moment * M, per_moment * moment_errors(state, probe.of, s)
    if probe.quantity == "combined_stress":
        tangent = beam.rest(s)[1] + beam.displacement(s, 1)
        value = np.abs(value) + per_force * np.abs((F * np.conj(tangent / np.abs(tangent))).real)
        allowed += per_force * floors(state)[0]
    return value, allowed + STRESS * np.abs(value).max()


def _moment(state: StationState, of: str) -> float:
    """Moment of a stop on its beam, or of a contact about the first pin that joins the beam and the touched body."""
    scene, body = state.scene, getattr(state.scene.contacts.get(of), "body", None)
    on = scene.stops[of].beam if of in scene.stops else scene.contacts[of].beams[0]
    ends = (end.point for end in (scene.beams[on].start, scene.beams[on].end) if isinstance(end, PinnedEnd))
    pin = next(state.point(point) for point in ends if body in (None, scene.body_of(point)))
    return abs(float(about(state.on[on][state.on[on]["source"] == of], pin).sum()))


def _holding(scene: Scene, of: str) -> list[str]:
    """Sources that hold a point or a body: joints, guides, drives, pins and stops."""
    ends = {name: getattr(scene.beams[stop.beam], stop.end).point for name, stop in scene.stops.items()}
    driven = {name: getattr(drive, "point", "") or getattr(drive, "body", "") for name, drive in scene.drives.items()}
    pins = {name: of for name, pin in scene.pins.items() if of in pin.points}
    return [of, *(name for name, held in (ends | driven | pins).items() if held == of)]


def _energies(state: StationState) -> tuple[float, float, float]:
    """Strain energy, work of the loads, and the energy that an even curvature of elements leaves out, J."""
    strain = even = 0.0
    for name, beam in state.beams.items():
        s, ds = gauss(np.unique(np.concatenate((beam.state.s, state.on[name]["s"]))))  # M may step at a load
        N, Q, M = (np.interp(s, beam.state.s, of) for of in (beam.state.N, beam.state.Q, state.unbalance(name)))
        EI, EA, GA = beam.stiffness(s)
        density = (M + state.beyond(name, s)[1]) ** 2 / EI + N**2 / EA * (state.kinematics != "bending")
        strain += 0.5 * float((density + Q**2 / GA * (state.kinematics == "shear")) @ ds)
        even += beam.h**2 * float((Q**2 / (24.0 * EI)) @ ds)
    return strain, sum(state.values[load] * state.load(load)[1] for load in state.scene.loads), even


def path(answer: Answer, states: Sequence[StationState]) -> Iterator[Finding]:
    """Changes of energy besides the work between stations of a branch, and energies gained at critical points."""
    branches = groupby(states, key=lambda state: (state.station.stage, state.station.branch))
    for (stage, _), of in ((key, list(group)) for key, group in branches):
        x, g = np.array([(state.station.value, _driving(state)) for state in of]).T
        strain, work, even = np.array([_energies(state) for state in of]).T
        h, slope = np.diff(x), np.gradient(g) if len(x) > 2 else 0.0 * x
        lost = np.diff(strain - work) - 0.5 * h * (g[1:] + g[:-1])
        error = 2.0 * even + FITTED * (strain + np.abs(work)) + ROUND_OFF * of[0].natural
        allowed = np.abs(h * np.diff(g)) + np.abs(h * np.diff(slope)) / 6.0 + error[1:] + error[:-1]
        for i, off in enumerate(np.abs(lost) if len(x) > 2 else -lost):
            yield (
                off - allowed[i],
                f"from {stage} {x[i]:g} to {x[i + 1]:g} the energy changes by {lost[i]:.3g} J more than the work",
            )
    for critical in answer.critical:
        gained = 0.0 if critical.after is None else critical.after - critical.energy
        yield (
            gained - CONTINUOUS * abs(critical.energy) - (ROUND_OFF * states[0].natural if states else 0.0),
            f"beyond {critical.stage} {critical.value:g} the energy is {gained:.3g} J larger",
        )


def _driving(state: StationState) -> float:
    """g of the stepped loads or drive."""
    name = state.stage.steps
    if name in state.scene.loads:
        return -sum(state.load(load)[1] for load in state.stage.stepped)
    drive, forces = state.scene.drives[name], state.forces[state.forces["source"] == name]
    way = unit(drive.direction) if isinstance(drive, DisplacementDrive) else 0j
    return float((forces["force"].sum() * np.conj(way)).real + (0.0 if way else forces["moment"].sum()))
