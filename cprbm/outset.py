"""What of a scene no mesh changes: neutral lines, sections, units, bodies, and how beams stand to each other.

It is worked out once, and every mesh of the scene is made of it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cprbm.curves import NeutralLine, neutral_line
from cprbm.made import Made
from cprbm.section import Section, largest_rigidity, section_of
from cprbm.standing import Attachment, Side, Standing, standing
from cprbm.staying import led, staying
from cprbm_scene import (
    BeamContact,
    BeamEnd,
    CircleContact,
    FreeEnd,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    RigidContact,
    Scene,
    WeldedEnd,
)
from cprbm_scene.answer import Array
from cprbm_scene.statement import BeamMoment


@dataclass(frozen=True, slots=True, eq=False)
class Outset:
    """A scene's beams, bodies and contacts for all meshes; by name what is not said to be otherwise.

    Attributes:
        lines: neutral lines, metres.
        moduli: E of the beams, Pa.
        sections: thickness and E·I along the beams, without units.
        unit_length: ℓ, m.
        unit_moment: S, N·m.
        free_bodies: names of the bodies that move.
        references: initial positions of their reference places (B, 2), units of length.
        starts, ends: what the beams' ends are joined to; no end is None for a free one, a free start a body of its own.
        loose: beams with a free start.
        marks: centres of circles and first places of edges on bodies that move, by contact.
        bent: where moments act within beams, shares of the length, ascending; of beams with any.
        standing: how the two beams of a contact stand to each other, made when it is asked for.
        at_home: the same while the bodies that drives lead are where they are drawn.
    """

    lines: Mapping[str, NeutralLine]
    moduli: Mapping[str, float]
    sections: Mapping[str, Section]
    unit_length: float
    unit_moment: float
    free_bodies: tuple[str, ...]
    references: Array
    starts: Mapping[str, Attachment]
    ends: Mapping[str, Attachment | None]
    loose: frozenset[str]
    marks: Mapping[str, Attachment]
    bent: Mapping[str, tuple[float, ...]]
    standing: Mapping[str, Standing]
    at_home: Mapping[str, Standing]


def outset_of(scene: Scene) -> Outset:
    """What every mesh of a ``scene`` is made of."""
    lines = {name: neutral_line(beam.curve) for name, beam in scene.beams.items()}
    unit_length = max(line.length for line in lines.values())
    moduli = {name: scene.materials[beam.material].youngs_modulus for name, beam in scene.beams.items()}
    unit_moment = max(largest_rigidity(beam, moduli[name]) for name, beam in scene.beams.items()) / unit_length
    places = {name: next(iter(body.points.values())) for name, body in scene.bodies.items() if body.motion != "fixed"}
    # a chain begins somewhere: a start that nothing holds is welded to a body that nothing else holds
    loose = frozenset(name for name, beam in scene.beams.items() if isinstance(beam.start, FreeEnd))
    places |= {_loose(name): scene.beams[name].curve.start for name in scene.beams if name in loose}
    number = {name: i for i, name in enumerate(places)}

    stay, lead = staying(scene, unit_length), led(scene, unit_length)

    def on(owner: str, point: tuple[float, float], *, welded: bool) -> Attachment:
        (x, y), (x0, y0) = point, places.get(owner, (0.0, 0.0))
        at = (x - x0) / unit_length, (y - y0) / unit_length
        return Attachment(number.get(owner, -1), at, welded, stays=owner in stay, led=owner in lead)

    def joined(end: BeamEnd) -> Attachment | None:
        if isinstance(end, FreeEnd):
            return None
        owner = scene.body_of(end.point)
        return on(owner, scene.bodies[owner].points[end.point], welded=isinstance(end, WeldedEnd))

    starts = {
        name: joined(beam.start) or Attachment(number[_loose(name)], (0.0, 0.0), welded=True)
        for name, beam in scene.beams.items()
    }
    ends = {name: joined(beam.end) for name, beam in scene.beams.items()}
    sections = {
        name: section_of(beam, moduli[name], lines[name].length, unit_length, unit_moment)
        for name, beam in scene.beams.items()
    }

    def stand(contact: str, *, home: bool) -> Standing:
        of = scene.contacts[contact]
        assert isinstance(of, BeamContact)
        one, other = (
            Side(lines[name], sections[name], (_at_home(held[0]), _at_home(held[1])) if home else held)
            for name, held in ((name, (starts[name], ends[name])) for name in of.between)
        )
        return standing(one, other, unit_length, thick=of.thick)

    beside = [name for name, contact in scene.contacts.items() if isinstance(contact, BeamContact)]

    return Outset(
        lines=lines,
        moduli=moduli,
        sections=sections,
        unit_length=unit_length,
        unit_moment=unit_moment,
        free_bodies=tuple(places),
        references=np.array(list(places.values()), dtype=float).reshape(-1, 2) / unit_length,
        starts=starts,
        ends=ends,
        loose=loose,
        marks={
            name: on(contact.body, anchor(contact), welded=False)
            for name, contact in scene.contacts.items()
            if isinstance(contact, RigidContact) and contact.body in number
        },
        bent=_bent(scene),
        standing=Made(beside, lambda contact: stand(contact, home=False)),
        at_home=Made(beside, lambda contact: stand(contact, home=True)),
    )


def anchor(contact: RigidContact) -> tuple[float, float]:
    """A place of what a beam may touch, m: the centre of a circle, the first place of an edge."""
    match contact:
        case CircleContact():
            return contact.center
        case LineContact():
            return contact.points[0]
        case HalfPlaneContact():
            return contact.point
    assert isinstance(contact, FunctionContact)
    return contact.curve.start


def _bent(scene: Scene) -> dict[str, tuple[float, ...]]:
    found = dict[str, set[float]]()
    for load in scene.loads.values():
        if isinstance(load, BeamMoment) and 0.0 < load.at < 1.0:
            found.setdefault(load.beam, set()).add(load.at)
    return {beam: tuple(sorted(marks)) for beam, marks in found.items()}


def _at_home(end: Attachment | None) -> Attachment | None:
    return None if end is None else end.at_home


def _loose(beam: str) -> str:
    """Name of the body of a beam's free start; no name in a scene holds a dot."""
    return f"{beam}.start"
