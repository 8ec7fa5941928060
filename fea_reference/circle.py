"""Frictionless contact of a beam with a rigid circle by a penalty along the beam's neutral line.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
x, c    point of the neutral line, centre of the circle: X + R(φ) arm from its body's own
r, n    distance |x − c| and its direction (x − c)/r;  τ is n turned clockwise
R, T    radius; half of the beam's thickness at ζ, zero for a line
g       gap r − R − T
ε       penalty stiffness per unit length of the beam
δ       lead: the gap at which the pressure begins
N       axial force of the beam
======  =====================================================================================

Energy Π_c = ∫ ½ ε ⟨δ − g⟩² ds over the beam's undeformed arc length, where

    δg = n·(δx − δc),     δ²g = n·(δ²x − δ²c) + (τ·(δx − δc))²/r,

and by ζ alone g' = n·x' − T', g'' = n·x'' + (τ·x')²/r.  The integral runs over the exact intervals on which g < δ,
as in :mod:`fea_reference.contact`: the pressure vanishes at their ends.

An even beam that lies on a circle has the circle's curvature κ = 1/(R + T), so it has no shear force, so its tension is
constant and presses it on with N κ (Landau and Lifshitz, Theory of Elasticity, §19).  Where EI varies, the shear force
is −κ EI', so that N + κ² EI is constant and the pressure κ (N − EI'').  Without a lead, the beam sinks in by
that over ε, and beside a clamp, which does not, a layer of width (4 EI/ε)^¼ leaves its pressure to the clamp: an
error of first order in the layer's width in the contact's force.  With δ = κ (N − EI'')/ε at the clamp there is no such
layer, and what is left, at the end of the zone, is of second order.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import CircleContact, Scene
from fea_reference.edge import edge_of
from fea_reference.hermite import Around, NeutralLine, along, plane, shapes, twice_along
from fea_reference.model import Model, turned
from fea_reference.state import Complex, State, squared, summed
from fea_reference.swept import gone_over
from fea_reference.touch import Circle, Penalty, Touch, gauss, together
from fea_reference.zones import Gap, Zones, negative, stepped

_BETWEEN = np.arange(1, 8) / 8.0  # of the way between two states
_SAGITTA = 0.15  # of the square of a way along an arc, by which its chord may leave it
_AT_END = 1e-6  # elements
_LAYERS = 32.0  # of the first penalty, in a beam's length
_RESOLVED = 3.0  # layers in an element: what they leave is of second order in their width
# Layers in a beam's length at the standard penetration: what they leave is below 1e-7, and thinner ones make more of a
# clamp's place being rounded. Penetration goes with the fourth power of the layer: who asks for less gets thinner ones.
_THINNEST, _STANDARD = 800.0, 1e-4


def circles(scene: Scene, model: Model, penetration: float) -> tuple[Circle, ...]:
    """The scene's contacts of a beam with a circle, ``penetration`` as in the settings."""
    found = []
    thinnest = _THINNEST * (_STANDARD / penetration) ** 0.25
    beams = [beam.name for beam in model.beams]
    bodies = [body.name for body in model.bodies]
    for name, contact in scene.contacts.items():
        if not isinstance(contact, CircleContact):
            continue
        first, body = beams.index(contact.beam), bodies.index(contact.body)
        beam = model.beams[first]
        at = (np.array(contact.center) - model.units.origin) / model.units.length
        x, y = at - model.bodies[body].centre
        edge = edge_of(beam.record, beam.elements.stop - beam.elements.start, model.units.length, thick=contact.thick)
        radius = contact.radius / model.units.length
        h = float(model.elements.length[beam.elements.start])
        layer = max(h, 0.5 * beam.thickness, min(beam.length / _LAYERS, radius))
        found.append(
            Circle(
                name,
                first,
                body,
                (float(x), float(y)),
                radius,
                edge,
                2.0 * edge.nearest if contact.thick else 1.0,
                beam.softest / layer**4,
                beam.softest / max(h / _RESOLVED, beam.length / thinnest) ** 4,
            )
        )
    return tuple(found)


def zones_of(model: Model, circle: Circle, z: State) -> Zones:
    """Where the beam overlaps the circle in state ``z``."""
    return model.leads.found(z, (circle, 0.0), lambda: (_find(_seen(model, circle, z), circle, 0.0), {}))[0]


def room(model: Model, circle: Circle, z: State) -> float:
    """How far the beam can move against the circle before it may touch it: a lower bound."""
    seen = _seen(model, circle, z)
    return float(np.abs(seen.away).min()) - circle.radius - circle.edge.farthest - seen.line.longest


