"""An offset question: offset points of a chain beside the exact offset curve, verdict, tables, figures and JSON.

======  ==========================================================================================
o_i     calculated ordinate of the offset point i; e_i the exact curve's at the same place
d_i     |o_i − e_i| over |e_i| or over t, as the question says
u_i     1.25 times the construction's own estimate of its distance from the curve, taken along the
        axis of the ordinate: the chain's largest, over the same
r_i     round-off of coordinates and offset, over the same
======  ==========================================================================================

A row (a spacing, N and t) differs where at some point d_i > u_i + r_i, is undecided where no point does but a sum is
more than the verdict limit (or a point lies beyond the exact curve's ends), and agrees otherwise.
"""

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from comparisons.case import Comparison, Verdict
from comparisons.formats import number, percent
from comparisons.geometry import offset_curve, ordinates
from comparisons.pairing import OffsetConstruction, Offsets, cprbm_offset_points
from comparisons.present.canvas import BLUE, RED, canvas, finished
from comparisons.present.columns import Column, Figure, Plain, Section, Table, plain, table_of
from comparisons.verdict import SAFETY, Word, first_met, worst_of
from cprbm_scene import Array, OffsetClaim, OffsetQuestion, frozendict
from cprbm_scene.offset import Shown

_SHOWN = 6  # columns and rows of the short table
_ROUND_OFF = 64.0 * float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class OffsetRow:
    """All offset points of a chain at a distance.

    Attributes:
        spacing: its name in the question.
        n: springs, and points.
        offset: t, m.
        differences, stated, round_off: d_i, u_i and r_i, (n,).
        over_offset: the largest |o_i − e_i| over t, whatever the question says.
        limit: the verdict limit of the question.
    """

    spacing: str
    n: int
    offset: float
    differences: Array
    stated: Array
    round_off: Array
    over_offset: float
    limit: float

    @property
    def total(self) -> Array:
        """u_i + r_i, (n,)."""
        return self.stated + self.round_off

    @property
    def difference(self) -> float:
        """The largest d_i; NaN where a point has no exact ordinate."""
        return float(np.max(self.differences))

    @property
    def pressure(self) -> float:
        """The largest d_i/(u_i + r_i)."""
        return float(np.max(self.differences / self.total))

    @property
    def word(self) -> Word:
        """The verdict on the row."""
        rules = (
            (not np.all(np.isfinite(self.differences)), Word.UNDECIDED),
            (self.pressure > 1.0, Word.DIFFER),
            (bool(np.max(self.total) > self.limit), Word.UNDECIDED),
        )
        return first_met(rules, Word.AGREE)


@dataclass(frozen=True, slots=True)
class OffsetComparison:
    """An offset question, its rows and the verdict.

    Attributes:
        seconds: of the two routes.
        shown: the calculated points of the first spacing at the numbers and offsets to be shown, (k, n, 2), m, each.
    """

    question: OffsetQuestion
    rows: tuple[OffsetRow, ...]
    verdict: Verdict
    seconds: Mapping[str, float]
    shown: tuple[Array, ...]

    @property
    def pressures(self) -> list[float]:
        """Differences of the rows over their stated uncertainties."""
        return [row.pressure for row in self.rows]


Compared = Comparison | OffsetComparison
"""Comparison of a scene or of an offset question."""


def compared_offset(question: OffsetQuestion, construct: OffsetConstruction = cprbm_offset_points) -> OffsetComparison:
    """Both routes for every spacing, N and t of a question."""
    distances, graph = question.sign * np.array(question.offsets), 0 if question.axis == "y" else 1
    chains = [(name, n) for name in question.spacings for n in question.numbers]
    begun = time.perf_counter()
    found = [construct(question.curve, question.spacings[name], n, distances) for name, n in chains]
    between = time.perf_counter()
    places = np.concatenate([each.points[..., graph] for each in found], axis=1)  # (k, all points)
    exact = np.stack(
        [ordinates(question.curve, *at, along_x=graph == 0) for at in zip(places, distances.tolist(), strict=True)]
    )
    seconds = {"cprbm": between - begun, "exact": time.perf_counter() - between}
    parts = np.split(exact, np.cumsum([n for _, n in chains])[:-1], axis=1)
    rows = tuple(
        row
        for (name, _), each, part in zip(chains, found, parts, strict=True)
        for row in _rows(question, name, each, part)
    )
    return OffsetComparison(question, rows, _judged(question, rows), frozendict(seconds), _shown(question, construct))


