"""Equilibrium as a minimum of potential energy under equalities and contacts, eq. (1), at one load.

==========  =================================================================================
q           unknowns: link angles θ, then u, v, φ of the free bodies
Z, μ        equalities and their multipliers, :mod:`cprbm.closure`
c, λ        contact constraints c ≤ 0 and forces λ ≥ 0, :mod:`cprbm.contact`
H           Hessian of PE + μ·Z + λ·c: tridiagonal over θ, plus JᵀWJ of the touching places
W = VΣVᵀ    second derivative of λ·c over its local numbers, entered as border columns JᵀV
==========  =================================================================================

One iteration is a Newton step on H with Z linearised; which contacts press is a small
complementarity problem in the compliance of the gaps.  H is made positive definite on the feasible
directions where it is not, first by the stiffness of the contacts that press, then by a shift.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from cprbm.bordered import Bordered, anchored, bordered, without
from cprbm.closure import Closure, closure_forces, closure_rows, closure_second, closure_values
from cprbm.complementarity import pressing
from cprbm.contact import Formulation, Rows
from cprbm.energy import (
    AnyLoad,
    LoadWork,
    load_work,
    spring_moments,
    strain_energy,
    strain_gradient,
    strain_hessian,
)
from cprbm.kinematics import Positions, State, most_turned, position_rows, positions, pulled_back
from cprbm.local import LocalSystem, local_step, local_system
from cprbm.model import Model
from scene.answer import Array, Ints

LONGEST_TURN = 0.5  # of any link in one iteration, rad
CONTACT_STIFFNESS = (1e4, 1e6)  # of pressing contacts while the energy alone is not convex, S/ℓ²; the first that helps
MANY = 40  # contact rows beyond which the system is solved with the joints' positions as unknowns
LOCAL = 8  # joints in a row that is local
PATIENCE = 12  # iterations; then the set that presses may go in circles, and is found by a rule that cannot
SAME = 0.1  # part by which residuals differ that are the same again
CIRCLES = 4  # returns that end the search for places of their own
AWAY = 6  # steps in a row, each longer than the one before
NOTHING = 1e-12  # S: moments below it are no load at all, and what is left is measured by S
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class Drag:
    """A pull back to the angles ``theta`` (n_links,), of ``strength`` per length: adds ½ η Σ L_i (θ_i − θ*_i)²."""

    theta: Array
    strength: float


@dataclass(frozen=True, slots=True)
class Problem:
    """What stays the same along a load path.

    Attributes:
        model, closure, loads: links and springs, equalities, dead loads.
        formulation: the contact rows at a state.
        steady: the same with rows at joints and ends alone, which come and go with nothing but the gaps there; for
            where rows at places of their own come and go in a circle.
        drag: what slows a leap from one branch to another; none in an equilibrium.
    """

    model: Model
    closure: Closure
    loads: Mapping[str, AnyLoad]
    formulation: Formulation
    steady: Formulation
    drag: Drag | None = None

    def stiffened(self) -> Array:
        """What the drag adds to the second derivatives over θ (n_links,)."""
        return self.model.lengths * (0.0 if self.drag is None else self.drag.strength)


@dataclass(frozen=True, slots=True)
class Point:
    """A state with its multipliers and everything first-order there.

    Attributes:
        formulation: by which the contact rows were found.
        state, at: the unknowns and the joints' positions.
        mu, lam: multipliers of the equalities and of the contact rows.
        Z, rows: equalities (mE,) and contact constraints.
        gradient: of the potential energy (n,).
        A_E: derivatives of Z over q.
        work: of the loads.
        systems: Newton's, of problems for which they were asked.
    """

    formulation: Formulation
    state: State
    at: Positions
    mu: Array
    lam: Array
    Z: Array
    rows: Rows
    gradient: Array
    A_E: Array
    work: LoadWork
    systems: list[tuple[Problem, System]] = field(default_factory=list, init=False, repr=False, compare=False)


@dataclass(frozen=True, slots=True)
class Measure:
    """How far a point is from equilibrium, each over its own scale; ``floor`` is round-off's share of residual."""

    residual: float
    floor: float
    violation: float
    overlap: float
    complementarity: float


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """Where an equilibrium solve ended."""

    point: Point
    measure: Measure
    iterations: int
    converged: bool


