"""N for a tolerance: N doubles until every stated uncertainty is within the tolerance.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
N       links or elements per beam, of the solid elements along each beam
τ       tolerance, a fraction
f       stated uncertainty of a row (a probe at a station) over the denominator of the row
======  ==========================================================================================

Values and uncertainties at an N follow from the answers at N/4, N/2 and N, of the CPRBM also at N/2 + N/14.  No answer
is solved twice.  A doubling of N divides f by 2⁴ at most, the highest order of all methods: the search ends early where
even this order does not reach τ at the largest N.

A value is a limit by Richardson's extrapolation (:mod:`comparisons.verdict.uncertainty`) or the finest value, whichever
has the smaller uncertainty, and of two grids the limit.  A coarser N takes part where the branch, the closed contacts
and the number of values are those of the finest answer.  Shapes, events and certificates are the finest answer's.  The
ends of a zone keep the finest values where the limits would change places: the zone is then no longer than the ends are
uncertain.

The finite elements come first, in the theory of the CPRBM.  Their values are the denominators of the other
solvers' f; where a solver is asked alone, its own values are.  The solid has an element across the thickness for every
20 along.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np

from comparisons.choices import Choices
from comparisons.executor import Crew
from comparisons.formats import at_station, percent
from comparisons.pairing import Solvers, in_other_theory, paired, with_solid
from comparisons.reactions import perturbed_scene
from comparisons.sentences import problem_sentences
from comparisons.stations import station_of
from comparisons.store import AnswerMemory
from comparisons.verdict import Error, Row, Runs, Uncertainties, error, first_met, limit, rows_of, runs_of
from cprbm_scene import Answer, Array, PointForces, Probe, Scene, SceneError, StationAnswer, frozendict
from cprbm_scene.answer import frozen_array

SolverName = Literal["cprbm", "fea", "solid"]

FIRST: Mapping[SolverName, int] = {"cprbm": 10, "fea": 10, "solid": 20}
"""N of the first runs."""

LARGEST: Mapping[SolverName, int] = {"cprbm": 5120, "fea": 640, "solid": 160}
"""Largest N of each solver."""

LARGEST_PAPER = 640
"""Largest N of the formulation ``paper``, whose time grows with the cube of N."""

HIGHEST_ORDER = 4.0

ENOUGH = 40
"""N from which on a refusal of a solver is final, and a tolerance out of reach ends the search."""

PATIENCE = 160
"""N from which on the search ends where nothing can be stated: a run ended early, or a value comes and goes with N."""

Say = Callable[[str], None]
"""Called with a description of the next solve."""


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Result of a search for N.

    Attributes:
        asked: the tolerance, a fraction.
        solver: the solver.
        n: the last N.
        worst: the row with the largest fraction; None without a row that states any.
        fraction: the largest stated uncertainty; infinite in trouble, and where a value exists at one N and not at
            another; 0 without a row.
        trouble: why nothing is stated; else empty.
        probes: names of the probes with limits as values.
        solved: every solved N, ascending.
        ended: why no larger N followed; empty where the tolerance is met.
    """

    asked: float
    solver: SolverName
    n: int
    worst: Row | None
    fraction: float
    trouble: str
    probes: tuple[str, ...]
    solved: tuple[int, ...] = ()
    ended: str = ""

    @property
    def extrapolated(self) -> tuple[int, ...]:
        """The two finest N, where values are limits of both; otherwise empty."""
        return (self.n // 2, self.n) if self.probes else ()

    @property
    def met(self) -> bool:
        """Whether every row is within the tolerance."""
        return self.fraction <= self.asked

    def end(self, most: int) -> str:
        """Why the search ends at this N, with at most ``most`` for N; empty where the search goes on."""
        finite, at_most = math.isfinite(self.fraction), self.fraction * (self.n / most) ** HIGHEST_ORDER
        rules = (
            (self.met, "the tolerance is met"),
            (2 * self.n > most, f"N = {most} is the largest N"),
            (not finite and self.n >= PATIENCE, "no larger N would help"),
            (finite and self.n >= ENOUGH and at_most > self.asked, f"N = {most}, the largest N, would not do either"),
        )
        return first_met(rules, "")

    def sentence(self, scene: Scene) -> str:
        """Result with the deciding row, with stations in the units of the scene's file."""
        what = f"{self.n} {'links' if self.solver == 'cprbm' else 'elements'} per beam"
        if self.probes:
            what = f"{len(self.probes)} probes extrapolated from N = {', '.join(map(str, self.extrapolated))}"
        found, row = self.trouble or "no row has a value", self.worst
        if row is not None:
            finite = math.isfinite(self.fraction)
            stated = f"states {percent(self.fraction)}" if finite else "has a value at one N and none at another"
            found = f"{row.probe.name} at {at_station(scene, row.stage, row.station)} {stated}"
        ended = f"; {self.ended}" if self.ended else ""
        met = "within" if self.met else "NOT within"
        return f"{self.solver.upper()}: {met} {percent(self.asked)}: {what}; at worst {found}{ended}."


class Level(NamedTuple):
    """Answers of a solver at N and coarser.

    Attributes:
        answers: by N; the complete answers alone, unless there is a trouble.
        even: at N, of the CPRBM in ``auto``; with limits as values, unless there is a trouble.
        uncertainties: of all values with a law.
        probes: names of the probes with limits as values.
        paper: the answer at N in ``paper``, if the CPRBM is asked in ``paper``.
        trouble: why there are no limits; else empty.
    """

    answers: Mapping[int, Answer]
    even: Answer
    uncertainties: Uncertainties = frozendict()
    probes: tuple[str, ...] = ()
    paper: Answer | None = None
    trouble: str = ""

    @property
    def answer(self) -> Answer:
        """The answer at N in the wanted formulation."""
        return self.paper or self.even

    def runs(self, solver: SolverName) -> dict[str, Answer]:
        """Runs of a comparison by name: the answer, the answer at N/2, and beside ``paper`` the limits in ``auto``."""
        even = {} if self.paper is None else {f"{solver} auto": self.even}
        return {solver: self.answer, f"{solver} finer": self.answers[max(self.answers) // 2], **even}


def limits_of(scene: Scene, answers: Mapping[int, Answer]) -> Level:
    """Limits of answers by N: complete answers at the finest N, at half of it, and at any further N."""
    fine = answers[n := max(answers)]
    series = [{size: station_of(answers[size], at.stage, at.value) for size in sorted(answers)} for at in fine.stations]
    found = [
        (at, {probe.name: _value(probe, by_size) for probe in scene.probes_in(at.stage)})
        for at, by_size in zip(fine.stations, series, strict=True)
    ]
    names = {name for _, values in found for name, (*_, extrapolated) in values.items() if extrapolated}
    uncertainties = {
        (at.stage, at.value, name): stated
        for at, values in found
        for name, (_, stated, _) in values.items()
        if stated is not None
    }
    probes = tuple(probe.name for probe in scene.probes if probe.name in names)
    # limits belong to no state: no forces are in balance with them
    stations = tuple(
        replace(
            at,
            values=frozendict({name: value for name, (value, *_) in values.items()}),
            beams={},
            forces=PointForces(),
        )
        for at, values in found
    )
    answer = replace(fine, stations=stations, seconds=sum(each.seconds for each in answers.values()))
    if probes:
        answer = replace(
            answer,
            settings=frozendict({**fine.settings, "extrapolated_from": [n // 2, n]}),
            notes=(
                *fine.notes,
                f"Extrapolated from N = {n // 2}, {n}: {', '.join(sorted(probes))}; all other values, shapes and "
                f"certificates are of N = {n}.",
            ),
        )
    return Level(answers, answer, frozendict(uncertainties), probes)


def _value(probe: Probe, by_size: Mapping[int, StationAnswer]) -> tuple[Array, Error | None, bool]:
    """Value (k,) at a station, its uncertainty (None without a law), and whether the value is a limit."""
    fine = by_size[n := max(by_size)]
    value = fine.values[probe.name]
    values = {
        size: station.values[probe.name]
        for size, station in by_size.items()
        if station.branch == fine.branch
        and station.touching.keys() == fine.touching.keys()
        and station.values[probe.name].shape == value.shape
    }
    if value.size == 0 or n // 2 not in values:
        return value, None, False
    sizes, series = list(values), list(values.values())
    own, found = error(sizes, series, at=len(sizes) - 1), limit(sizes, series)
    ordered = probe.quantity != "ends" or bool(np.all(np.diff(found.value) >= 0.0))
    surer = len(sizes) < 3 or found.uncertainty.sum() <= (own.even + own.uneven).sum()  # two grids show no order
    if not (ordered and surer):
        return value, own, False
    return frozen_array(found.value), Error(found.uncertainty, np.zeros_like(found.uncertainty)), True


@dataclass(frozen=True, slots=True)
class _Search:
    """A solver and its question; ``reference`` is the answer with the denominators, None for the solver's own."""

    scene: Scene
    solver: SolverName
    choices: Choices
    tolerance: float
    memory: AnswerMemory
    reference: Answer | None = None

    def run(self) -> tuple[Level, Tolerance]:
        """The last level of the search, and the result."""
        n, solved, end = FIRST[self.solver], set[int](), ""
        while not end:
            n *= 2
            try:
                level, found = self.at(n)
            except SceneError:  # few links may be too few for the joints of a formulation
                if n >= ENOUGH:
                    raise
                continue
            solved.update(found.solved)
            end = found.end(LARGEST_PAPER if self.in_paper else LARGEST[self.solver])
        return level, replace(found, solved=tuple(sorted(solved)), ended="" if found.met else end)

    def at(self, n: int) -> tuple[Level, Tolerance]:
        """The level of an N, and the result with N as the last number.

        Raises:
            SceneError: the solver refuses the question.
        """
        own, first = getattr(self.memory.solvers, self.solver), FIRST[self.solver]
        sizes = {size for size in (n // 4, n // 2, n) if size >= first}
        ordered = sorted(sizes | ({n // 2 + max(1, round(n / 14))} if self.solver == "cprbm" else set()))
        even = [(own, self.scene, replace(self.choices_at(size), formulation="auto")) for size in ordered]
        paper = [(own, self.scene, self.choices_at(n))] if self.in_paper else []
        solved = self.memory.answers([*even, *paper])
        in_paper = solved.pop() if paper else None
        answers = dict(zip(ordered, solved, strict=True))
        problems = {size: next(iter(problem_sentences(self.scene, each)), "") for size, each in answers.items()}
        trouble = problems[n // 2] or problems[n]
        worst: tuple[Row | None, float] = None, math.inf
        if trouble:
            level = Level(answers, answers[n], paper=in_paper, trouble=trouble)
        else:
            whole = {size: answer for size, answer in answers.items() if not problems[size]}
            level = limits_of(self.scene, whole)._replace(paper=in_paper)
            worst = self._worst(level)
        found = Tolerance(
            self.tolerance,
            self.solver,
            n,
            *worst,
            trouble=trouble,
            probes=() if self.in_paper else level.probes,
            solved=tuple(ordered),
        )
        return level, found

    def choices_at(self, n: int) -> Choices:
        """The choices at N."""
        return replace(self.choices.of_size(n), across=max(n // FIRST["solid"], 1))

    @property
    def in_paper(self) -> bool:
        """True for the CPRBM in ``paper``, whose values are never limits."""
        return self.solver == "cprbm" and self.choices.formulation == "paper"

    def _worst(self, level: Level) -> tuple[Row | None, float]:
        """The row with the largest f, and f, of a value in ``paper`` with the distance from ``auto``."""
        reference = self.reference or level.even
        answers = {**level.runs("cprbm"), "fea": reference, "fea finer": reference}
        runs = Runs(
            self.scene,
            self.choices.kinematics_of(self.scene),
            answers,
            settled={"cprbm": level.uncertainties},
        )
        pair = level.even, answers["cprbm finer"]
        stated = ((row, f) for row in rows_of(runs) if (f := _fraction(row, pair)) is not None)
        return max(stated, key=lambda each: each[1], default=(None, 0.0))


def _fraction(row: Row, pair: tuple[Answer, Answer]) -> float | None:
    """f; None without a value and between events, infinite where one answer of a ``pair`` alone has the value."""
    if row.events.between:
        return None
    if row.bounds is not None:
        return row.fraction(row.bounds.cprbm)
    shapes = {
        station.values[row.probe.name].shape
        for answer in pair
        for station in answer.stations
        if (station.stage, station.value) == row.where
    }
    return None if len(shapes) == 1 else math.inf


def solve_within(
    scene: Scene, solver: SolverName, choices: Choices, tolerance: float, solvers: Solvers, say: Say
) -> tuple[Answer, Tolerance]:
    """One solver's answer within a tolerance, or the answer at the last N.

    Args:
        scene: the question.
        solver: the solver.
        choices: formulation, theory, and the penetration at N = 40.
        tolerance: τ.
        solvers: functions of the solvers.
        say: called with a description of the next solve.

    Raises:
        SceneError: the solver refuses the question.
    """
    memory = AnswerMemory(solvers=with_solid(solvers) if solver == "solid" else solvers, say=say)
    theory = choices.kinematics_of(scene) if solver == "fea" else choices.theory_of(scene)
    level, found = _Search(scene, solver, choices.within(theory), tolerance, memory).run()
    return level.answer, found


def runs_within(
    scene: Scene, choices: Choices, tolerance: float, solvers: Solvers, crew: Crew, say: Say
) -> tuple[Runs, tuple[Tolerance, ...]]:
    """The runs of a comparison with all solvers within a tolerance, and the results of the searches.

    Args:
        scene, choices, tolerance, solvers, say: as of :func:`solve_within`.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    memory = AnswerMemory(pool=crew.pool, solvers=solvers, say=say)
    theory = choices.kinematics_of(scene)
    of_fea = _Search(scene, "fea", choices.within(theory), tolerance, memory)
    fea, elements = of_fea.run()
    of_cprbm = replace(of_fea, solver="cprbm", reference=fea.answer)
    cprbm, links = of_cprbm.run()
    at_last = replace(of_fea.choices_at(elements.n), links=links.n)
    if cprbm.trouble or fea.trouble:
        runs = paired(scene, at_last, replace(solvers, solid=None), memory)
    else:
        results: dict[str, Answer | str] = {**cprbm.runs("cprbm"), **fea.runs("fea")}
        results |= in_other_theory(scene, replace(at_last, links=links.n // 2), solvers)
        if (driven := perturbed_scene(scene)) is not None:
            results["cprbm perturbed"] = replace(of_cprbm, scene=driven, reference=None).at(links.n)[0].answer
        if solvers.exact and theory == "bending":
            (results["exact"],) = memory.answers([(solvers.exact, scene, of_fea.choices)])
        runs = runs_of(
            scene,
            theory,
            results,
            settled={"cprbm": cprbm.uncertainties, "fea": fea.uncertainties},
        )
    if solvers.solid is not None:
        solid, of_solid = replace(of_fea, solver="solid", reference=None if fea.trouble else fea.answer).run()
        return replace(runs, solids=tuple(solid.answers.values())), (links, elements, of_solid)
    return runs, (links, elements)
