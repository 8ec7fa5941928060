"""What a scene can say, row by row: a small scene for each, and which solvers answer it.

``docs/features.md`` shows the same table; :mod:`tests.together.test_features` solves every cell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi

from tests.together.features import (
    ASKED,
    BLOCK,
    CIRCLE,
    DOWN,
    ELLIPSE,
    HILL,
    INSIDE,
    PLANE,
    POLYNOMIAL,
    RAIL,
    ROOF,
    SPLINE,
    TABLE,
    Data,
    arc,
    bowed,
    cantilever,
    crossing,
    ended,
    held_by,
    itself,
    itself_tapered,
    linked,
    lying_by_its_edge,
    lying_on_its_pin,
    moved,
    pin,
    pivoted,
    pressed_then_held,
    probes,
    pulled,
    resting,
    sized,
    sliding,
    slotted,
    stepped_together,
    stopped,
    three_points,
    two_beams,
    two_tapered,
    weld,
)

SOLVERS = {"auto": "CPRBM `auto`", "paper": "CPRBM `paper`", "fea": "FE", "exact": "exact", "solid": "solid"}
ALL = frozenset(SOLVERS)
NOT_EXACT, BOTH = ALL - {"exact"}, frozenset({"auto", "fea"})
NONE, AUTO, CPRBM = frozenset[str](), frozenset({"auto"}), frozenset({"auto", "paper"})
NOT_SOLID, BEAMS, THREE = ALL - {"solid"}, NOT_EXACT - {"solid"}, BOTH | {"solid"}


@dataclass(frozen=True)
class Feature:
    """One row: the ``group`` and what is ``said``, a scene that says it, and who answers it."""

    group: str
    said: str
    data: Data
    solvers: frozenset[str] = ALL

    @property
    def cells(self) -> Mapping[str, bool]:
        """Whether each solver answers."""
        return {solver: solver in self.solvers for solver in SOLVERS}


FEATURES = (
    Feature("theory", "stretch", cantilever(theory="stretch")),
    Feature("theory", "shear", cantilever(theory="shear")),
    Feature("theory", "shear, with a contact", held_by(CIRCLE, theory="shear")),
    Feature("beams", "line", cantilever()),
    Feature("beams", "circular arc", cantilever(arc(0.5 * pi))),
    Feature("beams", "polynomial y = f(x)", cantilever(POLYNOMIAL)),
    Feature("beams", "polynomial x = f(y)", cantilever(POLYNOMIAL | {"axis": "y"})),
    Feature("beams", "spline through points", cantilever(SPLINE)),
    Feature(
        "beams", "thickness that varies", sized(thickness={"at": [0.0, 0.4, 1.0], "values": [1.2e-3, 0.8e-3, 1e-3]})
    ),
    Feature("beams", "width that varies", sized(width={"at": [0.0, 0.4, 1.0], "values": [0.02, 0.009, 0.012]})),
    Feature("beams", "imperfection", sized(imperfection={"amplitude": 1e-3, "half_waves": 2})),
    Feature("beams", "without joints, on rollers", three_points(), NONE),
    Feature("joints", "weld", ended(weld("G"))),
    Feature("joints", "pin", ended(pin("G"))),
    Feature("joints", "free end", ended({"joint": "free"})),
    Feature("joints", "pin between two bodies", linked(), NOT_EXACT),
    Feature("bodies", "free in the plane", cantilever(asked=(*ASKED, "tip.rotation"))),
    Feature("bodies", "on a pivot", pivoted(), NOT_EXACT),
    Feature("bodies", "slide", sliding()),
    Feature("bodies", "slide with rotation", sliding(turns=True)),
    Feature("bodies", "stop at a pin", stopped(), NOT_EXACT),
    Feature("bodies", "held by a contact and a load", resting(), AUTO),
    Feature("loads", "force on a body", cantilever(loads={"F": DOWN | {"direction": [-1.0, -1.0]}})),
    Feature("loads", "moment on a body", cantilever(loads={"M": {"kind": "moment", "body": "tip"}})),
    Feature(
        "loads",
        "force at a point of a beam",
        cantilever(loads={"F": {"kind": "beam_force", "beam": "beam", "at": 0.7, "direction": [1.0, -1.0]}}),
    ),
    Feature(
        "loads",
        "moment at a point of a beam",
        cantilever(
            arc(0.7),
            loads={"M": {"kind": "beam_moment", "beam": "beam", "at": 0.63}},
            asked=(*ASKED, "R.reaction_moment", "beam.bending_stress"),
        ),
        NOT_EXACT,
    ),
    Feature(
        "loads",
        "distributed load",
        cantilever(loads={"q": {"kind": "distributed", "beam": "beam", "direction": [0.0, -1.0], "along": [0.2, 0.9]}}),
    ),
    Feature(
        "drives",
        "displacement",
        cantilever(
            drives={"d": {"kind": "displacement", "point": "T", "direction": [-0.2, -1.0]}},
            asked=(*ASKED, "T.reaction"),
        ),
    ),
    Feature(
        "drives",
        "rotation",
        cantilever(drives={"r": {"kind": "rotation", "body": "tip"}}, asked=(*ASKED, "tip.reaction_moment")),
    ),
    Feature("drives", "from a stage on", pressed_then_held(), CPRBM),
    Feature("contacts", "two beams by their edges", two_beams()),
    Feature("contacts", "two beams as lines", two_beams(thick=False), NOT_SOLID),
    Feature("contacts", "two beams by their edges, of thickness that varies", two_tapered(), THREE),
    Feature("contacts", "circle", held_by(CIRCLE)),
    Feature("contacts", "circle on a body that moves", moved(CIRCLE), NOT_EXACT),
    Feature("contacts", "circle from inside", held_by(INSIDE), CPRBM),
    Feature("contacts", "ellipse", held_by(ELLIPSE), CPRBM),
    Feature("contacts", "half-plane", held_by(PLANE), NOT_EXACT),
    Feature("contacts", "line", held_by(TABLE), NOT_EXACT),
    Feature("contacts", "polyline with a corner that stands out", held_by(ROOF), THREE),
    Feature("contacts", "polyline that goes round", held_by(BLOCK), THREE),
    Feature("contacts", "function", held_by(HILL), NOT_EXACT),
    Feature("contacts", "spline", held_by(RAIL), CPRBM),
    Feature("contacts", "half-plane on a body that moves", moved(PLANE), NOT_EXACT),
    Feature("contacts", "polyline on a body that moves", moved(ROOF), THREE),
    Feature("contacts", "function on a body that moves", moved(HILL), NOT_EXACT),
    Feature("contacts", "beam pinned to what it touches, as a line", lying_on_its_pin(), BEAMS),
    Feature("contacts", "beam pinned to what it touches, by its edge", lying_by_its_edge(), NOT_EXACT),
    Feature("contacts", "beam with itself", itself(), THREE),
    Feature("contacts", "beam with itself, of thickness that varies", itself_tapered(), THREE),
    Feature("contacts", "none: two beams that may cross", crossing()),
    Feature("stages", "loads stepped together", stepped_together(), CPRBM),
    Feature("stages", "assembly first, by moments and pins", bowed(), NOT_EXACT),
    Feature(
        "probes",
        "bending stress along a beam",
        held_by(CIRCLE) | {"probes": probes("beam.bending_stress")},
    ),
    Feature("probes", "combined stress along a beam", pulled()),
    Feature("probes", "reaction of a slide", slotted(), NOT_EXACT),
    Feature("probes", "ends of a contact's zone", held_by(CIRCLE) | {"probes": probes("c.ends")}),
    Feature("probes", "load at which a contact closes", held_by(CIRCLE) | {"probes": probes("c.closing_load")}),
)
