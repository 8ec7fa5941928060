"""All of a scene's contacts, of any kind."""

from dataclasses import replace

import numpy as np

from cprbm_scene.statement import Scene
from fea_reference import circle, contact, face
from fea_reference.crossing import crosses_itself, lines_cross
from fea_reference.end_on_end import ends_pass_through
from fea_reference.far import FAR, cannot_touch, gap_lower_bound
from fea_reference.model import Model
from fea_reference.state import State
from fea_reference.touch import Circle, Contact, Face, Pair, Penalty, Touch
from fea_reference.zones import Zones, no_zones

CLOSED = 1e-9
"""Thicknesses: a gap that counts as closed."""


_APART = 1e-3  # thicknesses: gap above which the sides of beams are evident


def contacts(scene: Scene, model: Model, penetration: float) -> tuple[Contact, ...]:
    """The scene's contacts in order."""
    candidates: tuple[Contact, ...] = (
        *contact.pairs(scene, model),
        *contact.self_contacts(scene, model),
        *circle.circles(scene, model, penetration),
        *face.faces(scene, model, penetration),
    )
    by_name = {candidate.name: candidate for candidate in candidates}
    return tuple(by_name[name] for name in scene.contacts)


def zones_of(model: Model, pair: Contact, z: State) -> Zones:
    """Zones of overlap in state ``z``."""
    return model.known.recall(z, ("zones", pair), lambda: _zones_of(model, pair, z))


def least_gap(model: Model, pair: Contact, z: State) -> float:
    """The least gap in state ``z``; for two beams including ends of the second on the side of the first."""
    least = zones_of(model, pair, z).least
    if not isinstance(pair, Pair) or pair.roles is not None or least > FAR:
        return least
    return min(least, contact.least_at_ends(model, pair, z))


def _zones_of(model: Model, pair: Contact, z: State) -> Zones:
    apart = gap_lower_bound(model, pair, z)
    if apart > FAR:
        return no_zones(apart)
    match pair:
        case Pair():
            return contact.zones_of(model, pair, z)
        case Circle():
            return circle.zones_of(model, pair, z)
        case Face():
            return face.zones_of(model, pair, z)


def touch(
    model: Model, pair: Contact, penalty: Penalty, quadrature: int, z: State, held_depth: float | None = None
) -> Touch:
    """Contact energy derivatives, see :func:`fea_reference.contact.touch`; only pairs of beams are held."""
    return model.known.recall(
        z,
        ("touch", pair, penalty, quadrature, held_depth),
        lambda: _touch(model, pair, penalty, quadrature, z, held_depth),
    )


def _touch(model: Model, pair: Contact, penalty: Penalty, quadrature: int, z: State, held_depth: float | None) -> Touch:
    match pair:
        case Pair():
            return contact.touch(model, pair, penalty, quadrature, z, held_depth)
        case Circle():
            return circle.touch(model, pair, penalty, quadrature, z)
        case Face():
            return face.touch(model, pair, penalty, quadrature, z)


def resting_pressure(model: Model, evaluated: Touch, z: State) -> float:
    """Mean line pressure from axial forces where a beam lies on the opposite surface; zero on a straight edge."""
    match evaluated.pair:
        case Pair():
            return contact.resting_pressure(model, evaluated, evaluated.pair, z)
        case Circle():
            return circle.resting_pressure(model, evaluated, evaluated.pair, z)
        case Face():
            return 0.0


def with_current_sides(model: Model, pair: Contact, z: State) -> Contact:
    """The contact; for self-contact with the sides of state ``z``."""
    if isinstance(pair, Pair) and pair.roles is not None:
        return replace(pair, roles=pair.roles.renewed(model.line(model.beams[pair.first], z)))
    return pair


def open_contact(model: Model, pair: Contact, z: State) -> Contact:
    """An open contact in state ``z``; for two neighbouring beams with the sides of this state."""
    if not isinstance(pair, Pair) or pair.roles is not None or gap_lower_bound(model, pair, z) > FAR:
        return with_current_sides(model, pair, z)
    return contact.with_sides(model, pair, z) if least_gap(model, pair, z) > _APART * pair.scale else pair


