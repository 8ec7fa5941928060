"""Frictionless penalty contact of a beam with a rigid circle, integrated along the beam's neutral line.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, c    point of the neutral line, centre of the circle: X + R(φ) arm from its body's centre
r, n    distance |x − c| and its direction (x − c)/r;  τ is n turned clockwise
R, T    radius; half of the beam's thickness at ζ, zero for a line
g       gap r − R − T
ε       penalty stiffness per unit length of the beam
δ       lead: the gap at which the pressure begins
N       axial force of the beam
======  =====================================================================================

Energy Π_c = ∫ ½ ε ⟨δ − g⟩² ds over the beam's undeformed arc length, where

    δg = n·(δx − δc),     δ²g = n·(δ²x − δ²c) + (τ·(δx − δc))²/r,

and by ζ alone g' = n·x' − T', g'' = n·x'' + (τ·x')²/r. The integral runs over the exact intervals with g < δ, as in
:mod:`fea_reference.contact`: the pressure vanishes at their ends.

Resting pressure: a prismatic beam on a circle has the constant curvature κ = 1/(R + T), hence no shear force and a
constant tension. The pressure is N κ (Landau and Lifshitz, Theory of Elasticity, §19). With varying EI the shear
force is −κ EI'. Then N + κ² EI is constant and the pressure is κ (N − EI'').

Lead: without a lead the beam penetrates by the pressure over ε. A clamp does not penetrate. Beside a clamp the
pressure in a layer of width (4 EI/ε)^¼ therefore goes to the clamp. The error of the contact force is of first order
in the layer's width. With δ = κ (N − EI'')/ε at the clamp this layer vanishes; the remaining error, at the end of the
zone, is of second order.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import CircleContact, Scene
from fea_reference.hermite import Around, NeutralLine, as_plane
from fea_reference.model import Model
from fea_reference.rigid_touch import LAYERS, on_bodies, rigid_touch
from fea_reference.state import Complex, State, squared, summed
from fea_reference.swept import swept_over
from fea_reference.touch import Circle, Penalty, Touch, gauss_places
from fea_reference.zones import Gap, Zones, negative, steps_within

_BETWEEN = np.arange(1, 8) / 8.0  # shares of the way between two states
_SAGITTA = 0.15  # times the square of a motion along an arc: largest deviation of its chord
_AT_END = 1e-6  # elements


def circles(scene: Scene, model: Model, penetration: float) -> tuple[Circle, ...]:
    """The scene's contacts of a beam with a circle; ``penetration`` as in the settings."""
    contacts = []
    records = {name: record for name, record in scene.contacts.items() if isinstance(record, CircleContact)}
    for name, contact, first, body, edge, h, stiffest in on_bodies(model, records, penetration):
        beam, radius = model.beams[first], contact.radius / model.units.length
        x, y = (np.array(contact.center) - model.units.origin) / model.units.length - model.bodies[body].centre
        layer = max(h, 0.5 * beam.thickness, min(beam.length / LAYERS, radius))
        scale, softness = 2.0 * edge.nearest if contact.thick else 1.0, beam.softest / layer**4
        contacts.append(Circle(name, first, body, (float(x), float(y)), radius, edge, scale, softness, stiffest))
    return tuple(contacts)


def zones_of(model: Model, circle: Circle, z: State) -> Zones:
    """Zones of overlap of the beam with the circle in state ``z``."""
    return model.known.recall(
        z, ("lead", circle, 0.0), lambda: (_zones_below(_relative_line(model, circle, z), circle, 0.0), {})
    )[0]


def motion_before_contact(model: Model, circle: Circle, z: State) -> float:
    """Lower bound of the relative motion before the beam may touch the circle."""
    relative = _relative_line(model, circle, z)
    return float(np.abs(relative.away).min()) - circle.radius - circle.edge.farthest - relative.line.longest


def _relative_line(model: Model, circle: Circle, z: State) -> _RelativeLine:
    return _RelativeLine.of(model.line(model.beams[circle.first], z), centre(model, circle, z), circle)


def centre(model: Model, circle: Circle, z: State) -> Array:
    """Current centre (2,) of the circle."""
    return model.carried(model.bodies[circle.body], np.array(circle.arm), z)


def passes_through(model: Model, circle: Circle, before: State, after: State) -> bool:
    """True if a beam, straight from one state to another, sweeps over the circle's centre or cuts its inside.

    The beam sweeps over the centre if the closed loop of old line, end's path, new line and start's path winds around
    the centre. During the motion the beam may lie in the circle by the deviation of straight paths of a turning beam.
    """
    lines = [model.line(model.beams[circle.first], z) for z in (before, after)]
    centres = [np.array([complex(*centre(model, circle, z))]) for z in (before, after)]
    old, new = (line.nodes - c for line, c in zip(lines, centres, strict=True))
    loop = np.concatenate([old, new[::-1], old[:1]])
    if abs(np.angle(loop[1:] * loop[:-1].conj()).sum()) > np.pi:
        return True
    first, last, over = swept_over((lines[0], centres[0]), (lines[1], centres[1]))
    if (over & (first.d * last.d < 0.0)).any():
        return True  # a circle smaller than the distance between chords and arcs
    allowed = circle.radius + circle.edge.nearest - circle.deepest - _SAGITTA * np.abs(new - old).max() ** 2
    return any(np.abs(old + part * (new - old)).min() < allowed for part in _BETWEEN)


