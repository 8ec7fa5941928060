"""Processes that have everything loaded and call a function apart, for one argument after the other.

Each is a fresh interpreter, which loads and tries out all that the function needs once, with linear algebra on one
thread.  For each call it forks (:mod:`tests.robustness.apart`), so that calls neither wait for imports nor see what
another has left behind, and what is found hangs neither on their order nor on how many hosts there are.
"""

from __future__ import annotations

import gc
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import Pipe, get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, Generic, TypeVar

from comparisons.executor import COLLECTED, interrupts_ignored
from comparisons.threads import ONE_THREAD
from tests.robustness.apart import Crashed, End, Limits, apart

A = TypeVar("A")
R = TypeVar("R")


@dataclass(slots=True)
class _Host(Generic[A]):
    """A process, this end of the line to it, and what it is asked now."""

    process: BaseProcess
    line: Connection
    asked: A | None = None


@dataclass(slots=True)
class Hosts(Generic[A, R]):
    """Some hosts of one function; what they call must be one that can be pickled, with its argument and value."""

    prepare: Callable[[], None]
    limits: Limits
    hosts: list[_Host[A]] = field(default_factory=list)

    def each(self, call: Callable[[A], R], arguments: Iterable[A]) -> Iterator[tuple[A, End[R]]]:
        """Every argument with how its call ended, in the order in which they end."""
        left = iter(arguments)
        busy: dict[Connection, int] = {}

        def begin(place: int) -> None:
            for argument in left:
                host = self.hosts[place]
                host.asked = argument
                host.line.send((call, argument, self.limits))
                busy[host.line] = place
                return

        for place in range(len(self.hosts)):
            begin(place)
        while busy:
            for line in wait(list(busy)):
                assert isinstance(line, Connection)
                place = busy.pop(line)
                asked = self.hosts[place].asked
                assert asked is not None
                end: End[R]
                try:
                    end = line.recv()
                except (EOFError, ConnectionResetError):
                    end = Crashed("the process that had everything loaded was ended by force")
                    self._ended(place)
                    self.hosts[place] = _started(self.prepare)
                begin(place)
                yield asked, end

    def _ended(self, place: int) -> None:
        """Have a host end; it ends what it has forked."""
        host = self.hosts[place]
        host.line.close()
        host.process.join()
        host.process.close()


@contextmanager
def hosts_of(count: int, prepare: Callable[[], None], limits: Limits) -> Iterator[Hosts[Any, Any]]:
    """So many hosts, which end with the context, whatever they are doing.

    Args:
        count: how many.
        prepare: called once in each; loads what is needed.
        limits: of each call.
    """
    hosts: Hosts[Any, Any] = Hosts(prepare, limits)
    try:
        for _ in range(count):
            hosts.hosts.append(_started(prepare))
        yield hosts
    finally:
        for host in hosts.hosts:
            host.line.close()
        for host in hosts.hosts:
            host.process.join()


def _started(prepare: Callable[[], None]) -> _Host[Any]:
    mine, its = Pipe()
    process = get_context("spawn").Process(target=_served, args=(its, prepare), daemon=True)
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(ONE_THREAD)
    try:
        with interrupts_ignored():
            process.start()
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
    its.close()
    return _Host(process, mine)


def _served(line: Connection, prepare: Callable[[], None]) -> None:
    """What a host does until its line is closed; an interrupt is for the process that asks, and not for it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    prepare()
    gc.collect()
    gc.freeze()
    gc.set_threshold(*COLLECTED)
    while True:
        try:
            call, argument, limits = line.recv()
            line.send(apart(call, argument, limits, line))
        except (EOFError, BrokenPipeError, ConnectionResetError):
            return
