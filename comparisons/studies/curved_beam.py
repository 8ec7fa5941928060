"""What the straight-beam formula of bending stress misses in a beam that is curved at rest.

======  ====================================================================================
symbol  meaning
======  ====================================================================================
R, t    radius of the neutral line at rest, thickness; h = t/(2R)
r_i     radius of the inner edge, R − t/2
r_n     radius where a pure moment leaves no stress, t/ln(r_o/r_i) = R/a
a, b    (artanh h)/h and (a − 1)/h²; 1 and 1/3 of a straight beam
e       R − r_n = R h² b/a
K       stress at the inner edge over 6 M/(w t²), the straight beam's
======  ====================================================================================

Of a rectangle in pure bending (Winkler; S. P. Timoshenko, Strength of Materials II, section 12)

    σ_i = M (r_n − r_i)/(A e r_i),     K = (r_n − r_i) t/(6 e r_i) = (a − h b)/(3 b (1 − h)) = 1 + t/(3R) + O(h²).

It speaks of the moment.  That the moment is E A e R times the change of curvature, and not E I, is of second order.
"""

from __future__ import annotations

import numpy as np

from cprbm_scene.answer import Array

_SERIES_BELOW = 0.1  # h where the terms left out and the digits that a − 1 loses are both below 1e-13
_TERMS = 9


def inner_edge_factor(bentness: Array) -> Array:
    """K at thickness over radius ``bentness`` (k,), from 0 for a straight beam and less than 2.

    Raises:
        ValueError: an inner edge on or beyond the centre of curvature.
    """
    h = 0.5 * np.asarray(bentness, dtype=float)
    if not np.all((h >= 0.0) & (h < 1.0)):
        raise ValueError("thickness over radius must be at least 0 and less than 2")
    series = h < _SERIES_BELOW
    at = np.where(series, _SERIES_BELOW, h)
    powers = 2.0 * np.arange(_TERMS)
    b = np.where(series, np.sum(h[..., None] ** powers / (powers + 3.0), axis=-1), (np.arctanh(at) / at - 1.0) / at**2)
    a = 1.0 + h**2 * b
    return np.asarray((a - h * b) / (3.0 * b * (1.0 - h)))
