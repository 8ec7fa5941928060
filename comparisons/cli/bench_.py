"""``cprbm bench``: run time against error, both solvers beside general optimisers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons import workshop
from comparisons.choices import KINEMATICS, Kinematics
from comparisons.cli.completion import candidates
from comparisons.cli.options import COUNT, count, counts, folder, output_options, parameters, settings, timed
from comparisons.cli.section_output import SectionOutput, run_steps

if TYPE_CHECKING:
    from comparisons.bench.contenders import Contender
    from comparisons.bench.running import Clock

NOT_COMPLETED = 1
OURS = ("auto", "paper", "fea")
PEERS = ("slsqp", "ipopt") if workshop.is_checkout() else ()
"""Optimisers on the same problem: developers' tools."""


class _Method(click.Choice[str]):
    """Name of a method; removed methods, and methods of the checkout in a wheel, are refused with a sentence."""

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


def _sizes(ctx: click.Context, param: click.Parameter, value: tuple[str, ...]) -> tuple[int | dict[str, int], ...]:
    """A size for every ``-n``.

    Raises:
        click.BadParameter: a value is no number of links.
    """
    return tuple(count(ctx, param, text) for text in value)


@click.command("bench")
@click.argument("case", metavar="CASE|FILE.toml", shell_complete=candidates)
@parameters
@click.option(
    "--sizes",
    callback=counts,
    metavar="N,N,...",
    help="Links and elements per beam.  [default: 10, 20, 40 and further doublings, up to 5120 links in auto, 640 in "
    "paper and 1280 elements; in a checkout 160 links for ipopt and 80 for slsqp]",
)
@click.option(
    "-n",
    "--links",
    "links",
    multiple=True,
    callback=_sizes,
    metavar=COUNT,
    help="Links per beam, as 40 or as beam1=30,beam2=40; may be repeated, in place of --sizes.",
)
@click.option(
    "--method",
    "methods",
    multiple=True,
    type=_Method([*OURS, *PEERS]),
    help="Method to time; may be repeated. auto and paper belong to the CPRBM.  [default: all for the scene]",
)
@click.option(
    "--stations",
    type=click.Choice(["last", "all"]),
    default="last",
    show_default=True,
    help="'last': only the last station of every stage, in a single step, with the probes of the errors. "
    "'all': the whole scene, without the optimisers.",
)
@timed(
    "Repetitions of every size.",
    "is the last of its method; an optimiser is stopped then. Sizes with a longer sum are not repeated.",
    "30",
)
@click.option(
    "--clock",
    type=click.Choice(["wall", "cpu"]),
    default="wall",
    show_default=True,
    help="Elapsed seconds, or processor seconds for a machine with other work.",
)
@click.option(
    "--kinematics",
    type=click.Choice(KINEMATICS),
    default="bending",
    show_default=True,
    help="Beam theory of the finite elements; 'bending' is the theory of the CPRBM and of the errors.",
)
@output_options
@folder("Folder for numbers and figures.")
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
    quiet: bool,  # noqa: FBT001 - click passes a keyword
    out: Path | None,
) -> int:
    """Time solvers and optimisers against their errors.

    The numbers of links and elements grow.
    Exit code 1 means an incomplete run of a solver of this project.
    """
    from comparisons import cases, provenance
    from comparisons.bench import contenders, measures, running
    from comparisons.bench.section import bench_section
    from comparisons.bench.tables import sized
    from comparisons.choices import Choices, check
    from comparisons.cli import output
    from comparisons.pairing import solvers_of
    from comparisons.present.page import own_folder
    from cprbm_scene.frozendict import frozendict

    if sizes is not None and links:
        raise click.UsageError("found --sizes and -n; allowed: one of them.")
    whole = stations == "all"
    opened = cases.opened(case, settings())
    named = tuple(one if isinstance(one, int) else frozendict(one) for one in links) or (sizes or ())
    for one in named:
        check(Choices(links=one), opened)
    scene = opened if whole else measures.asked(opened)
    solvers = solvers_of(planted)
    every = (
        *contenders.contenders(solvers, Choices(kinematics=kinematics)),
        *(_peer(name) for name in PEERS if not methods or name in methods),
    )
    asked = [one for one in every if not methods or one.name in methods]
    absent = frozendict({one.name: why for one in asked if (why := _why_not(one, whole=whole))})
    taking = tuple(one for one in asked if one.name not in absent)
    if not taking:
        raise click.UsageError(
            "No method is left: " + "; ".join(f"{name}: {why}" for name, why in absent.items()) + "."
        )
    plan = running.Plan(
        frozendict({one.name: running.sizes_of(one, named) for one in taking}),
        kinematics,
        repeat,
        at_most,
        whole,
        clock,
    )
    output.room_for(json_file, out)
    with output.current(shown=not quiet) as say:
        say("reference of the errors")
        known = measures.reference(measures.asked(opened), solvers)
    session = running.Session(scene, plan, taking, provenance.machine(), running.CLOCKS[clock], known, absent)
    show = SectionOutput(json_file, None if out is None else own_folder(out, scene.name), quiet)
    jobs = output.progress(session.jobs(), shown=not quiet)
    run_steps(session, jobs, running.Session.do, bench_section, show)
    failed = [row for row in session.rows() if row.contender.name in OURS and not row.outcome.completed]
    for row in failed:
        who = f"{row.contender.label} at N = {sized(row.count)}"
        click.echo(f"cprbm: {scene.name}: {who}: {row.outcome.why}", err=True)
    return NOT_COMPLETED if failed else 0


def _peer(name: str) -> Contender:
    found: Contender = workshop.load(_tool(name)).contender()
    return found


def _why_not(contender: Contender, *, whole: bool) -> str:
    """Reason against a method; empty for a possible method."""
    if whole and contender.is_peer:
        return "an optimiser solves the last station only"
    return contender.absence
