"""Parameters of a scene, and expressions of parameters: named numbers with a unit, a range and a tolerance.

An expression such as ``"= 50*sqrt(3) - t/2"`` is read by a white list of Python's syntax.
A value is a number in the file's units together with its :class:`~cprbm_scene.units.Unit`.  Literals, pi and results of
sin, cos and tan have no unit (None): a sum gives them the unit of the other term, a key its own unit.  A ratio of two
lengths is a pure number, and no length.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple
from typing import Annotated, Any, NamedTuple

from pydantic import Field, ValidationInfo, ValidatorFunctionWrapHandler

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import unknown_name
from cprbm_scene.record import Record
from cprbm_scene.units import ANGLE, FORCE, LENGTH, STRESS, Measured, Reading, Unit, Units, mistake

LONGEST = 300
"""Largest number of characters of an expression: the evaluation of a longer expression could exhaust the stack."""


class Value(NamedTuple):
    """A number in the file's units, with its unit; None for a number without unit."""

    number: float
    unit: Unit | None = None


class ExpressionError(ValueError):
    """An expression without a value; the message completes ``found EXPRESSION``."""


_TERMS: Mapping[type[ast.AST], Callable[[float, float], float]] = frozendict(
    {ast.Add: operator.add, ast.Sub: operator.sub}
)
_FACTORS: Mapping[type[ast.AST], tuple[Callable[[float, float], float], int]] = frozendict(
    {ast.Mult: (operator.mul, 1), ast.Div: (operator.truediv, -1)}
)
_TURNS = frozendict({"sin": math.sin, "cos": math.cos, "tan": math.tan})
_ALIKE: Mapping[str, Callable[..., float]] = frozendict(
    {"hypot": math.hypot, "min": min, "max": max, "abs": abs, "atan2": math.atan2}
)
_COUNTS = frozendict({"sqrt": 1, "sin": 1, "cos": 1, "tan": 1, "abs": 1, "atan2": 2})
FUNCTIONS = (*_TURNS, *_ALIKE, "sqrt")


def evaluated(text: str, named: Callable[[str], Value], units: Units) -> Value:
    """Value of an expression.

    Args:
        text: the expression, without the equals sign.
        named: function from a name to its value.
        units: units of the file.

    Returns:
        The number in the file's units, with its unit.

    Raises:
        ExpressionError: the expression is no arithmetic, has no finite value, or combines different units.
    """
    if len(text) > LONGEST:
        raise ExpressionError(f"an expression of {len(text)} characters")
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError):
        raise ExpressionError("no arithmetic") from None
    try:
        value = _Evaluation(named, units).of(tree.body)
    except ArithmeticError as error:
        raise ExpressionError(f"without a value ({error.args[-1]})") from None
    if not math.isfinite(value.number):
        raise ExpressionError("without a finite value")
    return value


