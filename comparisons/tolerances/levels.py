"""The answers of one solver to one scene at the sizes that a search asks for, and what they state.

A row's f is u, as :mod:`comparisons.verdict.bounds` states it, over what the tables divide that row by.  There the
finite elements' value takes part; where they have not answered (``solve``) the answer stands in its own place.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, replace

from comparisons.choices import Choices
from comparisons.crew import Solver
from comparisons.pairing import Runs
from comparisons.sentences import problem_sentences
from comparisons.store import AnswerMemory
from comparisons.tolerances.search import FIRST, Estimate, Stated
from comparisons.tolerances.settled import Settled, settled
from comparisons.verdict.rows import Row, rows_of
from comparisons.verdict.station_events import Place
from comparisons.verdict.uncertainty import STANDARD
from cprbm_scene import Answer, Scene
from cprbm_scene.frozendict import frozendict


@dataclass(frozen=True, slots=True)
class SceneLevels:
    """One solver on one scene.

    Attributes:
        scene: the question.
        solver: who answers.
        base: choices with a theory; numbers of links and elements, and from ``FIRST`` on the penetration, follow N.
        memory: solves, nothing twice.
        beside: whether a value at N is held against N + N/7 as well.
        reference: the finite elements' answer, if they have one already.
    """

    scene: Scene
    solver: Solver
    base: Choices
    memory: AnswerMemory
    beside: bool
    reference: Answer | None = None

    def choices(self, n: int) -> Choices:
        """What is solved at ``n``: so that twice N is what :meth:`comparisons.choices.Choices.finer` makes of it."""
        share = FIRST / n
        # a product, not a power, so that halving the share divides it by 16 to the last digit
        penetration = self.base.penetration * (share * share * share * share)
        return replace(self.base, links=n, elements=n, penetration=penetration)

    def plain(self, n: int) -> Estimate:
        """Of the values at ``n``, from n and 2n."""
        return self._plain(n, beside=False)

    def checked(self, n: int) -> Estimate:
        """The same, with n + n/7 where the error may be uneven."""
        return self._plain(n, beside=self.beside)

    def settled(self, n: int) -> Estimate:
        """Of the values at 2n or what n and 2n extrapolate to, from n/2, n and 2n.

        A probe is extrapolated if its worst row states less so.
        """
        names = [probe.name for probe in self.scene.probes]
        kept, all_ = (self._settled(n, probes) for probes in ((), names))
        if kept.trouble or all_.trouble:
            return kept
        before, after = _worst_of_probes(kept), _worst_of_probes(all_)
        probes = frozenset(name for name, fraction in after.items() if fraction < before[name])
        rows = zip(kept.rows, all_.rows, strict=True)
        return Estimate(tuple(b if a.probe in probes else a for a, b in rows), extrapolated=probes)

    def answer(self, n: int) -> Answer:
        """The answer at ``n``."""
        return self._answers([self.choices(n)])[0]

    def pair(self, n: int, probes: Collection[str]) -> Settled:
        """The values settled on n/2, n and 2n, with these probes extrapolated."""
        answers = dict(zip(self._sizes(n), self._three(n), strict=True))
        beside = self.beside_it(n)
        if beside is not None and not problem_sentences(self.scene, beside):
            answers[round(n / self.ratio(n))] = beside
        return settled(self.scene, answers, probes)

    def beside_it(self, n: int) -> Answer | None:
        """The answer at n + n/7; None where no value is held against it."""
        return self._answers([self.choices(n).beside()])[0] if self.beside else None

    def ratio(self, n: int) -> float:
        """n over the links beside them."""
        return self.choices(n).ratios_beside()[0]

    def solved(self) -> tuple[int, ...]:
        """Every N at which the solver has answered the scene, ascending."""
        return self.memory.sizes(self.solver, self.scene)

    def _plain(self, n: int, *, beside: bool) -> Estimate:
        chosen = self.choices(n)
        even = replace(chosen, formulation="auto")
        mine = self._answers([chosen, even, even.finer(), *([even.beside()] if beside else [])])
        runs = replace(
            self._runs(mine[0], mine[2]),
            auto=None if chosen == even else mine[1],
            beside=mine[3] if beside else None,
            ratio=even.ratios_beside()[0],
        )
        return stated(self.scene, runs)

    def _settled(self, n: int, probes: Collection[str]) -> Estimate:
        troubles = [trouble for answer in self._three(n) for trouble in problem_sentences(self.scene, answer)]
        if troubles:
            return Estimate((), troubles[0])
        pair = self.pair(n, probes)
        runs = replace(
            self._runs(pair.answer, pair.coarse),
            beside=self.beside_it(n),
            ratio=self.ratio(n),
            settled=frozendict({"cprbm": pair.uncertainties}),
        )
        return stated(self.scene, runs)

    def _runs(self, value: Answer, other: Answer) -> Runs:
        """A solver's answer, what it is held against, and by what the differences are measured."""
        reference = value if self.reference is None else self.reference
        return Runs(self.base.kinematics_of(self.scene), (value, other), (reference, reference))

    def _three(self, n: int) -> tuple[Answer, Answer, Answer]:
        first, coarse, fine = self._answers([self.choices(size) for size in self._sizes(n)])
        return first, coarse, fine

    def _sizes(self, n: int) -> tuple[int, int, int]:
        return n // 2, n, 2 * n

    def _answers(self, wanted: list[Choices]) -> list[Answer]:
        return self.memory.answers([(self.solver, self.scene, choices) for choices in wanted])


def stated(scene: Scene, runs: Runs) -> Estimate:
    """What is stated of every row that has a value, of the first solver in ``runs``."""
    for _, answer in runs.everything():
        found = problem_sentences(scene, answer)
        if found:
            return Estimate((), found[0])
    rows = []
    for row in rows_of(scene, runs):
        fraction = _fraction(row, runs)
        if fraction is not None:
            rows.append(Stated(row.probe.name, row.stage, row.station, fraction, STANDARD))
    return Estimate(tuple(rows))


def _fraction(row: Row, runs: Runs) -> float | None:
    """f; None without a value or where a branch ends; infinite where there is one at one size and not at another."""
    if row.place is Place.BETWEEN:
        return None
    if row.bounds is not None:
        return row.fraction(row.bounds.cprbm)
    values = [
        station.values[row.probe.name]
        for name, answer in runs.everything()
        if name.startswith("cprbm")
        for station in answer.stations
        if (station.stage, station.value) == (row.stage, row.station)
    ]
    return None if len({value.shape for value in values}) == 1 else math.inf


def _worst_of_probes(estimate: Estimate) -> dict[str, float]:
    """The largest f of every probe; nothing in trouble.

    Rows of which nothing can be stated are the same however a value is settled, and do not count.
    """
    worst: dict[str, float] = {}
    for row in estimate.rows:
        if math.isfinite(row.fraction):
            worst[row.probe] = max(row.fraction, worst.get(row.probe, 0.0))
    return worst
