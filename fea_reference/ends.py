"""Ends of a contact zone, extrapolated from the curvature of the free side.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
s       arc length on the first beam; s_e where the penalty's pressure ends
κ       curvature by undeformed arc length: κ⁰ + M/EI, with M by statics
κ_o     curvature of the first beam if it conformed to the opposite surface there
χ       relative curvature, of the sign that opens the gap on the free side
w       width of the layer over which a penalty spreads a force at a zone's end
======  =====================================================================================

In rigid contact the force at the end of a zone acts at a point c, where χ is zero and starts to grow. A penalty
spreads the force over a layer of width w about c, so that the overlap ends at s_e = c + O(w). Beyond s_e there is no
pressure. There the beam is an elastica with the resultants of the exact solution up to O(w²); continued backwards
without pressure, χ vanishes at c + O(w²). χ is evaluated at three places beyond s_e, with moments from statics, and
extrapolated as a parabola. At an end of either beam there is no free side, and the zone ends there.

For a contact in a point χ is positive on both sides. Extrapolated through the point, both zeros lie beyond, so that
the zone would begin behind its end or beside its pressure; or χ decreases outwards without a zero inwards. The centre
of pressure is then the end. A contact in several points begins and ends in different points. Zones closer than the
three places of χ count as a single contact: beside a sheared point a penalty may press in two zones.
"""

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.circle import centre
from fea_reference.edge import Edge
from fea_reference.face import edge_distances
from fea_reference.hermite import NeutralLine
from fea_reference.model import BeamPart, Model
from fea_reference.recovery import bending_moment
from fea_reference.system import System
from fea_reference.touch import Circle, Face, Touch

_AT_END = 1e-6  # elements
# times the resultant: overlaps are 1e-6 of a thickness, and round-off of positions is 1e-13
_NOTHING = 1e-6
_READ = np.array([0.0, 1.0, 2.0])  # elements beyond s_e: places of χ


def ends(model: Model, system: System, touch: Touch) -> Array:
    """Places ζ (2,) on the first beam at the beginning of the first zone and the end of the last."""
    zones, weight = touch.zones, np.hypot(*touch.force).reshape(len(touch.zones.intervals), -1)
    # a clamped end in mere contact overlaps and presses by round-off
    force = weight.sum(axis=1)
    pressed = np.flatnonzero(force > _NOTHING * force.sum())
    begins, stops = zones.intervals[pressed].T
    outer = int(pressed[np.argmin(begins)]), int(pressed[np.argmax(stops)])
    extrapolated = np.array(
        [_continued(model, system, touch, at, way) for at, way in zip(outer, (-1.0, 1.0), strict=True)]
    )
    moment = (weight * touch.zeta.reshape(weight.shape)).sum(axis=1)
    order = np.argsort(zones.intervals[:, 0])
    apart = zones.intervals[order[1:], 0] - zones.intervals[order[:-1], 1] > _READ[-1]
    number = np.append(0, np.cumsum(apart))[np.argsort(order)]
    middle = np.array([moment[number == number[at]].sum() / force[number == number[at]].sum() for at in outer])
    points = np.array([1.0, -1.0]) * (extrapolated - middle) > 0.0
    return np.where(points | (points[::-1] & (number[outer[0]] == number[outer[1]])), middle, extrapolated)


def _continued(model: Model, system: System, touch: Touch, at: int, outwards: float) -> float:
    """End of the zone with interval ``at``, extrapolated from the free side in direction ``outwards``."""
    side = 0 if outwards < 0.0 else 1
    zeta, facing = float(touch.zones.intervals[at, side]), float(touch.zones.zeta_m[at, side])
    n = model.line(model.beams[touch.pair.first], system.z).n
    least, most = touch.pair.within if isinstance(touch.pair, Face) else (0.0, float(n))
    room = (most - zeta) if outwards > 0.0 else zeta - least
    if room <= _AT_END:
        return zeta
    beyond = zeta + outwards * _READ * min(1.0, room / _READ[-1])
    chi = _relative_curvature(model, system, touch, beyond, facing)
    if chi is None:
        return zeta
    # χ over the distance inwards, a parabola through three places
    distance = np.abs(beyond - zeta)
    a, b, c = np.polyfit(distance, chi, 2)
    roots = np.roots([a, b, c])
    # a parabola that barely misses zero ends at its minimum
    inwards = roots.real[roots.real <= 0.0]
    if inwards.size:
        return float(zeta + outwards * inwards.max())
    # open, and more so inwards: no zone end is reached, a contact in a point
    return float(-outwards * np.inf) if chi[0] > 0.0 and chi[-1] <= chi[0] else zeta


