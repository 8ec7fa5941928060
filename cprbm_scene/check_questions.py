"""What is asked and what is claimed: probes fit what they are of, claims are about what is asked."""

from __future__ import annotations

from bisect import bisect
from collections.abc import Iterator, Mapping

from cprbm_scene.check_names import RESERVED, point_names
from cprbm_scene.mistakes import Mistake, unknown_name
from cprbm_scene.statement import (
    CRITICAL,
    STRESSES,
    DisplacementDrive,
    EdgeContact,
    FreeEnd,
    PinnedEnd,
    Quantity,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
)

# what a quantity may be asked of
_OF: dict[Quantity, str] = {
    "displacement": "point",
    "rotation": "body",
    "force": "contact",
    "centre": "contact",
    "ends": "contact",
    "closing_load": "contact",
    "bending_stress": "beam",
    "combined_stress": "beam",
    "reaction": "support",
    "reaction_moment": "turned",
    "potential_energy": RESERVED,
    "angle": "stop",
    "moment": "holding",
}
_SAID = {
    "point": "a body's point",
    "body": "a body",
    "contact": "a contact",
    "beam": "a beam",
    "support": "a point of a fixed body at which a beam ends, a pivot, a driven point, or a body that slides",
    "stop": "a stop",
    "holding": "a stop, or a contact with a line, a half-plane or a function of the body that the beam is pinned to",
    "turned": "a point of a fixed body at which a beam ends, or a body whose rotation is driven",
    RESERVED: f"{RESERVED!r}, the scene itself",
}

_LISTED = 200
"""Stations of a stage that a mistake lists."""

_SEVERAL = STRESSES | {"displacement", "reaction", "ends"}
"""Quantities of more than one number."""


def wrong_probes(scene: Scene) -> Iterator[Mistake]:
    """Probes of nothing, of the wrong thing, or named twice."""
    bearers = _bearers(scene)
    everything = list(dict.fromkeys(name for names in bearers.values() for name in names))
    seen: set[str] = set()
    for i, probe in enumerate(scene.probes):
        key = f"probes[{i}]"
        kind = _OF[probe.quantity]
        if probe.of not in everything:
            yield unknown_name(f"{key}.of", probe.of, "point, body, beam, contact or stop", everything)
        elif probe.of not in bearers[kind]:
            listed = ", ".join(repr(name) for name in bearers[kind]) or "there is none"
            found = f"{probe.quantity!r} of {probe.of!r}"
            yield Mistake(key, found, f"{probe.quantity!r} of {_SAID[kind]}: {listed}")
        if probe.name in seen:
            yield Mistake(key, f"{probe.name!r} again", "each probe once")
        seen.add(probe.name)
        if "points" in probe.model_fields_set and probe.quantity not in STRESSES:
            yield Mistake(
                f"{key}.points",
                f"places along {probe.name!r}",
                "points for 'bending_stress' and 'combined_stress' only",
            )


def wrong_claims(scene: Scene) -> Iterator[Mistake]:
    """Claims about probes, stages or stations that the scene does not have, and values of what has several."""
    probes = {probe.name: probe for probe in scene.probes}
    stages = [stage.name for stage in scene.stages]
    ascending = {stage.name: sorted(stage.stations) for stage in scene.stages}
    for i, claim in enumerate(scene.claims):
        key = f"claims[{i}]"
        if claim.probe not in probes and claim.probe != CRITICAL:
            yield unknown_name(f"{key}.probe", claim.probe, "probe", [*probes, CRITICAL])
        elif claim.value is not None and claim.probe != CRITICAL and probes[claim.probe].quantity in _SEVERAL:
            yield Mistake(f"{key}.value", f"a value of {claim.probe!r}, which has several", "a probe of one number")
        if claim.stage is not None and claim.stage not in stages:
            yield unknown_name(f"{key}.stage", claim.stage, "stage", stages)
            continue
        if claim.station is None:
            continue
        if claim.probe == CRITICAL:
            allowed = f"none: of {CRITICAL!r} the first of a stage is meant"
            yield Mistake(f"{key}.station", f"{claim.station:g}", allowed)
            continue
        if not any(claim.speaks_of(*station) for station in _beside(ascending, claim.station)):
            listed = ", ".join(
                f"{value:g}"
                for stage in scene.stages
                if claim.in_stage(stage.name)
                for value in stage.stations[:_LISTED]
            )
            yield Mistake(f"{key}.station", f"{claim.station:g}", f"a station of a stage: {listed}")


def _beside(ascending: Mapping[str, list[float]], value: float) -> Iterator[tuple[str, float]]:
    """Of every stage the two stations between which a value lies."""
    for name, stations in ascending.items():
        place = bisect(stations, value)
        yield from ((name, station) for station in stations[max(0, place - 1) : place + 1])


def _bearers(scene: Scene) -> dict[str, list[str]]:
    """Names by what they are of: the keys of ``_SAID``."""
    fixed = {p for body in scene.bodies.values() if body.motion == "fixed" for p in body.points}
    ends = [end for beam in scene.beams.values() for end in (beam.start, beam.end)]
    supports = [end.point for end in ends if not isinstance(end, FreeEnd) and end.point in fixed]
    supports += [point for pin in scene.pins.values() for point in pin.points if point in fixed]
    pivots = [body.about for body in scene.bodies.values() if isinstance(body, TurningBody)]
    slides = [name for name, body in scene.bodies.items() if isinstance(body, SlidingBody)]
    points = [drive.point for drive in scene.drives.values() if isinstance(drive, DisplacementDrive)]
    bodies = [drive.body for drive in scene.drives.values() if isinstance(drive, RotationDrive)]
    return {
        "point": point_names(scene),
        "body": list(scene.bodies),
        "contact": list(scene.contacts),
        "beam": list(scene.beams),
        "support": list(dict.fromkeys((*supports, *pivots, *points, *slides))),
        "turned": list(dict.fromkeys((*supports, *bodies))),
        "stop": list(scene.stops),
        "holding": [
            *scene.stops,
            *(name for name, each in scene.contacts.items() if isinstance(each, EdgeContact) and _pinned(scene, each)),
        ],
        RESERVED: [RESERVED],
    }


def _pinned(scene: Scene, contact: EdgeContact) -> bool:
    """Whether an end of the beam is pinned to the edge's body, or to what is pinned to that at the same point."""
    beam = scene.beams.get(contact.beam)
    ends = () if beam is None else (beam.start, beam.end)
    together = {end.point for end in ends if isinstance(end, PinnedEnd)}
    for _ in scene.pins:
        together |= {point for pin in scene.pins.values() if together & set(pin.points) for point in pin.points}
    fixed = [body for body in scene.bodies.values() if body.motion == "fixed"]
    own = scene.bodies.get(contact.body)
    return any(together & set(body.points) for body in (fixed if own in fixed else [own]) if body is not None)