class _Evaluation:
    def __init__(self, named: Callable[[str], Value], units: Units) -> None:
        self._named, self._units = named, units

    def of(self, node: ast.expr) -> Value:
        """Value of a node."""
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return Value(float(number))
            case ast.Name(id="pi"):
                return Value(math.pi)
            case ast.Name(id=name):
                return self._named(name)
            case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
                value = self.of(operand)
                return value._replace(number=-value.number) if isinstance(sign, ast.USub) else value
            case ast.BinOp(left=left, op=op, right=right):
                return self._combined(op, self.of(left), self.of(right))
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in FUNCTIONS:
                if not args or len(args) != _COUNTS.get(name, len(args)):
                    raise ExpressionError(f"{name} of {len(args)} numbers")
                return self._called(name, [self.of(each) for each in args])
        raise ExpressionError(f"{ast.unparse(node)!r}, which is no arithmetic")

    def _combined(self, op: ast.operator, left: Value, right: Value) -> Value:
        if type(op) in _TERMS:
            (one, other), unit = self._alike((left, right))
            return Value(_TERMS[type(op)](one, other), unit)
        if type(op) in _FACTORS:
            function, power = _FACTORS[type(op)]
            unit = left.unit if right.unit is None else (left.unit or Unit()).times(right.unit, power)
            return Value(function(left.number, right.number), unit)
        if not isinstance(op, ast.Pow) or right.unit is not None:
            raise ExpressionError("no arithmetic, or an exponent with a unit")
        return self._power(left, right.number)

    def _called(self, name: str, values: Sequence[Value]) -> Value:
        if name == "sqrt":
            return self._power(values[0], 0.5)
        degree = math.pi / 180.0 if self._units.angle == "deg" else 1.0
        if name in _TURNS:
            (_, angle), _ = self._alike((Value(0.0, ANGLE), values[0]))
            return Value(_TURNS[name](angle * degree))
        numbers, unit = self._alike(values)
        number = float(_ALIKE[name](*numbers)) if len(numbers) > 1 or name in ("abs", "hypot") else numbers[0]
        return Value(number / degree, ANGLE) if name == "atan2" else Value(number, unit)

    def _alike(self, values: Sequence[Value]) -> tuple[list[float], Unit | None]:
        """Numbers in a common unit, and the unit."""
        unit = next((value.unit for value in values if value.unit is not None), None)
        factors = [1.0 if value.unit is None else value.unit.over(unit or Unit(), self._units) for value in values]
        if None in factors:
            raise ExpressionError("different units in one sum or function")
        return [value.number * (factor or 1.0) for value, factor in zip(values, factors, strict=True)], unit

    def _power(self, value: Value, exponent: float) -> Value:
        """A power of a value, with stress as force over the square of length."""
        number, unit = value
        if unit is not None:
            plain = Unit(unit.length - 2 * unit.stress, unit.force + unit.stress, unit.angle)
            number *= unit.over(plain, self._units) or 1.0
            powers = [power * exponent for power in astuple(plain)]
            if any(power != round(power) for power in powers):
                raise ExpressionError("a root of a unit")
            unit = Unit(*map(round, powers))
        if number < 0.0 and exponent != round(exponent):
            raise ExpressionError("a power of a negative number")
        return Value(number**exponent, unit)


_SETTING = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_ROUNDED = 1e-12
"""Share of a range by which a value may exceed the range: units are converted."""

_NAMED = frozendict(
    {name: (Units(length=name), LENGTH) for name in ("m", "cm", "mm", "um", "in")}
    | {name: (Units(force=name), FORCE) for name in ("N", "kN", "mN", "uN")}
    | {name: (Units(angle=name), ANGLE) for name in ("rad", "deg")}
    | {name: (Units(stress=name), STRESS) for name in ("Pa", "kPa", "MPa", "GPa")}
)


