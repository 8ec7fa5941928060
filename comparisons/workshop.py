"""Door to the developers' tools, which a checkout of the repository holds and the wheel does not.

The tools stand in ``tests`` and ``benchmarks``.  A tool's module is imported by its name, and only when the user asks
for the tool.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).resolve().parents[1]
"""Folder above this package: the checkout, or the folder of installed packages."""

FOLDERS = ("tests/robustness", "benchmarks")


@dataclass(frozen=True, slots=True)
class Tool:
    """A developers' tool.

    Attributes:
        module: its name.
        purpose: as the list of commands states it.
        new_name: the command that takes the place of this old one; empty if this is no old one.
    """

    module: str
    purpose: str = ""
    new_name: str = ""


TOOLS = {
    "robustness": Tool(
        "tests.robustness.command",
        "Judge both solvers on random scenes.",
    ),
    "stress": Tool("tests.robustness.command", new_name="robustness"),
    "study relations": Tool(
        "tests.relations.command",
        "Compare a scene with its moved, mirrored, reordered and scaled images.",
    ),
    "bench --method slsqp": Tool("benchmarks.peers.slsqp"),
    "bench --method ipopt": Tool("benchmarks.peers.ipopt"),
}
"""The tools by their commands, without the name of the program."""

REMOVED = {
    "regress": "'python -m tests.baseline' of a checkout records and compares the numbers (CONTRIBUTING.md).",
    "study readings": "no reading of section 3.4 jumps where the paper says (the page 'Where a branch ends').",
    "study materials": "within bending no error depends on the modulus (the page 'The paper’s claims').",
    "bench --method trust-constr": "13 times the time of the CPRBM (the page 'Decisions').",
}
"""Commands without a successor, with the reason and the page that keeps their results."""


def is_checkout() -> bool:
    """True if this package stands in a checkout, beside the tools' folders."""
    return all((ROOT / folder).is_dir() for folder in FOLDERS)


def absence(command: str) -> str:
    """The sentence that says why a tool or a removed command cannot run here; empty for every other command."""
    if command in TOOLS and not is_checkout():
        where = "it runs in a checkout of the repository, not from an installed package"
        return f"'cprbm {command}' is a developers' tool: {where}."
    return f"'cprbm {command}' is removed: {REMOVED[command]}" if command in REMOVED else ""


def load(command: str) -> ModuleType:
    """The module of a tool, from this checkout whatever the current folder holds."""
    if sys.path[0] != str(ROOT):
        sys.path.insert(0, str(ROOT))  # processes that share the work take this path over
    return import_module(TOOLS[command].module)
