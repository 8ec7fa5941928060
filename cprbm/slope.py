"""How the potential energy of the equilibria goes with what is stepped.

======  ==============================================================================
v       value of the stepped load or drive, SI
PE      potential energy of the equilibrium at v, units of S
Q       dPE/dv: of a drive its reaction, of a load minus what it moves by
======  ==============================================================================

By the envelope theorem Q = ∂L/∂v at fixed unknowns, L = PE + μ·Z + λ·c.  Along a branch PE is the integral of Q; at a
leap to another branch energy is lost.
"""

from __future__ import annotations

from cprbm.energy import load_work
from cprbm.equilibrium import Point, Problem, potential_energy

EVEN = 0.3  # of |ΔQ·Δv|: what a smooth Q, or one with a kink, differs by from its mean at the ends
NOTHING = 1e-7  # of the energy


def slope(problem: Problem, point: Point, name: str) -> float:
    """Q of the load or drive of a ``name``, S per its unit."""
    if name in problem.loads:
        only = {name: problem.loads[name]}
        return -load_work(problem.model, only, {name: 1.0}, point.state).value
    holds = problem.closure.holds
    mu = point.mu[problem.closure.first_hold :]
    return -sum(float(m) * hold.unit for hold, m in zip(holds, mu, strict=True) if hold.drive == name)


def leapt(problem: Problem, name: str, before: tuple[float, Point], after: tuple[float, Point]) -> bool:
    """Whether energy went that no work accounts for, from one equilibrium (v and its state) to another."""
    (v0, start), (v1, end) = before, after
    q0, q1 = slope(problem, start, name), slope(problem, end, name)
    e0, e1 = potential_energy(problem, start), potential_energy(problem, end)
    missing = abs(0.5 * (q0 + q1) * (v1 - v0) - (e1 - e0))
    scale = max(abs(e0), abs(e1), abs(q0 * v0), abs(q1 * v1))
    return missing > max(EVEN * abs((q1 - q0) * (v1 - v0)), NOTHING * scale)
