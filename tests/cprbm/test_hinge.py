"""The rotational hinge against the boundary-value problem of its elastica, contact at a point."""

import re

import numpy as np
import pytest

import cprbm
from cprbm.chain import mechanism_of
from cprbm.paper.contacts import fitted_boundary
from cprbm.paper.fit import fitted
from cprbm_scene import Ending, scene_from
from tests.cprbm.scenes import hinge, hinge_data, turned
from tests.references import hinge as exact

LAST = [{"name": "load", "steps": "M", "stations": [0.67]}]


@pytest.fixture(scope="module")
def truth():
    return exact.solve(exact.PAPER, 0.67)


def solved(links, formulation="auto", **changes):
    answer = cprbm.answer(hinge(**{"stages": LAST, **changes}), cprbm.Settings(links=links, formulation=formulation))
    assert answer.completed, answer.sentence
    return answer


def errors_of(links, truth, formulation="auto"):
    values = solved(links, formulation).stations[-1].values
    return np.array(
        [
            np.hypot(*(values["B.displacement"] - truth.displacement_B)) / np.hypot(*truth.displacement_B),
            np.hypot(*(values["D.displacement"] - truth.displacement_D)) / np.hypot(*truth.displacement_D),
            abs(values["BD.rotation"][0] / truth.rotation - 1.0),
            abs(values["contact.force"][0] / truth.contact_force - 1.0),
            abs(values["scene.potential_energy"][0] / truth.potential_energy - 1.0),
            np.hypot(*(values["A.reaction"] - truth.reaction_A)) / np.hypot(*truth.reaction_A),
            abs(values["A.reaction_moment"][0] / truth.reaction_moment_A - 1.0),
            abs(values["contact.closing_load"][0] / exact.closing_moment(exact.PAPER) - 1.0),
        ]
    )


def test_auto_converges_with_order_four_whatever_the_parity_of_n(truth):
    # reference: tests.references.hinge; 39, 41: the contact falls on a joint; 40: between two
    errors = {n: errors_of(n, truth) for n in (20, 39, 40, 41, 80)}
    assert np.all(np.log2(errors[20] / errors[80]) > 2.0 * 3.5)
    for n in (39, 40, 41):
        assert np.all(errors[n] < 3e-5)


@pytest.mark.parametrize(("links", "within"), [(20, 1e-4), (40, 1e-5)])
def test_the_contact_force_in_shear(links, within):
    """Finite elements in shear: 8.856116 N with 160 elements and 8.856186 N with 320, 8.85621 N in the limit."""
    force = solved(links, theory="shear").stations[-1].values["contact.force"][0]
    assert force == pytest.approx(8.85621, rel=within)


@pytest.mark.parametrize("beam", [1, 2])
def test_auto_stress_everywhere_up_to_the_clamps_and_through_the_kink_at_the_contact(truth, beam):
    # reference: tests.references.hinge
    def error(links):
        values = solved(links).stations[-1].values[f"beam{beam}.bending_stress"]
        exact_stress = truth.bending_stress(beam, np.linspace(0.0, exact.PAPER.length, len(values)))
        return np.max(np.abs(values - exact_stress)) / np.max(np.abs(exact_stress))

    # the moment has a kink at the contact; elsewhere the chain is of fourth order
    assert error(20) < 2e-4
    assert error(40) < 2e-5
    assert error(41) < 2e-5


def test_auto_meets_the_contact_at_its_place(truth):
    answer = solved(40)
    station = answer.stations[-1]
    assert station.values["contact.centre"][0] == pytest.approx(truth.contact_arc_lengths[0], abs=2e-6)
    assert station.touching["contact"].shape == (1, 2)
    assert station.touching["contact"][0] == pytest.approx(truth.contact_point, abs=2e-5)
    assert station.certificate.penetration < 1e-9


def test_paper_converges_to_the_same_truth(truth):
    # reference: tests.references.hinge. Even numbers of links put the contact between two joints, so that
    # the neutral line dips below the boundary by κh²/8 there: an error of order two, much the larger one
    errors = {n: errors_of(n, truth, "paper") for n in (20, 40, 80)}
    for coarse, fine in ((20, 40), (40, 80)):
        assert np.all(errors[coarse] / errors[fine] > 3.0)
    assert np.all(errors[40][:3] < 3e-3)
    assert errors[40][3] < 0.02
    assert errors_of(41, truth, "paper")[3] < 4e-3


