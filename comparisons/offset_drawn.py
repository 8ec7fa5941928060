"""The figures of an offset question: the largest errors over N and t, and the points on the exact curves."""

from __future__ import annotations

import numpy as np

from comparisons.figures import BLUE, RED, Picture, canvas, picture
from comparisons.offset_exact import offset_curve
from comparisons.offset_verdict import OffsetComparison
from cprbm_scene.offset import Shown


def of_comparison(compared: OffsetComparison) -> tuple[Picture, ...]:
    """The largest relative errors over N and t, and the offset points on the exact curves."""
    pictures = [_errors_map(compared)]
    if compared.question.shown is not None:
        pictures.append(_offset_points(compared, compared.question.shown))
    return tuple(pictures)


def _errors_map(compared: OffsetComparison) -> Picture:
    """A map per spacing, in the manner of the paper's Fig. 6."""
    question = compared.question
    numbers, offsets = sorted(question.numbers), sorted(question.offsets)
    found = {(row.spacing, row.n, row.offset): 100.0 * row.difference for row in compared.rows}
    positive = [value for value in found.values() if value > 0.0] or [1.0]
    least, most = 10.0 ** np.floor(np.log10(min(positive))), 10.0 ** np.ceil(np.log10(max(positive)))
    rows = -(-len(question.spacings) // 2)
    with canvas(8.4, 3.3 * rows) as figure:
        plots = figure.subplots(rows, 2, sharex=True, sharey=True, squeeze=False).ravel()
        for axes in plots[len(question.spacings) :]:
            axes.set_visible(False)
        for axes, spacing in zip(plots[: len(question.spacings)], question.spacings, strict=True):
            z = np.array([[max(found[spacing, n, t], least) for n in numbers] for t in offsets])
            mesh = axes.pcolormesh(
                numbers, offsets, z, norm="log", vmin=least, vmax=most, cmap="viridis", shading="nearest"
            )
            bounds = sorted({100.0 * claim.bound for claim in question.claims})
            bounds = [bound for bound in bounds if np.min(z) < bound < np.max(z)]
            if bounds and min(z.shape) > 1:
                lines = axes.contour(numbers, offsets, z, levels=bounds, colors="white", linewidths=1.2)
                axes.clabel(lines, fmt=lambda value: f"{value:g} %")
            axes.set_title(spacing, loc="left")
            axes.set_xlabel("springs N")
            axes.set_ylabel("offset t, m")
        figure.colorbar(mesh, ax=plots.tolist(), label="largest relative error, %")
        caption = (
            f"Largest error along {question.axis}, relative to the {question.relative_to}; white: the claims' bounds."
        )
        return picture(figure, "errors", caption)


def _offset_points(compared: OffsetComparison, shown: Shown) -> Picture:
    """The curve, its exact offsets and the calculated points, in the manner of the paper's Fig. 5."""
    question = compared.question
    name = next(iter(question.spacings))
    distances = question.sign * np.array(shown.offsets)
    u = np.linspace(0.0, 1.0, 400)
    with canvas(4.6 * len(shown.numbers), 3.2) as figure:
        plots = figure.subplots(1, len(shown.numbers), sharey=True, squeeze=False)[0]
        for axes, n, points in zip(plots, shown.numbers, compared.shown, strict=True):
            axes.plot(*offset_curve(question.curve, u, 0.0).T, color="black", linewidth=1.4, label="curve")
            for place, (t, found) in enumerate(zip(distances, points, strict=True)):
                label = ("exact offset", "calculated") if place == 0 else (None, None)
                exact = offset_curve(question.curve, u, float(t))
                axes.plot(*exact.T, color=RED, linewidth=1.2, label=label[0])
                axes.plot(*found.T, "o", color=BLUE, markersize=5, markerfacecolor="none", label=label[1])
                axes.annotate(f"t = {abs(t):g}", exact[200], textcoords="offset points", xytext=(0, 7), ha="center")
            axes.set_aspect("equal", adjustable="box")
            axes.margins(0.08)
            axes.set_title(f"N = {n}", loc="left")
            axes.set_xlabel("x, m")
        plots[0].set_ylabel("y, m")
        figure.legend(*plots[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return picture(figure, "points", f"Offset points on the exact offset curves, spacing {name}.")
