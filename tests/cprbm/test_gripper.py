"""The gripper of section 3.3 in the formulation ``paper``: two contacts at once, from the stress-free shape."""

from pathlib import Path

import numpy as np
import pytest

import cprbm
from comparisons import cases
from cprbm import following
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import point_at
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


def test_newtons_method_goes_there_in_one_load_step_however_many_joints_are_related():
    problem = mechanism_of(gripper("gripper", "F", [16.0]), asked((300, 400))).problem
    rest = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    found = equilibrium(problem, {"F": 16.0}, rest, 1e-11, 20)
    assert found.converged
    assert np.sum(found.point.lam > 0.0) >= 2


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


def test_a_load_at_which_a_state_was_doubted_is_not_solved_again(monkeypatch):
    # 16 N at once leave a doubt half-way; from 8 N the same state is believed
    scene, solved, seen = gripper("gripper", "F", [16.0]), [], following.doubt

    def noted(problem, values, *given, **named):
        found = equilibrium(problem, values, *given, **named)
        solved.extend([values["F"]] * found.converged)
        return found

    doubts = []
    monkeypatch.setattr(following, "equilibrium", noted)
    monkeypatch.setattr(following, "doubt", lambda *given: doubts.append(seen(*given)) or doubts[-1])
    answer = cprbm.answer(scene, asked((30, 40)))
    assert answer.completed, answer.sentence
    assert max(doubts) > 1.0
    assert len(solved) > 1
    assert sorted(solved) == sorted(set(solved))
    # reference: IPOPT on the same minimisation
    place, _ = MINIMA[30, 40]
    assert answer.stations[-1].values["A.displacement"] == pytest.approx(place, rel=1e-6)
