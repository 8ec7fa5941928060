"""Completion of command lines in a shell."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

VARIABLE = "_CPRBM_COMPLETE"
"""Environment variable of click: a shell sets the variable to ask for completions or for the set-up lines."""


def candidates(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Names of cases with the beginning ``incomplete``, and files, if the argument accepts files."""
    from comparisons import cases

    accepted = param.metavar or ""
    # a shell looks for files if no name fits, and drops names in front of this item
    files = [CompletionItem(incomplete, type="file")] if "FILE" in accepted else []
    names = (*cases.names(), "all") if "all" in accepted else cases.names()
    return [*files, *(CompletionItem(name) for name in names if name.startswith(incomplete))]
