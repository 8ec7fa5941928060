"""A beam as the strip that it is: its sections along the deformed neutral line, and what stresses them.

======  ========================================================================================
symbol  meaning
======  ========================================================================================
s       initial arc length of a section, m; the sections are at equal steps of it
x(s)    its middle, m: a cubic spline through the places that a solver states
n(s)    unit normal to the left of x'(s); at rest that of the stress-free curve
t, w    thickness and width of the place, m
σ       bending stress as answers state it: at the right edge, where y = −t/2
M       bending moment, σ·w·t²/6
======  ========================================================================================

At a height y along n the bending stress is −2yσ/t: a moment that turns the tangent counter-clockwise presses the left.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.geometry import length, points
from cprbm_scene import Beam, Probe, Scene, StationAnswer
from cprbm_scene.answer import Array, Shape
from cprbm_scene.statement import Quantity

SECTIONS = 241
"""Places along a beam."""

_STEP = 1e-6  # of the length, by which the normal at rest is found

SHOWN: tuple[Quantity, ...] = ("bending_stress", "combined_stress")


@dataclass(frozen=True, slots=True)
class Strip:
    """A beam at a station, in n sections.

    Attributes:
        s: arc lengths, m (n,).
        line, normal: middles, m, and unit normals, (n, 2).
        rest_line, rest_normal: the same where the beam was drawn free of stress, (n, 2).
        thickness, width: m (n,).
        bending_stress, combined_stress: Pa (n,), as :mod:`cprbm_scene.answer` defines them.
    """

    s: Array
    line: Array
    normal: Array
    rest_line: Array
    rest_normal: Array
    thickness: Array
    width: Array
    bending_stress: Array
    combined_stress: Array

    @property
    def moment(self) -> Array:
        """M (n,), N·m."""
        return self.bending_stress * self.width * self.thickness**2 / 6.0

    def layer(self, eta: float) -> Array:
        """Places (n, 2), m, at y = η·t/2, η from −1 at the right edge to 1 at the left."""
        return np.asarray(self.line + 0.5 * eta * self.thickness[:, None] * self.normal)

    def rest_layer(self, eta: float) -> Array:
        """The same (n, 2) as drawn, free of stress."""
        return np.asarray(self.rest_line + 0.5 * eta * self.thickness[:, None] * self.rest_normal)


def with_stresses(scene: Scene) -> Scene:
    """The same question, which asks for the stresses of every beam at all sections besides."""
    asked = {f"{beam}.{quantity}" for beam in scene.beams for quantity in SHOWN}
    kept = tuple(probe for probe in scene.probes if probe.name not in asked)
    more = tuple(Probe(of=beam, quantity=quantity, points=SECTIONS) for beam in scene.beams for quantity in SHOWN)
    return scene.model_copy(update={"probes": kept + more})


def strips_at(scene: Scene, station: StationAnswer) -> dict[str, Strip]:
    """Every beam by its name, at a station of an answer to :func:`with_stresses`."""
    return {name: _strip(name, beam, station) for name, beam in scene.beams.items()}


def _strip(name: str, beam: Beam, station: StationAnswer) -> Strip:
    u = np.linspace(0.0, 1.0, SECTIONS)
    s = u * length(beam.curve)
    rest_line, rest_normal = at_rest(beam, u)
    line, normal = _deformed(station.shapes[name], u)
    bending, combined = (station.values[f"{name}.{quantity}"] for quantity in SHOWN)
    return Strip(
        s, line, normal, rest_line, rest_normal, beam.thickness_at(u), beam.width_at(u), bending, combined
    )  # fmt: skip


def at_rest(beam: Beam, u: Array) -> tuple[Array, Array]:
    """Places and unit normals (n, 2) of a beam as drawn, at fractions ``u`` (n,) of its arc length."""
    whole = length(beam.curve)
    around = [points(beam.curve, whole * np.clip(u + side * _STEP, 0.0, 1.0)) for side in (-1.0, 1.0)]
    return points(beam.curve, whole * u), _left_of(around[1] - around[0])


def _deformed(shape: Shape, u: Array) -> tuple[Array, Array]:
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(shape.s, np.stack([shape.x, shape.y], axis=1))
    s = u * shape.s[-1]
    return np.asarray(spline(s)), _left_of(spline(s, 1))


def _left_of(way: Array) -> Array:
    """Unit normals (n, 2) to the left of directions (n, 2)."""
    return np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(way[:, 0], way[:, 1])[:, None]
