"""Parameters of a scene, and expressions of parameters: named numbers with a unit, a range and a tolerance.

An expression such as ``"= 50*sqrt(3) - t/2"`` is read by a white list of Python's syntax.  A value is a number in SI
with its :class:`~cprbm_scene.units.Unit`.  Literals, pi and results of sin, cos and tan have no unit (None): a sum
gives them the file's unit of the other term, a key its own unit.  A ratio of two lengths is a pure number, no length.
"""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Annotated, NamedTuple, get_args

from pydantic import Field, ValidationInfo, ValidatorFunctionWrapHandler, WithJsonSchema, WrapValidator

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake, SceneError, broken, shown, unknown_name
from cprbm_scene.units import ANGLE, NUMBER, OR_EXPRESSION, SIZES, Reading, Record, Unit, Units, mistake, silent

LONGEST = 300
"""Largest number of characters of an expression: the evaluation of a longer expression could exhaust the stack."""


class Value(NamedTuple):
    """A number in SI, with its unit; a number without unit (None) is in the unit of its place."""

    number: float
    unit: Unit | None = None


class ExpressionError(Exception):
    """An expression without a value; the message completes ``found EXPRESSION``."""


def _refuse(wrong: object, reason: str) -> None:
    if wrong:
        raise ExpressionError(reason)


Rule = Callable[[Callable[..., float], Sequence[Value], Units], Value]
"""Value of a function of values, with the file's units for numbers without unit."""


def _alike(function: Callable[..., float], values: Sequence[Value], units: Units) -> Value:
    """Sum, extremum or length of values of one dimension."""
    unit = next((value.unit for value in values if value.unit is not None), None)
    _refuse(
        any(value.unit is not None and value.unit.dimension != unit.dimension for value in values if unit is not None),
        "different units in one sum or function",
    )
    numbers = (
        value.number if unit is None or value.unit is not None else unit.in_si(value.number, units) for value in values
    )
    return Value(float(function(*numbers)), unit)


def _angle(function: Callable[..., float], values: Sequence[Value], units: Units) -> Value:
    """Angle from values of one dimension."""
    return Value(_alike(function, values, units).number, ANGLE)


def _of_angle(function: Callable[..., float], values: Sequence[Value], units: Units) -> Value:
    """Sine, cosine or tangent of an angle."""
    return Value(_alike(lambda _, angle: function(angle), [Value(0.0, ANGLE), *values], units).number)


def _product(function: Callable[..., float], values: Sequence[Value], units: Units) -> Value:
    """Product or quotient of two values."""
    (one, unit), (other, second) = values
    if second is not None:
        unit = (unit or NUMBER).times(second, -1 if function is operator.truediv else 1)
    return Value(function(one, other), unit)


def _power(function: Callable[..., float], values: Sequence[Value], units: Units) -> Value:
    """Power of a value, with stress as force over the square of length; without an exponent the square root."""
    (number, unit), (exponent, wrong) = values if len(values) > 1 else (values[0], Value(0.5))
    _refuse(wrong is not None, "no arithmetic, or an exponent with a unit")
    if unit is not None:
        powers = [power * exponent for power in (*unit.dimension, unit.angle)]
        _refuse(not all(power.is_integer() for power in powers), "a root of a unit")
        unit = Unit(*map(int, powers))
    _refuse(number < 0.0 and not exponent.is_integer(), "a power of a negative number")
    return Value(number**exponent, unit)


