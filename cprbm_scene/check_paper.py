"""What a scene tells the formulation ``paper``: elements along an axis, the boundary's beam, related joints."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cprbm_scene.check_shapes import is_beam
from cprbm_scene.geometry import arc_length, tangents_on
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import Beam, BeamContact, PaperContact, PaperRigid, Scene

SAMPLES = 1001  # of a beam's tangent
BACKWARDS = 1e-9  # part of a unit tangent that is none
LEAST_EXTENT = 1e-3  # of the beam's length, along the axis


def wrong_spacings(scene: Scene) -> Iterator[Mistake]:
    """Elements that shall be uniform along an axis along which the beam turns back, or does not run."""
    for name, beam in scene.beams.items():
        if beam.paper is not None and is_beam(beam) and not _runs_along(beam, beam.paper.uniform):
            yield Mistake(
                f"beams.{name}.paper.uniform",
                f"{beam.paper.uniform!r}, along which the curve turns back or does not run",
                "an axis along which the curve runs one way",
            )


def wrong_hints(scene: Scene) -> Iterator[Mistake]:
    """Entries that belong to no beam of their contact, and ranges of joints that are none."""
    for name, contact in scene.contacts.items():
        key = f"contacts.{name}.paper"
        if contact.paper is None:
            continue
        named = ", ".join(repr(beam) for beam in contact.beams)
        allowed = f"one of the pair: {named}" if isinstance(contact, BeamContact) else f"the contact's beam {named}"
        if isinstance(contact.paper, PaperContact) and contact.paper.boundary not in contact.beams:
            yield Mistake(f"{key}.boundary", repr(contact.paper.boundary), allowed)
        yield from _wrong_related(key, contact.paper, contact.beams, allowed)


def _runs_along(beam: Beam, axis: str) -> bool:
    part = 0 if axis == "x" else 1
    extent = beam.curve.end[part] - beam.curve.start[part]
    forwards = np.sign(extent) * tangents_on(beam.curve, np.linspace(0.0, 1.0, SAMPLES))[:, part]
    return abs(extent) >= LEAST_EXTENT * arc_length(beam.curve) and bool(np.all(forwards >= -BACKWARDS))


def _wrong_related(
    key: str, paper: PaperContact | PaperRigid, beams: tuple[str, ...], allowed: str
) -> Iterator[Mistake]:
    for beam, related in paper.related.items():
        where = f"{key}.related.{beam}"
        if beam not in beams:
            yield Mistake(where, f"the beam {beam!r}", allowed)
        given = [(axis, span) for axis, span in (("x", related.x), ("y", related.y)) if span is not None]
        if len(given) != 1:
            yield Mistake(where, "both x and y" if given else "neither x nor y", "a range in exactly one of x and y")
        for axis, span in given:
            if span[0] >= span[1]:
                yield Mistake(f"{where}.{axis}", str(list(span)), "a range from the smaller to the larger value")
