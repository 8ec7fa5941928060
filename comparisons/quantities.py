"""Quantities that probes ask for: units, components, norms, and the scale of a probe in a stage.

The scale is the unit of differences, uncertainties and limits.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
ℓ       length of the longest beam, m
S       bending stiffness of the stiffest beam over ℓ, E·I/ℓ, N·m
v       largest norm of a probe in a stage, of both compared answers
V       largest v over all stages
f       family: the largest value of all probes of one kind in the stage, in the probe's unit
n       natural value: the value where the stiffest beam is bent by a radian along ℓ
======  ==========================================================================================

    scale = max(v, V/4, f/1000, n/10⁴)

A probe may vanish by symmetry, and its largest norm is then round-off: f/1000 stands in for v.  A probe may hardly
change in a preparatory stage, such as a drive that closes a gap: V/4 stands in for v.  With a turn of 10⁻⁴ rad a beam
counts as straight, and a part without load as unloaded: n/10⁴ stands in for v.

==============================  ======================================================  ==========
quantity                        family                                                  n
==============================  ======================================================  ==========
displacement                    displacements of probes, drives and nine places of      ℓ
                                each beam; rotations times ℓ
rotation                        rotations of probes and drives; displacements over ℓ    1
angle                           angles of stops                                         1
force, reaction                 forces of probes and of the load; moments over ℓ        S/ℓ
reaction_moment, moment         moments of probes, of the load and of a driven beam;    S
                                forces times ℓ
bending and combined stress     stresses of probes                                      E·t/(2ℓ)
potential_energy                energies                                                S/10⁴
closing_load                    the stepped load or drive                               as stepped
centre, ends                    length of the contact's first beam, which is the scale
==============================  ======================================================  ==========

A beam in tension may not bend at all: the value v of a stress is at least the stress N/A of the beam's normal force.

A moment at a support depends on its reference point and may be small by accident.  The scale of a reaction moment is
therefore the largest moment of the balance: of supports, of drives and of the load.  A drive is resisted by at least
E·I/ℓ per radian of the softest beam, whether or not its reaction is a probe.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from comparisons.geometry import length, longest, points
from cprbm_scene import (
    STRESSES,
    Answer,
    Array,
    Beam,
    DistributedLoad,
    Probe,
    Quantity,
    Scene,
    Shape,
    Stage,
    StationAnswer,
)

VANISHING = 1e-2
"""A reference below this share of its scale may vanish, and is no divisor of shown fractions."""

OPEN_AT_ZERO: frozenset[Quantity] = frozenset({"force", "moment"})
"""Quantities that are exactly zero while a contact is open, or while no limit of a stop is reached."""

UNITS: Mapping[Quantity, str] = {
    "displacement": "m",
    "rotation": "rad",
    "force": "N",
    "centre": "m",
    "ends": "m",
    "bending_stress": "Pa",
    "combined_stress": "Pa",
    "reaction": "N",
    "reaction_moment": "N·m",
    "potential_energy": "J",
    "angle": "rad",
    "moment": "N·m",
}

COMPONENTS: Mapping[Quantity, tuple[str, str]] = {
    "displacement": ("x", "y"),
    "reaction": ("x", "y"),
    "ends": ("first", "last"),
}
"""Names of the components, of quantities with two."""

LOAD_UNITS = {
    "moment": "N·m",
    "force": "N",
    "beam_force": "N",
    "beam_moment": "N·m",
    "distributed": "N/m",
    "displacement": "m",
    "rotation": "rad",
}

FAMILY_SHARE = 1e-3
"""Least scale of a probe, a share of its family's largest value."""

STAGE_SHARE = 0.25
"""Least scale of a probe in a stage, a share of its largest value in all stages."""

NATURAL_SHARE = 1e-4
"""Least scale of a probe, a share of its natural value."""

_PLACES = 9

_OWN_NORM = frozenset({"displacement", "rotation", "potential_energy", "closing_load"})

_FAMILIES = {
    "reaction": "force",
    "reaction_moment": "moment",
    "bending_stress": "stress",
    "combined_stress": "stress",
}

