"""Questions of a command line: built-in cases, files and ``all``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from comparisons.cli.options import settings
from comparisons.cli.text import printable

if TYPE_CHECKING:
    from cprbm_scene import Question


def read_questions(arguments: Sequence[str]) -> list[Question]:
    """Questions of the arguments, without repetition; notes on implausible numbers go to standard error.

    Raises:
        SceneError: a case does not exist, or a file is no valid question.
        click.UsageError: two questions have the same name.
    """
    from comparisons import cases
    from cprbm_scene import Scene
    from cprbm_scene.plausibility import notes

    names = [name for text in arguments for name in (cases.names() if text == "all" else (text,))]
    questions = [cases.asked(name, settings()) for name in dict.fromkeys(names)]
    for question in questions:
        for note in notes(question) if isinstance(question, Scene) else ():
            click.echo(printable(f"Note: {question.file}: {note}"), err=True)
    own = [question.name for question in questions]
    twice = sorted({name for name in own if own.count(name) > 1})
    if twice:
        raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each scene.")
    return questions
