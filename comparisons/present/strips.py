"""A beam as a strip: sections along the deformed neutral line, and their stresses.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
s       initial arc length of a section, m; the sections are at equal steps
x(s)    middle of the section, m: a cubic spline through the places that a solver states
n(s)    unit normal to the left of x'(s); at rest of the stress-free curve
t, w    thickness and width of the section, m
η       height over the section's half thickness, −1 at the right edge, 1 at the left edge
σ, τ    bending stress at the right edge, and largest magnitude over the section, Pa
M       bending moment, σ·w·t²/6, N·m
======  ==========================================================================================

At a height η the bending stress is −η·σ: a moment that turns the tangent counter-clockwise presses the left edge.
"""

from typing import Literal, NamedTuple

import numpy as np

from comparisons.geometry import length, points
from cprbm_scene import Array, Beam, Probe, Quantity, Scene, StationAnswer

Coloured = Literal["bending_stress", "combined_stress", "moment"]

SECTIONS = 241
"""Sections along a beam."""

_STEP = 1e-6  # share of a beam's length over which the normal at rest is a central difference
_STRESSES: tuple[Quantity, ...] = ("bending_stress", "combined_stress")


class Strip(NamedTuple):
    """A beam at a station in n sections.

    Attributes:
        s: arc lengths (n,), m.
        line, normal: x and n, (n, 2); rest_line, rest_normal: at rest.
        thickness, width: t and w, (n,), m.
        bending_stress, combined_stress: σ and τ, (n,), Pa; zero where the answer states neither stress nor moment.
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

    def places(self, u: Array) -> Array:
        """Places (k, 2), m, of the neutral line at fractions ``u`` (k,) of the arc length."""
        return np.stack([np.interp(u * self.s[-1], self.s, each) for each in self.line.T], axis=1)

    def layer(self, eta: float, *, rest: bool = False) -> Array:
        """Places (n, 2), m, at the height η of the beam, or of the beam at ``rest``."""
        line, normal = (self.rest_line, self.rest_normal) if rest else (self.line, self.normal)
        return np.asarray(line + 0.5 * eta * self.thickness[:, None] * normal)

    def outline(self, *, rest: bool = False) -> Array:
        """Polygon (2n, 2), m, of both edges."""
        return np.concatenate([self.layer(-1.0, rest=rest), self.layer(1.0, rest=rest)[::-1]])


def with_stresses(scene: Scene) -> Scene:
    """The scene with probes for the stresses of every beam at all sections."""
    asked = {f"{beam}.{quantity}" for beam in scene.beams for quantity in _STRESSES}
    kept = tuple(probe for probe in scene.probes if probe.name not in asked)
    more = tuple(Probe(of=beam, quantity=quantity, points=SECTIONS) for beam in scene.beams for quantity in _STRESSES)
    return scene.model_copy(update={"probes": kept + more})


def strip_of(name: str, beam: Beam, station: StationAnswer) -> Strip:
    """A beam at a station, with stated stresses, or else with stresses of stated moments and normal forces."""
    from scipy.interpolate import CubicSpline  # a command without a picture needs no SciPy

    u, whole, shape = np.linspace(0.0, 1.0, SECTIONS), length(beam.curve), station.shapes[name]
    t, w, s = beam.thickness_at(u), beam.width_at(u), u * whole
    spline = CubicSpline(shape.s, np.stack([shape.x, shape.y], axis=1))
    ahead, behind = (points(beam.curve, whole * np.clip(u + step, 0.0, 1.0)) for step in (_STEP, -_STEP))
    state = station.beams.get(name)
    M, N = np.zeros((2, SECTIONS)) if state is None else (np.interp(s, state.s, of) for of in (state.M, state.N))

    def stress(quantity: Quantity, otherwise: Array) -> Array:
        stated = station.values.get(f"{name}.{quantity}", np.empty(0))
        return np.interp(u, np.linspace(0.0, 1.0, stated.size), stated) if stated.size else otherwise

    bending = stress("bending_stress", 6.0 * M / (w * t**2))
    combined = stress("combined_stress", np.abs(bending) + np.abs(N / (w * t)))
    along = u * shape.s[-1]
    return Strip(s, np.asarray(spline(along)), left_of(spline(along, 1)), points(beam.curve, s),
                 left_of(ahead - behind), t, w, bending, combined)  # fmt: skip


def left_of(way: Array) -> Array:
    """Unit normals (n, 2) to the left of directions (n, 2)."""
    return np.stack([-way[:, 1], way[:, 0]], axis=1) / np.hypot(way[:, 0], way[:, 1])[:, None]
