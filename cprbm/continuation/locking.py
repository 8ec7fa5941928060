"""Why no step leads on where beams cannot change their length: straight beams and taut beams.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
n, ν     forces of the links and multipliers of the rows in balance without any load
N        part of n along the link
v, v_t   stepped value, value of the taut state
F        largest force of a link
=======  ====================================================================================

A straight beam between held ends has such forces n, ν, and a repeated row.  Their work in a change df* of
the rows, −Σ ν df*, is Σ n times the elongation asked of the beam.  A beam in bending alone cannot become
longer; under shortening the beam buckles to either side, and the straight branch ends in a bifurcation at once.

A bent beam may be drawn taut.  There F grows like (v_t − v)^−p, so that F/F′ = (v_t − v)/p falls evenly to zero.
No force with a limit has this law.
"""

from __future__ import annotations

import numpy as np

from cprbm.continuation.path import Reached, Way
from cprbm.equilibrium.newton import Solved
from cprbm.equilibrium.sharing import balanced_forces
from cprbm_scene.answer import Array

TAUT, GROWN = 4, 4.0
"""Minima over which F grows so many times before it may be said to have no limit."""

ASKED = 1e-9
"""Elongation, over the longest beam, below which a way asks nothing of a straight beam."""

NEAR = 2.0
"""Times as far as the refused step: a limit farther away does not explain the refusal."""


def locked_beam(solved: Solved, change: Array) -> tuple[str, float]:
    """Name of the straight beam in balance with a repeated row, and the elongation asked of straight beams.

    The elongation belongs to a ``change`` of the targets, over the longest beam.  Without a repeated row the name is
    empty.
    """
    system, repeated = solved.system, np.flatnonzero(solved.state.repeated)
    if not len(repeated):
        return "", 0.0
    forces = balanced_forces(solved, int(repeated[0]))
    pull = _pulls(solved, forces)
    largest = np.maximum.reduceat(np.abs(pull), system.beams.first_link)
    longer = float(-(forces[system.rows.first :] @ change) / (system.metric @ pull) * len(pull))
    return list(system.mechanism.chains)[int(np.argmax(largest))], longer


def taut_value(trail: list[Reached], way: Way, refused: float) -> float | None:
    """v_t from the last minima before a refused fraction of the way; None where forces have a limit."""
    if len(trail) < TAUT:
        return None
    v = np.array([way.value(one.t) for one in trail[-TAUT:]])
    F = np.array([float(np.abs(_forces(one.solved, one.solved.state.z)).max()) for one in trail[-TAUT:]])
    if not np.all(np.diff(F) > 0.0) or F[-1] < GROWN * F[0]:
        return None
    ratio, middle = np.abs(0.5 * (F[1:] + F[:-1]) * np.diff(v) / np.diff(F)), 0.5 * (v[1:] + v[:-1])
    if not np.all(np.diff(ratio) < 0.0):
        return None
    limit = middle[-1] + ratio[-1] * (middle[-1] - middle[-2]) / (ratio[-2] - ratio[-1])
    return float(limit) if 0.0 < (limit - v[-1]) / (way.value(refused) - v[-1]) <= NEAR else None


def _forces(solved: Solved, vector: Array) -> Array:
    """Forces (links, 2) in a vector of unknowns."""
    return np.asarray(vector[solved.system.links.first[:, None] + [2, 3]])


def _pulls(solved: Solved, vector: Array) -> Array:
    """N of all links in a vector of unknowns."""
    angles = solved.state.z[solved.system.angles]
    return np.asarray((_forces(solved, vector) * np.column_stack([np.cos(angles), np.sin(angles)])).sum(axis=1))
