"""Frictionless penalty contact of two beams, or self-contact, integrated along the first beam's neutral line.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
ε       penalty stiffness per unit length of the first beam
δ       lead: the gap at which the pressure begins
p       line pressure ε⟨δ − g⟩
N, EI   axial force and bending stiffness of either beam
κ       curvature of the first beam on the second, positive where the second is convex
r, p_τ  x − x_m, and τ·δr
k       n·δx_m'
J, a    |x_m'| and n·x_m'';  Z = J² − d a
======  =====================================================================================

Energy Π_c = ∫ ½ ε ⟨δ − g⟩² ds over the first beam's undeformed arc length. At the closest point

    δg = side n·δr,     δ²g = side { n·δ²r − [ a p_τ² + d k² + 2 J p_τ k ] / Z }

(Konyukhov and Schweizerhof, Computational Contact Mechanics, ch. 5, in the plane). The integral runs over the exact
intervals with g < δ. The pressure vanishes at their moving ends, so that the ends add nothing to either derivative,
and the integrand is smooth in between. The pressure does not vanish where the second beam ends. There the term ½ ε (δ
− g)²/|x'·τ| along τ is missing, x' by arc length. Therefore a beam with an end over the inside of the other becomes
the first; the missing force is measured all the same, and a significant one exchanges the beams. If both beams have
such ends, every zone is integrated along the beam of its end (:mod:`fea_reference.carrying`).

With varying half thicknesses T and T_m, g is the minimum of |x − x_m| − T − T_m over x_m
(:mod:`fea_reference.facing`). At the middle of a zone g is minimal over x, too: n·x' = T' and, away from corners,
−n·x_m' = T_m'. n and τ lean from the second beam's normal, and J is τ·x_m'; the other formulas stay. At a convex
corner ζ_m is fixed and δ²g = side { n·δ²r + p_τ²/d }. At a concave corner n jumps. As in :mod:`fea_reference.face`
the moving place then adds −ε g (Δδg)²/Δg' to the second derivatives; this term, of first order in the jump of T_m'
and in the penetration, is neglected.

Resting pressure: beams in contact along a length are parallel, and both satisfy the transverse equilibrium. Per
length of the first, p = N₁ κ − EI₁ κ'' and −p = N₂ κ − EI₂ κ'', up to the ratio of thickness to radius in κ''. Hence

    p = κ (N₁ EI₂ − N₂ EI₁)/(EI₁ + EI₂),

and with δ = p/ε the pressure acts at zero gap; :mod:`fea_reference.circle` describes the error without this lead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Literal

import numpy as np

from cprbm_scene.answer import Array, Ints
from cprbm_scene.clearance import JOINED, overlap_at_rest
from cprbm_scene.curve_records import MEETING
from cprbm_scene.statement import BeamContact, FreeEnd, Scene, SelfContact
from fea_reference.carrying import cut_ends, merge_zones, split_zones
from fea_reference.edge import edge_of
from fea_reference.facing import Borders, Tapers, borders, lean
from fea_reference.hermite import (
    NeutralLine,
    as_plane,
    line_difference,
    projected_gradient,
    projected_hessian,
    shape_slopes,
    shapes,
)
from fea_reference.itself import survey_self, without_known_sides
from fea_reference.model import BeamPart, Model
from fea_reference.neighbours import nearest
from fea_reference.state import State
from fea_reference.staying import frame_of
from fea_reference.touch import Pair, Penalty, Touch, count_points_per_place, gauss, gauss_places
from fea_reference.zones import (
    Survey,
    Zones,
    end_distance,
    gap,
    has_end_over,
    no_zones,
    node_distance,
    one_side,
    overlap,
    search_distance,
    side_of,
    survey_pair,
)

_AT_END = 1e-6  # elements
_BESIDE = 2.0  # mean thicknesses: largest distance of neighbouring held ends
_SLENDER = 0.01  # lengths of the longest beam: substitute for the thickness of beams in contact as lines
_LYING = 1.0  # elements: least length of a zone at an end with a resting pressure
_LINE = 7  # unknowns of an element's line
_WEIGHTLESS = 1e-6  # least share of the force of all zones
_LAYERS = 10.0  # layers per beam length, for the widest layer


def pairs(scene: Scene, model: Model) -> tuple[Pair, ...]:
    """The scene's contacts of two beams, with their sides in the undeformed state."""
    contacts = []
    number = {beam.name: i for i, beam in enumerate(model.beams)}
    for name, contact in scene.contacts.items():
        if not isinstance(contact, BeamContact):
            continue
        i, j = (number[beam] for beam in contact.between)
        lines = [model.line(model.beams[index], model.start) for index in (i, j)]
        turned = has_end_over(lines[1], lines[0]) and not has_end_over(lines[0], lines[1])
        if turned:
            i, j = j, i
        first, second = model.beams[i], model.beams[j]
        mean = 0.5 * (first.thickness + second.thickness) - overlap_at_rest(scene, contact) / model.units.length
        least = 0.5 * (first.record.thinnest + second.record.thinnest) / model.units.length
        lines = [model.line(beam, model.start) for beam in (first, second)]
        side, side_m = side_of(lines[0], lines[1]), side_of(lines[1], lines[0])
        distance, scale, measure = (mean, least, least) if contact.thick else (0.0, _SLENDER, 1.0)
        ends, ends_m = _contact_ends(model, scene, first, second), _contact_ends(model, scene, second, first)
        thick = 0.5 * contact.thick * sum(beam.record.thickest for beam in (first, second)) / model.units.length
        free, free_m = (
            _contact_range(*order, JOINED * thick) for order in ((lines[0], lines[1]), (lines[1], lines[0]))
        )
        penalties = [_penalties(model, beam, mean) for beam in (first, second)]
        loosest, stiffness, stiffest = map(min, zip(*penalties, strict=True))
        tapers = _tapers(model, first, second, thick=contact.thick)
        strengths = (loosest, stiffness, stiffest)
        pair = Pair(name, i, j, turned, side, side_m, distance, scale, measure, *strengths, ends, ends_m, tapers=tapers)
        contacts.append(replace(pair, free=free, free_m=free_m))
    return tuple(contacts)


