"""What a shell is offered as it completes a command line."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

VARIABLE = "_CPRBM_COMPLETE"
"""Set by the shell that asks, or by whoever asks for the lines that teach a shell to; its name is click's."""


def offered(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """The cases whose names begin so, and files, as far as the argument takes them."""
    from comparisons import cases

    taken = param.metavar or ""
    # a shell looks for files where none of the names fits, and forgets names that stand before that item
    files = [CompletionItem(incomplete, type="file")] if "FILE" in taken else []
    names = (*cases.names(), "all") if "all" in taken else cases.names()
    return [*files, *(CompletionItem(name) for name in names if name.startswith(incomplete))]
