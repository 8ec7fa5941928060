"""A sweep: points, keys, known outcomes, and the solves of unknown points by an executor."""

import logging
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass, field, replace
from pathlib import Path
from threading import Lock

from comparisons.choices import Choices, check_counts
from comparisons.pairing import Solvers
from comparisons.store import digest, relevant
from comparisons.sweeps.outcome import Asked, Outcome, crashed, outcome_of, solve_limited
from comparisons.sweeps.points import Axis, Point
from comparisons.sweeps.workers import Workers
from comparisons.writing import append_line, whole_lines
from cprbm_scene import Mistake, Scene, SceneError, frozendict

_LOG = logging.getLogger(__name__)

JOURNAL = "outcomes.jsonl"
"""File of all outcomes: a line per solved point, written by the asking process alone."""


@dataclass(frozen=True, slots=True)
class Task:
    """A point of a sweep: its number from 1, values, scene, solver and key, and the key of a comparison."""

    number: int
    point: Point
    scene: Scene
    asked: Asked
    key: str
    compared: str

    def known(self, outcomes: Mapping[str, Outcome]) -> "Task":
        """The task, or the comparison of the point where known ``outcomes`` have the comparison alone."""
        found = outcomes.get(self.compared)
        if self.asked != "cprbm" or self.key in outcomes or found is None or not found.completed:
            return self
        return replace(self, asked="compare", key=self.compared)


@dataclass(frozen=True, slots=True)
class Sweep:
    """A sweep with its outcomes.

    Attributes:
        scene: with the values of its file.
        axes: the varied parameters; all have numbers of values in a grid.
        tasks: the points in order.
        outcomes: by key; a point that was not solved has none.
    """

    scene: Scene
    axes: tuple[Axis, ...]
    tasks: tuple[Task, ...]
    outcomes: Mapping[str, Outcome] = frozendict()

    def points(self) -> Iterator[tuple[Task, Outcome]]:
        """Solved points in order."""
        return ((task, self.outcomes[task.key]) for task in self.tasks if task.key in self.outcomes)

    def solved(self) -> list[tuple[Task, Outcome]]:
        """Points with numbers, in order."""
        return [(task, outcome) for task, outcome in self.points() if outcome.numbers_with_values]

    @property
    def headline(self) -> str:
        """Words of the checked points and the number of unchecked points, and the failures."""
        outcomes = [outcome for _, outcome in self.points()]
        checked = [outcome.verdict for outcome in outcomes if outcome.solver == "compare"]
        words = sorted(set(checked), key=lambda word: (word != "AGREE", word))
        text = ", ".join(f"{word or 'no verdict'} at {checked.count(word)}" for word in words)
        others = len(outcomes) - len(checked)
        text = (
            f"{text} of {len(checked)} checked points, {others} unchecked" if checked else f"{others} points, unchecked"
        )
        failed = [outcome.ending for outcome in outcomes if not outcome.completed]
        endings = ", ".join(f"{failed.count(name)} {name}" for name in sorted(set(failed)))
        text += f"; {len(failed)} of {len(outcomes)} points failed ({endings})" if failed else ""
        left = len(self.tasks) - len(outcomes)
        return f"{text}; {left} not solved" if left else text


def tasks_of(
    scene: Scene,
    points: Sequence[Point],
    asked: Asked,
    checked: frozenset[int],
    choices: Choices,
    shard: tuple[int, int] = (1, 1),
) -> tuple[Task, ...]:
    """Points with scenes and keys.

    Args:
        scene: the question.
        points: values of parameters, SI.
        asked: solver of the points.
        checked: places of points that are compared.
        choices: how finely, and by which variants.
        shard: i and n, for the points i, i + n, ...

    Raises:
        SceneError: the scene at a point is invalid.
    """
    check_counts(choices, scene)
    found, refused = [], []
    for place in range(shard[0] - 1, len(points), shard[1]):
        point = points[place]
        try:
            own = scene.with_parameters(**point)
        except SceneError as error:
            refused.append((point, error.mistakes[0]))
            continue
        solver: Asked = "compare" if place in checked else asked
        text = own.model_dump_json(exclude={"file"})
        key, compared = _key(solver, text, choices), _key("compare", text, choices)
        found.append(Task(place + 1, point, own, solver, key, compared))
    if refused:
        point, mistake = refused[0]
        values = ", ".join(f"{name} = {value:g}" for name, value in point.items())
        count = f"{len(refused)} of {len(points)} points without a valid scene"
        text = f"{count}, the first at {values} (SI): {mistake.found}"
        raise SceneError([Mistake(mistake.key, text, mistake.allowed, mistake.file)])
    return tuple(found)


