"""Limits of the numbers in ``limits.toml``, and the comparison of numbers with limits."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path

from tests.ratchets.sizes import Number

FILE = Path(__file__).with_name("limits.toml")
NAMES = {
    "pronouns": "% pronouns in docstrings and comments",
    "long-functions": "functions above 60 lines",
    "complex-functions": "functions of complexity above 15",
    "long-modules": "modules above 400 lines",
    "statements": "statements",
}
"""Names of the numbers in messages."""

HEAD = """\
# Limits of `make ratchets`. A limit never rises: `python -m tests.ratchets --lower` writes lower limits only.
# The limit of pronouns is a percentage of the words in docstrings and comments; the other limits are counts.
"""

Sizes = Mapping[str, Mapping[str, Number]]
"""Numbers by package and name."""


def read(path: Path = FILE) -> Sizes:
    """The limits in a file."""
    return tomllib.loads(path.read_text(encoding="utf-8"))


def write(limits: Sizes, path: Path = FILE) -> None:
    """Write limits to a file."""
    parts = [HEAD, *(f"\n[{package}]\n{_lines(numbers)}" for package, numbers in limits.items())]
    path.write_text("".join(parts), encoding="utf-8")


def _lines(numbers: Mapping[str, Number]) -> str:
    return "".join(f"{name} = {number}\n" for name, number in numbers.items())


def lowered(limits: Sizes, current: Sizes) -> Sizes:
    """The limits, lowered to the current numbers where the current numbers are below."""
    return {
        package: {name: min(limit, current[package][name]) for name, limit in numbers.items()}
        for package, numbers in limits.items()
    }


def departures(limits: Sizes, current: Sizes) -> Iterator[str]:
    """A sentence for every number above or below the limit."""
    for package, numbers in limits.items():
        for name, limit in numbers.items():
            number = current[package][name]
            found = f"{package}: {number} {NAMES[name]}, limit {limit}. "
            if number > limit:
                yield found + "The number may only fall: simplify the change, or another part of the package."
            elif number < limit:
                yield found + "Run `python -m tests.ratchets --lower` in the same commit."