def point_at(problem: Problem, values: dict[str, float], state: State, mu: Array, lam: Array, before: Rows) -> Point:
    """Evaluate a state; ``lam`` belongs to the rows ``before`` and is carried over to those found here."""
    at = positions(problem.model, state)
    rows = problem.formulation(state, at, before)
    return _point(problem, values, state, at, mu, carried(before, lam, rows, problem.model), rows)


def point_under(problem: Problem, values: dict[str, float], point: Point) -> Point:
    """The state of a ``point`` under other values; its rows are the same where they are found in the same way."""
    if point.formulation is not problem.formulation:
        return point_at(problem, values, point.state, point.mu, point.lam, point.rows)
    return _point(problem, values, point.state, point.at, point.mu, point.lam, point.rows)


def _point(
    problem: Problem, values: dict[str, float], state: State, at: Positions, mu: Array, lam: Array, rows: Rows
) -> Point:
    model = problem.model
    work = load_work(model, problem.loads, values, state, at)
    gradient = -work.gradient
    gradient[: model.n_links] += strain_gradient(model, state)
    if problem.drag is not None:
        gradient[: model.n_links] += problem.stiffened() * (state.theta - problem.drag.theta)
    return Point(
        formulation=problem.formulation,
        state=state,
        at=at,
        mu=mu,
        lam=lam,
        Z=closure_values(model, problem.closure, state, at, values),
        rows=rows,
        gradient=gradient,
        A_E=closure_rows(model, problem.closure, state, at),
        work=work,
    )


def local_rows(model: Model, state: State, at: Positions, joints: Ints, angles: Ints) -> Array:
    """Derivatives of local numbers over q: for joints (g, p) and angles (g, a), (g, 2p + a, n_links + 3B)."""
    (g, p), a = joints.shape, angles.shape[1]
    rows_x, rows_y = position_rows(model, state, at, joints.ravel())
    width = rows_x.shape[1]
    rows = np.zeros((g, 2 * p + a, width))
    rows[:, :p], rows[:, p : 2 * p] = rows_x.reshape(g, p, width), rows_y.reshape(g, p, width)
    rows[np.arange(g)[:, None], 2 * p + np.arange(a), angles] = 1.0
    return rows


def contact_rows(model: Model, point: Point) -> Array:
    """∂c over q, (m, n_links + 3B)."""
    parts = [np.zeros((0, model.n_links + 3 * len(model.free_bodies)))]
    for group in point.rows.groups:
        if np.all(group.joints == group.joints[0]) and np.all(group.angles == group.angles[0]):
            # rows of one boundary share their local numbers
            J = local_rows(model, point.state, point.at, group.joints[:1], group.angles[:1])
            parts.append(group.slopes @ J[0])
            continue
        m, p = group.joints.shape
        over_x, over_y = position_rows(model, point.state, point.at, group.joints.ravel())
        found = (group.slopes[:, :p].reshape(m, 1, p) @ over_x.reshape(m, p, -1))[:, 0]
        found += (group.slopes[:, p : 2 * p].reshape(m, 1, p) @ over_y.reshape(m, p, -1))[:, 0]
        flat = np.arange(m)[:, None] * found.shape[1] + group.angles
        found += np.bincount(flat.ravel(), group.slopes[:, 2 * p :].ravel(), found.size).reshape(found.shape)
        parts.append(found)
    return np.concatenate(parts)


def contact_gradient(model: Model, point: Point) -> Array:
    """∂(λ·c) over q (n_links + 3B,), without forming ∂c."""
    fx, fy, moments = point.rows.forces(point.lam, model.n_joints, model.n_unknowns)
    over_theta, over_bodies, _, _ = pulled_back(model, point.state, point.at, fx, fy)
    return np.concatenate((over_theta, over_bodies)) + moments


