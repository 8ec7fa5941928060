"""One step of Newton's method at a state, under the contacts that will press.

==========  =================================================================================
q           unknowns: link angles θ, then u, v, φ of the free bodies
L           PE + μ·Z + λ·c, Lagrangian
H           its Hessian: tridiagonal over θ, plus JᵀWJ of the touching places
W = VσVᵀ    second derivative of λ·c over its local numbers, entered as border columns JᵀV
S           Schur complement of the tridiagonal part, :mod:`cprbm.bordered`
Δq, Δμ, Δλ  the step: H Δq + A_Eᵀ Δμ + A_Iᵀ Δλ = −∂L, A_E Δq = −Z, A_I Δq ≤ −c
G           compliance of the gaps: what Δλ opens them by
==========  =================================================================================

The step is sought in differences, so that what round-off leaves of one is the right-hand side of the next.  Which
contacts press is a small complementarity problem in G.

A_E has dependent rows where a beam is straight between ends that do not move: turning its links by a little does not
bring them closer, and no equation says what it pulls by.  So in a step Z may stay behind by a very little (``GIVING``)
times Δμ, which is nothing once there is no more step: such a beam keeps the pull that it had.  So may gaps where
two obstacles with one corner hold a beam by two rows that are one, by as little times Δλ: they share its force.

H is made positive definite on the feasible directions where it is not, first by the stiffness of the contacts that
press, then by a shift.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.bordered import Bordered, Held, Kept, Symmetric, anchored, bordered, factorised, without
from cprbm.closure import closure_second, closure_sums
from cprbm.complementarity import pressing
from cprbm.first_contact import Factored, Rows, over_unknowns
from cprbm.kinematics import twice
from cprbm.local import GIVING, LocalSystem, local_step, local_system
from cprbm.once import once
from cprbm.point import Point, Problem
from cprbm_scene.answer import Array, Flags, Ints

# stiffness of pressing contacts and shift while the energy alone is not convex, S/ℓ²; the first that helps
TRIES = ((0.0, 0.0), (1e4, 0.0), (1e6, 0.0), *((0.0, 4.0**i) for i in range(1, 12)))
MANY = 40  # contact rows beyond which the system is solved with the joints' positions as unknowns
ALIKE = 1e-12  # 1 − cos between rows that are one
LOCAL = 8  # joints in a row that is local
NO_NUMBERS = np.zeros(0)


@dataclass(frozen=True)
class System:
    """A factorised Newton system.

    Attributes:
        factors: the tridiagonal part, and the border: bodies, anchors, curvatures, equalities and contacts.
        anchors: unknowns over θ that stand in the border, behind the bodies.
        n_bodies: u, v, φ of all bodies.
        n_base: border columns without those of the contacts, which stand behind them.
        active: the contacts that press (m,).
        added: right-hand sides of the curvatures' columns (r,): of those that were added.
        equalities: their columns, behind the curvatures'.
        expected: negative eigenvalues of a minimum's system without contacts.
    """

    factors: Bordered
    anchors: Ints
    n_bodies: int
    n_base: int
    active: Flags
    added: Array
    equalities: slice
    expected: int

    @once
    def schur(self) -> Symmetric:
        """Factors of S without the contacts."""
        return Symmetric(self.factors.schur[: self.n_base, : self.n_base])

    @once
    def convex(self) -> bool:
        """Whether the Hessian is positive definite where the equalities hold."""
        return self.factors.tridiagonal.negative() + self.schur.negative == self.expected

    @once
    def kept(self) -> Kept:
        """The system with the contacts that press, and no others.

        Raises:
            np.linalg.LinAlgError: it is exactly singular.
        """
        return self.factors.kept(np.concatenate((np.arange(self.n_base), self.n_base + self.active.nonzero()[0])))

    @property
    def stable(self) -> bool:
        """Whether the Hessian is positive definite where the equalities and the contacts that press hold."""
        return self.kept.negative <= self.expected + int(np.count_nonzero(self.active))

    def solved(self, f: Array, Z: Array) -> Array:
        """Δq (n_links + 3B,) by which ∂L changes by ``f`` and Z by ``Z``, and no gap that presses."""
        n = len(f) - self.n_bodies
        right = np.zeros(self.kept.corner.shape[0])
        right[: self.n_bodies] = f[n:]
        right[self.n_bodies : self.n_bodies + len(self.anchors)] = f[self.anchors]
        right[self.equalities] = Z
        return self.change(*self.kept.solve(f[:n], right))

    def change(self, a: Array, b: Array) -> Array:
        """Change of q, from that over θ and the border's solution."""
        change = np.concatenate((a, b[: self.n_bodies]))
        change[self.anchors] = b[self.n_bodies : self.n_bodies + len(self.anchors)]
        return change


