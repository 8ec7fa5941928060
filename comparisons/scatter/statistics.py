"""Statistics of scattering numbers, with intervals of 95 % confidence.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
f       a number of the answer, a function of d independent parameters
Sᵢ      first-order index: the variance of the mean of f for a fixed parameter i, over the variance of f
Tᵢ      total-order index: the mean of the variance of f with all but parameter i fixed, over the variance of f
======  ==========================================================================================

Quantiles have the exact binomial interval of independent points; for scrambled Sobol points this interval is cautious.
Shares have Wilson's interval.  Indices are the estimates of Saltelli et al. (2010) in SciPy; their intervals come from
resampled rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from comparisons.sweeps.points import SEED
from cprbm_scene.answer import Array

LEVELS = (0.025, 0.5, 0.975)
"""Probabilities of the quantiles."""

_CONFIDENCE = 0.95
_RESAMPLES = 400
CONSTANT = 1e-9
"""Standard deviation below which a number is constant, over the largest magnitude of its unit: round-off of answers."""


class Interval(NamedTuple):
    """An estimate and the ends of its interval; NaN where the sample is too small for an end."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Indices:
    """First- and total-order indices by parameter."""

    first: tuple[Interval, ...]
    total: tuple[Interval, ...]


def quantiles(values: Array) -> tuple[Interval, ...]:
    """Quantiles of ``values`` (n,) at ``LEVELS``."""
    from scipy.stats import quantile_test

    found = []
    for level in LEVELS:
        ends = quantile_test(values, p=level).confidence_interval(_CONFIDENCE)
        found.append(Interval(float(np.quantile(values, level)), float(ends.low), float(ends.high)))
    return tuple(found)


def share(count: int, whole: int) -> Interval:
    """``count`` over ``whole``."""
    from scipy.stats import binomtest

    ends = binomtest(count, whole).proportion_ci(_CONFIDENCE, method="wilson")
    return Interval(count / whole, float(ends.low), float(ends.high))


def indices(values: Array) -> Indices:
    """Indices of d parameters.

    Args:
        values: (d + 2, n) values of f at A, B, AB₁, ... AB_d; n is a power of 2.
    """
    count = values.shape[1]
    rows = np.random.default_rng(SEED).integers(count, size=(_RESAMPLES, count))
    estimate = _estimates(values)
    low, high = np.quantile([_estimates(values[:, row]) for row in rows], [0.025, 0.975], axis=0)
    first, total = (
        tuple(map(Interval, *(each[order].tolist() for each in (estimate, low, high)))) for order in range(2)
    )
    return Indices(first, total)


def _estimates(values: Array) -> Array:
    """Estimates (2, d) of the first- and total-order indices."""
    from scipy.stats import sobol_indices

    functions = {"f_A": values[None, 0], "f_B": values[None, 1], "f_AB": values[2:, None]}
    found = sobol_indices(func=functions, n=values.shape[1])
    return np.array([found.first_order, found.total_order])