def test_paper_needs_three_related_joints():
    with pytest.raises(Exception, match=r"contacts\.contact\.paper\.related\.beam2.*2 related joints"):
        cprbm.answer(hinge(), cprbm.Settings(links=10, formulation="paper"))


def test_paper_degree_is_lowered_to_the_points():
    assert solved(20, "paper").completed  # four related joints carry a cubic


def test_paper_joint_beyond_the_boundary_ends_by_name():
    # beam 2's boundary begins beside the middle, where beam 1 comes to press
    data = hinge_data()
    related = {"beam1": {"x": [0.0198, 0.0322]}, "beam2": {"x": [0.0268, 0.0322]}}
    data["contacts"]["contact"]["paper"]["related"] = related
    data |= {"claims": [], "stages": [{"name": "load", "steps": "M", "stations": [0.2, 0.67]}]}
    answer = cprbm.answer(scene_from(data), cprbm.Settings(formulation="paper"))
    assert answer.ending is Ending.LEFT_BOUNDARY
    assert re.search(
        r"in contact 'contact' joint 2\d of beam1 presses .* m beyond the end of the range", answer.sentence
    )
    assert [station.value for station in answer.stations] == [0.2]


def test_by_how_much_a_polynomial_misses_its_points_is_measured_and_told():
    # reference: beam 2's springs are even on a circle of 25 mm and their offset points on one of 27 mm; a straight line
    # through these, which are the same on either side of the middle, is level
    settings = cprbm.Settings(formulation="paper", degree=1)
    m = mechanism_of(hinge(), {"beam1": 40, "beam2": 40}, "bending", corrected=False)
    phi = np.pi * (1.0 - (np.arange(40) + 0.5) / 40.0)
    phi = phi[np.abs(0.025 * np.cos(phi)) <= 0.00625]
    height = 0.027 * np.sin(phi)
    fit = fitted(np.array(m.rest), fitted_boundary(m, "contact", 1)[0])
    misfit = np.abs(fit.V[0] @ fit.q - fit.points[1]).max() * m.units.length
    assert misfit == pytest.approx(np.max(np.abs(height - height.mean())), rel=1e-9)
    said = [note for note in cprbm.answer(hinge(), settings).notes if "misses the points" in note]
    assert len(said) == 1
    assert "at load" in said[0]
    few = cprbm.answer(hinge(), cprbm.Settings(links=20, formulation="paper"))  # a cubic through four points
    assert not any("misses the points" in note for note in few.notes)


@pytest.mark.parametrize("formulation", ["auto", "paper"])
def test_below_the_first_touch_nothing_presses_and_above_it_one_place(formulation):
    touch = exact.closing_moment(exact.PAPER)
    below, above = 0.93 * touch, 1.08 * touch
    answer = cprbm.answer(
        hinge(stages=[{"name": "load", "steps": "M", "stations": [below, above]}]),
        cprbm.Settings(formulation=formulation),
    )
    first, second = answer.stations
    assert first.values["contact.force"][0] == 0.0
    assert first.values["contact.centre"].size == first.values["contact.closing_load"].size == 0
    assert not first.touching
    assert second.values["contact.force"][0] > 0.0
    (event,) = answer.events
    assert event.contact == "contact"
    assert event.value == pytest.approx(touch, rel=1e-3 if formulation == "auto" else 0.04)


@pytest.mark.parametrize("formulation", ["auto", "paper"])
def test_forces_and_moments_balance(formulation):
    for station in solved(40, formulation, stages=hinge_data()["stages"]).stations:
        assert station.certificate.force_balance < 1e-10
        assert station.certificate.moment_balance < 1e-10
        assert station.certificate.holds


def test_the_way_does_not_matter():
    direct, stepped = solved(40), solved(40, stages=hinge_data()["stages"])
    for name, value in direct.stations[-1].values.items():
        other = stepped.stations[-1].values[name]
        assert other == pytest.approx(value, rel=1e-8, abs=1e-8 * np.max(np.abs(value)))


