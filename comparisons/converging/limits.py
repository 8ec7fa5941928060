"""How a number goes with N: observed order, limit, and how far each N is from it.

==========  ==============================================================================================
symbol      meaning
==========  ==============================================================================================
N_i, v_i    sizes, ascending, and the values there, (k,): a vector's components converge together
p           the order that theory gives
q           the order of the values; v = V + C N^−q to leading order
d_i         v_i − v_(i−1), and r_i = N_i/N_(i−1)
V_i         v_i + d_i/(r_i^p − 1), the extrapolation of the two sizes i − 1 and i (Richardson)
U           uncertainty of V_m, m the finest: S · max(k |V_m − V_(m−1)|, |V_(m−1) − V_(m−2)|/r_m^p) + f
k           |V_m − V| / |V_m − V_(m−1)| of values of order 1; 1 for sizes that double
S           safety factor, 1.25
f           what round-off leaves open
==========  ==============================================================================================

The observed order of three sizes solves  |d_(i+1)|/|d_i| = (N_i^−q − N_(i+1)^−q)/(N_(i−1)^−q − N_i^−q), whose right
side falls with q.  There is none where a change is round-off, or where the second of the two changes goes back on the
first.

Why U is honest where theory is not: with constant r and values of some other order q,

    V_m − V_(m−1) = d_m (r^p − r^q)/(r^p − 1),      V − V_m = d_m (r^p − r^q)/((r^p − 1)(r^q − 1)),

so that the error of the extrapolation is the last step between two of them over r^q − 1, whatever p was taken for q:
for r = 2 no more than that step for every q from 1 on, and a third of it for q = 2.  k says the same of sizes that
do not double.  Two extrapolations may meet by accident; so the step before, reduced by what it must have fallen
since, counts as well.

Theory may promise more than 2 where a kink, a penalty or a place of contact between nodes keeps the values from it.
Since U is honest for either, the limit is taken with p or with 2, whichever U is the smaller: with the order that the
values bear out.

Of two sizes alone there is no second extrapolation, and nothing but theory says what the order is: U is then the whole
correction |d/(r^p − 1)|.

Sources: P. J. Roache, *Verification and Validation in Computational Science and Engineering* (1998), chapter 5, whose
safety factor for three and more sizes is 1.25; L. Eça and M. Hoekstra, *J. Comput. Phys.* 262 (2014) 104-130, for
taking the theoretical order and widening the uncertainty where the observed one departs from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from cprbm_scene.answer import Array

SAFETY = 1.25
COMMON = 2.0
"""The order that is tried beside a higher one."""
_LEAST, _HIGHEST = 0.999, 16.0
"""The least order that U provides for, beside which 1 is another; none is looked for beyond the highest."""


@dataclass(frozen=True, slots=True)
class Limit:
    """Where a sequence of values goes.

    Attributes:
        value: the extrapolated value, (k,).
        uncertainty: how far from it the true limit may be, (k,), in the values' unit.
        assumed: the order of the extrapolation.
        order: observed at the three finest sizes, by the norms of the changes; None where there is none.
        why: why there is no order; empty where there is one.
    """

    value: Array
    uncertainty: Array
    assumed: float
    order: float | None
    why: str

    def errors(self, values: Array) -> Array:
        """How far ``values`` (m, k) may be from the true limit: |v − V| + U, (m, k)."""
        return np.asarray(np.abs(values - self.value) + self.uncertainty)


def limit(ns: Sequence[int], values: Array, order: float, floor: float = 0.0) -> Limit:
    """The limit of values that converge with N.

    Args:
        ns: N, at least two, strictly ascending.
        values: (m, k) or (m,), at each N.
        order: p, what theory gives, positive.
        floor: f, what round-off leaves open, in the values' unit.

    Raises:
        ValueError: fewer than two sizes, sizes that do not ascend, not as many values as sizes, a value that is not
            finite, or an order that is not positive.
    """
    n, v = _checked(ns, values)
    if not order > 0.0:
        raise ValueError(f"an order of {order:g}; it must be positive")
    if len(n) == 2:
        correction = np.diff(v, axis=0)[-1] / ((n[1] / n[0]) ** order - 1.0)
        return Limit(v[-1] + correction, np.abs(correction) + floor, order, None, "two sizes show no order")
    found, why = observed(ns[-3:], v[-3:], floor)
    candidates = [(p, *_extrapolated(n, v, p)) for p in dict.fromkeys((order, min(order, COMMON)))]
    p, value, uncertainty = min(candidates, key=lambda one: float(np.linalg.norm(one[2])))
    return Limit(value, uncertainty + floor, p, found, why)


def _extrapolated(n: Array, v: Array, p: float) -> tuple[Array, Array]:
    """V_m and U without f, (k,) each, of three sizes or more."""
    d = np.diff(v, axis=0)
    r = n[1:] / n[:-1]
    extrapolated = v[1:] + d / (r**p - 1.0)[:, None]
    steps = np.abs(np.diff(extrapolated, axis=0))
    # what the extrapolations leave of C N^−q, C = 1
    before, last = (n[1:] ** -_LEAST * (1.0 - (r**_LEAST - 1.0) / (r**p - 1.0)))[-2:]
    uncertainty = steps[-1] * abs(last / (last - before))
    if len(steps) > 1:
        uncertainty = np.maximum(uncertainty, steps[-2] / r[-1] ** p)
    return extrapolated[-1], SAFETY * uncertainty


def orders(ns: Sequence[int], values: Array, floor: float = 0.0) -> tuple[float | None, ...]:
    """The observed order of every three sizes that follow each other, with the arguments of :func:`limit`."""
    return tuple(observed(ns[i : i + 3], values[i : i + 3], floor)[0] for i in range(len(ns) - 2))


def observed(ns: Sequence[int], values: Array, floor: float = 0.0) -> tuple[float | None, str]:
    """The observed order of three sizes, by the norms of the changes; or None, and why.

    Args:
        ns: three N, strictly ascending.
        values: (3, k) or (3,), at each N.
        floor: a change no larger than this is round-off, in the values' unit.

    Raises:
        ValueError: as :func:`limit`, or not three sizes.
    """
    n, v = _checked(ns, values)
    if len(n) != 3:
        raise ValueError(f"{len(n)} sizes; an order is observed at three")
    first, second = np.diff(v, axis=0)
    sizes = np.linalg.norm(first), np.linalg.norm(second)
    if min(sizes) <= floor:
        return None, "the change is round-off"
    if np.dot(first, second) <= 0.0:
        return None, "the change turns back"
    share = sizes[1] / sizes[0]
    h = n[0] / n  # so that no power of a large N is too small a number

    def residual(q: float) -> float:
        return float((h[1] ** q - h[2] ** q) / (h[0] ** q - h[1] ** q) - share)

    if residual(1e-6) <= 0.0:
        return None, "the change does not fall"
    if residual(_HIGHEST) >= 0.0:
        return None, "the change falls faster than any order"
    return float(brentq(residual, 1e-6, _HIGHEST, xtol=1e-9)), ""


def _checked(ns: Sequence[int], values: Array) -> tuple[Array, Array]:
    n = np.array(ns, dtype=float)
    v = np.array(values, dtype=float)
    if len(n) < 2 or np.any(np.diff(n) <= 0.0) or n[0] <= 0.0:
        raise ValueError(f"sizes {list(ns)}; they must be two or more and ascend")
    if v.shape[:1] != n.shape or not np.all(np.isfinite(v)):
        raise ValueError(f"values of the shape {v.shape} at {len(n)} sizes; each must be there and finite")
    return n, v.reshape(len(n), -1)
