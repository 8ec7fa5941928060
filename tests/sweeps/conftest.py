"""Sweeps whose subject is no child process solve in the process of the test, and draw white figures."""

import pytest

from comparisons.sweeps import outcome
from tests.sweeps.planted import called_here


@pytest.fixture
def children():
    """Nothing: a test of child processes requests this name, and the points are solved in children."""


@pytest.fixture(autouse=True)
def _in_this_process(request, monkeypatch, unprinted):
    """A child loads modules and kernels for a second; a point of these sweeps takes a hundredth."""
    if "children" not in request.fixturenames:
        monkeypatch.setattr(outcome, "call_limited", called_here)


@pytest.fixture
def interpreted(monkeypatch):
    """Children interpret the kernels: for fewer than forty small solves, the machine code takes longer to load."""
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
