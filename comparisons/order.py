"""The order of convergence that an error estimate may assume, probe by probe, and the estimate.

Two for all but one thing: where a beam lies on a circle, or on another beam clamped beside it, up to a held end, the
pressure on the first elements and the shear of the support can be told apart to one element and no better, unless a
method takes care of it.  Their sum converges with the second order, each alone with the first, and so do the place
of the contact's resultant and the ends of the zone.  Of a method that does better the first order only makes the
stated uncertainty larger.

Where three and more discretisations show by themselves how the values go (:mod:`comparisons.converging.limits`), each
method's own order is what theory gives: of the chain the square of a link's length, of cubic Hermite elements the
fourth power of an element's (Strang and Fix, *An Analysis of the Finite Element Method*, section 1.6: 2(k + 1 − m) for
polynomials of degree k = 3 and energies of second derivatives, m = 2).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Literal

import numpy as np

from cprbm_scene import Probe, RigidContact, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import FreeEnd, SelfContact

SAFETY = 1.25  # S, of an error estimate
USUAL, BESIDE_A_HELD_END = 2, 1
OWN: Mapping[Literal["cprbm", "fea"], int] = {"cprbm": 2, "fea": 4}
BESIDE = 2.0  # mean thicknesses between the held ends of two beams that are clamped beside each other


def order_of(scene: Scene, probe: Probe) -> int:
    """p of the probe's values in both solvers."""
    if probe.quantity in ("force", "centre", "ends"):
        first = bool(_shared(scene, probe.of))
    elif probe.quantity == "reaction":
        first = any(probe.of in _shared(scene, contact) for contact in scene.contacts)
    else:
        first = False
    return BESIDE_A_HELD_END if first else USUAL


def _shared(scene: Scene, name: str) -> set[str]:
    """Points of held ends up to which a contact may reach."""
    contact = scene.contacts[name]
    if isinstance(contact, RigidContact):
        return set(_held(scene, contact.beam))
    first, second = (contact.beam, contact.beam) if isinstance(contact, SelfContact) else contact.between
    one, other = _held(scene, first), _held(scene, second)
    near = BESIDE * 0.5 * (scene.beams[first].thickest + scene.beams[second].thickest)
    return {
        point
        for mine, a in one.items()
        for its, b in other.items()
        if mine != its and scene.body_of(mine) == scene.body_of(its) and math.dist(a, b) <= near
        for point in (mine, its)
    }


def _held(scene: Scene, beam: str) -> dict[str, tuple[float, float]]:
    """Points at which a beam's ends are held, and where they are at rest."""
    record = scene.beams[beam]
    held = [end.point for end in (record.start, record.end) if not isinstance(end, FreeEnd)]
    return {point: scene.bodies[scene.body_of(point)].points[point] for point in held}


def richardson(order: int) -> float:
    """2^p/(2^p − 1): the error at N over its change from N to 2N."""
    return 2.0**order / (2.0**order - 1.0)


def uncertainty(
    v: Array, V: Array, beside: Array | None, ratio: float, order: int, size: Callable[[Array], float]
) -> float:
    """u of the values v (k,) at N, with V at 2N and, where there are some, those ``beside`` at N over ``ratio``.

    ``size`` is the norm of a difference (k,).
    """
    own = SAFETY * richardson(order) * size(v - V)
    return own if beside is None else own + SAFETY * size(unforeseen(v, V, beside, ratio, order))


def foretold(v: Array, V: Array, ratio: float, order: int) -> Array:
    """What the even law through v and V foretells of the value at N over ``ratio``."""
    error = richardson(order) * (v - V)
    return np.asarray(v - error + error * ratio**order)


def unforeseen(v: Array, V: Array, beside: Array, ratio: float, order: int) -> Array:
    """What it does not foretell of the value beside, as at N links."""
    return np.asarray((beside - foretold(v, V, ratio, order)) / ratio**order)
