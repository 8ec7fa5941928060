"""One recording of today's program for all tests of this folder."""

import pytest

from .declared import declared
from .promises import recorded
from .today import today, visible


@pytest.fixture(scope="session")
def promised():
    return visible(recorded())


@pytest.fixture(scope="session")
def changes():
    return declared()


@pytest.fixture(scope="session")
def now(promised, changes):
    return today(promised, changes)
