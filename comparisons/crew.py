"""The solves of a comparison, in worker processes or in this process."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, Future, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import starmap

from comparisons.choices import Choices
from comparisons.executor import call_limited, workers
from cprbm_scene import Answer, Mistake, Scene, SceneError

_LOG = logging.getLogger(__name__)

Solver = Callable[[Scene, Choices], Answer]
Job = tuple[Solver, Scene, Choices]
Decided = Callable[[Answer, Answer], bool]
"""Whether the answers to the first two jobs make the other jobs useless."""

_Result = Answer | tuple[Mistake, ...]


@dataclass(frozen=True, slots=True)
class Crew:
    """Processes for the solves of one case after the other; without a pool all solves run in this process."""

    pool: Executor | None = None

    def answers(self, jobs: list[Job]) -> list[Answer]:
        """The answers to jobs, in the order of the jobs.

        Raises:
            SceneError: a solver refuses a job.
        """
        return self.begin(jobs)()

    def begin(self, jobs: list[Job], decided: Decided = lambda *first: False) -> Callable[[], list[Answer]]:
        """A function that waits for the answers to jobs, which the processes begin with now, behind earlier jobs.

        The function returns and raises as :meth:`answers`.  Where the answers to the first two jobs are ``decided``, it
        returns these two alone, and cancels the other jobs.  Without a pool the work begins with the call.
        """
        if self.pool is None:
            return lambda: _collected(enumerate(starmap(_solve, jobs)), len(jobs), decided)
        # The finest runs take longest and stand last: begun right behind the first two jobs, they leave no worker idle.
        places = [*range(len(jobs))[:2], *reversed(range(len(jobs))[2:])]
        futures = {self.pool.submit(call_limited, None, _solve, *jobs[place]): place for place in places}
        return lambda: _awaited(futures, decided)


ALONE = Crew()


@contextmanager
def crew_of(count: int) -> Iterator[Crew]:
    """A crew of ``count`` processes, which end with the context; with a ``count`` of 1 this process works alone."""
    if count == 1:
        yield ALONE
        return
    with workers(count) as pool:
        yield Crew(pool)


def _awaited(futures: Mapping[Future[_Result], int], decided: Decided) -> list[Answer]:
    """The answers of processes; the first refusal, and a decision, cancel the other jobs."""
    try:
        return _collected(((futures[each], each.result()) for each in as_completed(futures)), len(futures), decided)
    finally:
        for future in futures:
            future.cancel()


def _collected(results: Iterable[tuple[int, _Result]], count: int, decided: Decided) -> list[Answer]:
    """The answers in the order of their places, logged as they come."""
    answers: dict[int, Answer] = {}
    for place, result in results:
        if isinstance(result, tuple):
            raise SceneError(result)
        answers[place] = result
        done = {"done": len(answers), "whole": count}
        report = result.scene, *done.values(), result.solver, result.ending.name, result.seconds
        _LOG.info("%s: run %d of %d is done: %s, %s after %.2f s", *report, extra=done)
        if place < 2 and {0, 1} <= answers.keys() and decided(answers[0], answers[1]):
            return [answers[0], answers[1]]
    return [answers[place] for place in range(count)]


def _solve(solver: Solver, scene: Scene, choices: Choices) -> _Result:
    """The answer, or the mistakes as plain records, since pickle rebuilds an exception from the text alone."""
    try:
        return solver(scene, choices)
    except SceneError as error:
        return error.mistakes
