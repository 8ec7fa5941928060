"""The five-bar in the paper's own form: first order where only a pin's neighbour presses, and left at the fit's end."""

import pytest

import cprbm
import fea_reference
from comparisons import cases
from cprbm.chain import mechanism_of
from cprbm.paper.contacts import related_joints
from cprbm_scene import Ending, Probe

JOINTS = {"contact": {"beam1": (8, 26), "beam2": (11, 28)}, "link1": {"beam1": (31, 40)}, "link2": {"beam2": (31, 40)}}


@pytest.fixture(scope="module")
def scene():
    """The case, asked for the forces on the link too, of which it knows better than to ask."""
    case = cases.opened("five-bar")
    forces = tuple(Probe(of=name, quantity="force") for name in ("link1", "link2"))
    return case.model_copy(update={"probes": (*case.probes, *forces)})


def in_paper(scene, links):
    return cprbm.answer(scene, cprbm.Settings(links=links, formulation="paper"))


def test_the_ranges_name_the_papers_joints(scene):
    # section 3.5: the joints in the paper's words, at its 40 elements
    m = mechanism_of(scene, {"beam1": 40, "beam2": 40}, scene.theory, corrected=False)
    for contact, beams in JOINTS.items():
        for beam, (first, last) in beams.items():
            found = related_joints(m, contact, beam, fewest=1)
            assert (found[0], found[-1], len(found)) == (first, last, last - first + 1)


def test_energy_and_input_moments_are_of_first_order_and_the_force_on_bc_grows(scene):
    # reference: finite elements. In the first stage beam 2 presses on BC beside its own pin, and nothing else touches
    first = scene.model_copy(update={"stages": scene.stages[:1]})
    truth = fea_reference.answer(first, fea_reference.Settings(elements=40, kinematics="bending")).stations[-1].values
    assert truth["contact.force"][0] == truth["link1.force"][0] == 0.0
    found = {n: in_paper(first, n).stations[-1].values for n in (20, 40, 80)}
    for probe in ("scene.potential_energy", "OA.reaction_moment", "CD.reaction_moment"):
        off = {n: abs(values[probe][0] - truth[probe][0]) for n, values in found.items()}
        assert off[20] > 0.3 * abs(truth[probe][0])
        assert 1.7 < off[20] / off[40] < 2.1
        assert 1.8 < off[40] / off[80] < 2.1
    force = {n: values["link2.force"][0] for n, values in found.items()}
    assert force[40] > 1.9 * force[20]
    assert force[80] > 1.9 * force[40]


def test_the_fitted_polynomial_is_left_behind_120_degrees_and_the_answer_says_so(scene):
    answer = in_paper(scene, 40)
    assert answer.ending is Ending.LEFT_BOUNDARY
    assert "joint 11 of beam2 presses" in answer.sentence
    assert [len(stage.stations) for stage in scene.stages] == [1, 9]
    assert len(answer.stations) == 1 + 7  # 90 to 120 degrees
    assert sum("next to the beam's own pin" in note for note in answer.notes) == 2
