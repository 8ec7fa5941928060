"""The questions that a sub-command is asked by name or file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from comparisons.cli.options import settings

if TYPE_CHECKING:
    from cprbm_scene import Question


def questions(asked: Sequence[str]) -> list[Question]:
    """The questions of built-in cases, files and ``all``, each once.

    Raises:
        SceneError: there is no such case, or a file is no valid question.
        click.UsageError: two of them have one name.
    """
    from comparisons import cases

    names = [name for text in asked for name in (cases.names() if text == "all" else (text,))]
    found = [cases.asked(name, settings()) for name in dict.fromkeys(names)]
    own = [question.name for question in found]
    twice = sorted({name for name in own if own.count(name) > 1})
    if twice:
        raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each.")
    return found
