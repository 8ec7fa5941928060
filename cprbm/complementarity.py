"""Which contacts press: the small linear complementarity problem inside a Newton step.

    w = G λ − b ≥ 0,   λ ≥ 0,   λᵀw = 0

======  =======================================================================
G       symmetric, positive semidefinite: compliance of the mechanism at its gaps
b       linearised violation of each gap if nothing pressed
λ, w    contact forces, remaining gaps
======  =======================================================================

λ is the minimum of ½ λᵀGλ − bᵀλ over λ ≥ 0 (Lawson and Hanson 1974, NNLS): from the rows that pressed before, those
that would pull go, then one row is added at a time, the most violated, and every step descends.  Rules that only count
signs and change all wrong ones at once (Júdice and Pires 1994, Murty) press with all of some tens of neighbours at
first, go through many sets of them whose compliances are the same but for round-off, and lose their way there; a set
that was built by descent has the few rows that press, after about as many steps.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import lapack

from cprbm_scene.answer import Array, Flags, Ints

RIGID = 1e-13  # of the largest compliance
TRACE = 1e-13  # of every row's own compliance
ROUNDED = 1e-14  # of the largest violation, and of one


def pressing(G: Array, b: Array, first: Flags) -> tuple[Array, Flags]:
    """Solve for λ (m,) and the set that presses (m,) of bool, starting from the guess ``first``.

    Raises:
        np.linalg.LinAlgError: no solution was found; G is not positive semidefinite or too degenerate.
    """
    compliance = G.diagonal()
    # a gap between places that cannot move is no unknown: it is open or the question has no answer
    yields = compliance > RIGID * compliance.max(initial=0.0)
    lam, active = np.zeros(len(b)), np.zeros(len(b), dtype=bool)
    rows = yields.nonzero()[0]
    if rows.size < len(b):
        if (b[~yields] > 0.0).any():
            raise np.linalg.LinAlgError("a closed contact that nothing yields to")
        if not rows.size:
            return lam, active
        G, b, first, compliance = G[rows[:, None], rows], b[rows], first[rows], compliance[rows]
    scale = np.sqrt(compliance)
    # rows in units of their own compliance; a trace of the identity parts rows that are the same twice
    H = G / scale
    H /= scale[:, None]
    H.reshape(-1)[:: len(b) + 1] += TRACE
    held, force = _descended(H, b / scale, first.nonzero()[0])
    if held.size:
        lam[rows[held]], active[rows[held]] = force / scale[held], True
    return lam, active


def _descended(H: Array, c: Array, held: Ints) -> tuple[Ints, Array]:
    """The minimum of ½ λᵀHλ − cᵀλ over λ ≥ 0, from the rows ``held``: those that press and their forces (k,).

    Raises:
        np.linalg.LinAlgError: two of them are the same, or it was not found.
    """
    slack = ROUNDED * (1.0 + float(np.abs(c).max()))
    force, barred, added = np.zeros(held.size), held[:0], -1
    for _ in range(50 + 10 * len(c)):
        while held.size:
            across = H.take(held, axis=0)
            factors, pivots, aim, failed = lapack.dgesv(across.take(held, axis=1), c[held])
            if failed:
                raise np.linalg.LinAlgError("contacts that are the same")
            if aim.min() >= -slack:
                force = aim
                break
            # towards the aim until the first force vanishes
            pulling = aim < -slack
            parts = np.full(held.size, np.inf)
            parts[pulling] = force[pulling] / (force[pulling] - aim[pulling])
            least = parts.min()
            kept = parts > least
            # a row that is added and leaves at once is violated by round-off only
            barred = np.concatenate((barred, held[~kept & (held == added)]))
            held, force = held[kept], (force + least * (aim - force))[kept]
        violated = c - force @ across if held.size else c.copy()
        violated[held] = violated[barred] = -np.inf
        added = int(violated.argmax())
        if violated[added] <= slack:
            if held.size:
                # without what the trace leaves the gaps open by
                more, _ = lapack.dgetrs(factors, pivots, TRACE * force)
                force = np.maximum(force + more, 0.0)
            return held, force
        held, force = np.concatenate((held, (added,))), np.concatenate((force, (0.0,)))
    raise np.linalg.LinAlgError("no complementary solution")
