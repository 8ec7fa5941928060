"""One thread of BLAS while a solver works: for small matrices further threads take time.

In a process with a loaded BLAS only threadpoolctl can limit the threads.  Without threadpoolctl BLAS keeps the threads
of the process; the program ``cprbm`` limits these threads at the start (:mod:`comparisons.threads`).
"""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from typing import Any, cast


def one_thread() -> AbstractContextManager[object]:
    """Context with a single thread per loaded library of linear algebra; without effect if threadpoolctl is missing."""
    try:
        libraries = _loaded(len(sys.modules))
    except ImportError:
        return nullcontext()
    return cast("AbstractContextManager[object]", libraries.limit(limits=1, user_api="blas"))


@lru_cache(maxsize=1)
def _loaded(modules: int) -> Any:  # noqa: ANN401 - threadpoolctl has no types
    """Controller of the loaded libraries, cached: threadpoolctl reads the process's map of memory, which takes long.

    Libraries are loaded with Python modules, so that an equal number of ``modules`` means equal libraries.
    """
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
