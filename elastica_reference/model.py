"""Dimensionless model of a scene: beams by arc length, bodies and loads.

=======  ==================================================================
symbol   meaning
=======  ==================================================================
ℓ        unit of length, the longest beam's, m
S        unit of moment and energy, the largest EI over ℓ; S/ℓ of force
c        1/EI of a section, 12/(E w t³)
T        half the thickness where beams touch by their edges, else 0
=======  ==================================================================
"""

from dataclasses import dataclass

import numpy as np

from cprbm_scene import Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import Beam, BeamEnd, BeamForce, DistributedLoad, FixedBody, FreeEnd, SlidingBody, WeldedEnd
from elastica_reference.curves import NeutralLine, neutral_line
from elastica_reference.spectral import Law


@dataclass(frozen=True, slots=True)
class End:
    """A beam's end: the ``point`` of a body that holds it (None for a free end), and True if ``welded``."""

    point: str | None
    welded: bool


@dataclass(frozen=True, slots=True)
class Strip:
    """A dimensionless beam.

    Attributes:
        name: name of the beam.
        line: stress-free neutral line.
        beam: record of the scene, in metres.
        knots: inner arc lengths with a kink of thickness, width or stress-free curvature, a point force, or an end of
            a distributed load.
        stiffness: Young's modulus over Sℓ, 1/m⁴, so that E·I is dimensionless.
        unit: ℓ, m.
        start, end: ends of the beam.
        spread: names and ranges of distributed loads.
    """

    name: str
    line: NeutralLine
    beam: Beam
    knots: tuple[float, ...]
    stiffness: float
    unit: float
    start: End
    end: End
    spread: tuple[tuple[str, float, float], ...]

    @property
    def length(self) -> float:
        """Arc length of the beam."""
        return self.line.length

    def rigidity(self, s: Array) -> Array:
        """EI (n,) at arc lengths ``s`` (n,)."""
        u = np.asarray(s) / self.length
        return np.asarray(self.stiffness * self.beam.width_at(u) * self.beam.thickness_at(u) ** 3 / 12.0)

    def rigidity_slope(self, s: Array) -> Array:
        """d(EI)/ds (n,), in the piece between two knots with the mean of the arc lengths."""
        width, thickness = self._relative_slopes(s)
        return np.asarray(self.rigidity(s) * (width + 3.0 * thickness))

    def rigidity_second(self, s: Array) -> Array:
        """d²(EI)/ds² (n,) there, for w t³ with linear w and t."""
        width, thickness = self._relative_slopes(s)
        return np.asarray(self.rigidity(s) * 6.0 * thickness * (width + thickness))

    def compliance(self, s: Array) -> Array:
        """c (n,) at arc lengths ``s`` (n,)."""
        return np.asarray(1.0 / self.rigidity(s))

    def compliance_slope(self, s: Array) -> Array:
        """dc/ds (n,), in the piece between two knots with the mean of the arc lengths."""
        width, thickness = self._relative_slopes(s)
        return np.asarray(-self.compliance(s) * (width + 3.0 * thickness))

    def half_thickness(self, s: Array) -> Array:
        """Half the thickness (n,), constant beyond the ends."""
        return np.asarray(0.5 * self.beam.thickness_at(np.clip(np.asarray(s) / self.length, 0.0, 1.0)) / self.unit)

    def half_thickness_slope(self, s: float) -> float:
        """Derivative of half the thickness at an arc length."""
        return 0.5 * self._slopes(s)[1] / self.unit

    def _relative_slopes(self, s: Array) -> tuple[Array, Array]:
        """w'/w and t'/t (n,), in the piece between two knots with the mean of the arc lengths."""
        u = np.asarray(s) / self.length
        width, thickness = self._slopes(float(np.mean(s)))
        return np.asarray(width / self.beam.width_at(u)), np.asarray(thickness / self.beam.thickness_at(u))

    def _slopes(self, s: float) -> tuple[float, float]:
        """dw/ds and dt/ds, in m per unit of length, between the knots around an arc length."""
        fence = np.array([0.0, *self.knots, self.length])
        k = int(np.clip(np.searchsorted(fence, s) - 1, 0, len(fence) - 2))
        u, step = fence[k : k + 2] / self.length, fence[k + 1] - fence[k]
        width, thickness = (float(np.diff(size(u))[0] / step) for size in (self.beam.width_at, self.beam.thickness_at))
        return width, thickness

    @property
    def law(self) -> Law:
        """Curvature and compliance of the beam's pieces."""
        return Law(self.line.curvature, self.line.curvature_slope, self.compliance, self.compliance_slope)


@dataclass(frozen=True, slots=True)
class Model:
    """Dimensionless beams and moving bodies of a scene.

    Attributes:
        scene: the problem statement.
        unit_length, unit_moment: ℓ, m, and S, N·m.
        strips: the beams by name.
        moving: degrees of freedom of moving bodies by name: 3, 1 for a slide, 2 for a pin in a slot.
    """

    scene: Scene
    unit_length: float
    unit_moment: float
    strips: dict[str, Strip]
    moving: dict[str, int]

    @property
    def unit_force(self) -> float:
        """S/ℓ, N."""
        return self.unit_moment / self.unit_length

    def rest(self, point: str) -> Array:
        """Reference position (2,) of a body's point."""
        return np.array(self.scene.bodies[self.scene.body_of(point)].points[point]) / self.unit_length

    def reference(self, body: str) -> Array:
        """Reference point (2,) for a body's moments: the mean of its named points."""
        return np.asarray(np.mean(np.array(list(self.scene.bodies[body].points.values())), axis=0) / self.unit_length)


def model_of(scene: Scene) -> Model:
    """Model of a scene."""
    lengths = {name: neutral_line(beam.curve, 1.0).length for name, beam in scene.beams.items()}
    unit = max(lengths.values())
    rigidities = {
        name: scene.materials[beam.material].youngs_modulus
        * float(np.max(beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3))
        / 12.0
        for name, beam in scene.beams.items()
    }
    moment = max(rigidities.values()) / unit
    strips = {}
    for name, beam in scene.beams.items():
        line = neutral_line(beam.curve, unit)
        loaded = [load.at for load in scene.loads.values() if isinstance(load, BeamForce) and load.beam == name]
        spread = {
            key: load.along
            for key, load in scene.loads.items()
            if isinstance(load, DistributedLoad) and load.beam == name
        }
        shares = {*map(float, beam.knots), *loaded, *(end for along in spread.values() for end in along)} - {0.0, 1.0}
        knots = tuple(sorted({*(u * line.length for u in shares), *line.kinks}))
        stiffness = scene.materials[beam.material].youngs_modulus / (moment * unit)
        strips[name] = Strip(
            name,
            line,
            beam,
            knots,
            stiffness,
            unit,
            _end(beam.start),
            _end(beam.end),
            tuple((key, begin * line.length, end * line.length) for key, (begin, end) in spread.items()),
        )
    moving = {
        name: (1 if body.pin is None else 2) if isinstance(body, SlidingBody) else 3
        for name, body in scene.bodies.items()
        if not isinstance(body, FixedBody)
    }
    return Model(scene, unit, moment, strips, moving)


def _end(end: BeamEnd) -> End:
    return End(None, welded=False) if isinstance(end, FreeEnd) else End(end.point, isinstance(end, WeldedEnd))
