"""What a contact formulation hands to the equilibrium solver.

A gap depends on a few local numbers z: positions of some joints, and angles of some links (or bodies).  A formulation
states its constraints c(z) ≤ 0, their first derivatives, and the second derivative of λ·c; how z depends
on the unknowns is the same for all and lives in :mod:`cprbm.kinematics`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from scipy.linalg import lapack

from cprbm import kinematics
from cprbm.kinematics import Positions, State
from cprbm.model import Chain, Model
from cprbm.once import once
from cprbm.strands import Faces
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.frozendict import frozendict

Sides = tuple[float, float]
"""That of B on which A lies, and of A on which B does, :mod:`cprbm.sighting`."""

REAL = 1e-13  # of the largest curvature of a group; what is below it is round-off


@dataclass(frozen=True, slots=True)
class Local:
    """Rows over local numbers.

    Attributes:
        joints, angles: what enters each row, (r, p) and (r, a).
        slopes: derivatives over x of the joints, y of the joints, angles (r, 2p + a).
    """

    joints: Ints
    angles: Ints
    slopes: Array


def over_unknowns(model: Model, state: State, at: Positions, parts: Sequence[Local]) -> Array:
    """Derivatives of rows over all unknowns, part behind part (Σr, n_links + 3B)."""
    if not parts:
        return np.zeros((0, model.n_unknowns))
    sums = [_sums(model, part) for part in parts]
    every = sums[0] if len(parts) == 1 else np.concatenate(sums)
    rows = kinematics.over_unknowns_by(model, state, at, every[:, 0], every[:, 1])
    first = 0
    for part in parts:
        (r, _), (_, p), (_, a) = part.slopes.shape, part.joints.shape, part.angles.shape
        mine = rows[first : first + r]
        if a:
            places = (np.arange(r)[:, None] * model.n_unknowns + part.angles).ravel()
            np.add.at(mine.reshape(-1), places, part.slopes[:, 2 * p :].ravel())
        first += r
    return rows


def _sums(model: Model, part: Local) -> Array:
    """Slopes over x and over y of joints, summed as :func:`cprbm.kinematics.summed` says (r, 2, n_links + k)."""
    (r, _), (_, p) = part.slopes.shape, part.joints.shape
    if model.hanging is not None:
        return part.slopes[:, : 2 * p].reshape(r, 2, p) @ model.hanging[part.joints]
    forces = np.zeros((2, r, model.n_joints))
    if p:
        along, across = forces.reshape(2, -1)
        places = (np.arange(r)[:, None] * model.n_joints + part.joints).ravel()
        np.add.at(along, places, part.slopes[:, :p].ravel())
        np.add.at(across, places, part.slopes[:, p : 2 * p].ravel())
    return kinematics.summed(model, forces[0], forces[1]).swapaxes(0, 1)


@dataclass(frozen=True, slots=True)
class Factored:
    """A second derivative Σ σ v vᵀ.

    Attributes:
        columns: v, as rows over local numbers (r).
        sigma: σ, none of them nought (r,).
    """

    columns: Local
    sigma: Array


@dataclass(frozen=True, slots=True)
class Blocks:
    """Second derivatives as g small matrices over local numbers of their own.

    Attributes:
        joints: whose x and y enter (g, p); angles: links whose θ enters (g, a).
        matrices: (g, 2p + a, 2p + a), over x of the joints, y of the joints, θ of the links.
    """

    joints: Ints
    angles: Ints
    matrices: Array

    def factored(self) -> Factored:
        """The same by eigenvalues."""
        if not self.matrices.size:
            return Factored(Local(self.joints[:0], self.angles[:0], np.zeros((0, self.matrices.shape[1]))), np.zeros(0))
        sigma, vectors = _by_eigenvalues(self.matrices)
        size = np.abs(sigma)
        block, number = (size > REAL * size.max()).nonzero()
        columns = Local(self.joints[block], self.angles[block], vectors[block, :, number])
        return Factored(columns, sigma[block, number])


def _by_eigenvalues(matrices: Array) -> tuple[Array, Array]:
    """Eigenvalues (g, n) and vectors (g, n, n) of g symmetric matrices; of one without what NumPy asks before.

    Raises:
        np.linalg.LinAlgError: they were not found.
    """
    if len(matrices) > 1:
        return np.linalg.eigh(matrices)
    sigma, vectors, failed = lapack.dsyevd(matrices[0], lower=1)
    if failed:
        raise np.linalg.LinAlgError("no eigenvalues of a contact's second derivative")
    return sigma[None], vectors[None]


@dataclass(frozen=True, slots=True)
class Group:
    """Constraints of one kind at one state.

    Attributes:
        contact: name of the contact.
        values: c (m,), units of length, feasible where ≤ 0.
        joints, angles: what enters each row, (m, p) and (m, a); angles by their number among the unknowns.
        slopes: ∂c over (x of joints, y of joints, angles), (m, 2p + a).
        curvature: λ (m,) ↦ blocks of ∂²(λ·c)/∂z².
        keys: what each row is, to recognise it again in the next iteration; −1 for a place that moves.
        arc: arc length on the contact's first beam where each row acts (m,).
        reach: length of the first beam, before and behind ``arc``, whose joints have these rows and no others.
        itself: whether a beam touches itself, at two places of which the first has the first joint.
    """

    contact: str
    values: Array
    joints: Ints
    angles: Ints
    slopes: Array
    curvature: Callable[[Array], Blocks]
    keys: tuple[int, ...]
    arc: Array
    reach: float = 0.0
    itself: bool = False

    @property
    def local(self) -> Local:
        """∂c."""
        return Local(self.joints, self.angles, self.slopes)

    def factored(self, multipliers: Array) -> Factored:
        """∂²(λ·c)."""
        return self.curvature(multipliers).factored()

    @property
    def holds_angles(self) -> bool:
        """Whether the rows limit angles alone, so that their multipliers are moments."""
        return self.joints.size == 0

    def on_first(self, chain: Chain) -> tuple[Array, Array]:
        """∂c over x and over y of the contact's first beam, which is ``chain``, (m,) each."""
        p = self.joints.shape[1]
        mine = (self.joints >= chain.joints.start) & (self.joints < chain.joints.stop)
        if self.itself:
            mine[:, 1:] = False
        return np.sum(self.slopes[:, :p] * mine, axis=1), np.sum(self.slopes[:, p : 2 * p] * mine, axis=1)


