"""The question of an offset curve: where points at a distance from a curve lie, without any mechanics.

It is a record beside :class:`~cprbm_scene.statement.Scene`; a file says ``question = "offset"`` to ask it.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cprbm_scene.statement import Curve, Fraction, Name, Named, Positive, Record

FEWEST, MOST = 4, 200
"""Springs that a question may ask for."""

Number = Annotated[int, Field(ge=FEWEST, le=MOST)]
Offsets = Annotated[tuple[Positive, ...], Field(min_length=1, max_length=100)]
Numbers = Annotated[tuple[Number, ...], Field(min_length=1, max_length=100)]


class Spacing(Record):
    """How a chain's joints are spread over a curve's variable (a polynomial's; of others the arc length).

    ``law`` is ``even``, or ``sine``: x = m + h sin φ with φ even from −π/2 to π/2, m and h middle and half of the
    range.  It holds ``of`` the ``joints`` (both ends and every spring) or of the ``elements``' ends, with the springs
    in the middles.
    """

    law: Literal["even", "sine"]
    of: Literal["joints", "elements"]


class OffsetClaim(Record):
    """What a publication says: from ``numbers_from`` springs on, every relative error is below ``bound``."""

    numbers_from: Number
    bound: Positive
    text: str = ""


class Shown(Record):
    """Numbers of springs and offsets of the picture."""

    numbers: Numbers
    offsets: Offsets


class OffsetQuestion(Record):
    """How near the offset points of a chain come to the exact offset curve.

    ``side`` is that of the curve as it runs.  The error is taken along ``axis``, at the offset point's place on the
    other axis, relative to the exact curve's ``ordinate`` (its coordinate along ``axis``) or to the ``offset``.
    ``numbers`` are springs N; ``offsets`` distances t, m.  ``verdict_limit`` is as of a scene.
    """

    question: Literal["offset"]
    name: Name
    title: str = ""
    source: str = ""
    curve: Curve
    side: Literal["left", "right"]
    axis: Literal["x", "y"] = "y"
    relative_to: Literal["ordinate", "offset"] = "ordinate"
    offsets: Offsets
    numbers: Numbers
    spacings: Annotated[Named[Spacing], Field(min_length=1)]
    claims: tuple[OffsetClaim, ...] = ()
    shown: Shown | None = None
    verdict_limit: Fraction = 0.015
    file: str = ""

    @property
    def sign(self) -> float:
        """+1 where the offset lies to the left, −1 to the right."""
        return 1.0 if self.side == "left" else -1.0
