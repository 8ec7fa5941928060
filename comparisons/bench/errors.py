"""How far answers are from the truth in the theory of bending, each in one number per measure.

==========  ==============================================================================================
symbol      meaning
==========  ==============================================================================================
v, v*       values of a probe at the last station, and the reference
scale       the largest of |v*|, of a thousandth of the largest |v*| of its quantity, since a probe may vanish by
            symmetry, and of 1e-4 of its natural value (:mod:`comparisons.verdict.scales`)
e           largest |v − v*| / scale over the probes of a measure
U           the same of the reference's own uncertainty; zero where it is exact
==========  ==============================================================================================

The reference is the exact answer where there is one, or else the limit by Richardson's extrapolation of the CPRBM in
``auto``, from N = 160, 320 and 640, with the uncertainty of
:mod:`comparisons.verdict.uncertainty`.  An error that is not
clearly larger than U says nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from comparisons.bench.question import MEASURES, Measure, measure_of
from comparisons.choices import Choices
from comparisons.pairing import Solvers
from comparisons.verdict.scales import NATURAL_SHARE, natural_value
from comparisons.verdict.uncertainty import limit
from cprbm_scene import Scene, SceneError
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

FINE = (160, 320, 640)
SMALL = 1e-3


@dataclass(frozen=True, slots=True)
class Reference:
    """The true ``values`` by probe, how far they may be off (each as its value), and ``by`` what they are known."""

    by: str
    values: Mapping[str, Array]
    uncertainty: Mapping[str, Array]


NOTHING = Reference("nothing: no reference is known", frozendict(), frozendict())


def reference(scene: Scene, solvers: Solvers) -> Reference:
    """The reference of a scene as :func:`comparisons.bench.question.asked` leaves it."""
    if solvers.exact is not None:
        exact = solvers.exact(scene, Choices(kinematics="bending"))
        if exact.completed and exact.stations:
            values = exact.stations[-1].values
            return Reference("the exact answer", values, frozendict({name: 0.0 * v for name, v in values.items()}))
    try:
        answers = [solvers.cprbm(scene, Choices(links=n)) for n in FINE]
    except SceneError:
        return NOTHING
    if not all(answer.completed for answer in answers):
        return NOTHING
    values, uncertainty = dict[str, Array](), dict[str, Array]()
    for probe in scene.probes:
        found = [answer.stations[-1].values[probe.name] for answer in answers]
        if len({one.shape for one in found}) == 1 and found[0].size:
            limited = limit(FINE, np.array(found))
            values[probe.name], uncertainty[probe.name] = limited.value, limited.uncertainty
    by = f"the CPRBM's limit (auto, N = {', '.join(map(str, FINE))})"
    return Reference(by, frozendict(values), frozendict(uncertainty))


def errors(scene: Scene, known: Reference, values: Mapping[str, Array]) -> Mapping[Measure, float]:
    """e of each measure that has a probe whose value and reference are known."""
    apart = {
        name: float(np.linalg.norm(values[name] - true))
        for name, true in known.values.items()
        if name in values and values[name].shape == true.shape
    }
    return _worst(scene, known, apart)


def uncertainties(scene: Scene, known: Reference) -> Mapping[Measure, float]:
    """U of each measure."""
    return _worst(scene, known, {name: float(np.linalg.norm(u)) for name, u in known.uncertainty.items()})


def _worst(scene: Scene, known: Reference, apart: Mapping[str, float]) -> Mapping[Measure, float]:
    sizes = {name: float(np.linalg.norm(true)) for name, true in known.values.items()}
    largest: dict[str, float] = {}
    for probe in scene.probes:
        largest[probe.quantity] = max(largest.get(probe.quantity, 0.0), sizes.get(probe.name, 0.0))
    found: dict[Measure, float] = {}
    for probe in scene.probes:
        measure = measure_of(scene, probe)
        if measure is not None and probe.name in apart:
            natural = natural_value(scene, probe.quantity, scene.stages[-1], contact=probe.of)
            scale = max(sizes[probe.name], SMALL * largest[probe.quantity], NATURAL_SHARE * natural)
            found[measure] = max(found.get(measure, 0.0), apart[probe.name] / scale)
    return frozendict({measure: found[measure] for measure in MEASURES if measure in found})
