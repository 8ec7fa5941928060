"""Structures of closed contacts at given places."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from cprbm_scene.frozendict import frozendict
from elastica_reference.gaps import Overlap
from elastica_reference.model import Model
from elastica_reference.newton import LostError
from elastica_reference.state import Known
from elastica_reference.structure import Meeting, Resting, Structure, Touch, Wrap

Places = Mapping[tuple[str, str], float]
"""Places of contacts, by (contact, key) as in :class:`elastica_reference.layout.Layout`."""


class NotCoveredError(Exception):
    """The solution has no equations for the scene's state; the text says which."""


def structure_of(model: Model, touches: Mapping[str, Touch], places: Places) -> Structure:
    """The structure of closed contacts at given places.

    Raises:
        NotCoveredError: a section has a kink, a load or a varying thickness where the beam lies on a circle.
    """
    order: dict[str, tuple[float | str, ...]] = {}
    for beam, strip in model.strips.items():
        items: list[tuple[float, float | str]] = [(knot, knot) for knot in strip.knots]
        for name, touch in touches.items():
            if isinstance(touch, Wrap) and touch.beam == beam:
                begin = 0.0 if touch.from_start else places[name, "begin"]
                end = strip.length if touch.to_end else places[name, "end"]
                if strip.beam.tapered and model.scene.contacts[name].thick:
                    raise NotCoveredError(f"{beam} lies along the circle of {name} with a varying thickness")
                if strip.spread:
                    raise NotCoveredError(f"{beam} lies along the circle of {name} under a distributed load")
                if any(begin <= knot <= end for knot in strip.knots):
                    raise NotCoveredError(
                        f"{beam} lies along the circle of {name} where its section has a kink or a force acts"
                    )
                items.append((begin, name))
            elif (name, beam) in places:
                items.append((places[name, beam], name))
        order[beam] = tuple(item for _, item in sorted(items, key=lambda item: item[0]))
    return Structure(frozendict(touches), frozendict(order))


def moved_to_ends(
    known: Known, model: Model, touch: Touch, places: Places
) -> tuple[Touch, dict[tuple[str, str], float]]:
    """A touch with its place moved to an end of the beam if beyond, and the places.

    Raises:
        LostError: an end in contact slid off the other beam's end, possibly in a step too long.
    """
    kept = dict(places)
    if isinstance(touch, Wrap):
        return touch, kept
    name = touch.contact
    s = _within(model, touch.beam, touch.at if touch.at is not None else places[name, touch.beam])
    if touch.at is None and s != places[name, touch.beam]:
        del kept[name, touch.beam]
        touch = replace(touch, at=s)
    if not isinstance(touch, Meeting):
        return touch, kept
    sigma = _within(model, touch.onto, places[name, touch.onto])
    if sigma == places[name, touch.onto]:
        return touch, kept
    if touch.at is not None:
        raise LostError(f"the place of {name} slides off the end of {touch.onto}")
    # the end of the second beam touches the first beam, which may run in the opposite direction
    del kept[name, touch.onto]
    angles = [float(known.along(beam, np.array([at]))[2, 0]) for beam, at in ((touch.beam, s), (touch.onto, sigma))]
    side = -touch.side if math.cos(angles[1] - angles[0]) > 0.0 else touch.side
    return Meeting(name, touch.onto, sigma, touch.beam, side, touch.apart), kept


def _within(model: Model, beam: str, s: float) -> float:
    return min(max(s, 0.0), model.strips[beam].length)


def touch_for(model: Model, overlap: Overlap) -> tuple[Touch, dict[tuple[str, str], float]]:
    """The touch for an overlap, and its places."""
    strip = model.strips[overlap.beam]
    at = overlap.s if overlap.at_end else None
    places = {} if overlap.at_end else {(overlap.contact, overlap.beam): overlap.s}
    if overlap.onto is None:
        return Resting(overlap.contact, overlap.beam, at), places
    apart = 0.0
    if model.scene.contacts[overlap.contact].thick:
        other = model.strips[overlap.onto]
        halves = strip.half_thickness(np.array([overlap.s])) + other.half_thickness(np.array([overlap.sigma]))
        apart = float(halves[0])
    places[overlap.contact, overlap.onto] = overlap.sigma
    return Meeting(overlap.contact, overlap.beam, at, overlap.onto, overlap.side, apart), places
