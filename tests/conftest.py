"""Settings and markers of all tests."""

from __future__ import annotations

import gc
import os

import pytest
from hypothesis import settings

from tests.house.internals import ROOT, Internals, product_names
from tests.house.unprinted import without_printing

# the time for an example depends on the load of the machine
settings.register_profile("no clock", deadline=None)
settings.load_profile("no clock")


@pytest.fixture(scope="session", autouse=True)
def _one_core():
    """Commands in the process of a test solve there: a second process loads all modules anew, 2 s of a processor each.

    Tests of workers name their number, and commands in fresh processes see all cores.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "cpu_count", lambda: 1)
        yield


@pytest.fixture(scope="session", autouse=True)
def _no_collection():
    """A benchmark collects rubbish before the clock starts, in the heap of all tests for 0.05 s of a processor."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gc, "collect", lambda generation=2: 0)
        yield


@pytest.fixture
def printed():
    """Nothing: a test that reads the bytes of figures requests this name, and ``unprinted`` does nothing."""


@pytest.fixture
def unprinted(request):
    """White figures: layout and printing take most of the time of a report; see :mod:`tests.house.unprinted`."""
    if "printed" in request.fixturenames:
        yield
        return
    with without_printing():
        yield


def pytest_collection_finish():
    """Modules and collected tests live to the end, so the garbage collector skips them: 8 % of the processor.

    The collector runs as seldom as in the processes of a sweep: the records of a load path are many and make no cycles.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 100)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Put the marker ``internals`` on the tests of internals of the product packages.

    Without a request for markers (``-m``) nobody reads the marker, and the search takes a third of the collection.
    """
    if not config.option.markexpr:
        return
    internals = Internals(ROOT, product_names())
    for item in items:
        if internals.names_for(item.path, getattr(item, "fixturenames", ())):
            item.add_marker(pytest.mark.internals)
