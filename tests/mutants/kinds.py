"""What is altered in a source, and where: one small fault at a time.

=============== ============================================================================================
kind            what becomes of the source
=============== ============================================================================================
constant        a whole number grows by one, another by a tenth; of an index, 0 becomes 1 and the rest one less
sign            ``a + b`` becomes ``a - b`` and the other way round, and so with ``+=``; ``-a`` becomes ``a``
product         ``a * b`` becomes ``a / b`` and the other way round
transpose       ``a.T`` becomes ``a``; ``a @ b`` becomes ``b @ a``
dropped term    ``a + b`` and ``a - b`` become ``a``; a statement ``a += b`` is left out
comparison      ``<`` becomes ``<=``, ``>`` becomes ``>=`` and the other way round; ``==`` becomes ``!=``
side            ``<`` becomes ``>``, ``<=`` becomes ``>=`` and the other way round
logic           ``and`` becomes ``or``; ``not a`` becomes ``a``
function        sine and cosine, least and largest, and their like take each other's places
float32         what a function returns, or a name is given, has passed through single precision
stale           what a loop finds anew is found once: a second assignment of the name is left out, as of an active set
=============== ============================================================================================

Texts, annotations and what stands in ``raise`` are left alone.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass

KINDS = (
    *("constant", "sign", "product", "transpose", "dropped term", "comparison", "side", "logic", "function"),
    *("float32", "stale"),
)
OTHER = {
    "sin": "cos",
    "cos": "sin",
    "min": "max",
    "max": "min",
    "argmin": "argmax",
    "argmax": "argmin",
    "minimum": "maximum",
    "maximum": "minimum",
    "any": "all",
    "all": "any",
    "floor": "ceil",
    "ceil": "floor",
    "nanmin": "nanmax",
    "nanmax": "nanmin",
    "zeros_like": "ones_like",
}
FLIPPED: dict[type[ast.cmpop], tuple[str, str | None]] = {
    ast.Lt: ("<=", ">"),
    ast.LtE: ("<", ">="),
    ast.Gt: (">=", "<"),
    ast.GtE: (">", "<="),
    ast.Eq: ("!=", None),
    ast.NotEq: ("==", None),
}
SINGLE = "__import__('numpy').float32"


@dataclass(frozen=True, slots=True)
class Mutant:
    """Bytes ``first`` to ``last`` of ``file`` become ``new``.

    ``line`` is where that stands, ``text`` what stands there, and ``function`` the line of the ``def`` around it, or of
    its first decorator; zero where there is none.
    """

    file: str
    line: int
    function: int
    kind: str
    first: int
    last: int
    new: str
    text: str

    @property
    def fault(self) -> str:
        """Names it, also after lines have moved; two alike in one line have one name."""
        return f"{self.file}: {self.text} -> {self.new}"

    def applied(self, source: bytes) -> bytes:
        """The altered source."""
        return source[: self.first] + self.new.encode() + source[self.last :]


def mutants_of(file: str, source: bytes) -> list[Mutant]:
    """All mutants of a file, in the order of its lines; of a few no reader of Python makes sense (:func:`reads`)."""
    starts = [0]
    for line in source.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))

    texts = [line.decode().strip() for line in source.splitlines()]

    def place(node: ast.AST) -> tuple[int, int]:
        return starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset

    def told(node: ast.AST) -> str:
        first, last = place(node)
        return source[first:last].decode()

    found = []
    for node, function, again, indexed in _nodes(ast.parse(source), 0, frozenset(), indexed=False):
        for kind, where, new in _altered(node, told, again, indexed):
            first, last = place(where)
            if source[first:last].decode() != new:
                found.append(Mutant(file, where.lineno, function, kind, first, last, new, texts[where.lineno - 1]))
    return found


def statement_at(source: bytes, line: int) -> tuple[int, int]:
    """First and last line of the innermost statement around a line; of one with a body, of what stands before it."""
    first, last = line, line
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.stmt) and node.lineno <= line <= node.end_lineno:
            body = getattr(node, "body", None)
            end = body[0].lineno - 1 if body else node.end_lineno
            if line <= max(end, node.lineno):
                first, last = node.lineno, max(end, node.lineno)
    return first, last


def reads(source: bytes) -> bool:
    """Whether it is a source."""
    try:
        ast.parse(source)
    except SyntaxError:
        return False
    return True


def _nodes(node, function, assigned, *, indexed) -> Iterator[tuple[ast.AST, int, frozenset[str] | None, bool]]:
    """Every node that may be altered; the function around it; names a loop assigns again; whether it is an index."""
    for field, child in ast.iter_fields(node):
        typed = field in ("annotation", "returns", "type_params", "decorator_list")
        if typed or (field == "args" and isinstance(node, ast.FunctionDef | ast.Lambda)):
            continue
        children = child if isinstance(child, list) else [child]
        before = set(assigned)
        for each in children:
            if not isinstance(each, ast.AST) or isinstance(
                each, ast.Raise | ast.Import | ast.ImportFrom | ast.JoinedStr
            ):
                continue
            if isinstance(each, ast.Expr) and isinstance(each.value, ast.Constant):
                continue
            inside = function
            if isinstance(each, ast.FunctionDef):
                inside = min([each.lineno, *(one.lineno for one in each.decorator_list)])
                before_inside = frozenset()
            else:
                before_inside = frozenset(before)
            loop = isinstance(node, ast.For | ast.While) and field == "body"
            yield each, inside, (frozenset(before) if loop or getattr(node, "in_loop", False) else None), indexed
            each.in_loop = (loop or getattr(node, "in_loop", False)) and not isinstance(each, ast.FunctionDef)
            yield from _nodes(
                each, inside, before_inside, indexed=indexed or (isinstance(node, ast.Subscript) and field == "slice")
            )
            before |= _names(each)


def _names(node) -> set[str]:
    targets = node.targets if isinstance(node, ast.Assign) else []
    return {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}


def _altered(node, told, again, indexed) -> Iterator[tuple[str, ast.AST, str]]:
    match node:
        case ast.Constant(value=bool()):
            return
        case ast.Constant(value=int(value)):
            new = (1 if value == 0 else value - 1) if indexed else value + 1
            yield "constant", node, str(new)
        case ast.Constant(value=float(value)):
            yield "constant", node, repr(1.1 * value if value else 0.1)
        case ast.BinOp(left=left, op=op, right=right):
            a, b = f"({told(left)})", f"({told(right)})"
            if isinstance(op, ast.Add | ast.Sub):
                yield "sign", node, f"({a} {'-' if isinstance(op, ast.Add) else '+'} {b})"
                yield "dropped term", node, a
            elif isinstance(op, ast.Mult | ast.Div):
                yield "product", node, f"({a} {'/' if isinstance(op, ast.Mult) else '*'} {b})"
            elif isinstance(op, ast.MatMult):
                yield "transpose", node, f"({b} @ {a})"
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield "sign", node, f"({told(operand)})"
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield "logic", node, f"({told(operand)})"
        case ast.AugAssign(target=target, op=ast.Add() | ast.Sub() as op, value=value):
            sign = "-=" if isinstance(op, ast.Add) else "+="
            yield "sign", node, f"{told(target)} {sign} {told(value)}"
            yield "dropped term", node, "pass"
        case ast.Attribute(value=value, attr="T"):
            yield "transpose", node, told(value)
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in FLIPPED:
            near, far = FLIPPED[type(op)]
            yield "comparison", node, f"({told(left)} {near} {told(right)})"
            if far is not None:
                yield "side", node, f"({told(left)} {far} {told(right)})"
        case ast.BoolOp(op=op, values=values):
            word = " or " if isinstance(op, ast.And) else " and "
            yield "logic", node, "(" + word.join(f"({told(value)})" for value in values) + ")"
        case ast.Call(func=ast.Attribute(value=value, attr=name) as function) if name in OTHER:
            yield "function", function, f"{told(value)}.{OTHER[name]}"
        case ast.Call(func=ast.Name(id=name) as function) if name in OTHER:
            yield "function", function, OTHER[name]
        case ast.Return(value=ast.BinOp(op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.MatMult()) as value):
            yield "float32", value, f"{SINGLE}({told(value)})"
        case ast.Assign(targets=targets, value=value):
            if again is not None and _names(node) and _names(node) <= again:
                yield "stale", node, "pass"
            if (
                isinstance(value, ast.BinOp)
                and not isinstance(value.op, ast.BitOr)
                and all(isinstance(target, ast.Name) for target in targets)
            ):
                yield "float32", value, f"{SINGLE}({told(value)})"
