"""How critical values go with N.

A size counts if its run gave a whole answer, or one that ends where its branch does, and has the critical value by the
mechanism of the finest size; of the sizes that do not, the coarser ones do not count either.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from comparisons.quantities import load_unit
from comparisons.stations import span_of
from comparisons.studies.families import Series
from comparisons.verdict.completeness import ends_at_critical
from comparisons.verdict.events import mechanism
from comparisons.verdict.uncertainty import Limit, limit, orders
from cprbm_scene import Answer, Critical, Scene, Stage


@dataclass(frozen=True, slots=True)
class CriticalFamily:
    """One critical value, found by one solver at all sizes.

    Attributes:
        series: who solved.
        stage: name of the stage.
        place: which one of the stage's, from 0.
        unit: SI unit of the values.
        span: of the stage, in the unit.
        critical: by N, where there is one.
        used: the sizes that count.
        orders: observed at every three sizes that count and follow each other.
        found: the limit, if two sizes or more count.
        why: why there is no limit, or no observed order.
    """

    series: Series
    stage: str
    place: int
    unit: str
    span: float
    critical: dict[int, Critical]
    used: tuple[int, ...]
    orders: tuple[float | None, ...]
    found: Limit | None
    why: str

    @property
    def mechanism(self) -> str:
        """How stability is lost at the finest size."""
        return mechanism(self.critical[max(self.critical)])

    def error(self, n: int) -> float | None:
        """How far the value at N may be from the true limit, in the unit."""
        if self.found is None or n not in self.used:
            return None
        return float(self.found.errors(np.array([[self.critical[n].value]]))[0, 0])


def critical_families(scene: Scene, series: Sequence[Series]) -> tuple[CriticalFamily, ...]:
    """Every critical value of every series, in the order of stages."""
    found = []
    for stage in scene.stages:
        own = {
            id(one): {n: [each for each in a.critical if each.stage == stage.name] for n, a in _answers(one).items()}
            for one in series
        }
        most = max((len(each) for sizes in own.values() for each in sizes.values()), default=0)
        for place in range(most):
            for one in series:
                here = {n: each[place] for n, each in sorted(own[id(one)].items()) if len(each) > place}
                if here:
                    found.append(_family(scene, one, stage, place, here))
    return tuple(found)


def _answers(series: Series) -> dict[int, Answer]:
    return {n: each for n, each in series.answers.items() if n in series.whole or ends_at_critical(each)}


def _family(scene: Scene, series: Series, stage: Stage, place: int, here: dict[int, Critical]) -> CriticalFamily:
    ns = sorted(_answers(series))
    last = here[max(here)]
    alike = [n in here and (here[n].loss, here[n].what) == (last.loss, last.what) for n in ns]
    first = max((i + 1 for i, same in enumerate(alike) if not same), default=0)
    used = tuple(ns[first:])
    values = np.array([here[n].value for n in used])
    floor = max((here[n].uncertainty for n in used), default=0.0)
    found = limit(used, values, series.order, floor) if len(used) > 1 else None
    why = "one size alone counts" if found is None else found.why
    if found is None and first:
        why = f"at N = {ns[first - 1]} there is none by this mechanism"
    return CriticalFamily(
        series=series,
        stage=stage.name,
        place=place,
        unit=load_unit(scene, stage),
        span=span_of(scene, stage),
        critical=here,
        used=used,
        orders=orders(used, values, floor) if len(used) > 2 else (),
        found=found,
        why=why,
    )
