"""Bodies on pivots, stops at pins and assemblies of the chained model, against statics, slopes and the elastica."""

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, Probe, SceneError
from tests.cprbm.scenes import MODULUS, THICKNESS
from tests.fea_reference.cantilever import elastica
from tests.together.pivots import FORCE, LENGTH, MOMENT, bowed, lever, straight, wheel


def solved(scene, links=40):
    answer = cprbm.answer(scene, cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    return answer


def test_a_lever_on_its_pivot_pulls_a_bar():
    # reference: statics; a bar that does not stretch lets nothing move
    r = 0.4 * LENGTH
    values = solved(lever(r)).stations[0].values
    pull = MOMENT / r
    assert values["lever.rotation"] == pytest.approx([0.0], abs=1e-9)
    assert values["A.displacement"] == pytest.approx([0.0, 0.0], abs=1e-12 * LENGTH)
    assert values["G.reaction"] == pytest.approx([pull, 0.0], abs=1e-9 * pull)
    assert values["A.reaction"] == pytest.approx([-pull, 0.0], abs=1e-9 * pull)


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize("towards", [0.0, 2.0, np.pi, -1.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_stop_turns_the_end_by_what_the_wheel_goes_beyond_it(end, towards, sense):
    # reference: β = −towards − φ, for the beam leaves the pin along x; a pinned end turned by ψ takes 4 EI ψ/L
    drawn = np.pi if towards == np.pi else -towards  # in (−π, π]
    play, turn = 0.3, 1e-3
    limits = {"least": drawn - play} if sense > 0.0 else {"most": drawn + play}
    way = [[0.2, 0.3 + turn], [0.1]]
    scene = wheel(towards, end, limits, [[sense * value for value in values] for values in way])
    before, beyond, after = (station.values for station in solved(scene).stations)
    for values, phi in ((before, 0.2), (after, 0.1)):
        assert values["stop.angle"] == pytest.approx([drawn - sense * phi], abs=1e-9)
        assert values["stop.moment"] == [0.0]
        assert values["wheel.reaction_moment"] == pytest.approx([0.0], abs=1e-9 * MOMENT)
    assert beyond["stop.angle"] == pytest.approx([drawn - sense * play], abs=1e-9)
    assert beyond["stop.moment"] == pytest.approx([4.0 * turn * MOMENT], rel=2e-3)
    assert beyond["wheel.reaction_moment"] == pytest.approx([sense * 4.0 * turn * MOMENT], rel=2e-3)


@pytest.mark.parametrize("theory", ["bending", "shear"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_station_may_lie_at_the_very_limit_of_a_stop(theory, sense):
    # reference: the beam is idle up to the limit, on the way there and on the way back
    play, limit = 0.3, "least" if sense > 0.0 else "most"
    ways = [[0.5 * play, play, 2.0 * play], [play, 0.0]]
    scene = wheel(2.0, "start", {limit: -2.0 - sense * play}, [[sense * value for value in way] for way in ways])
    stations = solved(scene.model_copy(update={"theory": theory})).stations
    moments = [station.values["stop.moment"][0] for station in stations]
    assert moments[:2] + moments[3:] == pytest.approx([0.0] * 4, abs=1e-9 * MOMENT)
    assert moments[2] == pytest.approx(4.0 * play * MOMENT, rel=0.1)


def test_a_stop_bends_its_beam_and_does_not_pull_it():
    # reference: a pinned end turned by ψ takes 4 EI ψ/L and gives the clamp 2 EI ψ/L; the shoe slides, so that the beam
    # is pulled by nothing of the first order in ψ
    turn, asked = 1e-3, {"of": "beam", "quantity": "combined_stress", "points": 5}
    scene = wheel(2.0, "end", {"least": -2.3}, [[0.3 + turn]])
    scene = scene.model_copy(update={"probes": (*scene.probes, Probe(**asked))})
    stress = solved(scene).stations[0].values["beam.combined_stress"]
    largest = 4.0 * turn * MODULUS * (0.5 * THICKNESS) / LENGTH
    assert stress == pytest.approx(largest * np.abs([-0.5, -0.125, 0.25, 0.625, 1.0]), abs=3e-3 * largest)


@pytest.mark.parametrize("moment", [0.5 * MOMENT, 2.5 * MOMENT])
def test_an_assembled_beam_is_the_elastica(moment):
    # reference: the elastica of a cantilever under a force across its tip, which is what a pin there holds
    alpha = 3.0
    x, _, phi = elastica(alpha)
    scene = bowed(alpha, moment=moment, stop={"least": 0.0, "most": 2.0 * np.pi})
    errors = []
    for links in (20, 40):
        station = solved(scene, links).stations[0]
        assert station.certificate.holds
        # from W above the pin to the beam behind it: a quarter turn, and on with the tip
        assert station.values["stop.angle"] == pytest.approx([0.5 * np.pi + phi], abs=2e-3)
        assert station.values["O.reaction_moment"] == pytest.approx([-alpha * x * MOMENT], rel=4.4 / links**2)
        errors.append(np.hypot(*(station.values["T.reaction"] / FORCE - [0.0, alpha])))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)
    assert errors[1] < 2e-4 * alpha


def test_a_stop_that_the_assembled_end_is_beyond_forbids_it():
    scene = bowed(3.0, moment=2.0 * MOMENT, stop={"most": 1.6})
    with pytest.raises(
        SceneError, match=r"stops.stop.most: found 1.6 rad: a stop that forbids the assembly.* 2\.\d+ rad"
    ):
        cprbm.answer(scene, cprbm.Settings(links=10))


def test_an_assembly_whose_moments_bend_the_wrong_way_says_so():
    # bent downwards and brought up, the beam holds out until it would snap
    answer = cprbm.answer(bowed(3.0, moment=-0.7 * MOMENT), cprbm.Settings(links=20))
    assert answer.ending is Ending.BRANCH_ENDS
    assert "as the ends go to their points, fold" in answer.sentence
    assert not answer.stations


def test_an_assembly_that_leads_over_eulers_load_says_so():
    # pushed straight towards its clamp, a beam that does not stretch has no way to go at all
    answer = cprbm.answer(straight(), cprbm.Settings(links=20))
    assert not answer.completed
    assert "as the ends go to their points" in answer.sentence
    assert not answer.stations
