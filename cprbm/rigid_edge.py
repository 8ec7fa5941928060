"""The paper's contact with a fixed or a moving boundary, eq. (11) with g_m, where that is a rigid edge.

==========  ===================================================================================
p_j         a related joint of the beam
m, φ        a place of the edge, and its body's rotation; zero for the ground
r           p − m
n, τ, k     normal, tangent and bend of a piece as p sees it, :mod:`cprbm.faces`, turned with the body
D           distance of p from the piece, negative behind it
T_j         t/2, half the thickness at the joint; zero for a line
c_j         T_j − D ≤ 0
J           turns by a right angle, counter-clockwise: J n = −τ
z           p (2), and m (2) and φ where the body moves
v_z         how p moves against the body: I for p, −I for m, −J r for φ
==========  ===================================================================================

    D_z = n·v_z,    D_zz = k (τ·v_z)(τ·v_z)ᵀ + E,    E: −τ and τ between φ and p, φ and m; −n·r at φ

Departures from eq. (11), in which c_j = ±(g_m(x_j) − y_j): the distance in the place of the gap along an axis, as for a
circle (:mod:`cprbm.rigid`); and the edge ends where the scene's does, where a line that is told by a point and an angle
goes on for ever: a joint that no piece faces is held by none.

Joints are places in the chain, half an element from the beam's ends at the nearest.  Where a beam is pinned on the
edge and lies on it up to the pin, the last of them holds the chord between the two and not the tangent.  The first
spring then turns by three quarters of what the arc of an element does (the link before it is half as long as the one
behind), and its moment, ¾ E·I κ₀ for an arc that is pressed flat, is that of the last joint's force at half an element
from the pin: it grows with N without limit.  What the beam's end lacks in turning and in energy is of first order in
1/N, and so is all that depends on it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm.edge import Edge
from cprbm.faces import Seen
from cprbm.first_contact import Blocks, Group
from cprbm.kinematics import Positions, State
from cprbm.model import Chain, Model
from cprbm.point import Point
from cprbm.related import related_joints
from cprbm_scene import Scene
from cprbm_scene.answer import Array, Flags, Ints


@dataclass(frozen=True, slots=True)
class RigidEdge:
    """One contact with an edge in the paper's form.

    Attributes:
        edge: its pieces, and where they are.
        joints: the related joints of the beam (m,), its start being 0, without those that cannot move against the edge.
        half: T_j (m,); units of length.
    """

    edge: Edge
    joints: Ints
    half: Array

    def groups(self, state: State, at: Positions) -> tuple[Group, ...]:
        """The constraints at a state, with exact derivatives: one for each joint and piece that it faces."""
        frame, every = self.edge.frame(state, at), self.edge.a.first_joint + self.joints
        p = np.stack((at.x[every], at.y[every]), axis=1)
        q = frame.inwards(p)
        every_face = self.edge.whole.facing(q, self.edge.whole.seen(q))
        found = []
        for number, face in enumerate(self.edge.pieces):
            facing, seen = every_face[number], face.seen(q)
            if np.any(facing):
                seen = Seen(seen.distance, frame.turned(seen.normal, frame.phi), seen.bend, seen.within)
                found.append(self._held(number, p - frame.m, seen, facing))
        return tuple(found)

    def presses_beside_own_pin(self, point: Point) -> bool:
        """Whether a joint presses that is next to where the beam is pinned on the edge."""
        pins, chain, rows = self.edge.pins, self.edge.a, point.rows
        beside = chain.s[[1, -2]][[pin is not None for pin in pins]]
        mine = np.array([name == self.edge.name for name in rows.contact], dtype=bool)
        return bool(np.any(np.isin(rows.arc[mine & (point.lam > 0.0)], beside)))

    def _held(self, number: int, every: Array, seen: Seen, facing: Flags) -> Group:
        """Rows of the joints ``facing`` one piece; ``every`` is r of all, (m, 2)."""
        edge, chain = self.edge, self.edge.a
        r, n, k = every[facing], seen.normal[facing], seen.bend[facing]
        tau = np.stack((n[:, 1], -n[:, 0]), axis=1)
        moves = edge.body >= 0
        # r over x of joint and m, y of the same
        over = np.kron(np.eye(2), [1.0, -1.0] if moves else [1.0])
        D_z, along = n @ over, tau @ over
        joints = chain.first_joint + self.joints[facing, None]
        angles = np.zeros((len(r), 0), dtype=np.intp)
        if moves:
            swung = np.stack((r[:, 1], -r[:, 0]), axis=1)  # −J r
            D_z, along = (
                np.column_stack((slopes, np.sum(of * swung, axis=1))) for slopes, of in ((D_z, n), (along, tau))
            )
            joints = np.column_stack((joints, np.full(len(r), edge.mark)))
            angles = np.full((len(r), 1), edge.turning, dtype=np.intp)
        second = k[:, None, None] * along[:, :, None] * along[:, None, :]
        if moves:
            second[:, 4, :4] -= tau @ over
            second[:, :4, 4] -= tau @ over
            second[:, 4, 4] -= np.sum(n * r, axis=1)

        def curvature(multipliers: Array) -> Blocks:
            pressing = np.flatnonzero(multipliers)
            weights = -multipliers[pressing, None, None]
            return Blocks(joints[pressing], angles[pressing], weights * second[pressing])

        mine = self.joints[facing]
        return Group(
            contact=edge.name,
            values=self.half[facing] - seen.distance[facing],
            joints=joints,
            angles=angles,
            slopes=-D_z,
            curvature=curvature,
            keys=tuple((mine + number * (chain.n + 2)).tolist()),
            arc=chain.s[mine],
        )


def rigid_edge(scene: Scene, model: Model, edge: Edge) -> RigidEdge:
    """One of the scene's contacts with an edge in the paper's form.

    Raises:
        SceneError: it has no related joint.
    """
    joints = related_joints(scene, edge.name, edge.a, fewest=1)
    joints = joints[~np.isin(joints, _fixed(edge.a, model.marks[edge.name].frame if edge.name in model.marks else -1))]
    half = 0.5 * edge.a.section.thickness_at(edge.a.s[joints]) if edge.offset > 0.0 else np.zeros(len(joints))
    return RigidEdge(edge, joints, half)


def _fixed(chain: Chain, frame: int) -> list[int]:
    """Joints beside ends that are welded to a body: these do not move against it."""
    start, end = chain.start, chain.end
    fixed = [1] if start.frame == frame and start.welded else []
    return fixed + ([chain.n] if end is not None and end.frame == frame and end.welded else [])
