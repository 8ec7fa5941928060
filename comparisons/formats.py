"""Numbers as people read them: never more digits than tell something, never a small one shown as nothing."""

from __future__ import annotations

import math

import numpy as np

from cprbm_scene.answer import Array

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))


def number(value: float | None, digits: int = 3) -> str:
    """``value`` to so many significant digits; a dash where there is none."""
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 10.0**6:
        decimals = max(0, digits - 1 - math.floor(math.log10(abs(value))))
        return f"{value:.{decimals}f}"
    return f"{value:.{digits - 1}e}"


def percent(fraction: float | None) -> str:
    """A fraction in per cent to three significant digits."""
    return "–" if fraction is None or not math.isfinite(fraction) else f"{number(100.0 * fraction)} %"


def scaled_unit(unit: str, size: float) -> tuple[float, str]:
    """The power of a thousand, and the unit with its prefix, in which ``size`` reads best.

    Units without a prefix of their own (radians) stay as they are.
    """
    if unit in ("rad", "") or size == 0.0 or not math.isfinite(size):
        return 1.0, unit
    for factor, prefix in _PREFIXES:
        if size >= factor:
            return factor, prefix + unit
    return 1.0, unit


def vector(values: Array, factor: float) -> str:
    """Values over ``factor`` to five significant digits; of many (a stress) the largest magnitude."""
    if values.size == 0:
        return "open"
    if values.size > 3:
        return f"max {number(float(np.max(np.abs(values))) / factor, 5)}"
    texts = [number(float(value) / factor, 5) for value in values]
    return texts[0] if len(texts) == 1 else f"({', '.join(texts)})"


def along(value: float, unit: str) -> str:
    """A value of a load or drive as titles show it; of a rotation also in degrees."""
    return f"{value:g} ({number(math.degrees(value), 4)}°)" if unit == "rad" else f"{value:g}"
