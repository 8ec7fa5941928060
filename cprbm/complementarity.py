"""Which contacts press: the small linear complementarity problem inside a Newton step.

    w = G λ − b ≥ 0,   λ ≥ 0,   λᵀw = 0

======  =======================================================================
G       symmetric, positive semidefinite: compliance of the mechanism at its gaps
b       linearised violation of each gap if nothing pressed
λ, w    contact forces, remaining gaps
======  =======================================================================

Block principal pivoting (Júdice and Pires 1994): all wrong signs are changed at once as long as their number
falls.  When it stalls, the same λ is found as the minimum of ½ λᵀGλ − bᵀλ over λ ≥ 0 (Lawson and Hanson 1974, NNLS):
one row is added at a time, the most violated, and every step descends.  Rules that only count signs, like
Murty's, go through sets of many neighbours whose compliances are the same but for round-off, and lose their
way there; a set that was built by descent has the few rows that press.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from scene.answer import Array, Flags, Ints

PATIENCE = 4
RIGID = 1e-13  # of the largest compliance
TRACE = 1e-13  # of every row's own compliance


def pressing(G: Array, b: Array, first: Flags) -> tuple[Array, Flags]:
    """Solve for λ (m,) and the set that presses (m,) of bool, starting from the guess ``first``.

    Raises:
        np.linalg.LinAlgError: no solution was found; G is not positive semidefinite or too degenerate.
    """
    compliance = G.diagonal()
    # a gap between places that cannot move is no unknown: it is open or the question has no answer
    yields = compliance > RIGID * compliance.max(initial=0.0)
    if not yields.all():
        if (b[~yields] > 0.0).any():
            raise np.linalg.LinAlgError("a closed contact that nothing yields to")
        lam, active = np.zeros(len(b)), np.zeros(len(b), dtype=bool)
        if yields.any():
            lam[yields], active[yields] = pressing(G[np.ix_(yields, yields)], b[yields], first[yields])
        return lam, active
    m = len(b)
    scale = np.sqrt(compliance)
    # rows in units of their own compliance; a trace of the identity parts rows that are the same twice
    H = G / (scale * scale[:, None])
    H.flat[:: m + 1] += TRACE
    c = b / scale
    active = first.copy()
    fewest, patience = m + 1, PATIENCE
    slack = 1e-14 * (1.0 + float(np.abs(c).max(initial=0.0)))
    while patience > 0:
        force, gap = np.zeros(m), -c
        held = active.nonzero()[0]
        if held.size:
            force[held] = _balancing(H, c, held)
            gap = H[:, held] @ force[held] - c
        wrong = np.where(active, force, gap) < -slack
        count = int(np.count_nonzero(wrong))
        if count == 0:
            return _sharpened(H, force, active) / scale, active
        if count < fewest:
            fewest, patience = count, PATIENCE
        else:
            patience -= 1
        active = active ^ wrong
    force, active = _descended(H, c, first, slack)
    return _sharpened(H, force, active) / scale, active


def _sharpened(H: Array, force: Array, active: Flags) -> Array:
    """Forces (m,) without what the trace leaves the gaps open by."""
    held = active.nonzero()[0]
    if held.size:
        force[held] += _balancing(H, TRACE * force, held)
    return np.maximum(force, 0.0)


def _balancing(H: Array, c: Array, held: Ints) -> Array:
    """Forces of the rows ``held`` (k,) by which their gaps are closed, (k,).

    Raises:
        np.linalg.LinAlgError: two of them are the same.
    """
    _, _, force, info = lapack.dgesv(H[held[:, None], held], c[held])
    if info != 0:
        raise np.linalg.LinAlgError("contacts that are the same")
    return np.asarray(force)


def _descended(H: Array, c: Array, first: Flags, slack: float) -> tuple[Array, Flags]:
    """The minimum of ½ λᵀHλ − cᵀλ over λ ≥ 0, from the rows ``first``."""
    m = len(c)
    force, active, barred, added = np.zeros(m), first.copy(), np.zeros(m, dtype=bool), np.zeros(m, dtype=bool)
    for _ in range(50 + 10 * m):
        while np.any(active):
            aim = np.zeros(m)
            aim[active] = _balancing(H, c, active.nonzero()[0])
            pulling = active & (aim <= 0.0)
            if not np.any(pulling):
                force = aim
                break
            # towards the aim until the first force vanishes
            parts = force[pulling] / np.maximum(force[pulling] - aim[pulling], np.finfo(float).tiny)
            force = force + np.min(parts) * (aim - force)
            active[np.flatnonzero(pulling)[parts <= np.min(parts)]] = False
            force[~active] = 0.0
        # a row that is added and leaves at once is violated by round-off only
        barred = (barred | added) & ~np.any(added & active)
        violated = np.where(active | barred, -np.inf, c - H @ force)
        worst = int(np.argmax(violated))
        if violated[worst] <= slack:
            return force, active
        added = np.arange(m) == worst
        active[worst] = True
    raise np.linalg.LinAlgError("no complementary solution")
