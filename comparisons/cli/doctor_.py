"""``cprbm doctor``: installed and missing libraries, with commands for installation."""

from __future__ import annotations

import click

INCOMPLETE = 1


@click.command("doctor")
@click.option("-q", "--quiet", is_flag=True, help="Print only required libraries that cannot be used.")
def command(quiet: bool) -> int:  # noqa: FBT001 - click passes a keyword
    """List installed and missing libraries.

    A missing library stands with the command that installs it.

    Two further lines state whether worker processes can run, and whether PyVista can draw. The last line sums up.
    Exit code 1 means a missing required library.
    """
    import platform

    from comparisons.executor import obstacle
    from comparisons.starting.present import WHAT_DRAWS, line_for, looked_for

    if not quiet:
        click.echo(f"Python {platform.python_version()}")
    whole, drawing, left = True, False, []
    for state in looked_for():
        library = state.library
        if state.there:
            said = f"{state.version:<12} for {library.needed_for}"
        elif state.version:
            said = f"{state.version:<12} cannot be imported ({state.trouble}); for {library.needed_for}"
            line = line_for(library.name, state.trouble)
            anew = f"install the library again: {library.line} --force-reinstall"
            said += f"; on Debian and Ubuntu install its system libraries, as root: {line}" if line else f"; {anew}"
        else:
            said = f"{'missing':<12} for {library.needed_for}; install: {library.line}"
        if not state.there and library.extra:
            left.append(library.name)
        whole &= state.there or bool(library.extra)
        drawing |= state.there and library.name == "pyvista"
        if not quiet or not (state.there or library.extra):
            click.echo(f"{library.name:<14} {said}")
    if quiet:
        return 0 if whole else INCOMPLETE
    alone = obstacle()
    said = f"{'single':<12} process for all work: {alone}" if alone else f"{'several':<12} can share the work"
    click.echo(f"{'processes':<14} {said}")
    if drawing and not alone:
        from comparisons.present.space import tried

        trouble = tried()
        said = "works        for pictures in space by 'view'"
        if trouble:
            said = f"{'impossible':<12} ({trouble}); on Debian and Ubuntu install, as root: {WHAT_DRAWS}"
        click.echo(f"{'drawing':<14} {said}")
    click.echo(_in_sum(left) if whole else "A required library is missing; install the library with the command above.")
    return 0 if whole else INCOMPLETE


def _in_sum(left: list[str]) -> str:
    """Summary for a new user."""
    if not left:
        return "All libraries are installed."
    return f"Answers, verdicts and reports work; {', '.join(left)}: only for the purpose beside the name."
