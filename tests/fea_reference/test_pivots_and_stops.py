"""Bodies on pivots, stops at pins and assemblies of the finite elements, against bars, slopes and the elastica."""

import numpy as np
import pytest

from cprbm_scene import Ending, SceneError
from fea_reference import Settings, answer
from fea_reference.acting import Acting
from fea_reference.contacts import contacts
from fea_reference.curvature import softest
from fea_reference.march import begin
from fea_reference.mass import lumped_mass
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.system import assemble, load_direction
from fea_reference.travel import Course, reach
from tests.cprbm.scenes import LENGTH, MODULUS, THICKNESS, WIDTH
from tests.fea_reference.cantilever import elastica
from tests.fea_reference.test_curvature import dense
from tests.together.pivots import FORCE, MOMENT, bowed, lever, straight, wheel

# ------------------------------------------------------------------------------------------------ a pivot


def test_a_lever_on_its_pivot_pulls_a_bar():
    """A moment M at an arm r pulls with M/r; the bar gives by F L/EA, and the pivot holds against it."""
    r = 0.4 * LENGTH
    got = answer(lever(r), Settings(elements=4, kinematics="stretch"))
    assert got.ending is Ending.COMPLETED, got.sentence
    values, pull = got.stations[0].values, MOMENT / r
    turned = pull * LENGTH / (MODULUS * WIDTH * THICKNESS) / r
    assert values["lever.rotation"] == pytest.approx([turned], rel=10.0 * turned)
    assert values["A.displacement"] == pytest.approx([0.0, 0.0], abs=1e-12 * LENGTH)
    # the bar leans by what the pin rises, of second order
    assert values["G.reaction"] == pytest.approx([pull, 0.0], rel=1e-4, abs=1e-4 * pull)
    assert values["A.reaction"] == pytest.approx(-values["G.reaction"], abs=1e-9 * pull)


# ------------------------------------------------------------------------------------------------- a stop