def _seen(model: Model, circle: Circle, z: State) -> _Seen:
    return _Seen.of(model.line(model.beams[circle.first], z), centre(model, circle, z), circle)


def centre(model: Model, circle: Circle, z: State) -> Array:
    """Where the circle's centre is, (2,)."""
    return model.carried(model.bodies[circle.body], np.array(circle.arm), z)


def passed(model: Model, circle: Circle, before: State, after: State) -> bool:
    """Whether a beam that goes straight from one state to another sweeps over the circle's centre or cuts its inside.

    It sweeps over the centre if the loop of its old place, its end's way, its new place backwards and its start's
    way winds round that.  On the way it may lie in the circle by what the straight way of a turning beam leaves out.
    """
    beam = model.beams[circle.first]
    old, new = (model.line(beam, z).points - centre(model, circle, z)[:, None] for z in (before, after))
    loop = np.concatenate([old, new[:, ::-1], old[:, :1]], axis=1)
    a, b = loop[:, :-1], loop[:, 1:]
    winding = np.arctan2(a[0] * b[1] - a[1] * b[0], (a * b).sum(axis=0)).sum()
    if abs(winding) > np.pi:
        return True
    centres = [np.array([complex(*centre(model, circle, z))]) for z in (before, after)]
    lines = [model.line(beam, z) for z in (before, after)]
    first, last, over = gone_over((lines[0], centres[0]), (lines[1], centres[1]))
    if (over & (first.d * last.d < 0.0)).any():
        return True  # a circle smaller than what chords leave of arcs
    way = np.hypot(*(new - old)).max()
    allowed = circle.radius + circle.edge.nearest - circle.deepest - _SAGITTA * way**2
    return any(np.hypot(*(old + part * (new - old))).min() < allowed for part in _BETWEEN)


def touch(model: Model, circle: Circle, penalty: Penalty, quadrature: int, z: State) -> Touch:
    """The penalty's energy derivatives in state ``z``, with ``quadrature`` Gauss points per interval."""
    beam, body = model.beams[circle.first], model.bodies[circle.body]
    seen, c = _seen(model, circle, z), centre(model, circle, z)
    line = seen.line
    ahead, _ = model.leads.found(z, (circle, penalty.lead), lambda: (_find(seen, circle, penalty.lead), {}))
    zones = replace(ahead, least=ahead.least + penalty.lead)

    points, weights = gauss(quadrature)
    width = zones.intervals[:, 1] - zones.intervals[:, 0]
    zeta = (zones.intervals[:, :1] + width[:, None] * 0.5 * (points + 1.0)).ravel()
    there = line.around(zeta)
    e = there.element
    ds = (0.5 * width[:, None] * weights).ravel() * line.lengths[e]

    r, toward, g = _clearance(seen, circle, there, zeta)
    x, n = plane(line.nodes[e] + there.way), plane(toward)
    tau = np.array([n[1], -n[0]])

    H = shapes(zeta - e)
    g_q, p = along(n, H, line, e), along(tau, H, line, e)
    own = twice_along(n, H, line, e)
    if body.dofs is not None:
        arm = turned(np.array(circle.arm), z[body.dofs[2]])
        across = np.array([-arm[1], arm[0]])  # ∂(R arm)/∂φ; its derivative is −R arm
        g_q = np.concatenate([g_q, -n, -across[None] @ n])
        p = np.concatenate([p, -tau, -across[None] @ tau])
    g_qq = p[:, None] * p[None, :] / r
    g_qq[:7, :7] += own
    if body.dofs is not None:
        g_qq[9, 9] += turned(np.array(circle.arm), z[body.dofs[2]]) @ n

    g = g - penalty.lead
    weight = penalty.stiffness * ds
    alike = together(quadrature, e)
    return Touch(
        pair=circle,
        zones=zones,
        chain=model.chain(((beam, e[::alike]),), z, body.dofs),
        alike=alike,
        stiffness=weight,
        gap=g,
        gap_by=g_q,
        gap_by_twice=g_qq,
        zeta=zeta,
        zeta_m=np.empty(0),
        x=x,
        x_m=c[:, None] + circle.radius * n,
        normal=n,
    )


