"""How far an answer is from a stationary point, by one measure for every optimiser.

=========  ====================================================================================================
symbol     meaning
=========  ====================================================================================================
g, A, C    ∂PE, ∂Z and ∂c over z
active     constraints with c > −``NEAR``
μ, λ       multipliers by least squares, min |g + Aᵀμ + Cᵀλ|, λ ≥ 0 and 0 where a constraint is not active
scale      the largest single force in the sum: of |g_strain|, |g_load|, |Aᵀμ|, |Cᵀλ|
residual   largest of: |g + Aᵀμ + Cᵀλ| over the scale; |Z| and c over ℓ; λ |c| over the scale and ℓ
=========  ====================================================================================================

An optimiser's own multipliers are not asked for: not each has them, and none is to be judged by what it says of itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from benchmarks.peers.formulas import Formulas
from cprbm_scene.answer import Array

NEAR = 1e-6  # ℓ


@dataclass(frozen=True, slots=True)
class Stationarity:
    """The ``residual`` and the multipliers ``mu`` (rows of Z,) and ``lam`` (m,) that make it small."""

    residual: float
    mu: Array
    lam: Array


def stationarity(formulas: Formulas, z: Array) -> Stationarity:
    """The measure at some z; infinite where that is no number."""
    nothing = np.zeros(formulas.equalities), np.zeros(len(formulas.contact(formulas.rest)))
    if not np.all(np.isfinite(z)):
        return Stationarity(float("inf"), *nothing)
    g, Z, c = formulas.energy_slope(z), formulas.closure(z), formulas.contact(z)
    if not np.all(np.isfinite(c)):
        return Stationarity(float("inf"), *nothing)
    A, C = formulas.closure_slope(z), formulas.contact_slope(z)
    active = np.flatnonzero(c > -NEAR)
    columns = np.vstack((A, C[active])).T
    least = np.concatenate((np.full(len(Z), -np.inf), np.zeros(len(active))))
    # bounded least squares stop where they are told to: well below what is asked of the residual
    found = lsq_linear(columns, -g, (least, np.inf), method="bvls", tol=1e-14) if columns.size else None
    multipliers = np.zeros(columns.shape[1]) if found is None else found.x
    mu, lam = multipliers[: len(Z)], np.zeros(len(c))
    lam[active] = multipliers[len(Z) :]
    pulls = A.T * mu, C.T * lam
    scale = max(float(np.max(np.abs(part), initial=0.0)) for part in (formulas.strain_slope(z), *pulls)) or 1.0
    unbalanced = float(np.max(np.abs(g + A.T @ mu + C.T @ lam))) / scale
    residual = max(
        unbalanced,
        float(np.max(np.abs(Z), initial=0.0)),
        float(np.max(c, initial=0.0)),
        float(np.max(lam * np.abs(c), initial=0.0)) / scale,
    )
    return Stationarity(residual, mu, lam)
