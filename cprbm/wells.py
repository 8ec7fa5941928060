"""Where the distance of two lines has a well of its own, and where a minimum is part of a zone of contact.

==========  ==============================================================================
D, D″       distance along a beam, and its second derivative at the beam's joints
i           number of a sample: joints and the places half-way between them, (2N+3)
==========  ==============================================================================

Over a zone of contact D is nought at the joints that press, so that the mean of D″ over neighbours vanishes: it
cannot be positive at three of them that follow each other.  Round a contact in a point it is positive on both sides,
however little, since a force bends the beam towards what it presses and nothing else does.  So a minimum has a place
of its own where D″ is positive at the joints around it, by more than the two lines' own unevenness.
"""

from __future__ import annotations

import numpy as np

from scene.answer import Array, Flags, Ints


def lowest(D: Array, reach: float) -> Ints:
    """Numbers of the samples (k,) lower than ``reach`` and not higher than their neighbours; no end is one."""
    return np.flatnonzero((D[:-2] >= D[1:-1]) & (D[2:] > D[1:-1]) & (reach > D[1:-1])) + 1


def isolated(parting: Array, samples: Ints, least: float) -> Flags:
    """Whether D″ at the joints (N+2,), infinite where D is, is more than ``least`` round each of some samples (k,)."""
    last = len(parting) - 1
    first, behind = samples // 2, (samples + 1) // 2
    # the ends have the curvature of the springs next to them
    around = np.clip(np.stack((first - 1, first, behind, behind + 1)), 1, last - 1)
    return np.asarray(np.all(parting[around] > least, axis=0))
