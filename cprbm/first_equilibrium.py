"""Equilibrium as a minimum of potential energy under equalities and contacts, eq. (1), at one load.

Newton's method by the steps of :mod:`cprbm.newton`, none of which turns a link far, and what tells that it is there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from cprbm.kinematics import most_turned
from cprbm.newton import known_system, many, newton_step
from cprbm.point import Point, Problem, point_at, point_under

LONGEST_TURN = 0.5  # of any link in one iteration, rad
PATIENCE = 12  # iterations; then the set that presses may go in circles, and is found by a rule that cannot
SAME = 0.1  # part by which residuals differ that are the same again
SHORT, LONG = 3, 6  # iterations of a circle: in which residuals alone tell it, and with the rows that press
IDLE, BETTER = 15, 0.7  # iterations in a row that lead nowhere: none leaves such a part of what the best one left
CIRCLES = 4  # returns that end the search for places of their own, and as many more that with steady rows
AWAY = 6  # steps in a row, each longer than the one before
STILL = 1e-12  # rad: a state from which a step leads no farther is where it would lead
NOTHING = 1e-12  # S: moments below it are no load at all, and what is left is measured by S
EPS = float(np.finfo(float).eps)

_most = np.maximum.reduce  # what the method max of an array comes to

Held = frozenset[tuple[str, int]]


@dataclass(frozen=True, slots=True)
class Measure:
    """How far a point is from equilibrium, each over its own scale; ``floor`` is round-off's share of residual."""

    residual: float
    floor: float
    violation: float
    overlap: float
    complementarity: float

    def within(self, tolerance: float) -> bool:
        """Whether nothing is left but what is tolerated, or round-off."""
        allowed = max(tolerance, 100.0 * EPS)
        return self.residual <= max(tolerance, self.floor) and self.violation <= allowed and self.overlap <= allowed


@dataclass(frozen=True, slots=True)
class Equilibrium:
    """Where an equilibrium solve ended."""

    point: Point
    measure: Measure
    iterations: int
    converged: bool


def largest_moment(point: Point) -> float:
    """The largest generalised force that balances at a point, S; nought where there is no load."""
    terms = np.abs(point.gradient) + np.abs(point.held) + np.abs(point.pressed)
    largest = max(float(_most(terms)), float(_most(np.abs(point.moments))))
    return largest if largest > NOTHING else 0.0


def measure(problem: Problem, point: Point) -> Measure:
    """Residuals of the optimality conditions over the largest terms in them; over S where there is no load."""
    model, c = problem.model, point.rows.values
    scale = largest_moment(point) or 1.0
    # an angle is known to eps·|θ|, a spring's moment to the stiffness times that
    turned = max(1.0, float(_most(np.abs(point.state.theta))))
    floor = 4.0 * EPS * model.stiffest * turned + 4.0 * EPS * sqrt(model.n_links) * scale
    return Measure(
        residual=float(_most(np.abs(problem.moves * point.unbalanced))) / scale,
        floor=floor / scale,
        violation=float(_most(np.abs(point.Z), initial=0.0)),
        overlap=float(_most(c, initial=0.0)),
        complementarity=float(_most(np.abs(point.lam * c), initial=0.0)) / scale,
    )


def equilibrium(
    problem: Problem,
    values: dict[str, float],
    start: Point,
    tolerance: float,
    iterations: int,
    *,
    settle: bool = False,
    farthest: float = np.inf,
    same: bool = False,
) -> Equilibrium:
    """Newton's method from ``start`` to the equilibrium under the loads' and drives' ``values`` (SI).

    Where it comes back to a residual it had, the row sets of a few states follow each other in a circle, and a part of
    the step is taken.  Where it comes back for good, or comes no nearer, the steady rows decide if they may ``settle``
    it; otherwise that is the end, as it is where these are no others or lead nowhere either.  Where ``farthest`` says
    (rad) by what a link turns at most, so it is beyond that, and where steps grow and grow: they lead away from a state
    that is no minimum.  The ``start`` may itself be the equilibrium if its rows were found under the ``same`` values.

    What joints alone hold at the start they hold on, if they may settle it, where a place among them leads away.
    """
    met: set[int] = set()
    found = _by_newton(problem, values, start, tolerance, iterations, met, settle=settle, farthest=farthest, same=same)
    held = [key for _, key in _held(start)]
    if found.converged or not settle or not held or min(held) < 0 or min(met, default=0) >= 0:
        return found
    steady = replace(problem, formulation=problem.steady)
    again = _by_newton(steady, values, start, tolerance, iterations, met, settle=False, farthest=farthest, same=False)
    return replace(again, iterations=found.iterations + again.iterations) if again.converged else found


