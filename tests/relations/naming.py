"""Nothing is another because it is named later, or second."""

from __future__ import annotations

from cprbm_scene import Probe
from cprbm_scene.answer import Array
from tests.relations.image import Data, Image, copied

UNORDERED = ("materials", "bodies", "beams", "loads", "drives", "contacts", "stops", "pins")
"""Tables whose order means nothing; that of stages is the order of events."""


def backwards(data: Data) -> Image:
    """Everything in the opposite order: the tables that have none, points of bodies and pins, probes."""
    new = copied(data)
    for table in UNORDERED:
        if table in new:
            new[table] = dict(reversed(new[table].items()))
    for body in new["bodies"].values():
        body["points"] = dict(reversed(body["points"].items()))
    for pin in new.get("pins", {}).values():
        pin["points"] = pin["points"][::-1]
    new["probes"] = new["probes"][::-1]
    return Image("in the opposite order", new)


def other_way_round(data: Data, contact: str) -> Image:
    """The image in which a ``contact`` of two beams names the second one first.

    Places are measured along that one, and a solver may have chosen where it asks for gaps by which is the first.
    """
    new = copied(data)
    new["contacts"][contact]["between"].reverse()

    def expected(probe: Probe, stage: str, value: Array) -> Array | None:
        return None if probe.of == contact and probe.quantity in ("centre", "ends", "moment") else value

    return Image(f"{contact} named the other way round", new, expected, discretised_anew=True)
