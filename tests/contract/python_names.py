"""Promises of the library: public names, parameters of functions, fields and methods of records."""

import dataclasses
import importlib
import inspect
import re
from collections.abc import Iterator
from enum import Enum
from pathlib import Path
from types import ModuleType
from typing import is_typeddict

from .promises import Promises

_DIRECTIVE = re.compile(r"^\.\. (auto\w+):: (\S+)((?:\n +:.*)*)", re.MULTILINE)


def documented(pages: Path) -> set[str]:
    """Full names in the directives of the library's pages."""
    names: set[str] = set()
    for page in sorted(pages.glob("*.md")):
        for directive, target, options in _DIRECTIVE.findall(page.read_text("utf-8")):
            if directive != "automodule":
                names.add(target)
                continue
            module = importlib.import_module(target)
            chosen = re.search(r":members:(.*)", options)
            listed = [name.strip() for name in chosen[1].split(",") if name.strip()] if chosen else []
            left_out = re.search(r":exclude-members:(.*)", options)
            without = {name.strip() for name in left_out[1].split(",")} if left_out else set()
            names |= {f"{target}.{name}" for name in (listed or _own(module)) if name not in without}
    return names


def _own(module: ModuleType) -> list[str]:
    """Public names of a module: the names in ``__all__``, or else the module's own definitions."""
    if hasattr(module, "__all__"):
        return list(module.__all__)
    found = vars(module).items()
    return [name for name, value in found if name[0] != "_" and getattr(value, "__module__", "") == module.__name__]


def exported(package: str) -> Promises:
    """The names in ``__all__`` of a package; none of a missing package."""
    try:
        names = importlib.import_module(package).__all__
    except ImportError:
        return {}
    return {f"python {package} exports {name}": "" for name in names}


def promised_by_name(full: str) -> Promises:
    """The promises of a public name; none of a missing name."""
    module, _, name = full.rpartition(".")
    try:
        value = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError):
        return {}
    item = f"python {full}"
    if inspect.isclass(value):
        return {item: "class", **dict(_of_class(item, value))}
    if inspect.isroutine(value):
        return {item: "function", **dict(_of_call(item, value))}
    return {item: "name"}


def _of_class(item: str, kind: type) -> Iterator[tuple[str, str | list[str]]]:
    if issubclass(kind, Enum):
        yield from ((f"{item} member {member.name}", "") for member in kind)
        return
    required: list[str] = []
    if is_typeddict(kind):
        fields = list(kind.__annotations__)
    elif dataclasses.is_dataclass(kind):
        of_class = [field for field in dataclasses.fields(kind) if not field.name.startswith("_")]
        fields = [field.name for field in of_class]
        empty = dataclasses.MISSING
        required = [each.name for each in of_class if each.default is empty and each.default_factory is empty]
    elif issubclass(kind, tuple) and hasattr(kind, "_fields"):
        fields = list(kind._fields)
        required = [name for name in fields if name not in kind._field_defaults]
    else:
        models = getattr(kind, "model_fields", {})
        fields = list(models)
        required = [name for name, field in models.items() if field.is_required()]
    for field in fields:
        yield f"{item} field {field}", ""
    if not item.startswith("python comparisons."):
        yield f"{item} requires", sorted(required)  # records of the harness are results, and users make none
    package = kind.__module__.partition(".")[0]
    bases = [base for base in kind.__mro__ if base.__module__.partition(".")[0] == package]
    for name, value in {name: value for base in bases[::-1] for name, value in vars(base).items()}.items():
        if name.startswith(("_", "model_")) or name in fields:
            continue
        if isinstance(value, property):
            yield f"{item} field {name}", ""
        elif inspect.isfunction(value):
            yield f"{item} method {name}", ""


def _of_call(item: str, function: object) -> Iterator[tuple[str, str | list[str]]]:
    required = []
    assert callable(function)
    for place, parameter in enumerate(inspect.signature(function).parameters.values(), start=1):
        by_name = parameter.kind is parameter.KEYWORD_ONLY
        several = parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD)
        form = "by name" if by_name else "any number" if several else f"place {place}"
        yield f"{item} parameter {parameter.name}", form
        if parameter.default is parameter.empty and not several:
            required.append(parameter.name)
    yield f"{item} requires", sorted(required)
