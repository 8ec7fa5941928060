"""Error against N of a question, and the error budget: tables, sentences, figures and documented JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from comparisons.choices import Choices
from comparisons.crew import Crew
from comparisons.display_units import at_station
from comparisons.pairing import Solvers
from comparisons.present.canvas import GREY, LINES, canvas, common_legend, finished, logarithmic
from comparisons.present.columns import Figure, Section
from comparisons.stations import at_shown
from comparisons.store import AnswerMemory
from comparisons.studies import budget_section as budgets
from comparisons.studies import offset_convergence
from comparisons.studies.budget import account_of
from comparisons.studies.convergence_tables import convergence_tables, document, sentences_of, shown_size
from comparisons.studies.families import Convergence, Family, converged
from cprbm_scene import OffsetQuestion, Question

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LEAST = 1e-13
"""Errors below this share of a probe's scale are round-off and are not drawn."""

_COLOURS = 10  # of matplotlib's standard cycle, C0 to C9


def convergence_section(
    question: Question, sizes: tuple[int, ...], choices: Choices, solvers: Solvers, crew: Crew
) -> Section:
    """Error against N, and the parts of every difference.

    Args:
        question: a scene with its shown stations, or an offset question.
        sizes: two or more ascending N.
        choices: the formulation and the beam theory.
        solvers: solvers of all runs.
        crew: worker processes.

    Raises:
        SceneError: a solver refuses the question.
    """
    if isinstance(question, OffsetQuestion):
        return offset_convergence.convergence_section(question, sizes, solvers.offset)
    question = at_shown(question)
    memory = AnswerMemory(pool=crew.pool, solvers=solvers)
    found = converged(question, sizes, choices, solvers, memory)
    n = shown_size(found)
    account = account_of(question, replace(choices, links=n, elements=2 * n), memory)
    return Section(
        "Error against N, and the error budget",
        (*sentences_of(found), *budgets.sentences_of(account)),
        (*convergence_figures(found), *budgets.budget_figures(account)),
        (*convergence_tables(found), *filter(lambda table: table.rows, (budgets.budget_table(account),))),
        "convergence",
        {**document(found), **budgets.data_of(account)},
        found.completed and not account.missing,
    )


def convergence_figures(found: Convergence) -> tuple[Figure, ...]:
    """Errors against N at the last station; no figure without errors."""
    stage = found.scene.stages[-1]
    last = [
        family
        for family in found.families
        if (family.stage, family.station) == (stage.name, stage.stations[-1]) and _errors(family)
    ]
    if not last:
        return ()
    names = list(dict.fromkeys(family.probe.name for family in last))
    with canvas(10.4, 5.6) as drawing:
        panels = drawing.subplots(1, 2, sharey=True)
        for axes, method, title in zip(panels, ("cprbm", "fea"), ("CPRBM", "FEA"), strict=True):
            logarithmic(axes, found.sizes)
            for family in last:
                if family.series.method == method:
                    _draw(axes, family, names.index(family.probe.name))
            axes.set_title(title, loc="left")
            axes.set_xlabel("links per beam, N" if method == "cprbm" else "elements per beam, N")
        for axes, series in zip(panels, found.series, strict=True):
            _triangle(axes, found.sizes, series.order)
        panels[0].set_ylabel("distance from the limit / the probe's largest value")
        common_legend(drawing, "right center", 1, 8.5)
        caption = (
            f"Distance from the limit at {at_station(found.scene, stage.name, stage.stations[-1])}; above it the "
            "limit's uncertainty, hollow where the uncertainty is larger."
        )
        exact = any(family.exact is not None for family in last)
        caption += " Crosses: distance from the exact value." if exact else ""
        return (finished(drawing, "convergence", caption),)


def _errors(family: Family) -> dict[int, float]:
    """Distance from the limit over the probe's scale by N, without round-off."""
    found = {n: family.apart(n) for n in family.used}
    return {n: far / family.scale for n, far in found.items() if far is not None and far > _LEAST * family.scale}


def _draw(axes: Axes, family: Family, place: int) -> None:
    errors, colour = _errors(family), f"C{place % _COLOURS}"
    line, marker = LINES[place // _COLOURS % len(LINES)]
    axes.plot(list(errors), list(errors.values()), line, color=colour, linewidth=1.1, label=family.probe.name)
    unsure = 0.0 if family.found is None else family.size(family.found.uncertainty) / family.scale
    for n, error in errors.items():
        face = colour if error > unsure else "white"
        axes.plot([n], [error], marker, color=colour, markersize=4.5, markerfacecolor=face)
        axes.plot([n, n], [error, error + unsure], color=colour, linewidth=0.7)
    true = {n: exact / family.scale for n in errors if (exact := family.true_error(n)) is not None}
    axes.plot(list(true), list(true.values()), "x", color=colour, markersize=6.5)


def _triangle(axes: Axes, sizes: Sequence[int], order: float) -> None:
    """The slope of an order, low at the left, below all errors."""
    left, right = sizes[0], sizes[1]
    low = 3.0 * axes.get_ylim()[0]
    high = low * (right / left) ** order
    axes.plot([left, right, left, left], [high, low, low, high], color=GREY, linewidth=1.0)
    at = (left, (low * high) ** 0.5)
    axes.annotate(f"{order:g}", at, textcoords="offset points", xytext=(4, -4), color=GREY, fontsize=9.0)
