"""Dead loads on beams, consistent with the neutral line: work, and its derivatives by the unknowns.

======  =====================================================================================
symbol  meaning
======  =====================================================================================
ζ_g     places of a load on its beam, element number plus ξ; f_g the force there
x(ζ)    point of the neutral line, :mod:`fea_reference.hermite`; ψ its tangent angle at a node
ξ*      place where the line's arc length from the element's first node is ξ L
l, α    length and angle of an element's chord; n = (−sin α, cos α), t = (cos α, sin α)
γ       shear angle of the element, between its line and the sections at both ends
c, c_t  compliance at a force inside an element with fixed ends, across and along
φ, σ    12 EI/(GA L²) and 1/(1 + φ); with the slip c of :mod:`fea_reference.element` σ = 1 − c₁ − c₂
m       speed of the cubic at both nodes, l (1 + (ψ₂ − ψ₁)²/16)
W       Σ f_g·(x(ζ_g) − x⁰(ζ_g)), and for a point force ½ c (f·n)² + ½ c_t (f·t)²
======  =====================================================================================

Consistent nodal forces: a force within an element, and a distributed load, act on the nodes by the cubic shape
functions. In small deflections the nodal displacements are then exact (P. Tong, Exact solution of certain problems by
finite-element method, AIAA Journal 7 (1969) 178-180). With shear this holds if the cubic of every element leans by
the element's own γ. The mean γ of a smooth line would not do: under a force γ jumps, and the mesh would decide which
part of the jump lies before the place.

Bubble: the shape functions lack the deflection within an element with fixed ends. Per element its energy is of fifth
order under a distributed load, and of third with shear; under a point force of third and first order. The bubble of a
point force is added and moves the place by c (f·n) n + c_t (f·t) t; the coupling of two forces in an element is
neglected. With u + v = L, the cantilever's formulas at both ends, and the element's axial compliance c_N,

    c = (u v/(12 EI L)) [ u v (1 − σ (v − u)²/L²) + φ L² ],     u³v³/(3 EI L³) without shear,     c_t = c_N u v/L.

The speed m is the speed of an arc over the chord, not the speed from the axial force as in
:mod:`fea_reference.hermite`. A load would do work on the latter within its element, with an error of a tenth.

Along an arc of angle 2α the cubic is slower in the middle, by α²/8 of its speed, so that a force acts at

    ξ* = ξ − (ψ₂ − ψ₁)² ξ (1 − ξ)(1 − 2ξ)/48

    ∂(½ c (f·n)² + ½ c_t (f·t)²)/∂α = (c_t − c)(f·n)(f·t),    ∂²/∂α² = (c − c_t)((f·t)² − (f·n)²)

A moment M does the work M (θ − θ⁰) of the section's rotation θ, not of the tangent. The tangent leans by the shear
angle; a moment on the tangent would be a couple over the element's length, whose shear grows on finer meshes. With
the shear angle γ of the element and the sections' rotations θ₁, θ₂ at its nodes,

    θ = (1 − ξ)(1 − 3 ξ) θ₁ − ξ (2 − 3 ξ) θ₂ + 6 ξ (1 − ξ)(α − γ),

as in the element's energy. The slope of a cubic through both nodes differs from θ by the third power of the element's
rotation. The difference depends on the place within the element, and refinement would not reveal the error.

    dα = n·d(x₂ − x₁)/l,    d²α = −2 (n·d(x₂ − x₁)) (t·d(x₂ − x₁))/l²

A moment, too, has a compliance within an element with fixed ends, c' = (u v/L)(1 − 3 σ u v/L²)/EI. The energy ½ c' M²
is constant. Two unit moments in an element, at u ≤ u', rotate each other's places by (u v'/L)(1 − 3 σ v u'/L²)/EI.
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array
from fea_reference.hermite import (
    Index,
    NeutralLine,
    chord_speed_excess,
    projected_gradient,
    projected_hessian,
    shape_slopes,
    shapes,
)
from fea_reference.leaning import LINE, Chain
from fea_reference.model import BeamLoadPart, BeamMomentPart, Model, OnBeam
from fea_reference.state import State

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_TURN = np.array([0.0, 0.0, -1.0, 0.0, 0.0, 1.0, 0.0])[:, None]  # derivatives of ψ₂ − ψ₁ by these unknowns


@dataclass(frozen=True, slots=True)
class BeamLoad:
    """A load in a given state.

    Attributes:
        part, value, force: the load, its value and forces (2, k), zero for a moment.
        place: points of application (2, k); work: W.
        chain: chain rule from the unknowns of element lines to all unknowns.
        local_gradient: derivatives (m, k) of W by the unknowns of the element lines.
        gradient, hessian: derivatives (M, k) and (M, M, k) of W by the unknowns ``dofs`` (M, k).
    """

    part: OnBeam
    value: float
    force: Array
    place: Array
    work: float
    chain: Chain
    local_gradient: Array
    gradient: Array
    hessian: Array

    @property
    def dofs(self) -> Index:
        """Unknowns on which the places depend."""
        return self.chain.dofs

    @property
    def moment(self) -> float:
        """Moment about the origin."""
        own = self.value if isinstance(self.part, BeamMomentPart) else 0.0
        return own + float((self.place[0] * self.force[1] - self.place[1] * self.force[0]).sum())


def beam_load(model: Model, part: OnBeam, value: float, z: State) -> BeamLoad:
    """A load of the given ``value`` in state ``z``."""
    if isinstance(part, BeamMomentPart):
        return _beam_moment(model, part, value, z)
    beam = model.beams[part.beam]
    force = value * part.forces
    placed = _load_places(model, part, z)
    place = placed.place
    start = model.known.recall(model.start, ("load", part.name), lambda: _load_places(model, part, model.start).place)
    local, twice = placed.projected_gradient(force)
    done = float((force * (place - start)).sum())
    if not part.distributed:
        bubble = _bubble(placed.line, placed.local, _compliances(model, part, placed), force)
        local, twice, place = local + bubble.local, twice + bubble.twice, place + bubble.moved
        done += 0.5 * float((bubble.moved * force).sum())
    chain = model.separate_chain(beam, placed.elements, z)
    return BeamLoad(part, value, force, place, done, chain, local, chain.gradient(local), chain.hessian(twice, local))


def _beam_moment(model: Model, part: BeamMomentPart, value: float, z: State) -> BeamLoad:
    """A moment of the given ``value`` in state ``z``."""
    beam, zeta = model.beams[part.beam], np.array([part.zeta])
    sections = model.line_of_sections(beam, z)
    e, xi = sections.locate(zeta)
    theta, local, twice = _section_angle(sections, zeta)
    bow = 6.0 * xi * (1.0 - xi)
    chords, at = model.chords(z), beam.elements.start + e
    theta = theta - bow * chords.shear[at]
    local[:6] -= bow * chords.shear_by[:, at]
    twice[:6, :6] -= bow * chords.shear_by_twice[:, :, at]
    rest, give = model.known.recall(model.start, ("load", part.name), lambda: _moment_at_rest(model, part))
    chain = model.chain_of_sections(beam, e, z)
    local, twice = value * local, value * twice
    work = value * float(theta[0] - rest) + 0.5 * value**2 * float(give)
    no_force, place = np.zeros((2, 1)), model.line(beam, z).at(zeta)[0]
    by, by_twice = chain.gradient(local), chain.hessian(twice, local)
    return BeamLoad(part, value, no_force, place, work, chain, local, by, by_twice)


def _moment_at_rest(model: Model, part: BeamMomentPart) -> Array:
    """Initial angle of the place and the rotation of the place by its own unit moment, (2,)."""
    beam, zeta = model.beams[part.beam], np.array([part.zeta])
    sections = model.line_of_sections(beam, model.start)
    e, xi = sections.locate(zeta)
    gamma = model.chords(model.start).shear[beam.elements.start + e]
    (theta,) = _section_angle(sections, zeta)[0] - 6.0 * xi * (1.0 - xi) * gamma
    return np.array((theta, _mutual_work(model, part, part, sections)))


def shared_work(model: Model, part: BeamMomentPart, other: BeamMomentPart, z: State) -> float:
    """Mutual work of two unit moments within an element; zero for different elements."""
    if part.beam != other.beam:
        return 0.0
    return _mutual_work(model, part, other, model.line(model.beams[part.beam], z))


def _mutual_work(model: Model, part: BeamMomentPart, other: BeamMomentPart, line: NeutralLine) -> float:
    zeta = np.array([part.zeta, other.zeta])
    e, xi = line.locate(zeta)
    if e[0] != e[1]:
        return 0.0
    first, last = float(xi.min()), float(xi.max())
    straight = first * (1.0 - last)
    beam = model.beams[part.beam]
    bending = float(beam.bending(zeta / line.n).mean())
    sigma = 1.0 - float(model.elements.slip[:, beam.elements][:, e[0]].sum())
    return float(line.lengths[e[0]]) * straight * (1.0 - 3.0 * sigma * last * (1.0 - first)) / bending


def _section_angle(line: NeutralLine, zeta: Array) -> tuple[Array, Array, Array]:
    """θ + 6 ξ (1 − ξ) γ at places (k,), and its derivatives by the unknowns of the element lines.

    The angle is continuous from the nodes.
    """
    e, xi = line.locate(zeta)
    first, last = line.angles[e], line.angles[e + 1]
    (cos, sin), _, turn, stretch = _chord(line, e)
    lean = np.arctan2(np.cos(first) * sin - np.sin(first) * cos, np.cos(first) * cos + np.sin(first) * sin)
    of_last, of_chord = xi * (3.0 * xi - 2.0), 6.0 * xi * (1.0 - xi)
    theta = first + of_last * (last - first) + of_chord * lean
    by = of_chord * turn
    by[2] += 1.0 - of_last - of_chord
    by[5] += of_last
    both = stretch[:, None] * turn[None, :]
    return theta, by, -of_chord * (both + both.transpose(1, 0, 2))


@dataclass(frozen=True, slots=True)
class _LoadPlaces:
    """Places of a load: their numbers ``local`` of an element in ``line``, ξ* and ξ, all (k,).

    ``slope`` and ``second`` (k,) are the derivatives of ξ* by the difference of the nodes' ψ. ``elements`` (c,) are the
    beam's elements with a load, and ``begins`` (c,) the first of the consecutive places in each element.
    """

    line: NeutralLine
    elements: Index
    begins: Index
    local: Index
    at: Array
    xi: Array
    slope: Array
    second: Array

    @property
    def place(self) -> Array:
        """x (2, k)."""
        return self.line.at(self.local + self.at)[0]

    def projected_gradient(self, f: Array) -> tuple[Array, Array]:
        """Derivatives (7, c) and (7, 7, c) of f·x(ξ*), summed in every element, by the unknowns of the element lines.

        The forces ``f`` are (2, k). A distributed load keeps ξ* = ξ.
        """
        line, e, H = self.line, self.local, shapes(self.at)
        speed, speed_twice = _speed(line, e[self.begins])
        at_places = projected_gradient(f, H, line, e), projected_hessian(f, H, line, e)
        local, twice = (np.add.reduceat(derivatives, self.begins, axis=-1) for derivatives in at_places)
        by, both = _by_nodes(local, speed), twice[LINE - 1][:, None] * speed[None, :]
        by_twice = twice + both + both.transpose(1, 0, 2) + local[LINE - 1] * speed_twice
        by_twice[LINE - 1] = by_twice[:, LINE - 1] = 0.0
        if not self.second.any():
            return by, np.asarray(by_twice)
        _, x1, x2 = line.at(e + self.at)
        ahead, bent = (f * x1).sum(axis=0), (f * x2).sum(axis=0)
        by1 = _by_nodes(projected_gradient(f, shape_slopes(self.at), line, e), speed)
        moved, turned = self.slope * _TURN, _TURN[:, None] * _TURN
        both = by1[:, None] * moved[None, :]
        by_twice += both + both.transpose(1, 0, 2) + (bent * self.slope**2 + ahead * self.second) * turned
        return by + ahead * moved, np.asarray(by_twice)


def _by_nodes(local: Array, speed: Array) -> Array:
    """Derivatives (7, k) by the nodes alone, from ``local`` (7, k) with the last row by the speed."""
    by = local + local[LINE - 1] * speed
    by[LINE - 1] = 0.0
    return np.asarray(by)


def _speed(line: NeutralLine, e: Index) -> tuple[Array, Array]:
    """Derivatives (7, k) and (7, 7, k) of m − L (1 + (ψ₂ − ψ₁)²/48) by the nodes."""
    _, _, turn, stretch = _chord(line, e)
    l = np.abs(line.nodes[e + 1] - line.nodes[e])  # noqa: E741 - the chord's length
    turned, L = line.angles[e + 1] - line.angles[e], line.lengths[e]
    both = stretch[:, None] * _TURN[None, :]
    _, by_l, by_turned, by_both, by_turned_twice = chord_speed_excess(l, L, turned)
    twice = by_l * l * turn[:, None] * turn[None, :] + by_both * l * (both + both.transpose(1, 0, 2))
    return by_l * l * stretch + by_turned * _TURN, twice + by_turned_twice * _TURN[:, None] * _TURN[None, :]


def _load_places(model: Model, part: BeamLoadPart, z: State) -> _LoadPlaces:
    """Places of a load in state ``z``; for a distributed load ξ* = ξ, as both halves of an element compensate."""
    beam = model.beams[part.beam]
    e, xi = model.line(beam, z).locate(part.zeta)
    elements, begins, number = np.unique(e, return_index=True, return_inverse=True)
    local = 2 * number
    line = model.separate_elements(beam, elements, z)
    g = np.zeros_like(xi) if part.distributed else xi * (1.0 + xi * (2.0 * xi - 3.0)) / 48.0
    turned = line.angles[local + 1] - line.angles[local]
    return _LoadPlaces(line, elements, begins, local, xi - g * turned**2, xi, -2.0 * g * turned, -2.0 * g)


def _compliances(model: Model, part: BeamLoadPart, placed: _LoadPlaces) -> tuple[Array, Array]:
    """c and c_t (k,) at the places of forces."""
    beam, elements, xi = model.beams[part.beam], model.elements, placed.xi
    e = beam.elements.start + placed.elements
    L, sigma = elements.length[e], 1.0 - elements.slip[:, e].sum(axis=0)
    bending = beam.bending(part.zeta / model.line(beam, model.start).n)
    uv = xi * (1.0 - xi)
    across = L**3 * uv * (uv * (1.0 - sigma * (1.0 - 2.0 * xi) ** 2) + 1.0 / sigma - 1.0) / (12.0 * bending)
    return np.asarray(across), np.asarray(elements.compliance[e] * L * uv)


@dataclass(frozen=True, slots=True)
class _Bubble:
    """Contribution of the bubble to the derivatives of W, ``local`` (7, k) and ``twice`` (7, 7, k), and to x (2, k)."""

    local: Array
    twice: Array
    moved: Array


def _bubble(line: NeutralLine, e: Index, gives: tuple[Array, Array], f: Array) -> _Bubble:
    t, n, turn, stretch = _chord(line, e)
    c, c_t = gives
    across, ahead = (f * n).sum(axis=0), (f * t).sum(axis=0)
    both = stretch[:, None] * turn[None, :]
    twice = (ahead**2 - across**2) * turn[:, None] * turn[None, :] + across * ahead * (both + both.transpose(1, 0, 2))
    return _Bubble((c_t - c) * across * ahead * turn, (c - c_t) * twice, c * across * n + c_t * ahead * t)


def _chord(line: NeutralLine, e: Index) -> tuple[Array, Array, Array, Array]:
    """t and n (2, k) of elements (k,), and dα and dl/l by the unknowns of the element lines (7, k)."""
    dx, dy = line.points[:, e + 1] - line.points[:, e]
    l = np.hypot(dx, dy)  # noqa: E741 - the chord's length
    t, n = np.stack([dx, dy]) / l, np.stack([-dy, dx]) / l
    turn, stretch = np.zeros((LINE, l.size)), np.zeros((LINE, l.size))
    turn[:2], turn[3:5] = -n / l, n / l
    stretch[:2], stretch[3:5] = -t / l, t / l
    return t, n, turn, stretch


def load_forces(model: Model, part: OnBeam, z: State) -> Array:
    """Generalised forces (size,) of a unit load, without the bubbles."""
    beam = model.beams[part.beam]
    if isinstance(part, BeamMomentPart):
        unit_load = _beam_moment(model, part, 1.0, z)
        return model.spread(unit_load.dofs, unit_load.gradient)
    placed = _load_places(model, part, z)
    chain = model.separate_chain(beam, placed.elements, z)
    return model.spread(chain.dofs, chain.gradient(placed.projected_gradient(part.forces)[0]))


def force_before(load: BeamLoad, line: NeutralLine, zeta: Array) -> Array:
    """Force (2, k) of the part of the load before places ``zeta`` (k,) of ``line``, within the same element."""
    part, (e, _) = load.part, line.locate(zeta)
    if isinstance(part, BeamMomentPart):
        return np.zeros((2, zeta.size))
    if not part.distributed:
        owner, _ = line.locate(part.zeta)
        return np.asarray(load.force * ((e == owner) & (part.zeta < zeta)))
    first = np.clip(part.begin, e, zeta)
    length = (np.clip(part.end, first, zeta) - first) * line.lengths[e]
    return np.asarray(load.value * part.density[:, None] * length)


def moment_before(load: BeamLoad, line: NeutralLine, zeta: Array) -> Array:
    """Moment (k,) about places ``zeta`` (k,) of ``line`` by the part of the load before, within the same element."""
    part, (e, _) = load.part, line.locate(zeta)
    if isinstance(part, BeamMomentPart):
        owner, _ = line.locate(np.array([part.zeta]))
        return np.where((e == owner) & (part.zeta < zeta), load.value, 0.0)
    x = line.at(zeta)[0]
    if not part.distributed:
        owner, _ = line.locate(part.zeta)
        arm = (load.place - x) * ((e == owner) & (part.zeta < zeta))
        return np.asarray(arm[0] * load.force[1] - arm[1] * load.force[0])
    first = np.clip(part.begin, e, zeta)
    half = 0.5 * (np.clip(part.end, first, zeta) - first)
    at = first + half * (1.0 + _POINTS[:, None])
    arm = line.at(at.ravel())[0].reshape(2, *at.shape) - x[:, None]
    share = half * line.lengths[e] * _WEIGHTS[:, None]
    force = load.value * part.density[:, None, None] * share
    return np.asarray((arm[0] * force[1] - arm[1] * force[0]).sum(axis=0))
