"""Departures of a solver's answer to the image of a scene from the image of the answer to the scene.

======  ==============================================================================================
symbol  meaning
======  ==============================================================================================
v, w    a probe's value at a station, in the answer to the scene and in the answer to the image
v′      image of v
c       the probe's scale in the stage in the image, :mod:`comparisons.quantities`
e       |w − v′|/c, the violation
r       residual or its floor by the certificate of the image's station
u, u′   the uncertainties of v and w on their discretisations, :mod:`tests.relations.uncertain`
======  ==============================================================================================

If the image keeps the discretised problem, e ≤ max(1e-7, r) holds; otherwise e ≤ max(1e-7, r, u + u′).  A refused
image violates the relation wholly, e = ∞.  So does an answer to the image with another ending, with fewer stations or
with values of another shape.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.quantities import arc_lengths, norm, probe_scales
from comparisons.stations import begins_at, station_of
from comparisons.verdict.point_forces import away_from_point_forces
from cprbm_scene import Answer, Probe, Scene, SceneError, StationAnswer, scene_from
from cprbm_scene.answer import Array, Flags
from cprbm_scene.statement import STRESSES
from tests.relations.image import Data, Image, plain
from tests.relations.relations import RELATIONS, Relation
from tests.relations.uncertain import Solved, critical_uncertainties, solved, uncertainties

TARGET = 1e-7


@dataclass(frozen=True, slots=True)
class Departure:
    """Departure of a number in an image's answer from the expected number.

    Attributes:
        probe: its name, or that of what is to vanish; empty where no number is meant.
        stage, station: where, of the scene; of what is said of the image alone, of that.
        size: e.
        allowed: by what it is bounded.
        why: in words, where there is nothing to be measured.
    """

    probe: str
    stage: str
    station: float
    size: float
    allowed: float = TARGET
    why: str = ""

    @property
    def pressure(self) -> float:
        """e over what is allowed: above 1 the relation does not hold."""
        return self.size / self.allowed


@dataclass(frozen=True, slots=True)
class Violation:
    """The worst of an image: ``what`` was done of a ``relation``, to which scene."""

    relation: str
    scene: str
    what: str
    worst: Departure

    @property
    def holds(self) -> bool:
        """Whether the relation does here."""
        return self.worst.pressure <= 1.0


def violations(
    data: Data, solver: Solver, choices: Choices, relations: Iterable[Relation] = RELATIONS
) -> Iterator[Violation]:
    """The worst violation of every image of a scene, in the relations' order.

    Args:
        data: the scene as a TOML file's plain data.
        solver: who answers.
        choices: how finely.
        relations: what is done.

    Raises:
        SceneError: the scene is refused; an image that is refused while the scene is not is a violation.
    """
    own = plain(data)
    first = solved(scene_from(own), solver, choices)
    for relation in relations:
        for image in relation.images(own):
            yield Violation(relation.name, first.scene.name, image.what, _worst(first, image, solver, choices))


def _worst(first: Solved, image: Image, solver: Solver, choices: Choices) -> Departure:
    try:
        other = solved(scene_from(image.data), solver, choices)
    except SceneError as error:
        return Departure("", "", math.nan, math.inf, why=f"refused: {error}")
    mine, theirs = first.answer, other.answer
    if theirs.completed is not mine.completed:
        became = f"{mine.ending.name} became {theirs.ending.name}: {theirs.sentence or mine.sentence}"
        return Departure("", "", math.nan, math.inf, why=became)
    found = [
        *_departures(first, image, other),
        *_by_itself(image, other),
        *_criticals(first, image, other),
    ]
    nothing = Departure("", "", math.nan, 0.0, why=mine.sentence)
    return max(found, key=lambda each: (each.pressure, each.size), default=nothing)


def _departures(first: Solved, image: Image, other: Solved) -> Iterator[Departure]:
    """Of every probe that both answers have, at every station that both scenes have."""
    stages = {stage.name: stage for stage in other.scene.stages}
    closed_in = _closing_stages(first.answer)
    scales = probe_scales(other.scene, (other.answer,))
    mine, theirs = ({}, {}) if not image.discretised_anew else (uncertainties(first), uncertainties(other))
    for station in first.answer.stations:
        stage = stages[station.stage]
        value = image.place(stage.name, station.value)
        if value not in stage.stations:
            continue
        try:
            its = station_of(other.answer, stage.name, value)
        except KeyError:
            if other.answer.completed:
                yield Departure("", stage.name, station.value, math.inf, why="it was not reached")
            continue
        if its.branch != station.branch:
            yield Departure("", stage.name, station.value, math.inf, why=f"branch {station.branch} became {its.branch}")
            continue
        for probe in first.scene.probes:
            in_stage = closed_in.get(probe.of, stage.name) if probe.quantity == "closing_load" else stage.name
            expected = image.expected(probe, in_stage, station.values[probe.name])
            if expected is None:
                continue
            scale, w = scales[in_stage, probe.name], its.values[probe.name]
            uncertain = mine.get((probe.name, stage.name, station.value), 0.0)
            uncertain += theirs.get((probe.name, stage.name, value), 0.0)
            allowed = max(TARGET, its.certificate.residual, its.certificate.residual_floor, uncertain)
            if w.shape != expected.shape:
                why = f"{expected.size} numbers became {w.size}"
                yield Departure(probe.name, stage.name, station.value, math.inf, allowed, why)
                continue
            counts = _compared(first.scene, probe, image, (station, its), w)
            yield Departure(
                probe.name, stage.name, station.value, norm(probe.quantity, (w - expected)[counts]) / scale, allowed
            )


def _compared(
    scene: Scene, probe: Probe, image: Image, stations: tuple[StationAnswer, StationAnswer], values: Array
) -> Flags:
    """Which of a probe are compared: of stresses on another discretisation those clear of where contacts end."""
    if not image.discretised_anew or probe.quantity not in STRESSES:
        return np.ones(values.shape, dtype=bool)
    return away_from_point_forces(scene, probe.of, arc_lengths(scene, probe), stations)


def _by_itself(image: Image, other: Solved) -> Iterator[Departure]:
    """What the image's answer must be whatever the scene's is."""
    if image.beyond is None:
        return
    for name, sizes in image.beyond(other.scene, other.answer).items():
        for (stage, value), size in sizes.items():
            certificate = station_of(other.answer, stage, value).certificate
            allowed = max(TARGET, certificate.residual, certificate.residual_floor)
            yield Departure(name, stage, value, size, allowed)


def _criticals(first: Solved, image: Image, other: Solved) -> Iterator[Departure]:
    """Departures of critical points, over the largest value of the load in the stage; uncertainties are allowed."""
    mine, theirs = first.answer, other.answer
    if len(mine.critical) != len(theirs.critical):
        why = f"{len(mine.critical)} critical values became {len(theirs.critical)}"
        yield Departure("critical", "", math.nan, math.inf, why=why)
        return
    # a stage may lead to zero
    largest = {
        stage.name: max(map(abs, (begins_at(other.scene, stage), *stage.stations))) for stage in other.scene.stages
    }
    meshes = [[0.0] * len(theirs.critical)] * 2
    if image.discretised_anew and theirs.critical:
        meshes = [critical_uncertainties(first), critical_uncertainties(other)]
    for here, there, *mesh in zip(mine.critical, theirs.critical, *meshes, strict=True):
        placed = image.place(here.stage, here.value)
        scaled = abs(placed / here.value) if here.value else 1.0
        allowed = scaled * (here.uncertainty + mesh[0]) + there.uncertainty + mesh[1]
        yield Departure(
            "critical",
            there.stage,
            there.value,
            abs(there.value - placed) / largest[there.stage],
            max(TARGET, allowed / largest[there.stage]),
        )


def _closing_stages(answer: Answer) -> dict[str, str]:
    """By contact the stage in which it first closed, to whose load or drive the closing load belongs."""
    found: dict[str, str] = {}
    for station in answer.stations:
        for name, value in station.values.items():
            if name.endswith(".closing_load") and value.size:
                found.setdefault(name.removesuffix(".closing_load"), station.stage)
    return found
