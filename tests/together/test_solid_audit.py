"""The audit of the solid: right answers pass, every planted fault is named.

Faults are planted in an answer that holds, or it is held against a scene that differs in one thing.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from comparisons.archive import packed, unpacked
from comparisons.audit import audit, audited
from comparisons.audit.edges import nearest, within
from comparisons.cases import opened
from cprbm_scene.answer import frozen_array
from fea_reference import solid
from tests.fea_reference.solid.bars import YOUNG, bar, quarter, straight
from tests.together.test_audit import last, missing_reaction, moved_body, one_sided, saying, scaled_moment, turned_force

THIN = solid.Settings(elements=20, across=1)


@pytest.fixture(scope="module")
def hinge():
    scene = opened("hinge")
    stage = scene.stages[0].model_copy(update={"stations": (0.11, 0.53), "shown": ()})
    return scene.model_copy(update={"stages": (stage,), "claims": ()})


@pytest.fixture(scope="module")
def answer(hinge):
    return solid.answer(hinge, THIN)


def leaning(poisson=0.35, height=-0.02, radius=0.04):
    """A cantilever that is pushed down onto a round support."""
    support = {
        "kind": "beam-circle",
        "beam": "beam",
        "body": "ground",
        "center": [0.2, height - radius],
        "radius": radius,
    }
    load = {"kind": "force", "point": "tip", "direction": [0.0, -1.0]}
    probes = (("tip", "displacement"), ("support", "force"), ("root", "reaction"), ("scene", "potential_energy"))
    contacts = {"support": support}
    return bar(
        straight(0.31), 0.017, poisson=poisson, load=load, stations=(3.1, 41.0), probes=probes, contacts=contacts
    )


@pytest.fixture(scope="module")
def on_a_circle():
    return solid.answer(leaning(), solid.Settings(elements=31, across=1))


def test_right_answers_pass(hinge, answer, on_a_circle):
    for scene, one in ((hinge, answer), (leaning(), on_a_circle)):
        assert one.completed, one.sentence
        found = audit(scene, one)
        assert found.complaints == ()
        assert found.stations == 2
        assert found.scaled < 1e-8
    assert on_a_circle.stations[-1].touching


def test_what_an_archive_keeps_is_audited_as_well(hinge, answer):
    assert audited(hinge, unpacked(packed(answer))) == ()


def area(of, beam, **changes):
    inside = of.inside[beam]
    return {**of.inside, beam: replace(inside, **{key: frozen_array(value) for key, value in changes.items()})}


def moved_node(found):
    of = found.stations[-1].statics
    y = of.inside["beam1"].y.copy()
    y[7, 0] += 1e-6
    return last(found, inside=area(of, "beam1", y=y))


def inside_out(found):
    """Two nodes of one element in each other's place."""
    of = found.stations[-1].statics
    x, y = (each.copy() for each in (of.inside["beam2"].x, of.inside["beam2"].y))
    for each in (x, y):
        each[[10, 12], 2] = each[[12, 10], 2]
    return last(found, inside=area(of, "beam2", x=x, y=y))


def sunk(found):
    """One beam moved into the other by three hundredths of its thickness."""
    of = found.stations[-1].statics
    mine = np.array([by == "contact" and on == "beam1" for by, on in zip(of.by, of.on, strict=True)])
    way = of.forces[mine].sum(axis=0)
    dx, dy = -0.03 * 1e-3 * way / np.hypot(*way)
    inside = of.inside["beam1"]
    return last(found, inside=area(of, "beam1", x=inside.x + dx, y=inside.y + dy))


def elsewhere(found):
    of = found.stations[-1].statics
    here = np.array([by == "contact" for by in of.by])
    return last(found, s=frozen_array(of.s - 0.013 * here), places=frozen_array(of.places + 0.013 * here[:, None]))


def leaning_force(found):
    """A contact that drags: its force is turned about where it acts, on both beams."""
    of = found.stations[-1].statics
    turn = np.exp(0.3j * np.array([by == "contact" for by in of.by]))
    forces = (of.forces @ (1.0, 1j)) * turn
    return last(found, forces=frozen_array(np.stack((forces.real, forces.imag), axis=1)))


FAULTS = {
    "a contact that pulls": (turned_force, "across a gap"),  # as if it pushed the other edge
    "a contact that drags": (leaning_force, "rubs"),
    "action without reaction": (one_sided, "action and reaction"),
    "a missing reaction": (missing_reaction, "ΣF of beam1"),
    "a scaled moment": (scaled_moment, "ΣM of"),
    "a force elsewhere": (elsewhere, "from its edge"),
    "a moved node": (moved_node, "bears"),
    "a node off its balance": (moved_node, "is left with"),
    "an element inside out": (inside_out, "inside out"),
    "a beam within the other": (sunk, "overlap"),
    "a moved body": (moved_body, "away from"),
    "a wrong energy": (lambda found: saying(found, "scene.potential_energy", 1.0003), "scene.potential_energy says"),
    "a wrong force": (lambda found: saying(found, "contact.force", 1.0003), "contact.force says"),
    "a wrong reaction": (lambda found: saying(found, "A.reaction", 1.0003), "A.reaction says"),
    "a wrong displacement": (lambda found: saying(found, "B.displacement", 1.0003), "B.displacement says"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_named(hinge, answer, fault):
    plant, words = FAULTS[fault]
    said = audited(hinge, plant(answer))
    assert any(words in sentence for sentence in said), said


def test_an_answer_to_another_scene_is_none(on_a_circle):
    said = audited(leaning(poisson=0.31), on_a_circle)
    assert any("bears" in each for each in said), said
    said = audited(leaning(radius=0.0412, height=-0.0195), on_a_circle)
    assert any("overlap" in each for each in said), said
    said = audited(leaning(height=-0.0205), on_a_circle)
    assert any("across a gap" in each for each in said), said


def of_arc(*stations, young=YOUNG):
    turn = {"kind": "moment", "body": "block"}
    scene = bar(quarter(0.11), 0.013, load=turn, stations=stations, probes=(("block", "rotation"),))
    material = scene.materials["m"].model_copy(update={"youngs_modulus": young})
    return scene.model_copy(update={"materials": {"m": material}})


def test_a_state_of_a_softer_material_is_no_equilibrium_and_loses_energy():
    # the second station is another material's, whose forces balance as well
    stations = (0.7, 0.71)
    whole, softer = (solid.answer(of_arc(*stations, young=young), THIN) for young in (YOUNG, 0.83 * YOUNG))
    assert audited(of_arc(*stations), whole) == ()
    said = audited(of_arc(*stations), replace(whole, stations=(whole.stations[0], softer.stations[1])))
    assert any("bears" in each for each in said), said
    assert any("more than the work" in each for each in said), said


def test_places_within_and_beside_a_triangle():
    # distances by hand: to the side y = 0, to the corner at 3 + 0j, to the slanting side x + y = 3
    line = np.array([0.0, 3.0, 3.0j, 0.0], dtype=complex)
    places = np.array([0.9 + 0.4j, 3.3 - 0.4j, 2.0 + 2.0j, -0.2 + 1.1j])
    assert within(places, line).tolist() == [True, False, False, False]
    assert nearest(places, line)[0] == pytest.approx([0.4, 0.5, 1.0 / np.sqrt(2.0), 0.2])
