"""``cprbm bench``: time and iterations against N, for both solvers on one scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import click

from comparisons.choices import KINEMATICS, Kinematics
from comparisons.cli.options import counts, folder, output, timed

if TYPE_CHECKING:
    from comparisons.benchmark import Method

NOT_COMPLETED = 1


@click.command("bench")
@click.argument("case", metavar="CASE|FILE.toml")
@click.option(
    "--sizes",
    callback=counts,
    metavar="N,N,...",
    help="Links and elements per beam; unless given 40, 80, 160 and so on doubled up to 5120 links, "
    "and up to 1280 elements.",
)
@timed("How often each size is solved.", "is not repeated, and no larger size of its solver is begun.")
@click.option("--solver", type=click.Choice(["cprbm", "fea", "both"]), default="both", show_default=True)
@click.option(
    "--formulation",
    type=click.Choice(["auto", "paper"]),
    default="auto",
    show_default=True,
    help="Contact formulation of the CPRBM.",
)
@click.option(
    "--kinematics",
    type=click.Choice(KINEMATICS),
    default="bending",
    show_default=True,
    help="Beam theory of the finite elements; 'bending' is the CPRBM's own.",
)
@output
@folder("Folder for the numbers and the figure.")
@click.pass_obj
def command(
    planted: object,
    case: str,
    sizes: tuple[int, ...] | None,
    repeat: int,
    at_most: float,
    solver: Literal["cprbm", "fea", "both"],
    formulation: Literal["auto", "paper"],
    kinematics: Kinematics,
    json_file: Path | None,
    quiet: bool,  # noqa: FBT001 - click hands it over by name
    out: Path | None,
) -> int:
    """Time the solvers on one scene at growing numbers of links and elements."""
    from comparisons import benchmark, benchmark_drawn, cases, documents, machine, sheets
    from comparisons.choices import Choices
    from comparisons.cli import showing
    from comparisons.pairing import solvers_of
    from comparisons.writing import write
    from scene import Ending

    scene = cases.opened(case)
    methods: tuple[Method, ...] = benchmark.METHODS if solver == "both" else (solver,)
    choices = Choices(formulation=formulation, kinematics=kinematics)
    plan = benchmark.Plan({name: benchmark.sizes_of(name, sizes) for name in methods}, choices, repeat, at_most)
    showing.room_for(json_file, out)
    with showing.current(shown=not quiet) as say:
        done = benchmark.measured(
            scene,
            plan,
            solvers_of(planted),
            machine.described(),
            watch=lambda repetition, method, n: say(f"{method} N = {n}, {repetition + 1} of {repeat}"),
        )
    data = documents.benchmark(done)
    if json_file is not None:
        showing.json(json_file, data)
    if out is not None:
        picture = benchmark_drawn.of_benchmark(done)
        write(out / scene.name / "bench.json", documents.text(data))
        write(out / scene.name / f"{picture.name}.svg", picture.svg)
        write(out / scene.name / f"{picture.name}.png", picture.png)
    if str(json_file) != "-" and not quiet:
        showing.tables(sheets.of_benchmark(done))
    failed = [timing for timing in done.timings if timing.ending is not Ending.COMPLETED]
    for timing in failed:
        click.echo(f"cprbm: {scene.name}: {timing.method} at N = {timing.n}: {timing.ending.value}.", err=True)
    return NOT_COMPLETED if failed else 0
