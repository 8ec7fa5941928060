"""Units of tables, figures and sentences: the units of the scene's file.

Answers are in SI.  A quantity with a stated unit has this unit everywhere: in a scene in mm and N a moment has N·mm.  A
quantity without a stated unit has the SI unit with the prefix for the largest value, one prefix in a table.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from comparisons.formats import number, scaled_unit
from comparisons.quantities import load_unit
from cprbm_scene import Scene, Stage
from cprbm_scene.units import ANGLE, FORCE, LENGTH, LINE_LOAD, MOMENT, STRESS

_POWERS = {
    "m": (LENGTH, "{length}"),
    "N": (FORCE, "{force}"),
    "rad": (ANGLE, "{angle}"),
    "Pa": (STRESS, "{stress}"),
    "N·m": (MOMENT, "{force}·{length}"),
    "J": (MOMENT, "{force}·{length}"),
    "N/m": (LINE_LOAD, "{force}/{length}"),
}
"""Powers of the file's units by SI unit, and the name of the product."""

DEGREE = math.radians(1.0)


def display_unit(scene: Scene, unit: str, size: float) -> tuple[float, str]:
    """Size in SI and name of the unit in which values of about ``size`` of the SI ``unit`` are displayed."""
    if not _stated(scene, unit):
        return scaled_unit(unit, abs(size))
    return _with_symbols(*file_unit(scene, unit))


def display_units(scene: Scene, sizes: Iterable[tuple[str, float]]) -> Mapping[str, tuple[float, str]]:
    """Displayed units by SI unit, one for all values of a table.

    Args:
        scene: the question.
        sizes: SI unit and magnitude of every value.
    """
    largest: dict[str, float] = {}
    for unit, size in sizes:
        largest[unit] = max(largest.get(unit, 0.0), size)
    return {unit: display_unit(scene, unit, size) for unit, size in largest.items()}


def file_unit(scene: Scene, unit: str) -> tuple[float, str]:
    """Size in SI and name of the file's unit for values in the SI ``unit``; the SI unit where the file states none."""
    if not _stated(scene, unit):
        return 1.0, unit
    powers, name = _POWERS[unit]
    return powers.in_si(1.0, scene.display_units), name.format(**scene.display_units.model_dump())


def _stated(scene: Scene, unit: str) -> bool:
    """Whether the file states a unit of a quantity in the SI ``unit``."""
    fields = scene.display_units.model_fields_set
    return unit in _POWERS and any(f"{{{field}}}" in _POWERS[unit][1] for field in fields)


def axis_unit(scene: Scene, unit: str, size: float) -> tuple[float, str]:
    """Displayed unit on the axis of a load or drive of about ``size`` of the SI ``unit``; of a rotation degrees."""
    return (DEGREE, "°") if unit == "rad" else display_unit(scene, unit, size)


def with_unit(scene: Scene, value: float, unit: str, digits: int) -> str:
    """An SI value with its displayed unit; an angle of a file in radians also in degrees."""
    factor, name = display_unit(scene, unit, value)
    return _joined(number(value / factor, digits), name) + _in_degrees(value, name)


def distance_text(scene: Scene, value: float, unit: str) -> str:
    """A distance on the load axis with its displayed unit, of a rotation in degrees; a dash for NaN."""
    if not math.isfinite(value):
        return "–"
    factor, name = axis_unit(scene, unit, value)
    return _joined(number(value / factor, 2), name)


def load_text(scene: Scene, stage: str, value: float) -> str:
    """A value of the load or drive that the stage of a name steps, with its displayed unit."""
    unit = load_unit(scene, next(each for each in scene.stages if each.name == stage))
    factor, name = _with_symbols(*file_unit(scene, unit))
    return _joined(f"{value / factor:.6g}", name) + _in_degrees(value, name)


def load_column(scene: Scene, stage: Stage, values: Sequence[float]) -> tuple[str, tuple[str, ...]]:
    """Heading and texts of a column with values of a stage's load or drive."""
    factor, unit = _with_symbols(*file_unit(scene, load_unit(scene, stage)))
    return f"{stage.steps}, {unit}", tuple(f"{value / factor:.6g}{_in_degrees(value, unit)}" for value in values)


def at_station(scene: Scene, stage: str, value: float) -> str:
    """Name of a stage, and the value of its load or drive with the displayed unit."""
    return f"{stage} {load_text(scene, stage, value)}"


def _with_symbols(size: float, name: str) -> tuple[float, str]:
    """Size and name of a unit, with the symbols of degree and of micro."""
    return size, name.replace("deg", "°").replace("um", "µm").replace("uN", "µN")


def _in_degrees(value: float, unit: str) -> str:
    """Addition to an angle that is displayed in radians; empty for other units."""
    return f" ({number(value / DEGREE, 4)}°)" if unit == "rad" else ""


def _joined(text: str, unit: str) -> str:
    return f"{text}{'' if unit == '°' else ' '}{unit}".rstrip()
