"""The solid's meshes for a tolerance: each twice as fine as the one before, until their limit is known well enough.

=======  =====================================================================================================
symbol   meaning
=======  =====================================================================================================
τ        the tolerance, a fraction
f        stated uncertainty of a row: U of :mod:`comparisons.solid_limits` over the denominator of its differences
=======  =====================================================================================================

Two meshes state f of order 2, three and more of the order that they show.  The answer is extrapolated from the finest
meshes that were solved, and no mesh is solved in vain.  A mesh on which the
solid does not arrive counts for nothing, and the next one is begun with.

The search ends unmet where the next mesh would be finer than :data:`LARGEST`, or where no probe that is not within τ
would be so on the finest even if its error fell with the fourth power of an element's length, the best that these
elements can do.  As long as one might, the search goes on for it: beside a kink of a section the stress of a solid has
no bound, and displacements are not to suffer from that.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparisons.choices import Choices
from comparisons.crew import Solver
from comparisons.pairing import Runs
from comparisons.quantities import norm
from comparisons.sentences import problem_sentences
from comparisons.solid_limits import solid_limit
from comparisons.stations import station_of
from comparisons.store import AnswerMemory
from comparisons.tolerances.search import Estimate, Stated, Tolerance
from comparisons.tolerances.settled import extrapolation_note
from comparisons.verdict.rows import Row, rows_of
from comparisons.verdict.uncertainty import OWN, STANDARD, largest
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import PointForces, frozen_array
from cprbm_scene.frozendict import frozendict

FIRST = (20, 1)
"""Elements along a beam and across it, of the first mesh."""

LARGEST = 160
"""Elements along a beam beyond which nothing is solved."""


@dataclass(frozen=True, slots=True)
class Meshed:
    """The solid within a tolerance: answers on meshes that double, whole ones if there are any, and what they state."""

    answers: tuple[Answer, ...]
    estimate: Estimate
    reached: Tolerance


def meshed(
    scene: Scene,
    solver: Solver,
    choices: Choices,
    tolerance: float,
    memory: AnswerMemory,
    rows: Sequence[Row] | None = None,
) -> Meshed:
    """Refine until every row's stated uncertainty is within a tolerance, or no finer mesh is allowed.

    Args:
        scene: the question.
        solver: who answers as a solid.
        choices: its numbers of elements do not count.
        tolerance: τ.
        memory: solves, nothing twice.
        rows: of a comparison, by whose denominators the fractions are; else by the solid's own values.

    Raises:
        SceneError: the solver refuses the question.
    """
    along, across = FIRST
    answers: tuple[Answer, ...] = ()
    solved: list[int] = []
    while True:
        solved.append(along)
        (answer,) = memory.answers([(solver, scene, replace(choices, elements=along, across=across))])
        trouble = problem_sentences(scene, answer)
        answers = () if trouble else (*answers, answer)
        if len(answers) > 1:
            estimate = stated(scene, answers, rows)
        else:
            estimate = Estimate((), trouble[0] if trouble else "one mesh alone states nothing")
        met = estimate.fraction <= tolerance
        ended = "" if met else _ended(estimate, along, tolerance)
        if met or ended:
            break
        along, across = 2 * along, 2 * across
    extrapolates = len(answers) > 1
    reached = Tolerance(
        asked=tolerance,
        met=met,
        solver="solid",
        n=along,
        worst=None if estimate.trouble else estimate.worst,
        trouble=estimate.trouble,
        extrapolated=(along // 2, along) if extrapolates else (),
        probes=tuple(probe.name for probe in scene.probes) if extrapolates else (),
        solved=tuple(solved),
        ended=ended,
    )
    return Meshed(answers or (answer,), estimate, reached)


def _ended(estimate: Estimate, along: int, tolerance: float) -> str:
    """Why a search ends unmet, and what it has met; empty if it goes on."""
    worst = estimate.worst_of_probes()
    unmet = [fraction for fraction in worst.values() if fraction > tolerance]
    fall = (LARGEST / along) ** OWN["solid"]
    if 2 * along > LARGEST:
        why = f"no mesh of more than {LARGEST} elements along a beam is solved"
    elif not estimate.trouble and all(tolerance * fall < fraction < math.inf for fraction in unmet):
        why = f"{LARGEST} elements along a beam, the most that are solved, would not do either"
    else:
        return ""
    met = ", ".join(name for name, fraction in worst.items() if fraction <= tolerance)
    return f"{why}; within it: {met}" if met else why


def stated(scene: Scene, answers: Sequence[Answer], rows: Sequence[Row] | None = None) -> Estimate:
    """The stated uncertainty of every row that has a value on the finest of two meshes or more."""
    found, nothing = [], []
    for row in _own_rows(scene, answers[-1]) if rows is None else rows:
        limited = solid_limit(scene, row, answers)
        if limited is None:
            if _comes_and_goes(row, answers):
                nothing.append(Stated(row.probe.name, row.stage, row.station, math.inf, STANDARD))
        elif limited[1].any():
            found.append((row, limited[0].assumed, norm(row.probe.quantity, limited[0].uncertainty[limited[1]])))
    widest = largest(((row.probe.name, row.stage), u) for row, _, u in found)
    known = [
        Stated(row.probe.name, row.stage, row.station, fraction, order)
        for row, order, _ in found
        if (fraction := row.fraction(widest[row.probe.name, row.stage])) is not None
    ]
    return Estimate((*nothing, *known))


def _comes_and_goes(row: Row, answers: Sequence[Answer]) -> bool:
    """Whether a value is there on one of the finest two meshes and not on the other."""
    values = [station_of(answer, row.stage, row.station).values[row.probe.name] for answer in answers[-2:]]
    return len({value.shape for value in values}) > 1


def _own_rows(scene: Scene, answer: Answer) -> tuple[Row, ...]:
    """The scene's rows, with the answer in the place of all others."""
    return rows_of(scene, Runs("bending", (answer, answer), (answer, answer)))


def settled(scene: Scene, answers: Sequence[Answer]) -> Answer:
    """The finest answer with the values that all tend to; of one alone itself.

    A value that is there on one mesh and not on another is the finest's, and so are the ends of a zone that would
    change places.  Limits are of no state: nothing says what acts, and all but values is the finest's.
    """
    if len(answers) < 2:
        return answers[-1]
    values = {(station.stage, station.value): dict(station.values) for station in answers[-1].stations}
    for row in _own_rows(scene, answers[-1]):
        found = solid_limit(scene, row, answers)
        if found is None or (row.probe.quantity == "ends" and np.any(np.diff(found[0].value) < 0.0)):
            continue
        values[row.stage, row.station][row.probe.name] = frozen_array(found[0].value)
    stations = [
        replace(
            station,
            values=frozendict(values[station.stage, station.value]),
            beams={},
            forces=PointForces(),
        )
        for station in answers[-1].stations
    ]
    sizes = tuple(int(str(answer.settings["elements"])) for answer in answers[-2:])
    return replace(
        answers[-1],
        settings=frozendict({**answers[-1].settings, "extrapolated_from": list(sizes)}),
        stations=tuple(stations),
        seconds=sum(answer.seconds for answer in answers),
        notes=(*answers[-1].notes, extrapolation_note(sizes, [probe.name for probe in scene.probes])),
    )
