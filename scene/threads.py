"""One thread of BLAS while a solver works: more of them cost more than they bring for matrices as small as ours.

A process that has loaded its BLAS can be held to that by threadpoolctl alone.  Where this is not installed, BLAS has
the threads that the process was given, and the program ``cprbm`` gives itself one (:mod:`comparisons.threads`).
"""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext


def one_thread() -> AbstractContextManager[object]:
    """Hold the libraries of linear algebra that are loaded to one thread each, as far as that can be done."""
    try:
        from threadpoolctl import threadpool_limits
    except ImportError:
        return nullcontext()
    limits: AbstractContextManager[object] = threadpool_limits(limits=1, user_api="blas")
    return limits