def _by_newton(
    problem: Problem,
    values: dict[str, float],
    start: Point,
    tolerance: float,
    iterations: int,
    met: set[int],
    *,
    settle: bool,
    farthest: float,
    same: bool,
) -> Equilibrium:
    """The same with no second way; the keys of all rows that have pressed are ``met``."""
    model = problem.model
    point = point_under(problem, values, start)
    now = measure(problem, point)
    seen: list[tuple[float, Held]] = []
    part, circles, settled = 1.0, 0, False
    idle, best = 0, np.inf
    grown, last = 0, np.inf
    near: Point | None = None
    for iteration in range(1, iterations + 1):
        try:
            change, mu, lam = newton_step(problem, point, thorough=iteration > PATIENCE, near=near)
        except np.linalg.LinAlgError:
            return Equilibrium(point, now, iteration, converged=False)
        longest = float(np.abs(change[: model.n_links]).max())
        if not np.isfinite(longest):
            return Equilibrium(point, now, iteration, converged=False)
        # not at once where it was asked of the start under other values which rows there are
        still = (iteration > 1 or same) and longest <= STILL and np.array_equal(lam > 0.0, point.lam > 0.0)
        if still and _settled(now, longest, tolerance):
            return Equilibrium(point, now, iteration, converged=True)
        grown, last = grown + 1 if longest > last else 0, longest
        if grown == AWAY and np.isfinite(farthest):
            return Equilibrium(point, now, iteration, converged=False)
        left = _left(now, tolerance)
        here = left, _held(point)
        met |= {key for _, key in here[1]}
        returns = _returns(seen, here)
        part = 0.5 * part if returns else min(1.0, 2.0 * part)
        circles += returns
        if circles == CIRCLES or idle == IDLE:
            if settled or not settle or _steady(seen):
                return Equilibrium(point, now, iteration, converged=False)
            problem, settled = replace(problem, formulation=problem.steady), True
            part, circles, seen, idle, best = 1.0, 0, [], 0, np.inf
        seen.append(here)
        scale = min(part, LONGEST_TURN / longest) if longest > 0.0 else part
        state = point.state.moved(scale * change, model.n_links)
        before, point = point, point_at(problem, values, state, mu, lam, point.rows)
        earlier, now = now, measure(problem, point)
        most = max(now.residual, now.violation, now.overlap)
        idle, best = 0 if most < BETTER * best else idle + 1, min(best, most)
        if most_turned(start.state, state) > farthest:
            return Equilibrium(point, now, iteration, converged=False)
        if scale == 1.0 and _settled(now, longest, tolerance):
            return Equilibrium(point, now, iteration, converged=True)
        # a step leaves what goes with its square; with the system of the state before, about twice the part of the
        # residual that the last one left
        enough = 2.0 * now.residual * now.residual <= tolerance * earlier.residual
        near = before if near is None and enough and _serves(problem, before, point) else None
    return Equilibrium(point, now, iterations, converged=False)


def _serves(problem: Problem, before: Point, point: Point) -> bool:
    """Whether the system of the state ``before`` is known, and has the rows of that of the ``point``."""
    if many(point.rows) or not point.rows.same(before.rows):
        return False
    known = known_system(problem, before)
    return known is not None and known.convex


def _left(now: Measure, tolerance: float) -> float:
    """What is left to be put right: the residual, and once there is none, what is violated; nought below all limits."""
    if now.residual > max(tolerance, now.floor):
        return now.residual
    violated = max(now.violation, now.overlap)
    return violated if violated > max(tolerance, 100.0 * EPS) else 0.0


def _held(point: Point) -> Held:
    """The rows that press."""
    return point.rows.pressed(point.lam)


def _steady(seen: list[tuple[float, Held]]) -> bool:
    """Whether the same rows have pressed lately, and none at a place of its own, so that it is no circle of rows."""
    lately = {held for _, held in seen[-LONG:]}
    return len(lately) == 1 and all(key >= 0 for held in lately for _, key in held)


def _returns(seen: list[tuple[float, Held]], here: tuple[float, Held]) -> bool:
    """Whether an iteration is back where it was two or three before, or a few more and the same rows press.

    In a circle each state denies the rows of the one before.
    """
    left, held = here
    if left == 0.0:
        return False
    for ago, (before, those) in enumerate(seen[-2 : -LONG - 1 : -1], start=2):
        if abs(left - before) < SAME * before and (ago <= SHORT or those == held):
            return True
    return False


def _settled(now: Measure, longest: float, tolerance: float) -> bool:
    return now.within(tolerance) and longest <= 1e-5