def with_sides(model: Model, pair: Pair, z: State) -> Pair:
    """The pair with order and sides of the beams as they lie apart in state ``z``.

    A beam beyond the other's end has no side at rest, and an end of the second may approach the first. The side comes
    from the last state with the beams opposite to each other.
    """
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    away = end_distance(second, first)
    if away < end_distance(first, second) and away <= node_distance(first, second):
        pair, first, second = pair.exchanged(), second, first
    return replace(pair, side=side_of(first, second, pair.side), side_m=side_of(second, first, pair.side_m))


def _contact_ends(model: Model, scene: Scene, beam: BeamPart, other: BeamPart) -> tuple[int, ...]:
    """Ends of ``beam`` (0 start, 1 end), except neighbours of an end of ``other`` on the same body."""
    own_ends, other_ends = (
        [
            (None if isinstance(end, FreeEnd) else frame_of(scene, scene.body_of(end.point)), place)
            for end, place in zip(
                (scene.beams[part.name].start, scene.beams[part.name].end),
                model.line(part, model.start).nodes[[0, -1]],
                strict=True,
            )
        ]
        for part in (beam, other)
    )
    near = _BESIDE * 0.5 * (beam.thickness + other.thickness)
    return tuple(
        which
        for which, (holder, place) in enumerate(own_ends)
        if not any(
            holder is not None and holder == other_holder and abs(place - there) < near
            for other_holder, there in other_ends
        )
    )


def _contact_range(line: NeutralLine, other: NeutralLine, joined: float) -> tuple[float, float]:
    """First and last place ζ with contact, at least ``joined`` from an end shared with the other beam."""
    shared = np.abs(line.nodes[[0, -1], None] - other.nodes[[0, -1]]).min(axis=1) <= MEETING
    first, last = np.where(shared, min(joined / float(line.lengths.min()), line.n), 0.0)
    return float(first), max(float(first), float(line.n - last))


