"""Places of a beam's line one by one, in plain numbers.

A minimum is sought at one place or two, by steps that follow from each other.  Of so few, arrays cost ten times what
they hold.  The formulas are those of :mod:`cprbm.smooth`, :mod:`cprbm.excess` and :mod:`cprbm.kinks`, and a test holds
both against each other.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import NamedTuple

from cprbm.excess import Tabulated
from cprbm.kinks import polynomials
from cprbm.model import Kinks
from cprbm.smooth import STRAIGHT, SmoothLine

FEW = 4  # places, of which one after the other is sooner there than all at once


class Spot(NamedTuple):
    """A place: arc length ``s``, position ``x``, ``y``, tangent angle ``psi``, ``speed`` and ``bend``."""

    s: float
    x: float
    y: float
    psi: float
    speed: float
    bend: float


class Spots:
    """One beam's line in a state, bent as its kinks say; of a line whose excess is tabulated or nought."""

    def __init__(self, line: SmoothLine, kinks: Kinks) -> None:
        chain = line.chain
        self.breaks, self.end, self.arcs = chain.listed_breaks, float(chain.s[-1]), line.arcs
        self.excess = chain.excess.coefficients if isinstance(chain.excess, Tabulated) else None
        self.missed = polynomials(chain, kinks) if kinks.places.size else None

    def at(self, s: float) -> Spot:
        """The place at an arc length, beyond the ends the end itself."""
        s = min(max(s, 0.0), self.end)
        half = bisect_right(self.breaks, s)
        border, x, y, cos, sin, psi, rate, R = self.arcs[:, half].tolist()
        off = s - border
        turned = 0.5 * off * rate + STRAIGHT
        middle = complex(math.cos(turned), math.sin(turned))
        place = R * off * (middle.imag / turned) * middle
        if self.excess is None:
            speed, bend = R, rate
            psi += rate * off
        else:
            second, first, beside = _polynomial(self.excess[half].tolist(), off)
            arc = R * middle * middle
            first = arc + first * off
            turning = first.conjugate() * (1j * rate * arc + second)
            squared = first.real**2 + first.imag**2
            place += beside * off * off
            speed, bend = math.sqrt(squared), turning.imag / squared
            psi += math.atan2(first.imag, first.real)
        if self.missed is not None:
            mean, once, twice, thrice = self.missed[:, half].tolist()
            psi += ((thrice * off + twice) * off + once) * off + mean
            bend += (3.0 * thrice * off + 2.0 * twice) * off + once
        place *= complex(cos, sin)
        return Spot(s, x + place.real, y + place.imag, psi, speed, bend)


def _polynomial(coefficients: list[list[float]], off: float) -> tuple[complex, complex, complex]:
    """Three complex polynomials at ``off``, from real and imaginary parts of their coefficients, lowest power first."""
    a, b, c, d, e, f = coefficients[-1]
    for row in coefficients[-2::-1]:
        a, b, c = row[0] + off * a, row[1] + off * b, row[2] + off * c
        d, e, f = row[3] + off * d, row[4] + off * e, row[5] + off * f
    return complex(a, b), complex(c, d), complex(e, f)


def spots(line: SmoothLine, kinks: Kinks) -> Spots | None:
    """Those of a line; none where its stress-free curve has to be asked each time."""
    chain = line.chain
    return Spots(line, kinks) if chain.excess is None or isinstance(chain.excess, Tabulated) else None
