"""Which beam of a pair carries the integral of which zone, where ends of both press each other's sides.

The integral along a beam sees that beam's own ends, and not those of the other: a zone that ends across from an end of
the second is cut off there, under pressure.  Along the second it ends where that beam does, and nothing is left out.
So such a zone is left to the second, and all the others stay with the first.  Of a zone that reaches from an end of the
one to an end of the other something is left out either way.
"""

from __future__ import annotations

import numpy as np

from fea_reference.zones import Zones
from scene.answer import Array, Flags, Ints

_AT_END = 1e-6  # elements


def cut_off(zones: Zones, last: int, ends: tuple[int, ...]) -> Flags:
    """Which ends of intervals (k, 2) are across from those ``ends`` of the second beam, of ``last`` elements."""
    across = np.zeros(zones.zeta_m.shape, dtype=bool)
    for end in ends:
        across |= np.abs(zones.zeta_m - end * last) <= _AT_END
    return across


def numbered(zones: Zones) -> Ints:
    """The zone that each interval (k,) belongs to; intervals are in order."""
    intervals = zones.intervals
    return np.cumsum(np.append(False, intervals[1:, 0] > intervals[:-1, 1]))[: len(intervals)]


def shared_out(along_first: Zones, along_second: Zones, last: int, ends: tuple[int, ...]) -> tuple[Zones, Zones]:
    """What of the zones seen along either beam is to be integrated there, if the second carries those at its ``ends``.

    A zone of the first's is one of the second's if they have a place of the second in common.  Of a beam at an angle an
    end is nearer to the other's side, straight across from that, than the side is straight across from the end: the
    second's own zone is there before the first's.
    """
    number, number_m = numbered(along_first), numbered(along_second)
    own = np.zeros(along_second.intervals.shape, dtype=bool)
    for end in ends:
        own |= np.abs(along_second.intervals - end * last) <= _AT_END
    taken = np.isin(number_m, number_m[own.any(axis=1)])
    handed = np.zeros(len(number), dtype=bool)
    for one in np.unique(number_m[taken]):
        places = along_second.intervals[number_m == one]
        shared = (along_first.zeta_m.min(axis=1) <= places.max()) & (along_first.zeta_m.max(axis=1) >= places.min())
        handed |= np.isin(number, number[shared])
    kept = Zones(along_first.intervals[~handed], along_first.zeta_m[~handed], along_first.least)
    return kept, Zones(along_second.intervals[taken], along_second.zeta_m[taken], along_second.least)


def seen_from_first(along_second: Zones) -> tuple[Array, Array]:
    """Intervals of the second beam's as those of the first that they face: ζ and ζ_m (k, 2) each."""
    order = np.argsort(along_second.zeta_m, axis=1)
    return np.take_along_axis(along_second.zeta_m, order, 1), np.take_along_axis(along_second.intervals, order, 1)
