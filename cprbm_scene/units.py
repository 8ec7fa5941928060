"""Fields of records: names, references, rules, and numbers with units that are converted where a file is read.

A reference to another part of the scene states the kind of the part, ``Annotated[Name, Of("beam")]``; a walk over the
records finds all references (:mod:`cprbm_scene.names`).  The rules of a record yield the mistakes between
its fields, with keys below the record's key; a walk over the records finds all mistakes (:mod:`cprbm_scene.reading`).

=============  ==================================================================
a, b, c, d     powers of length, force, angle and stress in a number's unit
u              size of the file's unit over the SI unit: 1/1000 of mm, π/180 of deg
=============  ==================================================================

A number x of a file is x·u_lengthᵃ·u_forceᵇ·u_angleᶜ·u_stressᵈ in SI, computed from the decimal digits of x and rounded
once: 9.7 mm is 0.0097 m.  Only a file has units; a :class:`~cprbm_scene.statement.Scene` and every answer are in SI.

A field states the unit as metadata, ``Annotated[float, Measured(Unit(length=1))]``.  The metadata validates the file's
number and then converts the number by the :class:`Reading` in pydantic's context.  Without a context numbers are in SI.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, NoReturn, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    StringConstraints,
    ValidationError,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    model_validator,
)
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, SceneError, in_words

T = TypeVar("T")

_LETTERS = "A-Za-z_À-ÖØ-öø-ɏΑ-Ωα-ω"
Word = Annotated[str, StringConstraints(pattern=f"^[{_LETTERS}][{_LETTERS}0-9-]*$", max_length=64)]
"""Latin and Greek letters, digits, '_' and '-': the name of a parameter in an expression."""
NAME = f"^[{_LETTERS}][{_LETTERS}0-9-]*( [{_LETTERS}0-9-]+)*$"
"""Pattern of words with a single space between words: names are parts of keys, of file names and of options."""
Name = Annotated[str, StringConstraints(pattern=NAME, max_length=64)]
Text = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x08\x0b-\x1f\x7f-\x9f]*$")]
"""Text without control characters, but for tabs and line ends."""
Title = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
"""Text of one line without control characters."""


Named = Annotated[Mapping[Name, T], AfterValidator(frozendict)]
NamedByWords = Annotated[Mapping[Word, T], AfterValidator(frozendict)]


@dataclass(frozen=True, slots=True)
class Of:
    """Kind of the named part of the scene, such as ``beam``; a tuple or table names several, at another ``key``."""

    kind: str
    key: str = ""


class Record(BaseModel):
    """Immutable record with strict types, without unknown keys, with finite numbers only."""

    model_config = ConfigDict(
        frozen=True, strict=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )

    @model_validator(mode="wrap")
    @classmethod
    def _checked(cls, data: object, handler: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        try:
            record = handler(data)
        except ValidationError as error:
            raise SceneError(list(in_words(error, data, cls.model_fields))) from None
        if record is not data:
            record.__dict__.update(record.completed())
            # rules limit files; programs build records beyond the rules
            if isinstance(info.context, Reading) and (mistakes := list(record.rules())):
                raise SceneError(mistakes)
        return record

    def completed(self) -> Mapping[str, object]:
        """Fields that follow from other fields, in place of their values in the file; none by default."""
        return {}

    def rules(self) -> Iterator[Mistake]:
        """Mistakes between the record's own fields, with keys below the record's own; none by default."""
        return iter(())


OR_EXPRESSION = {"anyOf": [{"type": "number"}, {"type": "string", "pattern": "^="}]}
"""JSON schema of a number, or of an expression in place of the number."""

SMALLEST, LARGEST = 1e-50, 1e50
"""Magnitudes of numbers with a unit, in SI: a product of six such numbers stays within floating-point numbers."""

_LENGTHS = {"m": "1", "cm": "0.01", "mm": "0.001", "um": "1e-6", "in": "0.0254"}
_OTHERS = {
    "N": "1",
    "kN": "1e3",
    "mN": "1e-3",
    "uN": "1e-6",
    "rad": "1",
    "Pa": "1",
    "kPa": "1e3",
    "MPa": "1e6",
    "GPa": "1e9",
}
SIZES: Mapping[str, Fraction] = frozendict(
    {name: Fraction(size) for name, size in (_LENGTHS | _OTHERS).items()} | {"deg": Fraction(math.pi / 180.0)}
)
"""Sizes of units in SI."""


class Units(Record):
    """Units of the numbers in a file; moments, distributed loads and energies are of force and length."""

    length: Literal["m", "cm", "mm", "um", "in"] = "m"
    """Unit of lengths."""
    force: Literal["N", "kN", "mN", "uN"] = "N"
    """Unit of forces."""
    angle: Literal["rad", "deg"] = "rad"
    """Unit of angles."""
    stress: Literal["Pa", "kPa", "MPa", "GPa"] = "Pa"
    """Unit of moduli and of stresses in claims."""


def silent(*_: object) -> NoReturn:
    """Raise a mistake without words, the consequence of another mistake: the record is left out of the scene."""
    raise mistake("", "")


@dataclass(slots=True)
class Reading:
    """State while a file is read: ``settings`` of parameters, the file's ``folder``, its units, and parts read so far.

    ``parts`` are loads, drives, stages and probes by the names of their fields and by their own names.  Expressions are
    silent mistakes until the parameters are read.
    """

    settings: Mapping[str, float | str] = field(default_factory=dict)
    folder: Path = Path()
    units: Units = field(default_factory=Units)
    parts: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    left_out: Collection[str] = ()
    evaluate: Callable[[str, Unit | None], float] = silent

    def in_si(self, value: Any, unit: Unit | None) -> Any:  # noqa: ANN401 - whatever TOML holds
        """A number or an expression in SI, infinite if it is too large; another value, or one without unit, unchanged.

        Raises:
            SceneError: the expression has no value, or another unit.
        """
        if isinstance(value, str) and value.startswith("="):
            return self.evaluate(value, unit)
        if unit is None or isinstance(value, bool) or not isinstance(value, int | float):
            return value
        with suppress(OverflowError):
            return unit.in_si(float(value), self.units)
        return math.inf


def mistake(found: str, allowed: str, key: str = "") -> SceneError:
    """An error of a validator with both halves of a mistake's sentence, at a ``key`` below the validated field."""
    return SceneError([Mistake(key, found, allowed)])


