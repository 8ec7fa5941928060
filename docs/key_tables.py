"""Tables of keys for the page on the scene format, from the records of a scene, written as the pages are built.

    python docs/key_tables.py        all tables, into docs/made/format

A table has a line for every key: the meaning (the docstring of the field), and the values (the field's type, unit,
bounds and default).  Records of one union share a table.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_args, get_origin

from pydantic.fields import FieldInfo

from comparisons.writing import write
from cprbm_scene import statement as records
from cprbm_scene.fields import Coefficients, Measured, Of, Record
from cprbm_scene.part_records import Imperfection, PaperBeam
from cprbm_scene.units import Unit

if TYPE_CHECKING:
    from sphinx.application import Sphinx

MADE = Path(__file__).resolve().parent / "made" / "format"

TABLES: Mapping[str, tuple[type[Record], ...]] = {
    "file": (records.Scene,),
    "units": (records.Units,),
    "parameters": (records.Parameter,),
    "tolerances": (records.Tolerance,),
    "materials": (records.Material,),
    "bodies": (records.FixedBody, records.FreeBody, records.SlidingBody, records.TurningBody),
    "beams": (records.Beam,),
    "profiles": (records.Profile,),
    "curves": (records.Line, records.Arc, records.Polynomial, records.Spline),
    "imperfections": (Imperfection,),
    "ends": (records.WeldedEnd, records.PinnedEnd, records.FreeEnd),
    "pins": (records.BodyPin,),
    "stops": (records.Stop,),
    "assembly": (records.Assembly,),
    "loads": (
        records.Moment,
        records.Force,
        records.BeamMoment,
        records.BeamForce,
        records.DistributedLoad,
    ),
    "drives": (records.DisplacementDrive, records.RotationDrive),
    "beam-contacts": (records.BeamContact, records.SelfContact),
    "edges": (
        records.CircleContact,
        records.EllipseContact,
        records.HalfPlaneContact,
        records.LineContact,
        records.FunctionContact,
        records.SplineContact,
    ),
    "stages": (records.Stage,),
    "probes": (records.Probe,),
    "claims": (records.Claim,),
    "paper-beams": (PaperBeam,),
    "paper-contacts": (records.PaperContact,),
    "related": (records.Related,),
}
"""Records of each table."""

NAME_LENGTH = 64
"""Largest number of characters of a name."""

TAGS = ("kind", "motion", "joint")
"""Keys that choose a record of a union."""

UNITS: Mapping[Unit, str] = {
    Unit(): "",
    Unit(length=1): "m",
    Unit(force=1): "N",
    Unit(angle=1): "rad",
    Unit(stress=1): "Pa",
    Unit(length=1, force=1): "N·m",
    Unit(length=-1, force=1): "N/m",
}
RULES = {"_of_stage": "unit of the stage", "_of_stations": "unit of the stage", "_of_value": "unit of the probe"}
"""Words for units that depend on other records, by the names of the rules."""

BOUNDS = {"gt": "above {:g}", "ge": "at least {:g}", "lt": "below {:g}", "le": "at most {:g}"}


def table(name: str) -> str:
    """Markdown tables of a union or a record: kinds with their meanings, then the keys."""
    parts = TABLES[name]
    tag = next((key for key in TAGS if key in parts[0].model_fields), "")
    lines: list[str] = []
    if tag:
        kinds = [get_args(part.model_fields[tag].annotation)[0] for part in parts]
        united = [unit_of(records.UNITS[kind]) for kind in kinds if kind in records.UNITS]
        lines += _row(f"`{tag}`", "meaning", *(["unit of its value"] if united else []), head=True)
        for i, (kind, part) in enumerate(zip(kinds, parts, strict=True)):
            lines += _row(f'`"{kind}"`', _first_sentence(part), *united[i : i + 1])
        lines.append("")
    lines += _row("key", "meaning", "values", head=True)
    for (key, meaning, allowed), owners in _keys(parts, tag).items():
        of = "" if len(owners) == len(parts) else f" of {', '.join(owners)}"
        lines += _row(f"`{key}`{of}", meaning, allowed)
    return "\n".join(lines) + "\n"


def _row(*cells: str, head: bool = False) -> list[str]:
    line = f"| {' | '.join(cells)} |"
    return [line, "|---" * len(cells) + "|"] if head else [line]


def _keys(parts: Sequence[type[Record]], tag: str) -> Mapping[tuple[str, str, str], list[str]]:
    """Key, meaning and values of all fields, with the kinds of the records that have the field."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for part in parts:
        kind = get_args(part.model_fields[tag].annotation)[0] if tag else part.__name__
        for key, field in part.model_fields.items():
            if key not in (tag, "file"):
                line = (key, _markdown(field.description or ""), values(field))
                found.setdefault(line, []).append(kind.removeprefix("beam-") if tag == "kind" else kind)
    return found


