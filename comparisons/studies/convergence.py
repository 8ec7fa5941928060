"""Error against N of a question, and the error budget: runs, figures and section.

Of an offset question the exact curve is known: the limit of every error is zero, and the order of two sizes is the
logarithm of their errors' ratio over the logarithm of the ratio of sizes.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import log, nan

import numpy as np

from comparisons.choices import Choices
from comparisons.executor import Crew
from comparisons.formats import at_station, percent
from comparisons.pairing import OffsetConstruction, Solvers
from comparisons.present.canvas import GREY, LINES, Line, Panel, chart
from comparisons.present.columns import Column, Figure, Section, Table, table_of
from comparisons.present.offset import OffsetRow, compared_offset
from comparisons.sentences import problem_sentences
from comparisons.stations import at_shown, last_station
from comparisons.store import AnswerMemory
from comparisons.studies import budget_section, convergence_tables
from comparisons.studies.budget import account_of
from comparisons.studies.families import Convergence, Family, Method, Series, critical_families, probe_families, size
from comparisons.verdict import Limit
from cprbm_scene import OffsetQuestion, Question, Scene
from cprbm_scene.offset import FEWEST, MOST

TITLE = "Error against N", "Both solvers at a family of sizes: limits, orders and errors of all numbers."
"""Title and lead of the page."""

_LEAST = 1e-13
"""Share of a probe's scale below which errors are round-off and not drawn."""

_COLOURS = 10  # of Matplotlib's standard cycle, C0 to C9


def convergence_of(scene: Scene, sizes: Sequence[int], choices: Choices, solvers: Solvers, crew: Crew) -> Convergence:
    """Orders and limits of a scene.

    Args:
        scene: the question.
        sizes: N, two or more, ascending.
        choices: the formulation and the beam theory; sizes and penetration follow from N.
        solvers: all solvers, the exact reference among them.
        crew: worker processes.

    Raises:
        SceneError: a solver refuses the question.
    """
    theory = choices.kinematics_of(scene)
    choices = choices.within(theory)
    runs: list[tuple[Method, str]] = [("cprbm", choices.formulation), ("fea", theory)]
    jobs = [(getattr(solvers, method), scene, choices.of_size(n)) for method, _ in runs for n in sizes]
    known = [] if solvers.exact is None or theory != "bending" else [(solvers.exact, scene, choices)]
    answers = crew.answers([*jobs, *known])
    exact, series = answers.pop() if known else None, list[Series]()
    for place, (method, variant) in enumerate(runs):
        own = dict(zip(sizes, answers[place * len(sizes) :], strict=False))
        why = {n: said for n, answer in own.items() if (said := "; ".join(problem_sentences(scene, answer)))}
        series.append(Series(method, variant, theory, own, why))
    return Convergence(
        scene,
        sizes=tuple(sizes),
        series=tuple(series),
        families=tuple(probe_families(scene, series, exact)),
        criticals=tuple(critical_families(scene, series)),
        exact=exact,
    )


def convergence_section(
    question: Question, sizes: tuple[int, ...], choices: Choices, solvers: Solvers, crew: Crew
) -> Section:
    """Error against N, and the parts of every difference.

    Args:
        question: a scene with its shown stations, or an offset question.
        sizes, choices, solvers, crew: as of :func:`convergence_of`.

    Raises:
        SceneError: a solver refuses the question.
    """
    if isinstance(question, OffsetQuestion):
        return _offset_section(question, sizes, solvers.offset)
    question = at_shown(question)
    memory = AnswerMemory(pool=crew.pool, solvers=solvers)
    found = convergence_of(question, sizes, choices, solvers, memory)
    account = account_of(question, replace(choices, links=found.shown, elements=2 * found.shown), memory)
    return Section(
        "Error against N, and the error budget",
        (*convergence_tables.sentences_of(found), *budget_section.sentences_of(account)),
        (*convergence_figures(found), *budget_section.budget_figures(account)),
        tuple(
            each for each in (*convergence_tables.tables_of(found), budget_section.budget_table(account)) if each.rows
        ),
        "convergence",
        {**convergence_tables.document(found), **budget_section.data_of(account)},
        found.completed and not account.missing,
    )


def convergence_figures(found: Convergence) -> tuple[Figure, ...]:
    """Errors against N at the last station; no figure without errors."""
    last = [family for family in found.last if _errors(family)]
    if not last:
        return ()
    names = list(dict.fromkeys(family.probe for family in last))
    left, right = found.sizes[:2]
    low, panels = 0.2 * min(error for family in last for error in _errors(family).values()), list[Panel]()
    for series in found.series:
        own = [family for family in last if family.solver == series.method]
        lines = [line for family in own for line in _lines(family, names.index(family.probe))]
        high = low * (right / left) ** series.order  # a triangle shows the slope of the order, below all errors
        lines.append(([left, right, left, left], [high, low, low, high], {"color": GREY, "linewidth": 1.0}))
        look = {"xytext": (4, -4), "color": GREY, "fontsize": 9.0}
        panel = Panel(
            ordinate="" if panels else "distance from the limit / the probe's largest value",
            lines=lines,
            title=convergence_tables.NAMES[series.method],
            texts=[(f"{series.order:g}", (left, (low * high) ** 0.5), look)],
        )
        panels.append(panel)
    caption = (
        f"Distance from the limit at {at_station(found.scene, *last_station(found.scene))}; above it the "
        "limit's uncertainty, hollow where the uncertainty is larger."
    )
    caption += " Crosses: distance from the exact value." if any(each.exact is not None for each in last) else ""
    return (
        chart("convergence", caption, "links or elements per beam, N", panels, panel=(5.2, 4.8), columns=2, shared="y",
              decades=found.sizes, legend=("right center", 1)),
    )  # fmt: skip


