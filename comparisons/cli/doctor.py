"""``cprbm list`` and ``doctor``: built-in cases, and libraries with commands for installation."""

from __future__ import annotations

import platform

import click

from comparisons import cases
from comparisons.cli.errors import INCOMPLETE
from comparisons.starting import libraries


def list_cases() -> None:
    """Print name, title and source of every built-in case."""
    for name, title, source in cases.described():
        click.echo(f"{name:<16} {title}" + (f" ({source})" if source else ""))


def doctor(quiet: bool) -> int:  # noqa: FBT001 - click passes a keyword
    """Print the state of all libraries; exit code 1 without a required library."""
    if not quiet:
        click.echo(f"Python {platform.python_version()}")
    there, missing, required = list[str](), list[str](), False
    for state in libraries.states():
        lacking = not (state.there or state.library.extra)
        required |= lacking
        (there if state.there else missing).append(state.library.name)
        if lacking or not quiet:
            click.echo(f"{state.library.name:<14} {state.text}")
    if not quiet:
        if "pyvista" in there:
            click.echo(f"{'drawing':<14} {_drawing_text()}")
        summary = f"Answers, verdicts and reports work; {', '.join(missing)}: only for the purpose beside the name."
        if required:
            summary = "A required library is missing; install the library with the command above."
        click.echo(summary if missing else "All libraries are installed.")
    return INCOMPLETE if required else 0


def _drawing_text() -> str:
    """Whether PyVista draws here."""
    from comparisons.present.space import tried  # NumPy may be missing

    trouble = tried()
    remedy = f"{'impossible':<12} ({trouble}); on Debian and Ubuntu install, as root: {libraries.WHAT_DRAWS}"
    return remedy if trouble else f"{'works':<12} for pictures in space by 'view'"
