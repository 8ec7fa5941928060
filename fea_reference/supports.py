"""Reactions of fixed bodies, guides and drives."""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.model import DrivePart, HingePart, JointPart, Model
from fea_reference.state import State


def joint_reaction(joint: JointPart, z: State) -> tuple[Array, float]:
    """Force (2,) and moment of a joint's body on the beam's end: the negative multipliers."""
    return -z[joint.rows[:2]], float(-z[joint.rows[2]]) if joint.rows.size == 3 else 0.0


def ground_reaction(model: Model, hinge: HingePart, z: State) -> tuple[str, Array] | None:
    """Fixed point of a hinge and its force (2,) on the other body; None between moving bodies."""
    for i, point, sign in zip(hinge.bodies, hinge.points, (1.0, -1.0), strict=True):
        if model.bodies[i].dofs is None:
            return point, np.asarray(sign * z[hinge.rows])
    return None


def row_reaction(part: DrivePart, z: State) -> tuple[Array, float]:
    """Force (2,) at the point and moment of a drive or guide on its body: the negative multiplier."""
    pull = -float(z.values[part.row])
    return (np.zeros(2), pull) if part.direction is None else (pull * part.direction, 0.0)
