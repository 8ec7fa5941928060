"""Promises of the command line: commands, arguments, options, choices and defaults, from click's own records."""

from collections.abc import Iterable, Iterator

import click

from .promises import Promises

PROGRAM = "cprbm"
HELP = frozenset({"-h", "--help"})


def commands_of(
    group: click.Group, further: Iterable[str] = (), path: tuple[str, ...] = (PROGRAM,)
) -> Iterator[tuple[str, click.Command]]:
    """Every command of a group with the full name, the group itself first.

    Args:
        group: where the walk begins.
        further: full names of further commands to look for: an alias may be hidden.
        path: words of the group's own full name.
    """
    yield " ".join(path), group
    context = click.Context(group)
    hidden = [words[len(path)] for name in further if (words := name.split())[: len(path)] == list(path) != words]
    for name in sorted({*group.list_commands(context), *hidden}):
        try:
            _, command, _ = group.resolve_command(context, [name])
        except click.ClickException:  # no command of this name, or a removed one
            continue
        if isinstance(command, click.Group):
            yield from commands_of(command, further, (*path, name))
        elif command is not None:
            yield " ".join((*path, name)), command


def promised_by(name: str, command: click.Command) -> Promises:
    """The promises of a command under the full name."""
    promises: Promises = {name: "group" if isinstance(command, click.Group) else "command"}
    demands: list[str] = []
    place = 0
    for parameter in command.params:
        if isinstance(parameter, click.Option):
            spelled = max(parameter.opts, key=len)
            for spelling in (*parameter.opts, *parameter.secondary_opts):
                promises[f"{name} option {spelling}"] = _form(parameter)
        else:
            place += 1
            spelled = f"argument {place}"
            promises[f"{name} {spelled}"] = "several" if parameter.nargs == -1 else "one"
        if parameter.required:
            demands.append(spelled)
        if isinstance(parameter.type, click.Choice):
            promises |= {f"{name} choice {spelled} {choice}": "" for choice in parameter.type.choices}
        default = parameter.to_info_dict()["default"] if isinstance(parameter, click.Option) else None
        for spelling in parameter.opts:  # a further spelling must not hide the promise of the first
            if isinstance(default, str | int | float) and not isinstance(default, bool):
                promises[f"{name} default {spelling}"] = str(default)
            elif hasattr(default, "__fspath__"):
                promises[f"{name} default {spelling}"] = default.__fspath__()
    promises[f"{name} requires"] = sorted(demands)
    return promises


def _form(option: click.Option) -> str:
    """How an option is written: with a value, without, or several times."""
    if option.is_flag:
        return "flag"
    return "values, repeated" if option.multiple else "value"
