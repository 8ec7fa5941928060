"""Rows of a scene: guides of bodies, joints of beams, pins between bodies, drives, stops, loads, and the assembly.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
β        angle from the line between a stop's two points to the beam's direction away from the pin
β₀       β as drawn, in (−π, π]
F, f     value of a load, quantity with the load's energy −F f(z)
C(s)     neutral line, a sum of weights and nodes
=======  ====================================================================================

A force on a beam works on the displacement of C(s), a distributed load on the displacement's integral, and a moment
on the section's angle at s.  All three are linear in the unknowns of the chain.

A stop has the rows β − β_least ≥ 0 and β_most − β ≥ 0.  The names of a joint's rows are ``beam@start.x``, ``.y``,
``.turn``; a stop's rows are ``stop.least`` and ``stop.most``; the row of a load or a drive has the same name.

The gradient of the Lagrangian by z is the chains' gradient plus Σ μ ∂f/∂z of the rows.  By the multiplier of a row
with prescribed value the gradient is f(z) − f*.
"""

from collections.abc import Iterator
from math import cos, hypot, pi, remainder, sin, tau
from typing import Literal, NamedTuple

import numpy as np
from scipy.sparse import csr_matrix

from cprbm.chain.compiled import compiled, compiled_inner
from cprbm.chain.loads import unit_force, unit_moment
from cprbm.chain.mechanism import AXES, Direction, Form, Mechanism, Row, node_coordinate
from cprbm_scene import FreeEnd, Scene, WeldedEnd
from cprbm_scene.answer import Array, Ints
from cprbm_scene.statement import (
    BeamEnd,
    BeamForce,
    BeamMoment,
    DisplacementDrive,
    Force,
    Moment,
    PinnedEnd,
    SlidingBody,
    TurningBody,
)

APART = 1e-6
"""Distance of an end from its point, over the beam's length, from which the end is drawn apart (the scene's limit)."""

STRAIGHT = 1e-9
"""Distance of β₀ from −π, rad, below which it is π: round-off decides between the two."""

END: tuple[Literal["start"], Literal["end"]] = ("start", "end")


class RowArrays(NamedTuple):
    """Rows: index of the first multiplier, constants; terms with the number of their row."""

    first: int
    constant: Array
    linear_row: Ints
    linear_index: Ints
    linear_factor: Array
    turning_row: Ints
    turning_index: Ints
    turning_cos: Array
    turning_sin: Array


def add_rows(m: Mechanism) -> None:
    """Add all rows of the scene to the mechanism."""
    for rows in (_guides, _beam_ends, _body_pins, _drives, _stops, _loads, _assembly):
        m.rows.extend(rows(m))


def ends_of(scene: Scene, beam: str) -> tuple[BeamEnd, BeamEnd]:
    """Records of a beam's start and end."""
    return scene.beams[beam].start, scene.beams[beam].end


def apart_ends(m: Mechanism) -> list[tuple[str, str]]:
    """Beams with ends drawn apart from their points, in a scene with an assembly."""
    beams = m.scene.beams if m.scene.assembly is not None else ()
    return [
        (beam, end)
        for beam in beams
        for end, node, record in zip(END, m.chains[beam].nodes[[0, -1]], ends_of(m.scene, beam), strict=True)
        if isinstance(record, PinnedEnd)
        and hypot(*(node - m.units.place(m.scene.place_of(record.point)))) > APART * m.chains[beam].length
    ]


def _guides(m: Mechanism) -> Iterator[Row]:
    for name, body in m.scene.bodies.items():
        if isinstance(body, TurningBody):
            for axis, direction in AXES:
                yield Row(f"{name}.pivot.{axis}", m.displacement(body.about, direction))
        elif isinstance(body, SlidingBody):
            point = body.pin or next(iter(body.points))
            along = unit_direction(body.along)
            yield Row(f"{name}.slide", m.displacement(point, (-along[1], along[0])))
            if not body.turns:
                yield Row(f"{name}.level", m.rotation(name))


def _beam_ends(m: Mechanism) -> Iterator[Row]:
    for beam in m.scene.beams:
        nodes = m.beam_nodes(beam)[[0, -1]]
        for end, node, link, record in zip(END, nodes, (0, -1), ends_of(m.scene, beam), strict=True):
            if isinstance(record, FreeEnd):
                continue
            for axis, direction in AXES:
                form = node_coordinate(int(node), direction) - m.point(record.point, direction)
                yield Row(f"{beam}@{end}.{axis}", form)
            if isinstance(record, WeldedEnd):
                yield Row(f"{beam}@{end}.turn", m.angle(beam, link) - m.rotation(m.scene.body_of(record.point)))


def _body_pins(m: Mechanism) -> Iterator[Row]:
    for name, pin in m.scene.pins.items():
        for axis, direction in AXES:
            yield Row(
                f"{name}.{axis}", m.displacement(pin.points[0], direction) - m.displacement(pin.points[1], direction)
            )


def _drives(m: Mechanism) -> Iterator[Row]:
    for name, drive in m.scene.drives.items():
        driven = m.scene.holds(drive, m.scene.stages[0].name)
        if isinstance(drive, DisplacementDrive):
            form = m.displacement(drive.point, unit_direction(drive.direction))
            yield Row(name, form, driven=driven, unit=1.0 / m.units.length)
        else:
            yield Row(name, m.rotation(drive.body), driven=driven, unit=1.0)


