"""Where Newton's method begins: a branch of equilibria, continued from those that are known on it.

==========  ==============================================================
v_k, q_k    values of what is stepped, and the unknowns and multipliers there
q(v)        ≈ Σ_k q_k Π_{j≠k} (v − v_j)/(v_k − v_j), Lagrange
==========  ==============================================================

It is a guess and no more: what is found from it is certified like all else.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cprbm.kinematics import State
from cprbm.mechanism import Mechanism
from cprbm.model import Fit, Kinks
from cprbm.point import Point, Problem, point_at
from cprbm_scene.answer import Array

FEWEST = 3  # states: of two the way goes on straight, and so does Newton's first step
MOST = 5
FITTED = 3  # meshes that lead to the next
KEPT = 15  # states, some of which may be too close to each other
FARTHEST = 1.5  # times as far from the nearest value as that is from the one after it
SPACED = 0.2  # of the way to the nearest value: of values closer to each other the last is taken


def continued(
    problem: Problem, values: dict[str, float], known: Sequence[tuple[float, Point]], v: float
) -> Point | None:
    """The state at v, which the ``values`` (SI) of loads and drives belong to; None where too little is known.

    Args:
        problem: its unknowns are numbered as those of the ``known`` states.
        values: of loads and drives, SI.
        known: v_k and the equilibrium there, in the order in which they were found; those up to a change of what
            presses are used.
        v: between them or beyond the last.
    """
    if len(known) < FEWEST:
        return None
    last = known[-1][1]
    pressing = _pressing(last)
    used: list[tuple[float, Point]] = []
    for value, point in reversed(known):
        if len(used) == MOST or value == v or _pressing(point) != pressing:
            break
        nearest = min((abs(v - other) for other, _ in used), default=0.0)
        if all(abs(value - other) > SPACED * nearest for other, _ in used):
            used.append((value, point))
    if len(used) < FEWEST:
        return None
    one, other = sorted((value for value, _ in used), key=lambda value: abs(v - value))[:2]
    if abs(v - one) > FARTHEST * abs(one - other):
        return None
    weights = lagrange(np.array([value for value, _ in used]), v)
    theta, bodies, mu = (
        np.tensordot(weights, np.stack(parts), 1)
        for parts in zip(*((p.state.theta, p.state.bodies, p.mu) for _, p in used), strict=True)
    )
    # what does not turn is set right by no iteration
    theta[problem.closure.fixed] = problem.model.rest[problem.closure.fixed]
    lam = np.zeros(len(last.lam))
    lam[last.lam > 0.0] = np.maximum(weights @ np.stack([point.lam[point.lam > 0.0] for _, point in used]), 0.0)
    return point_at(problem, values, State(theta, bodies), mu, lam, last.rows)


def led(known: Sequence[tuple[float, Mechanism]], v: float) -> Fit | None:
    """The mesh's fit to which those at the last values lead at v; None where they are not alike, or too far away."""
    last = known[-1][1].fit
    used = [(value, of) for value, of in known[-FITTED:] if value != v and _marked(of.fit) == _marked(last)]
    if len(used) < FEWEST or abs(v - used[-1][0]) > FARTHEST * abs(used[-1][0] - used[-2][0]):
        return None
    weights = lagrange(np.array([value for value, _ in used]), v)

    def gone_on(parts: Sequence[Array]) -> Array:
        return np.asarray(np.tensordot(weights, np.stack(parts), 1))

    fits = [mechanism.fit for _, mechanism in used]
    chains = {beam: [mechanism.problem.model.chain(beam) for _, mechanism in used] for beam in last.borders}
    borders = {beam: gone_on([chain.borders / chain.s[-1] for chain in mine]) for beam, mine in chains.items()}
    if any(np.any(np.diff(places) <= 0.0) for places in borders.values()):
        return None
    kinks = {
        name: tuple(
            Kinks(
                *(gone_on([getattr(fit.kinks[name][i], of) for fit in fits]) for of in ("places", "before", "behind"))
            )
            for i in range(len(mine))
        )
        for name, mine in last.kinks.items()
    }
    ends = {name: gone_on([fit.ends[name] for fit in fits]) for name in last.ends}
    return Fit(borders, ends, kinks, last.fixed)


def lagrange(at: Array, v: float) -> Array:
    """Π_{j≠k} (v − v_j)/(v_k − v_j) for values ``at`` (k,)."""
    return np.array([np.prod((v - np.delete(at, k)) / (at[k] - np.delete(at, k))) for k in range(len(at))])


def alike(one: Fit, other: Fit) -> bool:
    """Whether meshes have the same elements, somewhat longer or shorter: then what is known on both goes on evenly."""
    return _built(one) == _built(other)


def _marked(fit: Fit) -> tuple[object, ...]:
    """How many places and ends of each contact a mesh knows."""
    return (
        fit.fixed,
        {name: len(kinks[0].places) for name, kinks in fit.kinks.items()},
        {name: len(ends) for name, ends in fit.ends.items()},
    )


def _built(fit: Fit) -> tuple[object, ...]:
    return (
        _marked(fit),
        # numbers of the borders that are ends of zones
        {
            beam: sorted({int(np.argmin(np.abs(borders - end))) for ends in fit.ends.values() for end in ends})
            for beam, borders in fit.borders.items()
        },
    )


def _pressing(point: Point) -> tuple[tuple[str, int], ...]:
    return tuple(key for key, force in zip(point.rows.keys, point.lam, strict=True) if force > 0.0)