def claim_of_offset(question: OffsetQuestion, n: int) -> OffsetClaim | None:
    """The strictest claim about a chain of ``n`` springs."""
    return min(
        (claim for claim in question.claims if n >= claim.numbers_from), key=lambda claim: claim.bound, default=None
    )


def _rows(question: OffsetQuestion, name: str, found: Offsets, exact: Array) -> Iterator[OffsetRow]:
    """The rows of a chain, with exact ordinates (k, n) at the k offsets of the question."""
    tilt = np.abs(np.cos(found.tangents) if question.axis == "y" else np.sin(found.tangents))
    for t, points, off_curve, o in zip(question.offsets, found.points, found.off_curve, exact, strict=True):
        apart = np.abs(points[:, 1 if question.axis == "y" else 0] - o)
        over = np.full(len(o), t) if question.relative_to == "offset" else np.abs(o)
        yield OffsetRow(
            name,
            len(o),
            t,
            differences=apart / over,
            stated=SAFETY * np.max(off_curve / tilt) / over,
            round_off=_ROUND_OFF * (np.max(np.abs(points)) + t) / tilt / over,
            over_offset=float(np.max(apart)) / t,
            limit=question.verdict_limit,
        )


def _shown(question: OffsetQuestion, construct: OffsetConstruction) -> tuple[Array, ...]:
    if question.shown is None:
        return ()
    spacing, distances = next(iter(question.spacings.values())), question.sign * np.array(question.shown.offsets)
    return tuple(construct(question.curve, spacing, n, distances).points for n in question.shown.numbers)