def system(problem: Problem, point: Point, stiffness: float, shift: float) -> System:
    """Assemble and factorise, with a ``stiffness`` of the contacts that press and a ``shift`` added.

    Raises:
        np.linalg.LinAlgError: the tridiagonal part is exactly singular.
    """
    model, closure, A_I = problem.model, problem.closure, point.slopes
    n, n_bodies = model.n_links, 3 * model.n_bodies
    sums = closure_sums(closure, point.mu)
    if point.lam.any():
        sums += point.rows.sums(point.lam, model)
    second, second_bodies = twice(model, point.state, point.at, sums)
    diagonal, off = problem.springs
    diagonal, off = diagonal + second - point.work.diagonal, off - point.work.off
    if shift:
        diagonal += shift * model.lengths
    over_phi = second_bodies + closure_second(model, closure, point.state, point.mu) - point.work.second

    curved = _curvatures(point)
    low_rank = over_unknowns(model, point.state, point.at, [each.columns for each in curved])
    sigma = np.concatenate([NO_NUMBERS, *(each.sigma for each in curved)])
    added = np.zeros(len(sigma))
    active = point.lam > 0.0
    if stiffness:
        low_rank = np.concatenate((low_rank, A_I[active]))
        sigma = np.concatenate((sigma, np.full(np.count_nonzero(active), stiffness)))
        added = np.concatenate((added, -point.rows.values[active]))
    anchors = problem.loose
    tridiagonal = factorised(*without(diagonal, off, problem.still))
    if tridiagonal.nearly_singular(problem.generic, model.lengths):
        anchors = anchored(diagonal, off, model.lengths, anchors, closure.fixed)
        gone = Held(np.concatenate((anchors, closure.fixed)), n)
        tridiagonal = factorised(*without(diagonal, off, gone))

    r, k = len(sigma), len(anchors)
    first, inner = n_bodies + k, n_bodies + k + r
    n_base = inner + len(point.A_E)
    size = n_base + len(A_I)
    border, corner, own = np.zeros((n, size), order="F"), np.zeros((size, size)), np.zeros(size)
    wide = np.concatenate((low_rank, point.A_E, A_I))
    border[:, first:] = wide[:, :n].T
    corner[:n_bodies, first:] = wide[:, n:].T
    own[2:n_bodies:3] = over_phi
    own[n_bodies:first] = diagonal[anchors]
    own[first:inner] = -1.0 / sigma
    own[inner:n_base] = -GIVING
    if len(point.rows.groups) > 1:
        own[n_base:][_twins(point.rows, A_I)] = -GIVING
    corner.reshape(-1)[:: size + 1] = own
    for place, link in enumerate(anchors.tolist(), start=n_bodies):
        corner[place, first:] = border[link, first:]
        border[link + 1 : link + 2, place] = off[link : link + 1]
        border[max(link - 1, 0) : link, place] = off[max(link - 1, 0) : link]
    corner[first:, :first] = corner[:first, first:].T
    border[anchors] = border[closure.fixed] = 0.0
    return System(
        factors=bordered(tridiagonal, border, corner),
        anchors=anchors,
        n_bodies=n_bodies,
        n_base=n_base,
        active=active,
        added=added,
        equalities=slice(inner, n_base),
        expected=len(point.A_E) + int(np.count_nonzero(sigma > 0.0)),
    )