_RULES: Mapping[str, tuple[Callable[..., float], Rule, int]] = frozendict(
    {
        "+": (operator.add, _alike, 2),
        "-": (operator.sub, _alike, 2),
        "**": (operator.pow, _power, 2),
        "*": (operator.mul, _product, 2),
        "/": (operator.truediv, _product, 2),
        **{name: (getattr(math, name), _of_angle, 1) for name in ("sin", "cos", "tan")},
        "hypot": (math.hypot, _alike, 0),
        "min": (lambda *numbers: min(numbers), _alike, 0),
        "max": (lambda *numbers: max(numbers), _alike, 0),
        "abs": (abs, _alike, 1),
        "atan2": (math.atan2, _angle, 2),
        "sqrt": (math.sqrt, _power, 1),
    }
)
"""Operators and functions, each with the rule of its unit and the number of its arguments (0: at least one)."""
_SIGNS = frozendict({ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"})
FUNCTIONS = tuple(name for name in _RULES if name.isidentifier())


def evaluated(text: str, named: Callable[[str], Value], units: Units) -> Value:
    """Value of an expression.

    Args:
        text: the expression, without the equals sign.
        named: function from a name to its value.
        units: units of the file.

    Raises:
        ExpressionError: the expression is no arithmetic, has no finite value, or combines different units.
    """
    _refuse(len(text) > LONGEST, f"an expression of {len(text)} characters")

    def of(node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return Value(float(number))
            case ast.Name(id=name):
                return Value(math.pi) if name == "pi" else named(name)
            case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
                number, unit = of(operand)
                return Value(-number if isinstance(sign, ast.USub) else number, unit)
            case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _SIGNS:
                name, nodes = _SIGNS[type(sign)], [left, right]
            case ast.Call(func=ast.Name(id=name), args=nodes, keywords=[]) if name in FUNCTIONS:
                pass
            case _:
                raise ExpressionError(f"{ast.unparse(node)!r}, which is no arithmetic")
        function, rule, count = _RULES[name]
        _refuse(len(nodes) != (count or max(len(nodes), 1)), f"{name} of {len(nodes)} numbers")
        return rule(function, [of(each) for each in nodes], units)

    try:
        value = of(ast.parse(text.strip(), mode="eval").body)
    except SyntaxError:
        raise ExpressionError("no arithmetic") from None
    except SceneError:
        raise
    except (ArithmeticError, ValueError) as error:
        raise ExpressionError(f"without a value ({error.args[-1]})") from None
    _refuse(not math.isfinite(value.number), "without a finite value")
    return value


_SETTING = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
_ROUNDED = 1e-12
"""Share of a range by which a value may exceed the range: units are converted."""

_NAMED: Mapping[str, Value] = frozendict(
    {
        name: Value(float(SIZES[name]), Unit(**{quantity: 1}))
        for quantity, field in Units.model_fields.items()
        for name in get_args(field.annotation)
    }
)


def _or_expression(value: object, handler: ValidatorFunctionWrapHandler, info: ValidationInfo) -> object:
    of_file = isinstance(info.context, Reading)
    return value if of_file and isinstance(value, str) and value.startswith("=") else handler(value)


Scatter = Annotated[float, Field(gt=0.0)] | None


class Tolerance(Record):
    """Scatter of a parameter, normal or uniform."""

    normal: Scatter = None
    """Standard deviation of a normal scatter, in the parameter's unit."""
    uniform: Scatter = None
    """Half of the width of a uniform scatter, in the parameter's unit."""


class Parameter(Record):
    """A named number for expressions; after reading all numbers are in SI."""

    value: Annotated[float, WrapValidator(_or_expression), WithJsonSchema(OR_EXPRESSION)]
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


def register(reading: Reading, parameters: Mapping[str, Parameter]) -> Mapping[str, Parameter]:
    """The parameters in SI with the reading's settings; the reading evaluates expressions from now on.

    Raises:
        SceneError: unknown names or units, cycles, or values out of range.
    """
    resolved = _Resolved(reading, parameters)
    mistakes = [
        unknown_name(name, name, "parameter", parameters)
        for name in reading.settings
        if name not in parameters and not resolved.left_out(name)
    ]
    found = {}
    for name in parameters:
        try:
            found[name] = resolved.in_si(name)
        except SceneError as error:
            mistakes += [replace(each, key=each.key or name) for each in error.mistakes]
    if mistakes:
        raise SceneError(mistakes)
    reading.evaluate = resolved.evaluate
    return frozendict(found)


class _Resolved:
    """Values of parameters, evaluated on demand."""

    def __init__(self, reading: Reading, parameters: Mapping[str, Parameter]) -> None:
        self._reading, self._parameters = reading, parameters
        self._values: dict[str, Value | None] = {}  # None during the evaluation, and without a value

    def left_out(self, name: str) -> bool:
        """True if the file states a parameter of this name, with a mistake."""
        return not {"parameters", f"parameters.{name}"}.isdisjoint(self._reading.left_out)

    def evaluate(self, text: str, unit: Unit | None, key: str = "") -> float:
        """Number of an expression in SI, for a key with a ``unit``; None without a check of the unit."""
        number, own = self._expression(text, key)
        if not {"units", "units.length"}.isdisjoint(self._reading.left_out):
            silent()  # the unit of the file's lengths is unknown
        if own is None or unit is None:
            return number if unit is None else unit.in_si(number, self._reading.units)
        if own.dimension != unit.dimension:
            raise mistake(
                f"{text!r}, a number in {own}" if str(own) else f"{text!r}, a ratio without unit",
                f"a number in {unit}" if str(unit) else "a number without unit",
            )
        return number

    def _expression(self, text: str, key: str, users: tuple[str, ...] = ()) -> Value:
        try:
            return evaluated(text.removeprefix("="), lambda name: self._named(name, users), self._reading.units)
        except ExpressionError as error:
            raise mistake(
                f"{text!r}: {error}",
                f"an expression of numbers, + - * / ** ( ) and {', '.join((*self._parameters, 'pi', *FUNCTIONS))}",
                key,
            ) from None

    def in_si(self, name: str) -> Parameter:
        """A parameter with all numbers in SI."""
        given, (number, unit) = self._parameters[name], self._named(name)
        size, own = _unit_of(given.unit, f"{name}.unit")
        span = given.range and (given.range[0] * size, given.range[1] * size)
        slack = _ROUNDED * max(map(abs, span)) if span else 0.0
        if span and not span[0] - slack <= number <= span[1] + slack:
            raise mistake(
                f"{number / size:.9g} {given.unit}".rstrip(),
                f"a number from {span[0] / size:g} to {span[1] / size:g} {given.unit}".rstrip(),
                f"{name}.value",
            )
        scatter = given.tolerance and Tolerance(**{kind: each and each * size for kind, each in given.tolerance})
        return Parameter(value=number, unit=str(own if given.unit else unit or NUMBER), range=span, tolerance=scatter)

    def _named(self, name: str, users: tuple[str, ...] = ()) -> Value:
        """Value of a parameter that its ``users`` refer to, from the first parameter to the last."""
        if name not in self._parameters and not self.left_out(name):
            raise ExpressionError(unknown_name("", name, "parameter", self._parameters).found)
        _refuse(name in users, f"a cycle: {' -> '.join((*users, name))}")
        if name in self._parameters and name not in self._values:
            self._values[name] = None
            self._values[name] = self._computed(name, self._parameters[name], (*users, name))
        return self._values.get(name) or silent()

    def _computed(self, name: str, given: Parameter, users: tuple[str, ...]) -> Value:
        setting = self._reading.settings.get(name)
        if isinstance(given.value, str):
            if given.unit or setting is not None:
                raise mistake(
                    f"{given.value!r}, an expression",
                    "a number with a unit, or an expression alone; an expression takes no other value",
                    name,
                )
            return self._expression(given.value, f"{name}.value", users)
        size, unit = _unit_of(given.unit, f"{name}.unit")
        number = given.value if setting is None else setting
        if isinstance(number, str):
            written = _SETTING.fullmatch(number)
            if written is None:
                raise mistake(repr(number), "a number with a unit, such as 1.9mm", name)
            size, other = _unit_of(written[2] or given.unit, name)
            if other.dimension != unit.dimension:
                raise mistake(repr(number), f"a number in {given.unit or 'no unit'}", name)
            number = float(written[1])
        elif setting is not None:
            size = 1.0
        if not math.isfinite(number):
            raise mistake(f"{number:g}", "a finite number", name)
        return Value(float(Fraction(repr(number)) * Fraction(repr(size))), unit if given.unit else None)


def _unit_of(text: str, key: str) -> tuple[float, Unit]:
    """Size in SI and powers of a unit such as ``mm`` or ``N*mm``; a plain number for an empty text."""

    def named(name: str) -> Value:
        _refuse(name not in _NAMED, f"{name!r}, which is no unit")
        return _NAMED[name]

    try:
        value = evaluated(text.replace("^", "**"), named, Units()) if text else Value(1.0)
    except ExpressionError as error:
        raise mistake(f"{text!r}: {error}", f"a product of {', '.join(_NAMED)}", key) from None
    return value.number, value.unit or NUMBER
