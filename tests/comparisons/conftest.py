"""The hinge, and two made-up solvers that agree on it."""

import pytest

from comparisons import cases
from comparisons.pairing import Solvers
from cprbm_scene import Scene
from tests.comparisons.made_up import MadeUp


@pytest.fixture
def hinge() -> Scene:
    return cases.opened("hinge")


@pytest.fixture
def right() -> Solvers:
    """Two solvers that agree: 0.2 % and 0.05 % of error, half a per cent of theory."""
    return Solvers(cprbm=MadeUp("cprbm", 2e-3), fea=MadeUp("fea", -5e-4))
