"""A call in a process of its own: what it returns, what it raises, and what is said of one that ends."""

import math
import multiprocessing
import os
import signal

import pytest

from comparisons.processes import ByForceError, beside


def test_what_is_called_is_called_in_another_process():
    assert beside(os.getpid) != os.getpid()
    assert beside(math.hypot, 3.3, 5.6) == 6.5


def test_what_it_raises_is_raised_here():
    with pytest.raises(ValueError, match="math domain error"):
        beside(math.sqrt, -0.3)


@pytest.mark.parametrize(("ends", "by", "with_"), [(os._exit, 139, 139), (signal.raise_signal, 9, -9)])
def test_one_that_ends_by_force_is_told_of(ends, by, with_):
    with pytest.raises(ByForceError, match=f"ended with {with_}$"):
        beside(ends, by)


def test_no_semaphores_are_needed(monkeypatch):
    def refused(*_):
        raise OSError(13, "Permission denied")

    monkeypatch.setattr("multiprocessing.synchronize.SemLock.__init__", refused)
    assert beside(math.floor, 7.9) == 7


def test_an_interrupt_ends_it(monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("multiprocessing.connection.Connection.recv", interrupted)
    with pytest.raises(KeyboardInterrupt):
        beside(signal.pause)
    assert not multiprocessing.active_children()
