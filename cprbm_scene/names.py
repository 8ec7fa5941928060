"""Names of a scene: unique across the scene, and known to every reference."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cprbm_scene.mistakes import Mistake, unknown_name
from cprbm_scene.statement import BeamContact, RigidContact, Scene
from cprbm_scene.units import Of, Record

RESERVED = "scene"
"""Name of the scene itself in a probe."""

_TABLES = ("bodies", "beams", "loads", "drives", "contacts", "stops", "pins")
"""Tables whose names are unique, together with the points of all bodies."""


def records(value: object, key: str = "") -> Iterator[tuple[str, Record]]:
    """All records within a ``value`` at a ``key``, the value included, with their keys."""
    match value:
        case Record():
            yield key, value
            inner = [(f".{name}", each) for name, each in value]
        case Mapping():
            inner = [(f".{name}", each) for name, each in value.items()]
        case tuple():
            inner = [(f"[{i}]", each) for i, each in enumerate(value)]
        case _:
            return
    for part, each in inner:
        yield from records(each, f"{key}{part}".removeprefix("."))


def point_names(scene: Scene) -> list[str]:
    """Names of the points of all bodies."""
    return [point for body in scene.bodies.values() for point in body.points]


def repeated_names(scene: Scene) -> Iterator[Mistake]:
    """Names of points, bodies, beams, contacts, stops, pins, loads and drives with repeated or reserved names."""
    named = [(f"{table}.{name}", name) for table in _TABLES for name in getattr(scene, table)]
    points = [(f"bodies.{name}.points.{point}", point) for name, body in scene.bodies.items() for point in body.points]
    first: dict[str, str] = {}
    for key, name in (*named[: len(scene.bodies)], *points, *named[len(scene.bodies) :]):
        if name == RESERVED:
            yield Mistake(key, f"the name {name!r}, which stands for the scene itself", "another name")
        elif name in first:
            allowed = "names that are used once among points, bodies, beams, loads, drives, contacts, stops and pins"
            yield Mistake(key, f"the name {name!r}, which {first[name]} has too", allowed)
        first.setdefault(name, key)


def repeated_contacts(scene: Scene) -> Iterator[Mistake]:
    """Contacts of the same beams, or of the same beam and rigid shape."""
    seen: dict[object, str] = {}
    for name, contact in scene.contacts.items():
        rigid, paired = isinstance(contact, RigidContact), isinstance(contact, BeamContact)
        shape = tuple(value for field, value in contact if field not in {"thick", "paper"})
        first = seen.setdefault(shape if rigid else frozenset(contact.beams), name)
        if first != name:
            what, part = ("beam and the shape", "") if rigid else ("pair", ".between") if paired else ("beam", ".beam")
            yield Mistake(f"contacts.{name}{part}", f"the {what} of contacts.{first} again", f"each {what} once")


def unknown_names(scene: Scene) -> Iterator[Mistake]:
    """References to materials, points, bodies, beams, loads, drives and stages without a definition."""
    known: dict[str, Iterable[str]] = {
        "material": scene.materials,
        "point": point_names(scene),
        "body": scene.bodies,
        "beam": scene.beams,
        "stage": [stage.name for stage in scene.stages],
        "load": scene.loads,
        "load or drive": (*scene.loads, *scene.drives),
        "beam or contact with a rigid edge": [
            *scene.beams,
            *(name for name, contact in scene.contacts.items() if isinstance(contact, RigidContact)),
        ],
    }
    for key, record in records(scene):
        for field, info in type(record).model_fields.items():
            for of in (each for each in info.metadata if isinstance(each, Of)):
                for part, name in _named(getattr(record, field)):
                    if name not in known[of.kind]:
                        yield unknown_name(
                            f"{key}.{of.key or field}{part}".removeprefix("."), name, of.kind, known[of.kind]
                        )


def _named(value: object) -> Iterator[tuple[str, str]]:
    """Names in the value of a field, with places below the field's key."""
    match value:
        case str():
            yield "", value
        case Mapping():
            yield from ((f".{name}", name) for name in value)
        case tuple():
            yield from ((f"[{i}]{part}", name) for i, each in enumerate(value) for part, name in _named(each))
