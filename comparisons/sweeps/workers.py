"""Workers of a sweep: processes of this machine, or the workers of a Dask cluster (extra ``cluster``).

A Dask worker solves a point in a child process, since only a process can be ended at its time limit.  The child keeps
modules and compiled kernels from point to point, and computes with one thread.  The scheduler holds a few points per
worker.  The client releases every result at once: the loss of a worker repeats only the points of the worker.
"""

import os
import platform
import re
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import contextmanager
from functools import partial
from typing import Any, NamedTuple, ParamSpec, TypeVar

from comparisons.executor import permit_children, threads
from comparisons.provenance import program
from comparisons.threads import ONE_THREAD
from cprbm_scene import Mistake, SceneError

T = TypeVar("T")
P = ParamSpec("P")

WINDOW = 16
"""Number of points that the workers have at a time, so that a result is kept as soon as the result is there."""

PER_THREAD = 3
"""Number of points per thread of a cluster: one is solved, and two wait at the worker."""

CONNECT = 10.0
"""Longest wait for a scheduler, s."""

ARRIVE = 60.0
"""Longest wait for the first worker of a scheduler, s."""

_PLACE = re.compile(r"(?:local:(?P<count>[1-9]\d{0,2})|dask://(?P<scheduler>[^\s/:]+:\d{1,5}))")


class OtherVersionError(RuntimeError):
    """A worker has another version of the program, of Python or of a library."""


class Workers(NamedTuple):
    """Workers of a sweep.

    Attributes:
        submit: begins a call of a function with arguments on a worker, and returns the future of the call.
        window: function that returns the number of points that the workers have at a time.
        lost: errors of a point whose workers died.
    """

    submit: Callable[..., Future[Any]]
    window: Callable[[], int] = lambda: WINDOW
    lost: tuple[type[Exception], ...] = ()


@contextmanager
def workers_on(place: str) -> Iterator[Workers]:
    """Workers at ``local:N`` or ``dask://HOST:PORT``; local processes end with the context.

    Raises:
        SceneError: the text is no place, no scheduler or no worker answers, or a worker has another version.
        BrokenExecutor: the scheduler ended during the sweep.
        ImportError: Dask is not installed.
    """
    found = _PLACE.fullmatch(place)
    if found is None:
        allowed = "local:N with N processes, as local:2, or dask://HOST:PORT with the address of a scheduler"
        raise SceneError([Mistake("--on", repr(place), allowed)])
    if found["count"]:
        with threads(int(found["count"])) as pool:
            yield Workers(pool.submit)
    else:
        with _cluster(found["scheduler"]) as workers:
            yield workers


@contextmanager
def _cluster(scheduler: str) -> Iterator[Workers]:
    from distributed import Client, KilledWorker

    def refused(found: object, allowed: str) -> SceneError:
        return SceneError([Mistake("--on", f"dask://{scheduler}: {found}", allowed)])

    try:
        client = Client(f"tcp://{scheduler}", timeout=CONNECT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise refused(error, "the address of a running scheduler") from None
    with client, client.get_executor(pure=False) as pool:
        try:
            client.wait_for_workers(1, timeout=ARRIVE)
            yield Workers(
                submit=partial(pool.submit, _call, program()),
                window=lambda: PER_THREAD * sum(client.nthreads().values()),
                lost=(KilledWorker,),
            )
        except TimeoutError:
            raise refused(f"no worker after {ARRIVE:g} s", "a scheduler with workers") from None
        except OtherVersionError as error:
            raise refused(error, "the versions of the client at all workers") from None
        except CancelledError:
            raise BrokenExecutor(f"The scheduler at {scheduler} ended.") from None
        finally:
            pool.shutdown(wait=False)


def _call(version: str, function: Callable[P, T], *arguments: P.args, **named: P.kwargs) -> T:
    """Value of a call on a worker of the cluster that has the ``version`` of the client.

    Raises:
        OtherVersionError: the worker has another version; a worker may join after the first check.
    """
    if program() != version:
        raise OtherVersionError(f"another version of cprbm, Python or a library on {platform.node()}")
    os.environ.update(ONE_THREAD)  # the child takes the variables over
    permit_children()
    return function(*arguments, **named)
