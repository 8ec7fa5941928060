"""Names of a scene, unique and known to every reference; probes, claims and stages that fit the named parts."""

from collections.abc import Collection, Container, Iterator, Mapping

import numpy as np

from cprbm_scene.fields import Of, Record
from cprbm_scene.mistakes import LISTED, Mistake, broken, unknown_name
from cprbm_scene.statement import (
    CRITICAL,
    STRESSES,
    UNITS,
    BeamContact,
    DisplacementDrive,
    EdgeContact,
    FreeEnd,
    PaperContact,
    PinnedEnd,
    Quantity,
    RigidContact,
    RotationDrive,
    Scene,
    SlidingBody,
    TurningBody,
)

RESERVED = "scene"
"""Name of the scene itself in a probe."""

_TABLES = ("beams", "loads", "drives", "contacts", "stops", "pins")
"""Tables whose names are unique, together with the bodies and the points of all bodies."""


def references(value: object, key: str = "", of: Of | None = None) -> Iterator[tuple[Of, str, str]]:
    """Kinds, keys and names of all references within a ``value`` at a ``key``, itself a reference if ``of`` a kind."""
    match value:
        case str() if of is not None:
            yield of, key.removeprefix("."), value
        case Record():
            for name, field in type(value).model_fields.items():
                kind = next((each for each in field.metadata if isinstance(each, Of)), None)
                yield from references(getattr(value, name), f"{key}.{(kind and kind.key) or name}", kind)
        case Mapping():
            # the names of a mapping with a kind are references
            for name, each in value.items():
                yield from references(name if of else each, f"{key}.{name}", of)
        case tuple() if not isinstance(next(iter(value), None), float):
            for i, each in enumerate(value):
                yield from references(each, f"{key}[{i}]", of)


def repeated_names(scene: Scene) -> Iterator[Mistake]:
    """Names of points, bodies, beams, contacts, stops, pins, loads and drives with repeated or reserved names.

    A scene has a body for each named free end, unless the name of the body was taken.
    """
    named = [
        *((f"bodies.{name}", name) for name in scene.bodies),
        *((f"bodies.{name}.points.{point}", point) for name, body in scene.bodies.items() for point in body.points),
        *((f"{table}.{name}", name) for table in _TABLES for name in getattr(scene, table)),
    ]
    first = {name: key for key, name in reversed(named)}
    return broken(
        *(
            isinstance(end, FreeEnd)
            and end.point is not None
            and Mistake(
                f"beams.{name}.{side}.point",
                f"{end.point!r}, and another body with the name '{end.point}-body'",
                "another name of the free end",
            )
            for name, beam in scene.beams.items()
            for side, end, _ in beam.ends
        ),
        *(
            Mistake(key, f"the name {name!r}, which stands for the scene itself", "another name")
            if name == RESERVED
            else first[name] != key
            and Mistake(
                key,
                f"the name {name!r}, which {first[name]} has too",
                "names that are used once among points, bodies, beams, loads, drives, contacts, stops and pins",
            )
            for key, name in named
        ),
    )


MECHANICAL = ("point", "body", "beam")
"""Kinds of named parts without which a record has no place in the mechanism."""
_KINDS: Mapping[str, tuple[str, ...]] = {
    "material": ("materials",),
    "point": ("points",),
    "body": ("bodies",),
    "beam": ("beams",),
    "stage": ("stages",),
    "load": ("loads",),
    "load or drive": ("loads", "drives"),
    "beam or contact with a rigid edge": ("beams", "edges"),
}
"""Kinds of named parts, and their tables: ``points`` are of all bodies, ``edges`` the contacts with rigid edges."""


def unknown_names(scene: Scene, kinds: Collection[str] = tuple(_KINDS)) -> Iterator[Mistake]:
    """References to parts of some kinds without a definition; without words if the reader left the part out."""
    tables = {table: list(getattr(scene, table)) for table in ("materials", "bodies", "beams", "loads", "drives")} | {
        "points": list(scene.owners),
        "stages": [stage.name for stage in scene.stages],
        "edges": [name for name, contact in scene.contacts.items() if isinstance(contact, RigidContact)],
    }
    known = {kind: [name for table in _KINDS[kind] for name in tables[table]] for kind in kinds}
    return (
        Mistake(key, "", "")
        if scene.lacks(name, *_KINDS[of.kind])
        else unknown_name(key, name, of.kind, [*known[of.kind], *scene.left_out(*_KINDS[of.kind])])
        for of, key, name in references(scene)
        if of.kind in kinds and name not in known[of.kind]
    )


