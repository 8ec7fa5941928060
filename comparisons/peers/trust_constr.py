"""SciPy's trust-constr with exact derivatives: an interior point in a trust region, without updates to guess at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import optimize

from comparisons.peers.formulas import Formulas
from comparisons.peers.solving import Clock, Solve, by_scipy

if TYPE_CHECKING:
    from comparisons.pairing import Discretised

# The Lagrangian's gradient, the barrier, and the trust region: with SciPy's 1e-8 the gradient, which it measures with
# multipliers of its own, passes before the common residual does, and the region's size may end it first.
OPTIONS: dict[str, Any] = {"gtol": 1e-10, "barrier_tol": 1e-10, "xtol": 1e-12, "maxiter": 3000}
# A barrier of SciPy's 0.1, in S, is much beside the energy; with 1e-3 the hinge at N = 40 takes 24 iterations for 28.
OPTIONS |= {"initial_barrier_parameter": 1e-3, "initial_barrier_tolerance": 1e-3}
# Of the two dense factorisations: 0.17 s for 0.28 s there.
OPTIONS |= {"factorization_method": "SVDFactorization"}


def prepared(problem: Discretised, seconds: float) -> Solve:
    """The functions; they are all of the set-up."""
    formulas = Formulas(problem)
    # dense: every joint's place depends on all links before it, and sparse formats only add their own time
    constraints = []
    if formulas.equalities:
        constraints.append(
            optimize.NonlinearConstraint(
                formulas.closure, 0.0, 0.0, jac=formulas.closure_slope, hess=formulas.closure_second
            )
        )
    if len(formulas.contact(formulas.rest)):
        constraints.append(
            optimize.NonlinearConstraint(
                formulas.contact, -np.inf, 0.0, jac=formulas.contact_slope, hess=formulas.contact_second
            )
        )

    def minimised(clock: Clock) -> optimize.OptimizeResult:
        return optimize.minimize(
            formulas.energy,
            formulas.rest,
            jac=formulas.energy_slope,
            hess=formulas.energy_second,
            method="trust-constr",
            constraints=constraints,
            callback=clock,
            options=OPTIONS,
        )

    return lambda: by_scipy(minimised, formulas.rest, seconds)
