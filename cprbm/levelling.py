"""Contact in a point beside which the beams lie on each other, or nearly: the place is sought from outside.

==========  ======================================================================
p           arc length of a place on the contact's first beam
D′(p)       slope of the distance there, what the kinks add to it included
==========  ======================================================================

A place where D has a minimum of its own moves with it, as s(z) from D′(s, z) = 0 (:mod:`cprbm.nearest`).  At the end of
a length on which the beams lie on each other without pressing there is no such function: to one side D′ is nought all
along.  Pressed a little too far out, the beams part on that side; too far in, they overlap on the other.  So the row is
fixed to a place, and the place is found where the slope of the distance in equilibrium goes through zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from cprbm.first_equilibrium import Equilibrium, equilibrium
from cprbm.kinks import kinks_at
from cprbm.mechanism import Mechanism, mechanism_of
from cprbm.model import Fit, Kinks
from cprbm.nearest import Pair
from cprbm.point import Point
from cprbm.refining import carried_over
from cprbm.settings import Settings
from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

LEVEL = 1e-7  # of a slope: the slopes beside the kinks are those of the state before
FIRST = 0.02  # elements: the first move of a place
LONGEST = 0.5  # elements: the longest
MOVES = 12
PASSES = 4  # with the same places: what faces them on the second beam is that of the state before


def levelled(
    scene: Scene, settings: Settings, before: Mechanism, point: Point, fit: Fit, values: dict[str, float]
) -> tuple[Mechanism, Equilibrium] | None:
    """The equilibrium in which contacts in points press where the beams are parallel; None if none is found.

    Rigid circles and edges are no part of this: what is known of their places are minima.

    Args:
        scene, settings: the question, and the mesh.
        before, point: a state near by on another mesh.
        fit: for that state, with the places of contacts in points.
        values: of loads and drives, SI.
    """
    between = [name for name in fit.kinks if isinstance(before.pairs[name], Pair)]
    if not between:
        return None
    known: dict[str, tuple[Array, Array]] = {}
    for _ in range(MOVES):
        for _ in range(PASSES):
            target = mechanism_of(scene, settings, replace(fit, fixed=frozenset(between)), before)
            start = carried_over(before, point, target, values)
            solved = equilibrium(target.problem, values, start, settings.tolerance, settings.iterations)
            if not solved.converged:
                return None
            before, point = target, solved.point
            here = {name: _kinks(target, point, name, target.fit.kinks[name][0].places) for name in between}
            fit = replace(fit, kinks=frozendict({**fit.kinks, **here}))
        slopes = {name: _slopes(target, solved.point, name) for name in between}
        if all(np.all(np.abs(slope) <= LEVEL) for slope in slopes.values()):
            return target, solved
        moved = {name: _moved(target, solved.point, name, slopes, known) for name in between}
        fit = replace(fit, kinks=frozendict({**fit.kinks, **moved}))
    return None


def _slopes(mechanism: Mechanism, point: Point, name: str) -> Array:
    pair = mechanism.pairs[name]
    assert isinstance(pair, Pair)
    return pair.slopes(point.state, point.at, mechanism.fit.kinks[name][0].places)


def _moved(
    mechanism: Mechanism,
    point: Point,
    name: str,
    slopes: Mapping[str, Array],
    known: dict[str, tuple[Array, Array]],
) -> tuple[Kinks, ...]:
    """The kinks at the next places, by the secant through the last two."""
    pair, slope = mechanism.pairs[name], slopes[name]
    places = mechanism.fit.kinks[name][0].places
    size = pair.a.size_at(places)
    step = -FIRST * size * np.sign(slope)
    if name in known:
        last, its = known[name]
        change = slope - its
        step = np.where(change != 0.0, -slope * (places - last) / np.where(change != 0.0, change, 1.0), step)
    known[name] = places, slope
    return _kinks(mechanism, point, name, places + np.clip(step, -LONGEST * size, LONGEST * size))


def _kinks(mechanism: Mechanism, point: Point, name: str, places: Array) -> tuple[Kinks, ...]:
    """The kinks of a contact at ``places`` on its first beam and what faces them on its second."""
    pair = mechanism.pairs[name]
    pressed = pair.pressed(point.state, point.at, places)
    return tuple(kinks_at(chain, point.state, at) for chain, (_, at, _) in zip(pair.chains, pressed, strict=True))
