"""The energy of a beam that lies on its own end, and beyond the end, by differences."""

from dataclasses import replace

import numpy as np
import pytest

from fea_reference import Settings
from fea_reference.contact import self_contacts, touch
from fea_reference.contacts import zones_of
from fea_reference.model import build
from fea_reference.state import State
from fea_reference.touch import Penalty
from tests.fea_reference.differences import check
from tests.fea_reference.hooked import hook

ACROSS, ALONG = np.radians(27.0), np.radians(67.0)
EVEN, TAPERED = (0.0011, 0.0011), (0.0007, 0.0014)


def closed(lean, thickness, *, backwards):
    """Pressed a hundredth of the beam's length into itself, and out of shape."""
    model = build(hook(lean, thickness, [0.0091], backwards=backwards), Settings(elements=27, kinematics="bending"))
    rng = np.random.default_rng(11)
    z = model.start.values.copy()
    z[model.node_dofs] += 0.002 * rng.standard_normal(model.node_dofs.shape)
    z[model.element_dofs[6]] = rng.standard_normal(model.element_dofs.shape[1])
    (pair,) = self_contacts(hook(lean, thickness, [0.0091], backwards=backwards), model)
    return model, replace(pair, distance=pair.distance + zones_of(model, pair, State.of(z)).least + 0.01), z


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("thickness", [EVEN, TAPERED])
@pytest.mark.parametrize("lean", [ACROSS, ALONG])
def test_the_contacts_derivatives(lean, thickness, backwards):
    model, pair, z = closed(lean, thickness, backwards=backwards)
    end = 27.0 if backwards else 0.0

    def gathered(z):
        one = touch(model, pair, Penalty(1.0), 12, State.of(z))
        gradient, hessian = np.zeros(model.size), np.zeros((model.size, model.size))
        for dofs, g, H in zip(one.dofs.T, one.gradient.T, one.hessian(one.pushes).T, strict=True):
            np.add.at(gradient, dofs, g)
            np.add.at(hessian, np.ix_(dofs, dofs), H)
        return 0.5 * float((one.stiffness * one.gap**2).sum()), gradient, hessian

    on_end = touch(model, pair, Penalty(1.0), 12, State.of(z)).zeta_m == end
    assert on_end.any()
    assert on_end.all() == (lean == ACROSS)  # else a part of it lies beside the end
    value, _, hessian = gathered(z)
    assert value > 0.0
    assert hessian == pytest.approx(hessian.T, abs=1e-12 * np.abs(hessian).max())
    check(model, gathered, z, times=3, rel=1e-5, tangent=1e-4)
