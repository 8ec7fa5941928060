"""A contact's gradient and tangent beside central differences of what it stores."""

import numpy as np
import pytest

STEP = 1e-7


def check(model, gathered, z, *, times, rel, tangent):
    """Along random motions of the nodes and axial forces of the elements.

    ``gathered`` yields a potential, its gradient and its tangent at z; ``rel`` is asked of the gradient, ``tangent`` of
    the largest of its change.
    """
    _, gradient, hessian = gathered(z)[:3]
    rng = np.random.default_rng(7)
    for _ in range(times):
        v = np.zeros(model.size)
        v[model.node_dofs] = rng.standard_normal(model.node_dofs.shape)
        v[model.element_dofs[6]] = rng.standard_normal(model.element_dofs.shape[1])
        ahead, behind = gathered(z + STEP * v), gathered(z - STEP * v)
        assert gradient @ v == pytest.approx((ahead[0] - behind[0]) / (2 * STEP), rel=rel)
        slope = (ahead[1] - behind[1]) / (2 * STEP)
        assert hessian @ v == pytest.approx(slope, abs=tangent * np.abs(slope).max())
