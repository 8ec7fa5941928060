"""What depends on positions of joints and on angles, as rows over the unknowns.

==========  ==========================================================================
s_r         slopes of row r over x and y of some joints and over some angles
F_i         Σ s_r over the joints of the same beam beyond link i
==========  ==========================================================================

As ∂x_j/∂θ_i = −L_i sin θ_i and ∂y_j/∂θ_i = L_i cos θ_i for every joint j beyond link i, row r over θ_i is
dx_i F_y − dy_i F_x: no row needs the derivatives of the single joints.
"""

from __future__ import annotations

import numpy as np

from cprbm.kinematics import Positions, State, arm
from cprbm.model import Model
from scene.answer import Array, Ints


def over_unknowns(model: Model, state: State, at: Positions, joints: Ints, angles: Ints, slopes: Array) -> Array:
    """Rows over all unknowns (r, n_links + 3B).

    Args:
        model, state, at: where.
        joints: whose x and y a row depends on, (r, p).
        angles: on which of the unknowns' angles it depends besides, (r, a).
        slopes: over x of the joints, y of the joints, and the angles, (r, 2p + a).
    """
    r, p = joints.shape
    n, J = model.n_links, model.n_joints
    found = np.zeros((r, model.n_unknowns))
    number = np.arange(r)[:, None]
    if p:
        flat = (joints + J * number).ravel()
        fx = np.asarray(np.bincount(flat, slopes[:, :p].ravel(), r * J), dtype=float).reshape(r, J)
        fy = np.asarray(np.bincount(flat, slopes[:, p : 2 * p].ravel(), r * J), dtype=float).reshape(r, J)
        beyond_x, beyond_y = np.empty((r, n)), np.empty((r, n))
        for chain in model.chains:
            first, last = chain.first_joint, chain.first_joint + chain.n + 1
            links = slice(chain.first_link, chain.first_link + chain.n + 1)
            np.cumsum(fx[:, last:first:-1], axis=1, out=beyond_x[:, links][:, ::-1])
            np.cumsum(fy[:, last:first:-1], axis=1, out=beyond_y[:, links][:, ::-1])
            body = chain.start.body
            if body >= 0:
                tx = beyond_x[:, links.start] + fx[:, first]
                ty = beyond_y[:, links.start] + fy[:, first]
                _on_body(found[:, n + 3 * body : n + 3 * body + 3], tx, ty, arm(chain.start, state.bodies))
        np.subtract(at.dx * beyond_y, at.dy * beyond_x, out=found[:, :n])
        for j, mark in enumerate(model.marks.values(), start=model.first_mark):
            own = found[:, n + 3 * mark.body : n + 3 * mark.body + 3]
            _on_body(own, fx[:, j], fy[:, j], arm(mark, state.bodies))
    if angles.shape[1]:
        flat = (angles + model.n_unknowns * number).ravel()
        found += np.bincount(flat, slopes[:, 2 * p :].ravel(), found.size).reshape(found.shape)
    return found


def _on_body(columns: Array, fx: Array, fy: Array, lever: tuple[float, float]) -> None:
    """Add what slopes (r,) over a point of a body, at a ``lever`` from its reference place, are over u, v, φ."""
    columns[:, 0] += fx
    columns[:, 1] += fy
    columns[:, 2] += lever[0] * fy - lever[1] * fx
