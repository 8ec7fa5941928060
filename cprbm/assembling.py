"""Bringing beams' ends to the points they are pinned to, before anything is loaded or driven.

Three parts, each with an equilibrium at its end: the auxiliary moments grow while the ends are free; the ends go
straight to their points; the moments go away, and from here on stops act.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from cprbm.closure import apart_by, closure_of
from cprbm.energy import moment_on
from cprbm.kinematics import place
from cprbm.mechanism import Mechanism
from cprbm.point import Point, Problem, point_at
from cprbm_scene import Mistake, PinnedEnd, Scene, SceneError

APART = 1e-6  # of the beam's length
BEYOND = 1e-6  # rad, by which a limit may be exceeded as it begins to act


@dataclass(frozen=True, slots=True)
class Part:
    """One part of the assembly.

    Attributes:
        mechanism: what holds meanwhile.
        start: the state in which it begins, in that mechanism.
        begin, target: values as it begins and as it ends, by name.
        sentence: what is done.
    """

    mechanism: Mechanism
    start: Point
    begin: Mapping[str, float]
    target: Mapping[str, float]
    sentence: str


def freed(scene: Scene, mechanism: Mechanism, point: Point) -> Part:
    """The first part: ends that are drawn apart are free, and moments grow on them."""
    moments = _moments(scene)
    names = frozenset(_apart(scene, mechanism, point))
    problem = mechanism.without(*mechanism.stops)
    free = replace(problem, closure=closure_of(problem.model, problem.closure.hinges, problem.closure.holds, names))
    return Part(
        mechanism=replace(mechanism, problem=free),
        start=_as_in(free, point, {}),
        begin=dict.fromkeys(moments, 0.0),
        target=moments,
        sentence="the moments of the assembly grow",
    )


def brought(scene: Scene, mechanism: Mechanism, point: Point) -> Part:
    """The second part: from where they are the ends go straight to their points."""
    moments = _moments(scene)
    problem = mechanism.without(*mechanism.stops)
    gaps: dict[str, float] = {}
    for beam, gap in _apart(scene, mechanism, point).items():
        gaps |= dict(zip(apart_by(beam), gap, strict=True))
    values = {**moments, **gaps}
    return Part(
        mechanism=replace(mechanism, problem=problem),
        start=_as_in(problem, point, values),
        begin=values,
        target={**moments, **dict.fromkeys(gaps, 0.0)},
        sentence="the ends go to their points",
    )


def released(scene: Scene, mechanism: Mechanism, point: Point) -> Part:
    """The third part: stops act, and the moments go away.

    Raises:
        SceneError: a stop does not allow where its beam stands.
    """
    moments, mistakes = _moments(scene), list(_forbidden(scene, mechanism, point))
    if mistakes:
        raise SceneError(mistakes)
    problem = mechanism.without()
    return Part(
        mechanism=replace(mechanism, problem=problem),
        start=point_at(problem, moments, point.state, point.mu, point.lam, point.rows),
        begin=moments,
        target=dict.fromkeys(moments, 0.0),
        sentence="the moments of the assembly go away",
    )


def formulated(scene: Scene, mechanism: Mechanism, point: Point) -> Part:
    """What ends the assembly: the mechanism itself, by the formulation that was asked."""
    return Part(
        mechanism=mechanism,
        start=point_at(mechanism.problem, {}, point.state, point.mu, point.lam, point.rows),
        begin={},
        target={},
        sentence=f"{scene.name} stands assembled",
    )


def _moments(scene: Scene) -> dict[str, float]:
    assert scene.assembly is not None
    return {moment_on(beam): moment for beam, moment in scene.assembly.moments.items()}


def _forbidden(scene: Scene, mechanism: Mechanism, point: Point) -> Iterator[Mistake]:
    for name, stop in mechanism.stops.items():
        angle = stop.angle(point.state)
        for limit, sign in zip(stop.limits, stop.signs, strict=True):
            if sign * (angle - limit) > BEYOND:
                key = f"stops.{name}.{'most' if sign > 0.0 else 'least'}"
                found = (
                    f"{limit:g} rad: a stop that forbids the assembly, by which {scene.stops[name].beam!r} comes to "
                    f"stand at {angle:.4g} rad"
                )
                yield Mistake(key, found, "limits that the assembled beam keeps, or other moments", scene.file)


def _apart(scene: Scene, mechanism: Mechanism, point: Point) -> dict[str, tuple[float, float]]:
    """How far (x, y), m, the ends of the beams to be assembled are from their points, by beam."""
    model = mechanism.problem.model
    found = {}
    for chain in model.chains:
        if chain.end is None or not isinstance(scene.beams[chain.name].end, PinnedEnd):
            continue
        rest = np.array(scene.beams[chain.name].curve.end) - model.unit_length * np.array(
            place(model, chain.end, np.zeros_like(point.state.bodies))
        )
        if np.hypot(*rest) <= APART * chain.line.length:
            continue
        last = chain.first_joint + chain.n + 1
        px, py = place(model, chain.end, point.state.bodies)
        found[chain.name] = (
            float(point.at.x[last] - px) * model.unit_length,
            float(point.at.y[last] - py) * model.unit_length,
        )
    return found


def _as_in(problem: Problem, point: Point, values: dict[str, float]) -> Point:
    """A state under other equalities, whose multipliers are not known yet."""
    return point_at(problem, values, point.state, np.zeros(problem.closure.rows), point.lam, point.rows)
