"""The studies' figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture
from comparisons.studies.materials import MATERIALS, Materials, Sweep, Tested

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def error_against_ratio(found: Materials) -> Picture:
    """Displacement errors against Poisson's ratio, a panel for each case; the materials as marks on the lines."""
    with canvas(7.2, 3.4 * len(found.sweeps)) as figure:
        panels = figure.subplots(len(found.sweeps), 1, squeeze=False)[:, 0]
        for axes, sweep in zip(panels, found.sweeps, strict=True):
            for (probe, errors), colour in zip(sweep.errors.items(), (BLUE, RED), strict=False):
                _line(axes, sweep, probe, errors, colour)
                _marks(axes, [each for each in found.tested if each.specimen == sweep.specimen], probe, colour)
            bound = 100.0 * sweep.specimen.bound
            axes.axhline(
                bound, color=GREY, linewidth=1.0, linestyle=":", label=f"claimed for every material, {bound:g} %"
            )
            axes.set_ylim(bottom=0.0)
            axes.set_title(sweep.specimen.case, loc="left")
            axes.set_ylabel("displacement error, %")
            axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
        panels[-1].set_xlabel("Poisson's ratio ν")
        return picture(
            figure,
            "materials",
            "Error of the CPRBM beside the finite elements in shear against Poisson's ratio; dashed beside those in "
            f"stretch, dash-dotted in bending. Rings: {', '.join(MATERIALS)}, at loads in the ratio of their moduli.",
        )


def _line(axes: Axes, sweep: Sweep, probe: str, errors: tuple[float | None, ...], colour: str) -> None:
    known = [(ratio, 100.0 * e) for ratio, e in zip(sweep.poisson_ratios, errors, strict=True) if e is not None]
    if known:
        ratios, percents = zip(*known, strict=True)
        axes.plot(ratios, percents, "-", color=colour, linewidth=1.6, label=f"{probe.partition('.')[0]}, shear")
    for error, style in zip(sweep.without_shear[probe].values(), ("-.", "--"), strict=True):
        if error is not None:
            axes.axhline(100.0 * error, color=colour, linewidth=0.9, linestyle=style)


def _marks(axes: Axes, tested: list[Tested], probe: str, colour: str) -> None:
    for each in tested:
        for row in each.comparison.rows:
            fraction = row.fraction(row.difference)
            if row.probe.name == probe and fraction is not None:
                axes.plot(each.properties.poisson_ratio, 100.0 * fraction, "o", color=colour, markerfacecolor="none")
                above = each.material == "titanium"
                axes.annotate(
                    each.material,
                    (each.properties.poisson_ratio, 100.0 * fraction),
                    textcoords="offset points",
                    xytext=(0, 7 if above else -14),
                    ha="center",
                    fontsize=7.5,
                    color=colour,
                )