class Unit(NamedTuple):
    """Powers of length, force, angle and stress in a number's unit; without any a pure number."""

    length: int = 0
    force: int = 0
    angle: int = 0
    stress: int = 0

    @property
    def dimension(self) -> tuple[int, int]:
        """Powers of length and force: stress is force over the square of length, and an angle is a pure number."""
        return self.length - 2 * self.stress, self.force + self.stress

    def in_si(self, value: float, units: Units) -> float:
        """A number of a file in SI.

        Raises:
            OverflowError: the number is above the largest floating-point number.
        """
        size = math.prod(SIZES[name] ** power for (_, name), power in zip(units, self, strict=True) if power)
        return float(Fraction(repr(value)) * size) if size != 1 and math.isfinite(value) else value

    def times(self, other: Unit, power: int = 1) -> Unit:
        """Product with a power of another unit."""
        return Unit(*(one + power * two for one, two in zip(self, other, strict=True)))

    def __str__(self) -> str:
        named = zip(("m", "N", "rad", "Pa"), self, strict=True)
        return "*".join(f"{name}**{power}" if power != 1 else name for name, power in named if power)


@dataclass(frozen=True, slots=True)
class Measured:
    """Metadata of a field whose numbers have a ``unit``, or the unit by a rule from fields that are read already.

    A rule returns None for an unknown unit.
    """

    unit: Unit | Callable[[Reading, Mapping[str, Any]], Unit | None]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_wrap_validator_function(self.number, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchemaValue:
        return {"anyOf": [handler(schema), {"type": "string", "pattern": "^="}]}

    def number(self, value: object, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> object:
        """The number in SI; the field's bounds are on the file's number, or on the value of an expression."""
        if not isinstance(info.context, Reading):
            return handler(value)
        unit = self.unit if isinstance(self.unit, Unit) else self.unit(info.context, info.data)
        number = info.context.in_si(value, unit)
        checked = handler(number if isinstance(value, str) else value)
        if unit is None or unit == NUMBER:
            return checked
        if number == 0.0 == checked or SMALLEST <= abs(number) <= LARGEST:
            return number
        raise PydanticCustomError("range", f"zero or a magnitude between {SMALLEST:g} and {LARGEST:g} in SI units")


NUMBER = Unit()
LENGTH, FORCE, ANGLE, STRESS = Unit(length=1), Unit(force=1), Unit(angle=1), Unit(stress=1)
MOMENT, LINE_LOAD = Unit(length=1, force=1), Unit(length=-1, force=1)

Number = Annotated[float, Measured(NUMBER)]
Length = Annotated[float, Measured(LENGTH)]
Angle = Annotated[float, Measured(ANGLE)]
PositiveLength = Annotated[float, Field(gt=0.0), Measured(LENGTH)]
Positive = Annotated[float, Field(gt=0.0), Measured(NUMBER)]
Share = Annotated[float, Field(ge=0.0, le=1.0), Measured(NUMBER)]
PositiveShare = Annotated[float, Field(gt=0.0, le=1.0), Measured(NUMBER)]
Point = tuple[Length, Length]


def _nonzero(direction: tuple[float, float]) -> tuple[float, float]:
    if direction == (0.0, 0.0):
        raise mistake("[0, 0]", "a direction, at least one number not zero")
    return direction


Direction = Annotated[tuple[Number, Number], AfterValidator(_nonzero)]
"""Vector of any length but zero."""


def _by_powers(coefficients: object, info: ValidationInfo) -> object:
    """Coefficients of f in SI."""
    if not isinstance(info.context, Reading) or not isinstance(coefficients, tuple):
        return coefficients
    return tuple(info.context.in_si(value, Unit(length=1 - k)) for k, value in enumerate(coefficients))


Coefficients = Annotated[tuple[Number, ...], Field(min_length=2), BeforeValidator(_by_powers)]
"""Coefficients of a function f, a length, of a variable that is a length; lowest power first."""