def carried(before: Rows, lam: Array, rows: Rows, model: Model) -> Array:
    """Contact forces of an earlier state on the rows of this one: by key, or to the nearest place."""
    if rows.keys == before.keys:
        return lam
    forces = np.zeros(rows.size)
    reach = 2.0 * max(chain.h for chain in model.chains)
    by_key = {key: i for i, key in enumerate(rows.keys)} if len(set(rows.keys)) == rows.size else {}
    for force, key, arc, contact in zip(lam, before.keys, before.arc, before.contact, strict=True):
        if force <= 0.0:
            continue
        if key in by_key:
            forces[by_key[key]] += force
            continue
        forces[rows.nearest(contact, arc, reach)] += force
    return forces


def measure(problem: Problem, point: Point) -> Measure:
    """Residuals of the optimality conditions over the largest terms in them; over S where there is no load."""
    model = problem.model
    free = np.ones(len(point.gradient), dtype=bool)
    free[problem.closure.fixed] = False
    parts = (point.gradient, point.A_E.T @ point.mu, contact_gradient(model, point))
    terms = sum(np.abs(part) for part in parts)
    moments = np.abs(spring_moments(model, point.state))
    scale = max(float(np.max(terms, initial=0.0)), float(np.max(moments, initial=0.0)))
    scale = scale if scale > NOTHING else 1.0
    residual = parts[0] + parts[1] + parts[2]
    largest = float(np.max(np.abs(residual[free]), initial=0.0))
    # an angle is known to eps·|θ|, a spring's moment to the stiffness times that
    turned = max(1.0, float(np.max(np.abs(point.state.theta))))
    floor = 4.0 * EPS * float(np.max(model.couplings)) * turned + 4.0 * EPS * np.sqrt(model.n_links) * scale
    return Measure(
        residual=largest / scale,
        floor=float(floor / scale),
        violation=float(np.max(np.abs(point.Z), initial=0.0)),
        overlap=float(np.max(point.rows.values, initial=0.0)),
        complementarity=float(np.max(np.abs(point.lam * point.rows.values), initial=0.0)) / scale,
    )


@dataclass(frozen=True, slots=True)
class System:
    """A factorised Newton system, the places of its border columns, and ∂c over q, ``slopes`` (m, n_links + 3B)."""

    factors: Bordered
    base: Ints
    contacts: Ints
    equalities: Ints
    right: Array
    anchors: Ints
    expected: int
    n_links: int
    slopes: Array

    def step(self, keep: Ints, right: Array, f: Array) -> tuple[Array, Array]:
        """Change of q and the border's solution for the columns ``keep``."""
        a, b = self.factors.solve(f[: self.n_links], right, keep)
        n_bodies = len(f) - self.n_links
        change = np.concatenate((a, b[:n_bodies]))
        change[self.anchors] = b[n_bodies : n_bodies + len(self.anchors)]
        return change, b