def _loads(m: Mechanism) -> Iterator[Row]:
    for name, load in m.scene.loads.items():
        per_force, per_moment, unit_load = -1.0 / m.units.force, -1.0 / m.units.moment, None
        match load:
            case Moment():
                form, unit = m.rotation(load.body), per_moment
            case Force():
                form, unit = m.displacement(load.point, unit_direction(load.direction)), per_force
            case BeamMoment():
                chain, at = m.chains[load.beam], load.at * m.chains[load.beam].length
                links, factors = (each[0] for each in chain.angle_weights(np.array([at])))
                form, unit = _weighted(m.beam_angles(load.beam), chain.link_angle, links, factors), per_moment
                unit_load = unit_moment(chain, at, links, factors)
            case BeamForce():
                chain, at = m.chains[load.beam], load.at * m.chains[load.beam].length
                weights, along = chain.line.weights(np.array([at])), unit_direction(load.direction)
                form, unit = _displaced(m, load.beam, weights, along), per_force
                unit_load = unit_force(m, load.beam, along, at, weights)
            case _:
                chain = m.chains[load.beam]
                begin, end = (fraction * chain.length for fraction in load.along)
                places = np.concatenate([[begin], chain.arcs[(chain.arcs > begin) & (chain.arcs < end)], [end]])
                weights = csr_matrix(chain.line.integrals(places).sum(axis=0))
                form = _displaced(m, load.beam, weights, unit_direction(load.direction))
                unit = per_force * m.units.length
        yield Row(name, form, driven=False, unit=unit, unit_load=unit_load)


def _displaced(m: Mechanism, beam: str, weights: csr_matrix, direction: Direction) -> Form:
    """Weighted displacement of a beam's nodes along a unit ``direction``."""
    nodes, rest = m.beam_nodes(beam), m.chains[beam].nodes
    x, y = (_weighted(nodes + k, rest[:, k], weights.indices, weights.data) * direction[k] for k in (0, 1))
    return x + y


def _weighted(indices: Ints, rest: Array, used: Ints, factors: Array) -> Form:
    """Weighted change of the ``used`` unknowns from their values at rest."""
    terms = zip(indices[used].tolist(), factors.tolist(), strict=True)
    return Form(-float(rest[used] @ factors), tuple(term for term in terms if term[1] != 0.0))


def _stops(m: Mechanism) -> Iterator[Row]:
    for name, stop in m.scene.stops.items():
        form = stop_angle(m, name)
        if stop.least is not None:
            yield Row(f"{name}.least", form - Form(stop.least), driven=False, limit=True)
        if stop.most is not None:
            yield Row(f"{name}.most", Form(stop.most) - form, driven=False, limit=True)


def stop_angle(m: Mechanism, name: str) -> Form:
    """β of a stop, rad."""
    stop = m.scene.stops[name]
    joint = ends_of(m.scene, stop.beam)[END.index(stop.end)]
    assert not isinstance(joint, FreeEnd)
    line = np.subtract(m.scene.place_of(stop.towards), m.scene.place_of(joint.point))
    drawn = remainder(m.chains[stop.beam].leaving_angle(stop.end) - float(np.arctan2(line[1], line[0])), tau)
    drawn += tau if drawn < STRAIGHT - pi else 0.0
    turned = m.angle(stop.beam, 0 if stop.end == "start" else -1)
    return turned - m.rotation(m.scene.body_of(joint.point)) + Form(drawn)


def _assembly(m: Mechanism) -> Iterator[Row]:
    """Moments on ends drawn apart, of other beams on the end."""
    if m.scene.assembly is None:
        return
    apart = dict(apart_ends(m))
    for beam in m.scene.assembly.moments:
        form = m.angle(beam, 0 if apart.get(beam) == "start" else -1)
        yield Row(f"assembly.{beam}", form, driven=False, unit=-1.0 / m.units.moment)


def unit_direction(direction: Direction) -> Direction:
    """Unit vector of a direction."""
    size = hypot(*direction)
    return direction[0] / size, direction[1] / size


def row_arrays(m: Mechanism) -> RowArrays:
    """Terms of all rows."""
    linear = [(r, i, a) for r, row in enumerate(m.rows) for i, a in row.form.linear if a != 0.0]
    turning = [(r, *term) for r, row in enumerate(m.rows) for term in row.form.turning]
    return RowArrays(
        len(m.rest),
        np.array([row.form.constant for row in m.rows], dtype=float),
        np.array([r for r, _, _ in linear], dtype=np.int64),
        np.array([i for _, i, _ in linear], dtype=np.int64),
        np.array([a for _, _, a in linear], dtype=float),
        np.array([r for r, _, _, _ in turning], dtype=np.int64),
        np.array([i for _, i, _, _ in turning], dtype=np.int64),
        np.array([A for _, _, A, _ in turning], dtype=float),
        np.array([B for _, _, _, B in turning], dtype=float),
    )


@compiled
def row_values(z: Array, rows: RowArrays) -> Array:  # pragma: no cover
    """f of all rows."""
    values = rows.constant.copy()
    for t in range(rows.linear_row.size):
        values[rows.linear_row[t]] += rows.linear_factor[t] * z[rows.linear_index[t]]
    for t in range(rows.turning_row.size):
        half = sin(0.5 * z[rows.turning_index[t]])
        turned = -2.0 * rows.turning_cos[t] * half * half + rows.turning_sin[t] * sin(z[rows.turning_index[t]])
        values[rows.turning_row[t]] += turned
    return values


@compiled_inner
def add_row_gradient(z: Array, rows: RowArrays, weight: Array, gradient: Array) -> None:  # pragma: no cover
    """Add Σ weight ∂f/∂z of all rows to ``gradient``."""
    for t in range(rows.linear_row.size):
        gradient[rows.linear_index[t]] += weight[rows.linear_row[t]] * rows.linear_factor[t]
    for t in range(rows.turning_row.size):
        angle = z[rows.turning_index[t]]
        slope = rows.turning_sin[t] * cos(angle) - rows.turning_cos[t] * sin(angle)
        gradient[rows.turning_index[t]] += weight[rows.turning_row[t]] * slope
