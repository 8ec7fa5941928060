"""What no probe asks for is not computed: counted at the functions that would."""

from pkgutil import resolve_name

import pytest

import cprbm
import fea_reference
from comparisons import cases

STRESSES = {
    cprbm: ("cprbm.results.statics.Statics.bending_stress", "cprbm.results.statics.Statics.combined_stress"),
    fea_reference: ("fea_reference.probes.bending_moment", "fea_reference.probes.normal_force"),
}


def short(quantities):
    """The hinge up to its last station, with the probes of some quantities."""
    scene = cases.opened("hinge")
    stages = tuple(stage.model_copy(update={"stations": stage.stations[-1:]}) for stage in scene.stages)
    probes = tuple(probe for probe in scene.probes if probe.quantity in quantities)
    return scene.model_copy(update={"stages": stages, "probes": probes, "claims": ()})


def counted(solver, scene, monkeypatch):
    """How often a solver calls each of the functions for what may be asked."""
    calls = dict.fromkeys(STRESSES[solver], 0)
    for name in calls:
        original = resolve_name(name)

        def counting(*arguments, name=name, original=original):
            calls[name] += 1
            return original(*arguments)

        monkeypatch.setattr(name, counting)
    assert solver.answer(scene).completed
    return calls


@pytest.mark.parametrize("solver", [cprbm, fea_reference], ids=["cprbm", "fea"])
def test_stresses_are_found_for_who_asks(solver, monkeypatch):
    assert not any(counted(solver, short({"displacement", "rotation", "force"}), monkeypatch).values())


@pytest.mark.parametrize("solver", [cprbm, fea_reference], ids=["cprbm", "fea"])
def test_and_the_count_would_show_them(solver, monkeypatch):
    # the hinge has two beams; a closing is an event of every answer, asked or not
    found = counted(solver, short({"bending_stress"}), monkeypatch)
    assert found[next(name for name in found if ".bending_" in name)] == 2
