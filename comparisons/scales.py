"""What the differences of a probe are measured by.

A probe's *scale* in a stage is the largest norm that it has at any of the stage's stations, in either answer.
A probe may vanish by symmetry, and then its largest norm is round-off and no scale.  So probes of one kind
form a *family* with a scale of its own, and no probe's scale is less than a thousandth of its family's:

=====================================  ==============================================================
quantity                               the family's scale in a stage
=====================================  ==============================================================
displacement                           largest displacement asked for or of any beam's places, or rotation times length
rotation                               largest rotation asked for, or displacement over length
angle                                  largest angle of any stop
force, reaction                        largest of them, of the force loads' resultants, of the moments over length, and
                                       of what a drive is resisted with
reaction_moment, moment                largest of them, of the moment loads, of the forces times length, and the same
bending_stress, combined_stress        largest of them in any beam
potential_energy                       largest energy
closing_load                           largest value that the stage steps to
centre, ends                           length of the contact's first beam, which is also the probe's scale
=====================================  ==============================================================

What is stepped counts as if it were asked for.  The places are nine of each beam's neutral line: where all that is
asked for is a point that does not move, as one that a body turns about, beams bend nevertheless.

A moment at a support depends on the point about which it is taken: it is what is left of the loads' and the
other supports' moments, and may be small by accident of that point.  Its scale is therefore the largest
moment of the balance that it closes, of the supports', the drives' and the stepped one's.

The length is the longest beam's.

What a drive is resisted with is its reaction, and that need not be asked.  It is estimated, from below, by the softest
beam, bent along the longest beam's length ℓ by as much as the drive turns (or moves over ℓ): a moment EI/ℓ per radian.
Without it, of a mechanism that a drive bends a contact that hardly touches would be its own scale.

Where hardly anything happens (a station at zero load), the family's largest value is round-off as well.  No
family's scale is therefore less than 1e-7 of its *natural* scale, what the stiffest beam would show that is
bent by about a radian along the longest beam's length ℓ:

    displacement ℓ,  rotation 1,  moment and energy S = EI/ℓ,  force S/ℓ,  stress E·t/(2ℓ).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

import numpy as np

from comparisons.geometry import length, points
from cprbm_scene import Answer, Beam, Probe, Scene, Stage
from cprbm_scene.answer import Array, Shape
from cprbm_scene.statement import STRESSES, DistributedLoad, Quantity

SMALLEST_SHARE = 1e-3
"""Least scale of a probe as a share of its family's."""

SMALLEST_EVENT = 1e-7
"""Least scale of a family as a share of its natural scale."""

VANISHING = 1e-2
"""A reference below this share of its probe's scale counts as one that may vanish."""

Kind = Literal["moment", "force", "beam_force", "beam_moment", "displacement", "rotation"]
"""Of a load or drive."""

_PLACES = 9
"""Places of each beam whose way is looked at."""

_OWN_NORM = frozenset({"displacement", "rotation", "potential_energy", "closing_load"})
"""Quantities whose differences are stated as shares of the reference itself."""


def norm(quantity: Quantity, values: Array) -> float:
    """Euclidean norm of ``values`` (k,); of a stress along a beam the largest magnitude."""
    if values.size == 0:
        return 0.0
    return float(np.max(np.abs(values)) if quantity in STRESSES else np.linalg.norm(values))


def probe_scale(scene: Scene, probe: Probe, stage: Stage, answers: tuple[Answer, ...]) -> float:
    """The scale of a probe in a stage, in the probe's unit; never 0."""
    family = family_scale(scene, probe.quantity, stage, answers, contact=probe.of)
    if probe.quantity in ("centre", "ends"):
        return family
    if probe.quantity == "reaction_moment":
        supports = tuple(other for other in scene.probes if other.quantity == "reaction_moment")
        moments = max(_largest(supports, stage, answers), _stepped_moment(scene, stage))
        return max(moments, SMALLEST_SHARE * family)
    return max(_largest((probe,), stage, answers), SMALLEST_SHARE * family)


def family_scale(scene: Scene, quantity: Quantity, stage: Stage, answers: tuple[Answer, ...], *, contact: str) -> float:
    """The scale of a quantity's family in a stage; ``contact`` is the contact of a ``centre`` or of ``ends``."""
    natural = natural_scale(scene, quantity, stage, contact=contact)
    return max(family_size(scene, quantity, stage, answers, contact=contact), SMALLEST_EVENT * natural)


def natural_scale(scene: Scene, quantity: Quantity, stage: Stage, *, contact: str) -> float:
    """What a quantity amounts to where beams bend by about a radian, in its unit."""
    lever = _lever(scene)
    beams = [(beam, scene.materials[beam.material].youngs_modulus) for beam in scene.beams.values()]
    S = max(E * float(np.max(_stiffness(beam))) for beam, E in beams) / lever
    match quantity:
        case "displacement":
            return lever
        case "rotation" | "angle":
            return 1.0
        case "force" | "reaction":
            return S / lever
        case "closing_load":
            return {
                "moment": S,
                "force": S / lever,
                "beam_force": S / lever,
                "beam_moment": S,
                "distributed": S / lever**2,
                "displacement": lever,
                "rotation": 1.0,
            }[scene.stepped(stage).kind]
        case "bending_stress" | "combined_stress":
            return max(E * beam.thickest for beam, E in beams) / (2.0 * lever)
        case "centre" | "ends":
            return length(scene.beams[scene.contacts[contact].beams[0]].curve)
        case _:
            return S


