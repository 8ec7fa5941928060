"""One thread of BLAS while a solver works: more of them cost more than they bring for matrices as small as ours.

A process that has loaded its BLAS can be held to that by threadpoolctl alone.  Where this is not installed, BLAS has
the threads that the process was given, and the program ``cprbm`` gives itself one (:mod:`comparisons.threads`).
"""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


def one_thread() -> AbstractContextManager[object]:
    """Hold the libraries of linear algebra that are loaded to one thread each, as far as that can be done."""
    try:
        libraries = _loaded(len(sys.modules))
    except ImportError:
        return nullcontext()
    if all(library.num_threads == 1 for library in libraries.lib_controllers if library.user_api == "blas"):
        return nullcontext()
    limits: AbstractContextManager[object] = libraries.limit(limits=1, user_api="blas")
    return limits


@lru_cache(maxsize=1)
def _loaded(modules: int) -> ThreadpoolController:
    """The libraries that are loaded, for which threadpoolctl reads the process's map of memory: dear beside a solve.

    None is loaded but with a module that is imported, so they are those of as many ``modules``.
    """
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
