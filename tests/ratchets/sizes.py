"""The five measured numbers of a package."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.ratchets.prose import comments, docstrings, pronoun_share

LONGEST_FUNCTION = 60
"""Lines of a function, from ``def`` to the last statement."""

LONGEST_MODULE = 400
"""Lines of a file."""

GREATEST_COMPLEXITY = 15
"""Branches of a function, as rule C901 of ruff counts the branches."""

Number = int | float


@dataclass(frozen=True)
class Package:
    """The folder of a package, with the sources and the syntax trees of all modules."""

    folder: Path
    sources: list[str]
    trees: list[ast.Module]

    @property
    def nodes(self) -> Iterator[ast.AST]:
        """All nodes of the syntax trees."""
        return (node for tree in self.trees for node in ast.walk(tree))


def read(folder: Path) -> Package:
    """The package in a folder.

    Raises:
        SyntaxError: a module is no Python.
    """
    sources = [path.read_text(encoding="utf-8") for path in sorted(folder.rglob("*.py"))]
    return Package(folder, sources, [ast.parse(source) for source in sources])


def pronouns(package: Package) -> float:
    """Share of pronouns in docstrings and comments, in percent with one decimal."""
    texts = [*comments(package.sources), *docstrings(package.nodes)]
    return round(100 * pronoun_share(texts), 1)


def long_functions(package: Package) -> int:
    """Number of functions above 60 lines; a function inside a function counts as well."""
    functions = (node for node in package.nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return sum(function.end_lineno - function.lineno + 1 > LONGEST_FUNCTION for function in functions)


def complex_functions(package: Package) -> int:
    """Number of functions of complexity above 15; comments ``noqa`` do not count.

    Raises:
        CalledProcessError: ruff is missing or fails.
    """
    rule = ("--select", "C901", "--config", f"lint.mccabe.max-complexity={GREATEST_COMPLEXITY}", "--ignore-noqa")
    command = (sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "--exit-zero", *rule)
    done = subprocess.run([*command, "--output-format", "json", package.folder], stdout=subprocess.PIPE, check=True)
    return len(json.loads(done.stdout))


def long_modules(package: Package) -> int:
    """Number of modules above 400 lines."""
    return sum(len(source.splitlines()) > LONGEST_MODULE for source in package.sources)


def statements(package: Package) -> int:
    """Number of statements without docstrings; a compound statement and its inner statements count separately."""
    return sum(isinstance(node, ast.stmt) and not is_text(node) for node in package.nodes)


def is_text(statement: ast.stmt) -> bool:
    """True for a statement of a string only, such as a docstring."""
    return isinstance(statement, ast.Expr) and isinstance(getattr(statement.value, "value", None), str)


MEASURES: Mapping[str, Callable[[Package], Number]] = {
    "pronouns": pronouns,
    "long-functions": long_functions,
    "complex-functions": complex_functions,
    "long-modules": long_modules,
    "statements": statements,
}
"""Functions from a package to a number, by the name of the number in ``limits.toml``."""


def sizes(folder: Path) -> dict[str, Number]:
    """All numbers of the package in a folder, by name."""
    package = read(folder)
    return {name: measure(package) for name, measure in MEASURES.items()}
