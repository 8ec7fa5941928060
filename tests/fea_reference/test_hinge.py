"""The rotational hinge: what must hold of its answer whatever the numbers are."""

from pathlib import Path

import numpy as np
import pytest

from cprbm_scene import Ending, read, scene_from
from fea_reference import Settings, answer
from tests.references import hinge as exact

CASE = Path(__file__).parents[2] / "comparisons" / "cases" / "hinge.toml"


@pytest.fixture(scope="module")
def scene():
    return read(CASE)


@pytest.fixture(scope="module")
def solved(scene):
    return answer(scene)


def stepped(scene, *stations):
    stage = scene.stages[0].model_copy(update={"stations": stations})
    return scene.model_copy(update={"stages": (stage,)})


def test_every_station_is_certified(scene, solved):
    assert solved.ending is Ending.COMPLETED
    assert tuple(station.value for station in solved.stations) == scene.stages[0].stations
    for station in solved.stations:
        certificate = station.certificate
        assert certificate.holds
        assert certificate.force_balance < 1e-8
        assert certificate.moment_balance < 1e-8
        assert certificate.penetration <= 1e-4
        assert certificate.smallest_curvature > 0.0
        assert set(station.values) == {probe.name for probe in scene.probes}


def test_the_supports_balance_the_load(solved):
    """ΣF and ΣM about C, from the probes alone: no multiplier, no unit of the solver's own."""
    for station in solved.stations:
        values = station.values
        force = values["A.reaction"] + values["C.reaction"]
        assert force == pytest.approx([0.0, 0.0], abs=1e-8 * np.abs(values["A.reaction"]).max())
        lever = 2 * 0.02625
        moment = values["A.reaction_moment"] + values["C.reaction_moment"] - lever * values["A.reaction"][0]
        assert moment[0] == pytest.approx(-station.value, rel=1e-8)


def test_the_contact_closes_once_and_pushes_after(solved):
    (event,) = solved.events
    assert (event.contact, event.stage) == ("contact", "load")
    for station in solved.stations:
        values, closed = station.values, station.value > event.value
        assert (values["contact.force"][0] > 0.0) == closed
        assert values["contact.centre"].size == values["contact.closing_load"].size == int(closed)
        assert ("contact" in station.touching) == closed
    forces = [station.values["contact.force"][0] for station in solved.stations]
    assert forces == sorted(forces)


def test_the_beams_touch_at_the_closing_load(scene, solved):
    """Just below it there is no force; just above it there is one, small beside the last."""
    (event,) = solved.events
    got = answer(stepped(scene, event.value * (1 - 1e-6), event.value * (1 + 1e-6)))
    below, above = (station.values["contact.force"][0] for station in got.stations)
    assert below == 0.0
    assert 0.0 < above < 1e-3 * solved.stations[-1].values["contact.force"][0]


def test_the_stress_is_statics(scene, solved):
    """At the clamps the bending moment is the support's."""
    for station in solved.stations:
        for beam, root in (("beam1", "A"), ("beam2", "C")):
            stress = station.values[f"{beam}.bending_stress"][0]
            section = scene.beams[beam]
            modulus = section.width * section.thickness**2 / 6
            # The ground turns the beam's start by M; the section beyond answers with −M.
            expected = -station.values[f"{root}.reaction_moment"][0] / modulus
            assert stress == pytest.approx(expected, rel=1e-7)


def test_the_beams_touch_and_lie_where_the_elastica_does(scene):
    # reference: tests.references.hinge, in the bending theory
    truth = exact.solve(exact.PAPER, 0.67)
    (station,) = answer(stepped(scene, 0.67), Settings(kinematics="bending")).stations
    places = station.touching["contact"]
    assert places.mean(axis=0) == pytest.approx(truth.contact_point, abs=1e-5)
    # A zone's width, and the gap that the penalty leaves there.
    assert np.ptp(places, axis=0).max() < scene.beams["beam1"].thickness
    assert station.values["contact.centre"][0] == pytest.approx(truth.contact_arc_lengths[0], abs=1e-5)
    for beam in (1, 2):
        shape = station.shapes[f"beam{beam}"]
        assert shape.s[[0, -1]] == pytest.approx([0.0, exact.PAPER.length], rel=1e-12)
        assert np.stack([shape.x, shape.y]) == pytest.approx(truth.shape(beam, shape.s), abs=1e-6)


