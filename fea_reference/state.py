"""The unknowns as unevaluated sums value + rest, with twice the digits where needed.

======  =========================================================================
symbol  meaning
======  =========================================================================
u       unit round-off, half of machine precision
⊕, ⊗    rounded sum and product
======  =========================================================================

An element's end force is 12 EI/h³ times a difference of nodal positions, a contact's pressure ε times a difference of
lengths. Positions rounded to u leave residuals of 12 u EI/h³ and ε u, beyond the reach of Newton's method. As value +
rest positions are accurate to u², and their differences to a relative u.

The error of a rounded sum or product is a machine number (T. J. Dekker, Numer. Math. 18 (1971) 224; D. E. Knuth, The
Art of Computer Programming, vol. 2, §4.2.2): a + b = (a ⊕ b) + e and a b = (a ⊗ b) + e exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array, Ints

Complex = NDArray[np.complex128]
Numbers = TypeVar("Numbers", Array, Complex)

_SPLITTER = 2.0**27 + 1.0  # splits 53 bits into two halves


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class State:
    """The unknowns ``values`` + ``rest``, (size,) both; indexing gives the values. Equality is identity."""

    values: Array
    rest: Array

    @classmethod
    def of(cls, values: Array) -> State:
        """The state with machine numbers (size,) as unknowns."""
        return cls(values, np.zeros_like(values))

    @overload
    def __getitem__(self, dofs: np.int64) -> float: ...

    @overload
    def __getitem__(self, dofs: Ints) -> Array: ...

    def __getitem__(self, dofs: Ints | np.int64) -> Array | float:
        return self.values[dofs]

    def moved(self, step: Array) -> State:
        """The state with ``step`` (size,) added."""
        return State(*summed(self.values, self.rest + step))

    def difference(self, end: Ints, start: Ints) -> Array:
        """Unknowns ``end`` minus unknowns ``start``, without cancellation."""
        value, error = summed(self.values[end], -self.values[start])
        return np.asarray(value + (error + (self.rest[end] - self.rest[start])))


def summed(a: Numbers, b: Numbers) -> tuple[Numbers, Numbers]:
    """a ⊕ b and its error."""
    value = a + b
    shift = value - a
    return value, (a - (value - shift)) + (b - shift)


def multiplied(a: Array, b: Array) -> tuple[Array, Array]:
    """a ⊗ b and its error."""
    value = np.asarray(a * b)
    (high, low), (high_b, low_b) = _halves(a), _halves(b)
    return value, ((high * high_b - value) + high * low_b + low * high_b) + low * low_b


def squared(a: Array) -> tuple[Array, Array]:
    """a ⊗ a and its error."""
    value = np.asarray(a * a)
    high, low = _halves(a)
    return value, ((high * high - value) + 2.0 * (high * low)) + low * low


def _halves(a: Array) -> tuple[Array, Array]:
    """High and low half of a, with the exact sum a."""
    wide = _SPLITTER * a
    high = wide - (wide - a)
    return high, a - high
