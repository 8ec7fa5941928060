"""The figure of a scene at a family of sizes: error against N, both axes logarithmic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from comparisons.converging.families import Convergence, Family
from comparisons.figures import GREY, LOOKS, Picture, canvas, picture
from comparisons.verdict.uncertainty import OWN

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

_LEAST = 1e-13
"""Errors below this share of a probe's scale are round-off and are not drawn."""

_COLOURS = 10  # of matplotlib's standard cycle, C0 to C9


def of_convergence(found: Convergence) -> tuple[Picture, ...]:
    """The figure at the last station; none where there is nothing to draw."""
    stage = found.scene.stages[-1]
    last = [
        family
        for family in found.families
        if (family.stage, family.station) == (stage.name, stage.stations[-1])
        and family.series.kinematics == "bending"
        and _errors(family)
    ]
    if not last:
        return ()
    names = list(dict.fromkeys(family.probe.name for family in last))
    known = any(family.exact is not None for family in last)
    with canvas(10.4, 5.6) as figure:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, method, title, pieces in zip(
            panels, ("cprbm", "fea"), ("CPRBM", "FEA in bending"), ("links", "elements"), strict=True
        ):
            axes.set_xscale("log")
            axes.set_yscale("log")
            for family in last:
                if family.series.method == method:
                    _draw(axes, family, names.index(family.probe.name))
            axes.set_xticks(found.sizes, [str(n) for n in found.sizes])
            axes.minorticks_off()
            axes.grid(visible=True, which="major", color="#e4e4e4", linewidth=0.6)
            axes.set_title(title, loc="left")
            axes.set_xlabel(f"{pieces} per beam, N")
        panels[0].set_ylabel("distance from the limit / the probe's largest value")
        for axes, order in zip(panels, (OWN["cprbm"], OWN["fea"]), strict=True):
            _triangle(axes, found.sizes, order)
        labels: dict[str, Artist] = {}
        for axes in panels:
            handles, texts = axes.get_legend_handles_labels()
            labels.update(zip(texts, handles, strict=True))
        figure.legend(list(labels.values()), list(labels), loc="outside right center", fontsize=8.5)
        return (
            picture(
                figure,
                "convergence",
                f"Distance from the limit at {stage.name} {stage.stations[-1]:g}; above it the limit's uncertainty, "
                f"hollow where that is the larger.{' Crosses: distance from the exact value.' if known else ''}",
            ),
        )


def _errors(family: Family) -> dict[int, float]:
    """By N the distance from the limit over the probe's scale, without what is round-off."""
    found = {n: family.apart(n) for n in family.used}
    return {
        n: apart / family.scale for n, apart in found.items() if apart is not None and apart > _LEAST * family.scale
    }


def _draw(axes: Axes, family: Family, place: int) -> None:
    errors = _errors(family)
    line, marker = LOOKS[place // _COLOURS % len(LOOKS)]
    colour = f"C{place % _COLOURS}"
    ns = list(errors)
    axes.plot(ns, list(errors.values()), line, color=colour, linewidth=1.1, label=family.probe.name)
    unsure = 0.0 if family.found is None else family.size(family.found.uncertainty) / family.scale
    for n, error in errors.items():
        face = colour if error > unsure else "white"
        axes.plot([n], [error], marker, color=colour, markersize=4.5, markerfacecolor=face)
        axes.plot([n, n], [error, error + unsure], color=colour, linewidth=0.7)
    truth = {n: family.true_error(n) for n in ns}
    true = {n: error / family.scale for n, error in truth.items() if error is not None}
    axes.plot(list(true), list(true.values()), "x", color=colour, markersize=6.5)


def _triangle(axes: Axes, sizes: Sequence[int], order: float) -> None:
    """The slope of an order, low at the left, where no error is."""
    left, right = sizes[0], sizes[1]
    low = 3.0 * axes.get_ylim()[0]
    high = low * (right / left) ** order
    axes.plot([left, right, left, left], [high, low, low, high], color=GREY, linewidth=1.0)
    axes.annotate(
        f"{order:g}", (left, (low * high) ** 0.5), textcoords="offset points", xytext=(4, -4), color=GREY, fontsize=9.0
    )
