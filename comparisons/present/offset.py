"""Tables, figures and documented JSON of an offset comparison."""

from collections.abc import Iterable, Sequence

import numpy as np

from comparisons.formats import number, percent
from comparisons.geometry import offset_curve
from comparisons.offset_verdict import OffsetComparison, OffsetRow, claim_of_offset
from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Column, Figure, Plain, Section, Table, plain, table_of
from cprbm_scene.offset import Shown

_SHOWN = 6  # columns and rows of the short table


def document(compared: OffsetComparison) -> Plain:
    """One case of ``compare``; ``station`` is the offset t in metres, ``difference`` a fraction."""
    return {
        "case": compared.question.name,
        "verdict": compared.verdict.word.value,
        "sentence": compared.verdict.sentence,
        "solvers": {
            name: {"ending": "COMPLETED", "seconds": seconds, "settings": {}, "certificate": None}
            for name, seconds in compared.seconds.items()
        },
        "rows": [_row(compared, row) for row in compared.rows],
    }


def _row(compared: OffsetComparison, row: OffsetRow) -> Plain:
    claim = claim_of_offset(compared.question, row.n)
    return {
        "probe": f"{row.spacing}.offset_points",
        "stage": f"N = {row.n}",
        "station": row.offset,
        "unit": "1",
        "difference": plain(row.difference),
        "difference_over_offset": plain(row.over_offset),
        "uncertainty": {"cprbm": plain(float(np.max(row.stated))), "round_off": plain(float(np.max(row.round_off)))},
        "pressure": plain(row.pressure),
        "claim": None if claim is None else claim.bound,
        "claim_met": None if claim is None or not np.isfinite(row.difference) else row.difference < claim.bound,
        "verdict": row.word.value,
    }


def offset_sections(compared: OffsetComparison, figures: Sequence[Figure] = ()) -> tuple[Section, ...]:
    """Errors with the figures, and claims; run times stand last."""
    seconds = [Column[tuple[str, float]]("answer", lambda at: at[0]), Column("seconds", lambda at: at[1], number)]
    note = "From the question to all points, by this machine's clock."
    return (
        Section("Errors against the exact offset curve", (), tuple(figures), (error_table(compared),)),
        Section("What the source claims", tables=(_claims_table(compared),)),
        Section("Run time", tables=(table_of("Seconds", seconds, compared.seconds.items(), note),)),
    )


def error_table(compared: OffsetComparison) -> Table:
    """The largest relative errors of the first spacing, at some N and t."""
    question = compared.question
    spacing, offsets = next(iter(question.spacings)), _some(question.offsets)
    found = {(row.n, row.offset): row.difference for row in compared.rows if row.spacing == spacing}
    return Table(
        f"{question.title or question.name}: largest relative error, spacing {spacing}",
        ("N", *(f"t = {t:g}" for t in offsets)),
        tuple((f"{n:g}", *(percent(found[int(n), t]) for t in offsets)) for n in _some(question.numbers)),
        f"Of the offset points to the exact offset curve along {question.axis}, over the {question.relative_to}.",
    )


def claim_rows(compared: OffsetComparison) -> list[tuple[str, ...]]:
    """Claims with their spacings, bounds, largest errors, places and findings."""
    rows = _claims_table(compared).rows
    return [
        (f"{claim}, spacing {spacing}", bound, largest, at, met)
        for claim, spacing, bound, largest, at, _, met, *_ in rows
    ]


def _claims_table(compared: OffsetComparison) -> Table:
    """Claims of the source beside the largest errors found here."""
    standings = []
    for claim in compared.question.claims:
        for spacing in compared.question.spacings:
            rows = [row for row in compared.rows if row.spacing == spacing and row.n >= claim.numbers_from]
            worst, over = max(rows, key=lambda row: row.difference), max(row.over_offset for row in rows)
            missed = sorted({row.n for row in rows if not row.difference < claim.bound})
            standings.append({"claim": claim, "spacing": spacing, "worst": worst, "over": over, "missed": missed})
    columns = [
        Column[Plain]("claim", "claim", lambda claim: claim.text or f"from N = {claim.numbers_from} on"),
        Column("spacing", "spacing"),
        Column("source", "claim.bound", percent),
        Column("largest here", "worst.difference", percent),
        Column("at", "worst", lambda row: f"N, t = {row.n}, {row.offset:g}"),
        Column("over t", "over", percent),
        Column("", "missed", lambda missed: "not met" if missed else "met"),
        Column("not met at N", lambda at: ", ".join(map(str, at["missed"])) or None),
    ]
    return table_of(
        "Claims of the source",
        columns,
        standings,
        "Claims take no part in the verdict. N counts springs, and offset points; 'over t' is the largest error "
        "relative to the offset.",
    )


