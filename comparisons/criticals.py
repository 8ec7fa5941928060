"""Critical values beside each other: where a branch ends in either answer, why, and what may lie between.

======  =======================================================================================================
symbol  meaning
======  =======================================================================================================
v_c     the CPRBM's critical value at N links, v_f the finite elements' in the chosen theory at n elements
v_b     the finite elements' in ``bending``
U, U_b  what may lie between v_c and v_f, and between v_c and v_b: as of every row (:mod:`comparisons.measures`), by
        the same runs; r is what following a branch leaves open of a value on its discretisation
θ       the theory's part of U, |v_b − v_f|
T       what the stage asks, or else 0.3 degrees of a rotation and 1 % of the stage's span of anything else
W       the scene's ``verdict_limit`` as a share of the stage's span
======  =======================================================================================================

    DIFFER     one of the two has no such critical value, or another mechanism of losing stability, or
               |v_c − v_b| > max(T, U_b)
    UNDECIDED  the runs of one solver do not all have it, or not by one mechanism; or max(U − θ, U_b) > T; or
               U > max(T, W); or some run has gone on over it
    AGREE      otherwise

T is asked of the solvers, within one theory: |v_c − v_f| is then no more than that and θ, which is told beside it and
which W keeps from excusing much.

The first critical value of a stage is held against the first of the other answers, the second against the second.
Where a stage asks for none, one answer may end at what another has gone on over to a state beside it: both have it
then, by one mechanism and no farther apart than above, and what lies beyond nothing tells.
What a state releases in a jump is told and has no part in it: the rows of the next branch are judged by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from comparisons.branches import span_of, turns
from comparisons.measures import Bounds, bounds_of, load_unit
from comparisons.pairing import Runs
from cprbm_scene import Answer, Critical, GoneOver, Scene, Stage
from cprbm_scene.frozendict import frozendict

TURN = math.radians(0.3)
"""T of a rotation, rad."""

SHARE = 0.01
"""T of anything else, a share of the stage's span."""


@dataclass(frozen=True, slots=True)
class CriticalRow:
    """One critical value; lengths of the load's or drive's axis are in ``unit``.

    Attributes:
        stage: name of the stage.
        place: which one of the stage's, from 0.
        unit: SI unit of the values.
        cprbm, fea: the two solvers'; None where one has none.
        span: of the stage.
        allowed: T.
        largest: W.
        steady: whether the runs of either solver are of one mind: all have it by one mechanism, or none has it.
        turned: of the runs that have gone on over it how far the state beside it is turned, rad.
        difference: |v_c − v_f|, NaN where one is missing.
        same_theory: |v_c − v_b|, NaN where one is missing.
        bounds: U and U_b; None where a run has no such critical value.
    """

    stage: str
    place: int
    unit: str
    cprbm: Critical | None
    fea: Critical | None
    span: float
    allowed: float
    largest: float
    steady: bool
    difference: float = math.nan
    same_theory: float = math.nan
    bounds: Bounds | None = None
    turned: Mapping[str, float] = frozendict()

    @property
    def same_mechanism(self) -> bool:
        """Whether both solvers have it, and lose stability in one way."""
        if self.cprbm is None or self.fea is None:
            return False
        return _mechanism(self.cprbm) == _mechanism(self.fea)

    @property
    def differs(self) -> bool:
        """Whether the two solvers contradict each other."""
        if not self.same_mechanism:
            return self.steady
        if self.bounds is None:
            return False
        return self.same_theory > max(self.allowed, self.bounds.same_theory)

    @property
    def tellable(self) -> bool:
        """Whether what may lie between the values is small enough to have them agree."""
        if not self.steady or self.bounds is None or self.turned:
            return False
        own = max(self.bounds.total - self.bounds.theory, self.bounds.same_theory)
        return own <= self.allowed and self.bounds.total <= max(self.allowed, self.largest)

    @property
    def station(self) -> float:
        """A value to name it by: the CPRBM's, or the finite elements' where that has none."""
        found = self.cprbm or self.fea
        return math.nan if found is None else found.value


