"""Names: each used once across the scene, and none that nothing bears."""

from __future__ import annotations

from collections.abc import Iterator

from cprbm_scene.mistakes import Mistake, unknown_name
from cprbm_scene.statement import BeamContact, BodyLoad, FreeEnd, Moment, RigidContact, RotationDrive, Scene

RESERVED = "scene"


def point_names(scene: Scene) -> list[str]:
    """Names of the points of all bodies."""
    return [point for body in scene.bodies.values() for point in body.points]


def repeated_names(scene: Scene) -> Iterator[Mistake]:
    """Names of points, bodies, beams, contacts, stops, pins, loads and drives that are used twice or reserved."""
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
    """References to materials, points, bodies, beams, loads and drives that do not exist."""
    points = point_names(scene)
    for name, beam in scene.beams.items():
        if beam.material not in scene.materials:
            yield unknown_name(f"beams.{name}.material", beam.material, "material", scene.materials)
        for side, end in (("start", beam.start), ("end", beam.end)):
            if not isinstance(end, FreeEnd) and end.point not in points:
                yield unknown_name(f"beams.{name}.{side}.point", end.point, "point", points)
    acting = [(f"loads.{name}", load) for name, load in scene.loads.items() if isinstance(load, BodyLoad)]
    driving = [(f"drives.{name}", drive) for name, drive in scene.drives.items()]
    for key, each in (*acting, *driving):
        if isinstance(each, Moment | RotationDrive):
            if each.body not in scene.bodies:
                yield unknown_name(f"{key}.body", each.body, "body", scene.bodies)
        elif each.point not in points:
            yield unknown_name(f"{key}.point", each.point, "point", points)
    for name, contact in scene.contacts.items():
        paired = isinstance(contact, BeamContact)
        for i, beam_name in enumerate(contact.beams):
            if beam_name not in scene.beams:
                key = f"between[{i}]" if paired else "beam"
                yield unknown_name(f"contacts.{name}.{key}", beam_name, "beam", scene.beams)
        if isinstance(contact, RigidContact) and contact.body not in scene.bodies:
            yield unknown_name(f"contacts.{name}.body", contact.body, "body", scene.bodies)
    for name, stop in scene.stops.items():
        if stop.beam not in scene.beams:
            yield unknown_name(f"stops.{name}.beam", stop.beam, "beam", scene.beams)
        if stop.towards not in points:
            yield unknown_name(f"stops.{name}.towards", stop.towards, "point", points)
    for name, pin in scene.pins.items():
        for i, point in enumerate(pin.points):
            if point not in points:
                yield unknown_name(f"pins.{name}.points[{i}]", point, "point", points)
    for beam_name in scene.assembly.moments if scene.assembly is not None else ():
        if beam_name not in scene.beams:
            yield unknown_name(f"assembly.moments.{beam_name}", beam_name, "beam", scene.beams)
    for i, stage in enumerate(scene.stages):
        if stage.steps not in scene.loads and stage.steps not in scene.drives:
            yield unknown_name(f"stages[{i}].steps", stage.steps, "load or drive", (*scene.loads, *scene.drives))