PLACES_OF_CONTACT: frozenset[Quantity] = frozenset({"centre", "ends"})
"""Quantities whose values are arc lengths on the contact's first beam."""


def norm(quantity: Quantity, values: Array) -> float:
    """Euclidean norm of ``values`` (k,); of a stress along a beam the largest magnitude; 0 without values."""
    return float(np.abs(values).max(initial=0.0) if quantity in STRESSES else np.linalg.norm(values))


def stage_of(scene: Scene, name: str) -> Stage:
    """The stage of a name."""
    return next(stage for stage in scene.stages if stage.name == name)


def unit_of(scene: Scene, probe: Probe, stage: str) -> str:
    """SI unit of a probe's values in the stage of a name."""
    return load_unit(scene, stage) if probe.quantity == "closing_load" else UNITS[probe.quantity]


def load_unit(scene: Scene, stage: str) -> str:
    """SI unit of the load or drive that the stage of a name steps."""
    return LOAD_UNITS[scene.stepped(stage_of(scene, stage)).kind]


def arc_lengths(scene: Scene, probe: Probe) -> Array:
    """Arc lengths (k,), m, of the places of a stress probe."""
    return np.linspace(0.0, length(scene.beams[probe.of].curve), probe.points)


def direction(quantity: Quantity, difference: Array) -> Array:
    """Unit vector (k,) along ``difference`` (k,), zero where the difference is.

    The norm of a stress is its largest magnitude: the vector of a stress points along the component of that magnitude.
    """
    counts = np.arange(len(difference)) == np.argmax(np.abs(difference)) if quantity in STRESSES else True
    along = np.where(counts, difference, 0.0)
    return along / (np.linalg.norm(along) or 1.0)


def probe_scales(scene: Scene, answers: Sequence[Answer]) -> dict[tuple[str, str], float]:
    """Scale of every probe by the names of stage and probe, in the probe's unit; never 0."""
    largest = {stage.name: _largest(scene, stage, answers) for stage in scene.stages}
    found = {}
    for stage in scene.stages:
        families = family_values(scene, stage, answers, largest[stage.name])
        for probe in scene.probes:
            natural = natural_value(scene, probe.quantity, stage, contact=probe.of)
            own = max(largest[stage.name][probe.name], STAGE_SHARE * max(each[probe.name] for each in largest.values()))
            family = families.get(_FAMILIES.get(probe.quantity, probe.quantity), 0.0)
            balance = families["balance"] if probe.quantity == "reaction_moment" else 0.0
            scale = max(own, balance, FAMILY_SHARE * family, NATURAL_SHARE * natural)
            found[stage.name, probe.name] = natural if probe.quantity in PLACES_OF_CONTACT else scale
    return found


def family_values(
    scene: Scene, stage: Stage, answers: Sequence[Answer], largest: Mapping[str, float]
) -> dict[str, float]:
    """Largest value of every family in a stage, and of the ``balance`` of moments.

    Args:
        scene: the question.
        stage: the stage.
        answers: the compared answers.
        largest: largest norm of every probe in the stage.
    """

    def probes(*kinds: Quantity) -> float:
        return max((largest[probe.name] for probe in scene.probes if probe.quantity in kinds), default=0.0)

    kind, most = _stepped(scene, stage)
    step = dict.fromkeys(("displacement", "rotation", "force", "moment"), 0.0) | {kind: most}
    lever, softest = longest(scene), min(_bending_stiffness(scene, beam).min() for beam in scene.beams.values())
    resistance = max(step["rotation"], step["displacement"] / lever) * float(softest) / lever
    shapes = (item for station in _stations(stage, answers) for item in station.shapes.items())
    deflections = (deflection(scene.beams[name], shape) for name, shape in shapes)
    moved = max(probes("displacement"), step["displacement"], *filter(np.isfinite, deflections))
    turned = max(probes("rotation"), step["rotation"])
    balance = max(probes("reaction_moment"), step["moment"])
    moment = max(balance, probes("moment"), resistance)
    force = max(probes("force", "reaction"), step["force"])
    return {
        "displacement": max(moved, lever * turned),
        "rotation": max(turned, moved / lever),
        "angle": probes("angle"),
        "force": max(force, moment / lever),
        "moment": max(moment, force * lever),
        "stress": probes("bending_stress", "combined_stress"),
        "potential_energy": probes("potential_energy"),
        "closing_load": max(abs(station) for station in stage.stations),
        "balance": balance,
    }