def critical_rows(scene: Scene, runs: Runs) -> tuple[CriticalRow, ...]:
    """All critical values that the CPRBM or the finite elements found, in the order of stages."""
    everyone = dict(runs.everything())
    found = []
    for stage in scene.stages:
        own = {name: _of_stage(answer, stage) for name, answer in everyone.items()}
        most = max(len(_of_stage(answer, stage)) for answer in (runs.cprbm[0], runs.reference))
        for place in range(most):
            here = {name: each[place] if len(each) > place else None for name, each in own.items()}
            row = _row(scene, runs, stage, place, here)
            if not row.steady or row.differs:
                row = next(_over(scene, runs, stage, row, here), row)
            found.append(row)
    return tuple(found)


def mechanism(critical: Critical) -> str:
    """How stability is lost, in words: of a contact or a stop also which."""
    return f"{critical.what}: {critical.loss.value}" if critical.what else critical.loss.value


def released(critical: Critical) -> float | None:
    """The energy that a jump releases, J; None where a solver stopped."""
    return None if critical.after is None else critical.energy - critical.after


def _of_stage(answer: Answer, stage: Stage) -> tuple[Critical, ...]:
    return tuple(critical for critical in answer.critical if critical.stage == stage.name)


def _over(
    scene: Scene, runs: Runs, stage: Stage, row: CriticalRow, here: Mapping[str, Critical | None]
) -> Iterator[CriticalRow]:
    """The row in which runs that have gone on over what another ends at have it too, if they then do not differ."""
    for told in (row.cprbm, row.fea):
        if told is None:
            continue
        ends, turned = dict(here), {}
        for name, answer in runs.everything():
            mine, gone = here[name], _most_like(answer, told)
            if gone is None:
                continue
            same = mine is not None and _mechanism(mine) == _mechanism(told)
            if mine is None or not same or _apart(gone.end, told) < _apart(mine, told):
                ends[name], turned[name] = gone.end, gone.turned
        if turned:
            found = replace(_row(scene, runs, stage, row.place, ends), turned=frozendict(turned))
            if found.steady and not found.differs:
                yield found


def _most_like(answer: Answer, told: Critical) -> GoneOver | None:
    """What an answer has gone on over that is nearest to an end which another has told, by one mechanism."""
    how = told.stage, _mechanism(told)
    alike = (one for one in answer.gone_over if (one.end.stage, _mechanism(one.end)) == how)
    return min(alike, key=lambda one: _apart(one.end, told), default=None)


def _apart(one: Critical, other: Critical) -> float:
    return abs(one.value - other.value)


def _row(scene: Scene, runs: Runs, stage: Stage, place: int, here: Mapping[str, Critical | None]) -> CriticalRow:
    span = span_of(scene, stage)
    chosen = f"fea {runs.kinematics}"
    of_cprbm = {_mechanism(each) for name, each in here.items() if name.startswith("cprbm")}
    of_fea = {_mechanism(each) for name, each in here.items() if not name.startswith("cprbm")}
    row = CriticalRow(
        stage=stage.name,
        place=place,
        unit=load_unit(scene, stage),
        cprbm=here["cprbm"],
        fea=here[chosen],
        span=span,
        allowed=stage.critical_limit or (TURN if turns(scene, stage) else SHARE * span),
        largest=scene.verdict_limit * span,
        steady=len(of_cprbm) == len(of_fea) == 1,
    )
    present = {name: each for name, each in here.items() if each is not None}
    if len(present) < len(here):
        return row
    values = {name: np.array([each.value]) for name, each in present.items()}
    allowance = sum(
        max(each.uncertainty for name, each in present.items() if name.startswith("cprbm") is mine)
        for mine in (True, False)
    )
    return replace(
        row,
        difference=float(abs(values["cprbm"] - values[chosen])[0]),
        same_theory=float(abs(values["cprbm"] - values["fea bending"])[0]),
        bounds=bounds_of(runs, values, lambda d: float(np.linalg.norm(d)), allowance),
    )


def _mechanism(critical: Critical | None) -> tuple[str, str] | None:
    return None if critical is None else (critical.loss.name, critical.what)
