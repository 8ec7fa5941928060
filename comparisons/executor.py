"""Processes beside this process: a pool of workers that share the work, and a process for a single call.

On Linux the workers of a pool are forked from this process, which has loaded all modules: several workers pay for the
imports once.  Elsewhere a fork may break libraries of the system, and a fork of a process with threads may copy a
locked lock; there every worker is a fresh Python.  A single call always has a fresh Python.

Every process ends with the process that asked for the work, also where that process was killed.

Python counts the objects that a pool passes over by semaphores, which on Linux are files in ``/dev/shm``; in a
container this folder may be absent or read-only.  A single call needs no semaphore.
"""

from __future__ import annotations

import gc
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import ParamSpec, TypeVar

from comparisons import logs

T = TypeVar("T")
P = ParamSpec("P")

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
"""Environment for linear algebra on one thread; a library reads the variables when the library is loaded."""

COLLECTED = (50_000, 20, 100)
"""Thresholds of a worker's garbage collector: new objects, and collections of the younger generations."""


_THREADS = Path("/proc/self/task")
"""On Linux a folder with an entry for every thread of this process."""


class NoWorkersError(RuntimeError):
    """The system permits no worker processes; the text states the reason and a remedy."""


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


def call_fresh(call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Value of a call in a fresh Python; an exception of the call is raised here.

    Function, arguments and value are pickled.  An interrupt of this process ends the call.

    Raises:
        WorkerDiedError: the process ended by force.
    """
    context = get_context("spawn")
    reading, writing = context.Pipe(duplex=False)
    process = context.Process(target=_send_value, args=(writing, call, arguments, named), daemon=True)
    with interrupts_ignored():
        process.start()
    writing.close()
    try:
        value, error = reading.recv()
    except EOFError:
        process.join()
        raise WorkerDiedError(f"a process ended with {process.exitcode}") from None
    finally:
        process.kill()
        process.join()
        reading.close()
    if error is not None:
        raise error
    found: T = value
    return found


def _send_value(
    writing: Connection, call: Callable[..., object], arguments: tuple[object, ...], named: dict[str, object]
) -> None:
    """Call a function and send its value or its exception."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        result: tuple[object, Exception | None] = (call(*arguments, **named), None)
    except Exception as error:
        result = (None, error)
    writing.send(result)


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


def _follow(lifeline: Connection) -> None:
    """End this process as soon as the other end of ``lifeline`` closes; only the asking process owns the other end."""

    def end_with() -> None:
        wait([lifeline])
        os._exit(1)

    threading.Thread(target=end_with, daemon=True).start()
