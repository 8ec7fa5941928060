"""Compilation of kernels by Numba.

The machine code is stored beside the module or in the user's cache.  Where neither can be written, every process
compiles anew.  With the environment variable ``NUMBA_DISABLE_JIT=1`` the same functions are interpreted.
An installation without stored machine code compiles at the first solve, and says so on the log.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit
from numba.core.event import Event, Listener, register

Function = TypeVar("Function", bound=Callable[..., object])

LOGGER = logging.getLogger("cprbm.compiled")

UNNOTICED = 1.0
"""Compilation, s, that a user does not notice."""


class Compilation(Listener):
    """Says once that kernels are compiled, when the compilation has taken longer than ``unnoticed`` seconds."""

    def __init__(self, unnoticed: float = UNNOTICED) -> None:
        self.unnoticed, self.spent, self.begin, self.depth = unnoticed, 0.0, 0.0, 0

    def on_start(self, event: Event) -> None:
        """Take the time at the begin of a kernel; kernels within a kernel do not count twice."""
        self.begin = self.begin if self.depth else time.perf_counter()
        self.depth += 1

    def on_end(self, event: Event) -> None:
        """Add the time of a kernel."""
        self.depth -= 1
        if self.depth == 0 and self.spent <= self.unnoticed:
            self.spent += time.perf_counter() - self.begin
            if self.spent > self.unnoticed:
                LOGGER.info("cprbm compiles its kernels; later runs find the stored machine code")


COMPILATION = Compilation()
register("numba:compile", COMPILATION)  # type: ignore[no-untyped-call]


def compiled(function: Function) -> Function:
    """The function as machine code, with IEEE's results of divisions by zero."""
    try:
        kernel = njit(cache=True, error_model="numpy")(function)
    except RuntimeError:
        # no folder for stored machine code
        kernel = njit(error_model="numpy")(function)
    return cast("Function", kernel)
