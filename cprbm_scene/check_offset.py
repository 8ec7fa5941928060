"""What ties an offset question together: a curve that exists, whose offsets are graphs over the other axis."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cprbm_scene.check_shapes import wrong_curve
from cprbm_scene.geometry import points_on, tangents_on
from cprbm_scene.mistakes import Mistake
from cprbm_scene.offset import OffsetQuestion

_SAMPLES = 2001
_ACROSS = 1e-3  # least |cos| between the curve and the axis that it is a graph over


def mistakes_in_offset(question: OffsetQuestion) -> list[Mistake]:
    """Every mistake in what ties the records of ``question`` together."""
    return [replace(mistake, file=question.file) for mistake in _mistakes(question)]


def _mistakes(question: OffsetQuestion) -> Iterator[Mistake]:
    for key, values in (("offsets", question.offsets), ("numbers", question.numbers)):
        if len(set(values)) < len(values):
            yield Mistake(key, "a value twice", "each once")
    for i, claim in enumerate(question.claims):
        if claim.numbers_from > max(question.numbers):
            found = f"{claim.numbers_from}, beyond all numbers"
            yield Mistake(f"claims[{i}].numbers_from", found, f"at most {max(question.numbers)}")
    wrong = wrong_curve("curve", question.curve)
    if wrong is not None:
        yield wrong
        return
    u = np.linspace(0.0, 1.0, _SAMPLES)
    p, tangents = points_on(question.curve, u), tangents_on(question.curve, u)
    graph = tangents[:, 0 if question.axis == "y" else 1]
    if np.min(np.abs(graph)) < _ACROSS or np.ptp(np.sign(graph)) > 0.0:
        yield Mistake("axis", repr(question.axis), "an axis to which the curve is nowhere parallel")
        return
    normals = question.sign * np.column_stack((-tangents[:, 1], tangents[:, 0]))
    for key, offsets in (("offsets", question.offsets), ("shown.offsets", question.shown and question.shown.offsets)):
        for i, t in enumerate(offsets or ()):
            # where the offset is more than the radius of curvature it runs backwards: it has a cusp
            forwards = (np.diff(p + t * normals, axis=0) * tangents[:-1]).sum(axis=1)
            if np.min(forwards) <= 0.0:
                yield Mistake(f"{key}[{i}]", f"{t:g}", "less than the radius of curvature on that side of the curve")
