"""Processes beside this one, as far as the system has what they speak to each other through.

Python counts what they hand over by semaphores, which on Linux are files in ``/dev/shm``; in a container it may be that
nobody may write there, or that it is not there.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any


class AloneError(RuntimeError):
    """No process can work beside this one; the words say why, and what helps."""


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
