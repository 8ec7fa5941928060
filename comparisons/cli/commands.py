"""Groups of commands that say which there are where one is asked that there is not."""

from __future__ import annotations

import click


class Commands(click.Group):
    """Commands by their names; one that there is not is refused with those that there are."""

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """The command that the arguments begin with.

        Raises:
            click.UsageError: there is none of that name.
        """
        name = args[0]
        if self.get_command(ctx, name) is None:
            allowed = ", ".join(self.list_commands(ctx))
            ctx.fail(f"found {name!r}, which is no command of '{ctx.command_path}'; allowed: {allowed}")
        return super().resolve_command(ctx, args)
