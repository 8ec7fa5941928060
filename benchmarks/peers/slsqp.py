"""SciPy's SLSQP as the paper has its problem solved: all constraints carried, gradients by differences."""

from __future__ import annotations

from typing import TYPE_CHECKING

from scipy import optimize

from benchmarks.peers.formulas import Formulas
from benchmarks.peers.method import method
from benchmarks.peers.solving import Clock, Solve, by_scipy

if TYPE_CHECKING:
    from benchmarks.peers.record import Discretised
    from comparisons.bench.running import Contender

# The change of the energy, in S, at which it stops: at 1e-10 the common residual of the hinge at N = 40 is 1.4e-6, at
# 1e-12 it is 6e-7, and differences leave no less.
STOPS_AT = 1e-12
MOST = 2000  # iterations: SciPy's 100 are too few for a hundred unknowns


def prepared(problem: Discretised, seconds: float) -> Solve:
    """The functions; they are all of the set-up."""
    formulas = Formulas(problem)
    constraints = [{"type": "eq", "fun": formulas.closure}] if formulas.equalities else []
    if len(formulas.contact(formulas.rest)):
        constraints.append({"type": "ineq", "fun": lambda z: -formulas.contact(z)})

    def minimised(clock: Clock) -> optimize.OptimizeResult:
        # SciPy's own standard differences, forward, of everything: what a user of the paper's formulas has
        return optimize.minimize(
            formulas.energy,
            formulas.rest,
            jac="2-point",
            method="SLSQP",
            constraints=constraints,
            callback=clock,
            options={"maxiter": MOST, "ftol": STOPS_AT},
        )

    # how it ends is judged by the residual alone: at the end of its digits it says that a line search has failed
    return lambda: by_scipy(minimised, formulas.rest, seconds)


def contender() -> Contender:
    """SLSQP as a method of the benchmark."""
    return method("slsqp", "SLSQP", prepared, 80, ("#7a5195", "v"), ("both",))
