"""How an equilibrium moves with what is stepped, and whether two of them are on one branch.

======  ==============================================================================
v, θ    part of the way on which loads, drives or ends go evenly; link angles
r       dθ/dv on the branch, from Newton's system with the contacts that press
f       part of a step that lies before a contact closes or opens
======  ==============================================================================

On one branch the angles go from one equilibrium to the next as their rates say at both ends:

    θ_1 − θ_0 ≈ (f r_0 + (1 − f) r_1)(v_1 − v_0)    with one f between 0 and 1.

What a leap to another branch adds to this is in no proportion to the step.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cprbm.closure import apart_by
from cprbm.energy import load_work
from cprbm.model import Model
from cprbm.newton import local_system_at, many, own_system
from cprbm.point import Point, Problem
from cprbm_scene.answer import Array

APART = 0.5  # of the mean way that the rates make: curvature of the way, and more than one contact
SHIFTED = 0.002  # rad: links turn by less where contact only comes to be carried by other rows
OTHERS = 0.1  # of what one element bends by: the same where a place of its own becomes joints, or joints a place


def rate(problem: Problem, point: Point, change: Mapping[str, float]) -> Array:
    """r (n_links,), rad per unit of a way on which named values (SI) ``change``; nought in a singular system."""
    model = problem.model
    moved = {name: load for name, load in problem.loads.items() if change.get(name, 0.0)}
    f = load_work(model, moved, dict(change), point.state, point.at).gradient
    f[problem.closure.fixed] = 0.0
    try:
        if many(point.rows):
            return _local(problem, point, f, driven(problem, change))
        return own_system(problem, point).solved(f, driven(problem, change))[: model.n_links]
    except (np.linalg.LinAlgError, RuntimeError):
        return np.zeros(model.n_links)


def driven(problem: Problem, change: Mapping[str, float]) -> Array:
    """What Z must be changed by on a way on which named values (SI) ``change``, −∂Z/∂v (rows,)."""
    model, closure = problem.model, problem.closure
    asked = [change.get(name, 0.0) / model.unit_length for c in closure.ends for name in apart_by(model.chains[c].name)]
    asked += [0.0] * (closure.first_hold - len(asked))
    asked += [hold.unit * change.get(hold.drive, 0.0) for hold in closure.holds]
    return np.array(asked)


def _local(problem: Problem, point: Point, f: Array, asked: Array) -> Array:
    found, active = local_system_at(problem, point), point.lam > 0.0
    n, first = problem.model.n_links, found.n_links + 2 * found.n_joints
    right = np.zeros(found.size + int(np.sum(active)))
    right[:n], right[first : first + found.n_bodies] = f[:n], f[n:]
    right[found.first_mu : found.size] = asked
    return np.asarray(found.factorised(active).solve(right)[:n])


def carried_by_others(model: Model, before: Point, after: Point) -> float:
    """By how much (rad) links may turn as what the same contacts carry goes over to other rows of theirs.

    A contact in a place of its own becomes two joints, or these three: the discretisation is another, and the angles
    with it, by a part of what one element bends by there.
    """
    keys = before.rows.pressed(before.lam), after.rows.pressed(after.lam)
    if before.rows.pressing(before.lam) != after.rows.pressing(after.lam) or keys[0] == keys[1]:
        return SHIFTED
    bent = max(float(np.max(np.abs(np.diff(after.state.theta[chain.links])))) for chain in model.chains)
    return max(SHIFTED, OTHERS * bent)


def strayed(lengths: Array, change: Array, start: Array, end: Array, shifted: float = SHIFTED) -> bool:
    """Whether a ``change`` of the angles is not made of the ways that the rates at its ``start`` and ``end`` make.

    Args:
        lengths: of the links, the metric; (n_links,) as all others.
        change: θ_1 − θ_0.
        start, end: r_0 (v_1 − v_0) and r_1 (v_1 − v_0).
        shifted: rad, by which links may turn besides.
    """
    if float(np.max(np.abs(change))) <= shifted:
        return False
    turn = start - end
    size = float(lengths @ turn**2)
    f = min(max(float(lengths @ (turn * (change - end))) / size, 0.0), 1.0) if size > 0.0 else 0.0
    left = change - end - f * turn
    ways = [float(np.sqrt(lengths @ way**2)) for way in (start, end)]
    return float(np.sqrt(lengths @ left**2)) > max(APART * 0.5 * sum(ways), shifted * float(np.sqrt(np.sum(lengths))))