def _errors(family: Family) -> dict[int, float]:
    """Distance from the limit over the probe's scale by N, without round-off."""
    errors = {n: far / family.scale for n in family.used if (far := family.apart(n)) and family.scale > 0.0}
    return {n: error for n, error in errors.items() if error > _LEAST}


def _lines(family: Family, place: int) -> Iterator[Line]:
    """Errors, their markers and uncertainties, and crosses for true errors."""
    errors, colour = _errors(family), f"C{place % _COLOURS}"
    line, marker = LINES[place // _COLOURS % len(LINES)]
    yield [*errors], [*errors.values()], {"linestyle": line, "color": colour, "linewidth": 1.1, "label": family.probe}
    unsure = 0.0 if family.found is None else size(family.found.uncertainty) / family.scale
    for n, error in errors.items():
        face = colour if error > unsure else "white"
        yield [n], [error], {"marker": marker, "color": colour, "markersize": 4.5, "markerfacecolor": face}
        yield [n, n], [error, error + unsure], {"color": colour, "linewidth": 0.7}
    true = {n: exact / family.scale for n in errors if (exact := family.true_error(n)) is not None}
    yield [*true], [*true.values()], {"linestyle": "none", "marker": "x", "color": colour, "markersize": 6.5}


def _offset_section(question: OffsetQuestion, sizes: tuple[int, ...], construct: OffsetConstruction) -> Section:
    """Error against N for every spacing and offset, at the allowed sizes."""
    numbers = tuple(n for n in sizes if FEWEST <= n <= MOST)
    excluded = ", ".join(str(n) for n in sizes if n not in numbers)
    families, completed = list[Family](), True
    if len(numbers) > 1:
        compared = compared_offset(question.model_copy(update={"numbers": numbers}), construct)
        completed = compared.verdict.completed
        families = [
            _offset_family(spacing, t, [row for row in compared.rows if (row.spacing, row.offset) == (spacing, t)])
            for spacing in question.spacings
            for t in question.offsets
        ]
    return Section(
        "Error against N",
        (f"An offset question takes {FEWEST} to {MOST} springs; left out: {excluded}.",) if excluded else (),
        (_offset_figure(question, numbers, families),) if families else (),
        (_offset_table(question, numbers, families),) if families else (),
        "convergence",
        {
            "case": question.name,
            "families": [entry for family in families for entry in convergence_tables.entries(numbers, family)],
            "runs": [],
        },
        completed,
    )


def _offset_family(spacing: str, offset: float, rows: list[OffsetRow]) -> Family:
    """Errors of a spacing at an offset; an error that vanishes or is not finite has no order."""
    orders = [
        log(one.difference / two.difference) / log(two.n / one.n)
        if one.difference > 0.0 and two.difference > 0.0
        else None
        for one, two in pairwise(rows)
    ]
    zero = np.zeros(1)
    return Family(
        solver="cprbm",
        settings={"spacing": spacing},
        probe=f"{spacing}.offset_points",
        stage="offset",
        station=offset,
        unit="1",
        scale=1.0,
        components=("largest",),
        values={row.n: np.array([row.difference]) for row in rows},
        floor=0.0,
        used=tuple(row.n for row in rows),
        orders=tuple(orders),
        found=Limit(zero, zero, nan, orders[-1], ""),
        why="",
        exact=zero,
    )


def _largest(families: list[Family], spacing: str, n: int) -> float:
    """The largest error of all offsets."""
    return max(float(each.values[n][0]) for each in families if each.settings["spacing"] == spacing)


def _offset_table(question: OffsetQuestion, numbers: tuple[int, ...], families: list[Family]) -> Table:
    def error(n: int) -> Column[str]:
        return Column(f"N = {n}", lambda spacing: percent(_largest(families, spacing, n)))

    def order(spacing: str) -> str:
        return convergence_tables.spread(
            each for family in families if family.settings["spacing"] == spacing for each in family.orders
        )

    return table_of(
        f"{question.title or question.name}: largest error of all offsets",
        [Column[str]("spacing", str), *map(error, numbers), Column("order", order)],
        question.spacings,
        f"Error along {question.axis}, relative to the {question.relative_to} of the exact offset curve; orders of "
        "every two sizes and offset: median, least and largest.",
    )


def _offset_figure(question: OffsetQuestion, numbers: tuple[int, ...], families: list[Family]) -> Figure:
    looks = {spacing: (place, *LINES[place % len(LINES)]) for place, spacing in enumerate(question.spacings)}
    lines: list[Line] = [
        (numbers, [_largest(families, spacing, n) for n in numbers],
         {"linestyle": line, "marker": marker, "color": f"C{place % 10}", "markersize": 4.5, "label": spacing})
        for spacing, (place, line, marker) in looks.items()
    ]  # fmt: skip
    return chart(
        "convergence",
        caption="Largest error of all offsets against the number of springs.",
        abscissa="springs N",
        panels=[Panel(f"largest error / {question.relative_to}", lines)],
        panel=(6.4, 3.4),
        decades=numbers,
    )
