"""The solves of a comparison, in worker processes or in this process."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from comparisons.choices import Choices
from comparisons.executor import NoWorkersError, interrupts_ignored, workers
from cprbm_scene import Answer, Mistake, Scene, SceneError

_LOG = logging.getLogger(__name__)

Solver = Callable[[Scene, Choices], Answer]
Job = tuple[Solver, Scene, Choices]
Decided = Callable[[Answer, Answer], bool]
"""Whether the answers to the first two jobs make the other jobs useless."""

_Pending = Future[Answer | tuple[Mistake, ...]]


@dataclass(frozen=True, slots=True)
class Crew:
    """Processes for the solves of one case after the other; without a pool all solves run in this process."""

    pool: ProcessPoolExecutor | None = None

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
            return lambda: _one_by_one(jobs, decided)
        # The finest runs take longest and stand last: begun right behind the first two jobs, they leave no worker idle.
        places = [*range(len(jobs))[:2], *reversed(range(len(jobs))[2:])]
        with interrupts_ignored():  # until the workers are prepared
            futures: dict[_Pending, int] = {self.pool.submit(_solve, *jobs[place]): place for place in places}
        return lambda: _awaited(futures, decided)


ALONE = Crew()


@contextmanager
def crew_of(count: int) -> Iterator[Crew]:
    """A crew of ``count`` worker processes, which end with the context; a crew of one worker is this process itself.

    Where the system permits no further process, this process does all the work.
    """
    with ExitStack() as stack:
        crew = ALONE
        if count > 1:
            try:
                crew = Crew(stack.enter_context(workers(count)))
            except NoWorkersError as error:
                _LOG.info("one process does all of the work: %s", error)
        yield crew


def _one_by_one(jobs: Sequence[Job], decided: Decided) -> list[Answer]:
    """The answers, in this process."""
    answers: list[Answer] = []
    for solver, scene, choices in jobs:
        answers.append(solver(scene, choices))
        _report(answers[-1], len(answers), len(jobs))
        if len(answers) == 2 and decided(*answers):
            break
    return answers


def _awaited(futures: Mapping[_Pending, int], decided: Decided) -> list[Answer]:
    """The answers in the order of the places; the first refusal cancels the other jobs."""
    answers: dict[int, Answer] = {}
    try:
        for future in as_completed(futures):
            result = future.result()
            if isinstance(result, tuple):
                raise SceneError(result)
            answers[futures[future]] = result
            _report(result, len(answers), len(futures))
            if futures[future] < 2 and {0, 1} <= answers.keys() and decided(answers[0], answers[1]):
                return [answers[0], answers[1]]
    finally:
        for future in futures:
            future.cancel()
    return [answers[place] for place in range(len(futures))]


def _report(answer: Answer, done: int, whole: int) -> None:
    """Log the end of a run, with the number of finished runs, of ``whole``."""
    report = answer.scene, done, whole, answer.solver, answer.ending.name, answer.seconds
    _LOG.info("%s: run %d of %d is done: %s, %s after %.2f s", *report, extra={"done": done, "whole": whole})


def _solve(solver: Solver, scene: Scene, choices: Choices) -> Answer | tuple[Mistake, ...]:
    """The answer, or the mistakes as plain records, since pickle rebuilds an exception from the text alone."""
    try:
        return solver(scene, choices)
    except SceneError as error:
        return error.mistakes
