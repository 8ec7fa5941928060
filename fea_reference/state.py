"""The unknowns, each as a number and the rest that its rounding left: twice the digits where they are needed.

======  =========================================================================
symbol  meaning
======  =========================================================================
u       unit round-off, half of machine precision
⊕, ⊗    sum and product as the machine rounds them
======  =========================================================================

An element's end force is 12 EI/h³ times the difference of its nodes' places, a contact's pressure ε times the
difference of two lengths.  Places that are rounded to u leave 12 u EI/h³ and ε u unbalanced, which no Newton step
can remove.  Kept as value + rest, places are known to u², and their differences to u times themselves.

The error of a rounded sum or product is itself a machine number (T. J. Dekker, Numer. Math. 18 (1971) 224;
D. E. Knuth, The Art of Computer Programming, vol. 2, §4.2.2): a + b = (a ⊕ b) + e and a b = (a ⊗ b) + e exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array, Ints

Complex = NDArray[np.complex128]
Numbers = TypeVar("Numbers", Array, Complex)

_SPLITTER = 2.0**27 + 1.0  # cuts 53 bits into two halves


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class State:
    """The unknowns ``values`` + ``rest``, both (size,); indexed, it gives the values.  Equal to itself only."""

    values: Array
    rest: Array

    @classmethod
    def of(cls, values: Array) -> State:
        """The state whose unknowns are these machine numbers (size,)."""
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
        """What the unknowns ``end`` are more than the unknowns ``start``, with all digits."""
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
    """Numbers of half the digits whose sum is a."""
    wide = _SPLITTER * a
    high = wide - (wide - a)
    return high, a - high