def _relative_curvature(model: Model, system: System, touch: Touch, zeta: Array, facing: float) -> Array | None:
    """χ at places ``zeta`` (k,) of the first beam, opposite to ``facing``; None beyond the opposite surface."""
    z, pair = system.z, touch.pair
    beam = model.beams[pair.first]
    line = model.line(beam, z)
    x, tangent, _ = line.at(zeta)
    own = _curvature(model, system, beam, zeta)
    if isinstance(pair, Circle):
        n = x - centre(model, pair, z)[:, None]
        turning = np.sign(tangent[0] * n[1] - tangent[1] * n[0])
        # where the surface lies along the circle, the neutral line leans by the angle with sine T' by arc length
        return np.asarray(turning * own + _level(pair.edge, line, zeta) / (pair.radius + pair.edge.at(zeta)))
    if isinstance(pair, Face):
        near = edge_distances(model, pair, system.z, zeta)
        turning = np.sign(tangent[0] * near.normal[1] - tangent[1] * near.normal[0])
        return None if near.corner.any() else np.asarray(turning * own + near.bend)
    other = model.beams[pair.second]
    line_m = model.line(other, z)
    faced = pair.places_facing(line, line_m, zeta, np.full(zeta.shape, facing))
    if not faced.found.all():
        return None
    zeta_m = faced.zeta_m
    x_m, tangent_m, _ = line_m.at(zeta_m)
    along = np.sign((tangent * tangent_m).sum(axis=0))
    across = _curvature(model, system, other, zeta_m)
    side = pair.sides(zeta, zeta_m, tangent_m[0] * (x - x_m)[1] - tangent_m[1] * (x - x_m)[0])
    levels = [np.ones_like(zeta), np.ones_like(zeta)]
    if pair.tapers is not None:
        # as on a circle, with the lean of the other surface in addition
        surfaces = ((pair.tapers.first, line, zeta), (pair.tapers.second, line_m, zeta_m))
        levels = [_level(*surface) for surface in surfaces]
    apart = pair.apart(zeta, zeta_m)
    lying = across * levels[0] / (levels[1] - side * apart * across)
    if faced.fixed is not None:  # around a corner of the surface
        lying = np.where(faced.fixed, -side * levels[0] / apart, lying)
    return np.asarray(side * (along * own - lying))


def _level(edge: Edge, line: NeutralLine, zeta: Array) -> Array:
    """Cosine (k,) of the angle between surface and neutral line; the sine is T' by arc length."""
    return np.asarray(np.sqrt(1.0 - (edge.slope(zeta) / line.lengths[line.locate(zeta)[0]]) ** 2))


def _curvature(model: Model, system: System, beam: BeamPart, zeta: Array) -> Array:
    """Curvature (k,) of the deformed neutral line, (1 + c N)⁻¹ (κ⁰ + M/EI)."""
    elements = model.elements
    e = model.line(beam, system.z).locate(zeta)[0] + beam.elements.start
    undeformed = (elements.rotation[1, e] - elements.rotation[0, e]) / elements.length[e]
    fractions = zeta / (beam.elements.stop - beam.elements.start)
    moment = bending_moment(model, system, beam, fractions)
    stretch = elements.compliance[e] * system.z[model.element_dofs[6, e]]
    return np.asarray((undeformed + moment / beam.bending(fractions)) / (1.0 + stretch))
