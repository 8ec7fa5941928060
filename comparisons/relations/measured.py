"""By how much a solver's answer to a scene's image departs from what its answer to the scene says it is.

======  ==============================================================================================
symbol  meaning
======  ==============================================================================================
v, w    a probe's value at a station, in the answer to the scene and in that to the image
v′      what v is in the image
V       v at twice the links or elements
c       the probe's scale in the stage in the image, :mod:`comparisons.scales`
e       |w − v′|/c, the violation
r       what the certificates of both leave unsettled of the probe, over c
u       S·2^p/(2^p − 1)·|v − V| over its own scale, and no less than F times the largest in the stage: the
        uncertainty of the discretisation as :mod:`comparisons.measures` has it
======  ==============================================================================================

A relation that leaves the discretised problem what it is holds where e ≤ max(1e-7, r), another where e ≤ max(1e-7, r, u).
An image that is refused, that ends otherwise or earlier, or has another shape of value, violates it wholly: e = ∞.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from comparisons.choices import Choices
from comparisons.measures import SAFETY, SHARE_OF_LARGEST, arc_lengths, round_off
from comparisons.order import order_of, richardson
from comparisons.pairing import Solver
from comparisons.relations.image import Data, Image, plain
from comparisons.relations.relations import RELATIONS, Relation
from comparisons.scales import norm, probe_scale
from comparisons.spots import clear_of_spots
from comparisons.stations import station_of
from scene import Answer, Probe, Scene, SceneError, Stage, StationAnswer
from scene.reading import scene_from
from scene.statement import STRESSES

TARGET = 1e-7


@dataclass(frozen=True, slots=True)
class Violation:
    """The worst departure of an image's answer.

    Attributes:
        relation: name of what was done.
        case: the scene's name.
        what: what exactly was done.
        probe: name of the probe, or of what is to vanish.
        stage: where.
        station: of the first scene.
        size: e.
        allowed: by what it is bounded.
        why: in a sentence, where there is nothing to be measured.
    """

    relation: str
    case: str
    what: str
    probe: str
    stage: str
    station: float
    size: float
    allowed: float
    why: str = ""

    @property
    def holds(self) -> bool:
        """Whether the relation does here."""
        return self.size <= self.allowed

    @property
    def pressure(self) -> float:
        """e over what is allowed."""
        return self.size / self.allowed


def violations(
    data: Data, solver: Solver, choices: Choices, relations: Iterable[Relation] = RELATIONS
) -> tuple[Violation, ...]:
    """The worst violation of every image of a scene, by the relations' order.

    Args:
        data: the scene as a TOML file's plain data.
        solver: who answers.
        choices: how finely.
        relations: what is done.

    Raises:
        SceneError: the scene is refused; an image that is refused while the scene is not is a violation.
    """
    data = plain(data)
    scene = scene_from(data)
    answer = solver(scene, choices)
    finer: Answer | None = None
    found = []
    for relation in relations:
        for image in relation.images(data):
            if relation.within == "discretisation" and finer is None:
                finer = solver(scene, choices.finer())
            asked = finer if relation.within == "discretisation" else None
            found.append(_worst(relation, scene, answer, image, solver, choices, asked))
    return tuple(found)


def _worst(
    relation: Relation,
    scene: Scene,
    answer: Answer,
    image: Image,
    solver: Solver,
    choices: Choices,
    finer: Answer | None,
) -> Violation:
    def whole(why: str) -> Violation:
        return Violation(relation.name, scene.name, image.what, "", "", math.nan, math.inf, TARGET, why)

    try:
        other = scene_from(image.data)
        theirs = solver(other, choices)
    except SceneError as error:
        return whole(f"refused: {error}")
    if theirs.ending is not answer.ending:
        return whole(f"{answer.ending.name} became {theirs.ending.name}: {theirs.sentence or theirs.ending.value}")
    departures = list(_departures(relation.name, scene, answer, image, other, theirs, finer))
    if not departures:
        return whole("nothing to compare") if answer.stations else replace(whole(answer.sentence), size=0.0)
    return max(departures, key=lambda each: (each.pressure, each.size))


def _departures(
    relation: str,
    scene: Scene,
    answer: Answer,
    image: Image,
    other: Scene,
    theirs: Answer,
    finer: Answer | None,
) -> Iterator[Violation]:
    def violation(probe: str, stage: str, station: float, size: float, allowed: float, why: str = "") -> Violation:
        return Violation(relation, scene.name, image.what, probe, stage, station, size, allowed, why)

    stages = {stage.name: stage for stage in other.stages}
    closed_in = _closing_stages(answer)
    probes = {probe.name: probe for probe in other.probes}
    unsettled = {name: round_off(_reached(other, theirs), probe, (theirs,), (theirs,)) for name, probe in probes.items()}
    uncertain = {} if finer is None else _uncertainties(scene, answer, finer)
    for mine in answer.stations:
        stage = stages[mine.stage]
        value = image.place(mine.stage, mine.value)
        if value not in stage.stations:
            continue
        try:
            station = station_of(theirs, stage.name, value)
        except KeyError:
            yield violation("", stage.name, mine.value, math.inf, TARGET, "it was not reached")
            continue
        if station.branch != mine.branch:
            why = f"branch {mine.branch} became {station.branch}"
            yield violation("", stage.name, mine.value, math.inf, TARGET, why)
            continue
        for probe in scene.probes:
            expected = image.expected(probe, closed_in.get(probe.of, stage.name), mine.values[probe.name])
            if expected is None:
                continue
            w = station.values[probe.name]
            scale = probe_scale(other, probes[probe.name], stage, (theirs,))
            allowed = max(TARGET, unsettled[probe.name] / scale, uncertain.get((probe.name, stage.name, mine.value), 0.0))
            if w.shape != expected.shape:
                why = f"{expected.size} numbers became {w.size}"
                yield violation(probe.name, stage.name, mine.value, math.inf, allowed, why)
                continue
            counts = np.ones(w.shape, dtype=bool)
            if finer is not None and probe.quantity in STRESSES:
                counts = clear_of_spots(scene, probe.of, arc_lengths(scene, probe), (mine, station))
            size = norm(probe.quantity, (w - expected)[counts]) / scale
            yield violation(probe.name, stage.name, mine.value, size, allowed)
    if image.beyond is not None:
        for name, sizes in image.beyond(other, theirs).items():
            for (stage_name, value), size in sizes.items():
                yield violation(name, stage_name, value, size, max(TARGET, _floor(station_of(theirs, stage_name, value))))
    yield from _criticals(violation, answer, theirs, image, stages)


def _criticals(violation, answer, theirs, image, stages):
    if len(answer.critical) != len(theirs.critical):
        why = f"{len(answer.critical)} critical values became {len(theirs.critical)}"
        yield violation("critical", "", math.nan, math.inf, TARGET, why)
        return
    for mine, other in zip(answer.critical, theirs.critical, strict=True):
        span = max(abs(value) for value in stages[mine.stage].stations)
        size = abs(other.value - image.place(mine.stage, mine.value)) / span
        yield violation("critical", mine.stage, mine.value, size, max(TARGET, mine.uncertainty / span))


def _floor(station: StationAnswer) -> float:
    return max(station.certificate.residual, station.certificate.residual_floor)


def _reached(scene: Scene, answer: Answer) -> Scene:
    """The scene with the stages and stations that an answer has."""
    stages: list[Stage] = []
    for stage in scene.stages:
        stations = tuple(station.value for station in answer.stations if station.stage == stage.name)
        if stations:
            stages.append(stage.model_copy(update={"stations": stations}))
    return scene.model_copy(update={"stages": tuple(stages)})


def _closing_stages(answer: Answer) -> dict[str, str]:
    """By contact the stage in which it first closed, to whose load or drive the closing load belongs."""
    found: dict[str, str] = {}
    for station in answer.stations:
        for name, value in station.values.items():
            if name.endswith(".closing_load") and value.size:
                found.setdefault(name.removesuffix(".closing_load"), station.stage)
    return found


def _uncertainties(scene: Scene, answer: Answer, finer: Answer) -> dict[tuple[str, str, float], float]:
    """u by probe, stage and station."""
    found: dict[tuple[str, str, float], float] = {}
    for probe in scene.probes:
        factor = SAFETY * richardson(order_of(scene, probe))
        for stage in scene.stages:
            scale = probe_scale(scene, probe, stage, (answer,))
            changes: dict[float, float] = {}
            for station in answer.stations:
                if station.stage == stage.name:
                    changes[station.value] = factor * _change(scene, probe, station, finer) / scale
            least = SHARE_OF_LARGEST * max(changes.values(), default=0.0)
            found.update({(probe.name, stage.name, value): max(size, least) for value, size in changes.items()})
    return found


def _change(scene: Scene, probe: Probe, station: StationAnswer, finer: Answer) -> float:
    """|v − V|; of what is open in one of them nothing."""
    try:
        other = station_of(finer, station.stage, station.value)
    except KeyError:
        return 0.0
    v, V = station.values[probe.name], other.values[probe.name]
    if v.shape != V.shape:
        return 0.0
    if probe.quantity in STRESSES:
        counts = clear_of_spots(scene, probe.of, arc_lengths(scene, probe), (station, other))
        return norm(probe.quantity, (v - V)[counts])
    return norm(probe.quantity, v - V)
