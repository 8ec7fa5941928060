"""Newton's system with the joints' positions as unknowns: every contact row is local, everything is sparse.

==========  ======================================================================================
θ, p, b     link angles, joint positions x and y, the free bodies' u, v, φ
ρ           forces in the links: multipliers of p_{j+1} − p_j − L_i(cos θ_i, sin θ_i) = 0, and of
            beams' first joints and of marks at their places
μ, λ        multipliers of the equalities (:mod:`cprbm.closure`), and of the contacts that press
==========  ======================================================================================

    [ H_θθ + W   ·    Cᵀ ] [ dθ, dp, db ]   [ −∂PE        ]
    [            C     0 ] [ ρ, μ, λ    ] = [ 0, −Z, −c   ]

Eliminating dp and ρ gives the system of :mod:`cprbm.first_equilibrium`; here nothing is eliminated, no row has
more than a few entries, and the factors grow with the number of links. Which contacts press is found by
changing all wrong ones at once; the factorisation is repeated for each change.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from cprbm.closure import Closure, closure_second, closure_sums
from cprbm.energy import LoadWork, strain_hessian
from cprbm.first_contact import Rows
from cprbm.kinematics import Positions, State, arm, twice
from cprbm.model import Model
from cprbm_scene.answer import Array, Flags, Ints

if TYPE_CHECKING:
    from scipy.sparse.linalg import SuperLU

GIVING = 1e-14  # ℓ³/EI: compliance of the equalities' rows in a Newton step; see :mod:`cprbm.newton`
CHANGES = 12  # of the set that presses, in one Newton step; the next step goes on from the best set
BORDER = 30  # rows by which the set may differ from that which was factorised; a solution costs a part of factors


class _Entries:
    """Entries of a symmetric matrix, gathered as rows, columns and values."""

    def __init__(self) -> None:
        self.rows: list[Ints] = []
        self.columns: list[Ints] = []
        self.values: list[Array] = []

    def add(self, rows: Ints, columns: Ints, values: Array) -> None:
        """Some entries; the three arrays are broadcast together."""
        rows, columns, values = np.broadcast_arrays(rows, columns, values)
        self.rows.append(rows.ravel())
        self.columns.append(columns.ravel())
        self.values.append(np.asarray(values, dtype=float).ravel())

    def both(self, rows: Ints, columns: Ints, values: Array) -> None:
        """Some entries off the diagonal and their mirror images."""
        self.add(rows, columns, values)
        self.add(columns, rows, values)


@dataclass(frozen=True, slots=True)
class LocalSystem:
    """Newton's system without its contact rows, and the contact rows.

    Attributes:
        entries: rows, columns and values of the system without contact rows.
        slopes: rows, columns and values of ∂c, the columns in the system's numbering.
        size: unknowns of the system without contact rows.
        n_links, n_joints, n_bodies: of the model; n_bodies counts u, v, φ.
        fixed: unknowns that do not move.
        right: right-hand side for the step, without contact rows.
        values: c (m,).
        first_mu: where the multipliers of the equalities begin.
    """

    entries: tuple[Ints, Ints, Array]
    slopes: tuple[Ints, Ints, Array]
    size: int
    n_links: int
    n_joints: int
    n_bodies: int
    fixed: Ints
    right: Array
    values: Array
    first_mu: int

    def factorised(self, active: Flags) -> SuperLU:
        """Factors with the rows of the ``active`` contacts.

        Raises:
            RuntimeError: the system is exactly singular.
        """
        from scipy.sparse import coo_array, csc_array  # loaded where contacts are many
        from scipy.sparse.linalg import splu

        number = np.cumsum(active) - 1
        r, c, v = self.slopes
        mine = active[r]
        at, value = self.size + number[r[mine]], v[mine]
        rows = np.concatenate((self.entries[0], at, c[mine]))
        columns = np.concatenate((self.entries[1], c[mine], at))
        n = self.size + int(np.sum(active))
        values = np.concatenate((self.entries[2], value, value))
        keep = ~(np.isin(rows, self.fixed) | np.isin(columns, self.fixed))
        rows = np.concatenate((rows[keep], self.fixed))
        columns = np.concatenate((columns[keep], self.fixed))
        values = np.concatenate((values[keep], np.ones(len(self.fixed))))
        # SuperLU with panels of a single column reads uninitialised memory in a structurally singular matrix
        return splu(csc_array(coo_array((values, (rows, columns)), shape=(n, n))))

    def change(self, solution: Array) -> Array:
        """The part of a solution that is a step of q = (θ, bodies)."""
        first = self.n_links + 2 * self.n_joints
        return np.concatenate((solution[: self.n_links], solution[first : first + self.n_bodies]))

    def linearised(self, solution: Array) -> Array:
        """c + ∂c·step (m,)."""
        r, c, v = self.slopes
        return self.values + np.bincount(r, v * solution[c], minlength=len(self.values))


def local_system(
    model: Model,
    closure: Closure,
    state: State,
    at: Positions,
    mu: Array,
    lam: Array,
    Z: Array,
    rows: Rows,
    gradient: Array,
    work: LoadWork,
    stiffened: Array,
) -> LocalSystem:
    """Assemble the system at a state; ``stiffened`` (n_links,) is added to the second derivatives over θ."""
    n, J, n_bodies = model.n_links, model.n_joints, 3 * model.n_bodies
    first_body = n + 2 * J
    first_rho = first_body + n_bodies
    first_mu = first_rho + 2 * (n + len(model.chains) + len(model.marks))
    size = first_mu + closure.rows

    second, second_bodies = twice(model, state, at, closure_sums(closure, mu) + rows.sums(lam, model))
    over_phi = second_bodies + closure_second(model, closure, state, mu) - work.second
    diagonal, off = strain_hessian(model)
    diagonal, off = diagonal - work.diagonal, off - work.off

    entries = _Entries()
    links = np.arange(n)
    entries.add(links, links, diagonal + second + stiffened)
    entries.both(links[:-1], links[1:], off)
    bodies = first_body + 2 + 3 * np.arange(model.n_bodies)
    entries.add(bodies, bodies, over_phi)

    # link i of beam b runs between joints i + b and i + b + 1 of the shared numbering
    beam = np.concatenate([np.full(chain.n + 1, b) for b, chain in enumerate(model.chains)])
    joint = links + beam
    for axis, turned in ((0, at.dy), (1, -at.dx)):
        row = first_rho + 2 * links + axis
        place = n + axis * J + joint
        entries.both(row, place + 1, np.ones(n))
        entries.both(row, place, -np.ones(n))
        entries.both(row, links, turned)
    for b, chain in enumerate(model.chains):
        place_row, joint_0 = first_rho + 2 * n + 2 * b, chain.first_joint
        lever = arm(chain.start, state.bodies)
        _tie(entries, place_row, n + joint_0, n + J + joint_0, first_body, chain.start.body, lever)
    for m, mark in enumerate(model.marks.values()):
        mark_row, number = first_rho + 2 * (n + len(model.chains) + m), model.first_mark + m
        _tie(entries, mark_row, n + number, n + J + number, first_body, mark.body, arm(mark, state.bodies))
    for r, (b, last) in enumerate(zip(closure.ends, closure.end_joints, strict=True)):
        end = model.chains[b].end
        assert end is not None
        _tie(entries, first_mu + 2 * r, n + last, n + J + last, first_body, end.body, arm(end, state.bodies))
    for r, (link, body) in enumerate(closure.welds, start=2 * len(closure.ends)):
        entries.both(np.array([first_mu + r]), np.array([link]), np.ones(1))
        if body >= 0:
            entries.both(np.array([first_mu + r]), np.array([first_body + 3 * body + 2]), -np.ones(1))
    for p, hinge in enumerate(closure.hinges):
        pin_row = first_mu + closure.first_hinge + 2 * p
        for body, block in hinge.rows(state):
            columns_of = first_body + 3 * body + np.arange(3)
            entries.both((pin_row + np.arange(2))[:, None], columns_of[None], block)
    for r, hold in enumerate(closure.holds, start=first_mu + closure.first_hold):
        entries.both(np.full(3, r), first_body + 3 * hold.at.body + np.arange(3), np.array(hold.row(state)))

    row_numbers, columns, values = [], [], []
    first = 0
    for group, share in rows.shares(lam):
        own = _numbers(model, group.joints, group.angles)
        m = len(group.values)
        row_numbers.append(np.repeat(first + np.arange(m), own.shape[1]))
        columns.append(own.ravel())
        values.append(group.slopes.ravel())
        first += m
        if np.any(share > 0.0):
            blocks = group.curvature(share)
            local = _numbers(model, blocks.joints, blocks.angles)
            entries.add(local[:, :, None], local[:, None, :], blocks.matrices)
    last = np.arange(first_mu, size)
    entries.add(last, last, np.array(-GIVING))
    right = np.zeros(size)
    right[:n], right[first_body:first_rho] = -gradient[:n], -gradient[n:]
    right[first_mu:] = -Z - GIVING * mu
    right[closure.fixed] = 0.0
    return LocalSystem(
        entries=(np.concatenate(entries.rows), np.concatenate(entries.columns), np.concatenate(entries.values)),
        slopes=(
            np.concatenate(row_numbers).astype(np.intp),
            np.concatenate(columns).astype(np.intp),
            np.concatenate(values),
        ),
        size=size,
        n_links=n,
        n_joints=J,
        n_bodies=n_bodies,
        fixed=closure.fixed,
        right=right,
        values=rows.values,
        first_mu=first_mu,
    )


def _numbers(model: Model, joints: Ints, angles: Ints) -> Ints:
    """Where local numbers are in the system, whose bodies stand behind the joints."""
    n, J = model.n_links, model.n_joints
    return np.concatenate((n + joints, n + J + joints, np.where(angles < n, angles, angles + 2 * J)), axis=1)


def _tie(entries: _Entries, row: int, x: int, y: int, first_body: int, body: int, lever: tuple[float, float]) -> None:
    """Rows that hold a joint at a point of a body: x − u + r_y φ and y − v − r_x φ."""
    entries.both(np.array([row, row + 1]), np.array([x, y]), np.ones(2))
    if body >= 0:
        u = first_body + 3 * body
        entries.both(np.array([row, row + 1]), np.array([u, u + 1]), -np.ones(2))
        entries.both(np.array([row, row + 1]), np.array([u + 2, u + 2]), np.array([lever[1], -lever[0]]))


def local_step(system: LocalSystem, pressed: Flags) -> tuple[Array, Array, Array]:
    """Change of q and the new multipliers μ, λ, starting from the contacts that pressed.

    Raises:
        np.linalg.LinAlgError: the system is singular.
    """
    active, best = pressed.copy(), None
    fewest, slack = len(active) + 1, 1e-13 * (1.0 + np.max(np.abs(system.values), initial=0.0))
    found = Solved(system, active)
    for _ in range(CHANGES):
        if np.count_nonzero(active != found.active) > BORDER:
            found = Solved(system, active)
        solution, lam = found.changed_to(active)
        wrong = np.where(active, lam < 0.0, system.linearised(solution) > slack)
        count = int(np.sum(wrong))
        if count < fewest:
            fewest, best = count, active
        if count == 0:
            break
        active = active ^ wrong
    if best is None:
        raise np.linalg.LinAlgError("no solution of the linearised contact problem")
    # what was sought by a border is handed out by factors of its own
    solution, lam = (found if np.array_equal(best, found.active) else Solved(system, best)).changed_to(best)
    return system.change(solution), solution[system.first_mu : system.size], np.maximum(lam, 0.0)


class Solved:
    """The solution with the rows of some contacts ``active`` (m,), from which those with a few others follow.

    With K its matrix, x = K⁻¹f and E a border, the a of a row that presses as well, and a one in the place of λ for one
    that no longer does, the others are x − K⁻¹E y, (EᵀK⁻¹E) y = Eᵀx − g, with −c and nought in g.
    """

    def __init__(self, system: LocalSystem, active: Flags) -> None:
        self.system, self.active = system, active
        try:
            self.factors = system.factorised(active)
        except RuntimeError:
            raise np.linalg.LinAlgError("singular system") from None
        self.own = self.factors.solve(np.concatenate((system.right, -system.values[active])))

    def changed_to(self, active: Flags) -> tuple[Array, Array]:
        """The solution, and λ (m,), with these rows.

        Raises:
            np.linalg.LinAlgError: the system with them is singular.
        """
        system, before, solution = self.system, self.active, self.own
        lam = np.zeros(len(active))
        more, fewer = np.flatnonzero(active & ~before), np.flatnonzero(before & ~active)
        y = np.zeros(0)
        if more.size or fewer.size:
            place = np.full(len(active), -1)
            place[more] = np.arange(len(more))
            r, c, v = system.slopes
            mine = place[r] >= 0
            E = np.zeros((len(solution), len(more) + len(fewer)))
            np.add.at(E, (c[mine], place[r[mine]]), v[mine])
            E[system.size + np.cumsum(before)[fewer] - 1, len(more) + np.arange(len(fewer))] = 1.0
            E[system.fixed] = 0.0
            through, g = self.factors.solve(E), np.zeros(E.shape[1])
            g[: len(more)] = -system.values[more]
            y = np.linalg.solve(E.T @ through, E.T @ solution - g)
            solution = solution - through @ y
        lam[before] = solution[system.size :]
        lam[fewer], lam[more] = 0.0, y[: len(more)]
        return solution, lam
