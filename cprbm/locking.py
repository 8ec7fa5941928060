"""What does not move: beams that are straight between held ends, and what is driven until all it is held by is taut.

==========  ==================================================================================
Z, A        equalities and their derivatives over the unknowns q
ν           combination of the equalities that no small motion changes: νᵀA = 0
z           −∂Z/∂v, what Z must be changed by on the way
B           ½ ∂²(ν·Z)/∂q² of the links: what turning them changes ν·Z by, diagonal
F, v, v_t   the largest multiplier, and the value that is stepped; that at which beams are taut
==========  ==================================================================================

A beam that is straight between its ends is as long as they are apart: turning its links by q brings them closer by a
part of q² only, and nothing takes them farther apart.  Where the way asks for ν·z, so

    Σ B_ii q_i² = ν·z dv,

has no solution near by if B has the other sign, and the beam cannot become longer.  Otherwise it has q and −q, both of
size √dv: the beam buckles to one side or the other, and the straight branch ends in a bifurcation where it stands, for
in bending alone a column shortens by nothing before.  Where the way asks for nothing (ν·z = 0) the beam stays straight
under any pull, and what presses or pulls on it from the side is held by none that is finite.

A beam that is not straight yet, or lies round something, can be drawn until it is taut, and no further: a bend that a
pull F leaves has the length √(EI/F), so that F grows like (v_t − v)^−p with p about 2.  Whatever p is,

    F/F′ = (v_t − v)/p

falls to nothing evenly, as no force does that stays finite.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cprbm.beam_loads import BeamLoad
from cprbm.closure import closure_forces
from cprbm.kinematics import pulled_back
from cprbm.point import Point, Problem
from cprbm.rate import driven
from cprbm_scene.answer import Array

NOTHING = 1e-9  # of the largest singular value: rows whose combination is less do not depend on q
NEXT_TO = 3e-5  # the same of a beam that has bent by what the closure's tolerance lets it, q² ~ 1e-11, and more for it
TAKES_PART = 0.01  # of the largest, squared
TAUT, GROWN = 4, 4.0  # minima by which F grows so many times before it is said to have no limit
ASKED = 1e-6  # of the largest change that the way asks for of an equality


@dataclass(frozen=True, slots=True)
class Locked:
    """A beam that is straight between held ends, and whether the way asks it to become shorter and so ``buckles``."""

    beam: str
    buckles: bool

    @property
    def told(self) -> str:
        """What keeps the way from being gone, for people."""
        return f"beam '{self.beam}' is straight between its ends, and cannot become longer by bending"


def locked_on(problem: Problem, point: Point, change: Mapping[str, float]) -> Locked | None:
    """What the way, on which named values (SI) ``change``, asks of a straight beam in this state; None if nothing."""
    z, N = driven(problem, change), _free_of_motion(problem, point, NOTHING)
    nu = N @ (N.T @ z)
    asked = float(nu @ z)
    if asked <= (ASKED * float(np.max(np.abs(z), initial=0.0))) ** 2:
        return None
    fx, fy = closure_forces(problem.model, problem.closure, nu)
    second = pulled_back(problem.model, point.state, point.at, fx, fy)[2] * problem.moves[: problem.model.n_links]
    # along a straight beam one sign
    return Locked(_beams(problem, nu[:, None])[0], buckles=bool(second.sum() > 0.0))


def between_ends(beam: str) -> str:
    """Why nothing can press or pull on such a beam from the side, for people."""
    return f"beam '{beam}' is straight between ends that are held, and cannot give way from there by bending"


def drawn_taut(load: str, value: float) -> str:
    """Why a way ends near the ``value`` of a ``load`` where :func:`taut` finds it, for people."""
    return f"forces grow without limit as {load} comes to {value:.6g}, where beams would have to become longer"


def taut(minima: Sequence[tuple[float, Point]], refused: float) -> float | None:
    """v_t, told from the last minima and their values; None where forces have a limit.

    Args:
        minima: in order.
        refused: the value at which there was none.
    """
    if len(minima) < TAUT:
        return None
    v = np.array([value for value, _ in minima[-TAUT:]])
    F = np.array([max(np.max(np.abs(at.mu), initial=0.0), at.lam.max(initial=0.0)) for _, at in minima[-TAUT:]])
    if not np.all(np.diff(F) > 0.0) or F[-1] < GROWN * F[0]:
        return None
    ratio, middle = np.abs(0.5 * (F[1:] + F[:-1]) * np.diff(v) / np.diff(F)), 0.5 * (v[1:] + v[:-1])
    if not np.all(np.diff(ratio) < 0.0):
        return None
    limit = middle[-1] + ratio[-1] * (middle[-1] - middle[-2]) / (ratio[-2] - ratio[-1])
    return float(limit) if 0.0 < (limit - v[-1]) / (refused - v[-1]) <= 2.0 else None


def pressed_on(problem: Problem, before: Point, point: Point, values: Mapping[str, float]) -> str:
    """Name of a beam that is straight between held ends and has a contact or a dead load on it; empty if there is none.

    Args:
        before: where the beam is straight still.
        point: further on, where contacts press that do.
        values: of loads and drives (SI) there.
    """
    loaded = {load.chain for name, load in problem.loads.items() if isinstance(load, BeamLoad) and values.get(name)}
    for name in _beams(problem, _free_of_motion(problem, before, NEXT_TO)):
        chain = problem.model.chain(name)
        if problem.model.chains.index(chain) in loaded:
            return name
        for group, lam in point.rows.shares(point.lam):
            joints = group.joints[lam > 0.0] if len(group.joints) == len(lam) else group.joints
            if lam.any() and np.any((joints >= chain.joints.start) & (joints < chain.joints.stop)):
                return name
    return ""


def _free_of_motion(problem: Problem, point: Point, least: float) -> Array:
    """The ν as columns, orthonormal, (rows, k), of which ``least`` of the largest singular value is nothing."""
    A = point.A_E * problem.moves
    if not len(A):
        return A
    left, sizes, _ = np.linalg.svd(A, full_matrices=False)
    return np.asarray(left[:, sizes <= least * sizes[0]])


def _beams(problem: Problem, N: Array) -> list[str]:
    """The beams whose ends have a part in columns (rows, k)."""
    ends = problem.closure.ends
    parts = np.sum(N[: 2 * len(ends)] ** 2, axis=1).reshape(-1, 2).sum(axis=1)
    return [
        problem.model.chains[c].name for c, part in zip(ends, parts, strict=True) if part > TAKES_PART * parts.max()
    ]
