"""Whether what was asked is what the answer's state says."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.areas import AreaOfBeam
from comparisons.audit.balance import between_nodes, moments_beyond, near
from comparisons.audit.seen import Seen
from cprbm_scene import Probe
from cprbm_scene.answer import Array
from cprbm_scene.statement import BeamMoment, DisplacementDrive, DistributedLoad, Drive

SAME = 1e-6  # of the probe's largest value at the station, or of what it is a sum of
STRESS = 0.02  # of the largest stress: what the discretisation leaves between cuts
WITHIN = 1e-3  # of the energy: what loads on beams do within an element


def probed(seen: Seen) -> Iterator[str]:
    """Probes that say something else."""
    for probe in seen.scene.probes:
        given = seen.station.values.get(probe.name)
        found = _value(seen, probe)
        if given is None or found is None:
            continue
        value, allowed = found
        off = np.abs(given - value) if given.shape == value.shape else np.array([np.inf])
        worst = int(np.argmax(np.nan_to_num(off - allowed, nan=-np.inf)))
        if np.nan_to_num(off - allowed, nan=-np.inf)[worst] > 0.0:
            said = given.ravel()[min(worst, given.size - 1)] if given.size else float("nan")
            yield f"{probe.name} says {said:.8g} where the state has {value[min(worst, value.size - 1)]:.8g}"


def _value(seen: Seen, probe: Probe) -> tuple[Array, Array | float] | None:
    """What a probe should say, and what it may be off by; None of what is not summed up here."""
    scene, of = seen.scene, probe.of
    match probe.quantity:
        case "displacement":
            moved = seen.point(of) - complex(*scene.place_of(of))
            return np.array((moved.real, moved.imag)), SAME * seen.longest
        case "rotation":
            return np.array([seen.motion(of)[2]]), SAME
        case "force":
            on = scene.contacts[of].beams[0]
            if len(set(scene.contacts[of].beams)) == 1 and scene.contacts[of].kind == "beam-self":
                return None
            acting = seen.acting[on]
            total = sum((f for f, by in zip(acting.forces, acting.by, strict=True) if by == of), 0j)
            return np.array([abs(total)]), SAME * abs(total) + _rounded(seen)
        case "reaction" | "reaction_moment":
            force, moment, largest = _reaction(seen, of)
            if probe.quantity == "reaction":
                return np.array((force.real, force.imag)), SAME * largest + _rounded(seen)
            if any(stop.beam in seen.beams for stop in scene.stops.values()):
                return None
            return np.array([moment]), SAME * (abs(moment) + largest * seen.longest) + _rounded(seen) * seen.longest
        case "potential_energy":
            strain, work = seen.energy
            loaded = any(
                isinstance(load, BeamMoment | DistributedLoad) or load.kind == "beam_force"
                for load in scene.loads.values()
            )
            share = WITHIN if loaded else SAME
            given = sum(between_nodes(seen, name)[0] for name in seen.beams)
            return np.array([strain - work]), share * (abs(strain) + abs(work)) + given + 1e-12 * _rounded(seen)
        case "bending_stress" if not isinstance(seen.beams[of], AreaOfBeam):  # a solid's is no moment's
            return _stress(seen, probe)
        case _:
            return None


def _stress(seen: Seen, probe: Probe) -> tuple[Array, Array]:
    beam, rest = seen.beams[probe.of], seen.rests[probe.of]
    s = np.linspace(0.0, rest.length, probe.points)
    t = rest.thickness(s)
    per_moment = 0.5 * t * rest.E / rest.rigidity(s)
    value = per_moment * moments_beyond(seen, probe.of, s)
    # at an end, and beside forces, the discretisation's own ways to even out
    allowed = STRESS * float(np.max(np.abs(value))) + 3.0 * per_moment * near(seen, probe.of, s)
    allowed += per_moment * 1e-9 * float(np.max(rest.rigidity(s))) / rest.length
    outer = np.diff(beam.inside.borders)[[0, -1]]
    allowed = np.where((s < outer[0]) | (s > rest.length - outer[1]), np.inf, allowed)
    return value, allowed


def _reaction(seen: Seen, of: str) -> tuple[complex, float, float]:
    """Force and moment of what holds a point or body, and the largest force in it."""
    scene, statics = seen.scene, seen.statics
    names = {of, *(name for name, drive in scene.drives.items() if _driven(drive) == of)}
    names |= {name for name, body in scene.bodies.items() if body.motion == "slides" and name == of}
    pins = {name: pin.points for name, pin in scene.pins.items() if of in pin.points}
    grounded = {name for name in pins if scene.bodies[scene.body_of(of)].motion == "fixed"} if pins else set()
    force, moment, largest = 0j, 0.0, 0.0
    for by, f, m in zip(statics.by, statics.forces, statics.moments, strict=True):
        if by in names or by in grounded:
            force, moment, largest = force + complex(*f), moment + float(m), max(largest, float(np.hypot(*f)))
    return force, moment, largest


def _driven(drive: Drive) -> str:
    return drive.point if isinstance(drive, DisplacementDrive) else drive.body


def _rounded(seen: Seen) -> float:
    """What round-off leaves of a force, N."""
    return max(100.0 * beam.rounding / float(np.diff(beam.inside.borders).min()) for beam in seen.beams.values())
