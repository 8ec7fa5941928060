"""Between a scene and its solvers: notes, requirements, active contacts, progress, and a single thread of BLAS.

A note names crossing beams without a contact, or a load too large for the beams with a mix-up of units as explanation.

=======  ==============================================================
symbol   meaning
=======  ==============================================================
P, M, q  largest force, moment and distributed load of the stages
L, E I   length and largest bending stiffness of a beam
r        P L²/(E I), M L/(E I) or q L³/(E I): of order 1 where the deflection is the length
=======  ==============================================================

With E I = E w t³/12, r has the power -1 of E, 1 of the force and -2 of the unit of length, for every kind of load.

A solver states the met requirements and refuses the others by name.

A contact is active where its forces exceed a floor: round-off leaves forces of 1e-15 N in contacts that only touch.

For small matrices further threads of BLAS take time.  In a process with a loaded BLAS only threadpoolctl can limit the
threads.  Without threadpoolctl BLAS keeps the threads of the process; the program ``cprbm`` limits these threads at the
start (:mod:`comparisons.threads`).
"""

import logging
import math
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import lru_cache
from itertools import combinations, pairwise
from typing import Any, Literal, cast

import numpy as np

from cprbm_scene.answer import Array, ContactState, Event, PointForces, StationAnswer, frozen_array
from cprbm_scene.clearance import crossing, overlap_at_rest
from cprbm_scene.curve_records import shape_of
from cprbm_scene.fields import Units
from cprbm_scene.freedoms import Freedoms, unsupported
from cprbm_scene.mistakes import Mistake, SceneError, broken
from cprbm_scene.statement import (
    BeamContact,
    BodyLoad,
    CircleContact,
    EllipseContact,
    Load,
    Material,
    Scene,
    SplineContact,
)
from cprbm_scene.units import BY_QUANTITY, SIZES

Requirement = Literal["theory", "overlap at rest", "from", "together", "support", "edge"]


def requirements(scene: Scene) -> Iterator[tuple[Requirement, Mistake]]:
    """Kinds of requirements, with keys, values found, and values for a solver without the feature."""
    first, file, contacts = scene.stages[0].name, scene.file, [*scene.contacts.items()]
    overlaps = ((name, overlap_at_rest(scene, each)) for name, each in contacts if isinstance(each, BeamContact))
    rules: dict[Requirement, Iterator[Mistake]] = {
        "theory": broken(scene.theory != "bending" and Mistake("theory", repr(scene.theory), "'bending'", file)),
        "from": (
            Mistake(
                f"drives.{name}.from",
                f"a drive that is free before the stage {drive.begins!r}",
                "drives that hold from the start",
                file,
            )
            for name, drive in scene.drives.items()
            if not scene.holds(drive, first)
        ),
        "together": (
            Mistake(f"stages[{i}].steps", f"{list(stage.together)}", "one name", file)
            for i, stage in enumerate(scene.stages)
            if stage.together
        ),
        "support": (
            Mistake(mistake.key, mistake.found, "joints, guides and drives that hold it", file)
            for mistake, _ in unsupported(scene, Freedoms(scene))
        ),
        "edge": (
            Mistake(
                f"contacts.{name}",
                f"{each.kind!r}, {each.side}",
                "a circle from outside, a line, a half-plane or a function",
                file,
            )
            for name, each in contacts
            if isinstance(each, SplineContact | EllipseContact)
            or (isinstance(each, CircleContact) and each.side == "inside")
        ),
        "overlap at rest": (
            Mistake(
                f"contacts.{name}",
                f"beams that overlap at the start by {overlap:.3g} m",
                "beams that touch or are apart",
                file,
            )
            for name, overlap in overlaps
            if overlap
        ),
    }
    return ((kind, mistake) for kind, mistakes in rules.items() for mistake in mistakes)


def refuse(scene: Scene, solver: str, *met: Requirement) -> None:
    """Refuse a scene with requirements beyond those ``met`` by a ``solver``.

    Args:
        scene: the problem statement.
        solver: name of the solver for the message.
        met: kinds of requirements for which the solver has equations.

    Raises:
        SceneError: the scene has further requirements; the error names every key.
    """
    found = [mistake for kind, mistake in requirements(scene) if kind not in met]
    if found:
        raise SceneError([Mistake(e.key, e.found, f"{e.allowed}, for {solver}", e.file) for e in found])


ACTIVE = 1e-9
"""Floor of an active contact's force, over the largest force at the station: round-off leaves far less."""

UNLOADED = 1e-12
"""The same over the natural force, the largest E·I over the square of the longest beam: no load acts below."""


def contact_states(
    names: Iterable[str], forces: PointForces, touching: Mapping[str, Array], natural: tuple[float, float]
) -> Mapping[str, ContactState]:
    """States of the contacts ``names`` by their forces; ``natural`` are the scene's length (m) and force (N).

    A moment counts as a force at the natural length.  Without any forces a contact that touches is active.
    """
    size = np.hypot(forces.force[:, 0], forces.force[:, 1]) + np.abs(forces.moment) / natural[0]
    floor = max(ACTIVE * float(np.max(size, initial=0.0)), UNLOADED * natural[1])
    source, nowhere = np.array(forces.source, dtype=str), frozen_array(np.zeros((0, 2)))
    return {
        name: ContactState(
            bool(size[source == name].sum() > floor) if len(size) else name in touching, touching.get(name, nowhere)
        )
        for name in names
    }