@pytest.mark.parametrize(
    ("end", "towards", "sense"),
    [
        ("start", 0.0, 1.0),
        ("start", 2.0, -1.0),
        ("start", np.pi, -1.0),
        ("start", -1.0, 1.0),
        ("end", 0.0, -1.0),
        ("end", 2.0, 1.0),
        ("end", np.pi, 1.0),
    ],
)
def test_a_stop_turns_the_end_by_what_the_wheel_goes_beyond_it(end, towards, sense):
    """The beam leaves the pin along x: β = −towards − φ.  Beyond the limit the pinned end has 4 EI ψ/L of moment."""
    drawn = np.pi if towards == np.pi else -towards  # in (−π, π]
    play, turn = 0.3, 1e-3
    limits = {"least": drawn - play} if sense > 0.0 else {"most": drawn + play}
    way = [[0.2, 0.3 + turn], [0.1]]
    scene = wheel(towards, end, limits, [[sense * value for value in values] for values in way])
    got = answer(scene, Settings(elements=10, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    before, beyond, after = (station.values for station in got.stations)
    assert [(event.contact, event.stage) for event in got.events] == [("stop", "way0")]
    assert got.events[0].value == pytest.approx(sense * play, abs=1e-9)
    for values, phi in ((before, 0.2), (after, 0.1)):
        assert values["stop.angle"] == pytest.approx([drawn - sense * phi], abs=1e-9)
        assert values["stop.moment"] == [0.0]
        assert values["wheel.reaction_moment"] == pytest.approx([0.0], abs=1e-9 * MOMENT)
    assert beyond["stop.angle"] == pytest.approx([drawn - sense * play], abs=1e-9)
    assert beyond["stop.moment"] == pytest.approx([4.0 * turn * MOMENT], rel=1e-4)
    assert beyond["wheel.reaction_moment"] == pytest.approx([sense * 4.0 * turn * MOMENT], rel=1e-4)


@pytest.mark.parametrize("end", ["start", "end"])
def test_the_moment_of_a_stop_acts_where_the_beam_is_pinned(end):
    # the pin is at the wheel's pivot, the origin; where a beam takes a moment its bending has a jump
    scene = wheel(2.0, end, {"least": -2.3}, [[0.301]])
    got = answer(scene, Settings(elements=6, kinematics="bending"))
    # of double precision: a single one would make one of what it is compared with
    assert float(got.events[0].value) == pytest.approx(0.3, abs=1e-9)
    acting = got.stations[-1].forces
    own, other = (acting.chosen("stop", target) for target in ("beam", "wheel"))
    assert acting.place[own | other] == pytest.approx(np.zeros((2, 2)), abs=1e-12 * LENGTH)
    assert acting.s[own] == pytest.approx([0.0 if end == "start" else LENGTH], abs=1e-12 * LENGTH)
    moment = 4.0 * 1e-3 * MOMENT
    assert acting.moment[own] == pytest.approx([moment], rel=1e-4)
    assert acting.moment[other] == pytest.approx([-moment], rel=1e-4)


def pressed(stations=(0.2, 0.301)):
    """A model and a march of the wheel's, which has gone to the stations."""
    scene, settings = wheel(2.0, "start", {"least": -2.3}, [stations]), Settings(elements=6, kinematics="bending")
    model = build(scene, settings)
    march = begin(model, settings, contacts(scene, model, settings.penetration))
    for value in stations:
        reach(march, Course(0, 1.0), value)
    return model, march


@pytest.mark.parametrize("stations", [(0.2,), (0.2, 0.301)])
def test_the_smallest_curvature_is_on_what_stops_that_act_leave_free(stations):
    model, march = pressed(stations)
    assert bool(march.acting.limits) == (len(stations) == 2)
    assert softest(model, march.system).curvature == pytest.approx(dense(model, march.system), rel=1e-3)


def test_the_softest_mode_has_the_smallest_curvature():
    """uᵀ K u = μ of motions u with uᵀ M u = 1; a beam that does not stretch does no work in them."""
    model, march = pressed()
    mode = softest(model, march.system)
    u = mode.direction
    assert u @ (lumped_mass(model) * u) == pytest.approx(1.0)
    assert u @ (march.system.tangent.matrix @ u) == pytest.approx(mode.curvature, rel=1e-4)
    rows = march.system.tangent.matrix @ u
    assert rows[model.multipliers] == pytest.approx(np.zeros(model.multipliers.size), abs=1e-9)


# --------------------------------------------------------------------------------------------- an assembly


@pytest.mark.parametrize("moment", [0.5 * MOMENT, 2.5 * MOMENT])
def test_an_assembled_beam_is_the_elastica(moment):
    """A tip force across and no moment: what a pin there holds.  The auxiliary moment is gone at the end."""
    alpha = 3.0
    x, _, phi = elastica(alpha)
    scene = bowed(alpha, moment=moment, stop={"least": 0.0, "most": 2.0 * np.pi})
    errors = []
    for elements in (10, 20):
        got = answer(scene, Settings(elements=elements, kinematics="bending"))
        assert got.ending is Ending.COMPLETED, got.sentence
        assert got.stations[0].certificate.holds
        values = got.stations[0].values
        # from W above the pin to the beam behind it: a quarter turn, and on with the tip
        assert values["stop.angle"] == pytest.approx([0.5 * np.pi + phi], abs=1e-5)
        assert values["O.reaction_moment"] == pytest.approx([-alpha * x * MOMENT], rel=1e-4)
        errors.append(np.hypot(*(values["T.reaction"] / FORCE - [0.0, alpha])))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.2)
    assert errors[1] < 1e-4 * alpha


def test_a_stop_that_the_assembled_end_is_beyond_forbids_it():
    scene = bowed(3.0, moment=2.0 * MOMENT, stop={"most": 1.6})
    match = r"stops.stop.most: found 1.6 rad: a stop that forbids the assembly, by which 'beam' comes .* 2\.\d+ rad"
    with pytest.raises(SceneError, match=match):
        answer(scene, Settings(elements=10))


def test_an_assembly_whose_moments_bend_the_wrong_way_says_so():
    """Bent downwards and brought up the beam holds out until it would snap."""
    got = answer(bowed(3.0, moment=-0.7 * MOMENT), Settings(elements=10, kinematics="bending"))
    assert got.ending is Ending.BRANCH_ENDS
    assert got.sentence.startswith("during the assembly: at share of the ends' way to their points = 0.9")
    assert "it folds back" in got.sentence
    assert not got.stations


def test_an_assembly_that_leads_over_eulers_load_says_so():
    """Pushed straight towards its clamp the beam stays straight up to Euler's load of a clamped and pinned column."""
    got = answer(straight(), Settings(elements=10, kinematics="stretch"))
    assert got.ending is Ending.BRANCH_ENDS
    assert got.sentence.startswith("during the assembly")
    assert "another one branches off" in got.sentence
    assert not got.stations


# ---------------------------------------------------------------------------------------------- derivatives


@pytest.mark.parametrize("caught", [True, False])
def test_the_whole_tangent_with_stops_and_ends_apart(caught):
    scene = bowed(3.0, moment=MOMENT, stop={"least": 0.0})
    model = build(scene, Settings(elements=3))
    random = np.random.default_rng(7)
    z = model.start.values + 0.1 * random.standard_normal(model.size)
    values = random.standard_normal(len(model.stepped))
    ways = random.standard_normal((1, 2))
    acting = Acting(ways, stopping=True).stopped("stop", 0.0) if caught else Acting(None, stopping=False)

    def at(z, values):
        return assemble(model, {}, 6, values, State.of(z), acting)

    tangent = at(z, values).tangent.matrix.toarray()
    assert tangent == pytest.approx(tangent.T, abs=1e-12 * np.abs(tangent).max())
    for i in range(model.size):
        step = np.zeros(model.size)
        step[i] = 1e-6
        slope = (at(z + step, values).residual - at(z - step, values).residual) / 2e-6
        assert tangent[:, i] == pytest.approx(slope, abs=1e-6 * np.abs(tangent).max())
    for i in range(len(values)):
        more = values.copy()
        more[i] += 1.0
        change = at(z, more).residual - at(z, values).residual
        assert -change == pytest.approx(load_direction(model, i, State.of(z), acting), abs=1e-9)
