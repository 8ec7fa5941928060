"""The least value of a function that is known by samples, refined between them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_REFINED = 5  # of the lowest samples, so that one a little higher may still hold the least value
_PLACE = 1e-12  # tolerance of a minimum's place


def least(function: Callable[[Array], Array], samples: Array) -> float:
    """The least value of a function (n,) -> (n,) near its lowest ``samples`` (n,), which ascend."""
    from scipy.optimize import minimize_scalar  # loaded when a curve is measured, not with every scene

    values = function(samples)
    fence = np.pad(values, 1, constant_values=np.inf)
    minima = np.flatnonzero((values <= fence[:-2]) & (values <= fence[2:]))
    found = [float(np.min(values))]
    for i in minima[np.argsort(values[minima], kind="stable")[:_REFINED]]:
        refined = minimize_scalar(
            lambda place: float(function(np.array([place]))[0]),
            bounds=(float(samples[max(i - 1, 0)]), float(samples[min(i + 1, len(samples) - 1)])),
            method="bounded",
            options={"xatol": _PLACE},
        )
        found.append(float(refined.fun))
    return min(found)