def _some(values: Iterable[float]) -> list[float]:
    """At most ``_SHOWN`` ascending values, first and last among them."""
    ascending = sorted(values)
    places = np.unique(np.linspace(0, len(ascending) - 1, min(_SHOWN, len(ascending))).round().astype(int))
    return [ascending[place] for place in places]


def offset_figures(compared: OffsetComparison) -> tuple[Figure, ...]:
    """The largest relative errors over N and t, and the offset points on the exact curves."""
    shown = compared.question.shown
    return (_errors(compared), *(() if shown is None else (_points(compared, shown),)))


def _errors(compared: OffsetComparison) -> Figure:
    """A map per spacing, in the manner of the paper's Fig. 6."""
    question, spacings = compared.question, compared.question.spacings
    numbers, offsets = sorted(question.numbers), sorted(question.offsets)
    found = {(row.spacing, row.n, row.offset): 100.0 * row.difference for row in compared.rows}
    positive = [value for value in found.values() if value > 0.0] or [1.0]
    least, most = 10.0 ** np.floor(np.log10(min(positive))), 10.0 ** np.ceil(np.log10(max(positive)))
    with canvas(5.2, 2.6 * len(spacings), len(spacings), shared="xy") as (drawing, plots):
        for axes, spacing in zip(plots, spacings, strict=True):
            z = np.array([[max(found[spacing, n, t], least) for n in numbers] for t in offsets])
            mesh = axes.pcolormesh(
                numbers, offsets, z, norm="log", vmin=least, vmax=most, shading="nearest", rasterized=True
            )
            bounds = sorted({bound for claim in question.claims if z.min() < (bound := 100.0 * claim.bound) < z.max()})
            if bounds and min(z.shape) > 1:
                lines = axes.contour(numbers, offsets, z, levels=bounds, colors="white", linewidths=1.2)
                axes.clabel(lines, fmt=lambda value: f"{value:g} %")
            axes.set(title=spacing, ylabel="offset t, m")
        plots[-1].set_xlabel("springs N")
        drawing.colorbar(mesh, ax=[*plots], label="largest relative error, %")
        caption = f"Largest error along {question.axis}, relative to the {question.relative_to}"
        return finished(drawing, "errors", f"{caption}; white: the claims' bounds.")


def _points(compared: OffsetComparison, shown: Shown) -> Figure:
    """The curve, its exact offsets and the calculated points, in the manner of the paper's Fig. 5."""
    question, u = compared.question, np.linspace(0.0, 1.0, 400)
    with canvas(5.2, 3.0 * len(shown.numbers), len(shown.numbers), shared="x") as (drawing, plots):
        for axes, n, points in zip(plots, shown.numbers, compared.shown, strict=True):
            axes.plot(*offset_curve(question.curve, u, 0.0).T, color="black", linewidth=1.4, label="curve")
            for t, found in zip(shown.offsets, points, strict=True):
                exact = offset_curve(question.curve, u, float(question.sign * t))
                axes.plot(*exact.T, color=RED, linewidth=1.2, label="exact offset")
                axes.plot(*found.T, "o", color=BLUE, markersize=5, markerfacecolor="none", label="calculated")
                axes.annotate(f"t = {abs(t):g}", exact[200], textcoords="offset points", xytext=(0, 7), ha="center")
            axes.margins(0.08)
            axes.set(title=f"N = {n}", ylabel="y, m", aspect="equal")
        plots[-1].set_xlabel("x, m")
        caption = f"Offset points on the exact offset curves, spacing {next(iter(question.spacings))}."
        return finished(drawing, "points", caption, ("lower center", 3))
