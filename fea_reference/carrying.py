"""Which beam of a pair carries the integral of which zone, where ends of both press each other's sides.

The integral along a beam sees that beam's own ends, and not those of the other: a zone that ends across from an end of
the second is cut off there, under pressure.  Along the second it ends where that beam does, and nothing is left out.
So such a zone is left to the second, and all the others stay with the first.  Of a zone that reaches from an end of the
one to an end of the other something is left out either way.
"""

import numpy as np

from cprbm_scene.answer import Array, Flags, Ints
from fea_reference.zones import Zones

_AT_END = 1e-6  # elements


def at_ends(places: Array, last: int) -> bool:
    """Whether one of some places on a beam of ``last`` elements is an end of it."""
    return bool((np.minimum(places, last - places) <= _AT_END).any())


def cut_off(zones: Zones, last: int) -> Flags:
    """Which ends of intervals (k, 2) are across from an end of the second beam, of ``last`` elements."""
    return np.minimum(zones.zeta_m, last - zones.zeta_m) <= _AT_END


def shared_out(along_first: Zones, along_second: Zones, last: int, ends: tuple[int, ...]) -> tuple[Zones, Zones]:
    """What of the zones seen along either beam is to be integrated there, if the second carries those at its ``ends``.

    A zone of the first's is one of the second's if they have a place of the second in common.  Of a beam at an angle an
    end is nearer to the other's side, straight across from that, than the side is straight across from the end: the
    second's own zone is there before the first's.
    """
    number, number_m = along_first.numbers, along_second.numbers
    own = np.zeros(along_second.intervals.shape, dtype=bool)
    for end in ends:
        own |= np.abs(along_second.intervals - end * last) <= _AT_END
    taken = np.isin(number_m, number_m[own.any(axis=1)])
    handed = np.zeros(len(number), dtype=bool)
    for one in np.unique(number_m[taken]):
        places = along_second.intervals[number_m == one]
        shared = (along_first.zeta_m.min(axis=1) <= places.max()) & (along_first.zeta_m.max(axis=1) >= places.min())
        handed |= np.isin(number, number[shared])
    return along_first.chosen(~handed), along_second.chosen(taken)


def joined(along_first: Zones, along_second: Zones) -> tuple[Zones, Ints]:
    """Zones seen along either beam as the first beam's, in order along it; and which of them (k,) these were."""
    turn = np.argsort(along_second.zeta_m, axis=1)
    both = (
        (along_first.intervals, np.take_along_axis(along_second.zeta_m, turn, 1)),
        (along_first.zeta_m, np.take_along_axis(along_second.intervals, turn, 1)),
    )
    intervals, zeta_m = (np.concatenate(each) for each in both)
    order = np.argsort(intervals[:, 0])
    return Zones(intervals[order], zeta_m[order], min(along_first.least, along_second.least)), order
