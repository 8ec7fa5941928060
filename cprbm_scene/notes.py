"""Notes on implausible parts of a scene: beams that meet without a contact, loads too large for the beams.

A large load has a mix-up of units as explanation.

=======  ==============================================================
symbol   meaning
=======  ==============================================================
P, M, q  largest force, moment and distributed load of the stages
L, E I   length and largest bending stiffness of a beam
r        P L²/(E I), M L/(E I) or q L³/(E I): of order 1 where the deflection is the length
=======  ==============================================================

With E I = E w t³/12, r has the power -1 of E, 1 of the force and -2 of the unit of length, for every kind of load.
"""

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from cprbm_scene.clearance import TOUCHING, crossing, overlap_at_rest
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import UNITS, Beam, BeamContact, BodyLoad, Load, Scene, Units
from cprbm_scene.units import BY_QUANTITY, SIZES

LARGE = 1000.0
"""r above which a load is implausible: a cantilever under r = 1000 is straight but for 3 % of its length."""
SOFTEST, STIFFEST = 1e6, 1.5e12
"""Young's moduli of rubber and diamond, rounded outwards, Pa."""
_SAMPLES = 201
_POWERS = {"stress": -1, "length": -2, "force": 1}


def notes(scene: Scene) -> Iterator[str]:
    """Sentences on implausible parts of a scene; none for most scenes.

    Args:
        scene: a scene without mistakes.
    """
    known = {*map(frozenset, scene.may_cross), *(frozenset(contact.beams) for contact in scene.contacts.values())}
    boxes = {name: _box(beam) for name, beam in scene.beams.items()}
    for first, second in combinations(scene.beams, 2):
        beside = any(np.any(boxes[one][0] > boxes[other][1]) for one, other in ((first, second), (second, first)))
        if not beside and {first, second} not in known and (meeting := _meeting(scene, first, second)):
            yield (
                f"beams.{second}: {meeting}: without a contact of the two, no force acts there; a pair in may_cross "
                "needs no note."
            )
    yield from [*_load_notes(scene)] or (
        f"materials.{name}: youngs_modulus is {material.youngs_modulus:.3g} Pa, implausible below {SOFTEST:g} "
        f"and above {STIFFEST:g} Pa. Is the number in {scene.display_units.stress}, the file's unit of stress?"
        for name, material in scene.materials.items()
        if not SOFTEST <= material.youngs_modulus <= STIFFEST
    )


def _load_notes(scene: Scene) -> Iterator[str]:
    """Sentences on implausible loads."""
    for name, load in scene.loads.items():
        largest = max(
            (abs(value) for stage in scene.stages if name in stage.stepped for value in stage.stations), default=0.0
        )
        beams = scene.beams if isinstance(load, BodyLoad) else [load.beam]
        ratio, beam = min((largest * _per_unit(scene, load, beam), beam) for beam in beams)
        if ratio > LARGE:
            symbol = {"force": "P L^2", "beam_force": "P L^2", "distributed": "q L^3"}.get(load.kind, "M L")
            modulus = scene.materials[scene.beams[beam].material].youngs_modulus
            yield (
                f"loads.{name}: {symbol}/(E I) is {ratio:.3g} for the beam {beam!r}, implausible above "
                f"{LARGE:g}.{_explanation(ratio, modulus, scene.display_units)}"
            )


def _box(beam: Beam) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest coordinates (2,) of a beam with its thickness, m."""
    p, half = shape_of(beam.curve).point(np.linspace(0.0, 1.0, _SAMPLES)), 0.5 * beam.thickest
    return p.min(axis=0) - half, p.max(axis=0) + half


def _meeting(scene: Scene, first: str, second: str) -> str:
    """The way in which two beams meet as drawn; empty for beams that touch or are apart."""
    if place := crossing(scene, first, second):
        return f"crosses the beam {first!r} at the start, at {place} m"
    depth = overlap_at_rest(scene, BeamContact(kind="beam-beam", between=(first, second)))
    deep = depth > 0.5 * TOUCHING * (scene.beams[first].thinnest + scene.beams[second].thinnest)
    return f"overlaps the beam {first!r} at the start by {depth:.3g} m" if deep else ""


def _per_unit(scene: Scene, load: Load, name: str) -> float:
    """The ratio r of a load of 1 in SI units on a beam."""
    beam = scene.beams[name]
    width = float(beam.width_at(beam.knots).max())
    stiffness = scene.materials[beam.material].youngs_modulus * width * beam.thickest**3 / 12.0
    return float(shape_of(beam.curve).length ** (2 - UNITS[load.kind].length) / stiffness)


def _explanation(ratio: float, modulus: float, units: Units) -> str:
    """The question about the mix-up of units that brings r and E closest to ordinary values; empty without any."""
    mixed = (
        (quantity, own, other, float(SIZES[other] / SIZES[own]))
        for quantity, own in units
        for other in (BY_QUANTITY[quantity] if quantity in _POWERS else ())
        if other != own
    )
    found = (
        (abs(float(np.log10(true))), f" Is a {quantity} in {other} written as {own}?")
        for quantity, own, other, factor in mixed
        if (true := ratio * factor ** _POWERS[quantity]) <= LARGE
        and SOFTEST <= modulus * (factor if quantity == "stress" else 1.0) <= STIFFEST
    )
    return min(found, default=(0.0, ""))[1]
