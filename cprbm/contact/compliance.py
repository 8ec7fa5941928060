"""Compliance that a chain lacks under a point force.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
h, EI, GA  length of an element, bending stiffness, shear stiffness
s          place of a transverse unit force, from the clamp of a cantilever
w_j        weight of node j in the spline's position at s: the force on node j
M_i, Q_j   moment in joint i, shear force in link j, of length L_j
ξ          local parameter of a piece, from 0 to 1
c(ξ)       lost compliance: of bending over h³/EI, of shear over h/GA
=========  =====================================================================================

The spline spreads a point force over the nodes of a few links.  The chain of fourth order has the compliance

    Σ M_i² h/EI + Σ L_j Q_j² h²/(12 EI)

in place of s³/(3 EI), and with shear Σ L_j Q_j²/GA in place of s/GA.  A point force makes a kink F/GA in the neutral
line, and the spline has none.  The differences depend on ξ alone: a polynomial of degree six on every piece, the same
on all pieces but the half links at the ends.  A half link beyond a clamp or a pin has nearly no compliance of its
own, a half link at a free end more; both follow from a cantilever loaded near its two ends.
"""

from __future__ import annotations

from functools import cache
from typing import Literal

import numpy as np

from cprbm.chain.spline import spline_line
from cprbm_scene.answer import Array

POWERS = 7
"""Coefficients of c: weights are cubic in ξ, moments and their squares follow."""

ELEMENTS = 16
"""Elements of the cantilever: the middle piece is free of the ends' influence to 1e-9."""


@cache
def lost_compliance(part: Literal["bending", "shear"]) -> Array:
    """Coefficients of c, lowest power first, of the pieces of a beam.

    The rows (5, POWERS) are an inner piece, a first half link at a joint with a body, a free first half link, and both
    as last half links.
    """
    n = float(ELEMENTS)
    pieces = (0.5 * n - 0.5, 0.5 * n + 0.5), (0.0, 0.5), (n, n - 0.5), (0.5, 0.0), (n - 0.5, n)
    return np.array([_fitted(part, *ends) for ends in pieces])


def _fitted(part: str, begin: float, end: float) -> Array:
    """Coefficients of c between two places; the polynomial through POWERS places is exact."""
    xi = 0.5 - 0.5 * np.cos(np.pi * (np.arange(POWERS) + 0.5) / POWERS)
    lost = _lost(part, begin + (end - begin) * xi)
    return np.asarray(np.linalg.solve(np.vander(xi, POWERS, increasing=True), lost))


def _lost(part: str, s: Array) -> Array:
    """c at places ``s`` (k,) of a cantilever with h = EI = GA = 1."""
    arcs = np.concatenate([[0.0], np.arange(ELEMENTS) + 0.5, [float(ELEMENTS)]])
    force = spline_line(arcs).weights(s).toarray()
    sheared = np.cumsum(force[:, ::-1], axis=1)[:, ::-1][:, 1:] ** 2 @ np.diff(arcs)
    if part == "shear":
        return np.asarray(s - sheared)
    moment = force @ np.maximum(arcs[None, :] - arcs[1:-1, None], 0.0).T
    return np.asarray(s**3 / 3.0 - np.sum(moment**2, axis=1) - sheared / 12.0)
