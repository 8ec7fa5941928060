"""Contacts that are open by less than a solver's meshes tell, where another answer has them press.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
g, G    least gap of a contact in an answer at N and at 2N, by the auditor's lines
w       the same beside, at N + N/7
u       uncertainty of g, as of any value (:mod:`comparisons.measures`)
======  ==================================================================================

A contact that is open has no force on any mesh, and v − V says that the force is known to nothing.  It is not: where
0 ≤ g ≤ u the limit may press.  By how much no answer says in which it is open.  A gap is no less than nought but for
what the auditor's lines are off: what overlaps by more, and does not press, is no contact that is open.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from comparisons.audit.gaps import spaces
from comparisons.audit.rest import rests_of
from comparisons.audit.seen import seen_of
from comparisons.pairing import Runs
from comparisons.stations import station_of
from comparisons.uncertainty import error
from cprbm_scene import Answer, Scene

LESS = 0.1  # of u, by which a gap may seem to be less than nought

Where = tuple[str, float]
"""A stage and a station."""


def hardly_open(scene: Scene, runs: Runs) -> Mapping[Where, frozenset[str]]:
    """By station the contacts that press in some answer, and that all of a solver's leave open by less than they tell.

    Raises:
        KeyError: an answer lacks a station.
    """
    families = tuple(_families(runs))
    found: dict[Where, set[str]] = {}
    for stage in scene.stages:
        for value in stage.stations:
            closed = [
                [frozenset(station_of(answer, stage.name, value).touching) for answer in answers]
                for answers, _ in families
            ]
            for name in frozenset().union(*(each for family in closed for each in family)):
                for (answers, ratio), touching in zip(families, closed, strict=True):
                    if any(name in each for each in touching):
                        continue
                    gaps = [_gap(scene, answer, (stage.name, value), name) for answer in answers]
                    if np.isfinite(gaps).all() and -LESS <= gaps[0] / _uncertain(gaps, ratio) <= 1.0:
                        found.setdefault((stage.name, value), set()).add(name)
    return {where: frozenset(names) for where, names in found.items()}


def _families(runs: Runs) -> Iterator[tuple[tuple[Answer, ...], float]]:
    """Answers of one solver and theory at N, 2N and, if there is one, beside, and N over how many that has."""
    coarse = runs.cprbm[0] if runs.auto is None else runs.auto
    yield (coarse, runs.cprbm[1], *_known(runs.beside)), runs.ratio
    for kinematics, answers in runs.fea.items():
        if len(answers) > 1:
            beside = runs.fea_beside if kinematics == runs.kinematics else None
            yield (*answers[:2], *_known(beside)), runs.fea_ratio


def _known(answer: Answer | None) -> tuple[Answer, ...]:
    return () if answer is None else (answer,)


def _gap(scene: Scene, answer: Answer, where: Where, name: str) -> float:
    """g, m; infinite where nothing faces the beam, or the answer does not say what it is inside."""
    alone = replace(answer, stations=(station_of(answer, *where),))
    every = (space for seen in seen_of(scene, alone, rests_of(scene)) for space in spaces(seen, name))
    return min((float(np.min(space.gap, where=space.counted, initial=np.inf)) for space in every), default=np.inf)


def _uncertain(gaps: Sequence[float], ratio: float) -> float:
    """u from g, G and, where there is one, w."""
    g, G, *beside = (np.array([gap]) for gap in gaps)
    grids = zip((1.0, 1.0 / ratio, 2.0), (g, beside[0], G), strict=True) if beside else ((1.0, g), (2.0, G))
    sizes, values = zip(*grids, strict=True)
    found = error(sizes, values)
    return max(float((found.even + found.uneven)[0]), float(np.finfo(float).tiny))
