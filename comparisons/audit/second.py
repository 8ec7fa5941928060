"""The smallest curvature of the potential energy on the feasible directions, from the forces and the shape.

==========  ==============================================================================================
q           small motions: turns δψ of every beam along it, its start's place, bodies' (u, v, φ)
F(s)        sum of all forces on a beam beyond s; t its tangent, p a place of it
D, T        distance of neutral lines where they touch, and of what touches from the other's line
n, λ        direction in which a contact presses the first beam, and how hard
a           n·x″ of what the first beam touches; Z = 1 − D a; σ′ = 1/Z
p_τ, k      part of the relative motion along the contact; n·δx′ of the other line, k_A of the first
κ_A         n·x″ of the first beam
==========  ==============================================================================================

All forces, reactions and contacts among them, are dead for the second variation as long as their places stay:

    δ²Π = ∫ E·I δψ′² ds + ∫ (F·t) δψ² ds + Σ_bodies (Σ f·r) φ²
          + Σ_contacts λ [(a p_τ² + D k² + 2 p_τ k)/Z + (k_A − σ′(k + a p_τ))²/(κ_A − a/Z)]

where D is that from the other's line to the first's; the last part is of a contact in one place, which travels on both.
Joints, slides, drives and what presses leave the directions on which it is looked at.  The shape is a polygon here, of
links or between nodes, so that the number is that of the continuum but for a part of h², whatever the discretisation.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh, null_space

from comparisons.audit.areas import AreaOfBeam
from comparisons.audit.links import Links
from comparisons.audit.rest import Complex
from comparisons.audit.seen import Acting, AnyBeam, Seen
from cprbm_scene.answer import Array, Flags, Ints
from cprbm_scene.statement import (
    BeamContact,
    CircleContact,
    DisplacementDrive,
    FreeEnd,
    FunctionContact,
    SelfContact,
    SlidingBody,
    TurningBody,
    WeldedEnd,
)

SURE = 0.03  # EI/ℓ²: a curvature this far below zero is no discretisation's
COARSE = 2.0  # the same over the square of the fewest elements
MOST = 48  # turns of a beam that are looked at
SPOT = 2.0  # elements
FAR = 1e-6  # rad: a link that lies within this of a stop


@dataclass(frozen=True)
class _Rows:
    """Where the unknowns stand: of each beam the ``turns`` and the start's ``place``, of bodies (u, v, φ).

    ``polygons`` are what :func:`_polygon` says of every beam.
    """

    turns: dict[str, slice]
    places: dict[str, int]
    bodies: dict[str, int]
    size: int
    polygons: dict[str, tuple[Array, Complex, Array]]


def saddles(seen: Seen, least: float | None) -> Iterator[str]:
    """Whether a state whose smallest curvature is the ``least`` is no minimum of the potential energy."""
    if least is None:
        return
    fewest = min(len(_knots(beam)) - 1 for beam in seen.beams.values())
    if not least >= -(SURE + COARSE / fewest**2):
        yield f"the energy's smallest curvature on the feasible directions is {least:.3g} EI/ℓ²: it is no minimum"


def smallest_curvature(seen: Seen) -> float | None:
    """Of δ²Π over ∫ δψ² ds, in units of the largest E·I over the square of the longest beam.

    None where something presses whose curvature is not known here: a beam on itself, or on a curved edge; and of areas.
    """
    if any(isinstance(beam, AreaOfBeam) for beam in seen.beams.values()):
        return None
    pressed = {by for by in seen.statics.by if by in seen.scene.contacts}
    if any(isinstance(seen.scene.contacts[name], SelfContact | FunctionContact) for name in pressed):
        return None
    rows = _rows(seen)
    H, M = _energy(seen, rows)
    kept = [*_joints(seen, rows)]
    for name in sorted(pressed):
        kept += _contact(seen, rows, name, H)
    A = np.array(kept).reshape(-1, rows.size)
    size = np.linalg.norm(A, axis=1, keepdims=True)
    Z = null_space(A / np.where(size > 0.0, size, 1.0), rcond=1e-9) if len(A) else np.eye(rows.size)
    if not Z.shape[1]:
        return np.inf
    EI = max(float(np.max(rest.rigidity(np.linspace(0.0, rest.length, 33)))) for rest in seen.rests.values())
    mass = Z.T @ (M[:, None] * Z)
    small = 1e-9 * float(np.trace(mass)) / len(mass)  # bodies that turn while no beam does have none of their own
    least = eigh(Z.T @ H @ Z, mass + small * np.eye(len(mass)), eigvals_only=True, subset_by_index=[0, 0])[0]
    return float(least) * seen.longest**2 / EI


def _rows(seen: Seen) -> _Rows:
    turns, places, bodies, size = dict[str, slice](), dict[str, int](), dict[str, int](), 0
    for name, beam in seen.beams.items():
        turns[name] = slice(size, size + len(_knots(beam)))
        size = turns[name].stop
        places[name], size = size, size + 2
    for name in seen.statics.bodies:
        bodies[name], size = size, size + 3
    return _Rows(turns, places, bodies, size, {name: _polygon(seen, name) for name in seen.beams})


def _polygon(seen: Seen, name: str) -> tuple[Array, Complex, Array]:
    """Ends of pieces (m+1,) by arc length, their corners, and how much each turn has of each piece, (m, n+1)."""
    beam = seen.beams[name]
    knots = _knots(beam)
    n = len(knots)
    if isinstance(beam, Links) and n == len(beam.inside.borders):
        return beam.joints_at, beam.joints, np.eye(n)
    shares = np.zeros((n - 1, n))
    np.fill_diagonal(shares, 0.5)
    np.fill_diagonal(shares[:, 1:], 0.5)
    return knots, beam.line(knots)[0], shares


def _knots(beam: AnyBeam) -> Array:
    """Arc lengths where turns are unknown: borders of elements, of many every few."""
    e = beam.inside.borders
    every = -(-(len(e) - 1) // MOST)
    return np.append(e[:-1:every], e[-1])


def _moved(seen: Seen, rows: _Rows, name: str, s: float) -> Array:
    """δp at an arc length over q, (2, size): of the polygon, with what is left of the piece there."""
    ends, corners, shares = rows.polygons[name]
    found = np.zeros((2, rows.size))
    found[:, rows.places[name] : rows.places[name] + 2] = np.eye(2)
    steps = np.diff(corners)
    part = np.clip((s - ends[:-1]) / np.diff(ends), 0.0, 1.0)
    turned = 1j * steps * part
    found[:, rows.turns[name]] = turned.real @ shares, turned.imag @ shares
    return found


def _turned(seen: Seen, rows: _Rows, name: str, s: float) -> Array:
    """δψ at an arc length over q, (size,)."""
    found = np.zeros(rows.size)
    knots = _knots(seen.beams[name])  # of links that of link i is the tangent at border i
    i = int(np.clip(np.searchsorted(knots, s) - 1, 0, len(knots) - 2))
    share = (s - knots[i]) / (knots[i + 1] - knots[i])
    found[rows.turns[name].start + i : rows.turns[name].start + i + 2] = 1.0 - share, share
    return found


def _carried(seen: Seen, rows: _Rows, body: str, place: complex) -> Array:
    """δp of a place fixed to a body over q, (2, size)."""
    found = np.zeros((2, rows.size))
    if body in rows.bodies:
        first, moved, _ = seen.motion(body)
        r, at = place - first - moved, rows.bodies[body]
        found[:, at : at + 3] = [[1.0, 0.0, -r.imag], [0.0, 1.0, r.real]]
    return found


def _energy(seen: Seen, rows: _Rows) -> tuple[Array, Array]:
    """Twice the second variation with dead forces, (size, size), and what motions are measured by, (size,)."""
    H, M = np.zeros((rows.size, rows.size)), np.zeros(rows.size)
    for name, beam in seen.beams.items():
        e, acting, at = _knots(beam), seen.acting[name], rows.turns[name]
        _, s, _ = beam.rest.over(e)
        K = 1.0 / beam.rest.summed(e, 1.0 / beam.rest.rigidity(s))
        n = len(e)
        stiff = np.zeros((n, n))
        i = np.arange(n - 1)
        stiff[i, i] += K
        stiff[i + 1, i + 1] += K
        stiff[i, i + 1] -= K
        stiff[i + 1, i] -= K
        ends, corners, shares = rows.polygons[name]
        steps = np.diff(corners)
        pull = np.array([_along(acting, *piece) for piece in zip(ends[:-1], ends[1:], steps, strict=True)])
        H[at, at] = stiff + shares.T @ (pull[:, None] * shares)
        M[at] = shares.T @ np.abs(steps)
    for name, row in rows.bodies.items():
        first, moved, _ = seen.motion(name)
        acting = seen.acting[name]
        H[row + 2, row + 2] += float(((acting.places - first - moved) * np.conj(acting.forces)).real.sum())
    return H, M


def _along(acting: Acting, begin: float, end: float, step: complex) -> float:
    """(F·t) ds over a piece: of a force within it, what of the piece lies before."""
    before = np.clip((acting.s - begin) / (end - begin), 0.0, 1.0)
    return float((acting.forces * before * np.conj(step)).real.sum())


def _joints(seen: Seen, rows: _Rows) -> Iterator[Array]:
    """Motions that joints, slides, pivots, pins, drives and stops do not allow, (size,) each."""
    scene = seen.scene
    for name, beam in scene.beams.items():
        for end, s in ((beam.start, 0.0), (beam.end, seen.rests[name].length)):
            if isinstance(end, FreeEnd):
                continue
            owner = scene.body_of(end.point)
            yield from _moved(seen, rows, name, s) - _carried(seen, rows, owner, seen.point(end.point))
            if isinstance(end, WeldedEnd) or _stopped(seen, name, end.point):
                yield _turned(seen, rows, name, s) - _turning(rows, owner)
    for name, body in scene.bodies.items():
        if isinstance(body, SlidingBody):
            across = np.array((-body.along[1], body.along[0])) / np.hypot(*body.along)
            at = seen.point(next(iter(body.points)) if body.pin is None else body.pin)
            yield across @ _carried(seen, rows, name, at)
            if body.pin is None:
                yield _turning(rows, name)
        elif isinstance(body, TurningBody):
            yield from _carried(seen, rows, name, seen.point(body.about))
    for pin in scene.pins.values():
        one, other = (_carried(seen, rows, scene.body_of(point), seen.point(point)) for point in pin.points)
        yield from one - other
    for drive in scene.drives.values():
        if isinstance(drive, DisplacementDrive):
            moved = _carried(seen, rows, scene.body_of(drive.point), seen.point(drive.point))
            yield np.array(drive.direction) / np.hypot(*drive.direction) @ moved
        else:
            yield _turning(rows, drive.body)


def _turning(rows: _Rows, body: str) -> Array:
    found = np.zeros(rows.size)
    if body in rows.bodies:
        found[rows.bodies[body] + 2] = 1.0
    return found


def _stopped(seen: Seen, beam: str, point: str) -> bool:
    """Whether something holds a pinned end by a moment."""
    scene = seen.scene
    names = {name for name, stop in scene.stops.items() if stop.beam == beam}
    names |= {name for name, contact in scene.contacts.items() if beam in contact.beams}
    place = seen.point(point)
    acting = seen.acting[beam]
    return any(
        by in names and force == 0.0 and moment != 0.0 and abs(at - place) < FAR * seen.longest
        for by, force, moment, at in zip(acting.by, acting.forces, acting.moments, acting.places, strict=True)
    )


def _contact(seen: Seen, rows: _Rows, name: str, H: Array) -> list[Array]:
    """Rows of what presses; its curvature is added to ``H``."""
    contact = seen.scene.contacts[name]
    assert not isinstance(contact, SelfContact)
    first = contact.beams[0]
    mine = _of(seen.acting[first], name)
    other = contact.beams[1] if isinstance(contact, BeamContact) else None
    theirs = mine if other is None else _of(seen.acting[other], name)
    mine, theirs, alone = _in_spots(seen, (first, mine), (first if other is None else other, theirs))
    kept = []
    for k, s in enumerate(mine.s):
        if mine.forces[k] == 0.0:
            continue
        n = mine.forces[k] / abs(mine.forces[k])
        force, ahead = abs(mine.forces[k]), n * -1j
        moved_a, k_a = _moved(seen, rows, first, s), _leaning(seen, rows, first, s, n)
        place = seen.beams[first].line(np.array([s]))[0][0]
        if other is not None:
            sigma = float(theirs.s[k])
            at = seen.beams[other].line(np.array([sigma]))[0][0]
            moved_b, k_b = _moved(seen, rows, other, sigma), _leaning(seen, rows, other, sigma, n)
            end = min(sigma, seen.rests[other].length - sigma) < 1e-9 * seen.longest
            a, D = 0.0 if end else _bend(seen, other, sigma, n), abs(place - at)
            sense = 1.0 if (_ahead(seen, other, sigma) * np.conj(ahead)).real > 0.0 else -1.0
            k_b = sense * k_b  # by the arc length that goes along ``ahead``
        else:
            assert not isinstance(contact, BeamContact)
            half = 0.5 * float(seen.rests[first].thickness(np.array([s]))[0]) if contact.thick else 0.0
            moved_b = _carried(seen, rows, contact.body, place - half * n)
            a, D = (-1.0 / contact.radius if isinstance(contact, CircleContact) else 0.0), half
            k_b = _turning(rows, contact.body)
        direction, along = np.array((n.real, n.imag)), np.array((ahead.real, ahead.imag))
        relative = moved_a - moved_b
        kept.append(direction @ relative)
        p, Z = along @ relative, 1.0 - D * a
        row = np.outer(p, k_b)
        H += force * (a * np.outer(p, p) + D * np.outer(k_b, k_b) + row + row.T) / Z
        inner = 0.0 < s < seen.rests[first].length
        parting = _bend(seen, first, s, n) - a / Z
        if alone[k] and inner and parting > 0.0:
            leaning = k_a * (1.0 if (_ahead(seen, first, s) * np.conj(ahead)).real > 0.0 else -1.0)
            across = leaning - (k_b + a * p) / Z
            H += force * np.outer(across, across) / parting
    return kept


def _of(acting: Acting, name: str) -> Acting:
    mine = np.array([by == name for by in acting.by], dtype=bool) & (np.abs(acting.forces) > 0.0)
    return Acting((), acting.s[mine], acting.places[mine], acting.forces[mine], acting.moments[mine])


def _in_spots(seen: Seen, one: tuple[str, Acting], other: tuple[str, Acting]) -> tuple[Acting, Acting, Flags]:
    """What presses on two beams, by their names, with the resultant of what is in one place; and which are such.

    A place, as finely as it is known, is what is spread over no more than two elements, and farther than that from all
    else that presses.
    """
    mine = one[1]
    if not mine.s.size:
        return mine, other[1], np.zeros(0, dtype=bool)
    order = np.argsort(mine.s, kind="stable")
    apart = np.diff(mine.s[order]) > SPOT * _element(seen, one[0], mine.s[order][:-1])
    found, alone = [], []
    for group in np.split(order, np.flatnonzero(apart) + 1):
        spot = all(
            float(np.ptp(acting.s[group])) <= SPOT * float(_element(seen, name, acting.s[group]).max())
            for name, acting in (one, other)
        )
        parts = [group] if spot else list(group[:, None])
        found += [tuple(_resultant(seen, name, acting, part) for name, acting in (one, other)) for part in parts]
        alone += [spot] * len(parts)
    return _together([pair[0] for pair in found]), _together([pair[1] for pair in found]), np.array(alone, dtype=bool)


def _element(seen: Seen, name: str, s: Array) -> Array:
    """The longer of the elements to which places of a beam belong, (k,)."""
    e = seen.beams[name].inside.borders
    sizes, close = np.diff(e), 1e-9 * e[-1]
    sides = [np.clip(np.searchsorted(e, s + shift) - 1, 0, len(sizes) - 1) for shift in (-close, close)]
    return np.asarray(np.maximum(*(sizes[side] for side in sides)))


def _resultant(seen: Seen, name: str, acting: Acting, part: Ints) -> Acting:
    """That of a ``part`` of what acts, where its middle is."""
    weights = np.abs(acting.forces[part])
    s = np.array([weights @ acting.s[part] / weights.sum()])
    return Acting((), s, seen.beams[name].line(s)[0], np.array([acting.forces[part].sum()]), np.zeros(1))


def _together(parts: list[Acting]) -> Acting:
    s, places, forces, moments = (
        np.concatenate([getattr(each, what) for each in parts]) for what in ("s", "places", "forces", "moments")
    )
    return Acting((), s, places, forces, moments)


def _ahead(seen: Seen, name: str, s: float) -> complex:
    return complex(np.exp(1j * seen.beams[name].line(np.array([s]))[1][0]))


def _leaning(seen: Seen, rows: _Rows, name: str, s: float, n: complex) -> Array:
    """n·δx′ by a beam's own arc length, over q (size,)."""
    return float((1j * _ahead(seen, name, s) * np.conj(n)).real) * _turned(seen, rows, name, s)


def _bend(seen: Seen, name: str, s: float, n: complex) -> float:
    """n·x″ of a beam, from the turning over two elements about the place."""
    beam, L = seen.beams[name], seen.rests[name].length
    h = float(np.diff(beam.inside.borders).max())
    ends = np.clip(np.array([s - h, s + h]), 0.0, L)
    psi = np.unwrap(beam.line(ends)[1])
    side = (1j * _ahead(seen, name, s) * np.conj(n)).real
    return float(side * (psi[1] - psi[0]) / (ends[1] - ends[0]))