def _tapers(model: Model, first: BeamPart, second: BeamPart, *, thick: bool) -> Tapers | None:
    """Thickness variation of both beams; None without variation, or for contact as lines."""
    if not thick or not (first.record.tapered or second.record.tapered):
        return None
    edges = [
        edge_of(beam.record, beam.elements.stop - beam.elements.start, model.units.length, thick=True)
        for beam in (first, second)
    ]
    return Tapers(edges[0], edges[1])


def self_contacts(scene: Scene, model: Model) -> tuple[Pair, ...]:
    """The scene's self-contacts."""
    contacts = []
    for name, contact in scene.contacts.items():
        if not isinstance(contact, SelfContact):
            continue
        beam = model.beam(contact.beam)
        number = model.beams.index(beam)
        least = beam.record.thinnest / model.units.length
        T, scale, measure = (beam.thickness, least, least) if contact.thick else (0.0, _SLENDER, 1.0)
        later = not (_grounded(scene, contact.beam, "end") and not _grounded(scene, contact.beam, "start"))
        roles = without_known_sides(later=later, ended=contact.thick).renewed(model.line(beam, model.start))
        penalties = _penalties(model, beam, beam.thickness)
        tapers = _tapers(model, beam, beam, thick=contact.thick)
        contacts.append(
            Pair(name, number, number, later, 0.0, 0.0, T, scale, measure, *penalties, roles=roles, tapers=tapers)
        )
    return tuple(contacts)


def _grounded(scene: Scene, beam: str, which: Literal["start", "end"]) -> bool:
    """True if the end is on a fixed body and cannot come to lie on the beam's side."""
    end = getattr(scene.beams[beam], which)
    return not isinstance(end, FreeEnd) and not frame_of(scene, scene.body_of(end.point))


def _penalties(model: Model, beam: BeamPart, thickness: float) -> tuple[float, float, float]:
    """EI over the fourth power of the widest, the first and the thinnest layer."""
    h = float(model.elements.length[beam.elements.start])
    first = max(h, 0.5 * thickness)
    return beam.softest / max(first, beam.length / _LAYERS) ** 4, beam.softest / first**4, beam.softest / h**4


def zones_of(model: Model, pair: Pair, z: State) -> Zones:
    """Zones of overlap of a pair in state ``z``."""
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    return overlap(first, second, pair.distance, _survey(model, pair, z, pair.distance), 0.0, _rays(pair, second))


def least_at_ends(model: Model, pair: Pair, z: State) -> float:
    """Least gap of the second beam's ends that may touch the first; infinite without such an end nearby.

    Contact along the first is measured normal to the second. An end of the second touches the first's side along the
    first's normal; between beams at an angle this gap is smaller.
    """
    if not pair.ends_m:
        return np.inf
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    about, zeta = pair.exchanged(), second.n * np.array(pair.ends_m, dtype=float)
    near = nearest(second.nodes[zeta.astype(int)], first.nodes)[1].astype(float)
    there = gap(second, first, one_side(about.side), pair.distance, about.tapers, zeta, near)
    inside = there.found & (there.zeta_m > _AT_END) & (there.zeta_m < first.n - _AT_END)
    # a deeper end came around an end of the first and lies on the other side
    return float(there.g[inside & (there.g > -0.5 * pair.scale)].min(initial=np.inf))


def motion_before_facing(model: Model, pair: Pair, z: State) -> float:
    """Lower bound of the relative motion before any place of a beam faces the other."""
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    return node_distance(first, second) - search_distance(first, second, pair.distance)


def end_circle_distance(model: Model, pair: Pair, z: State) -> float:
    """Lower bound of the distance between the first beam and the circles about the second's ends."""
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    return float(nearest(second.nodes[[0, -1]], first.nodes)[0].min()) - first.longest - pair.distance


def _survey(model: Model, pair: Pair, z: State, T: float) -> Survey:
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))

    def look() -> Survey:
        if pair.roles is None:
            return survey_pair(first, second, pair.side, T, pair.tapers, pair.free)
        return survey_self(first, pair.roles, T, pair.tapers)

    return model.known.recall(z, ("survey", pair, T), look)


