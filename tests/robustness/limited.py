"""Calls in child processes with limits of processor time, clock time and memory; a crash ends the child alone.

A child is a fresh Python (:func:`comparisons.executor.call_limited`) with a preparation before the first call:
the time of loading counts in no call.  The child keeps loaded modules and kernels from call to call.
"""

from __future__ import annotations

import math
import os
import resource
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from traceback import extract_tb
from typing import Generic, TypeVar

from comparisons.executor import TimeLimitError, WorkerDiedError, call_limited, threads
from comparisons.threads import ONE_THREAD

A = TypeVar("A")
R = TypeVar("R")

PREPARED: list[bool] = []
"""Not empty in a prepared child."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of a call.

    Attributes:
        seconds: processor time, s, rounded up to a whole second.
        waiting: clock time over processor time: other work on the machine slows a call down.
        memory: address space, bytes.
    """

    seconds: float = 60.0
    waiting: float = 10.0
    memory: int = 4 * 2**30


@dataclass(frozen=True, slots=True)
class Returned(Generic[R]):
    """The value of a call."""

    value: R


@dataclass(frozen=True, slots=True)
class Crashed:
    """A call with an unexpected exception or the end of its process; ``sentence`` describes the end."""

    sentence: str


@dataclass(frozen=True, slots=True)
class OutOfTime:
    """A call that reached a limit of time."""

    sentence: str


End = Returned[R] | Crashed | OutOfTime


@dataclass(frozen=True, slots=True)
class Calls:
    """Threads with a child each.

    Attributes:
        pool: the threads.
        prepare: called once in each child.
    """

    pool: Executor
    prepare: Callable[[], None]

    def each(self, call: Callable[[A], R], arguments: Iterable[A], limits: Limits) -> Iterator[tuple[A, End[R]]]:
        """Every argument with the end of its call, in the order of the ends; function and value can be pickled."""
        futures = {self.pool.submit(self.end_of, call, argument, limits): argument for argument in arguments}
        for future in as_completed(futures):
            yield futures[future], future.result()

    def end_of(self, call: Callable[[A], R], argument: A, limits: Limits) -> End[R]:
        """The end of a call in the child of this thread."""
        clock = limits.waiting * limits.seconds
        try:
            call_limited(None, _prepare, self.prepare)
            return call_limited(clock, _within, call, argument, limits)
        except TimeLimitError:
            return OutOfTime(f"no end was reached in {clock:g} seconds of the clock")
        except WorkerDiedError as error:
            if f"-{int(signal.SIGXCPU)}" in str(error):
                return OutOfTime(f"no end was reached in {limits.seconds:g} seconds of the processor")
            return Crashed(str(error))


@contextmanager
def calls_of(count: int, prepare: Callable[[], None]) -> Iterator[Calls]:
    """Calls in ``count`` children with linear algebra on one thread; the children end with the context."""
    os.environ.update(ONE_THREAD)  # the children take the variables over
    with threads(count) as pool:
        yield Calls(pool, prepare)


def _prepare(prepare: Callable[[], None]) -> None:
    """Prepare this child once; the output of the child is dropped."""
    if PREPARED:
        return
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    prepare()
    PREPARED.append(True)


def _within(call: Callable[[A], R], argument: A, limits: Limits) -> Returned[R] | Crashed:
    """The value of a call within limits of this process, or the exception of the call in words."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    used = usage.ru_utime + usage.ru_stime
    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(used + limits.seconds), resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_AS, (limits.memory, resource.RLIM_INFINITY))
    try:
        return Returned(call(argument))
    except MemoryError:
        return Crashed(f"a call asked for more than {limits.memory / 2**30:g} GiB of memory")
    except Exception as error:
        place = extract_tb(error.__traceback__)[-1]
        file = "/".join(place.filename.replace(os.sep, "/").split("/")[-2:])
        return Crashed(f"{type(error).__name__}: {error} ({file}:{place.lineno} in {place.name})")
