"""Reads a source tree's imports, at any depth and behind any name, and says which of them break the law.

The law (CONTRIBUTING.md): cprbm_scene imports none of our rooms; the solvers and elastica_reference import cprbm_scene
only, and the solid, though it lives with the beam elements, is a room of its own; inside comparisons
one module, pairing, imports them; each heavy library has one door in a room, imported there when used.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOMS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
MAY_IMPORT = {
    "cprbm_scene": {"cprbm_scene"},
    "cprbm": {"cprbm", "cprbm_scene"},
    "fea_reference": {"fea_reference", "cprbm_scene"},
    "fea_reference.solid": {"fea_reference.solid", "cprbm_scene"},
    "elastica_reference": {"elastica_reference", "cprbm_scene"},
    "comparisons": {"comparisons", "cprbm_scene"},
}
SOLVERS = {"cprbm", "fea_reference", "fea_reference.solid", "elastica_reference"}
WITHIN = ("fea_reference.solid",)
DOOR_TO_SOLVERS = "comparisons.pairing"
DOOR_TO_TOOLS = "comparisons.workshop"
"""Imports the developers' tools, which stand in ``tests`` and ``benchmarks``, by names from a table."""
HEAVY = ("matplotlib", "pyvista", "gmsh", "meshio", "PIL")
HEAVY_ROOMS = {"skfem": "fea_reference"}
TEST_LIBRARIES = ("pytest", "hypothesis", "tests", "benchmarks")


@dataclass(frozen=True)
class Import:
    """``module`` (dotted, or None for a name made at run time) imported by ``importer`` at ``line``.

    ``late`` says that it stands inside a function, ``typing_only`` that only type checkers see it.
    """

    importer: str
    module: str | None
    line: int
    late: bool
    typing_only: bool

    def __str__(self):
        return f"{self.importer}:{self.line} imports {self.module or 'a name made at run time'}"


def sources(root: Path) -> dict[str, Path]:
    """Dotted module names of the rooms below ``root``, and their files."""
    found = {}
    for room in ROOMS:
        for path in sorted((root / room).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports_of(module: str, path: Path, modules: set[str]) -> list[Import]:
    """Every import in a file: statements, relative ones, ``__import__`` and ``import_module``."""
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]
    return list(_walk(ast.parse(path.read_text(encoding="utf-8")), module, package, modules, False, False))


def _walk(node, importer, package, modules, late, typing_only) -> Iterator[Import]:
    for child in ast.iter_child_nodes(node):
        in_function = late or isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        for name in _named(child, package, modules):
            yield Import(importer, name, child.lineno, late, typing_only)
        if isinstance(child, ast.If) and _is_type_checking(child.test):
            for part, hidden in ((child.body, True), (child.orelse, typing_only)):
                yield from _walk(ast.Module(body=part, type_ignores=[]), importer, package, modules, late, hidden)
        else:
            yield from _walk(child, importer, package, modules, in_function, typing_only)


def _named(node, package, modules) -> list[str | None]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        base = node.module or ""
        if node.level:
            above = package.split(".")[: len(package.split(".")) - node.level + 1]
            base = ".".join([*above, base]).rstrip(".")
        # "from package import module" imports the module, not a name of the package
        return [f"{base}.{alias.name}" if f"{base}.{alias.name}" in modules else base for alias in node.names]
    if isinstance(node, ast.Call):
        called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if called in ("__import__", "import_module"):
            first = node.args[0] if node.args else None
            known = isinstance(first, ast.Constant) and isinstance(first.value, str)
            return [first.value if known else None]
    return []


def _is_type_checking(test) -> bool:
    return getattr(test, "id", getattr(test, "attr", "")) == "TYPE_CHECKING"


def room_of(module: str) -> str:
    """The room of a dotted name; of what is none of ours its first part."""
    inner = (room for room in WITHIN if module == room or module.startswith(room + "."))
    return next(inner, module.split(".")[0])


def violations(root: Path) -> list[str]:
    """A sentence for each import below ``root`` that breaks the law."""
    files = sources(root)
    found = [each for module, path in files.items() for each in imports_of(module, path, set(files))]
    return [*_wrong_rooms(found), *_wrong_doors(found), *_cycles(found, set(files))]


def _wrong_rooms(found) -> Iterator[str]:
    for each in found:
        room = room_of(each.importer)
        if each.module is None:
            if each.importer != DOOR_TO_TOOLS:
                yield f"{each}: nobody can tell whether it may"
            continue
        target = room_of(each.module)
        if target in TEST_LIBRARIES:
            yield f"{each}: tests use the rooms, not the rooms the tests"
        if target not in MAY_IMPORT or target in MAY_IMPORT[room]:
            continue
        if target in SOLVERS and each.importer == DOOR_TO_SOLVERS:
            continue
        yield f"{each}: {room} may not import {target}"


def _wrong_doors(found) -> Iterator[str]:
    doors = {}
    for each in found:
        library = (each.module or "").split(".")[0]
        if library in HEAVY_ROOMS and each.importer.split(".")[0] != HEAVY_ROOMS[library]:
            yield f"{each}: only {HEAVY_ROOMS[library]} may"
        if library not in HEAVY or each.typing_only:
            continue
        if not each.late:
            yield f"{each}: a heavy library is imported inside the function that uses it"
        door = doors.setdefault((room_of(each.importer), library), each.importer)
        if door != each.importer:
            yield f"{each}: its one door is {door}"


def _cycles(found, modules) -> Iterator[str]:
    """Modules that import each other, at any depth; a type checker's import counts as none."""
    below = {module: set() for module in modules}
    for each in found:
        target = each.module
        while target and target not in modules:
            target = target.rpartition(".")[0]
        # a package's own __init__ is loaded before its modules in any case
        if target and target != each.importer and not each.typing_only:
            below[each.importer].add(target)

    def reached(start):
        seen, todo = set(), list(below[start])
        while todo:
            module = todo.pop()
            if module not in seen:
                seen.add(module)
                todo.extend(below[module])
        return seen

    circular = sorted(module for module in modules if module in reached(module))
    if circular:
        yield f"import cycle among {', '.join(circular)}"
