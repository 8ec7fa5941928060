"""Expressions in a scene file, ``"= 50*sqrt(3) - t/2"``: numbers with units, by a white list of Python's syntax.

A value is a number in the file's units together with its :class:`~cprbm_scene.units.Unit`.  Literals, pi and results of
sin, cos and tan have no unit (None): a sum gives them the unit of the other term, a key its own unit.  A ratio of two
lengths is a pure number, and no length.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import astuple
from typing import NamedTuple

from cprbm_scene.frozendict import frozendict
from cprbm_scene.units import ANGLE, Unit, Units

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
