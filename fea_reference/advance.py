"""Moving a state along a tangent direction without bending its elements.

======  =============================================================
symbol  meaning
======  =============================================================
l, α    length and angle of an element's chord
δ       first-order change, along the step
======  =============================================================

Adding a step to the nodes' positions lengthens and turns every chord by its square and its cube, and a short
element answers with forces of 12 EI/h³ times that.  Turning every chord by δα and lengthening it by δl
instead, and joining the chords from the beam's start, agrees to first order, so Newton's method stays of
second order; what is left unbalanced is smooth.
"""

from __future__ import annotations

import numpy as np

from fea_reference.model import Model
from scene.answer import Array


def advance(model: Model, z: Array, step: Array) -> Array:
    """State ``z`` moved by ``step``, both (size,)."""
    moved = np.asarray(z + step)
    for beam in model.beams:
        dofs = model.node_dofs[:2, beam.nodes]
        dx, dy = np.diff(z[dofs], axis=1)
        step_x, step_y = np.diff(step[dofs], axis=1)
        square = dx * dx + dy * dy
        turn = (dx * step_y - dy * step_x) / square
        stretch = 1.0 + (dx * step_x + dy * step_y) / square
        cos, sin = stretch * np.cos(turn), stretch * np.sin(turn)
        chords = np.stack([cos * dx - sin * dy, sin * dx + cos * dy])
        moved[dofs[:, 1:]] = moved[dofs[:, :1]] + np.cumsum(chords, axis=1)
    return moved
