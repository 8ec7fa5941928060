"""Choice of the beam that carries the contact integral of a zone, where ends of both beams press.

The integral along a beam resolves its own ends only. A zone opposite to an end of the second beam is cut off there
under pressure; along the second beam the zone ends with the beam, and nothing is missing. Such a zone is therefore
integrated along the second beam, all others along the first. A zone from an end of the first to an end of the second
is incomplete either way.
"""

import numpy as np

from cprbm_scene.answer import Array, Flags, Ints
from fea_reference.zones import Zones

_AT_END = 1e-6  # elements


def at_ends(places: Array, last: int) -> bool:
    """True if any of the places is an end of a beam of ``last`` elements."""
    return bool((np.minimum(places, last - places) <= _AT_END).any())


def cut_ends(zones: Zones, last: int) -> Flags:
    """True (k, 2) for interval ends opposite to an end of the second beam, of ``last`` elements."""
    return np.minimum(zones.zeta_m, last - zones.zeta_m) <= _AT_END


def split_zones(along_first: Zones, along_second: Zones, last: int, ends: tuple[int, ...]) -> tuple[Zones, Zones]:
    """Zones to integrate along either beam, if the second carries the zones at its ``ends``.

    A zone of the first is a zone of the second if both share a place of the second. Between beams at an angle, an end
    is nearer along the normal of the other's side than along its own: the second's zone appears before the first's.
    """
    number, number_m = along_first.numbers, along_second.numbers
    own = np.zeros(along_second.intervals.shape, dtype=bool)
    for end in ends:
        own |= np.abs(along_second.intervals - end * last) <= _AT_END
    second_carries = np.isin(number_m, number_m[own.any(axis=1)])
    transferred = np.zeros(len(number), dtype=bool)
    for zone in np.unique(number_m[second_carries]):
        places = along_second.intervals[number_m == zone]
        shared = (along_first.zeta_m.min(axis=1) <= places.max()) & (along_first.zeta_m.max(axis=1) >= places.min())
        transferred |= np.isin(number, number[shared])
    return along_first.chosen(~transferred), along_second.chosen(second_carries)


def merge_zones(along_first: Zones, along_second: Zones) -> tuple[Zones, Ints]:
    """Zones along either beam as zones of the first, in order along it, and their permutation (k,)."""
    turn = np.argsort(along_second.zeta_m, axis=1)
    both = (
        (along_first.intervals, np.take_along_axis(along_second.zeta_m, turn, 1)),
        (along_first.zeta_m, np.take_along_axis(along_second.intervals, turn, 1)),
    )
    intervals, zeta_m = (np.concatenate(arrays) for arrays in both)
    order = np.argsort(intervals[:, 0])
    return Zones(intervals[order], zeta_m[order], min(along_first.least, along_second.least)), order
