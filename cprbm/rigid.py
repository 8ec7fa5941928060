"""The paper's contact with a fixed boundary, eq. (11) with g_m, where that is a circle.

==========  =======================================================================
p_j, o      a related joint of the beam; the circle's centre
R           r + t/2, radius of g_m, with the thickness of the place; r for a line
ρ_j, n_j    |p_j − o| and (p_j − o)/ρ_j
c_j         R − ρ_j ≤ 0
t_j         (n_y, −n_x); t_j t_jᵀ/ρ_j is the derivative of n_j over p_j
==========  =======================================================================

Departure from eq. (11): the paper writes c_j = ±(g_m(x_j) − y_j).  Where g_m is defined and the joint is on its side
of the centre, both say that the joint is outside of the circle: the feasible set is the same, so is its minimum, and
so are the forces λ_j ∇c_j, each of which is the one force along n_j that balances the joint (the multipliers differ
by |∇c_j|, which is one here).  The distance is defined everywhere, also beside the circle, where g_m is not and its
slope on the way there grows beyond all bounds.

Where the beam is clamped on the circle, the first spring cannot move, and is h²/8R away from it.  The beam comes down
to the circle over a length ~ √h, whose pressure the clamp carries: shape and energy converge with h², the clamp's
moment with h, how clamp and circle share the force with √h only.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.first_contact import Factored, Group, Local
from cprbm.kinematics import Positions, State
from cprbm.model import Model
from cprbm.once import once
from cprbm.related import related_joints
from cprbm_scene import CircleContact, Scene
from cprbm_scene.answer import Array, Ints


@dataclass(frozen=True, eq=False)
class RigidCircle:
    """One contact with a circle in the paper's form.

    Attributes:
        name: of the contact.
        joints: the related joints (m,); arc: their arc lengths.
        mark: number of the circle's centre among the joints where it is on a body that moves, else −1.
        center: of the circle at rest; units of length.
        radius: R for each of the joints (m,); units of length.
    """

    name: str
    joints: Ints
    arc: Array
    mark: int
    center: tuple[float, float]
    radius: Array

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives."""
        moves = self.mark >= 0
        ox, oy = (at.x[self.mark], at.y[self.mark]) if moves else self.center
        rx, ry = at.x[self.joints] - ox, at.y[self.joints] - oy
        rho = np.hypot(rx, ry)
        nx, ny = rx / rho, ry / rho

        def factors(multipliers: Array) -> Factored:
            pressing = multipliers.nonzero()[0]
            columns = Local(joints[pressing], angles[pressing], self._over(ny[pressing], -nx[pressing]))
            return Factored(columns, -multipliers[pressing] / rho[pressing])

        joints, angles = self._local
        return (
            Group(
                contact=self.name,
                values=self.radius - rho,
                joints=joints,
                angles=angles,
                slopes=self._over(-nx, -ny),
                curvature=lambda lam: factors(lam).blocks(),
                keys=self._keys,
                arc=self.arc,
                factors=factors,
            ),
        )

    def _over(self, x: Array, y: Array) -> Array:
        """What is ``x`` and ``y`` (k,) over p − o, over x of joint and centre, then y: (k, 4), or (k, 2)."""
        return np.stack((x, -x, y, -y) if self.mark >= 0 else (x, y), axis=1)

    @once
    def _local(self) -> tuple[Ints, Ints]:
        """Joints and angles of each row, (m, 2) or (m, 1), and (m, 0)."""
        m = len(self.joints)
        joints = (self.joints, np.full(m, self.mark)) if self.mark >= 0 else (self.joints,)
        return np.stack(joints, axis=1), np.zeros((m, 0), dtype=np.intp)

    @once
    def _keys(self) -> tuple[int, ...]:
        return tuple(self.joints.tolist())


def rigid_circle(scene: Scene, model: Model, name: str) -> RigidCircle:
    """One of the scene's contacts with a circle in the paper's form.

    Raises:
        SceneError: it has no related joint.
    """
    contact = scene.contacts[name]
    assert isinstance(contact, CircleContact)
    chain, unit = model.chain(contact.beam), model.unit_length
    joints = related_joints(scene, name, chain, fewest=1)
    x, y = contact.center
    half = 0.5 * chain.section.thickness_at(chain.s[joints]) if contact.thick else np.zeros(len(joints))
    return RigidCircle(
        name=name,
        joints=chain.first_joint + joints,
        arc=chain.s[joints],
        mark=model.mark_of(name),
        center=(x / unit, y / unit),
        radius=contact.radius / unit + half,
    )
