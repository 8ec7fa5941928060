"""All quantities that follow from the unknowns.

Scalars are columns (K,), one column per derivative, and vectors (k, K).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cprbm_scene.answer import Array
from elastica_reference.model import Model
from elastica_reference.spectral import Piece

Columns = NDArray[Any]
"""Scalars (K,) or vectors (k, K), one column per derivative."""


@dataclass(frozen=True, slots=True)
class Part:
    """A piece of a beam from ``a`` to ``b`` (K,): states ``start`` (6, K) and ``end`` (4, K), and the solution.

    ``spread`` (2, K) is the distributed load on the piece.
    """

    a: Columns
    b: Columns
    start: Columns
    end: Columns
    spread: Columns
    solved: Piece

    @property
    def force(self) -> Columns:
        """Internal force (2, K) at the start."""
        return self.start[4:]

    @property
    def end_force(self) -> Columns:
        """Internal force (2, K) at the end."""
        force: Columns = self.start[4:] - self.spread * (self.b - self.a)
        return force


@dataclass(frozen=True, slots=True)
class Zone:
    """Zone of a beam on a circle, from ``a`` to ``b`` (K,).

    ``place`` (2, K) and ``angle`` (K,) of the beam at a; internal force (2, K) ``before`` and ``after`` the zone, and
    just inside its ``first`` and ``last`` end.
    """

    a: Columns
    b: Columns
    place: Columns
    angle: Columns
    before: Columns
    after: Columns
    first: Columns
    last: Columns


@dataclass(frozen=True, slots=True)
class EndAction:
    """Action of a beam's end on its support: ``force`` (2, K) at ``place`` (2, K) and ``moment`` (K,)."""

    place: Columns
    force: Columns
    moment: Columns


@dataclass
class Evaluation:
    """All quantities for given unknowns.

    Attributes:
        model: the mechanism.
        rows: the equations, zero at equilibrium.
        placements: displacement and rotation (3, K) of every body's reference.
        on_body: force and moment (3, K) on a body, about its reference, of beams, contacts, loads and drives.
        parts: the pieces of every beam.
        ends: action of a beam's end, by (beam, "start" or "end").
        resultants: force (2, K) of a contact on its beam; for two beams on ``Meeting.beam``.
        centres: centres of circles (2, K), by contact.
        zones: zones of wraps, by contact.
        turnings: position of a knot's rotation among the unknowns, and number of the row for a couple, by beam and
            knot.
    """

    model: Model
    rows: list[Columns] = field(default_factory=list)
    placements: dict[str, Columns] = field(default_factory=dict)
    on_body: dict[str, Columns] = field(default_factory=dict)
    parts: dict[str, list[Part]] = field(default_factory=dict)
    ends: dict[tuple[str, str], EndAction] = field(default_factory=dict)
    resultants: dict[str, Columns] = field(default_factory=dict)
    centres: dict[str, Columns] = field(default_factory=dict)
    zones: dict[str, Zone] = field(default_factory=dict)
    turnings: dict[tuple[str, float], tuple[int, int]] = field(default_factory=dict)

    def moved(self, body: str, rest: Array) -> Columns:
        """Current position (2, K) of a body's point with the reference position ``rest`` (2,)."""
        u, v, phi = self.placements[body]
        x, y = rest - self.model.reference(body)
        # cos φ − 1 as −2 sin²(φ/2), exact for small rotations
        cos_minus_one, sin = -2.0 * np.sin(0.5 * phi) ** 2, np.sin(phi)
        return np.stack([rest[0] + u + cos_minus_one * x - sin * y, rest[1] + v + sin * x + cos_minus_one * y])

    def turned(self, body: str, rest: Array) -> Columns:
        """Vector (2, K) from a body's reference to its point with the reference position ``rest`` (2,)."""
        phi = self.placements[body][2]
        x, y = rest - self.model.reference(body)
        return np.stack([np.cos(phi) * x - np.sin(phi) * y, np.sin(phi) * x + np.cos(phi) * y])

    def act(self, body: str, place: Columns, force: Columns, moment: Columns | float = 0.0) -> None:
        """Add a force (2, K) at a place (2, K) and a moment (K,) to the forces on a body."""
        arm = place - self.moved(body, self.model.reference(body))
        turning = moment + arm[0] * force[1] - arm[1] * force[0]
        self.on_body[body] = self.on_body[body] + np.stack([force[0], force[1], turning])

    def angle(self, beam: str, which: str) -> Columns:
        """Tangent angle (K,) of a beam's welded ``start`` or ``end``."""
        strip = self.model.strips[beam]
        end, s = (strip.start, 0.0) if which == "start" else (strip.end, strip.length)
        assert end.point is not None
        rest = float(strip.line.angle(np.array([s]))[0])
        turned: Columns = rest + self.placements[self.model.scene.body_of(end.point)][2]
        return turned

    def real(self) -> Evaluation:
        """The real part of the first column of all quantities."""

        def one(columns: Columns) -> Columns:
            return np.ascontiguousarray(columns[..., :1].real)

        return Evaluation(
            model=self.model,
            rows=[one(row) for row in self.rows],
            placements={name: one(columns) for name, columns in self.placements.items()},
            on_body={name: one(columns) for name, columns in self.on_body.items()},
            parts={
                beam: [
                    Part(one(part.a), one(part.b), one(part.start), one(part.end), one(part.spread), part.solved)
                    for part in parts
                ]
                for beam, parts in self.parts.items()
            },
            ends={key: EndAction(one(end.place), one(end.force), one(end.moment)) for key, end in self.ends.items()},
            resultants={name: one(columns) for name, columns in self.resultants.items()},
            centres={name: one(columns) for name, columns in self.centres.items()},
            zones={
                name: Zone(
                    one(zone.a),
                    one(zone.b),
                    one(zone.place),
                    one(zone.angle),
                    one(zone.before),
                    one(zone.after),
                    one(zone.first),
                    one(zone.last),
                )
                for name, zone in self.zones.items()
            },
            turnings=self.turnings,
        )
