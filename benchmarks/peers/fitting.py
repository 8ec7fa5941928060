"""Joints against the polynomial through points, eqs. (8) and (11), as a function of the coordinates that enter it.

=========  ====================================================================================================
symbol     meaning
=========  ====================================================================================================
a, o       of the joints, along the axis and across it (m,)
A, B       of the points (n,)
φ, V       powers of (a − centre)/width, and of A likewise: rows of d + 1 numbers
K, q       VᵀV, and coefficients of the fit, K q = VᵀB
c_j        ±(φ(a_j)·q − o_j) ≤ 0
=========  ====================================================================================================

The curve does not depend on centre and width, which are therefore constants of the derivatives although they are the
present mean and half-range of A.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cprbm_scene.answer import Array


@dataclass(frozen=True)
class Fitted:
    """Values and slopes at one place, of which nothing is found before it is asked for."""

    a: Array
    o: Array
    A: Array
    B: Array
    degree: int
    sense: float

    @cached_property
    def _span(self) -> tuple[float, float]:
        return float(np.mean(self.A)), 0.5 * float(np.ptp(self.A))

    def _powers(self, at: Array, order: int) -> Array:
        """Derivative of an ``order`` of the powers at some places (k, d+1)."""
        centre, width = self._span
        found = np.zeros((len(at), self.degree + 1))
        u, factor = (at - centre) / width, np.ones(self.degree + 1)
        found[:, order] = 1.0
        for power in range(order + 1, self.degree + 1):
            found[:, power] = found[:, power - 1] * u
        for down in range(order):
            factor *= (np.arange(self.degree + 1) - down) / width
        return found * factor

    @cached_property
    def _V(self) -> Array:
        return self._powers(self.A, 0)

    @cached_property
    def _V1(self) -> Array:
        return self._powers(self.A, 1)

    @cached_property
    def _phi(self) -> Array:
        return self._powers(self.a, 0)

    @cached_property
    def _phi1(self) -> Array:
        return self._powers(self.a, 1)

    @cached_property
    def q(self) -> Array:
        """Coefficients (d+1,)."""
        return np.asarray(np.linalg.solve(self._V.T @ self._V, self._V.T @ self.B), dtype=float)

    def values(self) -> Array:
        """c (m,)."""
        return np.asarray(self.sense * (self._phi @ self.q - self.o))

    @cached_property
    def _q_slopes(self) -> tuple[Array, Array]:
        """q over A and over B, (d+1, n) each."""
        V, V1 = self._V, self._V1
        K = V.T @ V
        rest, slope = self.B - V @ self.q, V1 @ self.q
        over_A, over_B = np.linalg.solve(K, V1.T * rest - V.T * slope), np.linalg.solve(K, V.T)
        return np.asarray(over_A, dtype=float), np.asarray(over_B, dtype=float)

    def slopes(self) -> Array:
        """∂c over (a, o, A, B), (m, 2m + 2n)."""
        phi, phi1 = self._phi, self._phi1
        q_A, q_B = self._q_slopes
        return self.sense * np.hstack((np.diag(phi1 @ self.q), -np.eye(len(self.o)), phi @ q_A, phi @ q_B))