def resting_pressure(model: Model, touch: Touch, circle: Circle, z: State) -> float:
    """κ (N − EI'') where a zone meets an end of the beam, else in the middle; zero where the beam is compressed.

    Zero too where what meets the end is less than an element: beside an end that touches and leaves the circle at once.
    N + κ² EI, which is constant, is the median along the zone, which its end cannot spoil.
    """
    if not touch.closed:
        return 0.0
    beam = model.beams[circle.first]
    line = model.line(beam, z)
    intervals = touch.zones.intervals
    middle = intervals.mean(axis=1)
    zone = np.cumsum(np.append(False, intervals[1:, 0] > intervals[:-1, 1]))
    if intervals[0, 0] <= _AT_END:
        place, mine = 0.0, zone == 0
    elif intervals[-1, 1] >= line.n - _AT_END:
        place, mine = float(line.n), zone == zone[-1]
    else:
        place, mine = float(np.median(middle)), zone >= 0
    if place in (0.0, line.n) and intervals[mine].max() - intervals[mine].min() < 1.0:
        return 0.0
    axial = z[model.element_dofs[6, line.locate(middle[mine])[0] + beam.elements.start]]
    kappa = 1.0 / (circle.radius + circle.edge.at(middle[mine]))
    constant = float(np.median(axial + kappa**2 * beam.bending(middle[mine] / line.n)))
    at = np.array([place / line.n])
    stiffness, second = float(beam.bending(at)[0]), float(beam.bending_second(at)[0])
    kappa_there = 1.0 / float(circle.radius + circle.edge.at(at * line.n)[0])
    return max(0.0, kappa_there * (constant - kappa_there**2 * stiffness - second))


@dataclass(frozen=True)
class _Seen:
    """A neutral ``line`` from the centre of a circle: its nodes by ``away`` x − c (n+1,), and ``over`` (n+1,) there.

    That is r² − (R + T)² of the least T, with all digits.
    """

    line: NeutralLine
    away: Complex
    over: Array

    @classmethod
    def of(cls, line: NeutralLine, c: Array, circle: Circle) -> _Seen:
        """Of a circle about ``c`` (2,)."""
        away, error = summed(line.nodes, np.full(line.nodes.shape, -complex(*c), dtype=np.complex128))
        rest = error + line.rests
        (x, lost_x), (y, lost_y) = squared(away.real), squared(away.imag)
        total, lost_in_sum = summed(x, y)
        own, lost_of_own = squared(np.array([circle.radius + circle.edge.nearest]))
        over, lost_in_difference = summed(total, -own)
        lost = lost_x + lost_y + 2.0 * (away.conj() * rest).real
        return cls(line, away, over + (lost_in_difference + lost_in_sum - lost_of_own + lost))

    def near(self, circle: Circle, lead: float) -> Ints:
        """Elements (k,) in which the gap may be less than a ``lead``, and those about the node that is nearest."""
        r = np.abs(self.away)
        least = np.minimum(r[:-1], r[1:])
        reach = circle.radius + circle.edge.farthest + max(lead, 0.0) + self.line.longest
        nearest = int(r.argmin())
        within = least < reach
        within[max(nearest - 1, 0) : nearest + 1] = True
        return np.flatnonzero(within)


def _clearance(seen: _Seen, circle: Circle, there: Around, zeta: Array) -> tuple[Array, Complex, Array]:
    """r (k,), n (k,) and g (k,) at places ``zeta`` (k,): g by (r² − (R + T)²)/(r + R + T) of the least T.

    At an element's first node the numerator has all its digits; from there on it changes by no more than the
    element is long, and so does its round-off.
    """
    q, d = seen.away[there.element], there.way
    away = q + d
    r = np.abs(away)
    more = ((2.0 * q + d) * d.conj()).real
    g = (seen.over[there.element] + more) / (r + (circle.radius + circle.edge.nearest))
    if circle.edge.varies:
        g -= circle.edge.at(zeta) - circle.edge.nearest
    return r, away / r, g


def _find(seen: _Seen, circle: Circle, lead: float) -> Zones:
    """All intervals on which the gap is less than ``lead``; those of a thick beam end at its knots too."""
    line = seen.line

    def at(zeta: Array, none: Array) -> Gap:
        there = line.around(zeta)
        r, n, g = _clearance(seen, circle, there, zeta)
        ahead = n.conj() * there.ahead
        slope = ahead.real - circle.edge.slope(zeta) if circle.edge.varies else ahead.real
        curvature = (n.conj() * there.bent).real + ahead.imag**2 / r
        return Gap(g - lead, slope, curvature, none, np.ones(zeta.shape, dtype=bool))

    zeta, neighbours = stepped(seen.near(circle, lead), circle.edge.inner)
    floor = float(np.finfo(float).eps) * line.longest
    return negative(at, zeta, at(zeta, np.zeros_like(zeta)), neighbours, circle.edge.inner, floor=floor)