def openings(scene: Scene, stations: Sequence[StationAnswer]) -> tuple[Event, ...]:
    """Events of contacts with forces at a station and without forces at the next station of the same branch.

    Between two stages the interval begins where the stepped load or drive stands before the later stage.
    """
    found, reached = [], dict.fromkeys((*scene.loads, *scene.drives), 0.0)
    steps = {stage.name: stage.steps for stage in scene.stages}
    for before, after in pairwise(stations):
        reached[steps[before.stage]] = before.value
        if before.branch == after.branch:
            low, high = sorted((reached[steps[after.stage]], after.value))
            found += [
                Event(after.stage, name, "opens", 0.5 * (low + high), (low, high))
                for name, contact in before.contacts.items()
                if contact.active and not after.contacts[name].active
            ]
    return tuple(found)


def station_reached(logger: logging.Logger, scene: Scene, reached: int, station: StationAnswer) -> None:
    """Log, at the level INFO, that a solver has come to the ``station`` with the number ``reached`` of the scene."""
    steps, whole = {stage.name: stage.steps for stage in scene.stages}, sum(len(each.stations) for each in scene.stages)
    spent = station.certificate.iterations
    logger.info(
        "%s: %s, stage %s: station %d of %d, %s = %.6g, %d iteration%s",
        scene.name,
        logger.name.rpartition(".")[0],
        station.stage,
        reached,
        whole,
        steps[station.stage],
        station.value,
        spent,
        "" if spent == 1 else "s",
        extra={"done": reached, "whole": whole},
    )


def one_thread() -> AbstractContextManager[object]:
    """Context with a single thread per loaded library of linear algebra; without effect if threadpoolctl is missing."""
    try:
        libraries = _loaded(len(sys.modules))
    except ImportError:
        return nullcontext()
    return cast("AbstractContextManager[object]", libraries.limit(limits=1, user_api="blas"))


@lru_cache(maxsize=1)
def _loaded(modules: int) -> Any:  # noqa: ANN401 - threadpoolctl has no types
    """Controller of the loaded libraries, cached: threadpoolctl reads the process's map of memory, which takes long.

    Libraries are loaded with Python modules, so that an equal number of ``modules`` means equal libraries.
    """
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


LARGE = 1000.0
"""r above which a load is implausible: a cantilever under r = 1000 is straight but for 3 % of its length."""
SOFTEST, STIFFEST = 1e6, 1.5e12
"""Young's moduli of rubber and diamond, rounded outwards, Pa."""
_SAMPLES = 201
_POWERS = {"stress": -1, "length": -2, "force": 1}


def notes(scene: Scene) -> Iterator[str]:
    """Sentences on implausible parts of a scene; none for most scenes.

    Args:
        scene: a scene without mistakes.
    """
    known = {*map(frozenset, scene.may_cross), *(frozenset(contact.beams) for contact in scene.contacts.values())}
    lines = {name: shape_of(beam.curve).point(np.linspace(0.0, 1.0, _SAMPLES)) for name, beam in scene.beams.items()}
    for first, second in combinations(scene.beams, 2):
        p, q = lines[first], lines[second]
        beside = np.any(p.min(axis=0) > q.max(axis=0)) or np.any(q.min(axis=0) > p.max(axis=0))
        if not beside and {first, second} not in known and (place := crossing(scene, first, second)):
            yield (
                f"beams.{second}: crosses the beam {first!r} at the start, at {place} m: without a contact of the two, "
                "no force acts there; a pair in may_cross needs no note."
            )
    yield from [*_load_notes(scene)] or (
        f"materials.{name}: youngs_modulus is {material.youngs_modulus:.3g} Pa, implausible below {SOFTEST:g} "
        f"and above {STIFFEST:g} Pa. Is the number in {scene.display_units.stress}, the file's unit of stress?"
        for name, material in scene.materials.items()
        if not SOFTEST <= material.youngs_modulus <= STIFFEST
    )


def _load_notes(scene: Scene) -> Iterator[str]:
    """Sentences on implausible loads."""
    for name, load in scene.loads.items():
        largest = max(
            (abs(value) for stage in scene.stages if name in stage.stepped for value in stage.stations), default=0.0
        )
        beams = scene.beams if isinstance(load, BodyLoad) else [load.beam]
        ratio, beam = min((largest * _per_unit(scene, load, beam), beam) for beam in beams)
        if ratio > LARGE:
            symbol = {"force": "P L^2", "beam_force": "P L^2", "distributed": "q L^3"}.get(load.kind, "M L")
            yield (
                f"loads.{name}: {symbol}/(E I) is {ratio:.3g} for the beam {beam!r}, implausible above {LARGE:g}."
                + _explanation(ratio, scene.materials[scene.beams[beam].material], scene.display_units)
            )


def _per_unit(scene: Scene, load: Load, name: str) -> float:
    """The ratio r of a load of 1 in SI units on a beam."""
    beam = scene.beams[name]
    width = float(beam.width_at(beam.knots).max())
    stiffness = scene.materials[beam.material].youngs_modulus * width * beam.thickest**3 / 12.0
    return float(shape_of(beam.curve).length ** (2 - load.unit.length) / stiffness)


def _explanation(ratio: float, material: Material, units: Units) -> str:
    """The question about the mix-up of units that brings r and E closest to ordinary values; empty without any."""
    mixed = (
        (quantity, own, other, float(SIZES[other] / SIZES[own]))
        for quantity, own in units
        for other in (BY_QUANTITY[quantity] if quantity in _POWERS else ())
        if other != own
    )
    found = (
        (abs(math.log10(true)), f" Is a {quantity} in {other} written as {own}?")
        for quantity, own, other, factor in mixed
        if (true := ratio * factor ** _POWERS[quantity]) <= LARGE
        and SOFTEST <= material.youngs_modulus * (factor if quantity == "stress" else 1.0) <= STIFFEST
    )
    return min(found, default=(0.0, ""))[1]
