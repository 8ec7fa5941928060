"""The recording of 3c78333 and the declared changes, for all tests of this folder."""

import pytest

from .declared import declared
from .promises import recorded
from .today import visible


@pytest.fixture(scope="session")
def promised():
    return visible(recorded())


@pytest.fixture(scope="session")
def changes():
    return declared()
