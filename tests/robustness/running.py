"""A run of random scenes, drawn and judged in hosts, outcomes kept at once, and what fails shrunk and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

from comparisons.pairing import Solvers
from comparisons.plain import Plain
from comparisons.writing import write
from cprbm_scene import Scene, SceneError, scene_from
from tests.robustness.apart import Crashed, End, Limits, OutOfTime, Returned, apart
from tests.robustness.drawing import Drawn, drawn
from tests.robustness.hosts import Hosts, hosts_of
from tests.robustness.judging import Effort, judged
from tests.robustness.kept import Kept, digest
from tests.robustness.outcomes import Outcome, Way
from tests.robustness.shrinking import Patience, shrunk
from tests.robustness.strata import stated
from tests.robustness.toml import toml_of

FAILURES = (Way.WRONG, Way.CRASHED, Way.TIMED_OUT)
"""The ways that are always a fault of ours."""

SHARE = 0.1
"""Of the time that a scene did not end in: a smaller one that takes longer is taken for one that does not either."""

HASTE = 30.0
"""Seconds of the clock in which such a scene is shrunk: every smaller one that is alike takes all of its time."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is to be found out of each scene, and with what.

    Attributes:
        seed: of the scenes.
        effort: for each.
        limits: of each.
    """

    seed: int
    effort: Effort = field(default_factory=Effort)
    limits: Limits = field(default_factory=Limits)


@dataclass(frozen=True, slots=True)
class Crew:
    """Who works on it.

    Attributes:
        solvers: who answers.
        hosts: how many processes.
        draw: the scene of a seed and an index.
        patience: with which what fails is shrunk.
    """

    solvers: Solvers
    hosts: int
    draw: Callable[[int, int], Drawn] = drawn
    patience: Patience = field(default_factory=Patience)


@dataclass(frozen=True, slots=True)
class Stress:
    """What is there of a run.

    Attributes:
        plan: what was asked.
        outcomes: by the index of the scene, ascending.
        saved: the files, below the run's folder, that replay what failed, likewise.
        before: how many outcomes had been kept before.
    """

    plan: Plan
    outcomes: Mapping[int, Outcome]
    saved: Mapping[int, str]
    before: int = 0


def run(plan: Plan, scenes: int, folder: Path, also: Sequence[Way], crew: Crew) -> Iterator[Stress]:
    """Judge the first scenes of a seed, except those whose outcomes are kept, and save what fails.

    Args:
        plan: what is to be found out.
        scenes: how many.
        folder: where outcomes and scenes that fail go; it is there.
        also: ways of ending that count as failures, beside those that always do.
        crew: who does it.

    Yields:
        What is there: first of all what was kept, and then after each scene that was judged or saved.

    Raises:
        OSError: the folder cannot be written to.
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
    with hosts_of(crew.hosts, partial(prepared, crew.solvers), plan.limits) as hosts:
        for now in _judged(there, left, kept, hosts, crew):
            there = now
            yield there
        yield from _shrunk(there, failing, folder, kept, hosts, crew)


def prepared(solvers: Solvers) -> None:
    """Load what the solvers need, by a scene that both of them know well."""
    from comparisons.cases import opened

    judged(opened("tapered"), solvers, Effort(sizes=1))


def _judged(there: Stress, left: Sequence[int], kept: Kept, hosts: Hosts[int, Outcome], crew: Crew) -> Iterator[Stress]:
    def with_outcome(index: int, outcome: Outcome) -> Stress:
        kept.ended(index, outcome)
        return replace(there, outcomes=dict(sorted({**there.outcomes, index: outcome}.items())))

    nameless = []
    for index, end in hosts.each(partial(_drawn_and_judged, there.plan, crew), left):
        if not isinstance(end, Returned):  # nobody was left to say what scene it was
            nameless.append(index)
        there = with_outcome(index, _outcome(f"scene-{index}", end))
        yield there
    for index, end in hosts.each(partial(_named, there, crew.draw), sorted(nameless)):
        if isinstance(end, Returned):
            there = with_outcome(index, end.value)
            yield there


def _shrunk(
    there: Stress, failing: Sequence[Way], folder: Path, kept: Kept, hosts: Hosts[int, str], crew: Crew
) -> Iterator[Stress]:
    todo = [index for index, each in there.outcomes.items() if each.way in failing and index not in there.saved]
    call = partial(_smaller, there.plan, crew, {index: there.outcomes[index] for index in todo})
    for index, end in hosts.each(call, sorted(todo)):
        if isinstance(end, Returned):
            outcome = there.outcomes[index]
            file = f"{outcome.name}.toml"
            write(folder / file, f"# {outcome.way.words}: {outcome.sentence}\n{_less(there, outcome)}\n{end.value}")
            kept.saved(index, file)
            there = replace(there, saved=dict(sorted({**there.saved, index: file}.items())))
            yield there


def judged_data(data: Plain, solvers: Solvers, effort: Effort) -> Outcome:
    """How a scene ends that is given as plain data."""
    try:
        scene = scene_from(data)
    except SceneError as error:
        return Outcome(str(data.get("name", "")), Way.REFUSED, "; ".join(map(str, error.mistakes)))
    return judged(scene, solvers, effort)


def replayed(scene: Scene, solvers: Solvers, plan: Plan) -> Outcome:
    """How a scene ends, in a process of its own."""
    with hosts_of(1, partial(prepared, solvers), plan.limits) as hosts:
        ((_, end),) = hosts.each(partial(judged, solvers=solvers, effort=plan.effort), [scene])
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


def _named(there: Stress, draw: Callable[[int, int], Drawn], index: int) -> Outcome:
    """The outcome of a scene that ended by force, with its name and what it states."""
    found = draw(there.plan.seed, index)
    features = tuple(sorted(stated(scene_from(found.data))))
    return replace(there.outcomes[index], name=found.name, stated=features)


def _less(there: Stress, outcome: Outcome) -> str:
    """What a file says of a scene that was shrunk in less time than it was judged in."""
    if outcome.way is not Way.TIMED_OUT:
        return ""
    return f"# Made smaller for as long as it took more than {SHARE * there.plan.limits.seconds:g} of them.\n"


def _smaller(plan: Plan, crew: Crew, outcomes: dict[int, Outcome], index: int) -> str:
    """The TOML of the smallest scene that ends as the one of an index did; if that was out of time, in less of it."""
    outcome = outcomes[index]
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
        end = apart(partial(judged_data, solvers=crew.solvers, effort=plan.effort), data, limits)
        return _outcome(outcome.name, end).kind == outcome.kind

    return toml_of(shrunk(crew.draw(plan.seed, index).data, alike, patience))
