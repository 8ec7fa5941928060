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

import numpy as np

from cprbm_scene.answer import Array, Ints
from fea_reference.model import Model
from fea_reference.state import State


def advance(model: Model, z: State, step: Array) -> State:
    """State ``z`` moved by ``step`` (size,)."""
    way = step.copy()
    for beam in model.beams:
        dofs = model.node_dofs[:2, beam.nodes]
        dx, dy, turn, stretch = _chords(dofs, z, step)
        # What each chord changes by, with all digits however small it is: (1 + stretch) R(turn) less one.
        along, across = stretch * np.cos(turn) - 2.0 * np.sin(0.5 * turn) ** 2, (1.0 + stretch) * np.sin(turn)
        changes = np.array([along * dx - across * dy, across * dx + along * dy])
        way[dofs[:, 1:]] = step[dofs[:, :1]] + np.cumsum(changes, axis=1)
    return z.moved(way)


def carried(model: Model, before: State, now: State, rate: Array) -> Array:
    """A ``rate`` (size,) in the state ``before`` as one that turns and stretches the chords of ``now`` by the same."""
    same = rate.copy()
    for beam in model.beams:
        dofs = model.node_dofs[:2, beam.nodes]
        _, _, turn, stretch = _chords(dofs, before, rate)
        dx, dy = now.difference(dofs[:, 1:], dofs[:, :-1])
        changes = np.array([stretch * dx - turn * dy, turn * dx + stretch * dy])
        same[dofs[:, 1:]] = rate[dofs[:, :1]] + np.cumsum(changes, axis=1)
    return same


def bend(model: Model, before: State, now: State, rates: tuple[Array, Array], by: float) -> tuple[Array, Array]:
    """What bends the way from one state to another while a value changes ``by`` so much: c₂ and c₃, (size,) each.

    Over u from −1 in the state ``before`` to 0 ``now`` it is ``by`` times u times the last rate, + c₂ u² + c₃ u³;
    ``rates`` are those at both ends, (size,) each, by the value.
    """
    here = by * rates[1]
    come = way_to(model, now, before) + here
    turned = by * carried(model, before, now, rates[0]) - here
    return 3.0 * come + turned, 2.0 * come + turned


def way_to(model: Model, start: State, end: State) -> Array:
    """The step (size,) by which ``start`` is moved to ``end``, see :func:`advance`."""
    way = (end.values - start.values) + (end.rest - start.rest)
    for beam in model.beams:
        dofs = model.node_dofs[:2, beam.nodes]
        dx, dy = start.difference(dofs[:, 1:], dofs[:, :-1])
        along, across = end.difference(dofs[:, 1:], dofs[:, :-1])
        ratio = (along + 1j * across) / (dx + 1j * dy)
        turn, stretch = np.angle(ratio), np.abs(ratio) - 1.0
        changes = np.array([stretch * dx - turn * dy, turn * dx + stretch * dy])
        way[dofs[:, 1:]] = way[dofs[:, :1]] + np.cumsum(changes, axis=1)
    return way


def _chords(dofs: Ints, z: State, step: Array) -> tuple[Array, Array, Array, Array]:
    """The chords (n,) between a beam's nodes, ``dofs`` (2, n + 1), along x and y, and their turn and stretch."""
    dx, dy = z.difference(dofs[:, 1:], dofs[:, :-1])
    step_x, step_y = np.diff(step[dofs], axis=1)
    square = dx * dx + dy * dy
    return dx, dy, (dx * step_y - dy * step_x) / square, (dx * step_x + dy * step_y) / square
