"""Fixtures: the hinge, and a driven crank whose branches end, with the comparisons of right solvers."""

import pytest

from comparisons import cases
from tests.verdict.comparing import C, F, compared
from tests.verdict.jumping import Jumping


@pytest.fixture(scope="session")
def hinge():
    return cases.opened("hinge")


@pytest.fixture(scope="session")
def agreeing(hinge):
    """The comparison of right solvers on the hinge."""
    return compared(hinge, C, F)


@pytest.fixture(scope="session")
def crank():
    """The case ``prestressed`` at every second degree, with two probes of the made-up jump and no critical limit."""
    whole = cases.opened("prestressed")
    usual = {"shown": (), "critical_limit": None, "beyond": None}
    stages = tuple(stage.model_copy(update={"stations": stage.stations[::2], **usual}) for stage in whole.stages)
    probes = tuple(probe for probe in whole.probes if probe.name in ("crank.reaction_moment", "scene.potential_energy"))
    return whole.model_copy(update={"stages": stages, "probes": probes, "claims": ()})


@pytest.fixture(scope="session")
def coarse(crank):
    """The crank at every tenth degree."""
    stages = (stage.model_copy(update={"stations": stage.stations[::5]}) for stage in crank.stages)
    return crank.model_copy(update={"stages": tuple(stages)})


@pytest.fixture(scope="session")
def forward(coarse):
    """The way forward of the crank alone, at every tenth degree."""
    return coarse.model_copy(update={"stages": coarse.stages[:1]})


@pytest.fixture(scope="session")
def jumped(crank):
    """The comparison of right solvers on the crank: both jump forward at 70.4° and back at 25.3°."""
    return compared(crank, Jumping("cprbm"), Jumping("fea"))