def _judged(question: OffsetQuestion, rows: Sequence[OffsetRow]) -> Verdict:
    """The worst word of all rows, with the row that decides."""
    word = worst_of(row.word for row in rows) or Word.UNDECIDED
    mine = [row for row in rows if row.word is word]
    row = max(mine, key=lambda row: row.pressure if np.isfinite(row.pressure) else np.inf)
    largest, i = max(float(np.max(row.stated)) for row in mine), int(np.argmax(row.differences / row.total))
    limit = percent(question.verdict_limit)
    rules = (
        (not np.isfinite(row.pressure), "some offset point lies beyond the ends of the exact curve"),
        (word is Word.UNDECIDED, f"the stated uncertainty reaches {percent(largest)}, more than {limit}"),
    )
    cause = first_met(rules, f"{percent(row.differences[i])} against a stated {percent(row.total[i])}")
    beginning = {
        Word.AGREE: f"All {len(rows)} rows agree; the closest call is",
        Word.DIFFER: f"{len(mine)} of {len(rows)} rows differ, most of all",
        Word.UNDECIDED: f"{len(mine)} of {len(rows)} rows are undecided, first of all",
    }
    sentence = f"{beginning[word]} {row.spacing} at N = {row.n}, t = {row.offset:g}: {cause}."
    return Verdict(word, (sentence,), completed=all(np.isfinite(each.difference) for each in rows))


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
    return (
        Section("Errors against the exact offset curve", (), tuple(figures), (error_table(compared),)),
        Section("What the source claims", tables=(_claims_table(compared),)),
        Section(
            "Run time",
            tables=(
                table_of(
                    "Seconds",
                    seconds,
                    compared.seconds.items(),
                    note="From the question to all points, by this machine's clock.",
                ),
            ),
        ),
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
    return [
        (f"{claim}, spacing {spacing}", bound, largest, at, met)
        for claim, spacing, bound, largest, at, _, met, *_ in _claims_table(compared).rows
    ]


def _claims_table(compared: OffsetComparison) -> Table:
    """Claims of the source beside the largest errors found here."""
    question = compared.question
    groups = [
        (claim, spacing, [row for row in compared.rows if row.spacing == spacing and row.n >= claim.numbers_from])
        for claim in question.claims
        for spacing in question.spacings
    ]
    standings = [
        {
            "claim": claim,
            "spacing": spacing,
            "worst": max(rows, key=lambda row: row.difference),
            "over": max(row.over_offset for row in rows),
            "missed": ", ".join(map(str, sorted({row.n for row in rows if not row.difference < claim.bound}))) or None,
        }
        for claim, spacing, rows in groups
    ]
    return table_of(
        "Claims of the source",
        columns=[
            Column[Plain]("claim", "claim", lambda claim: claim.text or f"from N = {claim.numbers_from} on"),
            Column("spacing", "spacing"),
            Column("source", "claim.bound", percent),
            Column("largest here", "worst.difference", percent),
            Column("at", "worst", lambda row: f"N, t = {row.n}, {row.offset:g}"),
            Column("over t", "over", percent),
            Column("", lambda at: "not met" if at["missed"] else "met"),
            Column("not met at N", "missed"),
        ],
        items=standings,
        note="Claims take no part in the verdict. N counts springs, and offset points; 'over t' is the largest error "
        "relative to the offset.",
    )


def _some(values: Iterable[float]) -> list[float]:
    """At most ``_SHOWN`` ascending values, first and last among them."""
    ascending = sorted(values)
    places = np.unique(np.linspace(0, len(ascending) - 1, min(_SHOWN, len(ascending))).round().astype(int))
    return [ascending[place] for place in places]


def offset_figures(compared: OffsetComparison) -> tuple[Figure, ...]:
    """The largest relative errors over N and t, and the offset points on the exact curves."""
    return _errors(compared), *(_points(compared, shown) for shown in (compared.question.shown,) if shown)


def _errors(compared: OffsetComparison) -> Figure:
    """A map per spacing, in the manner of the paper's Fig. 6."""
    question, spacings = compared.question, compared.question.spacings
    numbers, offsets = sorted(question.numbers), sorted(question.offsets)
    found = {(row.spacing, row.n, row.offset): 100.0 * row.difference for row in compared.rows}
    maps = {spacing: np.array([[found[spacing, n, t] for n in numbers] for t in offsets]) for spacing in spacings}
    positive = [value for value in found.values() if value > 0.0] or [1.0]
    least, most = 10.0 ** np.floor(np.log10(min(positive))), 10.0 ** np.ceil(np.log10(max(positive)))
    with canvas(5.2, 2.6 * len(spacings), len(spacings), shared="xy") as (drawing, plots):
        for axes, (spacing, errors) in zip(plots, maps.items(), strict=True):
            z = np.maximum(errors, least)
            mesh = axes.pcolormesh(
                numbers, offsets, z, norm="log", vmin=least, vmax=most, shading="nearest", rasterized=True
            )
            bounds = sorted({bound for claim in question.claims if z.min() < (bound := 100.0 * claim.bound) < z.max()})
            if bounds and min(z.shape) > 1:
                lines = axes.contour(numbers, offsets, z, levels=bounds, colors="white", linewidths=1.2)
                axes.clabel(lines, fmt="%g %%")
            axes.set(title=spacing, ylabel="offset t, m")
        plots[-1].set_xlabel("springs N")
        drawing.colorbar(mesh, ax=[*plots], label="largest relative error, %")
        caption = f"Largest error along {question.axis}, relative to the {question.relative_to}"
        return finished(drawing, "errors", f"{caption}; white: the claims' bounds.")


def _points(compared: OffsetComparison, shown: Shown) -> Figure:
    """The curve, its exact offsets and the calculated points, in the manner of the paper's Fig. 5."""
    question, u = compared.question, np.linspace(0.0, 1.0, 400)
    curve, *exact = (offset_curve(question.curve, u, question.sign * t) for t in (0.0, *shown.offsets))
    with canvas(5.2, 3.0 * len(shown.numbers), len(shown.numbers), shared="x") as (drawing, plots):
        for axes, n, points in zip(plots, shown.numbers, compared.shown, strict=True):
            axes.plot(*curve.T, color="black", linewidth=1.4, label="curve")
            for t, line, found in zip(shown.offsets, exact, points, strict=True):
                axes.plot(*line.T, color=RED, linewidth=1.2, label="exact offset")
                axes.plot(*found.T, "o", color=BLUE, markersize=5, markerfacecolor="none", label="calculated")
                axes.annotate(f"t = {abs(t):g}", line[200], textcoords="offset points", xytext=(0, 7), ha="center")
            axes.margins(0.08)
            axes.set(title=f"N = {n}", ylabel="y, m", aspect="equal")
        plots[-1].set_xlabel("x, m")
        return finished(
            drawing,
            "points",
            caption=f"Offset points on the exact offset curves, spacing {next(iter(question.spacings))}.",
            legend=("lower center", 3),
        )
