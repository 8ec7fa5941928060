"""Search for the tests that depend on internals of the product packages.

A test depends on an internal name if the name is imported by the module of the test, by a ``conftest.py`` above the
module or by a helper module of ``tests``. Helper modules count as a whole, because a failing import stops the whole
module. An import inside a fixture of a ``conftest.py`` counts for the users of the fixture only. Dotted names in
strings (``monkeypatch.setattr("cprbm.march.step", ...)``) and programs in strings (for a subprocess) count as imports.
"""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path

from tests.house.public_names import DOCUMENTED, ENTRIES, EXPORTING

ROOT = Path(__file__).parents[2]
DOTTED = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)+")
FILE_NAME = re.compile(r".*\.(py|toml|json|md|html)")


def product_names() -> dict[str, frozenset[str]]:
    """Public names of the product packages, by module."""
    exported = {package: exported_names(ROOT / package.replace(".", "/") / "__init__.py") for package in EXPORTING}
    return exported | {module: frozenset(names) for module, names in (DOCUMENTED | ENTRIES).items()}


def exported_names(path: Path) -> frozenset[str]:
    """The names in the ``__all__`` of a module, read without an import of the module."""
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return frozenset(ast.literal_eval(node.value))
    return frozenset()


class Internals:
    """Search for internal names below a root folder.

    Args:
        root: the folder of the product packages and of ``tests``.
        public: public names of the product packages, by module.
    """

    def __init__(self, root: Path, public: Mapping[str, frozenset[str]]) -> None:
        self.root = root
        self.public = public
        self.packages = {module.partition(".")[0] for module in public}
        self._dependencies = cache(self._find_dependencies)
        self._functions = cache(functions_of)

    def names_for(self, test: Path, fixtures: Iterable[str] = ()) -> list[str]:
        """Sorted internal names behind a test.

        Args:
            test: the file of the test.
            fixtures: names of the fixtures requested by the test, directly or through other fixtures.
        """
        folders = [test.parent, *test.parent.parents]
        waiting = [test, *(folder / "conftest.py" for folder in folders[: folders.index(self.root)])]
        requested = frozenset(fixtures)
        seen, internal = set(), set()
        while waiting:
            path = waiting.pop()
            if path not in seen:
                seen.add(path)
                of_fixtures = requested & self._functions(path) if path.name == "conftest.py" else None
                names, helpers = self._dependencies(path, of_fixtures)
                internal |= names
                waiting += helpers
        return sorted(internal)

    def _find_dependencies(self, path: Path, fixtures: frozenset[str] | None) -> tuple[set[str], set[Path]]:
        """Internal names that a module imports itself, and the files of its helper modules.

        Functions of a ``conftest.py`` count only if ``fixtures`` holds their names.
        """
        internal, helpers = set(), set()
        if not path.exists():
            return internal, helpers
        tree = ast.parse(path.read_text(encoding="utf-8"))
        if fixtures is not None:
            tree.body = [part for part in tree.body if not isinstance(part, ast.FunctionDef) or part.name in fixtures]
        for dotted in self._used_names(tree):
            module, name = self._split(dotted)
            if module.partition(".")[0] == "tests":
                helpers.add(self._file(module))
            elif not self._is_public(module, name):
                internal.add(f"{module}.{name}" if name else module)
        return internal, helpers

    def _used_names(self, tree: ast.Module) -> set[str]:
        """Dotted names of ``tests`` and of the product packages in a module."""
        used = {*imported_names(tree), *(name for text in strings(tree) for name in self._names_in_string(text))}
        return {name for name in used if name.partition(".")[0] in {*self.packages, "tests"}}

    def _names_in_string(self, text: str) -> Iterator[str]:
        if DOTTED.fullmatch(text):
            yield from [] if FILE_NAME.fullmatch(text) else [text]
        elif "import" in text and any(package in text for package in self.packages):
            yield from imported_names(program(text))

    def _split(self, dotted: str) -> tuple[str, str]:
        """Module and name of a dotted name; the name is "" for a module, further attributes are dropped.

        A public name takes precedence over a module of the same name.
        """
        parts = dotted.split(".")
        prefixes = [(".".join(parts[:n]), "".join(parts[n : n + 1])) for n in range(len(parts), 0, -1)]
        public = (found for found in prefixes if found[1] in self.public.get(found[0], ()))
        modules = (found for found in prefixes if self._file(found[0]).exists())
        return next(public, None) or next(modules, prefixes[-1])

    def _file(self, module: str) -> Path:
        path = self.root / module.replace(".", "/")
        return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")

    def _is_public(self, module: str, name: str) -> bool:
        if not name or name in {"__doc__", "__file__", "__name__"}:
            return any(public == module or public.startswith(f"{module}.") for public in self.public)
        return name in self.public.get(module, ())


def functions_of(path: Path) -> frozenset[str]:
    """Names of the functions of a module; no names without the file."""
    body = ast.parse(path.read_text(encoding="utf-8")).body if path.exists() else []
    return frozenset(part.name for part in body if isinstance(part, ast.FunctionDef))


def imported_names(tree: ast.AST) -> Iterator[str]:
    """Dotted names that a syntax tree imports, and the attributes of imported modules in the tree."""
    nodes = list(ast.walk(tree))
    bound = {}
    for node in nodes:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name
                first = alias.name.partition(".")[0]
                bound[alias.asname or first] = alias.name if alias.asname else first
        elif isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                yield f"{node.module}.{alias.name}"
                bound[alias.asname or alias.name] = f"{node.module}.{alias.name}"
    for node in nodes:
        if isinstance(node, ast.Attribute):
            yield from attribute_name(node, bound)
        elif isinstance(node, ast.Call):
            yield from patched_name(node, bound)


def attribute_name(node: ast.expr, bound: Mapping[str, str]) -> list[str]:
    """The dotted name of an attribute of an imported module; an empty list for any other expression."""
    parts = []
    while isinstance(node, ast.Attribute):
        parts.append(node.attr)
        node = node.value
    return [".".join([bound[node.id], *reversed(parts)])] if isinstance(node, ast.Name) and node.id in bound else []


def patched_name(call: ast.Call, bound: Mapping[str, str]) -> Iterator[str]:
    """The dotted name behind ``setattr(MODULE, "NAME", ...)`` or ``getattr(MODULE, "NAME")``."""
    function = getattr(call.func, "attr", getattr(call.func, "id", ""))
    if function in {"setattr", "delattr", "getattr", "object"} and len(call.args) > 1:
        name = call.args[1].value if isinstance(call.args[1], ast.Constant) else None
        if isinstance(name, str):
            yield from (f"{owner}.{name}" for owner in attribute_name(call.args[0], bound))


def strings(tree: ast.AST) -> Iterator[str]:
    """String constants of a syntax tree; a value put into an f-string reads ``None``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            yield "".join(part.value if isinstance(part, ast.Constant) else "None" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def program(text: str) -> ast.AST:
    """The syntax tree of a program in a string, or of the import statements in any other text."""
    try:
        return ast.parse(textwrap.dedent(text))
    except SyntaxError:
        return ast.Module([statement for line in text.splitlines() for statement in _import_statement(line)], [])


def _import_statement(line: str) -> list[ast.stmt]:
    try:
        return ast.parse(line.strip()).body if line.strip().startswith(("import ", "from ")) else []
    except SyntaxError:
        return []
