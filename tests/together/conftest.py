"""The hinge, solved once by both solvers for all tests of this folder."""

from __future__ import annotations

import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.pairing import Runs, Solvers, paired
from cprbm_scene import Scene


@pytest.fixture(scope="session")
def hinge() -> Scene:
    return cases.opened("hinge")


@pytest.fixture(scope="session")
def hinge_runs(hinge: Scene) -> Runs:
    """Both solvers at their standard settings: N = 40 and 80 links, 80 and 160 elements."""
    return paired(hinge, Choices(), Solvers())


@pytest.fixture(scope="session")
def coarse_runs(hinge: Scene) -> Runs:
    """The theory ``bending`` alone, with few elements: enough to catch a wrong one of the finite elements."""
    return paired(hinge, Choices(elements=20, kinematics="bending"), Solvers())