_OF: Mapping[Quantity, str] = {
    "displacement": "a point of a body or of a free end, end = { joint = 'free', point = 'NAME' }",
    "rotation": "a body",
    "force": "a contact",
    "centre": "a contact",
    "ends": "a contact",
    "closing_load": "a contact",
    "bending_stress": "a beam",
    "combined_stress": "a beam",
    "reaction": "a point of a fixed body at which a beam ends, a pivot, a driven point, or a body that slides",
    "reaction_moment": "a point of a fixed body at which a beam ends, or a body whose rotation is driven",
    "potential_energy": f"{RESERVED!r}, the scene itself",
    "angle": "a stop",
    "moment": "a stop, or a contact with a line, a half-plane or a function of the body that the beam is pinned to",
}
"""Parts of the scene with a quantity."""

_BEARERS = ("bodies", "points", "beams", "contacts", "stops")
_OF_JOINTS: Container[Quantity] = ("reaction", "reaction_moment", "moment")
"""Quantities of parts that a joint to other parts has, or a drive."""

_SEVERAL = STRESSES | {"displacement", "reaction", "ends"}
"""Quantities of more than one number."""


def wrong_probes(scene: Scene) -> Iterator[Mistake]:
    """Probes of unknown names, of parts without the quantity, repeated probes, and places of other than stress."""
    bearers = _bearers(scene)
    everything = list(dict.fromkeys(name for names in bearers.values() for name in names))
    first = {probe.name: i for i, probe in reversed(list(enumerate(scene.probes)))}
    for i, probe in enumerate(scene.probes):
        part, known = _OF[probe.quantity], bearers[_OF[probe.quantity]]
        allowed = f"{probe.quantity!r} of {part}: {', '.join(map(repr, known)) or 'there is none'}"
        yield from broken(
            probe.of not in everything
            and not scene.lacks(probe.of, *_BEARERS)
            and unknown_name(
                f"probes[{i}].of",
                probe.of,
                "point, body, beam, contact or stop",
                [*everything, *scene.left_out(*_BEARERS)],
            ),
            probe.of in everything
            and probe.of not in known
            and (scene.whole() or probe.quantity not in _OF_JOINTS)
            and Mistake(f"probes[{i}]", f"{probe.quantity!r} of {probe.of!r}", allowed),
            first[probe.name] < i and Mistake(f"probes[{i}]", f"{probe.name!r} again", "each probe once"),
            "points" in probe.model_fields_set
            and probe.quantity not in STRESSES
            and Mistake(
                f"probes[{i}].points",
                f"places along {probe.name!r}",
                "points for 'bending_stress' and 'combined_stress' only",
            ),
        )


def wrong_claims(scene: Scene) -> Iterator[Mistake]:
    """Claims on unknown probes, stages or stations, and a single value for a probe of several numbers."""
    probes = {probe.name: probe for probe in scene.probes}
    for i, claim in enumerate(scene.claims):
        key, probe, critical = f"claims[{i}]", probes.get(claim.probe), claim.probe == CRITICAL
        unasked = any(probe and not probe.asked_in(each.name) for each in scene.stages if each.name == claim.stage)
        own = [value for stage in scene.stages if claim.in_stage(stage.name) for value in stage.stations]
        yield from broken(
            not (probe or critical or scene.lacks(claim.probe, "probes"))
            and unknown_name(f"{key}.probe", claim.probe, "probe", [*probes, CRITICAL]),
            claim.value is not None
            and probe is not None
            and probe.quantity in _SEVERAL
            and Mistake(f"{key}.value", f"a value of {claim.probe!r}, which has several", "a probe of one number"),
            unasked
            and Mistake(f"{key}.stage", f"{claim.stage!r}, in which {claim.probe!r} is not asked", "another stage"),
            claim.station is not None
            and critical
            and Mistake(f"{key}.station", f"{claim.station:g}", f"none: of {CRITICAL!r} the first of a stage is meant"),
            claim.station is not None
            and not (unasked or critical)
            and scene.whole(["stages"])
            and not np.isclose(own, claim.station, rtol=1e-9, atol=0.0).any()
            and Mistake(
                f"{key}.station",
                f"{claim.station:g}",
                f"a station of a stage: {', '.join(f'{value:g}' for value in own[:LISTED])}",
            ),
        )


