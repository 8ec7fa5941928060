"""The group of all commands of ``cprbm`` as data (help texts, options, functions), and a command line as a function."""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from comparisons.choices import KINEMATICS
from comparisons.cli import options
from comparisons.cli.commands import TOOLS, Commands, SolvingCommand, absence_of, is_checkout, later
from comparisons.cli.errors import exit_code
from comparisons.cli.options import CASE, CASES, EXACT, EXPORTS, MANY, NUMERICAL, OUTPUT, SET, SIZED, VARIANTS

if TYPE_CHECKING:
    from comparisons.pairing import Solvers

ANSWERING = click.Choice(["cprbm", "fea", "exact", "solid"])
"""Names of all solvers of a single answer."""

OPTIMISERS = ("slsqp", "ipopt") if is_checkout() else ()
"""Optimisers on the problem of the CPRBM: developers' tools."""

_here = partial(options.folder, default=".", show_default=True)
"""Option ``--out DIR`` of the commands that write scene files."""

_number_of = partial(click.Option, show_default=True)
_sizes = partial(click.Option, ["--sizes"], metavar="N,N,...")
_growing = partial(_sizes, callback=options.family_sizes, show_default=True)


class _Method(click.Choice[str]):
    """Name of a method; removed methods, and methods of the checkout in a wheel, are refused."""

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The method.

        Raises:
            click.ClickException: the method is a developers' tool and this is no checkout, or the method is removed.
            click.BadParameter: no method has this name.
        """
        if absence := absence_of(f"bench --method {value}"):
            raise click.ClickException(absence)
        return super().convert(value, param, ctx)


def _list_studies() -> None:
    """List the studies, if the command line has none."""
    ctx = click.get_current_context()
    names = STUDIES.list_commands(ctx) if ctx.invoked_subcommand is None else ()
    for name in names:
        click.echo(f"{name:<16} {STUDIES.commands[name].get_short_help_str(100)}")


MECHANISM = (
    click.Command(
        "new",
        callback=later("files.new"),
        params=[
            click.Argument(["name"]),
            options.BRIEF,
            _here(help="Folder for the scene and its schema."),
        ],
        help="Write NAME.toml, a commented scene to start from.\n\nThe scene is a small mechanism; change the scene "
        "into your own. A JSON schema beside the file lets editors complete keys and mark mistakes.",
    ),
    click.Command(
        "import",
        callback=later("files.import_drawing"),
        params=[
            click.Argument(["drawing"], metavar="FILE", type=options.READ_FILE),
            click.Option(["--thickness"], callback=options.positive, required=True, metavar="T",
                         help="Thickness of the beams, in the file's unit."),
            click.Option(["--width"], callback=options.positive, required=True, metavar="W",
                         help="Width of the beams, in the file's unit."),
            click.Option(["--unit"], type=click.Choice(["m", "cm", "mm", "um", "in"]), default="mm", show_default=True,
                         help="Unit of lengths in the file, and in the scene."),
            click.Option(["--within"], callback=options.fraction, default="1e-5", show_default=True, metavar="SHARE",
                         help="Allowed distance of a spline from its curve, over the length of the curve."),
            click.Option(["--name"], metavar="NAME", help="Name of the scene.  [default: the name of the file]"),
            _here(help="Folder for NAME.toml."),
        ],
        help="Write a scene from the curves of a drawing.\n\nFILE is a table of points (.csv), a .dxf (read by "
        "ezdxf), or a .geo, .step, .msh, .brep or .iges (read by gmsh). Lines and circular arcs stay exact; other "
        "curves become splines with a stated distance. Wrong curves are left out and named. gmsh runs a .geo file as "
        "a program: import trusted files only.",
    ),
    SolvingCommand(
        "solve",
        callback=later("answers.solve"),
        params=[CASE, SET, options.solver(type=ANSWERING, help="Solver of the scene."), *NUMERICAL, *EXPORTS, *OUTPUT],
        help="Solve a scene with a single solver and print all stations.",
    ),
    SolvingCommand(
        "compare",
        callback=later("verdicts.compare_all"),
        params=[
            CASES, SET,
            options.opinions_for(help="Solvers: 'cprbm,fea', or 'cprbm,fea,solid' for a third opinion."),
            *NUMERICAL, EXACT, *EXPORTS, *OUTPUT,
            options.folder(help="Folder of the report.  [default: 'report' for 'compare all', otherwise none]"),
        ],
        help="Solve scenes with both solvers and state a verdict.\n\nThe verdict of a scene is AGREE, DIFFER or "
        "UNDECIDED, with a reason.",
    ),
    SolvingCommand(
        "converge",
        callback=later("verdicts.converge_all"),
        params=[
            CASES, SET, options.opinions_for(
                help="Solvers: 'cprbm,fea', or 'cprbm,fea,solid' for the error of the beam theories."
            ),
            _growing(default="10,20,40,80,160,320", help="Two or more numbers of links and elements per beam."),
            *VARIANTS, EXACT, *OUTPUT,
            options.folder(help="Folder of page, numbers and figures.  [default: 'convergence' for 'converge all', "
                           "otherwise none]"),
        ],
        help="State order, limit and error of every number against N.\n\nThe error budget splits every difference of "
        "the solvers into parts.",
    ),
    SolvingCommand(
        "sweep",
        callback=later("many.sweep"),
        params=[
            CASE,
            click.Option(["--vary"], multiple=True, metavar="NAME=FIRST..LAST:COUNT",
                         help="Range of a parameter, such as t=1.8mm..2.2mm:11; several make a grid. Without :COUNT "
                         "the range of a sample."),
            click.Option(["--sample"], metavar="sobol:K|lhs:K|FILE.csv",
                         help="Points of a sample in place of a grid; without --vary in the ranges of the scene's "
                         "parameters."),
            options.solver(type=click.Choice(["cprbm", "fea", "compare"]),
                           help="Solver of every point, or both with a verdict."),
            click.Option(["--check"], type=click.IntRange(min=0), default=0, metavar="K",
                         help="Compare both solvers at K points: corners, then a Sobol subset."),
            click.Option(["--shard"], callback=options.shard, default="1/1", metavar="I/N", show_default=True,
                         help="Solve the points I, I + N, ... only."),
            click.Option(["--merge"], multiple=True, metavar="DIR",
                         type=click.Path(exists=True, file_okay=False, path_type=Path),
                         help="Take over the outcomes of a folder, such as of a shard; may be repeated."),
            options.flag(["--netcdf"], help="Write sweep.nc too, through xarray."),
            *MANY,
        ],
        help="Solve a scene at many values of its parameters.\n\nThe folder has a table of all numbers, a table of the "
        "last stations, figures and a page. A sweep that was stopped goes on with the same command, and a larger grid "
        "takes over the points of a smaller grid.",
    ),
    SolvingCommand(
        "tolerance",
        callback=later("many.tolerance"),
        params=[
            CASE,
            _number_of(["--samples"], default="1024", callback=options.power_of_2, metavar="N",
                       help="Number of points in a sample, a power of 2."),
            options.flag(["--sobol"],
                         help="First- and total-order Sobol indices too; N (d + 2) points for d parameters."),
            click.Option(["--limits"], type=options.READ_FILE, metavar="FILE.toml",
                         help="File with [[limits]] on probes, for the yield."),
            options.solver(type=click.Choice(["cprbm", "fea"]), help="Solver of all points."),
            *MANY,
        ],
        help="Quantiles and yield of a scene whose parameters scatter.\n\nThe parameters with a tolerance in the scene "
        "are independent: normal or uniform. The folder has the tables of a sweep, tolerance.json and a page. A study "
        "that was stopped goes on with the same command.",
    ),
    SolvingCommand(
        "optimise",
        callback=later("many.optimise"),
        params=[
            CASE,
            click.Option(["--goal"], required=True, type=options.READ_FILE, metavar="FILE.toml",
                         help="File with a [goal] and [[limits]] on probes."),
            click.Option(["--vary"], multiple=True, metavar="NAME=FIRST..LAST",
                         help="Range of a parameter; otherwise the ranges of the scene's parameters."),
            _number_of(["--starts"], type=click.IntRange(1, 64), default=4, metavar="K",
                       help="Number of starts: the values of the file, and Sobol points."),
            _number_of(["--solves"], type=click.IntRange(10, 10_000), default=200, metavar="K",
                       help="Largest number of solves per start."),
            *MANY,
        ],
        help="Search the parameters of a scene for a goal within limits.\n\nThe CPRBM solves all points. The best "
        "point is solved at twice the links and by both solvers, and is called an optimum only if the solvers agree. "
        "A search that was stopped goes on with the same command.",
    ),
    SolvingCommand(
        "view",
        callback=later("answers.view"),
        params=[
            CASE, SET, options.solver(type=ANSWERING, help="Solver of the scene."),
            click.Option(["--out"], type=options.FILE, metavar="FILE",
                         help="File to write; the ending selects the kind: .png, .svg; .gif, .apng (animation through "
                         "the stations); .3d.png, .3d.gif, .3d.apng (in space, by PyVista); .vtu, .pvd (a station, all "
                         "stations, for ParaView).  [default: the scene's name with .png]"),
            click.Option(["--quantity"], type=click.Choice(["bending_stress", "combined_stress", "moment"]),
                         default="bending_stress", show_default=True, help="Quantity behind the colours of the beams."),
            click.Option(["--station"], metavar="[STAGE:]VALUE",
                         help="The station to show, in the file's units.  [default: the last of all]"),
            *NUMERICAL,
            options.BRIEF,
            options.VERBOSE,
        ],
        help="Draw a solver's answer: picture, animation or VTU files.",
    ),
    SolvingCommand(
        "report",
        callback=later("verdicts.report"),
        params=[
            click.Argument(["arguments"], nargs=-1, metavar="[CASE|FILE.toml...|all]",
                           shell_complete=options.candidates),
            SET, *SIZED, *VARIANTS,
            _growing(default="10,20,40,80",
                     help="Two or more numbers of links and elements per beam for the error against N."),
            click.Option(["--without"], multiple=True, type=click.Choice(["convergence", "times"]),
                         help="Leave out a long part; may be repeated. 'convergence': error against N and the error "
                         "budget. 'times': run time against error, and the paper's Table 1."),
            EXACT, *OUTPUT, options.folder(help="Folder of the report.  [default: 'full-report']"),
        ],
        help="Write a page with verdicts, figures, errors and run times.\n\nThe page opens without a network. Without "
        "a scene the report covers all built-in cases. Finished parts are taken from the folder, and an interrupted "
        "run goes on. Exit code 0 means a written report, with any verdict.",
    ),
)  # fmt: skip
STUDIES = Commands(
    "study",
    {"Commands": (
        SolvingCommand(
            "calibration",
            callback=later("verdicts.study_calibration"),
            params=[*OUTPUT, options.folder(help="Folder for page, numbers and figure.")],
            help="Compare stated and true errors on every case with an exact answer.",
        ),
        click.Command("relations", help=TOOLS["study relations"][1]),
        SolvingCommand(
            "table1",
            callback=later("verdicts.study_table1"),
            params=[options.repeated(help="Repetitions of every cell of the table."),
                    options.time_limit(default="60", help="A solve that takes longer is not repeated."), *OUTPUT,
                    options.folder(help="Folder for page, numbers and figure.")],
            help="Time both solvers at the paper's discretisations, beside the paper's Table 1.",
        ),
    )},
    "Run a long study; without a name, list the studies.",
    callback=_list_studies,
)  # fmt: skip
EVIDENCE = (
    click.Command("list", callback=later("doctor.list_cases"), help="List the built-in cases."),
    SolvingCommand(
        "bench",
        callback=later("verdicts.bench"),
        params=[
            CASE, SET,
            _sizes(callback=options.counts,
                   help="Links and elements per beam.  [default: 10, 20, 40 and further doublings, up to 5120 "
                         "links in auto, 640 in paper and 1280 elements; in a checkout 160 links for ipopt and 80 for "
                         "slsqp]"),
            click.Option(["-n", "--links", "numbers"], multiple=True, callback=options.numbers, metavar=options.COUNT,
                         help="Links per beam, as 40 or as beam1=30,beam2=40; may be repeated, in place of --sizes."),
            click.Option(["--method", "methods"], multiple=True, type=_Method(["auto", "paper", "fea", *OPTIMISERS]),
                         help="Method to time; may be repeated. auto and paper belong to the CPRBM.  [default: all for "
                         "the scene]"),
            click.Option(["--stations"], type=click.Choice(["last", "all"]), default="last", show_default=True,
                         help="'last': only the last station of every stage, in a single step, with the probes of the "
                         "errors. 'all': the whole scene, without the optimisers."),
            options.repeated(help="Repetitions of every size."),
            options.time_limit(default="30", help="A solve that takes longer is the last of its method; an optimiser "
                               "is stopped then. Sizes with a longer sum are not repeated."),
            click.Option(["--clock"], type=click.Choice(["wall", "cpu"]), default="wall", show_default=True,
                         help="Elapsed seconds, or processor seconds for a machine with other work."),
            click.Option(["--kinematics"], type=click.Choice(KINEMATICS), default="bending", show_default=True,
                         help="Beam theory of the finite elements; 'bending' is the theory of the CPRBM and of the "
                         "errors."),
            *OUTPUT, options.folder(help="Folder for numbers and figures."),
        ],
        help="Time solvers and optimisers against their errors.\n\nThe numbers of links and elements grow. Exit code 1 "
        "means an incomplete run of a solver of this project.",
    ),
    STUDIES,
)  # fmt: skip
DEVELOPMENT = (
    click.Command("schema", callback=later("files.schema"), help="Print the JSON schema of scene files."),
    click.Command(
        "doctor",
        callback=later("doctor.doctor"),
        params=[options.flag(["-q", "--quiet"], help="Print only required libraries that cannot be used.")],
        help="List installed and missing libraries.\n\nA missing library stands with the command that installs it.\n\n"
        "A further line states whether PyVista can draw. The last line sums up. Exit code 1 means a missing required "
        "library.",
    ),
    click.Command("robustness", help=TOOLS["robustness"][1]),
)


def _version(ctx: click.Context, param: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's form
    """Print the installed version; a folder of sources without installation has no version."""
    if value:
        from comparisons.provenance import version_of

        own = version_of("cprbm")
        click.echo(f"cprbm {own}" if own else "cprbm, run from its sources: no version is installed")
        ctx.exit()


commands = Commands(
    "cprbm",
    {"Your mechanism": MECHANISM, "Built-in cases and evidence": EVIDENCE, "Development": DEVELOPMENT},
    "Contact-aided compliant mechanisms: CPRBM beside finite elements, with a verdict.",
    [click.Option(["--version"], is_flag=True, is_eager=True, expose_value=False, callback=_version,
                  help="Show the version and exit.")],
)  # fmt: skip
commands.context_settings = {"help_option_names": ["-h", "--help"]}


def run(arguments: Sequence[str], solvers: "Solvers | None" = None) -> int:
    """Run a command line.

    Args:
        arguments: without the program's name.
        solvers: solvers in place of the real solvers.

    Returns:
        The exit code; a sentence about any problem is on standard error.
    """

    def command() -> int | None:
        if sys.stdout is None:
            raise click.ClickException("Standard output is closed.")
        # not ``commands.main``: a closed standard output would end the process there
        with commands.make_context("cprbm", list(arguments), obj=solvers) as context:
            code = commands.invoke(context)
        sys.stdout.flush()
        return code if isinstance(code, int) else 0

    return exit_code(command)