def touch(model: Model, circle: Circle, penalty: Penalty, quadrature: int, z: State) -> Touch:
    """Contact energy derivatives in state ``z``, with ``quadrature`` Gauss points per interval."""
    relative = _relative_line(model, circle, z)
    ahead, _ = model.known.recall(
        z, ("lead", circle, penalty.lead), lambda: (_zones_below(relative, circle, penalty.lead), {})
    )
    zones = replace(ahead, least=ahead.least + penalty.lead)
    places = gauss_places(zones, relative.line, quadrature)
    r, n, g = _clearance(relative, circle, places[1], places[0])
    return rigid_touch(
        model, circle, penalty, quadrature, z, zones, places, (g, as_plane(n), 1.0 / r, r - circle.radius)
    )


def resting_pressure(model: Model, touch: Touch, circle: Circle, z: State) -> float:
    """κ (N − EI'') at the beam's end in contact, else in the middle of the zone; zero in compression.

    Also zero if the contact at the end is shorter than an element: the end leaves the circle at once. The constant N
    + κ² EI is the median along the zone, insensitive to the zone's end.
    """
    if not touch.closed:
        return 0.0
    beam = model.beams[circle.first]
    line = model.line(beam, z)
    intervals = touch.zones.intervals
    middle = intervals.mean(axis=1)
    zone = np.cumsum(np.append(False, intervals[1:, 0] > intervals[:-1, 1]))
    if intervals[0, 0] <= _AT_END:
        place, selected = 0.0, zone == 0
    elif intervals[-1, 1] >= line.n - _AT_END:
        place, selected = float(line.n), zone == zone[-1]
    else:
        place, selected = float(np.median(middle)), zone >= 0
    if place in (0.0, line.n) and intervals[selected].max() - intervals[selected].min() < 1.0:
        return 0.0
    axial = z[model.element_dofs[6, line.locate(middle[selected])[0] + beam.elements.start]]
    kappa = 1.0 / (circle.radius + circle.edge.at(middle[selected]))
    constant = float(np.median(axial + kappa**2 * beam.bending(middle[selected] / line.n)))
    at = np.array([place / line.n])
    stiffness, second = float(beam.bending(at)[0]), float(beam.bending_second(at)[0])
    kappa_there = 1.0 / float(circle.radius + circle.edge.at(at * line.n)[0])
    return max(0.0, kappa_there * (constant - kappa_there**2 * stiffness - second))


@dataclass(frozen=True)
class _RelativeLine:
    """A neutral ``line`` relative to a circle's centre: vectors ``away`` x − c (n+1,) of its nodes.

    ``over`` (n+1,) is r² − (R + T)² there, for the least T, without cancellation.
    """

    line: NeutralLine
    away: Complex
    over: Array

    @classmethod
    def of(cls, line: NeutralLine, c: Array, circle: Circle) -> _RelativeLine:
        """Relative to a circle with centre ``c`` (2,)."""
        away, error = summed(line.nodes, np.full(line.nodes.shape, -complex(*c), dtype=np.complex128))
        rest = error + line.rests
        (x, lost_x), (y, lost_y) = squared(away.real), squared(away.imag)
        total, lost_in_sum = summed(x, y)
        own, lost_of_own = squared(np.array([circle.radius + circle.edge.nearest]))
        over, lost_in_difference = summed(total, -own)
        round_off = lost_x + lost_y + 2.0 * (away.conj() * rest).real
        return cls(line, away, over + (lost_in_difference + lost_in_sum - lost_of_own + round_off))

    def near(self, circle: Circle, lead: float) -> Ints:
        """Elements (k,) with a possible gap below ``lead``, and the elements at the nearest node."""
        r = np.abs(self.away)
        least = np.minimum(r[:-1], r[1:])
        reach = circle.radius + circle.edge.farthest + max(lead, 0.0) + self.line.longest
        nearest = int(r.argmin())
        within = least < reach
        within[max(nearest - 1, 0) : nearest + 1] = True
        return np.flatnonzero(within)


def _clearance(relative: _RelativeLine, circle: Circle, there: Around, zeta: Array) -> tuple[Array, Complex, Array]:
    """r (k,), n (k,) and g (k,) at places ``zeta`` (k,); g is (r² − (R + T)²)/(r + R + T) for the least T.

    The numerator is exact at an element's first node and changes by at most the element's length, with a round-off to
    match.
    """
    q, d = relative.away[there.element], there.way
    away = q + d
    r = np.abs(away)
    change = ((2.0 * q + d) * d.conj()).real
    g = (relative.over[there.element] + change) / (r + (circle.radius + circle.edge.nearest))
    if circle.edge.varies:
        g -= circle.edge.at(zeta) - circle.edge.nearest
    return r, away / r, g


def _zones_below(relative: _RelativeLine, circle: Circle, lead: float) -> Zones:
    """Intervals with a gap below ``lead``, divided at the knots of a thick beam."""
    line = relative.line

    def at(zeta: Array, zeta_m: Array) -> Gap:
        there = line.around(zeta)
        r, n, g = _clearance(relative, circle, there, zeta)
        ahead = n.conj() * there.ahead
        slope = ahead.real - circle.edge.slope(zeta) if circle.edge.varies else ahead.real
        curvature = (n.conj() * there.bent).real + ahead.imag**2 / r
        return Gap(g - lead, slope, curvature, zeta_m, zeta == zeta)

    zeta, neighbours = steps_within(relative.near(circle, lead), circle.edge.inner)
    floor = float(np.finfo(float).eps) * line.longest
    return negative(at, zeta, at(zeta, np.zeros_like(zeta)), neighbours, circle.edge.inner, floor=floor)
