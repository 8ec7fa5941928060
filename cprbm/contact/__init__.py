"""Contact of curves: geometry, gaps with derivatives, places, pairs of a scene.

* :mod:`cprbm.contact.curve`: pieces, linear in the positions of nodes;
* :mod:`cprbm.contact.closest`: points, closest points, boxes; :mod:`cprbm.contact.gap`: gap and derivatives;
* :mod:`cprbm.contact.corners`, :mod:`cprbm.contact.edges`: corners of rigid solids, places at corners;
* :mod:`cprbm.contact.fixed`: joints, ends and corners at the nearest feet;
* :mod:`cprbm.contact.settling`: feet and moving places on a frozen state, counters;
* :mod:`cprbm.contact.pairs`, :mod:`cprbm.contact.candidates`: contacts of a scene, places and closed set of a state.
"""

from cprbm.contact.candidates import (
    TOUCHING,
    Contacts,
    Geometry,
    contact_geometry,
    copied,
    fixed_places,
    hold_sections_upright,
    on_edge,
    open_contacts,
    places_at,
    sides_at_rest,
    taken,
    touching_as_drawn,
)
from cprbm.contact.closest import lost_at
from cprbm.contact.curve import BEND, CORNER, Curve, CurveArrays, Frames, beam_curve, curve_arrays
from cprbm.contact.edges import corner_sides, is_left, left_corner
from cprbm.contact.fixed import REACH, Sites, contact_places, is_movable, joined, matched, picked
from cprbm.contact.gap import (
    COUPLING,
    GRADIENT,
    LOCAL,
    SHIFT,
    TANGENT,
    TURN,
    Columns,
    Law,
    Places,
    Row,
    gap_frame,
    gap_row,
    local_indices,
    touching_points,
)
from cprbm.contact.settling import (
    BOX_TESTS,
    FINDING,
    GAPS,
    SEARCHES,
    find_feet,
    move_places,
    near_pairs,
    new_counters,
    separations,
    settle,
    settle_near,
    sweeps_any_point,
)

__all__ = [
    "BEND",
    "BOX_TESTS",
    "CORNER",
    "COUPLING",
    "FINDING",
    "GAPS",
    "GRADIENT",
    "LOCAL",
    "REACH",
    "SEARCHES",
    "SHIFT",
    "TANGENT",
    "TOUCHING",
    "TURN",
    "Columns",
    "Contacts",
    "Curve",
    "CurveArrays",
    "Frames",
    "Geometry",
    "Law",
    "Places",
    "Row",
    "Sites",
    "beam_curve",
    "contact_geometry",
    "contact_places",
    "copied",
    "corner_sides",
    "curve_arrays",
    "find_feet",
    "fixed_places",
    "gap_frame",
    "gap_row",
    "hold_sections_upright",
    "is_left",
    "is_movable",
    "joined",
    "left_corner",
    "local_indices",
    "lost_at",
    "matched",
    "move_places",
    "near_pairs",
    "new_counters",
    "on_edge",
    "open_contacts",
    "picked",
    "places_at",
    "separations",
    "settle",
    "settle_near",
    "sides_at_rest",
    "sweeps_any_point",
    "taken",
    "touching_as_drawn",
    "touching_points",
]
