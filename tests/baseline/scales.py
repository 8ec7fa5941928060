r"""Scales by which two records are compared.

=====  ==================================================================
ℓ      arc length of the longest beam, m
E, I   Young's modulus, Pa, and second moment of area, m⁴, of a section
S      bending stiffness of the stiffest beam over ℓ, max E I / ℓ, N·m
=====  ==================================================================

The *natural* scale of a quantity is its size where the stiffest beam bends by a radian along ℓ: ℓ of a displacement,
1 rad of a rotation, S/ℓ of a force, S of a moment and an energy, E t/(2ℓ) of a stress. A change below 1e-12 of the
natural scale is round-off. The *scale* of a probe in a stage is its largest norm there, and at least a thousandth of
the largest of all probes of the same quantity.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cprbm_scene import Answer, Scene

ROUND_OFF = 1e-12
"""Round-off of a number over the natural scale."""

LEAST_SHARE = 1e-3
"""Least scale of a probe over the largest scale of its quantity: a value of zero by symmetry has no own scale."""

LENGTHS = frozenset({"displacement", "centre", "ends"})
ANGLES = frozenset({"rotation", "angle"})
FORCES = frozenset({"force", "reaction"})
STRESSES = frozenset({"bending_stress", "combined_stress"})


def natural_scales(scene: Scene, answer: Answer) -> dict[str, float]:
    """Natural scale of every requested quantity, in SI; empty for an answer without stations."""
    if not answer.stations:
        return {}
    length = max(float(shape.s[-1]) for shape in answer.stations[0].shapes.values())
    beams = [(beam, scene.materials[beam.material].youngs_modulus) for beam in scene.beams.values()]
    sections = [
        (E, np.asarray(beam.width_at(beam.knots)), np.asarray(beam.thickness_at(beam.knots))) for beam, E in beams
    ]
    stiffness = max(float(np.max(E * width * thickness**3 / 12.0)) for E, width, thickness in sections) / length
    stress = max(float(np.max(E * thickness)) for E, _, thickness in sections) / (2.0 * length)
    loads = max(abs(value) for stage in scene.stages for value in stage.stations)
    found = {}
    for quantity in {probe.quantity for probe in scene.probes}:
        if quantity in LENGTHS:
            found[quantity] = length
        elif quantity in ANGLES:
            found[quantity] = 1.0
        elif quantity in FORCES:
            found[quantity] = stiffness / length
        elif quantity in STRESSES:
            found[quantity] = stress
        else:
            found[quantity] = loads if quantity == "closing_load" else stiffness
    return found


def quantity_of(probe: str) -> str:
    """The quantity of a probe's name, ``BD.rotation`` for instance."""
    return probe.rpartition(".")[2]


def norm(probe: str, values: Iterable[float]) -> float:
    """Euclidean norm of values (k,); of a stress along a beam the largest magnitude."""
    array = np.array(list(values), dtype=float)
    if array.size == 0:
        return 0.0
    return float(np.max(np.abs(array)) if quantity_of(probe) in STRESSES else np.linalg.norm(array))


def probe_scales(stations: Iterable[Mapping[str, Any]]) -> dict[tuple[str, str], float]:
    """Scale of every stage and probe over the recorded stations of one run, in the probe's unit."""
    largest: dict[tuple[str, str], float] = {}
    of_quantity: dict[tuple[str, str], float] = {}
    for station in stations:
        for probe, values in station["values"].items():
            size = norm(probe, values)
            own, shared = (station["stage"], probe), (station["stage"], quantity_of(probe))
            largest[own] = max(largest.get(own, 0.0), size)
            of_quantity[shared] = max(of_quantity.get(shared, 0.0), size)
    return {
        (stage, probe): max(size, LEAST_SHARE * of_quantity[stage, quantity_of(probe)])
        for (stage, probe), size in largest.items()
    }
