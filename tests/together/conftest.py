"""The hinge, solved once by both solvers for all tests of this folder."""

import pytest

from comparisons import cases, compare
from comparisons.choices import Choices


@pytest.fixture(scope="session")
def hinge():
    return cases.opened("hinge")


@pytest.fixture(scope="session")
def hinge_runs(hinge):
    """Both solvers at their standard settings: N = 40 and 80 links, 80 and 160 elements."""
    return compare(hinge).runs


@pytest.fixture(scope="session")
def coarse_runs(hinge):
    """The theory ``bending`` alone, with few elements: enough to catch a wrong one of the finite elements."""
    return compare(hinge, Choices(elements=20, kinematics="bending")).runs
