"""Where the distance of two lines has a well of its own, and where a minimum is part of a zone of contact.

==========  ==============================================================================
D, D″       distance along a beam, and its second derivative at the beam's joints
i           number of a sample: joints and the places half-way between them, (2N+3)
==========  ==============================================================================

Over a zone of contact D is nought at the joints that press, so that the mean of D″ over neighbours vanishes: it
cannot be positive at three of them that follow each other.  Round a contact in a point it is positive on both sides,
however little, since a force bends the beam towards what it presses and nothing else does.  So a minimum has a place
of its own where D″ is positive at the joints around it, by more than the two lines' own unevenness.

Where no such place was seen, joints press; what they hold apart may then have one, and pressed there has none.  So what
is held at a minimum and is apart at both joints beside it stays a place of its own: no state is neither.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cprbm.model import Chain
from cprbm_scene.answer import Array, Flags, Ints

BESIDE = 2.5  # a joint closer than this many h to a place of its own leaves what presses to that
NEAR = 1.5  # h between a minimum and a place that is known to be one
HELD = 2e-3  # of h², 1/ℓ: gaps that a zone may leave at its joints
ITERATIONS = 12
BORDER = np.array([[-1e-7], [1e-7]])  # units of length: to either side of a place where elements may meet
SETTLED = 1e-9  # units of length: the last step to a minimum
LEVEL = 0.01  # of the larger gap beside a minimum: less on its other side is the end of a zone


def lowest(D: Array, reach: float) -> Ints:
    """Numbers of the samples (k,) lower than ``reach`` and not higher than their neighbours; no end is one."""
    here = D[1:-1]
    found: Ints = ((D[:-2] >= here) & (D[2:] > here) & (reach > here)).nonzero()[0] + 1
    return found


def lowest_of_parabola(s: Array, D: Array, samples: Ints) -> Array:
    """How far from ``samples`` (k,) parabolas through D there and beside, at ``s``, are lowest; nought without one."""
    before, behind = samples - 1, samples + 1
    known = np.isfinite(D[before]) & np.isfinite(D[behind])
    one, other = np.where(known, (s[before] - s[samples], s[behind] - s[samples]), ((-1.0,), (1.0,)))
    fall, rise = np.where(known, (D[before] - D[samples], D[behind] - D[samples]), 0.0)
    rise, fall = rise / other, fall / one
    curved = (rise - fall) / (other - one)
    ahead = -0.5 * (rise - curved * other) / np.where(curved == 0.0, np.inf, curved)
    return np.where((curved != 0.0) & (ahead > one) & (ahead < other), ahead, 0.0)


def bottom(
    slope: Callable[[Array], tuple[Array, Array]], start: Array, within: Array, least: float | Array, close: float
) -> tuple[Array, Flags]:
    """Newton's method on a slope that goes through zero: the places, and at which of them it settled.

    Two joints that press are as far from the circle as each other, so that what is lowest between them is just where
    their elements meet.  From one to the next the second derivative jumps, and from which of both a place like that is
    seen would hang on round-off: the first step goes by the mean of both sides.

    Args:
        slope: of places (k,), dD/ds and d²D/ds².
        start: places (k,) to begin at.
        within: (2, k) the places between which it is sought.
        least: d²D/ds² that is no more than unevenness, one or (k,); where it is less, there is no going on.
        close: a step whose square is nothing.
    """
    if not start.size:
        return start, np.zeros(0, dtype=bool)
    s, (low, high) = start, within
    beside = np.minimum(np.maximum(start + BORDER, low), high).ravel()
    D_s, D_ss = np.array(slope(beside)).reshape(2, 2, -1).sum(axis=1) / 2.0
    step = np.zeros(len(s))
    for iteration in range(ITERATIONS):
        if iteration:
            D_s, D_ss = slope(s)
        step = -D_s / np.where(D_ss > least, D_ss, np.inf)
        s = np.minimum(np.maximum(s + step, low), high)
        if np.abs(step).max() < close:
            break
    return s, (D_ss > least) & (np.abs(step) < SETTLED)


@dataclass(frozen=True, slots=True)
class Wells:
    """Minima that may have a place of their own.

    Attributes:
        samples: the lowest samples (k,).
        parted: whether D″ is positive all round, or the place is known.
        apart: the lesser gap of the joints on either side, zero where it is next to nothing.
    """

    samples: Ints
    parted: Flags
    apart: Array

    def held(self, gap: Array) -> Flags:
        """Which have a place of their own, ``gap`` (k,) being what is found there."""
        return np.asarray(self.parted | (self.apart + gap > 0.0))


def wells(chain: Chain, gap: Array, parting: Array, samples: Ints, least: float, known: Array) -> Wells:
    """What may be a well, of the lowest samples (k,).

    Args:
        chain: the beam.
        gap: at the samples (2N+3,).
        parting: D″ at the joints (N+2,), infinite where it is not known.
        samples: the lowest, as :func:`lowest` finds them.
        least: D″ that is no more than the lines' own unevenness.
        known: arc lengths (j,) where the contact is known to be in a point: what is near is one.
    """
    s = chain.halves[samples]
    h = chain.size_at(s)
    near = (np.abs(s[:, None] - known) <= NEAR * h[:, None]).any(axis=1)
    parted, apart = near | _parted(parting, samples, least), _apart(gap, samples, h)
    likely = parted | (apart > 0.0)
    return Wells(samples[likely], parted[likely], apart[likely])


def _parted(parting: Array, samples: Ints, least: float) -> Flags:
    last = len(parting) - 1
    first, behind = samples // 2, (samples + 1) // 2
    # the ends have the curvature of the springs next to them
    around = np.minimum(np.maximum(np.array((first - 1, first, behind, behind + 1)), 1), last - 1)
    return np.asarray((parting[around] > least).all(axis=0))


def _apart(gap: Array, samples: Ints, h: Array) -> Array:
    """Next to nothing is what the joints of a zone have, or the last of a zone beside the one beyond it."""
    one, other = gap[2 * ((samples - 1) // 2)], gap[np.minimum(2 * (samples // 2 + 1), len(gap) - 1)]
    lesser = np.minimum(one, other)
    return np.where((lesser > HELD * h**2) & (lesser > LEVEL * np.maximum(one, other)), lesser, 0.0)
