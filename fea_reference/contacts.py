"""All of a scene's contacts, of whichever kind."""

from __future__ import annotations

from fea_reference import circle, contact
from fea_reference.crossing import cross
from fea_reference.model import Model
from fea_reference.state import State
from fea_reference.touch import Contact, Pair, Penalty, Touch
from fea_reference.zones import Zones
from scene.mistakes import Mistake, SceneError
from scene.statement import EdgeContact, Scene


def contacts(scene: Scene, model: Model, penetration: float) -> tuple[Contact, ...]:
    """What may touch, in the scene's order.

    Raises:
        SceneError: a contact with a line, a half-plane or a function, or a pin between bodies.
    """
    allowed = "a kind that this method offers so far"
    mistakes = [
        Mistake(f"contacts.{name}.kind", repr(one.kind), allowed, scene.file)
        for name, one in scene.contacts.items()
        if isinstance(one, EdgeContact)
    ]
    mistakes += [Mistake(f"pins.{name}", "a pin between two bodies", allowed, scene.file) for name in scene.pins]
    if mistakes:
        raise SceneError(mistakes)
    every: tuple[Contact, ...] = (*contact.pairs(scene, model), *circle.circles(scene, model, penetration))
    found = {one.name: one for one in every}
    return tuple(found[name] for name in scene.contacts)


def zones_of(model: Model, what: Contact, z: State) -> Zones:
    """Where there is overlap in state ``z``."""
    return contact.zones_of(model, what, z) if isinstance(what, Pair) else circle.zones_of(model, what, z)


def touch(model: Model, what: Contact, penalty: Penalty, quadrature: int, z: State, held: float | None = None) -> Touch:
    """The penalty's energy derivatives, see :func:`fea_reference.contact.touch`; only beams are ever held."""
    if isinstance(what, Pair):
        return contact.touch(model, what, penalty, quadrature, z, held)
    return circle.touch(model, what, penalty, quadrature, z)


def resting_pressure(model: Model, one: Touch, z: State) -> float:
    """The line pressure that the axial forces give where a beam lies on what it touches, on average."""
    if isinstance(one.pair, Pair):
        return contact.resting_pressure(model, one, one.pair, z)
    return circle.resting_pressure(model, one, one.pair, z)


def passed_through(model: Model, what: Contact, before: State, after: State) -> bool:
    """Whether what may touch has passed through each other on the way from one state to another."""
    if not isinstance(what, Pair):
        return circle.passed(model, what, before, after)
    # Lines without thickness cross by what the penalty lets through; that is held, and measured.
    held = what.distance == 0.0 and contact.zones_of(model, what, after).least < 0.0
    return not held and cross(*(model.line(model.beams[i], after) for i in (what.first, what.second)))
