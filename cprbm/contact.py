"""What a contact formulation hands to the equilibrium solver.

A gap depends on a few local numbers z: positions of some joints, and angles of some links (or bodies).  A formulation
states its constraints c(z) ≤ 0, their first derivatives, and the second derivative of λ·c; how z depends
on the unknowns is the same for all and lives in :mod:`cprbm.kinematics`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from frozendict import frozendict

from cprbm.kinematics import Positions, State
from cprbm.model import Chain
from cprbm.strands import Faces
from scene.answer import Array, Flags, Ints


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

    ``faces`` are the sides by which beams face themselves, by contact; they go from state to state.
    """

    groups: tuple[Group, ...]
    faces: Mapping[str, Faces] = frozendict()

    @cached_property
    def values(self) -> Array:
        """c (m,)."""
        return np.concatenate([group.values for group in self.groups]) if self.groups else np.zeros(0)

    @cached_property
    def arc(self) -> Array:
        """Arc length on each contact's first beam (m,)."""
        return np.concatenate([group.arc for group in self.groups]) if self.groups else np.zeros(0)

    @cached_property
    def holds_angles(self) -> Flags:
        """Which rows limit angles alone (m,)."""
        found = [np.full(len(group.values), group.holds_angles) for group in self.groups]
        return np.concatenate([np.zeros(0, dtype=bool), *found])

    @cached_property
    def reach(self) -> Array:
        """Length of the first beam before and behind each row whose joints have no others (m,)."""
        return np.repeat([group.reach for group in self.groups], [len(group.values) for group in self.groups])

    @cached_property
    def keys(self) -> tuple[tuple[str, int], ...]:
        """What each row is: its contact and its key there."""
        return tuple((group.contact, key) for group in self.groups for key in group.keys)

    @cached_property
    def contact(self) -> tuple[str, ...]:
        """Name of each row's contact."""
        return tuple(group.contact for group in self.groups for _ in group.keys)

    @property
    def size(self) -> int:
        """Number of constraints m."""
        return len(self.values)

    def nearest(self, contact: str, arc: float, reach: float = np.inf) -> Ints:
        """Number of the row of a contact that is nearest to an arc length, (1,); (0,) where none is within reach."""
        mine = np.array([name == contact for name in self.contact], dtype=bool)
        away = np.abs(self.arc - arc)
        near = np.flatnonzero(mine & (away <= reach))
        return near[np.argsort(away[near], kind="stable")[:1]]

    def shares(self, multipliers: Array) -> list[tuple[Group, Array]]:
        """Every group with its part of the multipliers (m,)."""
        ends = np.cumsum([len(group.values) for group in self.groups])
        return list(zip(self.groups, np.split(multipliers, ends[:-1]), strict=True)) if self.groups else []

    def pressing(self, multipliers: Array) -> set[str]:
        """Names of the contacts and stops that have a row whose multiplier is positive."""
        return {group.contact for group, lam in self.shares(multipliers) if np.any(lam > 0.0)}

    def forces(self, multipliers: Array, n_joints: int, n_unknowns: int) -> tuple[Array, Array, Array]:
        """∂(λ·c) over x and y of all joints (n_joints,), and what is over unknown angles at once (n_unknowns,)."""
        fx, fy, moments = np.zeros(n_joints), np.zeros(n_joints), np.zeros(n_unknowns)
        for group, lam in self.shares(multipliers):
            p = group.joints.shape[1]
            local = lam[:, None] * group.slopes
            np.add.at(fx, group.joints, local[:, :p])
            np.add.at(fy, group.joints, local[:, p : 2 * p])
            np.add.at(moments, group.angles, local[:, 2 * p :])
        return fx, fy, moments


Formulation = Callable[[State, Positions, Rows], Rows]
"""The rows at a state, and those of a state before."""

NO_ROWS = Rows(())
