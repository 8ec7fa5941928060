"""Texts of numbers, and the units of tables, figures and sentences: the units of the scene's file.

A text has few digits, and no small number reads as zero.  Answers are in SI.  A quantity with a stated unit has this
unit everywhere: in a scene in mm and N a moment has N·mm.  A quantity without a stated unit has the SI unit with the
prefix for the largest value, one prefix in a table.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from comparisons.quantities import COMPONENTS, load_unit
from cprbm_scene import STRESSES, Answer, Array, Quantity, Scene, Stage
from cprbm_scene.units import ANGLE, FORCE, LENGTH, LINE_LOAD, MOMENT, STRESS

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))

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


def display_unit(scene: Scene, unit: str, size: float) -> tuple[float, str]:
    """Size in SI and name of the unit in which values of about ``size`` of the SI ``unit`` are displayed."""
    return _file_symbol(scene, unit) if _stated(scene, unit) else scaled_unit(unit, abs(size))


def display_units(scene: Scene, sizes: Iterable[tuple[str, float]]) -> Mapping[str, tuple[float, str]]:
    """Displayed units by SI unit, one for all values of a table.

    Args:
        scene: the question.
        sizes: SI unit and magnitude of every value.
    """
    return {unit: display_unit(scene, unit, largest) for unit, largest in dict(sorted(sizes)).items()}


def file_unit(scene: Scene, unit: str) -> tuple[float, str]:
    """Size in SI and name of the file's unit for values in the SI ``unit``; the SI unit where the file states none."""
    if not _stated(scene, unit):
        return 1.0, unit
    powers, name = _POWERS[unit]
    return powers.in_si(1.0, scene.display_units), name.format(**scene.display_units.model_dump())


def _stated(scene: Scene, unit: str) -> bool:
    """Whether the file states a unit of a quantity in the SI ``unit``."""
    return unit in _POWERS and any(f"{{{field}}}" in _POWERS[unit][1] for field in scene.display_units.model_fields_set)


def axis_unit(scene: Scene, unit: str, size: float) -> tuple[float, str]:
    """Displayed unit on the axis of a load or drive of about ``size`` of the SI ``unit``; of a rotation degrees."""
    return (DEGREE, "°") if unit == "rad" else display_unit(scene, unit, size)


def with_unit(scene: Scene, value: float, unit: str, digits: int) -> str:
    """An SI value with its displayed unit; an angle of a file in radians also in degrees."""
    factor, name = display_unit(scene, unit, value)
    return joined(number(value / factor, digits), name) + _in_degrees(value, name)


def distance_text(scene: Scene, value: float, unit: str) -> str:
    """A distance on the load axis with its displayed unit, of a rotation in degrees; a dash for NaN."""
    if not math.isfinite(value):
        return "–"
    factor, name = axis_unit(scene, unit, value)
    return joined(number(value / factor, 2), name)


def load_text(scene: Scene, stage: str, value: float) -> str:
    """A value of the load or drive that the stage of a name steps, with its displayed unit."""
    factor, name = _file_symbol(scene, load_unit(scene, stage))
    return joined(f"{value / factor:.6g}", name) + _in_degrees(value, name)


def load_column(scene: Scene, stage: Stage, values: Sequence[float]) -> tuple[str, tuple[str, ...]]:
    """Heading and texts of a column with values of a stage's load or drive."""
    factor, unit = _file_symbol(scene, load_unit(scene, stage.name))
    return f"{stage.steps}, {unit}", tuple(f"{value / factor:.6g}{_in_degrees(value, unit)}" for value in values)


def at_station(scene: Scene, stage: str, value: float) -> str:
    """Name of a stage, and the value of its load or drive with the displayed unit."""
    return f"{stage} {load_text(scene, stage, value)}"


def in_file_units(scene: Scene, answer: Answer) -> Answer:
    """An answer whose sentence and notes have the displayed units of the loads and drives that stages step."""
    stages = {stage.steps: stage.name for stage in scene.stages}
    value = re.compile(rf"\b({'|'.join(map(re.escape, stages))}) (=|is|comes to) ([-+]?\d[\d.]*(?:e[-+]\d+)?)\b")
    sentence, *notes = (
        value.sub(lambda found: f"{found[1]} {found[2]} {load_text(scene, stages[found[1]], float(found[3]))}", text)
        for text in (answer.sentence, *answer.notes)
    )
    return replace(answer, sentence=sentence, notes=tuple(notes))


def with_symbols(name: str) -> str:
    """Name of a unit of a file, with the symbols of degree and of micro."""
    return name.replace("deg", "°").replace("um", "µm").replace("uN", "µN")


def _file_symbol(scene: Scene, unit: str) -> tuple[float, str]:
    """The file's unit (:func:`file_unit`) with symbols."""
    size, name = file_unit(scene, unit)
    return size, with_symbols(name)


def _in_degrees(value: float, unit: str) -> str:
    """Addition to an angle that is displayed in radians; empty for other units."""
    return f" ({number(value / DEGREE, 4)}°)" if unit == "rad" else ""


def joined(text: str, unit: str) -> str:
    """A number and its unit."""
    return f"{text}{'' if unit == '°' else ' '}{unit}".rstrip()
