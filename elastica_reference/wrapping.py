"""Contact along a circle: a beam that lies on the circle from a to b, between two knots of its section.

=======  ==================================================================================================
symbol   meaning
=======  ==================================================================================================
o, ρ     the circle's centre; its radius plus half of the constant thickness of a thick beam
g        +1 if the beam runs around the circle counter-clockwise, else −1; κ_c = g/ρ
τ, n, e  unit tangent, left-hand normal, outward normal e = −g n
m, F     internal moment and force; N = F·τ; ' is d/ds
p        line pressure on the beam, along e
=======  ==================================================================================================

The beam has the circle's curvature, so

    m = EI (κ_c − κ0),   F·e = g m',   N + κ_c m = const,   p = N/ρ − g m''                                    (1)

from m' = −F·n, F' = −p e. At an end not held by a clamp m is continuous, which determines the place of the end. F·e
may jump there, by a point force of the circle; N is continuous.
"""

import numpy as np

from cprbm_scene import CircleContact
from cprbm_scene.answer import Array
from elastica_reference.evaluation import Columns, EndAction, Evaluation, Part, Zone
from elastica_reference.layout import Layout
from elastica_reference.model import Strip
from elastica_reference.structure import Wrap


def wrap_between(out: Evaluation, where: Layout, wrap: Wrap, before: Part, after: Part, z: Columns) -> None:
    """Rows of a wrap between two pieces of a beam."""
    name, g = wrap.contact, wrap.sense
    strip, centre, rho = out.model.strips[wrap.beam], out.centres[name], neutral_radius(out, wrap)
    a, b = z[where.places[name, "begin"]], z[where.places[name, "end"]]
    place, theta = before.end[:2], before.end[2]
    tangent_a, e_a = _frame(theta, g)
    (m_a, dm_a), (m_b, dm_b) = _moment(strip, wrap, rho, a), _moment(strip, wrap, rho, b)
    out.rows += [*(place - centre - rho * e_a), before.end[3] - m_a]
    place_b, theta_b = _rotated(place, centre, theta, g * (b - a) / rho)
    out.rows += [*(after.start[:2] - place_b), after.start[2] - theta_b, after.start[3] - m_b]
    tangent_b, e_b = _frame(theta_b, g)
    N_a, N_b = _along(before.force, tangent_a), _along(after.force, tangent_b)
    out.rows.append(N_b + g / rho * m_b - N_a - g / rho * m_a)  # (1)
    first, last = N_a * tangent_a + g * dm_a * e_a, N_b * tangent_b + g * dm_b * e_b
    _record(out, wrap, Zone(a, b, place, theta, before.force, after.force, first, last))


def wrap_from_clamp(out: Evaluation, where: Layout, wrap: Wrap, z: Columns) -> None:
    """Rows of a wrap from a beam's clamped start, or to its clamped end."""
    name, g = wrap.contact, wrap.sense
    strip, centre, rho = out.model.strips[wrap.beam], out.centres[name], neutral_radius(out, wrap)
    which, end = ("start", strip.start) if wrap.from_start else ("end", strip.end)
    part = out.parts[strip.name][0 if wrap.from_start else -1]
    state = part.start[:4] if wrap.from_start else part.end
    free = z[where.places[name, "end" if wrap.from_start else "begin"]]
    clamp_place = np.full_like(free, 0.0 if wrap.from_start else strip.length)
    assert end.point is not None
    clamp = out.moved(out.model.scene.body_of(end.point), out.model.rest(end.point))
    angle = out.angle(strip.name, which)
    place, theta = _rotated(clamp, centre, angle, g * (free - clamp_place) / rho)
    (m_free, dm_free), (m_held, dm_held) = _moment(strip, wrap, rho, free), _moment(strip, wrap, rho, clamp_place)
    out.rows += [*(state[:2] - place), state[2] - theta, state[3] - m_free]
    (tangent, e), (tangent_held, e_held) = _frame(theta, g), _frame(angle, g)
    N = _along(part.force, tangent)
    inside_free = N * tangent + g * dm_free * e
    inside_held = (N + g / rho * (m_free - m_held)) * tangent_held + g * dm_held * e_held  # (1)
    if wrap.from_start:
        out.ends[strip.name, which] = EndAction(clamp, inside_held, m_held)
        _record(out, wrap, Zone(clamp_place, free, clamp, angle, inside_held, part.force, inside_held, inside_free))
    else:
        out.ends[strip.name, which] = EndAction(clamp, -inside_held, -m_held)
        _record(out, wrap, Zone(free, clamp_place, place, theta, part.force, inside_held, inside_free, inside_held))


def neutral_radius(out: Evaluation, wrap: Wrap) -> float:
    """ρ; the beam has a constant thickness."""
    contact = out.model.scene.contacts[wrap.contact]
    assert isinstance(contact, CircleContact)
    half = float(out.model.strips[wrap.beam].half_thickness(np.zeros(1))[0]) if contact.thick else 0.0
    return contact.radius / out.model.unit_length + half


def _record(out: Evaluation, wrap: Wrap, zone: Zone) -> None:
    """Record the zone; its force on the beam is F before minus F after."""
    contact = out.model.scene.contacts[wrap.contact]
    assert isinstance(contact, CircleContact)
    force = zone.before - zone.after
    out.resultants[wrap.contact], out.zones[wrap.contact] = force, zone
    out.act(contact.body, out.centres[wrap.contact], -force)


def _moment(strip: Strip, wrap: Wrap, rho: float, s: Columns) -> tuple[Columns, Columns]:
    """m and m' (K,) at an arc length (K,)."""
    at = np.array([float(s[0].real)])
    m, dm, ddm = (float(value[0]) for value in bending(strip, wrap.sense / rho, at))
    away = s - at[0]  # zero except for the complex step
    return m + dm * away, dm + ddm * away


def bending(strip: Strip, kappa: float, s: Array) -> tuple[Array, Array, Array]:
    """m, m' and m'' (n,) of a beam with constant curvature ``kappa``, at arc lengths (n,)."""
    EI, dEI, ddEI = strip.rigidity(s), strip.rigidity_slope(s), strip.rigidity_second(s)
    change = kappa - strip.line.curvature(s)
    slope, second = strip.line.curvature_slope(s), strip.line.curvature_second(s)
    return EI * change, dEI * change - EI * slope, ddEI * change - 2.0 * dEI * slope - EI * second


def _rotated(place: Columns, centre: Columns, angle: Columns, by: Columns) -> tuple[Columns, Columns]:
    """Position and tangent angle after a rotation ``by`` around the centre."""
    x, y = place - centre
    cos, sin = np.cos(by), np.sin(by)
    return centre + np.stack([cos * x - sin * y, sin * x + cos * y]), angle + by


def _frame(angle: Columns, sense: float) -> tuple[Columns, Columns]:
    """τ and e."""
    tangent = np.stack([np.cos(angle), np.sin(angle)])
    return tangent, sense * np.stack([tangent[1], -tangent[0]])


def _along(force: Columns, tangent: Columns) -> Columns:
    return np.asarray(force[0] * tangent[0] + force[1] * tangent[1])
