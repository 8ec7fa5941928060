"""A state of a mechanism under given loads and drives, with its multipliers and everything first-order there.

==========  =================================================================================
q           unknowns: link angles θ, then u, v, φ of the free bodies
PE          potential energy, eq. (4)
Z, μ        equalities and their multipliers, :mod:`cprbm.closure`
c, λ        contact constraints c ≤ 0 and forces λ ≥ 0, :mod:`cprbm.first_contact`
==========  =================================================================================
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from cprbm.bordered import Held, generic
from cprbm.closure import Closure, closure_rows, closure_values
from cprbm.energy import AnyLoad, LoadWork, load_work, spring_moments, strain_energy, strain_gradient, strain_hessian
from cprbm.first_contact import Formulation, Rows
from cprbm.kinematics import Positions, State, positions, pulled_back
from cprbm.model import Model
from cprbm.once import once
from cprbm_scene.answer import Array, Ints

if TYPE_CHECKING:
    from cprbm.newton import System

FEW = 40  # contact rows


@dataclass(frozen=True, slots=True)
class Drag:
    """A pull back to the angles ``theta`` (n_links,), of ``strength`` per length: adds ½ η Σ L_i (θ_i − θ*_i)²."""

    theta: Array
    strength: float


@dataclass(frozen=True)
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

    @once
    def springs(self) -> tuple[Array, Array]:
        """Diagonal (n_links,) and off-diagonal (n_links−1,) of what the second derivatives over θ always hold."""
        diagonal, off = strain_hessian(self.model)
        return diagonal + self.stiffened(), off

    @once
    def moves(self) -> Array:
        """One for each unknown, nought for links that do not turn (n_unknowns,)."""
        moves = np.ones(self.model.n_unknowns)
        moves[self.closure.fixed] = 0.0
        return moves

    @once
    def loose(self) -> Ints:
        """The first links of beams, but those that do not turn."""
        fixed = set(self.closure.fixed.tolist())
        first = [chain.first_link for chain in self.model.chains if chain.first_link not in fixed]
        return np.array(first, dtype=np.intp)

    @once
    def still(self) -> Held:
        """The :attr:`loose` ones and those that do not turn."""
        return Held(np.concatenate((self.loose, self.closure.fixed)), self.model.n_links)

    @once
    def generic(self) -> Array:
        """A right-hand side with a part in every direction, :func:`cprbm.bordered.generic`, (n_links,)."""
        return generic(self.model.lengths, self.still.unknowns)

    def stiffened(self) -> Array:
        """What the drag adds to the second derivatives over θ (n_links,)."""
        return self.model.lengths * (0.0 if self.drag is None else self.drag.strength)


@dataclass(frozen=True)
class Point:
    """A state with its multipliers and everything first-order there.

    Attributes:
        model: of which it is a state.
        formulation: by which the contact rows were found.
        state, at: the unknowns and the joints' positions.
        mu, lam: multipliers of the equalities and of the contact rows.
        Z, rows: equalities (mE,) and contact constraints.
        moments: of the springs (n_links−1,).
        gradient: of the potential energy (n,).
        A_E: derivatives of Z over q.
        work: of the loads.
        systems: Newton's, of problems for which they were asked.
    """

    model: Model
    formulation: Formulation
    state: State
    at: Positions
    mu: Array
    lam: Array
    Z: Array
    rows: Rows
    moments: Array
    gradient: Array
    A_E: Array
    work: LoadWork
    systems: list[tuple[Problem, System]] = field(default_factory=list, init=False, repr=False, compare=False)

    @property
    def bare(self) -> Point:
        """The same without what was worked out from it, for those who keep many."""
        return replace(self)

    @once
    def slopes(self) -> Array:
        """∂c over q, (m, n_links + 3B)."""
        return contact_rows(self.model, self)

    @once
    def held(self) -> Array:
        """∂(μ·Z) over q (n_links + 3B,)."""
        return np.asarray(self.mu @ self.A_E)

    @once
    def unbalanced(self) -> Array:
        """∂L over q (n_links + 3B,)."""
        return self.gradient + self.held + self.pressed

    @once
    def pressed(self) -> Array:
        """∂(λ·c) over q (n_links + 3B,)."""
        # few rows are wanted as such for the next step
        return self.lam @ self.slopes if self.rows.size <= FEW else contact_gradient(self.model, self)


def point_at(problem: Problem, values: dict[str, float], state: State, mu: Array, lam: Array, before: Rows) -> Point:
    """Evaluate a state; ``lam`` belongs to the rows ``before`` and is carried over to those found here."""
    at = positions(problem.model, state)
    rows = problem.formulation(state, at, before)
    return _point(problem, values, state, at, mu, carried(before, lam, rows, problem.model), rows)


def point_under(problem: Problem, values: dict[str, float], point: Point) -> Point:
    """The state of a ``point`` under other values; its rows are the same where they are found in the same way."""
    if point.formulation is not problem.formulation:
        return point_at(problem, values, point.state, point.mu, point.lam, point.rows)
    found = _point(problem, values, point.state, point.at, point.mu, point.lam, point.rows)
    if found.work.curved_as(point.work):
        found.systems.extend(point.systems)
    return found


def _point(
    problem: Problem, values: dict[str, float], state: State, at: Positions, mu: Array, lam: Array, rows: Rows
) -> Point:
    model = problem.model
    work = load_work(model, problem.loads, values, state, at)
    gradient = -work.gradient
    moments = spring_moments(model, state)
    gradient[: model.n_links] += strain_gradient(moments)
    if problem.drag is not None:
        gradient[: model.n_links] += problem.stiffened() * (state.theta - problem.drag.theta)
    return Point(
        model=model,
        formulation=problem.formulation,
        state=state,
        at=at,
        mu=mu,
        lam=lam,
        Z=closure_values(model, problem.closure, state, at, values),
        rows=rows,
        moments=moments,
        gradient=gradient,
        A_E=closure_rows(model, problem.closure, state, at),
        work=work,
    )


def contact_rows(model: Model, point: Point) -> Array:
    """∂c over q, (m, n_links + 3B)."""
    return point.rows.over_unknowns(model, point.state, point.at)


def contact_gradient(model: Model, point: Point) -> Array:
    """∂(λ·c) over q (n_links + 3B,), without forming ∂c."""
    if not np.count_nonzero(point.lam):
        return np.zeros(model.n_unknowns)
    fx, fy, moments = point.rows.forces(point.lam, model.n_joints, model.n_unknowns)
    over_theta, over_bodies, _, _ = pulled_back(model, point.state, point.at, fx, fy)
    return np.concatenate((over_theta, over_bodies)) + moments


def carried(before: Rows, lam: Array, rows: Rows, model: Model) -> Array:
    """Contact forces of an earlier state on the rows of this one: by key, or to the nearest place."""
    if rows.same(before):
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


def potential_energy(problem: Problem, point: Point) -> float:
    """PE of eq. (4), units of S."""
    return strain_energy(problem.model, point.state) - point.work.value