def test_beams_of_unlike_thickness_touch_between_their_surfaces():
    """A thin beam above a thick one, pressed down: they touch half the thick one's thickness above its line."""
    upper, lower = 0.0011, 0.0037
    y = 0.5 * (upper + lower)
    ends = {"ground": {"R": [0.0, y], "S": [0.0, 0.0], "T": [0.19, 0.0]}, "tip": {"P": [0.17, y]}}

    def beam(start, end, first, last, thickness):
        return {
            "curve": {"kind": "line", "start": start, "end": end},
            "thickness": thickness,
            "width": 0.0071,
            "material": "m",
            "start": {"joint": "weld", "point": first},
            "end": {"joint": "weld", "point": last},
        }

    pressed = scene_from(
        {
            "name": "unlike",
            "theory": "bending",
            "materials": {"m": {"youngs_modulus": 2.3e9, "poisson_ratio": 0.35}},
            "bodies": {
                "ground": {"motion": "fixed", "points": ends["ground"]},
                "block": {"motion": "free", "points": ends["tip"]},
            },
            "beams": {
                "thin": beam(ends["tip"]["P"], ends["ground"]["R"], "P", "R", upper),
                "thick": beam(ends["ground"]["S"], ends["ground"]["T"], "S", "T", lower),
            },
            "loads": {"press": {"kind": "force", "point": "P", "direction": [0.0, -1.0]}},
            "contacts": {"touch": {"kind": "beam-beam", "between": ["thin", "thick"]}},
            "stages": [{"name": "load", "steps": "press", "stations": [1e-3]}],
            "probes": [{"of": "touch", "quantity": "force"}, {"of": "touch", "quantity": "centre"}],
        }
    )
    (station,) = answer(pressed, Settings(elements=20)).stations
    # The thin beam is drawn from its tip, which is what presses: within the first element.
    assert 0.0 <= station.values["touch.centre"][0] < 0.17 / 20
    assert station.values["touch.force"][0] == pytest.approx(1e-3, rel=0.2)
    # The thick beam gives way by P a³ b³/(3 EI L³) < 1e-7 m.
    assert station.touching["touch"][:, 1] == pytest.approx(0.5 * lower, abs=2e-7)
    assert station.touching["touch"][:, 0] == pytest.approx(0.17, abs=0.17 / 20)


def test_unlike_numbers_of_elements(scene, solved):
    """No node of one beam faces a node of the other."""
    got = answer(scene, Settings(elements={"beam1": 47, "beam2": 61})).stations[-1].values
    fine = solved.stations[-1].values
    assert got["B.displacement"] == pytest.approx(fine["B.displacement"], rel=1e-4)
    assert got["contact.force"] == pytest.approx(fine["contact.force"], rel=1e-3)


def test_one_bold_step_arrives_where_ten_do(scene, solved):
    got = answer(stepped(scene, 0.67))
    assert got.ending is Ending.COMPLETED
    assert got.stations[0].values["B.displacement"] == pytest.approx(
        solved.stations[-1].values["B.displacement"], rel=1e-5
    )


def test_a_load_far_beyond_ends_by_name(scene):
    got = answer(stepped(scene, 0.335, 1e9), Settings(elements=20, iteration_limit=300))
    assert got.ending in (
        Ending.STEP_TOO_SMALL,
        Ending.TURNED_TOO_FAR,
        Ending.BEAMS_CROSSED,
        Ending.BRANCH_ENDS,
        Ending.NOT_CERTIFIED,
    )
    assert len(got.sentence) > 20
    assert [station.value for station in got.stations] == [0.335]
    assert all(np.isfinite(value).all() for value in got.stations[0].values.values())


def test_there_and_back_again(scene, solved):
    """Elastic and without friction: the way does not matter, and unloading opens the contact."""
    got = answer(stepped(scene, 0.0, 0.67, 0.67, 0.134, 0.0))
    assert got.ending is Ending.COMPLETED, got.sentence
    rest, loaded, again, below, back = (station.values for station in got.stations)
    for values in (rest, back):
        assert values["B.displacement"] == pytest.approx([0.0, 0.0], abs=1e-11)
        assert values["contact.force"][0] == 0.0
    assert loaded["B.displacement"] == pytest.approx(solved.stations[-1].values["B.displacement"], rel=1e-5)
    assert again["contact.force"] == pytest.approx(loaded["contact.force"], rel=1e-6)
    assert below["B.displacement"] == pytest.approx(solved.stations[1].values["B.displacement"], rel=1e-9)


@pytest.mark.parametrize("kinematics", ["bending", "stretch"])
def test_fine_meshes_are_no_harder(scene, kinematics):
    """Newton's method must not need more iterations because the elements are short."""
    got = answer(stepped(scene, 0.2, 0.5), Settings(elements=320, kinematics=kinematics))
    assert got.ending is Ending.COMPLETED, got.sentence
    assert got.stations[0].certificate.iterations < 20


def test_round_off_of_very_many_elements_is_no_negative_curvature(scene):
    """The curvature belongs to the mechanism: the number of elements has no part in it."""
    got = answer(stepped(scene, 0.067), Settings(elements=2560, kinematics="bending"))
    assert got.ending is Ending.COMPLETED, got.sentence
    coarse = answer(stepped(scene, 0.067), Settings(elements=80, kinematics="bending"))
    expected = coarse.stations[0].certificate.smallest_curvature
    assert got.stations[0].certificate.smallest_curvature == pytest.approx(expected, rel=1e-3)
