"""``cprbm doctor``: installed and missing libraries, with commands for installation."""

from __future__ import annotations

import platform

import click

from comparisons.cli.errors import INCOMPLETE
from comparisons.starting import present
from comparisons.starting.present import WHAT_DRAWS, line_for


def doctor(quiet: bool) -> int:  # noqa: FBT001 - click passes a keyword
    """Print the state of all libraries; exit code 1 without a required library."""
    if not quiet:
        click.echo(f"Python {platform.python_version()}")
    states = []
    for state in present.looked_for():
        states.append(state)
        if not quiet or not (state.there or state.library.extra):
            click.echo(f"{state.library.name:<14} {_state_text(state)}")
    complete = all(state.there or state.library.extra for state in states)
    if quiet:
        return 0 if complete else INCOMPLETE
    if any(state.there and state.library.name == "pyvista" for state in states):
        click.echo(f"{'drawing':<14} {_drawing_text()}")
    missing = ", ".join(state.library.name for state in states if not state.there)
    summary = f"Answers, verdicts and reports work; {missing}: only for the purpose beside the name."
    if not complete:
        summary = "A required library is missing; install the library with the command above."
    click.echo(summary if missing else "All libraries are installed.")
    return 0 if complete else INCOMPLETE


def _state_text(state: present.State) -> str:
    """Version and purpose of a library, and the command that installs the library if needed."""
    library = state.library
    if state.there:
        return f"{state.version:<12} for {library.needed_for}"
    if not state.version:
        return f"{'missing':<12} for {library.needed_for}; install: {library.line}"
    line = line_for(library.name, state.trouble)
    remedy = f"on Debian and Ubuntu install its system libraries, as root: {line}" if line else (
        f"install the library again: {library.line} --force-reinstall"
    )  # fmt: skip
    return f"{state.version:<12} cannot be imported ({state.trouble}); for {library.needed_for}; {remedy}"


def _drawing_text() -> str:
    """Whether PyVista draws here."""
    from comparisons.present.space import tried  # NumPy may be missing

    trouble = tried()
    if not trouble:
        return "works        for pictures in space by 'view'"
    return f"{'impossible':<12} ({trouble}); on Debian and Ubuntu install, as root: {WHAT_DRAWS}"
