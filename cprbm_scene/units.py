"""Numbers of files: units, expressions with units, and points of tables of separated values.

An expression such as ``"= 50*sqrt(3) - t/2"`` is read by a white list of Python's syntax.  A value is a number in SI
with its :class:`Unit`.  Literals, pi and results of sin, cos and tan have no unit (None): a sum gives them the file's
unit of the other term, a key its own unit.  A ratio of two lengths is a pure number, no length.

A table has a header of names and units, ``x [mm], y [mm]``, and may have further columns, blank lines and lines of
comment that begin with ``#``.  Columns are separated by commas, semicolons or tabs; numbers have a decimal point.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from cprbm_scene.mistakes import Mistake, SceneError, mistake, refuse_broken

SMALLEST, LARGEST = 1e-50, 1e50
"""Magnitudes of numbers with a unit, in SI: a product of six such numbers stays within floating-point numbers."""

BY_QUANTITY: Mapping[str, Mapping[str, Fraction]] = {
    "length": {
        "m": Fraction(1),
        "cm": Fraction("0.01"),
        "mm": Fraction("0.001"),
        "um": Fraction("1e-6"),
        "in": Fraction("0.0254"),
    },
    "force": {
        "N": Fraction(1),
        "kN": Fraction(10**3),
        "mN": Fraction(1, 10**3),
        "uN": Fraction(1, 10**6),
        "lbf": Fraction("4.4482216152605"),
    },
    "angle": {"rad": Fraction(1), "deg": Fraction(math.pi / 180.0)},
    "stress": {
        "Pa": Fraction(1),
        "kPa": Fraction(10**3),
        "MPa": Fraction(10**6),
        "GPa": Fraction(10**9),
        "psi": Fraction("4.4482216152605") / Fraction("0.0254") ** 2,
    },
}
"""Sizes of units in SI, by the quantities of :class:`Unit`."""
SIZES: Mapping[str, Fraction] = {name: size for sizes in BY_QUANTITY.values() for name, size in sizes.items()}

FileUnits = Iterable[tuple[str, str]]
"""Quantities of :class:`Unit` in order, each with the file's unit."""


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

    def in_si(self, value: float, units: Iterable[tuple[str, str]]) -> float:
        """A number of a file in SI.

        Raises:
            OverflowError: the number is above the largest floating-point number.
        """
        size = math.prod(SIZES[name] ** power for (_, name), power in zip(units, self, strict=True) if power)
        return float(Fraction(repr(value)) * size) if size != 1 and math.isfinite(value) else value

    def __str__(self) -> str:
        return "*".join(
            f"{name}**{power}" if power != 1 else name
            for name, power in zip(("m", "N", "rad", "Pa"), self, strict=True)
            if power
        )


NUMBER = Unit()
LENGTH, FORCE, ANGLE, STRESS = Unit(length=1), Unit(force=1), Unit(angle=1), Unit(stress=1)
MOMENT, LINE_LOAD = Unit(length=1, force=1), Unit(length=-1, force=1)

LONGEST_EXPRESSION = 300
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


Rule = Callable[[Callable[..., float], Sequence[Value], FileUnits], Value]
"""Value of a function of values, with the file's units for numbers without unit."""


def _alike(function: Callable[..., float], values: Sequence[Value], units: FileUnits) -> Value:
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


def _angle(function: Callable[..., float], values: Sequence[Value], units: FileUnits) -> Value:
    """Angle from values of one dimension."""
    return Value(_alike(function, values, units).number, ANGLE)


def _of_angle(function: Callable[..., float], values: Sequence[Value], units: FileUnits) -> Value:
    """Sine, cosine or tangent of an angle."""
    return Value(_alike(lambda _, angle: function(angle), [Value(0.0, ANGLE), *values], units).number)


def _product(function: Callable[..., float], values: Sequence[Value], units: FileUnits) -> Value:
    """Product or quotient of two values."""
    (one, unit), (other, second) = values
    if second is not None:
        sense = -1 if function is operator.truediv else 1
        unit = Unit(*(power + sense * further for power, further in zip(unit or NUMBER, second, strict=True)))
    return Value(function(one, other), unit)


def _power(function: Callable[..., float], values: Sequence[Value], units: FileUnits) -> Value:
    """Power of a value, with stress as force over the square of length; without an exponent the square root."""
    (number, unit), (exponent, wrong) = values if len(values) > 1 else (values[0], Value(0.5))
    _refuse(wrong is not None, "no arithmetic, or an exponent with a unit")
    if unit is not None:
        powers = [power * exponent for power in (*unit.dimension, unit.angle)]
        _refuse(not all(power.is_integer() for power in powers), "a root of a unit")
        unit = Unit(*map(int, powers))
    _refuse(number < 0.0 and not exponent.is_integer(), "a power of a negative number")
    return Value(number**exponent, unit)


_RULES: Mapping[str, tuple[Callable[..., float], Rule, int]] = {
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
"""Operators and functions, each with the rule of its unit and the number of its arguments (0: at least one)."""
_SIGNS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.Pow: "**"}
FUNCTIONS = tuple(name for name in _RULES if name.isidentifier())