def system(problem: Problem, point: Point, stiff: Array, shift: float) -> System:
    """Assemble and factorise; ``stiff`` (m,) are stiffnesses of contacts that are added, nought of most.

    Raises:
        np.linalg.LinAlgError: the tridiagonal part is exactly singular.
    """
    model, closure, rows = problem.model, problem.closure, point.rows
    n, n_bodies = model.n_links, 3 * len(model.free_bodies)
    A_I = contact_rows(model, point)
    fx, fy = closure_forces(model, closure, point.mu)
    cx, cy, _ = rows.forces(point.lam, model.n_joints, model.n_unknowns)
    fx, fy = fx + cx, fy + cy
    _, _, second, second_bodies = pulled_back(model, point.state, point.at, fx, fy)
    diagonal, off = strain_hessian(model)
    diagonal = diagonal + second + shift * model.lengths + problem.stiffened() - point.work.diagonal
    off = off - point.work.off
    over_phi = second_bodies + closure_second(model, closure, point.state, point.mu) - point.work.second

    columns, curvatures, known = [], [], []
    for group, lam in rows.shares(point.lam):
        if not np.any(lam > 0.0):
            continue
        blocks = group.curvature(lam)
        if not blocks.matrices.size:
            continue
        sigma, V = np.linalg.eigh(blocks.matrices)
        J = local_rows(model, point.state, point.at, blocks.joints, blocks.angles)
        along = np.einsum("gkj,gkn->gjn", V, J).reshape(sigma.size, -1)
        real = np.abs(sigma).ravel() > 1e-13 * np.max(np.abs(sigma), initial=0.0)
        columns.append(along[real].T)
        curvatures.append(sigma.ravel()[real])
        known.append(np.zeros(int(np.sum(real))))
    if np.any(stiff):
        columns.append(A_I[stiff > 0.0].T)
        curvatures.append(stiff[stiff > 0.0])
        known.append(-rows.values[stiff > 0.0])
    low_rank = np.concatenate(columns, axis=1) if columns else np.zeros((n + n_bodies, 0))
    sigma = np.concatenate(curvatures) if curvatures else np.zeros(0)
    free = [c.first_link for c in model.chains if c.first_link not in closure.fixed]
    anchors = anchored(diagonal, off, model.lengths, np.array(free, dtype=np.intp), closure.fixed)

    m_E, m_I, r, k = closure.rows, rows.size, len(sigma), len(anchors)
    first = n_bodies + k
    size = first + r + m_E + m_I
    border, corner = np.zeros((n, size)), np.zeros((size, size))
    wide = np.concatenate((low_rank, point.A_E.T, A_I.T), axis=1)
    border[:, first:] = wide[:n]
    corner[:n_bodies, first:] = wide[n:]
    corner[2:n_bodies:3, 2:n_bodies:3] = np.diag(over_phi)
    i = np.arange(r)
    corner[first + i, first + i] = -1.0 / sigma
    for place, link in enumerate(anchors, start=n_bodies):
        corner[place, place] = diagonal[link]
        corner[place, first:] = border[link, first:]
        border[link + 1 : link + 2, place] = off[link : link + 1]
        border[max(link - 1, 0) : link, place] = off[max(link - 1, 0) : link]
    corner[first:, :first] = corner[:first, first:].T
    held = np.concatenate((anchors, closure.fixed))
    border[held] = 0.0
    diagonal, off = without(diagonal, off, held)
    return System(
        factors=bordered(diagonal, off, border, corner),
        base=np.arange(first + r + m_E),
        contacts=np.arange(first + r + m_E, size),
        equalities=np.arange(first + r, first + r + m_E),
        right=np.concatenate((np.zeros(first), *known, -point.Z))
        if known
        else np.concatenate((np.zeros(first), -point.Z)),
        anchors=anchors,
        expected=m_E + int(np.sum(sigma > 0.0)),
        n_links=n,
        slopes=A_I,
    )


def own_system(problem: Problem, point: Point) -> System:
    """The system with nothing added to it; for Newton's step, the rate and the curvatures at a state the same one.

    Raises:
        np.linalg.LinAlgError: the tridiagonal part is exactly singular.
    """
    for its, found in point.systems:
        if its is problem:
            return found
    found = system(problem, point, np.zeros(point.rows.size), 0.0)
    point.systems.append((problem, found))
    return found


def _convex_system(problem: Problem, point: Point) -> System:
    """A system that is positive definite on the feasible directions.

    Raises:
        np.linalg.LinAlgError: no shift up to the springs' own stiffness helped.
    """
    none = np.zeros(point.rows.size)
    tries = [(none, 0.0)]
    if np.any(point.lam > 0.0):
        tries += [(np.where(point.lam > 0.0, stiffness, 0.0), 0.0) for stiffness in CONTACT_STIFFNESS]
    tries += [(none, 4.0**i) for i in range(1, 12)]
    for stiff, shift in tries:
        try:
            plain = shift == 0.0 and not np.any(stiff)
            found = own_system(problem, point) if plain else system(problem, point, stiff, shift)
            if found.factors.negative(found.base) == found.expected:
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