def _rays(pair: Pair, second: NeutralLine) -> list[Borders]:
    """Places of the second beam with a jump of the gap's curvature; for self-contact of both sides."""
    sides = (pair.side,) if pair.roles is None else (1.0,) if pair.tapers is None else (1.0, -1.0)
    return [borders(second, pair.edge_m, side) for side in sides]


def touch(
    model: Model, pair: Pair, penalty: Penalty, quadrature: int, z: State, held_depth: float | None = None
) -> Touch:
    """Contact energy derivatives in state ``z``, with ``quadrature`` Gauss points per interval.

    A contact held at ``held_depth`` acts, in tension too, where the gap exceeds its minimum by no more than this depth.
    Far from equilibrium, a contact that was closed then neither vanishes nor becomes a rigid wall in Newton's method.
    """
    distance = pair.distance + penalty.lead
    least = _survey(model, pair, z, distance).least
    level = 0.0 if held_depth is None else least + held_depth
    zones, zones_m = _overlap(model, pair, z, distance, level), no_zones(np.inf)
    if pair.carried:
        along_second = _overlap(model, pair.exchanged(), z, distance, level)
        zones, zones_m = split_zones(zones, along_second, model.line(model.beams[pair.second], z).n, pair.carried)
    here = _gauss_points(model, pair, distance, quadrature, z, zones)
    missing, missing_share = _missing_force(model, pair, penalty, z, zones, here)
    if zones_m.intervals.size:
        about = pair.exchanged()
        there = _gauss_points(model, about, distance, quadrature, z, zones_m)
        further_missing, further_share = _missing_force(model, about, penalty, z, zones_m, there)
        missing, missing_share = missing + further_missing, max(missing_share, further_share)
        least = min(least, _survey(model, about, z, distance).least)
        zones, order = merge_zones(zones, zones_m)
        here = here.with_other(there, (order[:, None] * quadrature + np.arange(quadrature)).ravel())

    beam, beam_m = model.beams[pair.first], model.beams[pair.second]
    points_per_place = count_points_per_place(quadrature, here.e, here.e_m)
    return Touch(
        pair=pair,
        zones=replace(zones, least=least + penalty.lead),
        chain=model.chain(((beam, here.e[::points_per_place]), (beam_m, here.e_m[::points_per_place])), z),
        points_per_place=points_per_place,
        stiffness=penalty.stiffness * here.ds,
        gap=here.g,
        gap_by=here.by,
        gap_by_twice=here.by_twice,
        zeta=here.zeta,
        zeta_m=here.zeta_m,
        x=here.x,
        x_m=here.x_m,
        normal=here.normal,
        missing=missing,
        missing_share=missing_share,
    )


def _overlap(model: Model, pair: Pair, z: State, distance: float, level: float) -> Zones:
    """Zones along the first beam with a gap below ``level``, for a ``distance`` of the neutral lines."""
    line, line_m = model.line(model.beams[pair.first], z), model.line(model.beams[pair.second], z)
    if level < line_m.longest:
        return overlap(line, line_m, distance, _survey(model, pair, z, distance), level, _rays(pair, line_m))
    return overlap(line, line_m, distance + level, _survey(model, pair, z, distance + level), 0.0, _rays(pair, line_m))


