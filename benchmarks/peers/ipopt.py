"""IPOPT through CasADi, with exact derivatives; only where the extra ``peers`` is installed.

What was chosen was measured (seconds of the processor, cold start): on the hinge at N = 40 expressions of scalars
(SX) are solved in 10.5 ms after 0.12 s of set-up, of matrices (MX) in 42 ms after 0.15 s.  The adaptive barrier takes
6 iterations there and 12 on the gripper at (30, 40), 10.7 and 40 ms; the monotone one, which IPOPT ships, takes 8 and
16, 12.8 and 50 ms, and leaves a residual of 9e-7 on the gripper where the other leaves 3e-8.  A smaller first
barrier, another oracle of the adaptive one, no scaling of the functions and no relaxed bounds bring nothing beside
it.
"""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmarks.peers.expressions import expressions
from benchmarks.peers.formulas import Formulas
from benchmarks.peers.method import method
from benchmarks.peers.solving import LATE, Solve, Solved

if TYPE_CHECKING:
    from benchmarks.peers.record import Discretised
    from comparisons.bench.running import Contender

OPTIONS: dict[str, Any] = {
    "print_time": False,
    "error_on_fail": False,
    "ipopt.print_level": 0,  # writing to the screen takes time, and belongs to nobody here
    "ipopt.sb": "yes",
    "ipopt.linear_solver": "mumps",  # the one that CasADi brings with it
    "ipopt.hessian_approximation": "exact",
    "ipopt.mu_strategy": "adaptive",
    # its own 1e-8 is over a mean of the multipliers, and leaves the common residual above its tolerance on a gripper of
    # (15, 20) links; this takes one iteration more there, and none at (30, 40), at 40 and on the hinge
    "ipopt.tol": 1e-9,
    "ipopt.max_iter": 3000,
}


def there() -> bool:
    """Whether CasADi is installed."""
    return importlib.util.find_spec("casadi") is not None


def prepared(problem: Discretised, seconds: float) -> Solve:
    """Expressions, their derivatives, and the optimiser.

    Raises:
        ModuleNotFoundError: CasADi is not installed.
    """
    import casadi as ca

    formulas = Formulas(problem)
    z, energy, rows = expressions(formulas)
    options = {**OPTIONS, "ipopt.max_cpu_time": seconds}
    optimiser = ca.nlpsol("ipopt", "ipopt", {"x": z, "f": energy, "g": rows}, options)
    least = np.where(np.arange(rows.shape[0]) < formulas.equalities, 0.0, -np.inf)

    def solve() -> Solved:
        found = optimiser(x0=formulas.rest, lbg=least, ubg=0.0)
        stats = optimiser.stats()
        status = str(stats["return_status"])
        why = "" if stats["success"] else status.replace("_", " ").lower()
        why = LATE if status == "Maximum_CpuTime_Exceeded" else why
        return Solved(np.array(found["x"]).ravel(), int(stats["iter_count"]), why)

    return solve


def contender() -> Contender:
    """IPOPT as a method of the benchmark."""
    absence = "" if there() else "CasADi is not installed (the extra 'peers')"
    return method("ipopt", "IPOPT", prepared, 160, ("#2f8f4e", "P"), ("solve", "both"), absence)
