"""Groups of commands that say which there are where one is asked that there is not."""

from __future__ import annotations

from difflib import get_close_matches

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
            known = self.list_commands(ctx)
            near = get_close_matches(name.casefold(), known, n=1)
            meant = f" (is {near[0]!r} meant?)" if near else ""
            said = f"found {name!r}, which is no command of '{ctx.command_path}'{meant}; allowed: {', '.join(known)}"
            ctx.fail(said)
        return super().resolve_command(ctx, args)
