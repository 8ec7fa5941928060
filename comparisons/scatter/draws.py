"""Points drawn from the distributions of parameters: scrambled Sobol points.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
d, n    number of parameters, and number of points in a sample, a power of 2
A, B    two independent samples (n, d): the columns of a Sobol sequence in 2 d dimensions
ABᵢ     the sample A with column i of B, for the indices of parameter i
======  ==========================================================================================

Source of the design: Saltelli et al., Computer Physics Communications 181 (2010) 259-270.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

import numpy as np

from comparisons.sweeps.points import SEED
from cprbm_scene import Mistake, Scene, SceneError
from cprbm_scene.answer import Array

_EDGE = 2.0**-32
"""Distance of a share from 0 and 1, where a normal distribution is infinite; Sobol points have 30 bits."""


class Distribution(Protocol):
    """Distribution of a parameter, such as a frozen distribution of :mod:`scipy.stats`."""

    def ppf(self, q: Array) -> Array:
        """Values, SI, below which the parameter lies with the probabilities ``q``."""


def distributions_of(scene: Scene) -> dict[str, Distribution]:
    """Distributions of the parameters with a tolerance.

    Raises:
        SceneError: no parameter has a tolerance.
    """
    from scipy.stats import norm, uniform

    found: dict[str, Distribution] = {}
    for name, parameter in scene.parameters.items():
        scatter = parameter.tolerance
        if scatter is not None and scatter.normal is not None:
            found[name] = norm(parameter.value, scatter.normal)
        elif scatter is not None and scatter.uniform is not None:
            found[name] = uniform(parameter.value - scatter.uniform, 2.0 * scatter.uniform)
    if not found:
        allowed = "a parameter with a tolerance, as t = { value = 2.0, unit = 'mm', tolerance = { normal = 0.02 } }"
        raise SceneError([Mistake("parameters", "no tolerance", allowed, scene.file)])
    return found


def drawn(distributions: Mapping[str, Distribution], count: int, *, indices: bool) -> Array:
    """Values (k, d) of d parameters, SI: a sample of ``count`` points, or with ``indices`` A, B, AB₁, ... AB_d.

    Raises:
        SceneError: indices of a single parameter.
    """
    from scipy.stats import qmc

    size = len(distributions)
    if indices and size < 2:
        raise SceneError([Mistake("--sobol", "one parameter with a tolerance", "two or more: the index of one is 1")])
    samples = 2 if indices else 1
    shares = qmc.Sobol(samples * size, seed=SEED).random_base2(count.bit_length() - 1)
    shares = np.clip(shares, _EDGE, 1.0 - _EDGE)
    own = [*distributions.values()] * samples
    columns = [each.ppf(column) for each, column in zip(own, shares.T, strict=True)]
    if not indices:
        return np.column_stack(columns)
    a, b = columns[:size], columns[size:]
    mixed = ([*a[:i], b[i], *a[i + 1 :]] for i in range(size))
    return np.concatenate([np.column_stack(each) for each in (a, b, *mixed)])
