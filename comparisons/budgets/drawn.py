"""The figure of an error budget: what each probe's difference is made of, and how large it is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from comparisons.budgets.accounts import Account
from comparisons.budgets.parts import PARTS, Budget
from comparisons.formats import percent
from comparisons.present.canvas import GREY, canvas, finished
from comparisons.present.columns import Figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LOOKS = {
    "contact": ("#7b4ea3", "contact: paper to auto"),
    "links": ("#1f5fa8", "CPRBM: links"),
    "rest": ("#222222", "rest between the limits"),
    "elements": ("#3f8f5b", "FEA: elements"),
    "penalty": ("#8fd0b5", "FEA: penalty"),
}

MISSED = "#8a6d1f"
_TOLD_OF_SOLID = (
    " The thin bars beside the sum are what the beam theories miss together: the finite elements' limit less the "
    "solid's value, and how far that may be off."
)


def of_account(account: Account) -> tuple[Figure, ...]:
    """The figure at the last station; none where there is no budget."""
    budgets = [each for each in account.last if each.all_parts > 0.0]
    if not budgets:
        return ()
    with canvas(10.4, 1.9 + 0.34 * len(budgets)) as figure:
        left, right = figure.subplots(1, 2, sharey=True, width_ratios=(5, 2))
        _composition(left, budgets)
        _sizes(right, budgets)
        left.set_yticks(range(len(budgets)), [each.row.probe.name for each in budgets])
        left.invert_yaxis()
        handles, labels = left.get_legend_handles_labels()
        further = right.get_legend_handles_labels()
        figure.legend(
            [*handles, *further[0]], [*labels, *further[1]], loc="outside lower center", ncols=4, fontsize=9.0
        )
        stage = account.scene.stages[-1]
        return (
            finished(
                figure,
                "budget",
                f"What the difference of the CPRBM from the finite elements in {account.runs.theory} is made of at "
                f"{stage.name} {stage.stations[-1]:g}: parts that make it larger to the right, those that make it "
                "smaller to the left, as shares of all of them; the diamond is their sum, which the panel beside shows "
                "in per cent." + (_TOLD_OF_SOLID if any(each.missed is not None for each in budgets) else ""),
            ),
        )


def _composition(axes: Axes, budgets: Sequence[Budget]) -> None:
    shown = [name for name in PARTS if any(getattr(each.parts, name) != 0.0 for each in budgets)]
    ends = [[0.0, 0.0] for _ in budgets]
    for name in shown:
        colour, label = LOOKS[name]
        shares = [100.0 * _share(each, name) for each in budgets]
        starts = [end[share < 0.0] for end, share in zip(ends, shares, strict=True)]
        axes.barh(range(len(budgets)), shares, left=starts, height=0.66, color=colour, label=label)
        for end, share in zip(ends, shares, strict=True):
            end[share < 0.0] += share
    _missed(axes, budgets)
    net = [sum(end) for end in ends]
    axes.plot(net, range(len(budgets)), "D", color="white", markeredgecolor="black", markersize=5.0, label="their sum")
    axes.axvline(0.0, color="black", linewidth=0.8)
    axes.set_xlabel("share of all parts, %")


def _missed(axes: Axes, budgets: Sequence[Budget]) -> None:
    """A bar below each row whose beam theories are held against the solid."""
    known = [
        (place, 100.0 / each.all_parts, each.row.fraction(each.missed), each.row.fraction(each.missed_uncertainty))
        for place, each in enumerate(budgets)
        if each.missed is not None and each.missed_uncertainty is not None
    ]
    if known:
        axes.barh(
            [place + 0.42 for place, *_ in known],
            [share * (missed or 0.0) for _, share, missed, _ in known],
            xerr=[share * (doubt or 0.0) for _, share, _, doubt in known],
            height=0.14,
            color=MISSED,
            error_kw={"linewidth": 0.8},
            label="missed by beam theory: FEA to solid",
        )


def _share(budget: Budget, name: str) -> float:
    return (budget.row.fraction(getattr(budget.parts, name)) or 0.0) / budget.all_parts


def _sizes(axes: Axes, budgets: Sequence[Budget]) -> None:
    shown = list[float]()
    for label, marker, colour, sizes in (
        ("difference, %", "D", "black", [each.row.difference for each in budgets]),
        ("paper beside auto, %", "o", LOOKS["contact"][0], [_beside(each) for each in budgets]),
        ("curved beam, %", "^", GREY, [each.curved for each in budgets]),
    ):
        known = [(100.0 * fraction, place) for place, fraction in enumerate(_fractions(budgets, sizes)) if fraction]
        if known:
            x, y = zip(*known, strict=True)
            shown += x
            face = colour if marker == "D" else "none"
            axes.plot(x, y, marker, color=colour, markersize=5.0, markerfacecolor=face, label=label)
    for place, budget in enumerate(budgets):
        axes.annotate(
            percent(budget.row.fraction(budget.row.difference)),
            (1.02, place),
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=9.0,
        )
    _decades(axes, shown)
    axes.tick_params(axis="y", length=0.0)
    axes.grid(visible=True, which="major", axis="x", color="#e4e4e4", linewidth=0.6)
    axes.set_xlabel("size, %")


def _decades(axes: Axes, shown: Sequence[float]) -> None:
    """Whole decades, of which alone the numbers are written: those between them have no room in so narrow a panel."""
    axes.set_xscale("log")
    if shown:
        lowest, highest = math.floor(math.log10(min(shown))), math.ceil(math.log10(max(shown)))
        axes.set_xlim(10.0**lowest / 2.0, 2.0 * 10.0 ** max(highest, lowest + 1))
        every = max(1, math.ceil((highest - lowest) / 4))
        axes.set_xticks([10.0**power for power in range(lowest, max(highest, lowest + 1) + 1, every)])
    axes.tick_params(axis="x", which="minor", labelbottom=False)


def _beside(budget: Budget) -> float | None:
    """How far ``paper`` is from ``auto`` where it is no part of the sum."""
    return None if budget.paper is None or budget.parts.contact != 0.0 else abs(budget.paper)


def _fractions(budgets: Sequence[Budget], sizes: Sequence[float | None]) -> list[float]:
    return [0.0 if size is None else each.row.fraction(size) or 0.0 for each, size in zip(budgets, sizes, strict=True)]
