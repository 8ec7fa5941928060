"""Groups of commands with developers' tools outside the wheel; an unknown name gets a list of the known names."""

from __future__ import annotations

from difflib import get_close_matches

import click

from comparisons import workshop


class ToolCommand(click.Command):
    """Placeholder of a developers' tool in a list of commands: a list imports no tool.

    Attributes:
        tool: the tool's command, without the name of the program.
    """

    def __init__(self, tool: str) -> None:
        super().__init__(tool.rpartition(" ")[2], help=workshop.TOOLS[tool].purpose)
        self.tool = tool

    def loaded(self) -> click.Command:
        """The command of the tool; for an old name standard error states the new name."""
        new_name = workshop.TOOLS[self.tool].new_name
        if new_name:
            click.echo(
                f"cprbm: 'cprbm {self.tool}' is now 'cprbm {new_name}'; the next release drops the old name.", err=True
            )
        found: click.Command = workshop.load(self.tool).command
        return found


class Commands(click.Group):
    """Commands by name; the message for an unknown name lists the known names."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command at the start of the arguments.

        Raises:
            click.ClickException: the command is a developers' tool and this is no checkout, or the command is removed.
            click.UsageError: no command has this name.
        """
        name = args[0]
        path = f"{ctx.command_path} {name}".partition(" ")[2]
        if absence := workshop.absence(path):
            raise click.ClickException(absence)
        if self.get_command(ctx, name) is None:
            known = self.list_commands(ctx)
            near = get_close_matches(name.casefold(), known, n=1)
            meant = f" (is {near[0]!r} meant?)" if near else ""
            ctx.fail(f"found {name!r}, no command of '{ctx.command_path}'{meant}; allowed: {', '.join(known)}")
        _, command, rest = super().resolve_command(ctx, args)
        return name, command.loaded() if isinstance(command, ToolCommand) else command, rest
