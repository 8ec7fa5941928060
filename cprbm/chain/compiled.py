"""Compilation of kernels by Numba.

The machine code is stored beside the module or in the user's cache.  Where neither can be written, every process
compiles anew.  A kernel contains called kernels of other modules, but Numba looks at the kernel's own module
alone: here a change of any module with kernels makes all stored machine code out of date.  The stamp is a part of
the version, which Numba reads first: an index of another stamp may name classes that are gone.  With the environment
variable ``NUMBA_DISABLE_JIT=1`` the same functions are interpreted.  An installation without stored machine code
compiles at the first solve, and says so once.
"""

import logging
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, TypeVar, cast

from numba import njit
from numba.core.event import Event, Listener, register

Function = TypeVar("Function", bound=Callable[..., object])

LOGGER = logging.getLogger("cprbm.compiled")
"""Without handlers, Python prints warnings on standard error."""


PACKAGES = ("chain", "contact", "equilibrium", "paper")
FILES = [path.stat() for package in PACKAGES for path in Path(__file__).parents[1].glob(f"{package}/*.py")]
STAMP = max(file.st_mtime_ns for file in FILES), sum(file.st_size for file in FILES)
"""Latest time, and size, of the modules with kernels."""


class Compilation(Listener):
    """Says once that kernels are compiled.

    Attributes:
        said: whether the process has said so.
        stored: whether the machine code is stored.
    """

    said = False
    stored = True

    def on_start(self, event: Event) -> None:
        """Say that the first kernel of this package is compiled."""
        if not self.said and event.data["dispatcher"].py_func.__module__.startswith("cprbm."):
            self.said = True
            hint = (
                "later runs find the stored machine code"
                if self.stored
                else "no folder for the machine code can be written, and every process compiles: set NUMBA_CACHE_DIR"
            )
            LOGGER.warning("cprbm compiles its kernels, a minute or two; %s", hint)

    def on_end(self, event: Event) -> None:
        """Nothing is said at the end."""


COMPILATION = Compilation()
register("numba:compile", COMPILATION)  # type: ignore[no-untyped-call]


def compiled(function: Function, *, counts: bool = True) -> Function:
    """The function as machine code, with IEEE's results of divisions by zero.

    Numba counts the references to every array of the arguments, also of tuples, at every call.  In a loop over places
    of contact the counts take several times as long as the arithmetic.  A function without ``counts`` neither makes
    nor returns arrays.
    """
    translated = partial(cast("Any", njit), error_model="numpy", _nrt=counts)  # Numba's types lack ``_nrt``
    try:
        kernel = translated(cache=True)(function)
        stored = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
        if stored is not None:
            stored._version = f"{stored._version} {STAMP}"
    except RuntimeError:
        COMPILATION.stored = False
        kernel = translated()(function)
    return cast("Function", kernel)


compiled_inner = partial(compiled, counts=False)
