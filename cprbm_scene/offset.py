"""Question of an offset curve: the places of points at a distance from a curve, without mechanics.

The question is a record beside :class:`~cprbm_scene.statement.Scene`; a file says ``question = "offset"``.
"""

from collections.abc import Iterator
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from cprbm_scene.curve_records import CurveField, shape_of
from cprbm_scene.curves import SAMPLES
from cprbm_scene.fields import Name, Named, Positive, PositiveLength, PositiveShare, Record, Text, Title
from cprbm_scene.mistakes import Mistake, broken

FEWEST, MOST = 4, 200
"""Allowed numbers of springs."""

_ACROSS = 1e-3
"""Least component of the curve's tangent along the other axis, over which the curve is a graph."""

Number = Annotated[int, Field(ge=FEWEST, le=MOST)]
Offsets = Annotated[tuple[PositiveLength, ...], Field(min_length=1, max_length=100)]
Numbers = Annotated[tuple[Number, ...], Field(min_length=1, max_length=100)]


class Spacing(Record):
    """Places of a chain's joints along a curve's variable (a polynomial's; for other curves the arc length).

    ``law`` is ``even``, or ``sine``: x = m + h sin φ with equally spaced φ from −π/2 to π/2, m and h middle and half of
    the range.  The law holds ``of`` the ``joints`` (both ends and every spring) or of the ends of the ``elements``,
    with the springs in the middles.
    """

    law: Literal["even", "sine"]
    of: Literal["joints", "elements"]


class OffsetClaim(Record):
    """Statement of a publication: from ``numbers_from`` springs on, every relative error is below ``bound``."""

    numbers_from: Number
    bound: Positive
    text: Text = ""


class Shown(Record):
    """Numbers of springs and offsets of the picture."""

    numbers: Numbers
    offsets: Offsets


class OffsetQuestion(Record):
    """Distance between the offset points of a chain and the exact offset curve.

    ``side`` is the side of the curve, seen from start to end.  The error is taken along ``axis``, at the offset point's
    place on the other axis, relative to the exact curve's ``ordinate`` (the coordinate along ``axis``) or to the
    ``offset``.  ``numbers`` are springs N; ``offsets`` distances t, m.  ``verdict_limit`` is the same as of a scene.
    """

    question: Literal["offset"]
    name: Name
    title: Title = ""
    source: Text = ""
    curve: CurveField
    side: Literal["left", "right"]
    axis: Literal["x", "y"] = "y"
    relative_to: Literal["ordinate", "offset"] = "ordinate"
    offsets: Offsets
    numbers: Numbers
    spacings: Annotated[Named[Spacing], Field(min_length=1)]
    claims: tuple[OffsetClaim, ...] = ()
    shown: Shown | None = None
    verdict_limit: PositiveShare = 0.015
    file: str = ""

    @property
    def sign(self) -> float:
        """+1 for an offset to the left, −1 to the right."""
        return 1.0 if self.side == "left" else -1.0

    def rules(self) -> Iterator[Mistake]:
        """Repeated values, claims on numbers without a run, and offset curves that are no graph over the other axis."""
        yield from broken(
            len(set(self.offsets)) < len(self.offsets) and Mistake("offsets", "a value twice", "each once"),
            len(set(self.numbers)) < len(self.numbers) and Mistake("numbers", "a value twice", "each once"),
            *(
                claim.numbers_from > max(self.numbers)
                and Mistake(
                    f"claims[{i}].numbers_from",
                    f"{claim.numbers_from}, beyond all numbers",
                    f"at most {max(self.numbers)}",
                )
                for i, claim in enumerate(self.claims)
            ),
        )
        u, shape = np.linspace(0.0, 1.0, SAMPLES), shape_of(self.curve)
        p, tangents = shape.point(u), shape.tangent(u)
        across = tangents[:, 0 if self.axis == "y" else 1]
        normals = self.sign * np.column_stack((-tangents[:, 1], tangents[:, 0]))
        places = [
            (f"{part}[{i}]", t)
            for part, own in (("offsets", self.offsets), ("shown.offsets", self.shown.offsets if self.shown else ()))
            for i, t in enumerate(own)
        ]
        parallel = bool(np.min(np.abs(across)) < _ACROSS or np.ptp(np.sign(across)) > 0.0)
        yield from broken(
            parallel and Mistake("axis", repr(self.axis), "an axis to which the curve is nowhere parallel"),
            # beyond the radius of curvature the offset curve runs backwards, with a cusp
            *(
                not parallel
                and np.min((np.diff(p + t * normals, axis=0) * tangents[:-1]).sum(axis=1)) <= 0.0
                and Mistake(key, f"{t:g}", "less than the radius of curvature on that side of the curve")
                for key, t in places
            ),
        )