def around_end(model: Model, pair: Contact, before: State, after: State) -> Contact:
    """The open contact; with the sides of state ``after`` if a beam came around an end of the other since ``before``.

    A place beyond the other beam's end has no gap. Around the end, its gap appears at once, across the neutral line.
    With the sides of ``after`` the beams are apart in both states.
    """
    if (
        not isinstance(pair, Pair)
        or pair.roles is not None
        or least_gap(model, pair, after) >= -pair.distance - CLOSED * pair.scale
    ):
        return pair
    renewed = contact.with_sides(model, pair, after)
    apart = min(least_gap(model, *there) for there in ((pair, before), (renewed, before), (renewed, after)))
    return renewed if apart >= 0.0 else pair


def motion_before_contact(model: Model, pair: Contact, z: State) -> float:
    """Lower bound of the relative motion before the contact needs evaluation; −∞ for self-contact and edges."""
    match pair:
        case Pair(roles=None):
            return contact.motion_before_facing(model, pair, z)
        case Circle():
            return circle.motion_before_contact(model, pair, z)
        case _:
            return -np.inf


def motion_before_overlap(model: Model, pair: Contact, z: State) -> float:
    """Lower bound of the relative motion before an overlap, from the least gap.

    No two places approach by more than their motions. Places beyond an end of the other beam have no gap; their
    distance from the beam is their distance from the end. The ends of a line in self-contact have no bound. A beam
    folded within its own thickness is beyond the elements.
    """
    least = zones_of(model, pair, z).least
    numbers = (pair.first, pair.second) if isinstance(pair, Pair) else (pair.first,)
    longest = [model.line(model.beams[i], z).longest for i in numbers]
    # a distance above an element's length may be between nodes only, and smaller in between
    least = least if least <= longest[-1] else max(longest[-1], least - max(longest))
    if not isinstance(pair, Pair) or pair.ended:
        return least
    return min(least, contact.end_circle_distance(model, pair, z)) if pair.roles is None else -np.inf


def relative_motion(model: Model, pair: Contact, before: State, after: State) -> float:
    """Upper bound of the relative motion on the straight way between two states; infinite for an edge."""

    def way(number: int) -> float:
        dofs = model.node_dofs[:2, model.beams[number].nodes]
        dx, dy = after.values[dofs] - before.values[dofs]
        return float(np.hypot(dx, dy).max())

    match pair:
        case Pair():
            return way(pair.first) + way(pair.second)
        case Circle():
            x, y, phi = model.body_state(model.bodies[pair.body], after) - model.body_state(
                model.bodies[pair.body], before
            )
            return way(pair.first) + float(np.hypot(x, y) + abs(phi) * np.hypot(*pair.arm))
        case Face():
            return np.inf


def passed_through(model: Model, pair: Contact, before: State, after: State) -> bool:
    """True if the bodies of the contact passed through each other between two states."""
    if isinstance(pair, Circle | Face):
        gaps = zones_of(model, pair, before).least, zones_of(model, pair, after).least
        if cannot_touch(model, pair, gaps, before, after):
            return False
    if isinstance(pair, Circle):
        return circle.passes_through(model, pair, before, after)
    if isinstance(pair, Face):
        return face.passes_through(model, pair, before, after)
    first, second = (model.line(model.beams[i], after) for i in (pair.first, pair.second))
    if pair.roles is not None:
        line = model.line(model.beams[pair.first], before)
        return ends_pass_through(pair, line, first) or crosses_itself(first, contact.zones_of(model, pair, after))
    # Lines without thickness cross by the penetration of the penalty, which is held and measured. At mere contact,
    # chords cross by the sagitta of their elements.
    in_contact = pair.distance == 0.0 and least_gap(model, pair, after) <= CLOSED * pair.scale
    return not in_contact and lines_cross(first, second)
