"""Processes beside this one: several that share work, or one fresh Python for a single call.

Python counts what several hand over by semaphores, which on Linux are files in ``/dev/shm``; in a container it may be
that nobody may write there, or that it is not there.  A single call needs none.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from multiprocessing.connection import Connection
from typing import Any, ParamSpec, TypeVar

T = TypeVar("T")
P = ParamSpec("P")


class AloneError(RuntimeError):
    """No process can work beside this one; the words say why, and what helps."""


class ByForceError(RuntimeError):
    """A process ended without the result or the exception of its call."""


def pool(workers: int, prepares: Callable[..., object] | None = None, *given: Any) -> ProcessPoolExecutor:  # noqa: ANN401
    """So many processes, each a fresh Python that ``prepares`` itself with what is ``given``.

    Raises:
        AloneError: the system has no semaphores for them.
    """
    try:
        return ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=prepares, initargs=given)
    except (OSError, NotImplementedError, ImportError) as error:
        raise AloneError(f"no processes beside this one ({error}); on Linux they need a writable /dev/shm") from None


def trouble() -> str:
    """Why no process can work beside this one; empty if one can."""
    try:
        pool(1).shutdown()
    except AloneError as error:
        return str(error)
    return ""


def beside(call: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """What a function returns that is called in a fresh Python; what it raises is raised here.

    All of it must be what can be pickled.  The process ends with the call, and with an interrupt of this one.

    Raises:
        ByForceError: the process ended by force.
    """
    process_of = get_context("spawn")
    reading, writing = process_of.Pipe(duplex=False)
    process = process_of.Process(target=_tell, args=(writing, call, arguments, named), daemon=True)
    with deaf():
        process.start()
    writing.close()
    try:
        returned, raised = reading.recv()
    except EOFError:
        process.join()
        raise ByForceError(f"a process ended with {process.exitcode}") from None
    except BaseException:
        process.kill()
        raise
    finally:
        process.join()
        reading.close()
    if raised is not None:
        raise raised
    found: T = returned
    return found


def _tell(
    writing: Connection, call: Callable[..., object], arguments: tuple[object, ...], named: dict[str, object]
) -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        result: tuple[object, Exception | None] = (call(*arguments, **named), None)
    except Exception as error:
        result = (None, error)
    writing.send(result)


@contextmanager
def deaf() -> Iterator[None]:
    """Processes that are started meanwhile ignore interrupts until they say otherwise themselves.

    A process inherits that an interrupt is ignored, and nothing else of its parent's handling; one that is
    interrupted while it still loads its modules would print a traceback.
    """
    if threading.current_thread() is not threading.main_thread():  # no other may say how signals are handled
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
