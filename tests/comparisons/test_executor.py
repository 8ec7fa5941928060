"""A call in a process of its own: what it returns, what it raises, and what is said of one that ends."""

import math
import multiprocessing
import os
import signal

import pytest

from comparisons.executor import WorkerDiedError, call_fresh


def test_what_is_called_is_called_in_another_process():
    assert call_fresh(os.getpid) != os.getpid()
    assert call_fresh(math.hypot, 3.3, 5.6) == 6.5


def test_what_it_raises_is_raised_here():
    with pytest.raises(ValueError, match="math domain error"):
        call_fresh(math.sqrt, -0.3)


@pytest.mark.parametrize(("ends", "by", "with_"), [(os._exit, 139, 139), (signal.raise_signal, 9, -9)])
def test_one_that_ends_by_force_is_told_of(ends, by, with_):
    with pytest.raises(WorkerDiedError, match=f"ended with {with_}$"):
        call_fresh(ends, by)


def test_no_semaphores_are_needed(monkeypatch):
    def refused(*_):
        raise OSError(13, "Permission denied")

    monkeypatch.setattr("multiprocessing.synchronize.SemLock.__init__", refused)
    assert call_fresh(math.floor, 7.9) == 7


def test_an_interrupt_ends_it(monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("multiprocessing.connection.Connection.recv", interrupted)
    with pytest.raises(KeyboardInterrupt):
        call_fresh(signal.pause)
    assert not multiprocessing.active_children()
