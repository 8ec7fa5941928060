"""Fixtures: the hinge, and a driven crank whose branches end."""

import pytest

from comparisons import cases


@pytest.fixture(scope="session")
def hinge():
    return cases.opened("hinge")


@pytest.fixture(scope="session")
def crank():
    """The case ``prestressed`` at every second degree, with two probes of the made-up jump and no critical limit."""
    whole = cases.opened("prestressed")
    usual = {"shown": (), "critical_limit": None, "beyond": None}
    stages = tuple(stage.model_copy(update={"stations": stage.stations[::2], **usual}) for stage in whole.stages)
    probes = tuple(probe for probe in whole.probes if probe.name in ("crank.reaction_moment", "scene.potential_energy"))
    return whole.model_copy(update={"stages": stages, "probes": probes, "claims": ()})
