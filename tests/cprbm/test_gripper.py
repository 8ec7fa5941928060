"""The gripper of section 3.3 in the formulation ``paper``: two contacts at once, from the stress-free shape."""

from pathlib import Path

import pytest

import cprbm
from comparisons import cases
from cprbm_scene import scene_from

CASES = Path(__file__).parents[2] / "comparisons" / "cases"
# Displacement of A, m, and potential energy, J, at 16 N by IPOPT (CasADi's, exact derivatives, standard options) on the
# same minimisation written down from the paper alone, with IPOPT's own distance 1e-8 of the longest beam in the gaps
MINIMA = {
    (30, 40): ([0.0163631014, -0.0402271338], -0.3932222588),
    (60, 80): ([0.0163619648, -0.0402213778], -0.3930295854),
}
# Springs of beam 2 nearer to the block than the last offset point of beam 1, of how many
BEYOND = {(30, 40): "1 of 20", (60, 80): "2 of 40"}


def gripper(case, steps, stations):
    data = cases.data(case)
    data["claims"] = []
    data["stages"] = [{"name": "load", "steps": steps, "stations": stations}]
    data["probes"] = [{"of": of, "quantity": "displacement"} for of in ("A", "B", "O")]
    data["probes"] += [
        {"of": contact, "quantity": quantity}
        for contact in ("contact", "circle")
        for quantity in ("force", "centre", "ends", "closing_load")
    ]
    data["probes"] += [{"of": "scene", "quantity": "potential_energy"}]
    if steps == "dy":
        data["probes"] += [{"of": "A", "quantity": "reaction"}]
    return scene_from(data)


def asked(links):
    return cprbm.Settings(links={"beam1": links[0], "beam2": links[1]}, formulation="paper")


@pytest.mark.parametrize("links", MINIMA)
def test_straight_to_the_whole_load(links):
    answer = cprbm.answer(gripper("gripper", "F", [16.0]), asked(links))
    assert answer.completed, answer.sentence
    (station,) = answer.stations
    displacement, energy = MINIMA[links]
    assert station.values["A.displacement"] == pytest.approx(displacement, abs=2e-8)
    assert station.values["scene.potential_energy"][0] == pytest.approx(energy, rel=2e-7)
    assert station.certificate.holds
    assert station.certificate.smallest_curvature > 0.0
    assert set(station.touching) == {"contact", "circle"}
    (note,) = [note for note in answer.notes if "beyond" in note]
    assert note.startswith(f"in contact 'contact' {BEYOND[links]} related joints lie beyond the fitted boundary's ends")


def test_the_load_path_leads_where_the_whole_load_does():
    stations = [1.6, 6.4, 11.2, 16.0]
    by_steps = cprbm.answer(gripper("gripper", "F", stations), asked((30, 40)))
    assert by_steps.completed, by_steps.sentence
    assert by_steps.stations[-1].values["A.displacement"] == pytest.approx(MINIMA[30, 40][0], abs=2e-8)
    for contact in ("circle", "contact"):
        closed = [station.values[f"{contact}.closing_load"] for station in by_steps.stations]
        forces = [station.values[f"{contact}.force"][0] for station in by_steps.stations]
        for load, force, closing in zip(stations, forces, closed, strict=True):
            assert (force > 0.0) == (closing.size == 1)
            assert not closing.size or 0.0 < closing[0] <= load
        assert forces[0] == 0.0
        assert forces[-1] > 0.0


def test_a_driven_gripper_and_one_under_that_force_are_one():
    # reference: action is reaction; the drive's force, applied as a load, moves A by what was driven
    driven = cprbm.answer(gripper("gripper-driven", "dy", [0.02, 0.04]), asked((30, 40)))
    assert driven.completed, driven.sentence
    forces = [-station.values["A.reaction"][1] for station in driven.stations]
    loaded = cprbm.answer(gripper("gripper", "F", forces), asked((30, 40)))
    assert loaded.completed, loaded.sentence
    for one, other in zip(driven.stations, loaded.stations, strict=True):
        assert other.values["A.displacement"] == pytest.approx(one.values["A.displacement"], abs=1e-9)
        assert other.values["circle.force"] == pytest.approx(one.values["circle.force"], abs=1e-6)
