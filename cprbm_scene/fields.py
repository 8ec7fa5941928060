"""Fields of records: names, references, rules, parameters, and numbers with units that are converted on reading.

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

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ModelWrapValidatorHandler,
    PositiveFloat,
    StringConstraints,
    ValidationError,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    WrapValidator,
    model_validator,
)
from pydantic_core import CoreSchema, core_schema

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import (
    Mistake,
    SceneError,
    broken,
    in_words,
    mistake,
    refuse_broken,
    shown,
    silent,
    unknown_name,
)
from cprbm_scene.units import (
    ANGLE,
    FUNCTIONS,
    LARGEST,
    LENGTH,
    NUMBER,
    SMALLEST,
    ExpressionError,
    Unit,
    Value,
    evaluated,
    unit_of,
)

T = TypeVar("T")

LETTERS = "A-Za-z_À-ÖØ-öø-ɏΑ-Ωα-ω"
Word = Annotated[str, StringConstraints(pattern=f"^[{LETTERS}][{LETTERS}0-9-]*$", max_length=64)]
"""Latin and Greek letters, digits, '_' and '-': the name of a parameter in an expression."""
NAME = f"^[{LETTERS}][{LETTERS}0-9-]*( [{LETTERS}0-9-]+)*$"
"""Pattern of words with a single space between words: names are parts of keys, of file names and of options."""
Name = Annotated[str, StringConstraints(pattern=NAME, max_length=64)]
Text = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x08\x0b-\x1f\x7f-\x9f]*$")]
"""Text without control characters, but for tabs and line ends."""
Title = Annotated[str, StringConstraints(pattern=r"^[^\x00-\x1f\x7f-\x9f]*$")]
"""Text of one line without control characters."""


Named = Annotated[Mapping[Name, T], AfterValidator(frozendict)]
OptionalNamed = Annotated[Named[T], Field(default_factory=frozendict)]
"""Table that a file may leave out."""


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
            if isinstance(info.context, Reading):
                refuse_broken(*record.rules())
        return record

    def completed(self) -> Mapping[str, object]:
        """Fields that follow from other fields, in place of their values in the file; none by default."""
        return {}

    def rules(self) -> Iterator[Mistake]:
        """Mistakes between the record's own fields, with keys below the record's own; none by default."""
        return iter(())


class Units(Record):
    """Units of the numbers in a file; moments, distributed loads and energies are of force and length."""

    length: Literal["m", "cm", "mm", "um", "in"] = "m"
    """Unit of lengths."""
    force: Literal["N", "kN", "mN", "uN", "lbf"] = "N"
    """Unit of forces."""
    angle: Literal["rad", "deg"] = "rad"
    """Unit of angles."""
    stress: Literal["Pa", "kPa", "MPa", "GPa", "psi"] = "Pa"
    """Unit of moduli and of stresses in claims."""


_SETTING = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_ROUNDED = 1e-12
"""Share of a range by which a value may exceed the range: units are converted."""


def _or_expression(value: object, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> object:
    of_file = isinstance(info.context, Reading)
    return value if of_file and isinstance(value, str) and value.startswith("=") else handler(value)


class Tolerance(Record):
    """Scatter of a parameter, normal or uniform."""

    normal: PositiveFloat | None = None
    """Standard deviation of a normal scatter, in the parameter's unit."""
    uniform: PositiveFloat | None = None
    """Half of the width of a uniform scatter, in the parameter's unit."""


class Parameter(Record):
    """A named number for expressions; after reading all numbers are in SI."""

    value: Annotated[
        float, WrapValidator(_or_expression, json_schema_input_type=float | Annotated[str, Field(pattern="^=")])
    ]
    """Value in the ``unit``, or an expression in the file's units."""
    unit: str = ""
    """Product of units, such as ``mm``, ``N*mm`` or ``N/mm**2``; empty for a plain number."""
    range: tuple[float, float] | None = None
    """Least and largest value, in the ``unit``."""
    tolerance: Tolerance | None = None
    """Scatter of the value."""

    def rules(self) -> Iterator[Mistake]:
        """The mistake of a range with exchanged ends."""
        return broken(
            self.range
            and self.range[0] > self.range[1]
            and Mistake("range", shown(self.range), "the least value, then the largest")
        )


