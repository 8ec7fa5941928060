"""With shear, an arc that is held on a straight edge and pressed down on it: the line leans, the section does not.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
θ       rotation of a section, EI = 1: M = θ' − κ⁰
γ       angle of shear, Q/GA: the line has the angle θ + γ
F       force down at the tip, which has no moment and slides
c       as far as the arc lies on the edge
λ       √(GA/EI): 1/λ is half a thickness
======  =====================================================================================

On the edge the line is level, γ = −θ, so that Q = −GA θ and, from M' = −Q, θ'' = λ² θ: the pressure GA θ' falls off
from c within 1/λ.  At c, θ = F/GA, and behind it the beam is free.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, fsolve

from cprbm_scene import Ending
from tests.fea_reference.test_faces import KAPPA, on_its_pin, peeled
from tests.references.integrated import end_of

STOUT = 0.07
QUANTITIES = ("scene.potential_energy", "link.reaction_moment", "edge.moment", "edge.force")


def stiffness(thickness):
    """GA and EA where EI is one."""
    return 5.0 / 6.0 * 12.0 / (2.0 * 1.3 * thickness**2), 12.0 / thickness**2


def free(force, length, theta, moment, thickness):
    """A free part that begins at the origin: x, y, θ, M and the energy at its end."""
    GA, EA = stiffness(thickness)

    def slope(_, v):
        theta, M = v[2:4]
        cos, sin = math.cos(theta), math.sin(theta)
        Q, N = -force * cos, -force * sin
        x, y = (1.0 + N / EA) * cos - Q / GA * sin, (1.0 + N / EA) * sin + Q / GA * cos
        return [x, y, KAPPA + M, force * x, 0.5 * (M**2 + Q**2 / GA + N**2 / EA)]

    return end_of(slope, (0.0, length), [0, 0, theta, moment, 0], rtol=1e-13, atol=1e-14)


def height(drop):
    return (1.0 - math.cos(KAPPA)) / KAPPA - drop


def far_peeled(drop, thickness):
    """Where c is many 1/λ: energy, moment of the edge about the joint, and F; the pressure's tail is e^(−λc)."""
    GA, _ = stiffness(thickness)
    lam = math.sqrt(GA)

    def part(force, length):
        return free(force, length, force / GA, force / lam - KAPPA, thickness)

    def unflat(force):
        return brentq(lambda length: part(force, length)[3], 1e-6, 1.5 * KAPPA / force, xtol=1e-15)

    force = brentq(lambda F: part(F, unflat(F))[1] - height(drop), 1.2 * KAPPA, 20.0 * KAPPA, xtol=1e-13)
    length = unflat(force)
    x, _, _, _, energy = part(force, length)
    theta, c = force / GA, 1.0 - length
    on_edge = 0.5 * KAPPA**2 * c - KAPPA * theta + 0.5 * lam * theta**2
    return energy + on_edge, force * (c + x), force


def clamped(drop, thickness):
    """Where the edge does not press: energy, and the moment of the joint."""

    def missed(guess):
        _, y, _, M, _ = free(guess[0], 1.0, 0.0, guess[1], thickness)
        return [M, y - height(drop)]

    (force, moment), _, flag, _ = fsolve(missed, [0.9, -0.9], full_output=True, xtol=1e-13)
    assert flag == 1
    return free(force, 1.0, 0.0, moment, thickness)[4], -moment


def near_peeled(drop, thickness):
    """Where c is of the order of 1/λ, and the section is level at the joint, θ ∝ sinh λs: energy and moment."""
    GA, _ = stiffness(thickness)
    lam = math.sqrt(GA)

    def part(force, reach):
        return free(force, 1.0 - reach / lam, force / GA, lam * force / GA / math.tanh(reach) - KAPPA, thickness)

    def missed(guess):
        at = part(*guess)
        return [at[3], at[1] - height(drop)]

    (force, reach), _, flag, _ = fsolve(missed, [1.0, 0.5], full_output=True, xtol=1e-12)
    assert flag == 1
    x, _, _, _, energy = part(force, reach)
    theta, c = force / GA, reach / lam
    on_edge = 0.5 * KAPPA**2 * c - KAPPA * theta + 0.5 * lam * theta**2 / math.tanh(reach)
    return energy + on_edge, force * (c + x)


def found(drop, elements, *, thickness=STOUT, joint="pin", thick=False):
    _, answered = on_its_pin(
        elements=elements, kinematics="shear", drop=drop, thickness=thickness, joint=joint, thick=thick
    )
    assert answered.ending is Ending.COMPLETED, answered.sentence
    return [float(answered.stations[-1].values[quantity][0]) for quantity in QUANTITIES]


def test_a_stout_beam_peels_off_as_its_closed_form_does():
    energy, moment, force = far_peeled(0.4, STOUT)
    errors = np.array([found(0.4, elements) for elements in (20, 40, 80)]) / [energy, moment, moment, force] - 1.0
    assert np.log2(errors[0, 0] / errors[-1, 0]) / 2.0 > 1.7
    assert errors[-1] == pytest.approx(np.zeros(4), abs=1e-4)


def test_with_less_shear_it_peels_off_as_in_bending():
    # what shear and stretch make goes with the square of the thickness
    force, _, tip, strain = peeled(0.4, KAPPA)
    bending = np.array([strain, force * tip[0], force * tip[0], force])
    stout, thin = (np.array(found(0.4, 80, thickness=t)) / bending - 1.0 for t in (STOUT, STOUT / 3.0))
    assert np.all(stout < -2e-3)
    assert thin == pytest.approx(stout / 9.0, abs=2e-4)


@pytest.mark.parametrize("thick", [False, True])
def test_where_the_line_leans_into_the_edge_beside_a_section_that_lifts_it_off_the_joint_holds_it(thick):
    energy, moment = clamped(0.26, STOUT)
    values = np.array([found(0.26, elements, thick=thick) for elements in (10, 20, 40, 80, 160)])
    assert np.all(values[:, 3] == 0.0)
    errors = np.abs(values[:, :2] / [energy, moment] - 1.0)
    assert np.all(errors[0] < 1e-4)
    assert np.all(errors[-1] < 2e-6)
    # what the edge would do there has no arm
    assert values[-1, :2] == pytest.approx(near_peeled(0.26, STOUT), rel=1e-4)


def test_between_both_nothing_depends_on_the_mesh():
    values = np.array([found(0.28, elements) for elements in (40, 80, 160)])
    assert values[:, :3] == pytest.approx(np.tile(values[-1, :3], (3, 1)), rel=5e-5)
    assert values[1, 3] == pytest.approx(values[-1, 3], rel=0.05)
    assert values[-1, :2] == pytest.approx(near_peeled(0.28, STOUT), rel=1e-4)


@pytest.mark.parametrize("drop", [0.26, 0.4])
def test_a_weld_holds_the_section_as_the_stop_does(drop):
    pinned, welded = found(drop, 40), found(drop, 40, joint="weld")
    assert [welded[0], welded[1], welded[3]] == pytest.approx([pinned[0], pinned[1], pinned[3]], rel=1e-6, abs=1e-12)
