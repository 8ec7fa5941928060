"""Names: unique across the scene, and references to existing names."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from cprbm_scene.mistakes import Mistake, unknown_name
from cprbm_scene.statement import BeamContact, BodyLoad, FreeEnd, Moment, RigidContact, RotationDrive, Scene

RESERVED = "scene"


def point_names(scene: Scene) -> list[str]:
    """Names of the points of all bodies."""
    return [point for body in scene.bodies.values() for point in body.points]


def repeated_names(scene: Scene) -> Iterator[Mistake]:
    """Repeated or reserved names of points, bodies, beams, contacts, stops, pins, loads and drives."""
    bearers = [
        *((f"bodies.{name}", name) for name in scene.bodies),
        *((f"bodies.{name}.points.{point}", point) for name, body in scene.bodies.items() for point in body.points),
        *((f"beams.{name}", name) for name in scene.beams),
        *((f"loads.{name}", name) for name in scene.loads),
        *((f"drives.{name}", name) for name in scene.drives),
        *((f"contacts.{name}", name) for name in scene.contacts),
        *((f"stops.{name}", name) for name in scene.stops),
        *((f"pins.{name}", name) for name in scene.pins),
    ]
    first: dict[str, str] = {}
    for key, name in bearers:
        if name == RESERVED:
            yield Mistake(key, f"the name {name!r}, which stands for the scene itself", "another name")
        elif name in first:
            allowed = "names that are used once among points, bodies, beams, loads, drives, contacts, stops and pins"
            yield Mistake(key, f"the name {name!r}, which {first[name]} has too", allowed)
        first.setdefault(name, key)


def unknown_names(scene: Scene) -> Iterator[Mistake]:
    """References to missing materials, points, bodies, beams, contacts, loads and drives, and pairs of one name."""
    for key, name, what, known in _references(scene):
        if name not in known:
            yield unknown_name(key, name, what, known)
    for i, pair in enumerate(scene.may_cross):
        if pair[0] == pair[1]:
            yield Mistake(f"may_cross[{i}]", f"{pair[0]!r} twice", "two different names")


def _references(scene: Scene) -> Iterator[tuple[str, str, str, Collection[str]]]:
    """Every reference by name: the key, the name, the kind of record, and the existing names."""
    points, beams = point_names(scene), scene.beams
    for name, beam in beams.items():
        yield f"beams.{name}.material", beam.material, "material", scene.materials
        for side, end in (("start", beam.start), ("end", beam.end)):
            if not isinstance(end, FreeEnd):
                yield f"beams.{name}.{side}.point", end.point, "point", points
    loads = ((f"loads.{name}", load) for name, load in scene.loads.items() if isinstance(load, BodyLoad))
    for key, each in (*loads, *((f"drives.{name}", drive) for name, drive in scene.drives.items())):
        if isinstance(each, Moment | RotationDrive):
            yield f"{key}.body", each.body, "body", scene.bodies
        else:
            yield f"{key}.point", each.point, "point", points
    for name, contact in scene.contacts.items():
        for i, beam_name in enumerate(contact.beams):
            key = f"between[{i}]" if isinstance(contact, BeamContact) else "beam"
            yield f"contacts.{name}.{key}", beam_name, "beam", beams
        if isinstance(contact, RigidContact):
            yield f"contacts.{name}.body", contact.body, "body", scene.bodies
    for name, stop in scene.stops.items():
        yield f"stops.{name}.beam", stop.beam, "beam", beams
        yield f"stops.{name}.towards", stop.towards, "point", points
    for name, pin in scene.pins.items():
        yield from ((f"pins.{name}.points[{i}]", point, "point", points) for i, point in enumerate(pin.points))
    for beam_name in scene.assembly.moments if scene.assembly is not None else ():
        yield f"assembly.moments.{beam_name}", beam_name, "beam", beams
    crossing = [*beams, *(name for name, contact in scene.contacts.items() if isinstance(contact, RigidContact))]
    for i, pair in enumerate(scene.may_cross):
        for j, name in enumerate(pair):
            yield f"may_cross[{i}][{j}]", name, "beam or contact with a rigid edge", crossing
    for i, stage in enumerate(scene.stages):
        yield f"stages[{i}].steps", stage.steps, "load or drive", (*scene.loads, *scene.drives)