def natural_value(scene: Scene, quantity: Quantity, stage: Stage, *, contact: str) -> float:
    """Value of a quantity where the stiffest beam is bent by a radian along the longest, in the quantity's unit."""
    lever = longest(scene)
    stiffness = float(max(_bending_stiffness(scene, beam).max() for beam in scene.beams.values())) / lever
    bent = max(scene.materials[beam.material].youngs_modulus * beam.thickest for beam in scene.beams.values()) / (
        2.0 * lever
    )
    by_kind: dict[str, float] = {
        **dict.fromkeys(STRESSES, bent),
        "displacement": lever,
        "rotation": 1.0,
        "angle": 1.0,
        "potential_energy": NATURAL_SHARE * stiffness,
        "force": stiffness / lever,
        "reaction": stiffness / lever,
        "beam_force": stiffness / lever,
        "distributed": stiffness / lever**2,
    }
    if quantity in PLACES_OF_CONTACT:
        return length(scene.beams[scene.contacts[contact].beams[0]].curve)
    return by_kind.get(scene.stepped(stage).kind if quantity == "closing_load" else quantity, stiffness)


def denominator(probe: Probe, reference: float, scale: float) -> float:
    """Divisor of a row's shown fractions: the ``reference`` norm, or the scale where the reference may vanish."""
    return reference if probe.quantity in _OWN_NORM and reference >= VANISHING * scale else scale


def _largest(scene: Scene, stage: Stage, answers: Sequence[Answer]) -> dict[str, float]:
    """Largest size of every probe at the stage's stations."""
    return {
        probe.name: max((_size(scene, probe, at) for at in _stations(stage, answers)), default=0.0)
        for probe in scene.probes
    }


def _size(scene: Scene, probe: Probe, station: StationAnswer) -> float:
    """Norm of a probe at a station, of a stress at least the stress of the normal force; 0 if not finite or absent."""
    values = station.values.get(probe.name, np.zeros(0))
    if probe.quantity in STRESSES and probe.of in station.beams:
        beam, state = scene.beams[probe.of], station.beams[probe.of]
        thickness, width = (of(state.s / state.s[-1]) for of in (beam.thickness_at, beam.width_at))
        values = np.append(values, state.N / (thickness * width))
    return norm(probe.quantity, values) if np.isfinite(values).all() else 0.0


def _stations(stage: Stage, answers: Sequence[Answer]) -> list[StationAnswer]:
    return [station for answer in answers for station in answer.stations if station.stage == stage.name]


def _stepped(scene: Scene, stage: Stage) -> tuple[str, float]:
    """Kind of the stepped load or drive, as a displacement, rotation, force or moment, and the largest value."""
    load, most = scene.stepped(stage), max(abs(station) for station in stage.stations)
    if isinstance(load, DistributedLoad):
        most *= (load.along[1] - load.along[0]) * length(scene.beams[load.beam].curve)
    return {"beam_force": "force", "distributed": "force", "beam_moment": "moment"}.get(load.kind, load.kind), most


def deflection(beam: Beam, shape: Shape) -> float:
    """Largest distance, m, of nine places of a beam from the places at rest."""
    some = np.linspace(0, len(shape.s) - 1, _PLACES).astype(int)
    rest = points(beam.curve, shape.s[some])
    return float(np.max(np.hypot(shape.x[some] - rest[:, 0], shape.y[some] - rest[:, 1])))


def _bending_stiffness(scene: Scene, beam: Beam) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """E·I (k,), N·m², at the knots between which the section varies linearly."""
    inertia = beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3 / 12.0
    return np.asarray(scene.materials[beam.material].youngs_modulus * inertia, dtype=float)