def test_the_other_sign_is_the_mirror_image():
    there = solved(40)
    back = solved(40, stages=[{"name": "load", "steps": "M", "stations": [-0.67]}])
    one, other = there.stations[-1].values, back.stations[-1].values
    assert other["D.displacement"] * (1.0, -1.0) == pytest.approx(one["B.displacement"], rel=1e-9)
    assert other["contact.force"] == pytest.approx(one["contact.force"], rel=1e-9)
    assert -other["beam2.bending_stress"] == pytest.approx(one["beam1.bending_stress"], rel=1e-7, abs=1.0)


@pytest.mark.parametrize("angle", [np.radians(37.0), np.pi / 2.0])
def test_a_rigid_motion_of_the_scene_changes_nothing(angle):
    data = {**hinge_data(), "claims": [], "stages": LAST}
    one = cprbm.answer(scene_from(data)).stations[-1].values
    other = cprbm.answer(scene_from(turned(data, angle, (0.31, -0.17)))).stations[-1].values
    for name in (
        "BD.rotation",
        "contact.force",
        "contact.centre",
        "A.reaction_moment",
        "beam1.bending_stress",
    ):
        assert other[name] == pytest.approx(one[name], rel=1e-9, abs=1e-9 * np.max(np.abs(one[name])))


@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_units_of_the_modulus_change_nothing(factor):
    data = {**hinge_data(), "claims": [], "stages": LAST}
    one = cprbm.answer(scene_from(data)).stations[-1].values
    data["materials"] = {"abs": {"youngs_modulus": 2.3e9 * factor, "poisson_ratio": 0.35}}
    data["stages"] = [{"name": "load", "steps": "M", "stations": [0.67 * factor]}]
    other = cprbm.answer(scene_from(data)).stations[-1].values
    assert other["BD.rotation"] == pytest.approx(one["BD.rotation"], rel=1e-10)
    assert other["contact.force"] == pytest.approx(one["contact.force"] * factor, rel=1e-9)


def test_contact_named_the_other_way_round():
    contacts = {"contact": {"kind": "beam-beam", "between": ["beam2", "beam1"]}}
    one, other = solved(40).stations[-1].values, solved(40, contacts=contacts).stations[-1].values
    assert other["contact.force"] == pytest.approx(one["contact.force"], rel=1e-9)
    assert other["BD.rotation"] == pytest.approx(one["BD.rotation"], rel=1e-9)


def test_a_load_far_beyond_completes_certified_or_ends_by_name():
    answer = cprbm.answer(hinge(stages=[{"name": "load", "steps": "M", "stations": [0.67, 67.0, 6700.0]}]))
    assert answer.stations[0].value == 0.67
    for station in answer.stations:
        assert station.certificate.holds
        assert all(np.all(np.isfinite(value)) for value in station.values.values())
    assert answer.completed or answer.ending.value in answer.sentence


@pytest.mark.parametrize(
    ("links", "key"),
    [
        (0, "settings.links.beam1"),
        (1, "settings.links.beam2"),
        ({"beam1": 30}, "beam2"),
        ({"beam1": 9, "beam2": 9, "x": 9}, "links.x"),
    ],
)
def test_links_that_do_not_fit_are_refused(links, key):
    from cprbm_scene import SceneError

    with pytest.raises(SceneError, match=key):
        cprbm.answer(hinge(), cprbm.Settings(links=links))


def test_beams_may_have_links_of_their_own(truth):
    values = solved({"beam1": 46, "beam2": 31}).stations[-1].values
    assert values["BD.rotation"][0] == pytest.approx(truth.rotation, rel=2e-3)


def test_a_fitted_boundary_leaves_a_moment_and_the_answer_says_so():
    notes = cprbm.answer(hinge(), cprbm.Settings(formulation="paper")).notes
    (left,) = [float(found[1]) for note in notes if (found := re.search(r"leave a moment of (\S+) of", note))]
    assert 1e-12 < left < 1e-2


def test_a_contact_that_never_closes_is_named():
    answer = cprbm.answer(hinge(stages=[{"name": "load", "steps": "M", "stations": [0.1]}]))
    assert answer.notes == ("contact 'contact' never closed at a station",)
