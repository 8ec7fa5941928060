"""A run of random scenes: drawn and judged in child processes, outcomes stored at once, failures shrunk and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from comparisons.pairing import Solvers
from comparisons.present.columns import Plain
from comparisons.writing import write
from cprbm_scene import Scene, SceneError, scene_from
from tests.robustness.drawing import Drawn, drawn
from tests.robustness.judging import Effort, judged
from tests.robustness.kept import Kept, digest
from tests.robustness.limited import Calls, Crashed, End, Limits, OutOfTime, Returned, calls_of
from tests.robustness.outcomes import Outcome, Way
from tests.robustness.shrinking import Patience, shrunk
from tests.robustness.strata import stated
from tests.robustness.toml import toml_of

FAILURES = (Way.WRONG, Way.CRASHED, Way.TIMED_OUT)
"""Ways that are always a fault of the program."""

SHARE = 0.1
"""Share of the time limit after which a smaller scene counts as out of time."""

HASTE = 30.0
"""Clock time, s, for the shrinking of a scene that was out of time: every smaller scene takes all of its time."""


@dataclass(frozen=True, slots=True)
class Plan:
    """The question of a run.

    Attributes:
        seed: of the scenes.
        effort: for each scene.
        limits: of each scene.
    """

    seed: int
    effort: Effort = field(default_factory=Effort)
    limits: Limits = field(default_factory=Limits)


@dataclass(frozen=True, slots=True)
class Crew:
    """The means of a run.

    Attributes:
        solvers: the functions that answer.
        children: number of child processes.
        draw: function that returns the scene of a seed and an index.
        patience: effort of shrinking.
    """

    solvers: Solvers
    children: int
    draw: Callable[[int, int], Drawn] = drawn
    patience: Patience = field(default_factory=Patience)


@dataclass(frozen=True, slots=True)
class Stress:
    """The state of a run.

    Attributes:
        plan: the question.
        outcomes: by the index of the scene, ascending.
        saved: files below the run's folder that replay failures, by the same index.
        before: number of outcomes of an earlier run.
    """

    plan: Plan
    outcomes: Mapping[int, Outcome]
    saved: Mapping[int, str]
    before: int = 0


def run(plan: Plan, scenes: int, folder: Path, also: Sequence[Way], crew: Crew) -> Iterator[Stress]:
    """Judge the first scenes of a seed without a stored outcome, and save failures.

    Args:
        plan: the question.
        scenes: number of scenes.
        folder: existing folder of outcomes and saved scenes.
        also: further ways that count as failures.
        crew: the means.

    Yields:
        The state of the run: first the stored outcomes, then after each scene that was judged or saved.

    Raises:
        OSError: the folder cannot be written.
    """
    kept = Kept(folder / f"outcomes-{digest(plan)}.jsonl")
    known, files = kept.read()
    outcomes = {index: known[index] for index in sorted(known) if index < scenes}
    saved = {index: files[index] for index in sorted(files) if index < scenes}
    there = Stress(plan, outcomes, saved, before=len(outcomes))
    yield there
    failing = (*FAILURES, *also)
    left = [index for index in range(scenes) if index not in outcomes]
    if not left and all(index in saved for index, each in outcomes.items() if each.way in failing):
        return
    with calls_of(crew.children, partial(prepared, crew.solvers)) as calls:
        for now in _judged(there, left, kept, calls, crew):
            there = now
            yield there
        yield from _shrunk(there, failing, folder, kept, calls, crew)


def prepared(solvers: Solvers) -> None:
    """Load the modules and kernels of both solvers by a small case."""
    from comparisons.cases import opened

    judged(opened("tapered"), solvers, Effort(sizes=1))


def _judged(there: Stress, left: Sequence[int], kept: Kept, calls: Calls, crew: Crew) -> Iterator[Stress]:
    for index, end in calls.each(partial(_drawn_and_judged, there.plan, crew), left, there.plan.limits):
        name, features = f"scene-{index}", ()
        if not isinstance(end, Returned):
            name, features = _named(there.plan, crew, calls, index)
        outcome = replace(_outcome(name, end), stated=features) if features else _outcome(name, end)
        kept.ended(index, outcome)
        there = replace(there, outcomes=dict(sorted({**there.outcomes, index: outcome}.items())))
        yield there


def _shrunk(
    there: Stress, failing: Sequence[Way], folder: Path, kept: Kept, calls: Calls, crew: Crew
) -> Iterator[Stress]:
    found = {index: each for index, each in there.outcomes.items() if each.way in failing and index not in there.saved}
    pending = {calls.pool.submit(_smaller, there.plan, crew, calls, index, found[index]): index for index in found}
    for future in as_completed(pending):
        index, outcome = pending[future], found[pending[future]]
        file = f"{outcome.name}.toml"
        text = f"# {outcome.way.words}: {outcome.sentence}\n{_less(there, outcome)}\n{future.result()}"
        write(folder / file, text)
        kept.saved(index, file)
        there = replace(there, saved=dict(sorted({**there.saved, index: file}.items())))
        yield there


def judged_data(data: Plain, solvers: Solvers, effort: Effort) -> Outcome:
    """The outcome of a scene of plain data."""
    try:
        scene = scene_from(data)
    except SceneError as error:
        return Outcome(str(data.get("name", "")), Way.REFUSED, "; ".join(map(str, error.mistakes)))
    return judged(scene, solvers, effort)


def replayed(scene: Scene, solvers: Solvers, plan: Plan) -> Outcome:
    """The outcome of a scene in a child process."""
    with calls_of(1, partial(prepared, solvers)) as calls:
        ((_, end),) = calls.each(partial(judged, solvers=solvers, effort=plan.effort), [scene], plan.limits)
    return _outcome(scene.name, end)


def _outcome(name: str, end: End[Outcome]) -> Outcome:
    match end:
        case Returned(outcome):
            return outcome
        case Crashed(sentence):
            return Outcome(name, Way.CRASHED, sentence)
        case OutOfTime(sentence):
            return Outcome(name, Way.TIMED_OUT, sentence)


def _drawn_and_judged(plan: Plan, crew: Crew, index: int) -> Outcome:
    return judged_data(crew.draw(plan.seed, index).data, crew.solvers, plan.effort)


def _named(plan: Plan, crew: Crew, calls: Calls, index: int) -> tuple[str, tuple[str, ...]]:
    """Name and features of a scene that ended by force."""
    ((_, end),) = calls.each(partial(_stated, plan, crew.draw), [index], plan.limits)
    return end.value if isinstance(end, Returned) else (f"scene-{index}", ())


def _stated(plan: Plan, draw: Callable[[int, int], Drawn], index: int) -> tuple[str, tuple[str, ...]]:
    found = draw(plan.seed, index)
    return found.name, tuple(sorted(stated(scene_from(found.data))))


def _less(there: Stress, outcome: Outcome) -> str:
    """Comment of a saved scene that was shrunk with less time."""
    if outcome.way is not Way.TIMED_OUT:
        return ""
    return f"# Each smaller scene took more than {SHARE * there.plan.limits.seconds:g} s of the processor.\n"


def _smaller(plan: Plan, crew: Crew, calls: Calls, index: int, outcome: Outcome) -> str:
    """TOML of the smallest scene with the same kind of outcome; a scene out of time is shrunk with less time."""
    limits, patience = plan.limits, crew.patience
    if outcome.way is Way.TIMED_OUT:
        limits = replace(limits, seconds=SHARE * limits.seconds)
        patience = replace(patience, seconds=min(patience.seconds, HASTE))

    def alike(data: Plain) -> bool:
        if outcome.way is not Way.REFUSED:
            try:
                scene_from(data)
            except SceneError:
                return False
        end = calls.end_of(partial(judged_data, solvers=crew.solvers, effort=plan.effort), data, limits)
        return _outcome(outcome.name, end).kind == outcome.kind

    return toml_of(shrunk(crew.draw(plan.seed, index).data, alike, patience))
