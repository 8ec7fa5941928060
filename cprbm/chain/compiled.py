"""Compilation of kernels by Numba.

The machine code is stored beside the module or in the user's cache.  Where neither can be written, every process
compiles anew.  With the environment variable ``NUMBA_DISABLE_JIT=1`` the same functions are interpreted.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar, cast

from numba import njit

Function = TypeVar("Function", bound=Callable[..., object])


def compiled(function: Function) -> Function:
    """The function as machine code, with IEEE's results of divisions by zero."""
    try:
        kernel = njit(cache=True, error_model="numpy")(function)
    except RuntimeError:
        # no folder for stored machine code
        kernel = njit(error_model="numpy")(function)
    return cast("Function", kernel)
