"""``cprbm doctor``: what is there, what is missing, and what installs it."""

from __future__ import annotations

import click

INCOMPLETE = 1


@click.command("doctor")
@click.option("-q", "--quiet", is_flag=True, help="Only what is needed and cannot be used.")
def command(quiet: bool) -> int:  # noqa: FBT001 - click hands it over by name
    """Say which libraries are there and which are missing, with the line that installs each.

    Then stands whether processes can share the work and, with PyVista, whether pictures in space can be drawn, which
    both ask something of the system; the last line sums up.
    Exit code 1 says that something is missing without which nothing works.
    """
    import platform

    from comparisons.processes import trouble as trouble_beside
    from comparisons.starting.present import looked_for
    from comparisons.starting.system import WHAT_DRAWS, line_for

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
            anew = f"install it anew: {library.line} --force-reinstall"
            said += f"; on Debian and Ubuntu install what it wants, as root: {line}" if line else f"; {anew}"
        else:
            said = f"{'missing':<12} for {library.needed_for}; install it: {library.line}"
        if not state.there and library.extra:
            left.append(library.name)
        whole &= state.there or bool(library.extra)
        drawing |= state.there and library.name == "pyvista"
        if not quiet or not (state.there or library.extra):
            click.echo(f"{library.name:<14} {said}")
    if quiet:
        return 0 if whole else INCOMPLETE
    alone = trouble_beside()
    said = f"{'one':<12} does all of the work: {alone}" if alone else f"{'several':<12} can share the work"
    click.echo(f"{'processes':<14} {said}")
    if drawing and not alone:
        from comparisons.viewing.space import tried

        trouble = tried()
        said = "works        for pictures in space by 'view'"
        if trouble:
            said = f"{'impossible':<12} ({trouble}); on Debian and Ubuntu install what draws, as root: {WHAT_DRAWS}"
        click.echo(f"{'drawing':<14} {said}")
    click.echo(
        _in_sum(left) if whole else "Without what is missing above nothing works; the lines beside it install it."
    )
    return 0 if whole else INCOMPLETE


def _in_sum(left: list[str]) -> str:
    """What the whole says to somebody who wants to begin."""
    if not left:
        return "Everything is there."
    names = ", ".join(left)
    return f"All is there that answers, verdicts and reports need; {names}: only for what stands beside the name."