@dataclass(slots=True, eq=False)
class Reading:
    """State while a file is read: ``settings`` of parameters, the file's ``folder`` and units, and what is read so far.

    Units are those of ``stepped`` loads and drives, and of the stations of ``stages``.  Expressions are silent mistakes
    until the ``parameters`` are read.  ``left_out`` has tables and names of parts with mistakes.  ``again`` reads the
    file with other parameters.  A reading is no part of the question: all readings are equal.
    """

    settings: Mapping[str, float | str] = field(default_factory=dict)
    folder: Path = Path()
    units: Units = field(default_factory=Units)
    stepped: dict[str, Unit] = field(default_factory=dict)
    stages: Mapping[str, Unit | None] = field(default_factory=dict)
    left_out: Collection[tuple[str, str]] = ()
    again: Callable[..., Any] | None = None
    parameters: Mapping[str, Parameter] | None = None
    values: dict[str, Value | None] = field(default_factory=dict)
    """Values of parameters, evaluated on demand; None during the evaluation, and without a value."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Reading)

    def in_si(self, value: Any, unit: Unit | None) -> Any:  # noqa: ANN401 - whatever TOML holds
        """A number or an expression in SI, infinite if it is too large; another value, or one without unit, unchanged.

        Raises:
            SceneError: the expression has no value, or another unit.
        """
        try:
            if isinstance(value, str) and value.startswith("="):
                return self._evaluated(value, unit)
            if unit is None or isinstance(value, bool) or not isinstance(value, int | float):
                return value
            return unit.in_si(float(value), self.units)
        except OverflowError:
            return math.inf

    def register(self, parameters: Mapping[str, Parameter]) -> Mapping[str, Parameter]:
        """The parameters in SI with the settings; the reading evaluates expressions from now on.

        Raises:
            SceneError: unknown names or units, cycles, or values out of range.
        """
        self.parameters, found = parameters, dict[str, Parameter]()
        mistakes = [
            unknown_name(name, name, "parameter", parameters)
            for name in self.settings
            if name not in parameters and not self._lacks("parameters", name)
        ]
        for name in parameters:
            try:
                found[name] = self._parameter(name, parameters[name])
            except SceneError as error:
                mistakes += [each._replace(key=each.key or name) for each in error.mistakes]
        refuse_broken(*mistakes)
        return frozendict(found)

    def _lacks(self, table: str, name: str) -> bool:
        return not {(table, ""), (table, name)}.isdisjoint(self.left_out)

    def _evaluated(self, text: str, unit: Unit | None) -> float:
        """Number of an expression in SI, for a key with a ``unit``; None without a check of the unit."""
        number, own = self._expression(text, "")
        if self._lacks("units", "length"):
            silent()  # the unit of the file's lengths is unknown
        refuse_broken(
            own is not None
            and unit is not None
            and own.dimension != unit.dimension
            and Mistake(
                "",
                f"{text!r}, a number in {own}" if str(own) else f"{text!r}, a ratio without unit",
                f"a number in {unit}" if str(unit) else "a number without unit",
            )
        )
        return number if unit is None or own is not None else unit.in_si(number, self.units)

    def _expression(self, text: str, key: str, users: tuple[str, ...] = ()) -> Value:
        known = silent() if self.parameters is None else self.parameters
        try:
            return evaluated(text.removeprefix("="), lambda name: self._named(name, users), self.units)
        except ExpressionError as error:
            allowed = f"an expression of numbers, + - * / ** ( ) and {', '.join((*known, 'pi', *FUNCTIONS))}"
            raise mistake(f"{text!r}: {error}", allowed, key) from None

    def _parameter(self, name: str, given: Parameter) -> Parameter:
        """A parameter with all numbers in SI."""
        number, unit = self._named(name)
        size, own = unit_of(given.unit, f"{name}.unit")
        span = given.range and (given.range[0] * size, given.range[1] * size)
        slack = _ROUNDED * max(map(abs, span)) if span else 0.0
        refuse_broken(
            span
            and not span[0] - slack <= number <= span[1] + slack
            and Mistake(
                f"{name}.value",
                f"{number / size:.9g} {given.unit}".rstrip(),
                f"a number from {span[0] / size:g} to {span[1] / size:g} {given.unit}".rstrip(),
            )
        )
        return Parameter(
            value=number,
            unit=str(own if given.unit else unit or NUMBER),
            range=span,
            tolerance=given.tolerance and Tolerance(**{kind: each and each * size for kind, each in given.tolerance}),
        )

    def _named(self, name: str, users: tuple[str, ...] = ()) -> Value:
        """Value of a parameter that its ``users`` refer to, from the first parameter to the last."""
        known = self.parameters or {}
        if name in users or (name not in known and not self._lacks("parameters", name)):
            unknown = unknown_name("", name, "parameter", known).found
            raise ExpressionError(f"a cycle: {' -> '.join((*users, name))}" if name in users else unknown)
        if name in known and name not in self.values:
            self.values[name] = None
            self.values[name] = self._computed(name, known[name], (*users, name))
        return self.values.get(name) or silent()

    def _computed(self, name: str, given: Parameter, users: tuple[str, ...]) -> Value:
        setting = self.settings.get(name)
        if isinstance(given.value, str):
            refuse_broken(
                (given.unit or setting is not None)
                and Mistake(
                    name,
                    f"{given.value!r}, an expression",
                    "a number with a unit, or an expression alone; an expression takes no other value",
                )
            )
            return self._expression(given.value, f"{name}.value", users)
        number, (size, unit) = given.value, unit_of(given.unit, f"{name}.unit")
        own, written = unit, isinstance(setting, str) and _SETTING.fullmatch(setting)
        if written:
            number, (size, own) = float(written[1]), unit_of(written[2] or given.unit, name)
        elif setting is not None:
            number, size = math.nan if isinstance(setting, str) else setting, 1.0
        refuse_broken(
            not (math.isfinite(number * size) and own.dimension == unit.dimension)
            and Mistake(
                name,
                repr(given.value if setting is None else setting),
                f"a finite number, as 1.9{given.unit}",
            )
        )
        return Value(float(Fraction(repr(number)) * Fraction(repr(size))), unit if given.unit else None)


@dataclass(frozen=True, slots=True)
class Measured:
    """Metadata of a field whose numbers have a ``unit``, or the unit by a rule from fields that are read already.

    A rule returns None for an unknown unit.
    """

    unit: Unit | Callable[[Reading, Mapping[str, Any]], Unit | None]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_wrap_validator_function(self.number, handler(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [handler(schema), {"type": "string", "pattern": "^="}]}

    def number(self, value: object, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> object:
        """The number in SI; the field's bounds are on the file's number, or on the value of an expression."""
        if not isinstance(info.context, Reading):
            return handler(value)
        unit = self.unit if isinstance(self.unit, Unit) else self.unit(info.context, info.data)
        number = info.context.in_si(value, unit)
        checked = handler(number if isinstance(value, str) else value)
        pure = unit is None or unit == NUMBER
        refuse_broken(
            not (pure or number == 0.0 == checked or SMALLEST <= abs(number) <= LARGEST)
            and Mistake("", shown(value), f"zero or a magnitude between {SMALLEST:g} and {LARGEST:g} in SI units")
        )
        return checked if pure else number


Number = Annotated[float, Measured(NUMBER)]
Length = Annotated[float, Measured(LENGTH)]
Angle = Annotated[float, Measured(ANGLE)]
PositiveLength = Annotated[float, Field(gt=0.0), Measured(LENGTH)]
Positive = Annotated[float, Field(gt=0.0), Measured(NUMBER)]
Share = Annotated[float, Field(ge=0.0, le=1.0), Measured(NUMBER)]
PositiveShare = Annotated[float, Field(gt=0.0, le=1.0), Measured(NUMBER)]
Point = tuple[Length, Length]


def _nonzero(direction: tuple[float, float]) -> tuple[float, float]:
    refuse_broken(direction == (0.0, 0.0) and Mistake("", "[0, 0]", "a direction, at least one number not zero"))
    return direction


Direction = Annotated[tuple[Number, Number], AfterValidator(_nonzero)]
"""Vector of any length but zero."""


def _by_powers(coefficients: object, info: ValidationInfo) -> object:
    """Coefficients of f in SI."""
    return (
        tuple(info.context.in_si(value, Unit(length=1 - k)) for k, value in enumerate(coefficients))
        if isinstance(info.context, Reading) and isinstance(coefficients, tuple)
        else coefficients
    )


Coefficients = Annotated[tuple[Number, ...], Field(min_length=2), BeforeValidator(_by_powers)]
"""Coefficients of a function f, a length, of a variable that is a length; lowest power first."""