@dataclass(frozen=True)
class Rows:
    """All constraints at one state, group behind group.

    ``faces`` are the sides by which beams face themselves, by contact, and ``sides`` those of each other on which beams
    were seen; they go from state to state.
    """

    groups: tuple[Group, ...]
    faces: Mapping[str, Faces] = frozendict()
    sides: Mapping[str, Sides] = frozendict()

    @once
    def values(self) -> Array:
        """c (m,)."""
        if len(self.groups) == 1:
            return self.groups[0].values
        return np.concatenate([group.values for group in self.groups]) if self.groups else np.zeros(0)

    @once
    def arc(self) -> Array:
        """Arc length on each contact's first beam (m,)."""
        return np.concatenate([group.arc for group in self.groups]) if self.groups else np.zeros(0)

    @once
    def holds_angles(self) -> Flags:
        """Which rows limit angles alone (m,)."""
        found = [np.full(len(group.values), group.holds_angles) for group in self.groups]
        return np.concatenate([np.zeros(0, dtype=bool), *found])

    @once
    def reach(self) -> Array:
        """Length of the first beam before and behind each row whose joints have no others (m,)."""
        return np.repeat([group.reach for group in self.groups], [len(group.values) for group in self.groups])

    @once
    def keys(self) -> tuple[tuple[str, int], ...]:
        """What each row is: its contact and its key there."""
        return tuple([(group.contact, key) for group in self.groups for key in group.keys])

    def pressed(self, multipliers: Array) -> frozenset[tuple[str, int]]:
        """Keys of the rows whose multiplier is positive."""
        pressing = (multipliers > 0.0).nonzero()[0].tolist()
        return frozenset([self.keys[row] for row in pressing]) if pressing else frozenset()

    @once
    def contact(self) -> tuple[str, ...]:
        """Name of each row's contact."""
        return tuple([group.contact for group in self.groups for _ in group.keys])

    @property
    def size(self) -> int:
        """Number of constraints m."""
        return self.values.size

    def nearest(self, contact: str, arc: float, reach: float = np.inf) -> Ints:
        """Number of the row of a contact that is nearest to an arc length, (1,); (0,) where none is within reach."""
        mine = np.array([name == contact for name in self.contact], dtype=bool)
        away = np.abs(self.arc - arc)
        near = (mine & (away <= reach)).nonzero()[0]
        return near[away[near].argsort(kind="stable")[:1]]

    @once
    def spans(self) -> tuple[slice, ...]:
        """Where the rows of each group are."""
        ends = [0, *accumulate([group.values.size for group in self.groups])]
        return tuple([slice(begin, end) for begin, end in pairwise(ends)])

    def same(self, before: Rows) -> bool:
        """Whether these are the rows of another state, by contacts and keys."""
        # the same keys of another contact are other rows
        return len(self.groups) == len(before.groups) and (
            [(group.contact, group.keys) for group in self.groups]
            == [(group.contact, group.keys) for group in before.groups]
        )

    def shares(self, multipliers: Array) -> list[tuple[Group, Array]]:
        """Every group with its part of the multipliers (m,)."""
        return [(group, multipliers[span]) for group, span in zip(self.groups, self.spans, strict=True)]

    def pressing(self, multipliers: Array) -> set[str]:
        """Names of the contacts and stops that have a row whose multiplier is positive."""
        return {group.contact for group, lam in self.shares(multipliers) if (lam > 0.0).any()}

    def forces(self, multipliers: Array, n_joints: int, n_unknowns: int) -> tuple[Array, Array, Array]:
        """∂(λ·c) over x and y of all joints (n_joints,), and what is over unknown angles at once (n_unknowns,)."""
        fx, fy, moments = np.zeros(n_joints), np.zeros(n_joints), np.zeros(n_unknowns)
        for group, lam in self.shares(multipliers):
            pressing = lam.nonzero()[0]
            if not pressing.size:
                continue
            p = group.joints.shape[1]
            local, joints = lam[pressing, None] * group.slopes[pressing], group.joints[pressing].ravel()
            np.add.at(fx, joints, local[:, :p].ravel())
            np.add.at(fy, joints, local[:, p : 2 * p].ravel())
            np.add.at(moments, group.angles[pressing].ravel(), local[:, 2 * p :].ravel())
        return fx, fy, moments

    def sums(self, multipliers: Array, model: Model) -> Array:
        """∂(λ·c) over x and y of all joints, summed as :func:`cprbm.kinematics.summed` says (2, n_links + k)."""
        if model.hanging is None:
            fx, fy, _ = self.forces(multipliers, model.n_joints, model.n_unknowns)
            return kinematics.summed(model, fx, fy)
        found = np.zeros((2, model.hanging.shape[1]))
        for group, lam in self.shares(multipliers):
            pressing, p = lam.nonzero()[0], group.joints.shape[1]
            if pressing.size and p:
                local = lam[pressing, None] * group.slopes[pressing, : 2 * p]
                forces = local.reshape(-1, 2, p).swapaxes(0, 1).reshape(2, -1)
                found += forces @ model.hanging[group.joints[pressing].ravel()]
        return found

    def over_unknowns(self, model: Model, state: State, at: Positions) -> Array:
        """∂c over all unknowns (m, n_links + 3B)."""
        return over_unknowns(model, state, at, [group.local for group in self.groups])


Formulation = Callable[[State, Positions, Rows], Rows]
"""The rows at a state, and those of a state before."""

NO_ROWS = Rows(())
