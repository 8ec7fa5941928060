"""Which contacts press: the small linear complementarity problem inside a Newton step.

    w = G λ − b ≥ 0,   λ ≥ 0,   λᵀw = 0

======  =======================================================================
G       symmetric, positive semidefinite: compliance of the mechanism at its gaps
b       linearised violation of each gap if nothing pressed
λ, w    contact forces, remaining gaps
======  =======================================================================

Block principal pivoting (Júdice and Pires 1994): all wrong signs are changed at once as long as
their number falls; when it stalls, Murty's rule changes the last wrong one alone, which cannot cycle.
"""

from __future__ import annotations

import numpy as np

from scene.answer import Array, Flags

PATIENCE = 4
RIGID = 1e-13  # of the largest compliance


def pressing(G: Array, b: Array, first: Flags) -> tuple[Array, Flags]:
    """Solve for λ (m,) and the set that presses (m,) of bool, starting from the guess ``first``.

    Raises:
        np.linalg.LinAlgError: no solution was found; G is not positive semidefinite or too degenerate.
    """
    compliance = np.diag(G)
    # a gap between places that cannot move is no unknown: it is open or the question has no answer
    yields = compliance > RIGID * np.max(compliance, initial=0.0)
    if np.any(b[~yields] > 0.0):
        raise np.linalg.LinAlgError("a closed contact that nothing yields to")
    if not np.all(yields):
        lam, active = np.zeros(len(b)), np.zeros(len(b), dtype=bool)
        if np.any(yields):
            lam[yields], active[yields] = pressing(G[np.ix_(yields, yields)], b[yields], first[yields])
        return lam, active
    m = len(b)
    scale = np.sqrt(compliance)
    # rows in units of their own compliance; a trace of the identity parts rows that are the same twice
    H = G / np.outer(scale, scale) + 1e-13 * np.eye(m)
    c = b / scale
    active = first.copy()
    fewest, patience = m + 1, PATIENCE
    for _ in range(50 + 10 * m):
        force = np.zeros(m)
        if np.any(active):
            force[active] = np.linalg.solve(H[np.ix_(active, active)], c[active])
        gap = H @ force - c
        slack = 1e-14 * (1.0 + np.max(np.abs(c)))
        wrong = np.where(active, force < -slack, gap < -slack)
        count = int(np.sum(wrong))
        if count == 0:
            return np.maximum(force, 0.0) / scale, active
        if count < fewest:
            fewest, patience = count, PATIENCE
        elif patience > 0:
            patience -= 1
        else:
            wrong[: np.flatnonzero(wrong)[-1]] = False
        active = active ^ wrong
    raise np.linalg.LinAlgError("no complementary solution")
