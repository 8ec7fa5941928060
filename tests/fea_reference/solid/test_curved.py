"""A curved bar that hardly moves, beside plane elasticity: what a straight beam's theory misses in it."""

import numpy as np
import pytest

from fea_reference import solid
from tests.fea_reference.solid.bars import WIDTH, YOUNG, bar, quarter
from tests.references.curved_bar import flexibility, tip_motion

R, THICKNESS = 0.11, 0.013
TIP = (("tip", "displacement"), ("block", "rotation"))


@pytest.mark.parametrize("load", ["force", "moment"])
@pytest.mark.parametrize("poisson", [0.0, 0.35])
def test_a_curved_bar_is_that_of_plane_elasticity(load, poisson):
    # both faces are held, which at ν = 0 changes nothing of a bar in bending, and of shear by a part of t/L; at
    # ν = 0.35 each takes 0.0073 t off the length that turns (a strip that is held at one end), beside what it moves
    amount = 1e-4
    pull, turn = {"kind": "force", "point": "tip", "direction": [1.0, 0.0]}, {"kind": "moment", "body": "block"}
    kind = pull if load == "force" else turn
    scene = bar(quarter(R), THICKNESS, poisson=poisson, load=kind, stations=(amount,), probes=TIP)
    found = solid.answer(scene, solid.Settings(elements=30, across=4))
    assert found.completed, found.sentence
    values = found.stations[0].values
    ours = np.array([*values["tip.displacement"], values["block.rotation"].item() * R]) / amount
    F = flexibility(R - THICKNESS / 2, R + THICKNESS / 2, WIDTH, np.pi / 2, YOUNG, poisson)
    exact = tip_motion(F, (0.0, R), *(((1.0, 0.0), 0.0) if load == "force" else ((0.0, 0.0), 1.0))) * (1.0, 1.0, R)
    off = np.abs(ours - exact).max() / np.abs(exact).max()
    assert off < (2e-4 if poisson == 0.0 else 2.5e-3)
    if poisson == 0.0:  # and the reference tells them apart: a straight beam's theory is farther off
        straight = straight_beam(poisson, load)
        assert np.abs(straight - exact).max() / np.abs(exact).max() > 3.0 * off


def straight_beam(poisson, load):
    """The same by the flexibility of a line that bends, stretches and shears (κ = 5/6), by quadrature."""
    x, w = np.polynomial.legendre.leggauss(40)
    angle, ds = np.pi / 4 * (x + 1.0), np.pi / 4 * w * R
    area, inertia = WIDTH * THICKNESS, WIDTH * THICKNESS**3 / 12
    arm = np.stack([-R * np.cos(angle), R - R * np.sin(angle)])  # from the section to the tip
    N, V, M = np.zeros((3, 40)), np.zeros((3, 40)), np.zeros((3, 40))
    N[0], N[1], V[0], V[1] = -np.sin(angle), np.cos(angle), np.cos(angle), np.sin(angle)
    M[0], M[1], M[2] = -arm[1], arm[0], 1.0
    shear = 5 / 6 * YOUNG / (2 * (1 + poisson)) * area
    F = sum((k * ds) @ k.T / c for k, c in ((N, YOUNG * area), (V, shear), (M, YOUNG * inertia)))
    return F @ ([1.0, 0.0, 0.0] if load == "force" else [0.0, 0.0, 1.0]) * (1.0, 1.0, R)