class _Own(Measured):
    """Metadata of numbers in the parameter's own unit."""

    def of(self, reading: Reading, record: Mapping[str, Any]) -> None:
        """None: the parameter states the unit."""

    def _number(self, value: object, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> object:
        expression = isinstance(info.context, Reading) and isinstance(value, str) and value.startswith("=")
        return value if expression else handler(value)


Own = Annotated[float, _Own()]
PositiveOwn = Annotated[float, Field(gt=0.0), _Own()]


class Tolerance(Record):
    """Scatter of a parameter: ``normal``, a standard deviation, or ``uniform``, half of a width; in its unit."""

    normal: PositiveOwn | None = None
    uniform: PositiveOwn | None = None


class Parameter(Record):
    """A named number: a ``value`` in a ``unit`` such as ``mm`` or ``N*mm``, within a ``range``, with a ``tolerance``.

    Without a unit the parameter is a plain number.  In place of a number the value may be an expression; it is then in
    the file's units.  After reading all numbers are in SI.
    """

    value: Own
    unit: str = ""
    range: tuple[Own, Own] | None = None
    tolerance: Tolerance | None = None


def register(reading: Reading, parameters: Mapping[str, Parameter]) -> Mapping[str, Parameter]:
    """The parameters in SI with the reading's settings; the reading evaluates expressions from now on.

    Raises:
        SceneError: an unknown name or unit, a cycle, or a value out of range.
    """
    for name in reading.settings:
        if name not in parameters:
            unknown = unknown_name(name, name, "parameter", parameters)
            raise mistake(unknown.found, unknown.allowed, unknown.key)
    resolved = _Resolved(reading, parameters)
    found = {name: resolved.in_si(name) for name in parameters}
    reading.evaluate = resolved.evaluate
    return frozendict(found)


class _Resolved:
    """Values of parameters in the file's units, evaluated on demand."""

    def __init__(self, reading: Reading, parameters: Mapping[str, Parameter]) -> None:
        self._reading, self._parameters = reading, parameters
        self._values: dict[str, Value] = {}
        self._open: list[str] = []

    def evaluate(self, text: str, unit: Unit | None) -> float:
        """Number of an expression in the file's units, for a key with a ``unit``; None without a check of the unit."""
        try:
            value = evaluated(text.removeprefix("="), self._named, self._reading.units)
        except ExpressionError as error:
            known = ", ".join((*self._parameters, "pi", *FUNCTIONS))
            raise mistake(f"{text!r}: {error}", f"an expression of numbers, + - * / ** ( ) and {known}") from None
        factor = 1.0 if unit is None or value.unit is None else value.unit.over(unit, self._reading.units)
        if factor is None:
            found = f"{text!r}, a number in {value.unit}" if str(value.unit) else f"{text!r}, a ratio without unit"
            raise mistake(found, f"a number in {unit}" if str(unit) else "a number without unit")
        return value.number * factor

    def in_si(self, name: str) -> Parameter:
        """A parameter with all numbers in SI."""
        given, value = self._parameters[name], self._value(name)
        unit = value.unit or Unit()
        size, own = _unit_of(given.unit, f"{name}.unit")
        number = unit.in_si(value.number, self._reading.units)
        span = given.range and (given.range[0] * size, given.range[1] * size)
        if span is not None:
            slack = _ROUNDED * max(abs(span[0]), abs(span[1]))
            if not span[0] - slack <= number <= span[1] + slack:
                allowed = f"a number from {span[0] / size:g} to {span[1] / size:g} {given.unit}".rstrip()
                raise mistake(f"{number / size:.9g} {given.unit}".rstrip(), allowed, f"{name}.value")
        scatter = given.tolerance and Tolerance(
            normal=given.tolerance.normal and given.tolerance.normal * size,
            uniform=given.tolerance.uniform and given.tolerance.uniform * size,
        )
        return Parameter(value=number, unit=str(own if given.unit else unit), range=span, tolerance=scatter)

    def _named(self, name: str) -> Value:
        if name not in self._parameters:
            raise ExpressionError(unknown_name("", name, "parameter", self._parameters).found)
        return self._value(name)

    def _value(self, name: str) -> Value:
        if name in self._open:
            raise ExpressionError(f"a cycle: {' -> '.join((*self._open, name))}")
        if name not in self._values:
            self._open.append(name)
            self._values[name] = self._computed(name, self._parameters[name])
            self._open.pop()
        return self._values[name]

    def _computed(self, name: str, given: Parameter) -> Value:
        size, unit = _unit_of(given.unit, f"{name}.unit")
        setting = self._reading.settings.get(name)
        if isinstance(given.value, str):
            if given.unit or setting is not None:
                raise mistake(f"{given.value!r}, an expression", "a number with a unit, or an expression alone", name)
            try:
                return evaluated(given.value.removeprefix("="), self._named, self._reading.units)
            except ExpressionError as error:
                raise mistake(f"{given.value!r}: {error}", "an expression of parameters", f"{name}.value") from None
        number = given.value
        if isinstance(setting, str):
            written = _SETTING.fullmatch(setting)
            if written is None:
                raise mistake(repr(setting), "a number with a unit, such as 1.9mm", name)
            other_size, other = _unit_of(written[2] or given.unit, name)
            if other.over(unit, Units()) is None:
                raise mistake(repr(setting), f"a number in {given.unit or 'no unit'}", name)
            number = float(written[1]) * (other_size / size)
        elif setting is not None:
            number = float(setting) / size
        if not math.isfinite(number):
            raise mistake(f"{number:g}", "a finite number", name)
        return Value(number * (size / unit.in_si(1.0, self._reading.units)), unit if given.unit else None)


def _unit_of(text: str, key: str) -> tuple[float, Unit]:
    """Size in SI and powers of a unit such as ``mm`` or ``N*mm``; a plain number for an empty text."""
    if not text:
        return 1.0, Unit()

    def named(name: str) -> Value:
        if name not in _NAMED:
            raise ExpressionError(f"{name!r}, which is no unit")
        units, unit = _NAMED[name]
        return Value(unit.in_si(1.0, units), unit)

    try:
        value = evaluated(text.replace("^", "**"), named, Units())
    except ExpressionError as error:
        raise mistake(f"{text!r}: {error}", f"a product of {', '.join(_NAMED)}", key) from None
    return value.number, value.unit or Unit()