def _first_sentence(part: type[Record]) -> str:
    return _markdown((part.__doc__ or "").split("\n\n")[0].strip())


def _markdown(text: str) -> str:
    return " ".join(text.replace("``", "`").split())


def values(field: FieldInfo) -> str:
    """Words for the values of a field: type, unit, bounds, default."""
    words = _type(Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation)
    if field.is_required():
        return words
    default = field.get_default(call_default_factory=True)
    if default in (None, (), "") or isinstance(default, Mapping | Record):
        return f"{words}; optional"
    return f"{words}; default {_literal(default)}"


def _literal(value: object) -> str:
    match value:
        case bool():
            return f"`{str(value).lower()}`"
        case str():
            return f'`"{value}"`'
        case tuple():
            return f"`[{', '.join(f'{each:g}' for each in value)}]`"
        case _:
            return f"{value:g}"


def unit_of(unit: Unit | Callable[..., Unit | None]) -> str:
    """Words for a unit in SI, or for a rule."""
    return UNITS[unit] if isinstance(unit, Unit) else RULES[unit.__name__]


def _type(annotation: Any, metadata: Sequence[Any] = ()) -> str:  # noqa: ANN401 - annotations have no type
    """Words for an annotation with ``metadata``."""
    if annotation == Coefficients:
        return "list of at least two numbers"
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _type(inner[0], [*metadata, *inner[1:]])
    if origin in (Union, UnionType):
        known = [each for each in inner if each is not NoneType]
        return ", or ".join(dict.fromkeys(_type(each, metadata) for each in known))
    of = next((each.kind for each in metadata if isinstance(each, Of)), "")
    if origin is Literal:
        return ", ".join(f'`"{each}"`' for each in inner)
    if origin is tuple:
        items = _plural(_type(inner[0], [each for each in metadata if isinstance(each, Of)]))
        return f"list of {items}" if inner[-1] is Ellipsis else f"two {items}"
    if origin is not None and issubclass(origin, Mapping):
        item = _type(inner[1])
        return "tables by name" if item == "table" else f"{_plural(item)}, by the names of {of or 'point'}s"
    if issubclass(annotation, Record):
        return "table"
    if annotation in (bool, str):
        named = any(getattr(each, "max_length", None) == NAME_LENGTH for each in metadata)
        return "`true`, `false`" if annotation is bool else f"name of a {of}" if of else "name" if named else "text"
    return _number(annotation, metadata)


def _plural(words: str) -> str:
    """Words for several values."""
    if words.startswith("two "):
        return f"pairs of {words.removeprefix('two ')}"
    if words.startswith("name of a "):
        kind = words.removeprefix("name of a ")
        return "names" if " " in kind else f"names of {kind}s"
    return re.sub("^(number|table|name|text)", r"\1s", words)


def _number(annotation: type, metadata: Sequence[Any]) -> str:
    bounds = {
        name: getattr(part, name)
        for each in metadata
        for part in getattr(each, "metadata", None) or [each]
        for name in BOUNDS
        if getattr(part, name, None) is not None
    }
    unit = next((unit_of(each.unit) for each in metadata if isinstance(each, Measured)), "")
    words = [BOUNDS[name].format(bound) for name, bound in bounds.items()]
    if {"ge", "le"} <= bounds.keys():
        words = [f"from {bounds['ge']:g} to {bounds['le']:g}"]
    return ", ".join(filter(None, ["whole number" if annotation is int else "number", unit, *words]))


def write_tables() -> None:
    """Write all tables into ``docs/made/format``."""
    for name in TABLES:
        write(MADE / f"{name}.md", table(name))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the writing before Sphinx reads the pages."""
    app.connect("builder-inited", lambda _: write_tables())
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    write_tables()
