"""With which power of the element's length each number's error falls.

The element's own power is four without stretch and shear, and two with shear, which is even over each element.  A
contact keeps it where the force acts at a node and the penetration asked falls in step.
"""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from cprbm_scene import Ending, read
from fea_reference import Settings, answer
from tests.references import hinge as exact
from tests.references.wrapped import Wrapped

CASES = Path(__file__).parents[2] / "comparisons" / "cases"
OPEN, TOUCHING = 0.268, 0.67  # N·m: below the closing moment and above


def values(case, load, elements, kinematics="bending", penetration=1e-4):
    scene = read(CASES / f"{case}.toml")
    stage = scene.stages[0].model_copy(update={"stations": (load,)})
    got = answer(
        scene.model_copy(update={"stages": (stage,)}),
        Settings(elements=elements, kinematics=kinematics, penetration=penetration),
    )
    assert got.ending is Ending.COMPLETED, got.sentence
    return got.stations[-1].values


def hinge_errors(moment, elements, penetration=1e-4):
    """Of every probe but the stresses, each over its size."""
    truth = exact.solve(exact.PAPER, moment)
    true = {
        "B.displacement": truth.displacement_B,
        "D.displacement": truth.displacement_D,
        "BD.rotation": truth.rotation,
        "A.reaction": truth.reaction_A,
        "C.reaction": truth.reaction_C,
        "A.reaction_moment": truth.reaction_moment_A,
        "C.reaction_moment": truth.reaction_moment_C,
        "scene.potential_energy": truth.potential_energy,
    }
    if truth.contact_force:
        true |= {"contact.force": truth.contact_force, "contact.closing_load": exact.closing_moment(exact.PAPER)}
    found = values("hinge", moment, elements, penetration=penetration)
    return {probe: np.linalg.norm(found[probe] - number) / np.linalg.norm(number) for probe, number in true.items()}


def test_without_contact_every_error_falls_with_the_fourth_power():
    # reference: tests.references.hinge
    coarse, fine = (hinge_errors(OPEN, n) for n in (20, 40))
    for probe, error in coarse.items():
        assert np.log2(error / fine[probe]) == pytest.approx(4.0, abs=0.1), probe


def test_a_contact_in_a_point_at_a_node_keeps_the_fourth_power_as_the_penetration_falls_with_it():
    # reference: tests.references.hinge
    coarse, fine = (hinge_errors(TOUCHING, n, 1e-4 * (40 / n) ** 4) for n in (40, 80))
    for probe, error in coarse.items():
        assert np.log2(error / fine[probe]) == pytest.approx(4.0, abs=0.3), probe


def test_with_shear_every_error_falls_with_the_second_power():
    # changes from each number of elements to the next, as there is no exact answer
    found = [values("hinge", OPEN, n, "shear") for n in (80, 160, 320)]
    for probe in ("B.displacement", "D.displacement", "BD.rotation", "A.reaction", "C.reaction_moment"):
        one, other = (np.linalg.norm(b[probe] - a[probe]) for a, b in pairwise(found))
        assert np.log2(one / other) == pytest.approx(2.0, abs=0.15), probe


def test_orders_on_a_wrap():
    """Along a zone the pressure bends the beam within elements that do not end where it does: energy of third order,
    tip of second.  Reference: tests.references.wrapped.
    """
    truth = Wrapped(length=0.0973, radius=0.0711, thickness=0.00103, width=0.0097, youngs_modulus=2.07e11, force=137.0)
    errors = []
    for n in (20, 160):
        found = values("wrapped", 137.0, n)
        errors.append(
            [
                np.linalg.norm(found["T.displacement"] - truth.displacement) / np.linalg.norm(truth.displacement),
                abs(found["scene.potential_energy"][0] / truth.potential_energy - 1.0),
                abs(found["contact.ends"][1] / truth.wrap_length - 1.0),
            ]
        )
    tip, energy, end = np.log2(np.array(errors[0]) / errors[1]) / 3.0
    assert tip > 1.8
    assert energy > 2.8
    assert end > 2.0


def test_a_contact_in_a_point_is_no_zone_where_the_gap_opens_less_and_less_on_one_side():
    # closed form: at a point the zone begins and ends where the resultant acts (cprbm_scene.answer). Beam 1 of the
    # gripper parts from beam 2 most sharply at the place itself
    found = values("gripper", 9.6, 40)
    assert found["contact.ends"] == pytest.approx(np.repeat(found["contact.centre"], 2), abs=1e-12)