@dataclass(frozen=True, slots=True)
class _GaussPoints:
    """Gauss points (k,) along the first beam: elements, places and points of both lines, and the gap.

    ``ds`` (k,) is arc length of the first beam. ``by`` (14, k) and ``by_twice`` (14, 14, k) are derivatives of the
    gap by the element unknowns of the first line, then of the second, evaluated at the first call.
    """

    e: Ints
    e_m: Ints
    zeta: Array
    zeta_m: Array
    x: Array
    x_m: Array
    ds: Array
    g: Array
    by: Callable[[], Array]
    by_twice: Callable[[], Array]
    normal: Array

    def with_other(self, other: _GaussPoints, order: Ints) -> _GaussPoints:
        """These points and the points of an integral along the second beam, in ``order``."""

        def both(own: Array, others: Array) -> Array:
            return np.concatenate([own, others], axis=-1)[..., order]

        return _GaussPoints(
            e=np.concatenate([self.e, other.e_m])[order],
            e_m=np.concatenate([self.e_m, other.e])[order],
            zeta=both(self.zeta, other.zeta_m),
            zeta_m=both(self.zeta_m, other.zeta),
            x=both(self.x, other.x_m),
            x_m=both(self.x_m, other.x),
            ds=both(self.ds, other.ds),
            g=both(self.g, other.g),
            by=cache(lambda: both(self.by(), np.roll(other.by(), _LINE, axis=0))),
            by_twice=cache(lambda: both(self.by_twice(), np.roll(other.by_twice(), (_LINE, _LINE), axis=(0, 1)))),
            normal=both(self.normal, -other.normal),
        )


def _gauss_points(model: Model, pair: Pair, distance: float, quadrature: int, z: State, zones: Zones) -> _GaussPoints:
    """The gap at the Gauss points of the first beam's ``zones``."""
    line, line_m = model.line(model.beams[pair.first], z), model.line(model.beams[pair.second], z)
    # an interval and its Gauss points lie within a single element
    zeta, there, ds = gauss_places(zones, line, quadrature)
    share = 0.5 * (gauss(quadrature)[0] + 1.0)
    guess = (zones.zeta_m[:, :1] + np.diff(zones.zeta_m, axis=1) * share).ravel()
    e, x = there.element, line.nodes[there.element] + there.way
    xi = zeta - e
    faced = pair.places_facing(line, line_m, zeta, guess)
    zeta_m, across, J = faced.zeta_m, faced.across, faced.c
    e_m, xi_m = line_m.locate(zeta_m)
    x_m = line_m.nodes[across.element] + across.way
    tau = as_plane(faced.w)
    n = np.array([-tau[1], tau[0]])
    d = (n * as_plane(line_difference(line, there, line_m, across))).sum(axis=0)
    a = (n * as_plane(across.bent)).sum(axis=0)
    Z, fixed = J * J - d * a, faced.fixed
    side = pair.sides(zeta, zeta_m, d)
    g = side * d - distance
    if pair.tapers is not None:
        g += pair.tapers.thinner(zeta, zeta_m)

    H, H_m = shapes(xi), shapes(xi_m)

    @cache
    def by() -> Array:
        by_q = np.concatenate([projected_gradient(n, H, line, e), -projected_gradient(n, H_m, line_m, e_m)])
        return np.asarray(side * by_q)

    def by_twice() -> Array:
        p = np.concatenate([projected_gradient(tau, H, line, e), -projected_gradient(tau, H_m, line_m, e_m)])
        # p and k by the unknowns of both lines; k has those of the second alone
        k = projected_gradient(n, shape_slopes(xi_m), line_m, e_m)
        shares = np.array([a, J, d]) / (Z if fixed is None else np.where(fixed, 1.0, Z))
        if fixed is not None:
            shares = np.where(fixed, [-1.0 / np.where(d == 0.0, 1.0, d), 0.0 * d, 0.0 * d], shares)
        a_Z, J_Z, d_Z = shares
        d_qq = (-a_Z * p)[:, None] * p
        pk = (-J_Z * p)[:, None] * k
        d_qq[:, _LINE:] += pk
        d_qq[_LINE:] += pk.transpose(1, 0, 2)
        d_qq[_LINE:, _LINE:] -= (d_Z * k)[:, None] * k
        d_qq[:_LINE, :_LINE] += projected_hessian(n, H, line, e)
        d_qq[_LINE:, _LINE:] -= projected_hessian(n, H_m, line_m, e_m)
        return np.asarray(side * d_qq)

    return _GaussPoints(e, e_m, zeta, zeta_m, as_plane(x), as_plane(x_m), ds, g, by, cache(by_twice), side * n)


