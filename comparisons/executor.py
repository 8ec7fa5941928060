"""Processes beside this process: children that answer call by call, and threads that wait for the values.

A child of :func:`crew_of` is forked from this process on Linux, and takes over all loaded modules: several children pay
for the imports once.  Elsewhere a fork may break libraries of the system, and a fork of a process with threads may copy
a locked lock; there, and for all other calls, a child is a fresh Python.

Every child ends with the process that asked for the work, also where that process was killed.  A child needs no
semaphores, which on Linux are files in ``/dev/shm``; in a container this folder may be absent or read-only.
"""

import copyreg
import gc
import logging
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, ThreadPoolExecutor, as_completed
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from multiprocessing import current_process, get_context, parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Literal, ParamSpec, TypeVar, cast
from weakref import WeakSet

from comparisons import logs
from comparisons.choices import Choices
from cprbm_scene import Answer, Scene, SceneError

T = TypeVar("T")
P = ParamSpec("P")

COLLECTED = (50_000, 20, 100)
"""Thresholds of a child's garbage collector: new objects, and collections of the younger generations."""

_THREADS = Path("/proc/self/task")
"""On Linux a folder with an entry for every thread of this process."""

_LOG = logging.getLogger(__name__)

Solver = Callable[[Scene, Choices], Answer]

Job = tuple[Solver, Scene, Choices]

Decided = Callable[[Answer, Answer], bool]
"""Whether the answers to the first two jobs make the other jobs useless."""

# by itself pickle rebuilds an exception from the text alone
copyreg.pickle(SceneError, lambda error: (SceneError, (error.mistakes,)))


class TimeLimitError(RuntimeError):
    """A call was ended at its time limit."""


class WorkerDiedError(BrokenExecutor):
    """A process ended without the value or the exception of its call."""