def newton_step(problem: Problem, point: Point, *, thorough: bool = False) -> tuple[Array, Array, Array]:
    """Change of q and the new multipliers μ, λ.

    Args:
        problem: what stays the same.
        point: where the step begins.
        thorough: of many contacts too, find the set that presses by the complementarity problem's own rule, and
            make the energy convex; dear where they are many.

    Raises:
        np.linalg.LinAlgError: the linearised problem has no solution.
    """
    if many(point.rows) and not thorough:
        return local_step(local_system_at(problem, point), point.lam > 0.0)
    found = _convex_system(problem, point)
    f = -point.gradient.copy()
    f[problem.closure.fixed] = 0.0
    n, n_bodies = found.n_links, len(f) - found.n_links
    right = found.right.copy()
    right[:n_bodies] += f[n:]
    right[n_bodies : n_bodies + len(found.anchors)] += f[found.anchors]
    change, b = found.step(found.base, right, f)
    lam = np.zeros(point.rows.size)
    if point.rows.size:
        S, base, contacts = found.factors.schur, found.base, found.contacts
        across = S[np.ix_(base, contacts)]
        G = -(S[np.ix_(contacts, contacts)] - across.T @ np.linalg.solve(S[np.ix_(base, base)], across))
        lam, active = pressing(0.5 * (G + G.T), point.rows.values + found.slopes @ change, point.lam > 0.0)
        if np.any(active):
            keep = np.concatenate((base, contacts[active]))
            change, b = found.step(keep, np.concatenate((right, -point.rows.values[active])), f)
            lam = np.zeros(point.rows.size)
            lam[active] = np.maximum(b[len(base) :], 0.0)
    return change, b[found.equalities], lam


def potential_energy(problem: Problem, point: Point) -> float:
    """PE of eq. (4), units of S."""
    return strain_energy(problem.model, point.state) - point.work.value


def equilibrium(
    problem: Problem,
    values: dict[str, float],
    start: Point,
    tolerance: float,
    iterations: int,
    *,
    settle: bool = False,
    farthest: float = np.inf,
) -> Equilibrium:
    """Newton's method from ``start`` to the equilibrium under the loads' and drives' ``values`` (SI).

    Where it comes back to a residual it had, the row sets of two or three states follow each other in a circle, and
    a part of the step is taken.  Where it comes back for good, the steady rows decide if they may ``settle`` it;
    otherwise that is the end.  Where ``farthest`` says (rad) by what a link turns at most, so it is beyond that, and
    where steps grow and grow: they lead away from a state that is no minimum.
    """
    model = problem.model
    point = point_under(problem, values, start)
    now = measure(problem, point)
    seen: list[float] = []
    part, circles = 1.0, 0
    grown, last = 0, np.inf
    for iteration in range(1, iterations + 1):
        try:
            change, mu, lam = newton_step(problem, point, thorough=iteration > PATIENCE)
        except np.linalg.LinAlgError:
            return Equilibrium(point, now, iteration, converged=False)
        longest = float(np.max(np.abs(change[: model.n_links])))
        if not np.isfinite(longest):
            return Equilibrium(point, now, iteration, converged=False)
        grown, last = grown + 1 if longest > last else 0, longest
        if grown == AWAY and np.isfinite(farthest):
            return Equilibrium(point, now, iteration, converged=False)
        returns = _returns(seen, now.residual)
        part = 0.5 * part if returns else min(1.0, 2.0 * part)
        circles += returns
        if circles == CIRCLES and not settle:
            return Equilibrium(point, now, iteration, converged=False)
        if circles == CIRCLES:
            problem = replace(problem, formulation=problem.steady)
        seen.append(now.residual)
        scale = min(part, LONGEST_TURN / longest) if longest > 0.0 else part
        state = point.state.moved(scale * change, model.n_links)
        point = point_at(problem, values, state, mu, lam, point.rows)
        now = measure(problem, point)
        if most_turned(start.state, state) > farthest:
            return Equilibrium(point, now, iteration, converged=False)
        if scale == 1.0 and _settled(now, longest, tolerance):
            return Equilibrium(point, now, iteration, converged=True)
    return Equilibrium(point, now, iterations, converged=False)


def _returns(seen: list[float], residual: float) -> bool:
    """Whether an iteration is back where it was two or three before: each state denies the other's rows."""
    return any(abs(residual - before) < SAME * before for before in seen[-3:-1])


def _settled(now: Measure, longest: float, tolerance: float) -> bool:
    return (
        now.residual <= max(tolerance, now.floor)
        and now.violation <= max(tolerance, 100.0 * EPS)
        and now.overlap <= max(tolerance, 100.0 * EPS)
        and longest <= 1e-5
    )
