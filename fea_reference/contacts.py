"""All of a scene's contacts, of whichever kind."""

from dataclasses import replace

import numpy as np

from cprbm_scene.statement import Scene
from fea_reference import circle, contact, face
from fea_reference.crossing import cross, crosses_itself
from fea_reference.end_on_end import ends_through
from fea_reference.far import FAR, kept_apart, least_apart
from fea_reference.model import Model
from fea_reference.state import State
from fea_reference.touch import Circle, Contact, Face, Pair, Penalty, Touch
from fea_reference.zones import Zones, none

CLOSED = 1e-9
"""Of the thickness, a gap that is none."""


_APART = 1e-3  # of the thickness: a gap at which one sees on which side of each other beams lie


def contacts(scene: Scene, model: Model, penetration: float) -> tuple[Contact, ...]:
    """What may touch, in the scene's order."""
    every: tuple[Contact, ...] = (
        *contact.pairs(scene, model),
        *contact.selves(scene, model),
        *circle.circles(scene, model, penetration),
        *face.faces(scene, model, penetration),
    )
    found = {one.name: one for one in every}
    return tuple(found[name] for name in scene.contacts)


def zones_of(model: Model, what: Contact, z: State) -> Zones:
    """Where there is overlap in state ``z``."""
    return model.overlaps.found(z, what, lambda: _zones_of(model, what, z))


def least_gap(model: Model, what: Contact, z: State) -> float:
    """The least gap in state ``z``; of two beams also where an end of the second is on the side of the first."""
    least = zones_of(model, what, z).least
    if not isinstance(what, Pair) or what.roles is not None or least > FAR:
        return least
    return min(least, contact.least_at_ends(model, what, z))


def _zones_of(model: Model, what: Contact, z: State) -> Zones:
    apart = least_apart(model, what, z)
    if apart > FAR:
        return none(apart)
    match what:
        case Pair():
            return contact.zones_of(model, what, z)
        case Circle():
            return circle.zones_of(model, what, z)
        case Face():
            return face.zones_of(model, what, z)


def touch(model: Model, what: Contact, penalty: Penalty, quadrature: int, z: State, held: float | None = None) -> Touch:
    """The penalty's energy derivatives, see :func:`fea_reference.contact.touch`; only beams are ever held."""
    key = what, penalty, quadrature, held
    return model.touches.found(z, key, lambda: _touch(model, what, penalty, quadrature, z, held))


def _touch(model: Model, what: Contact, penalty: Penalty, quadrature: int, z: State, held: float | None) -> Touch:
    match what:
        case Pair():
            return contact.touch(model, what, penalty, quadrature, z, held)
        case Circle():
            return circle.touch(model, what, penalty, quadrature, z)
        case Face():
            return face.touch(model, what, penalty, quadrature, z)


def resting_pressure(model: Model, one: Touch, z: State) -> float:
    """The line pressure that the axial forces give where a beam lies on what it touches, on average.

    On a straight edge they give none.
    """
    match one.pair:
        case Pair():
            return contact.resting_pressure(model, one, one.pair, z)
        case Circle():
            return circle.resting_pressure(model, one, one.pair, z)
        case Face():
            return 0.0


def looked_at(model: Model, what: Contact, z: State) -> Contact:
    """The same contact; of a beam and itself with the sides on which its places lie in state ``z``."""
    if isinstance(what, Pair) and what.roles is not None:
        return replace(what, roles=what.roles.renewed(model.line(model.beams[what.first], z)))
    return what


def open_in(model: Model, what: Contact, z: State) -> Contact:
    """The same of a contact that is open in state ``z``; of two beams that are near each other, as they lie there."""
    if not isinstance(what, Pair) or what.roles is not None:
        return looked_at(model, what, z)
    apart = least_apart(model, what, z) <= FAR and least_gap(model, what, z) > _APART * what.scale
    return contact.looked_at(model, what, z) if apart else what


def room(model: Model, what: Contact, z: State) -> float:
    """How far what may touch can move, each against the other, before anything of it is seen to: a lower bound.

    Of a beam and itself, and of an edge, nothing is known.
    """
    match what:
        case Pair(roles=None):
            return contact.room(model, what, z)
        case Circle():
            return circle.room(model, what, z)
        case _:
            return -np.inf


def clear(model: Model, what: Contact, z: State) -> float:
    """How far what may touch can move, each against the other, before it overlaps: by the least gap, a lower bound.

    No two places come nearer to each other by more than they move.  Places of a beam beyond an end of the other have
    no gap, and are as far from it as from that end; of a line's own ends nothing is known.  That a beam bends double
    within its own thickness is no motion that its elements follow.
    """
    least = zones_of(model, what, z).least
    numbers = (what.first, what.second) if isinstance(what, Pair) else (what.first,)
    longest = [model.line(model.beams[i], z).longest for i in numbers]
    # what is farther than an element may be known by nodes only, and be nearer between them
    least = least if least <= longest[-1] else max(longest[-1], least - max(longest))
    if not isinstance(what, Pair) or what.ended:
        return least
    return min(least, contact.ends_apart(model, what, z)) if what.roles is None else -np.inf


def against(model: Model, what: Contact, before: State, after: State) -> float:
    """The most by which places of what may touch move against each other on the straight way between two states."""

    def way(number: int) -> float:
        dofs = model.node_dofs[:2, model.beams[number].nodes]
        dx, dy = after.values[dofs] - before.values[dofs]
        return float(np.hypot(dx, dy).max())

    match what:
        case Pair():
            return way(what.first) + way(what.second)
        case Circle():
            x, y, phi = model.body_state(model.bodies[what.body], after) - model.body_state(
                model.bodies[what.body], before
            )
            return way(what.first) + float(np.hypot(x, y) + abs(phi) * np.hypot(*what.arm))
        case Face():
            return np.inf


def passed_through(model: Model, what: Contact, before: State, after: State) -> bool:
    """Whether what may touch has passed through each other on the way from one state to another."""
    if isinstance(what, Circle | Face):
        gaps = zones_of(model, what, before).least, zones_of(model, what, after).least
        if kept_apart(model, what, gaps, before, after):
            return False
    if isinstance(what, Circle):
        return circle.passed(model, what, before, after)
    if isinstance(what, Face):
        return face.passed(model, what, before, after)
    first, second = (model.line(model.beams[i], after) for i in (what.first, what.second))
    if what.roles is not None:
        line = model.line(model.beams[what.first], before)
        return ends_through(what, line, first) or crosses_itself(first, contact.zones_of(model, what, after))
    # Lines without thickness cross by what the penalty lets through; that is held, and measured.  Where one just
    # touches the other, chords cross by what their elements bow.
    held = what.distance == 0.0 and least_gap(model, what, after) <= CLOSED * what.scale
    return not held and cross(first, second)
