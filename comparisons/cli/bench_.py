"""``cprbm bench``: run time against error, both solvers beside the optimisers that a user would take instead."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons import workshop
from comparisons.choices import KINEMATICS, Kinematics
from comparisons.cli.completing import offered
from comparisons.cli.options import count, counts, folder, output, parameters, settings, timed

if TYPE_CHECKING:
    from comparisons.bench.contenders import Contender
    from comparisons.bench.errors import Reference
    from comparisons.bench.running import Clock, Session
    from comparisons.documents import Plain

NOT_COMPLETED = 1
OURS = ("auto", "paper", "fea")
PEERS = ("slsqp", "ipopt") if workshop.is_checkout() else ()
"""Optimisers on the same problem, which are developers' tools."""


class _Method(click.Choice[str]):
    """A method by its name; a sentence refuses a method of the checkout in a wheel, and a removed method."""

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The method.

        Raises:
            click.ClickException: the method is a developers' tool and this is no checkout, or the method is removed.
            click.BadParameter: no method has this name.
        """
        if absence := workshop.absence(_tool(value)):
            raise click.ClickException(absence)
        return super().convert(value, param, ctx)


def _tool(name: str) -> str:
    return f"bench --method {name}"


def _named(ctx: click.Context, param: click.Parameter, value: tuple[str, ...]) -> tuple[int | dict[str, int], ...]:
    """Every ``-n`` as one size.

    Raises:
        click.BadParameter: one is no number of links.
    """
    return tuple(count(ctx, param, one) for one in value)


@click.command("bench")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=offered)
@parameters
@click.option(
    "--sizes",
    callback=counts,
    metavar="N,N,...",
    help="Links and elements per beam; unless given 10, 20, 40 and so on doubled, up to 5120 links in auto, 640 in "
    "paper and 1280 elements; in a checkout 160 links for ipopt and 80 for slsqp.",
)
@click.option(
    "-n",
    "links",
    multiple=True,
    callback=_named,
    metavar="COUNT",
    help="One size, as 40 or as beam1=30,beam2=40; may be repeated, in the place of --sizes.",
)
@click.option(
    "--method",
    "methods",
    multiple=True,
    type=_Method([*OURS, *PEERS]),
    help="Who takes part; may be repeated. Unless given all that the scene offers. auto and paper are the CPRBM's.",
)
@click.option(
    "--stations",
    type=click.Choice(["last", "all"]),
    default="last",
    show_default=True,
    help="'last': each stage's last station alone, gone to at once, and no probes but those that errors are told by. "
    "'all': the scene as it stands, without the peers, which know one station.",
)
@timed(
    "How often each size is solved.",
    "is the last of its method, and a peer's is ended then; sizes that together take longer are not repeated.",
    "30",
)
@click.option(
    "--clock",
    type=click.Choice(["wall", "cpu"]),
    default="wall",
    show_default=True,
    help="Seconds that pass, or those of the processor, for a machine that has other work.",
)
@click.option(
    "--kinematics",
    type=click.Choice(KINEMATICS),
    default="bending",
    show_default=True,
    help="Beam theory of the finite elements; 'bending' is the CPRBM's own, and that of the errors.",
)
@output
@folder("Folder for the numbers and the figures.")
@click.pass_obj
def command(
    planted: object,
    case: str,
    sizes: tuple[int, ...] | None,
    links: tuple[int | dict[str, int], ...],
    methods: tuple[str, ...],
    stations: Literal["last", "all"],
    repeat: int,
    at_most: float,
    clock: Clock,
    kinematics: Kinematics,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Time the solvers, and optimisers on the same problem, on one scene at growing numbers of links and elements.

    Exit code 1 says that a run of the project's own solvers did not complete; what a peer does is told in the tables.
    """
    from comparisons import cases, machine
    from comparisons.bench import contenders, errors, question, running, told
    from comparisons.choices import Choices, check
    from comparisons.cli import showing
    from comparisons.pairing import solvers_of
    from cprbm_scene.frozendict import frozendict

    if sizes is not None and links:
        raise click.UsageError("found --sizes and -n; allowed: one of them.")
    whole = stations == "all"
    opened = cases.opened(case, settings())
    named = tuple(one if isinstance(one, int) else frozendict(one) for one in links) or (sizes or ())
    for one in named:
        check(Choices(links=one), opened)
    scene = opened if whole else question.asked(opened)
    solvers = solvers_of(planted)
    every = (
        *contenders.contenders(solvers, Choices(kinematics=kinematics)),
        *(_peer(name) for name in PEERS if not methods or name in methods),
    )
    asked = [one for one in every if not methods or one.name in methods]
    absent = frozendict({one.name: why for one in asked if (why := _why_not(one, whole=whole))})
    taking = tuple(one for one in asked if one.name not in absent)
    if not taking:
        raise click.UsageError("Nobody is left: " + "; ".join(f"{name}: {why}" for name, why in absent.items()) + ".")
    plan = running.Plan(
        frozendict({one.name: running.sizes_of(one, named) for one in taking}),
        kinematics,
        repeat,
        at_most,
        whole,
        clock,
    )
    session = running.Session(scene, plan, taking, machine.described(), running.CLOCKS[clock], absent=absent)
    showing.room_for(json_file, out)
    with showing.current(shown=not quiet) as say:
        say("the reference of the errors")
        known = errors.reference(question.asked(opened), solvers)
    try:
        for job in showing.progress(session.jobs(), shown=not quiet):
            session.do(job)
            if session.seconds:
                _written(told.document(session.done(known)), json_file, out, scene.name)
    except KeyboardInterrupt:
        if session.seconds:
            _shown(session, known, json_file, out, quiet=quiet)
        raise
    return _shown(session, known, json_file, out, quiet=quiet)


def _shown(session: Session, known: Reference, json_file: Path | None, out: Path | None, *, quiet: bool) -> int:
    """Write and print what is done; the exit code.

    Raises:
        SceneError: every method has refused the question.
        OSError: something cannot be written.
    """
    from comparisons.bench import drawn, told
    from comparisons.cli import showing
    from comparisons.writing import write

    done = session.done(known)
    data = told.document(done)
    _written(data, json_file, out, done.scene.name)
    if json_file is not None and str(json_file) == "-":
        showing.json(json_file, data)
    if out is not None:
        for picture in drawn.pictures(done):
            write(out / done.scene.name / f"{picture.name}.svg", picture.svg)
            write(out / done.scene.name / f"{picture.name}.png", picture.png)
    if str(json_file) != "-" and not quiet:
        showing.tables(told.sheets(done))
    failed = [one for one in done.timings if one.contender.name in OURS and not one.outcome.completed]
    for one in failed:
        who = f"{one.contender.label} at N = {told.sized(one.count)}"
        click.echo(f"cprbm: {done.scene.name}: {who}: {one.outcome.why}", err=True)
    return NOT_COMPLETED if failed else 0


def _written(data: Plain, json_file: Path | None, out: Path | None, name: str) -> None:
    """Put the numbers into their files, as many as there are.

    Raises:
        OSError: one cannot be written.
    """
    from comparisons import documents
    from comparisons.cli import showing
    from comparisons.writing import write

    if json_file is not None and str(json_file) != "-":
        showing.json(json_file, data)
    if out is not None:
        write(out / name / "bench.json", documents.text(data))


def _peer(name: str) -> Contender:
    found: Contender = workshop.load(_tool(name)).contender()
    return found


def _why_not(contender: Contender, *, whole: bool) -> str:
    """Why a method cannot take part; empty if it can."""
    if whole and contender.is_peer:
        return "an optimiser of one minimum knows the last station alone"
    return contender.absence
