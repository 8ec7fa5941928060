"""Texts of numbers: few digits, prefixes of units, and no small number that reads as zero."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from comparisons.quantities import COMPONENTS
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES, Quantity

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))


def number(value: float | None, digits: int = 3) -> str:
    """A number to ``digits`` significant digits; a dash without a finite value."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 10.0**6:
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
        return f"{value:.{decimals}f}"
    return f"{value:.{digits - 1}e}"


def percent(fraction: float | None, digits: int = 3) -> str:
    """A fraction in per cent to ``digits`` significant digits; a dash without a finite value."""
    return "–" if fraction is None or not math.isfinite(fraction) else f"{number(100.0 * fraction, digits)} %"


def scaled_unit(unit: str, size: float) -> tuple[float, str]:
    """Size in SI and name of the unit with the prefix for values of about ``size``; radians have no prefix."""
    if unit in ("rad", "") or size == 0.0 or not math.isfinite(size):
        return 1.0, unit
    return next(((factor, prefix + unit) for factor, prefix in _PREFIXES if size >= factor), (1.0, unit))


def component_names(quantity: Quantity) -> tuple[str, ...]:
    """Names of the components of a quantity in a table."""
    return ("max",) if quantity in STRESSES else COMPONENTS.get(quantity, ("",))


def components(quantity: Quantity, values: Array, factor: float, floor: float) -> Iterator[tuple[str, str]]:
    """Name and text of every component of ``values`` (k,) over ``factor``; of a stress the largest magnitude.

    Values below ``floor``, in the unit of ``values``, are round-off and print as 0.
    """
    if quantity in STRESSES and values.size:
        values = np.array([np.max(np.abs(values))])
    for name, value in zip(component_names(quantity), values.tolist(), strict=False):
        yield name, _component(value, factor, floor)


def vector(values: Array, factor: float, floor: float = 0.0) -> str:
    """Values over ``factor`` to five significant digits; of many (a stress) the largest magnitude."""
    if values.size == 0:
        return "open"
    if values.size > 3:
        return f"max {_component(float(np.max(np.abs(values))), factor, floor)}"
    texts = [_component(float(value), factor, floor) for value in values]
    return texts[0] if len(texts) == 1 else f"({', '.join(texts)})"


def _component(value: float, factor: float, floor: float) -> str:
    return number(0.0 if abs(value) < floor else value / factor, 5)
