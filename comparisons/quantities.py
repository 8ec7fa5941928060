"""Units, components and norms of the quantities that probes ask for."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from comparisons.geometry import length
from cprbm_scene import Probe, Scene, Stage
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES, Quantity

VANISHING = 1e-2
"""A reference below this share of its scale may vanish, and is no divisor of shown fractions."""

OPEN_AT_ZERO: frozenset[Quantity] = frozenset({"force", "moment"})
"""Quantities that are exactly zero while a contact is open, or while no limit of a stop is reached."""

UNITS: Mapping[Quantity, str] = {
    "displacement": "m",
    "rotation": "rad",
    "force": "N",
    "centre": "m",
    "ends": "m",
    "bending_stress": "Pa",
    "combined_stress": "Pa",
    "reaction": "N",
    "reaction_moment": "N·m",
    "potential_energy": "J",
    "angle": "rad",
    "moment": "N·m",
}

COMPONENTS: Mapping[Quantity, tuple[str, str]] = {
    "displacement": ("x", "y"),
    "reaction": ("x", "y"),
    "ends": ("first", "last"),
}
"""Names of the components, of quantities with two."""

LOAD_UNITS = {
    "moment": "N·m",
    "force": "N",
    "beam_force": "N",
    "beam_moment": "N·m",
    "distributed": "N/m",
    "displacement": "m",
    "rotation": "rad",
}


def norm(quantity: Quantity, values: Array) -> float:
    """Euclidean norm of ``values`` (k,); of a stress along a beam the largest magnitude; 0 without values."""
    if values.size == 0:
        return 0.0
    return float(np.max(np.abs(values)) if quantity in STRESSES else np.linalg.norm(values))


def unit_of(scene: Scene, probe: Probe, stage: Stage) -> str:
    """SI unit of a probe's values in a stage."""
    return load_unit(scene, stage) if probe.quantity == "closing_load" else UNITS[probe.quantity]


def load_unit(scene: Scene, stage: Stage) -> str:
    """SI unit of the load or drive that a stage steps."""
    return LOAD_UNITS[scene.stepped(stage).kind]


def arc_lengths(scene: Scene, probe: Probe) -> Array:
    """Arc lengths (k,), m, of the places of a stress probe."""
    return np.linspace(0.0, length(scene.beams[probe.of].curve), probe.points)


def direction(quantity: Quantity, difference: Array) -> Array:
    """Unit vector (k,) along ``difference`` (k,), zero where the difference is.

    The norm of a stress is its largest magnitude: the vector of a stress points along the component of that magnitude.
    """
    if not difference.any():
        return np.zeros_like(difference)
    if quantity in STRESSES:
        along = np.zeros_like(difference)
        worst = int(np.argmax(np.abs(difference)))
        along[worst] = np.sign(difference[worst])
        return along
    return np.asarray(difference / np.linalg.norm(difference))
