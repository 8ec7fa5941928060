"""Places at corners: the side of a beam on which a corner lies, and the way from a corner to a face.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
a, b     unit tangents of the faces before and behind a corner, in the sense of the edge
σ, n     side of the beam on which the corner lies, left normal of the beam
N        σ n, from the beam to the corner
=======  ====================================================================================

A beam that touches a corner has both faces behind it: −N·a ≥ 0 and N·b ≥ 0.  Hence σ has the sign of n·(b − a) there.
Farther away the position of the corner tells σ, unless the beam is inside the solid.  A corner that overlaps by the
lost compliance keeps the last side.  Beyond a beam's end a corner has no side: the beam may come back on either side.

Where N·b < 0 the distance falls along the face behind the corner: the point of contact leaves the corner, and is the
minimum of the gap between beam and face.  The same holds for the face before the corner, where N·a > 0.  A point of
contact on a bend is the same point of the beam, which moves on with the beam.
"""

import numpy as np

from cprbm.contact.candidates import Geometry, on_edge, taken
from cprbm.contact.closest import curve_jet
from cprbm.contact.corners import Corner
from cprbm.contact.fixed import is_movable
from cprbm.contact.gap import Places, gap_frame
from cprbm.contact.settling import FINDING, find_feet, near_pairs, separations, settle
from cprbm_scene.answer import Array, Ints

SURE = 1e-3
"""Distance of a corner from a beam's neutral line, over the longest beam, from which the last side does not count."""

ON_BEAM = 1e-9
"""Distance of a corner from a beam as drawn, over the longest beam, below which only the faces tell the side."""

SLIDING = 1e-9
"""Least −N·b at which a point of contact leaves a corner: round-off."""

FAR = 1.0
"""Distance of two boxes, over the longest beam, beyond which a beam does not pass a corner in a step."""

BESIDE = 1.5
"""Farthest place of contact beside a corner that the point of contact leaves, pieces."""


def corner_of(geometry: Geometry, places: Places, k: int) -> Corner:
    """The corner of a place on a rigid curve."""
    corners: tuple[Corner, ...] = geometry.pairs[int(places.pair[k])].corners
    return next(each for each in corners if each.curve == places.curve[k])


def corner_sides(geometry: Geometry, z: Array, known: Array, counters: Ints) -> Array:
    """Sides (curves,) of the corners' curves in an accepted state; 0 beyond a beam's end, and for other curves.

    Args:
        geometry, z: the state.
        known: the last sides (curves,), 0 without.
        counters: count box tests and searches.
    """
    if not geometry.has_corners:
        return known
    arrays, sides = geometry.arrays, known.copy()
    near = near_pairs(z, arrays, geometry.sites.columns, FAR, counters)
    places = taken(
        geometry.sites.possible, near[geometry.sites.possible.pair] & on_edge(arrays, geometry.sites.possible)
    )
    nothing = np.empty(len(places.pair))
    find_feet(z, arrays, places, nothing, counters)
    settle(z, arrays, places, nothing, nothing, counters, 0)
    apart = separations(z, arrays, places)
    for k, curve in enumerate(places.curve.tolist()):
        _, _, x, y, _, _ = curve_jet(z, arrays, places.foot[k], places.eta[k])
        distance = float(np.hypot(*apart[k]))
        if places.at_point[k]:
            sides[curve] = 0.0
        elif distance >= SURE or known[curve] == 0.0:
            (a, b), sizes = _faces(geometry, z, places, k)
            # between the faces the vector from the corner to the foot is −α a + β b with shares of both faces
            shares = np.linalg.lstsq(np.column_stack([a, -b]) * sizes, apart[k])[0]
            way = b - a if distance < ON_BEAM or shares.min() > 0.0 < 1.0 - shares.sum() else apart[k]
            sides[curve] = 1.0 if np.array([-y, x]) @ way >= 0.0 else -1.0
    return sides


def is_left(geometry: Geometry, z: Array, places: Places, k: int) -> bool:
    """True if the distance falls along a face beside the corner of a place, or the place lies on a bend."""
    a, b = _slopes(geometry, z, places, k)
    return bool(max(a, -b) > SLIDING or not geometry.arrays.is_point[places.curve[k]])


def left_corner(geometry: Geometry, z: Array, places: Places, k: int, sides: Array, counters: Ints) -> Places | None:
    """The place of the beam to which a point of contact that has left a corner goes; None without such a place.

    Args:
        geometry, z, places: a state in equilibrium.
        k: number of a closed place at a corner.
        sides: of the pairs (pairs, 2).
        counters: count the gaps.
    """
    corner, arrays, pair = corner_of(geometry, places, k), geometry.arrays, geometry.pairs[places.pair[k]]
    a, b = _slopes(geometry, z, places, k)
    bends, first = not arrays.is_point[places.curve[k]], arrays.first[pair.second]
    trial = taken(places, np.array([k]))
    trial.curve[:], trial.piece[:], trial.xi[:] = pair.first, places.foot[k], places.eta[k]
    trial.other[:], trial.side[:] = pair.second, sides[places.pair[k], 0]
    if bends:
        along, pieces = places.piece[k] - arrays.first[places.curve[k]], arrays.last[pair.second] - first + 1
        trial.foot[:], trial.eta[:] = first + (corner.behind + along) % pieces, places.xi[k]
    else:
        trial.foot[:], trial.eta[:] = (first + corner.behind, 0.0) if -b > a else (first + corner.before, 1.0)
    gap, curvature = np.empty(1), np.empty(1)
    settle(z, arrays, trial, gap, curvature, counters, FINDING)
    apart = arrays.arc[trial.piece] + trial.xi * arrays.span[trial.piece]
    apart -= arrays.arc[places.foot[k]] + places.eta[k] * arrays.span[places.foot[k]]
    near = abs(apart[0]) < BESIDE * arrays.span[trial.piece[0]] and not trial.at_point[0] and curvature[0] > 0.0
    return trial if near and is_movable(arrays, geometry.sites, trial, 0) else None


def _slopes(geometry: Geometry, z: Array, places: Places, k: int) -> tuple[float, float]:
    """N·a and N·b of a corner."""
    frame = gap_frame(z, geometry.arrays, places, k)
    a, b = (float(frame.nx * x + frame.ny * y) for x, y in _faces(geometry, z, places, k)[0])
    return a, b


def _faces(geometry: Geometry, z: Array, places: Places, k: int) -> tuple[Array, Array]:
    """a and b of a corner (2, 2), and sizes (2,) of the pieces; a and b are zero for a circle."""
    corner, first = corner_of(geometry, places, k), geometry.arrays.first[geometry.pairs[places.pair[k]].second]
    borders = (first + corner.before, 1.0), (first + corner.behind, 0.0)
    tangents = np.array([curve_jet(z, geometry.arrays, int(piece), xi)[2:4] for piece, xi in borders])
    sizes = np.maximum(np.hypot(*tangents.T), 1e-300)
    return tangents / sizes[:, None], sizes
