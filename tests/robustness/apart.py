"""A call in a process of its own, which may crash or hang and takes nothing else along.

The process is forked from this one, so that all that is loaded here is loaded there at no cost.  It has so many
seconds of the processor, more of the clock, and so much memory; what it prints is dropped.
"""

from __future__ import annotations

import contextlib
import math
import os
import resource
import signal
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait
from typing import Generic, NoReturn, TypeVar

A = TypeVar("A")
R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class Limits:
    """What a call may take.

    Attributes:
        seconds: of the processor; whole ones count.
        waiting: seconds of the clock for each of the processor: other work on the machine is no reason to be out of
            time, and waiting for ever is one.
        memory: bytes of address space.
    """

    seconds: float = 60.0
    waiting: float = 10.0
    memory: int = 4 * 2**30


@dataclass(frozen=True, slots=True)
class Returned(Generic[R]):
    """The call returned a value."""

    value: R


@dataclass(frozen=True, slots=True)
class Crashed:
    """The call raised what nobody expected, or its process ended by force; ``sentence`` says how."""

    sentence: str


@dataclass(frozen=True, slots=True)
class OutOfTime:
    """The call was ended after its seconds."""

    sentence: str


End = Returned[R] | Crashed | OutOfTime


def apart(call: Callable[[A], R], argument: A, limits: Limits, gone: Connection | None = None) -> End[R]:
    """Call a function in a process of its own.

    Args:
        call: the function; what it returns must be one that can be pickled.
        argument: its argument.
        limits: what it may take.
        gone: has something to read, or is closed, when nobody wants the value any more.

    Raises:
        EOFError: nobody wants the value; the process has been ended.
    """
    reading, writing = Pipe(duplex=False)
    child = os.fork()
    if child == 0:
        reading.close()
        if gone is not None:
            gone.close()
        _alone(call, argument, limits, writing)
    writing.close()
    try:
        if gone is not None and gone in wait([reading, gone]):
            raise EOFError
        try:
            end: End[R] = reading.recv()
        except EOFError:
            _, status = os.waitpid(child, 0)
            return _ended(os.waitstatus_to_exitcode(status), limits)
        os.waitpid(child, 0)
        return end
    except BaseException:
        with contextlib.suppress(ProcessLookupError, ChildProcessError):
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        raise
    finally:
        reading.close()


def _alone(call: Callable[[A], R], argument: A, limits: Limits, writing: Connection) -> NoReturn:
    """What the child does; it never returns into its parent's program."""
    try:
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nowhere, stream)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (limits.memory, limits.memory))
        whole = math.ceil(limits.seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (whole, whole + 5))
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, limits.waiting * limits.seconds)
        end: End[R]
        try:
            end = Returned(call(argument))
        except MemoryError:
            end = Crashed(f"more than {limits.memory / 2**30:g} GiB of memory were asked for")
        except Exception as error:
            end = Crashed(_said(error))
        writing.send(end)
        writing.close()
    finally:
        os._exit(0)


def _said(error: Exception) -> str:
    """What was raised, and the innermost place in the sources at which it was."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    parts = place.filename.replace(os.sep, "/").split("/")
    return f"{type(error).__name__}: {error} ({'/'.join(parts[-2:])}:{place.lineno} in {place.name})"


def _ended(code: int, limits: Limits) -> Crashed | OutOfTime:
    """How a process ended that handed nothing back, from its exit code."""
    if -code in (signal.SIGXCPU, signal.SIGALRM):
        if -code == signal.SIGXCPU:
            return OutOfTime(f"no end was reached in {limits.seconds:g} seconds of the processor")
        return OutOfTime(f"no end was reached in {limits.waiting * limits.seconds:g} seconds of the clock")
    if code < 0:
        return Crashed(f"its process was ended by {signal.Signals(-code).name}")
    return Crashed(f"its process ended by itself, with the exit code {code}")
