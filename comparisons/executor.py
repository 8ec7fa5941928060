"""Processes beside this process: a pool of workers that share the work, and a child that answers call by call.

On Linux the workers of a pool are forked from this process, which has loaded all modules: several workers pay for the
imports once.  Elsewhere a fork may break libraries of the system, and a fork of a process with threads may copy a
locked lock; there every worker is a fresh Python.  A child is always a fresh Python.

Every process ends with the process that asked for the work, also where that process was killed.

Python counts the objects that a pool passes over by semaphores, which on Linux are files in ``/dev/shm``; in a
container this folder may be absent or read-only.  A child needs no semaphore.
"""

from __future__ import annotations

import gc
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import current_process, get_context, parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import ParamSpec, TypeVar
from weakref import WeakSet

from comparisons import logs

T = TypeVar("T")
P = ParamSpec("P")

COLLECTED = (50_000, 20, 100)
"""Thresholds of a worker's garbage collector: new objects, and collections of the younger generations."""


_THREADS = Path("/proc/self/task")
"""On Linux a folder with an entry for every thread of this process."""


class NoWorkersError(RuntimeError):
    """The system permits no worker processes; the text states the reason and a remedy."""


class TimeLimitError(RuntimeError):
    """A call was ended at its time limit."""


class WorkerDiedError(RuntimeError):
    """A process ended without the value or the exception of its call."""


@contextmanager
def workers(count: int) -> Iterator[ProcessPoolExecutor]:
    """Pool of ``count`` processes that end with the context, whatever they still solve.

    Raises:
        NoWorkersError: the system has no semaphores.
    """
    forks = len(list(_THREADS.glob("*"))) == 1
    context = get_context("fork") if forks else get_context("spawn")
    reading, lifeline = context.Pipe(duplex=False)
    given = reading, lifeline if forks else None, logs.level()
    try:
        pool = ProcessPoolExecutor(count, mp_context=context, initializer=_prepare_worker, initargs=given)
    except (OSError, NotImplementedError, ImportError) as error:
        raise NoWorkersError(
            f"no processes beside this one ({error}); on Linux they need a writable /dev/shm"
        ) from None
    try:
        yield pool
    finally:
        lifeline.close()  # the workers end
        pool.shutdown(cancel_futures=True)
        reading.close()


def obstacle() -> str:
    """Why the system permits no worker processes; empty if the system permits workers."""
    try:
        with workers(1):
            return ""
    except NoWorkersError as error:
        return str(error)


class Child:
    """A fresh Python that answers call by call; a child that died or took too long is replaced at the next call."""

    def __init__(self) -> None:
        self._start()
        _children.add(self)

    def _start(self) -> None:
        context = get_context("spawn")
        self._line, line = context.Pipe()
        self._process = context.Process(target=_serve, args=(line,), daemon=True)
        with interrupts_ignored():
            self._process.start()
        line.close()

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
        if self._line.closed:
            self._start()
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
        found: T = value
        return found

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

    Raises:
        TimeLimitError: the call took more than ``seconds``.
        WorkerDiedError: the child ended by force, or all children were ended.
    """
    if not hasattr(_local, "child"):
        _local.child = Child()
    if _ended.is_set():
        raise WorkerDiedError("the calls of this process were ended")
    child: Child = _local.child
    return child.call(seconds, call, *arguments, **named)


@contextmanager
def threads(count: int) -> Iterator[ThreadPoolExecutor]:
    """Pool of ``count`` threads for :func:`call_limited`, whose children end with the context."""
    pool = ThreadPoolExecutor(count)
    try:
        yield pool
    finally:
        _ended.set()
        for child in list(_children):
            child.kill()
        pool.shutdown(cancel_futures=True)
        _ended.clear()


def call_fresh(call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Value of a call in a fresh Python, as :meth:`Child.call` without a time limit.

    Raises:
        WorkerDiedError: the process ended by force.
    """
    child = Child()
    try:
        return child.call(None, call, *arguments, **named)
    finally:
        child.close()


def _serve(line: Connection) -> None:
    """Answer calls until the line closes."""
    parent = parent_process()
    assert parent is not None, "this process was started by another process"
    _follow(parent.sentinel)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    with suppress(EOFError):
        while True:
            function, arguments, named = line.recv()
            try:
                result: tuple[object, Exception | None] = (function(*arguments, **named), None)
            except Exception as error:
                result = (None, error)
            line.send(result)


@contextmanager
def interrupts_ignored() -> Iterator[None]:
    """Context in which new processes ignore interrupts until they state otherwise.

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


def _prepare_worker(reading: Connection, lifeline: Connection | None, level: int) -> None:
    """Prepare a worker: signals end it without a message, log records from ``level`` on reach standard error.

    The garbage collector runs less often and skips loaded modules: the records of a load path are many and make no
    cycles.
    """
    if lifeline is not None:  # a forked worker has a copy of the end that only the asking process may own
        lifeline.close()
    logs.print_from(level)
    gc.freeze()
    gc.set_threshold(*COLLECTED)
    for number in (signal.SIGINT, signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)):
        signal.signal(number, signal.SIG_DFL)
    _follow(reading)


def _follow(lifeline: Connection | int) -> None:
    """End this process as soon as the other end of ``lifeline`` closes; only the asking process owns the other end."""

    def end_with() -> None:
        wait([lifeline])
        os._exit(1)

    threading.Thread(target=end_with, daemon=True).start()
