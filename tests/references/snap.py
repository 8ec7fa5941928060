"""A straight inextensible beam whose ends are nearer than its length, one of them turned until the beam snaps.

=======  =================================================================================
symbol   meaning
=======  =================================================================================
L, EI    length, bending stiffness; both are one here
d        distance of the ends, along x from the clamp
φ        rotation of the clamp from the direction of x, counter-clockwise
β        tangent angle at the far end; M₁ moment on the beam there
M₀, F    moment in the beam at the clamp, force of the far end on the beam
=======  =================================================================================

The beam begins at the origin with the angle φ and ends at (d, 0), pinned: M₁ = 0, or clamped: β = 0.  These are three
equations in M₀, F_x, F_y and φ.  On the branch of the beam that hangs below the line of its ends, a growing φ turns
the clamp against the beam; the branch folds at φ*, and the beam snaps to the branch above, which is the other's image
in that line (φ, β, y, M to −φ, −β, −y, −M) and folds at −φ*.

A stop that keeps β from falling below β₀ < β(φ*) catches the beam as it snaps.  It presses with a moment M₁ > 0, which
falls as φ is turned back, and lets go where M₁ = 0.  That is a place of the branch beyond its fold, where the beam
alone is unstable: it jumps back to the branch below.

As 1 − d → 0, with φ = μ √(1 − d), a linear beam under a thrust τ² with ∫ w'² = 2 (1 − d) remains,

    w'''' + τ² w'' = 0                                                                              (1)

Sources: R. H. Plaut and L. N. Virgin, Vibration and snap-through of bent elastica strips subjected to end rotations,
Journal of Applied Mechanics 76 (2009) 041011; M. Gomez, D. E. Moulton and D. Vella, Critical slowing down in purely
elastic 'snap-through' instabilities, Nature Physics 13 (2017) 142-145: (1), and φ* = 1.7818 √(1 − d) of the beam whose
far end is clamped.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tests.references.branch import Wanted, on_branch, vanishing
from tests.references.rod import TIGHT, carried, stored

Array = NDArray[np.float64]
FarEnd = Literal["pinned", "clamped"]


@dataclass(frozen=True, slots=True)
class State:
    """φ, β, M₀, M₁, F and what the beam stores, without dimension; ``unknowns`` are M₀, F_x, F_y and φ."""

    clamp: float
    far: float
    clamp_moment: float
    far_moment: float
    force: Array
    energy: float
    unknowns: Array


@dataclass(frozen=True)
class Snap:
    """The beam by the distance d of its ends, and what its far end is."""

    distance: float
    far_end: FarEnd = "pinned"

    def end(self, X: Array, tolerance: float = TIGHT) -> tuple[Array, Array]:
        """x − d, y, β and M₁ at the far end, and their derivatives (4, 4) by M₀, F_x, F_y and φ."""
        end, D = carried(np.array([0.0, 0.0, X[3], X[0]]), X[1:3], 1.0, 0.0, tolerance)
        return end - [self.distance, 0.0, 0.0, 0.0], D[:, [3, 4, 5, 2]]

    def equations(self, X: Array, tolerance: float) -> tuple[Array, Array]:
        """The three equations and their derivatives (3, 4)."""
        E, D = self.end(X, tolerance)
        rows = [0, 1, 3 if self.far_end == "pinned" else 2]
        return E[rows], D[rows]

    def determinant(self, X: Array, tolerance: float) -> float:
        """What vanishes where φ is critical."""
        return float(np.linalg.det(self.equations(X, tolerance)[1][:, :3]))

    @cached_property
    def hanging(self) -> State:
        """The beam below the line of its ends: pinned, with a clamp that carries no moment; clamped, at φ = 0."""
        c = 2.0 * np.sqrt(1.0 - self.distance) / np.pi  # half the rise of a cosine, or the rise of a sine
        if self.far_end == "pinned":
            guess, given = np.array([0.0, -(np.pi**2), 0.0, -np.pi * c]), 0
        else:
            guess, given = np.array([-2.0 * np.pi**2 * c, -4.0 * np.pi**2, 0.0, 0.0]), 3
        return self.state(on_branch(self.equations, guess, np.eye(4)[given]))

    def at(self, clamp: float) -> State:
        """The beam that hangs below, at φ up to the fold."""
        return self.state(self._first(lambda X, _: X[3] - clamp, clamp - self.hanging.clamp))

    def above(self, clamp: float) -> State:
        """The beam that stands above the line of its ends, at φ from −φ* on: the image of the one below at −φ."""
        M, Fx, Fy, phi = self.at(-clamp).unknowns
        return self.state(np.array([-M, Fx, -Fy, -phi]))

    @cached_property
    def fold(self) -> State:
        """Where the branch of the beam that hangs below ends as φ grows."""
        return self.state(self._first(self.determinant, 1.0))

    def let_go(self, far: float) -> State:
        """Where, beyond the fold, a pinned beam's β has come down to ``far``."""
        fold = self.fold.unknowns
        beyond = np.array([0.0, -1.0, 0.0, 0.0])  # the thrust grows on and on
        return self.state(vanishing(self.equations, lambda X, _: self.end(X)[0][2] - far, fold, beyond, 0.5, 100))

    def stopped(self, clamp: float, far: float, guess: State) -> State:
        """The pinned beam at φ whose far end a stop holds at β."""

        def equations(X: Array, tolerance: float) -> tuple[Array, Array]:
            E, D = self.end(X, tolerance)
            return E[:3] - [0.0, 0.0, far], D[:3]

        start = guess.unknowns + (clamp - guess.clamp) * np.eye(4)[3]
        return self.state(on_branch(equations, start, np.eye(4)[3]))

    def assembled(self, moment: float) -> State:
        """The beam at φ = 0 after its assembly by a moment on its end, counter-clockwise.

        The straight beam becomes an arc under the moment; its end is brought straight to (d, 0); the moment goes.
        """
        arc = np.array([np.sin(moment), 1.0 - np.cos(moment)]) / moment
        X = np.array([moment, 0.0, 0.0, 0.0])
        way = [(arc + share * ([self.distance, 0.0] - arc), moment) for share in np.linspace(0.0, 1.0, 21)]
        way += [(np.array([self.distance, 0.0]), share * moment) for share in np.linspace(1.0, 0.0, 21)]
        for place, kept in way:

            def equations(X: Array, tolerance: float, place: Array = place, kept: float = kept) -> tuple[Array, Array]:
                E, D = self.end(X, tolerance)
                return E[[0, 1, 3]] + [self.distance - place[0], -place[1], -kept], D[[0, 1, 3]]

            X = on_branch(equations, X, np.eye(4)[3])
        return self.state(X)

    def state(self, X: Array) -> State:
        """What X says."""
        E, _ = self.end(X)
        energy = stored(np.array([0.0, 0.0, X[3], X[0]]), X[1:3], 1.0)
        return State(X[3], E[2], X[0], E[3], X[1:3], energy, X)

    def _first(self, wanted: Wanted, sense: float) -> Array:
        return vanishing(self.equations, wanted, self.hanging.unknowns, sense * np.eye(4)[3], 0.5, 100)