def evaluated(text: str, named: Callable[[str], Value], units: FileUnits) -> Value:
    """Value of an expression.

    Args:
        text: the expression, without the equals sign.
        named: function from a name to its value.
        units: units of the file.

    Raises:
        ExpressionError: the expression is no arithmetic, has no finite value, or combines different units.
    """
    _refuse(len(text) > LONGEST_EXPRESSION, f"an expression of {len(text)} characters")

    def of(node: ast.expr) -> Value:
        match node:
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return Value(float(number))
            case ast.Name(id=name):
                return Value(math.pi) if name == "pi" else named(name)
            case ast.UnaryOp(op=ast.UAdd() | ast.USub() as sign, operand=operand):
                return _product(operator.mul, [Value(-1.0 if isinstance(sign, ast.USub) else 1.0), of(operand)], units)
            case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _SIGNS:
                return of(ast.Call(ast.Name(_SIGNS[type(sign)]), [left, right], []))
            case ast.Call(func=ast.Name(id=name), args=nodes, keywords=[]) if name in _RULES:
                function, rule, count = _RULES[name]
                _refuse(len(nodes) != (count or max(len(nodes), 1)), f"{name} of {len(nodes)} numbers")
                return rule(function, [of(each) for each in nodes], units)
        raise ExpressionError(f"{ast.unparse(node)!r}, which is no arithmetic")

    try:
        # Python reads a name with a letter of full width as the plain name, but as no keyword: 'in' is a unit
        value = of(
            ast.parse(
                re.sub(r"(?<![\w.])[A-Za-z]", lambda letter: chr(0xFEE0 + ord(letter[0])), text.strip()), mode="eval"
            ).body
        )
    except SyntaxError:
        raise ExpressionError("no arithmetic") from None
    except SceneError:
        raise
    except (ArithmeticError, ValueError) as error:
        raise ExpressionError(f"without a value ({error.args[-1]})") from None
    _refuse(not math.isfinite(value.number), "without a finite value")
    return value


NAMED: Mapping[str, Value] = {
    name: Value(float(size), Unit(**{quantity: 1}))
    for quantity, sizes in BY_QUANTITY.items()
    for name, size in sizes.items()
}
"""Units as values."""


def unit_of(text: str, key: str) -> tuple[float, Unit]:
    """Size in SI and powers of a unit such as ``mm`` or ``N*mm``; a plain number for an empty text."""

    def named(name: str) -> Value:
        _refuse(name not in NAMED, f"{name!r}, which is no unit")
        return NAMED[name]

    try:
        value = evaluated(text.replace("^", "**"), named, ()) if text else Value(1.0)
    except ExpressionError as error:
        raise mistake(f"{text!r}: {error}", f"a product of {', '.join(NAMED)}", key) from None
    return value.number, value.unit or NUMBER


LONGEST = 1_000_000
"""Largest size of a file in bytes: a hundred times the longest built-in case."""
_COLUMN = re.compile(r"\s*([xy])\s*(?:[\[(/_]?\s*(?:in\s)?\s*(mm|cm|um|µm|m|in)\s*[\])]?)?\s*", re.IGNORECASE)


def text_of(path: str | Path, readable: str, name: str = "", most: int = LONGEST) -> str:
    """Text of a file in UTF-8, with or without a byte-order mark.

    Args:
        path: the file.
        readable: description of a readable file, for the messages.
        name: begin of the found values in the messages.
        most: largest size in bytes.

    Raises:
        SceneError: the file cannot be read, or is too large.
    """
    try:
        with Path(path).open("rb") as stream:
            found = stream.read(most + 1)
        if len(found) <= most:
            return found.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise mistake(f"{name}bytes that are no UTF-8 text (at byte {error.start})", readable) from None
    except (OSError, ValueError) as error:
        raise mistake(
            f"{name}a file that cannot be read ({getattr(error, 'strerror', None) or error})", readable
        ) from None
    raise mistake(f"{name}a file that is larger", f"{readable}, at most {most // 1_000_000} MB")


def rows_of(text: str) -> list[tuple[int, list[str]]]:
    """Numbers and cells of the rows of a table, whose first row decides on the separator."""
    lines = [
        (row, line)
        for row, line in enumerate(text.splitlines(), start=1)
        if line.strip(" \t,;#") and not line.lstrip().startswith("#")
    ]
    mark = next((mark for mark in ";\t" if lines and mark in lines[0][1]), ",")
    return [(row, [cell.strip("\"' \t") for cell in line.split(mark)]) for row, line in lines]


def read_points(path: Path, unit: str) -> tuple[tuple[float, float], ...]:
    """Points of the columns x and y, in a unit of length.

    Args:
        path: file in UTF-8, with or without a byte-order mark.
        unit: unit of the points, and of columns without a unit: m, cm, mm, um or in.

    Raises:
        SceneError: the file cannot be read, or has a wrong header or number; the error names file, row and
            column.
    """
    text = text_of(path, "a table of points in UTF-8, with a path from the scene's folder", f"{str(path)!r}, ")
    (first, header), *rows = rows_of(text) or [(1, [""])]
    columns = {
        name[1].lower(): (i, (name[2] or unit).lower().replace("µ", "u"))
        for i, title in enumerate(header)
        if (name := _COLUMN.fullmatch(title))
    }
    refuse_broken(
        set(columns) != {"x", "y"}
        and Mistake(
            "",
            f"{','.join(header)[:80]!r} in {path.name}, row {first}",
            "a header with the columns x and y, such as 'x [mm], y [mm]'; units are m, cm, mm, um and in",
        )
    )
    return tuple(
        (_number(path, row, cells, "x", *columns["x"], unit), _number(path, row, cells, "y", *columns["y"], unit))
        for row, cells in rows
    )


def _number(path: Path, row: int, cells: list[str], name: str, column: int, own: str, unit: str) -> float:
    """Number of a cell in a unit of length."""
    cell = cells[column] if column < len(cells) else ""
    with suppress(ValueError):
        if abs(number := float(cell)) <= LARGEST:
            return number if own == unit else float(Fraction(repr(number)) * SIZES[own] / SIZES[unit])
    raise mistake(f"{cell!r} in {path.name}, row {row}, column {name}", "a finite number with a decimal point")
