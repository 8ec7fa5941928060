"""Fixtures: the hinge, and two made-up solvers with equal verdicts."""

import pytest

from comparisons import cases


@pytest.fixture(scope="session")
def hinge():
    return cases.opened("hinge")


@pytest.fixture(scope="session")
def right():
    """Two solvers that agree: 0.2 % and 0.05 % of error, half a per cent of theory."""
    # an import at the head would mark every test of the folder as dependent on internals
    from comparisons.pairing import Solvers
    from tests.verdict.made_up import MadeUp

    return Solvers(cprbm=MadeUp("cprbm", 2e-3), fea=MadeUp("fea", -5e-4))


@pytest.fixture(autouse=True)
def _quick_figures(unprinted):
    """Tests that read the bytes of figures request ``printed``."""
