"""Question of a benchmark, and errors of answers: the last loads at once, and a number for every measure.

A time with all stations and probes would include stresses, places of contact and closing loads, which no peer gives.
Therefore a scene keeps the last station of every stage, and the probes of two measures:

========  =============================================================================================
measure   probes
========  =============================================================================================
places    displacements of points and rotations of bodies
forces    resultants of contacts; the force of a drive at its point, the moment of a drive that turns a body
========  =============================================================================================

Errors are taken in the theory of bending.

==========  ==============================================================================================
symbol      meaning
==========  ==============================================================================================
v, v*       values of a probe at the last station, and the reference
scale       the largest of |v*|, of a thousandth of the largest |v*| of its quantity, since a probe may vanish by
            symmetry, and of 1e-4 of its natural value (:mod:`comparisons.quantities`)
e           largest |v − v*| / scale over the probes of a measure
U           the same of the reference's own uncertainty; zero where it is exact
==========  ==============================================================================================

The reference is the exact answer where there is one.  Otherwise the reference is the limit by Richardson's
extrapolation of the CPRBM in ``auto`` from N = 160, 320 and 640, with the uncertainty of
:mod:`comparisons.verdict.uncertainty`.  An error that is not clearly larger than U says nothing.
"""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Literal

import numpy as np

from comparisons.choices import Choices
from comparisons.pairing import Solvers
from comparisons.quantities import NATURAL_SHARE, natural_value
from comparisons.verdict import largest, limit
from cprbm_scene import Answer, Array, DisplacementDrive, Probe, Scene, SceneError, frozendict

Measure = Literal["places", "forces"]
MEASURES: tuple[Measure, ...] = ("places", "forces")

FINE = (160, 320, 640)
SMALL = 1e-3


def at_last_loads(scene: Scene) -> Scene:
    """The scene with the last station of every stage only."""
    stages = tuple(stage.model_copy(update={"stations": stage.stations[-1:]}) for stage in scene.stages)
    return scene.model_copy(update={"stages": stages})


def benchmark_scene(scene: Scene) -> Scene:
    """The scene in bending, with its last loads and the probes of both measures, and without claims."""
    probes = tuple(probe for probe in scene.probes if measure_of(scene, probe) is not None)
    return at_last_loads(scene).model_copy(update={"probes": probes, "claims": (), "theory": "bending"})


def measure_of(scene: Scene, probe: Probe) -> Measure | None:
    """The measure of a probe; None of a probe without a measure."""
    if probe.quantity in ("displacement", "rotation"):
        return "places"
    driven = {drive.point if isinstance(drive, DisplacementDrive) else drive.body for drive in scene.drives.values()}
    at_drive = probe.quantity in ("reaction", "reaction_moment") and probe.of in driven
    return "forces" if at_drive or probe.quantity == "force" else None


@dataclass(frozen=True, slots=True)
class Reference:
    """Reference ``values`` by probe, their ``uncertainty`` in the same shapes, and their origin ``by``."""

    by: str
    values: Mapping[str, Array] = frozendict()
    uncertainty: Mapping[str, Array] = frozendict()


NOTHING = Reference("nothing: no reference is known")


def reference(scene: Scene, solvers: Solvers) -> Reference:
    """The reference of a scene of :func:`benchmark_scene`."""
    exact = None if solvers.exact is None else solvers.exact(scene, Choices(kinematics="bending"))
    if exact is not None and exact.completed and exact.stations:
        values = exact.stations[-1].values
        return Reference("the exact answer", values, frozendict({name: 0.0 * v for name, v in values.items()}))
    answers = list[Answer]()
    with suppress(SceneError):
        answers = [solvers.cprbm(scene, Choices(links=n)) for n in FINE]
    if not answers or not all(answer.completed for answer in answers):
        return NOTHING
    found = {probe.name: [answer.stations[-1].values[probe.name] for answer in answers] for probe in scene.probes}
    alike = {name: each for name, each in found.items() if each[0].size and len({value.shape for value in each}) == 1}
    limits = {name: limit(FINE, values) for name, values in alike.items()}
    return Reference(
        f"the CPRBM's limit (auto, N = {', '.join(map(str, FINE))})",
        frozendict({name: each.value for name, each in limits.items()}),
        frozendict({name: each.uncertainty for name, each in limits.items()}),
    )


def errors(scene: Scene, known: Reference, values: Mapping[str, Array]) -> Mapping[Measure, float]:
    """e of each measure with a probe of known value and reference."""
    alike = {name for name, true in known.values.items() if name in values and values[name].shape == true.shape}
    return _worst(scene, known, {name: values[name] - known.values[name] for name in alike})


def uncertainties(scene: Scene, known: Reference) -> Mapping[Measure, float]:
    """U of each measure."""
    return _worst(scene, known, known.uncertainty)


def _worst(scene: Scene, known: Reference, apart: Mapping[str, Array]) -> Mapping[Measure, float]:
    sizes = {name: float(np.linalg.norm(true)) for name, true in known.values.items()}

    def share(probe: Probe) -> float:
        """The distance over the scale of a probe."""
        alike = max(sizes.get(each.name, 0.0) for each in scene.probes if each.quantity == probe.quantity)
        natural = natural_value(scene, probe.quantity, scene.stages[-1], contact=probe.of)
        scale = max(sizes[probe.name], SMALL * alike, NATURAL_SHARE * natural)
        return float(np.linalg.norm(apart[probe.name])) / scale

    found = largest((measure_of(scene, probe), share(probe)) for probe in scene.probes if probe.name in apart)
    return frozendict({measure: found[measure] for measure in MEASURES if measure in found})
