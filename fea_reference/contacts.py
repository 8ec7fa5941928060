"""All of a scene's contacts, of any kind."""

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
"""Thicknesses: a gap that counts as closed."""


_APART = 1e-3  # thicknesses: gap above which the sides of beams are evident


def contacts(scene: Scene, model: Model, penetration: float) -> tuple[Contact, ...]:
    """The scene's contacts in order."""
    every: tuple[Contact, ...] = (
        *contact.pairs(scene, model),
        *contact.selves(scene, model),
        *circle.circles(scene, model, penetration),
        *face.faces(scene, model, penetration),
    )
    found = {one.name: one for one in every}
    return tuple(found[name] for name in scene.contacts)


def zones_of(model: Model, what: Contact, z: State) -> Zones:
    """Zones of overlap in state ``z``."""
    return model.overlaps.found(z, what, lambda: _zones_of(model, what, z))


def least_gap(model: Model, what: Contact, z: State) -> float:
    """The least gap in state ``z``; for two beams including ends of the second on the side of the first."""
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
    """Contact energy derivatives, see :func:`fea_reference.contact.touch`; only pairs of beams are held."""
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
    """Mean line pressure from axial forces where a beam lies on the opposite surface; zero on a straight edge."""
    match one.pair:
        case Pair():
            return contact.resting_pressure(model, one, one.pair, z)
        case Circle():
            return circle.resting_pressure(model, one, one.pair, z)
        case Face():
            return 0.0


def looked_at(model: Model, what: Contact, z: State) -> Contact:
    """The contact; for self-contact with the sides of state ``z``."""
    if isinstance(what, Pair) and what.roles is not None:
        return replace(what, roles=what.roles.renewed(model.line(model.beams[what.first], z)))
    return what


def open_in(model: Model, what: Contact, z: State) -> Contact:
    """An open contact in state ``z``; for two beams near each other with the sides of that state."""
    if not isinstance(what, Pair) or what.roles is not None:
        return looked_at(model, what, z)
    apart = least_apart(model, what, z) <= FAR and least_gap(model, what, z) > _APART * what.scale
    return contact.looked_at(model, what, z) if apart else what


def room(model: Model, what: Contact, z: State) -> float:
    """Lower bound of the relative motion before the contact needs evaluation; −∞ for self-contact and edges."""
    match what:
        case Pair(roles=None):
            return contact.room(model, what, z)
        case Circle():
            return circle.room(model, what, z)
        case _:
            return -np.inf


def clear(model: Model, what: Contact, z: State) -> float:
    """Lower bound of the relative motion before an overlap, from the least gap.

    No two places approach by more than their motions. Places beyond an end of the other beam have no gap; their
    distance from the beam is their distance from the end. The ends of a line in self-contact have no bound. A beam
    folded within its own thickness is beyond the elements.
    """
    least = zones_of(model, what, z).least
    numbers = (what.first, what.second) if isinstance(what, Pair) else (what.first,)
    longest = [model.line(model.beams[i], z).longest for i in numbers]
    # a distance above an element's length may be between nodes only, and smaller in between
    least = least if least <= longest[-1] else max(longest[-1], least - max(longest))
    if not isinstance(what, Pair) or what.ended:
        return least
    return min(least, contact.ends_apart(model, what, z)) if what.roles is None else -np.inf


def against(model: Model, what: Contact, before: State, after: State) -> float:
    """Upper bound of the relative motion on the straight way between two states; infinite for an edge."""

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
    """True if the bodies of the contact passed through each other between two states."""
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
    # Lines without thickness cross by the penetration of the penalty, which is held and measured. At mere contact,
    # chords cross by the sagitta of their elements.
    held = what.distance == 0.0 and least_gap(model, what, after) <= CLOSED * what.scale
    return not held and cross(first, second)