def family_size(scene: Scene, quantity: Quantity, stage: Stage, answers: tuple[Answer, ...], *, contact: str) -> float:
    """The largest value in a quantity's family in a stage, as the table says; it may be round-off."""

    def largest(*kinds: Quantity) -> float:
        probes = tuple(probe for probe in scene.probes if probe.quantity in kinds)
        return _largest(probes, stage, answers)

    def moved() -> float:
        return max(largest("displacement"), _stepped(scene, stage, "displacement"), _bent(scene, stage, answers))

    def turned() -> float:
        return max(largest("rotation"), _stepped(scene, stage, "rotation"))

    lever = _lever(scene)
    match quantity:
        case "displacement":
            return max(moved(), lever * turned())
        case "rotation":
            return max(turned(), moved() / lever)
        case "force" | "reaction":
            return max(
                largest("force", "reaction"),
                _stepped_force(scene, stage),
                largest("reaction_moment", "moment") / lever,
                _stepped_moment(scene, stage) / lever,
                _resisted(scene, stage) / lever,
            )
        case "reaction_moment" | "moment":
            return max(
                largest("reaction_moment", "moment"),
                _stepped_moment(scene, stage),
                _resisted(scene, stage),
                largest("force", "reaction") * lever,
                _stepped_force(scene, stage) * lever,
            )
        case "bending_stress" | "combined_stress":
            return largest("bending_stress", "combined_stress")
        case "closing_load":
            return max(abs(station) for station in stage.stations)
        case "centre" | "ends":
            return length(scene.beams[scene.contacts[contact].beams[0]].curve)
        case _:
            return largest(quantity)


def denominator(probe: Probe, reference: Array, scale: float) -> float:
    """What a row's difference is divided by: the reference's norm, or the scale where that may vanish."""
    own = norm(probe.quantity, reference)
    return own if probe.quantity in _OWN_NORM and own >= VANISHING * scale else scale


def _stiffness(beam: Beam) -> Array:
    """I at the places between which the section goes straight, m⁴."""
    return np.asarray(beam.width_at(beam.knots) * beam.thickness_at(beam.knots) ** 3 / 12.0)


def _lever(scene: Scene) -> float:
    return max(length(beam.curve) for beam in scene.beams.values())


def _largest(probes: tuple[Probe, ...], stage: Stage, answers: tuple[Answer, ...]) -> float:
    return max(_norms(probes, stage, answers), default=0.0)


def _norms(probes: tuple[Probe, ...], stage: Stage, answers: tuple[Answer, ...]) -> Iterator[float]:
    for answer in answers:
        for station in answer.stations:
            if station.stage != stage.name:
                continue
            for probe in probes:
                values = station.values.get(probe.name)
                if values is not None and bool(np.all(np.isfinite(values))):
                    yield norm(probe.quantity, values)


def _bent(scene: Scene, stage: Stage, answers: tuple[Answer, ...]) -> float:
    """The farthest, m, that one of nine places of a beam is from where it is drawn, at any of the stage's stations."""
    ways = (
        _way(scene.beams[name], shape)
        for answer in answers
        for station in answer.stations
        if station.stage == stage.name
        for name, shape in station.shapes.items()
    )
    return max((way for way in ways if np.isfinite(way)), default=0.0)


def _way(beam: Beam, shape: Shape) -> float:
    """The farthest, m, that one of nine places of a beam is from where it is drawn."""
    some = np.linspace(0, len(shape.s) - 1, _PLACES).astype(int)
    drawn = points(beam.curve, shape.s[some])
    return float(np.max(np.hypot(shape.x[some] - drawn[:, 0], shape.y[some] - drawn[:, 1])))


def _stepped_force(scene: Scene, stage: Stage) -> float:
    """Largest resultant, N, of a load that the stage steps, if it is a force on a body or a beam."""
    load = scene.stepped(stage)
    if isinstance(load, DistributedLoad):
        stretch = (load.along[1] - load.along[0]) * length(scene.beams[load.beam].curve)
        return stretch * max(abs(station) for station in stage.stations)
    return max(_stepped(scene, stage, "force"), _stepped(scene, stage, "beam_force"))


def _stepped_moment(scene: Scene, stage: Stage) -> float:
    """Largest magnitude, N·m, of a moment on a body or a beam, if the stage steps one."""
    return max(_stepped(scene, stage, "moment"), _stepped(scene, stage, "beam_moment"))


def _resisted(scene: Scene, stage: Stage) -> float:
    """Moment, N·m, with which the softest beam resists the stage's drive; 0 where it steps a load."""
    lever = _lever(scene)
    turned = max(_stepped(scene, stage, "rotation"), _stepped(scene, stage, "displacement") / lever)
    softest = min(
        scene.materials[beam.material].youngs_modulus * float(np.min(_stiffness(beam))) for beam in scene.beams.values()
    )
    return turned * softest / lever


def _stepped(scene: Scene, stage: Stage, kind: Kind) -> float:
    """Largest magnitude of what the stage steps, if it is a load or drive of that ``kind``."""
    return max(abs(station) for station in stage.stations) if scene.stepped(stage).kind == kind else 0.0