def _key(asked: Asked, scene: str, choices: Choices) -> str:
    names = ("cprbm", "fea") if asked == "compare" else (asked,)
    return digest("sweep", asked, scene, *(repr(relevant(name, choices)) for name in names))


def known_outcomes(folders: Sequence[Path]) -> dict[str, Outcome]:
    """Outcomes in the journals of ``folders`` by key; a line that a kill cut short is dropped.

    Raises:
        OSError: a journal cannot be read.
    """
    outcomes: dict[str, Outcome] = {}
    for path in (folder / JOURNAL for folder in folders):
        for number, line in enumerate(whole_lines(path), start=1):
            try:
                key, outcome = outcome_of(line)
            except (ValueError, KeyError, TypeError) as error:
                _LOG.warning("line %d of %s is damaged (%s); the point is solved again", number, path, error)
            else:
                outcomes[key] = outcome
    return outcomes


@dataclass(frozen=True, slots=True)
class Runner:
    """Solver of the points of a sweep.

    Attributes:
        workers: solve the points.
        choices: how finely, and by which variants.
        solvers: the functions that answer.
        limit: time limit per solve, s.
        out: folder of the journal; None for no journal.
        moved: called with the number of known outcomes.
        known: outcomes by key; lock: of the known outcomes and the journal, since several threads may ask for points.
    """

    workers: Workers
    choices: Choices
    solvers: Solvers
    limit: float
    out: Path | None = None
    moved: Callable[[int], None] = lambda done: None
    known: dict[str, Outcome] = field(default_factory=dict)
    lock: Lock = field(default_factory=Lock)

    def run(self, sweep: Sweep, merged: Sequence[Path] = ()) -> Sweep:
        """The sweep with outcomes of all points, as far as possible from the journals.

        Args:
            sweep: points.
            merged: folders with further journals.

        Raises:
            OSError: a journal cannot be read or written.
        """
        every = known_outcomes(merged if self.out is None else (self.out, *merged))
        if self.out is not None and (self.out / JOURNAL).is_symlink():  # outcomes belong into the folder
            (self.out / JOURNAL).unlink()
        tasks = tuple(task.known(every) for task in sweep.tasks)
        self.known.update((task.key, every[task.key]) for task in tasks if task.key in every)
        return replace(sweep, tasks=tasks, outcomes=self.outcomes(tasks))

    def outcomes(self, tasks: Sequence[Task]) -> dict[str, Outcome]:
        """Outcomes of points by key; each new outcome is written into the journal at once.

        A point that crashed is solved again, and a point that took too long if the time limit is larger.

        Raises:
            OSError: the journal cannot be written.
        """
        wanted = {task.key: task for task in tasks}
        self.moved(len(self.known))
        for task, outcome in self._solved([task for task in wanted.values() if self._is_open(task)]):
            with self.lock:
                self.known[task.key] = outcome
                if self.out is not None:
                    append_line(self.out / JOURNAL, outcome.line(task.key))
                self.moved(len(self.known))
        return {key: self.known[key] for key in wanted}

    def _is_open(self, task: Task) -> bool:
        """Whether a point is unknown, or is solved again."""
        found = self.known.get(task.key)
        late = found is not None and found.ending == "TIME_LIMIT" and self.limit > found.limit
        return found is None or found.ending == "CRASHED" or late

    def _solved(self, tasks: Sequence[Task]) -> Iterator[tuple[Task, Outcome]]:
        """Points with outcomes in the order of their ends.

        A point whose workers died is solved once more, last and alone.
        """
        queue, suspects = deque(tasks), deque[Task]()
        pending: dict[Future[Outcome], Task] = {}

        def submit(task: Task) -> None:
            future = self.workers.submit(solve_limited, task.scene, self.choices, task.asked, self.solvers, self.limit)
            pending[future] = task

        try:
            while queue or pending or suspects:
                for _ in range(min(self.workers.window() - len(pending), len(queue))):
                    submit(queue.popleft())
                alone = not pending
                if alone:
                    submit(suspects.popleft())
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    task = pending.pop(future)
                    try:
                        yield task, future.result()
                    except self.workers.lost as error:
                        if alone:
                            yield task, crashed(task.asked, f"the workers died: {error}")
                        else:  # an other point of the same worker may be the reason
                            suspects.append(task)
        finally:
            for future in pending:
                future.cancel()
