"""Questions and solvers of a request, and the folders of its files."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import click

from comparisons import cases
from comparisons.choices import check
from comparisons.cli.errors import printable
from comparisons.cli.output import make_room
from comparisons.cli.request import Request
from comparisons.pairing import Solvers, solvers_of, with_solid
from cprbm_scene import Question, Scene
from cprbm_scene.plausibility import notes


def scene_of(request: Request) -> Scene:
    """The scene of a command for a single scene; notes on implausible numbers go to standard error.

    Raises:
        SceneError: the case does not exist, the file is no valid scene, or the choices do not fit the scene.
    """
    return _checked(cases.opened(request.case, request.values), request)


def _checked(scene: Scene, request: Request) -> Scene:
    """The scene after notes on implausible numbers to standard error.

    Raises:
        SceneError: the choices do not fit the scene.
    """
    for note in notes(scene):
        click.echo(printable(f"Note: {scene.file}: {note}"), err=True)
    check(request.choices, scene)
    return scene


def questions_of(request: Request) -> list[Question]:
    """Questions of the arguments, without repetition; notes on implausible numbers go to standard error.

    Raises:
        SceneError: a case does not exist, a file is no valid question, or the choices do not fit a scene.
        click.UsageError: two questions have the same name.
    """
    names = [name for text in request.arguments for name in (cases.names() if text == "all" else (text,))]
    questions = [cases.asked(name, request.values) for name in dict.fromkeys(names)]
    twice = sorted(name for name, number in Counter(question.name for question in questions).items() if number > 1)
    if twice:
        raise click.UsageError(f"Several scenes have the name {', '.join(twice)}; allowed: a name for each scene.")
    for scene in questions:
        if isinstance(scene, Scene):
            _checked(scene, request)
    return questions


def solvers_for(request: Request) -> Solvers:
    """The solvers of a comparison."""
    found = solvers_of(request.planted, exact=request.exact)
    return with_solid(found) if "solid" in request.opinions else found


def with_room(request: Request, folder: str = "") -> Request:
    """The request with its folders made; without ``--out`` the report goes to ``folder``, or nowhere if empty.

    Raises:
        OSError: a folder cannot be created.
    """
    out = request.out or (Path(folder) if folder else None)
    make_room(request.json_file, request.csv_file, request.plot_file, out=out)
    return replace(request, out=out)