def wrong_stages(scene: Scene) -> Iterator[Mistake]:
    """Stages with the same name, with loads of different units together, or with a drive that is free there."""
    first = {stage.name: i for i, stage in reversed(list(enumerate(scene.stages)))}
    for i, stage in enumerate(scene.stages):
        units = sorted({str(UNITS[scene.loads[load].kind]) for load in stage.together if load in scene.loads})
        drive = scene.drives.get(stage.steps)
        yield from broken(
            first[stage.name] < i and Mistake(f"stages[{i}].name", f"{stage.name!r} again", "each stage's name once"),
            len(units) > 1 and Mistake(f"stages[{i}].steps", f"loads in {' and '.join(units)}", "loads of one unit"),
            drive is not None
            and not scene.holds(drive, stage.name)
            and Mistake(
                f"stages[{i}].steps",
                f"{stage.steps!r}, a drive that is free until the stage {drive.begins!r}",
                "a drive that holds, or a load",
            ),
        )


def wrong_contacts(scene: Scene) -> Iterator[Mistake]:
    """Contacts of the same beams or shape, and data for the formulation ``paper`` on beams outside the contact."""
    seen: dict[object, str] = {}
    for name, contact in scene.contacts.items():
        match contact:
            case RigidContact():
                # the same shape, whatever the formulation
                shape = frozenset[object](value for value in contact if value[0] not in {"thick", "paper"})
                what, part, same = "beam and the shape", "", shape
            case BeamContact():
                what, part, same = "pair", ".between", frozenset(contact.beams)
            case _:
                what, part, same = "beam", ".beam", frozenset(contact.beams)
        first, key, names = seen.setdefault(same, name), f"contacts.{name}", ", ".join(map(repr, contact.beams))
        allowed = f"one of the pair: {names}" if isinstance(contact, BeamContact) else f"the contact's beam {names}"
        boundary = contact.paper.boundary if isinstance(contact.paper, PaperContact) else contact.beams[0]
        related = contact.paper.related if contact.paper is not None else ()
        yield from broken(
            first != name and Mistake(f"{key}{part}", f"the {what} of contacts.{first} again", f"each {what} once"),
            boundary not in contact.beams and Mistake(f"{key}.paper.boundary", repr(boundary), allowed),
            *(
                beam not in contact.beams and Mistake(f"{key}.paper.related.{beam}", f"the beam {beam!r}", allowed)
                for beam in related
            ),
        )


def _bearers(scene: Scene) -> dict[str, list[str]]:
    """Names of the parts of the scene with a quantity, by the values of ``_OF``."""
    fixed = {point for body in scene.bodies.values() if body.motion == "fixed" for point in body.points}
    joined = (str(end.point) for beam in scene.beams.values() for _, end, _ in beam.ends)
    pinned = (point for pin in scene.pins.values() for point in pin.points)
    supports = [point for point in (*joined, *pinned) if point in fixed]
    moved = (
        *(body.about for body in scene.bodies.values() if isinstance(body, TurningBody)),
        *(drive.point for drive in scene.drives.values() if isinstance(drive, DisplacementDrive)),
        *(name for name, body in scene.bodies.items() if isinstance(body, SlidingBody)),
    )
    turned = (drive.body for drive in scene.drives.values() if isinstance(drive, RotationDrive))
    edges = [name for name, each in scene.contacts.items() if isinstance(each, EdgeContact) and _pinned(scene, each)]
    return {
        _OF["displacement"]: list(scene.owners),
        _OF["rotation"]: list(scene.bodies),
        _OF["force"]: list(scene.contacts),
        _OF["bending_stress"]: list(scene.beams),
        _OF["reaction"]: list(dict.fromkeys((*supports, *moved))),
        _OF["reaction_moment"]: list(dict.fromkeys((*supports, *turned))),
        _OF["angle"]: list(scene.stops),
        _OF["moment"]: [*scene.stops, *edges],
        _OF["potential_energy"]: [RESERVED],
    }


def connected(names: set[str], groups: Collection[set[str]]) -> set[str]:
    """The ``names`` with all names of the groups that are connected to them by common names."""
    reached = set(names)
    while more := {name for group in groups if group & reached for name in group} - reached:
        reached |= more
    return reached


def _pinned(scene: Scene, contact: EdgeContact) -> bool:
    """True if pins at the same point join the beam and the edge's body; fixed bodies count as the same body."""
    own = scene.bodies[contact.body]
    pinned = {end.point for _, end, _ in scene.beams[contact.beam].ends if isinstance(end, PinnedEnd)}
    together = connected(pinned, [set(pin.points) for pin in scene.pins.values()])
    bodies = [body for body in scene.bodies.values() if body == own or body.motion == own.motion == "fixed"]
    return any(together & set(body.points) for body in bodies)