def _twins(rows: Rows, A_I: Array) -> Ints:
    """Contact rows that hold what a row of another contact holds."""
    if len(A_I) > MANY:
        return np.zeros(0, dtype=np.intp)
    size = np.sqrt((A_I * A_I).sum(axis=1))
    apart = size[:, None] * size - A_I @ A_I.T
    of = np.array(rows.contact)
    alike = (apart <= ALIKE * size[:, None] * size) & (of[:, None] != of)
    return np.asarray(alike.any(axis=1)).nonzero()[0]


def _curvatures(point: Point) -> list[Factored]:
    """Second derivatives of λ·c over local numbers, of the groups that press."""
    return [group.factored(lam) for group, lam in point.rows.shares(point.lam) if lam.any()]


def own_system(problem: Problem, point: Point) -> System:
    """The system with nothing added to it; for Newton's step, the rate and the curvatures at a state the same one.

    Raises:
        np.linalg.LinAlgError: the tridiagonal part is exactly singular.
    """
    found = known_system(problem, point)
    if found is None:
        found = system(problem, point, 0.0, 0.0)
        point.systems.append((problem, found))
    return found


def known_system(problem: Problem, point: Point) -> System | None:
    """What :func:`own_system` hands out, if it has been asked before."""
    return next((found for its, found in point.systems if its is problem), None)


def _convex_system(problem: Problem, point: Point) -> System:
    """A system that is positive definite on the feasible directions.

    Raises:
        np.linalg.LinAlgError: no shift up to the springs' own stiffness helped.
    """
    for stiffness, shift in TRIES:
        if stiffness and not point.lam.any():
            continue
        try:
            plain = not (stiffness or shift)
            found = own_system(problem, point) if plain else system(problem, point, stiffness, shift)
            if found.convex:
                return found
        except np.linalg.LinAlgError:
            continue
    raise np.linalg.LinAlgError("the energy cannot be made convex")


def many(rows: Rows) -> bool:
    """Whether the contacts are many and each is local: the rows of a fitted boundary are not."""
    return rows.size > MANY and all(group.joints.shape[1] <= LOCAL for group in rows.groups)


def local_system_at(problem: Problem, point: Point) -> LocalSystem:
    """The system with the joints' positions as unknowns, at a state."""
    return local_system(
        problem.model,
        problem.closure,
        point.state,
        point.at,
        point.mu,
        point.lam,
        point.Z,
        point.rows,
        point.gradient,
        point.work,
        problem.stiffened(),
    )


def newton_step(
    problem: Problem, point: Point, *, thorough: bool = False, near: Point | None = None
) -> tuple[Array, Array, Array]:
    """Change of q and the new multipliers μ, λ.

    Args:
        problem: what stays the same.
        point: where the step begins.
        thorough: of many contacts too, find the set that presses by the complementarity problem's own rule, and
            make the energy convex; dear where they are many.
        near: a state nearby with few contacts and the same, whose system is known and good enough.

    Raises:
        np.linalg.LinAlgError: the linearised problem has no solution.
    """
    if many(point.rows) and not thorough:
        return local_step(local_system_at(problem, point), point.lam > 0.0)
    found = _convex_system(problem, point) if near is None else own_system(problem, near)
    n, base = problem.model.n_links, found.n_base
    f = -problem.moves * point.unbalanced
    right = np.concatenate((f[n:], f[found.anchors], found.added, -point.Z))
    f[found.anchors] = 0.0
    first = found.factors.tridiagonal.solve(f[:n, None])[:, 0]
    alone = found.factors.border.T @ first
    if not point.rows.size:
        b = found.schur.solve((right - alone)[:, None])[:, 0]
        return found.change(first - found.factors.solved @ b, b), point.mu + b[found.equalities], point.lam
    S = found.factors.schur
    across = S[:base, base:]
    solved = found.schur.solve(np.concatenate(((right - alone[:base])[:, None], across), axis=1))
    b, X = solved[:, 0], solved[:, 1:]
    G = across.T @ X - S[base:, base:]
    G = 0.5 * (G + G.T)
    lam, _ = pressing(G, point.rows.values + alone[base:] + b @ across + G @ point.lam, point.lam > 0.0)
    more = lam - point.lam
    b = b - X @ more
    change = found.change(first - found.factors.solved @ np.concatenate((b, more)), b)
    return change, point.mu + b[found.equalities], lam
