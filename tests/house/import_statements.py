"""Import statements of a source file, with the place of each statement."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

Place = Literal["head", "function", "type checking"]


@dataclass(frozen=True)
class Import:
    """Import of ``library`` (first part of the dotted name) at ``line``.

    ``place`` is "head" for an import when the module is loaded, "function" for an import inside a function, and
    "type checking" for an import under ``if TYPE_CHECKING``.
    """

    library: str
    line: int
    place: Place


def imports_in(source: str) -> Iterator[Import]:
    """Absolute imports in the text of a module, in the order of the text."""
    return _imports_below(ast.parse(source), "head")


def _imports_below(node: ast.AST, place: Place) -> Iterator[Import]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import):
            yield from (Import(alias.name.partition(".")[0], child.lineno, place) for alias in child.names)
        elif isinstance(child, ast.ImportFrom) and not child.level:
            yield Import(child.module.partition(".")[0], child.lineno, place)
        elif isinstance(child, ast.If) and ast.unparse(child.test).endswith("TYPE_CHECKING"):
            yield from _imports_below(ast.Module(child.body, []), "type checking")
            yield from _imports_below(ast.Module(child.orelse, []), place)
        elif isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            yield from _imports_below(child, "function")
        else:
            yield from _imports_below(child, place)