class Child:
    """A process that answers call by call: a fresh Python (``spawn``), or a copy of this process (``fork``)."""

    def __init__(self, method: Literal["spawn", "fork"] = "spawn") -> None:
        context = get_context(method)
        self._line, line = context.Pipe()
        self._process = context.Process(target=_serve, args=(line, logs.level()), daemon=True)  # type: ignore[attr-defined]
        with _interrupts_ignored():
            self._process.start()
        line.close()
        _children.add(self)

    @property
    def closed(self) -> bool:
        """True if the child answers no further call."""
        return self._line.closed

    def call(self, seconds: float | None, function: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
        """Value of a call in the child; an exception of the call is raised here.

        Function, arguments and value are pickled.  An interrupt of this process ends the child.

        Args:
            seconds: time limit by the clock, s; None for no limit.
            function, arguments, named: the call.

        Raises:
            TimeLimitError: the time limit passed.
            WorkerDiedError: the child ended by force.
        """
        try:
            self._line.send((function, arguments, named))
            if seconds is not None and not self._line.poll(seconds):
                raise TimeLimitError(f"no result after {seconds:g} s")
            value, error = self._line.recv()
        except (EOFError, BrokenPipeError, ConnectionResetError):
            self.close()
            raise WorkerDiedError(f"a process ended with {self._process.exitcode}") from None
        except BaseException:
            self.kill()
            self.close()
            raise
        if error is not None:
            raise error
        return cast("T", value)

    def kill(self) -> None:
        """End the child by force; a running call raises :class:`WorkerDiedError`."""
        self._process.kill()

    def close(self) -> None:
        """End the child after its last call."""
        self._line.close()
        self._process.join()


_children: WeakSet[Child] = WeakSet()
_local = threading.local()
_ended = threading.Event()


def permit_children() -> None:
    """Permit children of this process, also where the process is a daemon, such as a worker of Dask.

    Python forbids children of daemons, since a daemon is ended without a chance to end its children.  A child of this
    module ends with its parent by itself.
    """
    vars(current_process())["_config"]["daemon"] = False


def call_limited(seconds: float | None, call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Value of a call in the child of this thread, which keeps its loaded modules and kernels from call to call.

    A child that died or took too long is replaced at the next call.

    Raises:
        TimeLimitError: the call took more than ``seconds``.
        WorkerDiedError: the child ended by force, or all children were ended.
    """
    child: Child | None = getattr(_local, "child", None)
    if child is None or child.closed:
        child = _local.child = Child()
    if _ended.is_set():
        raise WorkerDiedError("the calls of this process were ended")
    return child.call(seconds, call, *arguments, **named)


@contextmanager
def threads(count: int, children: list[Child] | None = None) -> Iterator[ThreadPoolExecutor]:
    """Pool of ``count`` threads for :func:`call_limited`, whose children end with the context.

    A thread takes the last of the ``children``, as long as there are any; other threads begin children of their own.
    """
    pool = ThreadPoolExecutor(count, initializer=_take_child, initargs=(children or [],))
    try:
        yield pool
    finally:
        _ended.set()
        for child in list(_children):
            child.kill()
        pool.shutdown(cancel_futures=True)
        _ended.clear()


def _take_child(children: list[Child]) -> None:
    """Take a child for this thread."""
    with suppress(IndexError):
        _local.child = children.pop()


def call_fresh(call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Value of a call in a fresh Python, as :meth:`Child.call` without a time limit.

    Raises:
        WorkerDiedError: the process ended by force.
    """
    with closing(Child()) as child:
        return child.call(None, call, *arguments, **named)


def _serve(line: Connection, level: int) -> None:
    """Answer calls until the line closes; log records from ``level`` on reach standard error.

    An interrupt of all processes ends the asking process, and thereby the children; the other signals end this process
    without a message.  The garbage collector runs less often and skips loaded modules: the records of a load path are
    many and make no cycles.
    """
    parent = parent_process()
    assert parent is not None, "this process was started by another process"
    threading.Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()
    logs.print_from(level)
    gc.freeze()
    gc.set_threshold(*COLLECTED)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for number in (signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)):
        signal.signal(number, signal.SIG_DFL)
    with suppress(EOFError):
        while True:
            function, arguments, named = line.recv()
            try:
                result: tuple[object, Exception | None] = (function(*arguments, **named), None)
            except Exception as error:
                result = (None, error)
            line.send(result)


def _end_with(process: int) -> None:
    """End this process as soon as the ``process`` of a sentinel ends."""
    wait([process])
    os._exit(1)


@contextmanager
def _interrupts_ignored() -> Iterator[None]:
    """Context in which new processes ignore interrupts from the beginning.

    A process takes over that an interrupt is ignored.  An interrupt during the imports of a process would print a
    traceback.
    """
    if threading.current_thread() is not threading.main_thread():  # only the main thread may set handlers
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@dataclass(frozen=True, slots=True)
class Crew:
    """Processes for the solves of one case after the other; without a pool all solves run in this process."""

    pool: Executor | None = None

    def begin(self, call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> Callable[[], T]:
        """A function for the value of a call, which begins at once in the pool; without a pool, with the function."""
        now = partial(call, *arguments, **named)
        return now if self.pool is None else self.pool.submit(call_limited, None, now).result

    def answers(self, jobs: list[Job], decided: Decided = lambda *first: False) -> list[Answer]:
        """The answers to jobs, in the order of the jobs.

        Where the answers to the first two jobs are ``decided``, the answers are these two alone, and the other jobs are
        cancelled.

        Raises:
            SceneError: a solver refuses a job, which cancels the other jobs.
        """
        if self.pool is None:
            return _collected(enumerate(solver(scene, choices) for solver, scene, choices in jobs), len(jobs), decided)
        # The finest runs take longest and stand last: begun right behind the first two jobs, they leave no worker idle.
        numbered = [*enumerate(jobs)]
        futures = {
            self.pool.submit(call_limited, None, solver, scene, choices): place
            for place, (solver, scene, choices) in (*numbered[:2], *reversed(numbered[2:]))
        }
        try:
            return _collected(((futures[each], each.result()) for each in as_completed(futures)), len(jobs), decided)
        finally:
            for future in futures:
                future.cancel()


ALONE = Crew()


@contextmanager
def crew_of(count: int) -> Iterator[Crew]:
    """A crew of ``count`` processes, which end with the context; with a ``count`` of 1 this process works alone.

    The processes have the modules of this process, where the system permits forks.
    """
    if count == 1:
        yield ALONE
        return
    method: Literal["fork", "spawn"] = "fork" if len(list(_THREADS.glob("*"))) == 1 else "spawn"
    with threads(count, [Child(method) for _ in range(count)]) as pool:
        yield Crew(pool)


def _collected(results: Iterable[tuple[int, Answer]], count: int, decided: Decided) -> list[Answer]:
    """The answers in the order of their places, logged as they come."""
    answers: dict[int, Answer] = {}
    for place, answer in results:
        answers[place] = answer
        _LOG.info(
            "%s: run %d of %d is done: %s, %s after %.2f s",
            *(answer.scene, len(answers), count, answer.solver, answer.ending.name, answer.seconds),
            extra={"done": len(answers), "whole": count},
        )
        if place < 2 and {0, 1} <= answers.keys() and decided(answers[0], answers[1]):
            return [answers[0], answers[1]]
    return [answers[place] for place in range(count)]
