"""What the ground does to what is joined to it."""

from __future__ import annotations

from fea_reference.model import JointPart
from fea_reference.state import State
from scene.answer import Array


def support(joint: JointPart, z: State) -> tuple[Array, float]:
    """Force (2,) and moment of a joint's body on the beam's end: the multipliers, turned round."""
    force = -z[joint.rows[:2]]
    return force, float(-z[joint.rows[2]]) if joint.rows.size == 3 else 0.0
