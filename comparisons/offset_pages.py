"""An offset comparison as tables and as the documented JSON."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from comparisons.documents import Plain, plain
from comparisons.formats import percent
from comparisons.offset_verdict import OffsetComparison, OffsetRow, claim_of_offset
from comparisons.sheet import Sheet

T = TypeVar("T")

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
        "rows": [
            {
                **_row(compared, row),
                "verdict": word.value if word else None,
            }
            for row, word in zip(compared.rows, compared.verdict.words, strict=True)
        ],
    }


def sheets_of(compared: OffsetComparison) -> tuple[Sheet, ...]:
    """The largest relative errors of the first spacing in short, and the claims for every spacing."""
    return (errors(compared), claims(compared))


def _row(compared: OffsetComparison, row: OffsetRow) -> Plain:
    claim = claim_of_offset(compared.question, row.n)
    met = None if claim is None or not np.isfinite(row.difference) else row.difference < claim.bound
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
        "claim_met": met,
    }


def errors(compared: OffsetComparison) -> Sheet:
    """The largest relative errors of the first spacing, at some N and t."""
    question = compared.question
    spacing = next(iter(question.spacings))
    numbers, offsets = _some(sorted(question.numbers)), _some(sorted(question.offsets))
    found = {(row.n, row.offset): row.difference for row in compared.rows if row.spacing == spacing}
    return Sheet(
        f"{question.title or question.name}: largest relative error, spacing {spacing}",
        ("N", *(f"t = {t:g}" for t in offsets)),
        tuple((str(n), *(percent(found[n, t]) for t in offsets)) for n in numbers),
        f"Of the offset points to the exact offset curve along {question.axis}, over the {question.relative_to}.",
    )


def claims(compared: OffsetComparison) -> Sheet:
    """What the source claims, beside what comes out here."""
    body = []
    for claim in compared.question.claims:
        for spacing in compared.question.spacings:
            rows = [row for row in compared.rows if row.spacing == spacing and row.n >= claim.numbers_from]
            worst = max(rows, key=lambda row: row.difference)
            over = [row.n for row in rows if not row.difference < claim.bound]
            body.append(
                (
                    claim.text or f"from N = {claim.numbers_from} on",
                    spacing,
                    percent(claim.bound),
                    percent(worst.difference),
                    f"{worst.n}, {worst.offset:g}",
                    percent(max(row.over_offset for row in rows)),
                    "met" if not over else "not met",
                    ", ".join(str(n) for n in sorted(set(over))) or "–",
                )
            )
    return Sheet(
        "Claims of the source",
        ("claim", "spacing", "theirs", "ours", "at N, t", "over t", "", "not met at N"),
        tuple(body),
        "They stand beside our figures and have no part in the verdict. N counts springs, and offset points; 'over t' "
        "is the largest error relative to the offset.",
    )


def _some(values: list[T]) -> list[T]:
    """At most six of them, first and last among them."""
    places = np.unique(np.linspace(0, len(values) - 1, min(_SHOWN, len(values))).round().astype(int))
    return [values[place] for place in places]
