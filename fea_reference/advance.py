"""Motion of a state along a tangent direction without parasitic strain of its elements.

======  =============================================================
symbol  meaning
======  =============================================================
l, α    length and angle of an element's chord
δ       first-order change, along the step
======  =============================================================

A step added to the nodes' positions changes every chord by second- and third-order terms, too. A short element turns
this change into forces of 12 EI/h³ times its size. Instead every chord is turned by δα and lengthened by δl, and the
chords are joined from the beam's start. This agrees to first order, so that Newton's method stays quadratic, and
leaves a smooth residual.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.model import Model
from fea_reference.state import State


def advance(model: Model, z: State, step: Array) -> State:
    """State ``z`` moved by ``step`` (size,)."""
    dx, dy, turn, stretch = _chords(model, z, step)
    # change of every chord without cancellation: (1 + stretch) R(turn) minus the identity
    along, across = stretch * np.cos(turn) - 2.0 * np.sin(0.5 * turn) ** 2, (1.0 + stretch) * np.sin(turn)
    return z.moved(_joined(model, step, np.array([along * dx - across * dy, across * dx + along * dy])))


def transported(model: Model, before: State, now: State, rate: Array) -> Array:
    """Vector ``rate`` (size,) of the state ``before``, transported to ``now``: equal turn and stretch of the chords."""
    _, _, turn, stretch = _chords(model, before, rate)
    dx, dy = now.difference(model.element_dofs[3:5], model.element_dofs[:2])
    return _joined(model, rate, np.array([stretch * dx - turn * dy, turn * dx + stretch * dy]))


def path_terms(model: Model, before: State, now: State, rates: tuple[Array, Array], by: float) -> tuple[Array, Array]:
    """Higher-order terms c₂ and c₃ (size,) of the path between two states, for an increment ``by`` of the parameter.

    With u from −1 in the state ``before`` to 0 ``now`` the path is u ``by`` times the last rate + c₂ u² + c₃ u³.
    ``rates`` are the path tangents (size,) at both ends.
    """
    here = by * rates[1]
    first_term = step_between(model, now, before) + here
    turned = by * transported(model, before, now, rates[0]) - here
    return 3.0 * first_term + turned, 2.0 * first_term + turned


def step_between(model: Model, start: State, end: State) -> Array:
    """The step (size,) from ``start`` to ``end``, inverse of :func:`advance`."""
    ends = model.element_dofs[3:5], model.element_dofs[:2]
    (dx, dy), (along, across) = start.difference(*ends), end.difference(*ends)
    ratio = (along + 1j * across) / (dx + 1j * dy)
    turn, stretch = np.angle(ratio), np.abs(ratio) - 1.0
    moved = (end.values - start.values) + (end.rest - start.rest)
    return _joined(model, moved, np.array([stretch * dx - turn * dy, turn * dx + stretch * dy]))


def _chords(model: Model, z: State, step: Array) -> tuple[Array, Array, Array, Array]:
    """Chord components (n,) along x and y of all elements, and their turn and stretch in a ``step`` (size,)."""
    last, first = model.element_dofs[3:5], model.element_dofs[:2]
    (dx, dy), (step_x, step_y) = z.difference(last, first), step[last] - step[first]
    square = dx * dx + dy * dy
    return dx, dy, (dx * step_y - dy * step_x) / square, (dx * step_x + dy * step_y) / square


def _joined(model: Model, step: Array, changes: Array) -> Array:
    """The ``step`` (size,) with the ``changes`` (2, n) of all chords, joined from the beams' starts."""
    joined = step.copy()
    for beam in model.beams:
        dofs = model.node_dofs[:2, beam.nodes]
        joined[dofs[:, 1:]] = step[dofs[:, :1]] + changes[:, beam.elements].cumsum(axis=1)
    return joined