def resting_pressure(model: Model, touch: Touch, pair: Pair, z: State) -> float:
    """Resting pressure at an end of the first beam in contact, else the median of the zones.

    The pressure is κ (N₁ EI₂ − N₂ EI₁)/(EI₁ + EI₂); zero where the beams pull apart, and for a contact shorter than
    an element at the end. Ends held side by side may part at once: their gap is zero up to round-off, and no pressure
    acts.
    """
    if not touch.closed:
        return 0.0
    beam, beam_m = model.beams[pair.first], model.beams[pair.second]
    line, line_m = model.line(beam, z), model.line(beam_m, z)
    zones = touch.zones.chosen(np.argsort(touch.zones.intervals[:, 0]))  # self-contact loops are not ordered
    intervals, zone = zones.intervals, zones.numbers
    at_end = np.array([intervals[0, 0] <= _AT_END, intervals[-1, 1] >= line.n - _AT_END])
    widths = [
        np.ptp(intervals[zone == number]) for number in (zone[[0, -1]][at_end] if at_end.any() else np.unique(zone))
    ]
    if min(widths) < _LYING:
        return 0.0
    middle, middle_m = intervals.mean(axis=1), zones.zeta_m.mean(axis=1)
    e = line.locate(middle)[0] + beam.elements.start
    e_m = line_m.locate(middle_m)[0] + beam_m.elements.start
    x_m, speed, bent = line_m.at(middle_m)
    J = np.hypot(speed[0], speed[1])
    away = line.at(middle)[0] - x_m
    side = pair.sides(middle, middle_m, speed[0] * away[1] - speed[1] * away[0])
    of_second = -side * (speed[0] * bent[1] - speed[1] * bent[0]) / J**3
    kappa = of_second / (1.0 + pair.apart(middle, middle_m) * of_second)  # parallel curves
    axial, axial_m = z[model.element_dofs[6, e]], z[model.element_dofs[6, e_m]]
    EI, EI_m = beam.bending(middle / line.n), beam_m.bending(middle_m / line_m.n)
    pressure = kappa * (axial * EI_m - axial_m * EI) / (EI + EI_m)
    return max(0.0, float(np.median(pressure[[0, -1]][at_end] if at_end.any() else pressure)))


def _missing_force(
    model: Model, pair: Pair, penalty: Penalty, z: State, zones: Zones, gauss_points: _GaussPoints
) -> tuple[float, float]:
    """The force ½ ε g²/|x'·τ| missing at intervals cut off by an end of the second beam, and its largest share.

    The share is relative to the force of the zone; zones with a negligible part of the total force do not count.
    """
    if pair.ended:
        return 0.0, 0.0
    first, second = (model.line(model.beams[i], z) for i in (pair.first, pair.second))
    across = cut_ends(zones, second.n)
    if not across.any():
        return 0.0, 0.0
    zeta, zeta_m = zones.intervals[across], zones.zeta_m[across]
    there, there_m = first.around(zeta), second.around(zeta_m)
    back = (there_m.ahead / np.abs(there_m.ahead)).conj()
    d = (back * line_difference(first, there, second, there_m)).imag
    side = pair.sides(zeta, zeta_m, d)
    if pair.edge_m is not None:
        back = lean(there_m.ahead, pair.edge_m.slope(zeta_m), side).conj()
        d = (back * line_difference(first, there, second, there_m)).imag
    g = np.minimum(side * d - pair.apart(zeta, zeta_m) - penalty.lead, 0.0)
    ahead = np.abs((back * there.ahead).real) / first.lengths[there.element]
    left_out = 0.5 * penalty.stiffness * g**2 / np.maximum(ahead, 1e-3)
    number = zones.numbers
    forces = (-penalty.stiffness * gauss_points.ds * gauss_points.g).reshape(len(number), -1).sum(axis=1)
    pushes = np.abs(np.bincount(number, forces))
    missing = np.bincount(number[np.nonzero(across)[0]], left_out, minlength=pushes.size)
    counts = (missing > _WEIGHTLESS * pushes.sum()) & (pushes > 0.0)
    return float(missing.sum()), float((missing[counts] / pushes[counts]).max(initial=0.0))
