"""Parts of the difference between the CPRBM and the finite elements, for every probe at every station.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
N, n, p     links, elements and penetration of the choices
v_c, v_f    the CPRBM's value, and the finite elements' in the same theory: the compared values
v_a         the CPRBM's value in ``auto`` at N; v_c unless ``paper`` was chosen
L_c         limit of v_a for N → ∞, from N, 2N and 4N
v_0         limit of v_f for p → 0 at n elements, from p/4 and p/16
L_f         limit of v_f for p → 0 and n → ∞
δ           v(p/16) − v_0, the effect of the penalty where it is stiffest
==========  ================================================================================================

    v_c − v_f = (v_c − v_a) + (v_a − L_c) + (L_c − L_f) + (L_f − v_0) + (v_0 − v_f)
                 contact       links         rest          elements      penalty

A part is its component along v_c − v_f, with its sign: the parts sum to the norm of the difference.  Of a stress the
parts are taken at the place of the largest difference.  Without a difference, parts that cancel count along v_f.

The limits in N and n are those of :mod:`comparisons.verdict.uncertainty`.  The effect of the penalty is proportional to
a small p.  Where v(p) is farther off the line through p/4 and p/16 than half of the line's own change, no law shows:
v_0 is then the value at p/16, and δ becomes an uncertainty.  L_f follows from n at p/16 and 2n at p/256, less δ and
δ/16.  On a circle the length of the elements decides on the depth of a beam: there the penalty is a part of
``elements``.

Three sizes stand beside the sum: the distance of ``paper`` from ``auto`` at N, the error of the straight-beam formula
of stress, and L_f less the value of the solid.

*Straight-beam formula.*  A beam that is curved at rest has in a rectangle in pure bending (Winkler; S. P. Timoshenko,
Strength of Materials II, section 12)

    σ_i = M (r_n − r_i)/(A e r_i),     K = (r_n − r_i) t/(6 e r_i) = (a − h b)/(3 b (1 − h)) = 1 + t/(3R) + O(h²)

======  ====================================================================================
R, t    radius of the neutral line at rest, thickness; h = t/(2R)
r_i     radius of the inner edge, R − t/2
r_n     radius where a pure moment leaves no stress, t/ln(r_o/r_i) = R/a
a, b    (artanh h)/h and (a − 1)/h²; 1 and 1/3 of a straight beam
e       R − r_n = R h² b/a
K       stress at the inner edge over 6 M/(w t²), the straight beam's
======  ====================================================================================

The formula speaks of the moment.  That the moment is E A e R times the change of curvature, and not E I, is of second
order.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.special import hyp2f1

from comparisons.choices import Choices, check_counts
from comparisons.geometry import bentness_on, length
from comparisons.opinions import solid_limit
from comparisons.pairing import in_paper
from comparisons.quantities import direction, norm, probe_scales
from comparisons.sentences import problem_sentences
from comparisons.stations import Where, last_station, station_of, stations_of
from comparisons.store import AnswerMemory
from comparisons.verdict import Row, away_from_point_forces, bare_row, limit
from cprbm_scene import Answer, Array, Flags, Probe, Scene

PARTS = ("contact", "links", "rest", "elements", "penalty")
"""Names of the parts, in the order of the sum."""

LEVELS, ELEMENTS, TIGHTNESS = (1, 2, 4), (1, 2), (1, 4, 16)
"""Links over N, elements over n, and p over the penetration of a run."""

DEEPER = (1.0, 1.0 / 16.0)
"""Penetrations at n and 2n over the penetration at n."""

LINEAR = 0.5
"""Largest distance of v(p) from the line of the penalty, over the change of the line."""

LEAST = 1e-9
"""Fraction below which the parts together are tolerances of the iterations."""

_Runs = Mapping[str, Sequence[Answer]]
"""Answers by name: ``cprbm`` as chosen, ``cprbm auto`` at LEVELS, ``fea`` at TIGHTNESS, ``fea finer`` and
``solid`` at ELEMENTS."""


@dataclass(frozen=True, slots=True)
class Budget:
    """Parts of the difference of a probe at a station, in the probe's unit.

    Attributes:
        row: values, difference and denominator.
        parts: by name, each along the difference.
        rest_uncertainty: of L_c − L_f, by the uncertainties of the limits; elements_uncertainty: of L_f.
        off_line: distance of v_f from the line through the values at p/4 and p/16.
        paper: component of ``paper`` less ``auto`` at N along the difference; None without both values.
        inner_edge: of a stress the factor K (k,) of the curved beam's inner edge; None of other probes.
        curved: the largest (K − 1)|v_f| at the places that take part.
        missed: component of L_f less the solid's value along the difference; None without such a value.
        missed_uncertainty: uncertainty of ``missed``.
    """

    row: Row
    parts: Mapping[str, float]
    rest_uncertainty: float
    elements_uncertainty: float
    off_line: float
    paper: float | None
    inner_edge: Array | None
    curved: float | None
    missed: float | None
    missed_uncertainty: float | None

    @property
    def all_parts(self) -> float:
        """Σ|part| as a fraction; 0 for the tolerances of iterations."""
        found = self.row.fraction(sum(map(abs, self.parts.values()))) or 0.0
        return found if found > LEAST else 0.0


@dataclass(frozen=True, slots=True)
class Account:
    """Budgets of a scene.

    Attributes:
        scene, choices: the question, and the compared discretisation with its theory.
        budgets: at every station; none with an incomplete answer.
        missing: problems of incomplete answers, in sentences.
        silent: why the requested solid has no complete answer; empty otherwise.
    """

    scene: Scene
    choices: Choices
    budgets: tuple[Budget, ...]
    missing: tuple[str, ...] = ()
    silent: str = ""

    @property
    def last(self) -> tuple[Budget, ...]:
        """Budgets of the last station of the last stage."""
        return tuple(each for each in self.budgets if each.row.where == last_station(self.scene))


def account_of(scene: Scene, choices: Choices, memory: AnswerMemory) -> Account:
    """The budgets of a scene.

    Args:
        scene: the question.
        choices: the compared discretisation.
        memory: the solvers, and known answers.

    Raises:
        SceneError: a solver refuses the question.
    """
    check_counts(choices, scene)
    choices = choices.within(choices.kinematics_of(scene))
    runs = _solve(scene, choices, memory)
    solids = runs.pop("solid", [])
    missing = tuple(
        f"{name}, run {place + 1} of {len(answers)}: {sentence}"
        for name, answers in runs.items()
        for place, answer in enumerate(answers)
        for sentence in problem_sentences(scene, answer)
    )
    if missing:
        return Account(scene, choices, (), missing)
    silent = [f"{answer.ending.value}. {answer.sentence}" for answer in solids if not answer.completed]
    beside = {"cprbm paper": runs["cprbm"][0]} if choices.formulation == "paper" else {}
    paper = (beside or in_paper(scene, choices, memory.solvers)).get("cprbm paper")
    scales = probe_scales(scene, (runs["cprbm"][0], runs["fea"][0]))
    found = (
        _budget(scene, runs, paper, () if silent else solids, probe, where, scales[where[0], probe.name])
        for where in stations_of(scene)
        for probe in scene.probes_in(where[0])
    )
    return Account(scene, choices, tuple(filter(None, found)), silent="".join(silent[:1]))


def _solve(scene: Scene, choices: Choices, memory: AnswerMemory) -> dict[str, list[Answer]]:
    even, solvers = replace(choices, formulation="auto"), memory.solvers
    tight = [replace(choices, penetration=choices.penetration / tightness) for tightness in TIGHTNESS]
    wanted = [
        ("cprbm", solvers.cprbm, [choices]),
        ("cprbm auto", solvers.cprbm, [even, even.finer(), even.finer().finer()]),
        ("fea", solvers.fea, tight),
        ("fea finer", solvers.fea, [tight[-1], tight[-1].finer()]),
    ]
    if solvers.solid is not None:
        wanted.append(("solid", solvers.solid, [choices, choices.finer()]))
    answers = iter(memory.answers([(solver, scene, own) for _, solver, every in wanted for own in every]))
    return {name: [next(answers) for _ in every] for name, _, every in wanted}


def _budget(
    scene: Scene,
    runs: _Runs,
    paper: Answer | None,
    solids: Sequence[Answer],
    probe: Probe,
    where: Where,
    scale: float,
) -> Budget | None:
    """The budget of a probe; None where a contact is open, and where the answers are on different branches."""
    at = {name: [station_of(each, *where) for each in answers] for name, answers in runs.items()}
    stations = [station for each in at.values() for station in each]
    every = [station.values[probe.name] for station in stations]
    if len({(station.branch, v.shape) for station, v in zip(stations, every, strict=True)}) > 1 or not np.any(every):
        return None
    row = bare_row(scene, (at["cprbm"][0], at["fea"][0]), probe, where, scale)
    counts, K = np.ones(row.cprbm.shape, dtype=bool), None
    if row.arc_length is not None:
        counts, beam = away_from_point_forces(scene, probe.of, row.arc_length, stations), scene.beams[probe.of]
        if not counts.any():
            return None
        K = inner_edge_factor(bentness_on(beam, row.arc_length / length(beam.curve)))
    v = {name: np.array([each.values[probe.name][counts] for each in found]) for name, found in at.items()}
    v_c, v_a, v_f = v["cprbm"][0], v["cprbm auto"][0], v["fea"][0]
    v_0, delta, off_line, in_doubt = _penalty(probe, v["fea"])
    L_c = limit(LEVELS, v["cprbm auto"])
    L_f = limit(ELEMENTS, v["fea finer"] - np.outer(DEEPER, delta))
    along = direction(probe.quantity, v_c - v_f if (v_c - v_f).any() else v_f)
    parts = (float(np.dot(one - two, along)) for one, two in pairwise([v_c, v_a, L_c.value, L_f.value, v_0, v_f]))
    own = float(np.dot(L_f.uncertainty + in_doubt, np.abs(along)))
    missed, uncertainty = _solid_part(scene, row, solids, counts, L_f.value, along)
    return Budget(
        row=replace(row, difference=norm(probe.quantity, v_c - v_f)),
        parts=dict(zip(PARTS, parts, strict=True)),
        rest_uncertainty=float(np.dot(L_c.uncertainty, np.abs(along))) + own,
        elements_uncertainty=own,
        off_line=off_line,
        paper=_of_paper(paper, row, at["cprbm"][0].branch, v_a, counts, along),
        inner_edge=K,
        curved=None if K is None else float(np.max((K - 1.0)[counts] * np.abs(v_f))),
        missed=missed,
        missed_uncertainty=None if missed is None else uncertainty + own,
    )


def _penalty(probe: Probe, values: Array) -> tuple[Array, Array, float, Array]:
    """v_0, δ, the distance of v(p) from the line, and the uncertainty of v_0, from values (3, k) at p, p/4 and p/16."""
    v_0 = limit(TIGHTNESS[1:], values[1:], 1.0).value
    delta = values[-1] - v_0
    off_line = norm(probe.quantity, values[0] - (v_0 + TIGHTNESS[-1] * delta))
    if off_line > LINEAR * norm(probe.quantity, TIGHTNESS[-1] * delta):
        return values[-1], np.zeros_like(delta), off_line, np.abs(delta)
    return v_0, delta, off_line, np.zeros_like(delta)


def _of_paper(paper: Answer | None, row: Row, branch: int, v_a: Array, counts: Flags, along: Array) -> float | None:
    """Component of ``paper`` less ``auto``; None without a complete answer on the branch with such a value."""
    station = station_of(paper, *row.where) if paper is not None and paper.completed else None
    if station is None or station.branch != branch or station.values[row.probe.name].shape != row.cprbm.shape:
        return None
    return float(np.dot(station.values[row.probe.name][counts] - v_a, along))


def _solid_part(
    scene: Scene, row: Row, solids: Sequence[Answer], counts: Flags, beams: Array, along: Array
) -> tuple[float | None, float]:
    """Component of the ``beams``' limit less the solid's value, and its uncertainty; None without such a value."""
    limited = solid_limit(scene, row, solids) if solids else None
    if limited is None or not limited[1][counts][np.abs(along) > 0.0].all():  # the solid's contacts may end elsewhere
        return None, 0.0
    value, uncertainty = limited[0].value[counts], limited[0].uncertainty[counts]
    return float(np.dot(beams - value, along)), float(np.dot(uncertainty, np.abs(along)))


def inner_edge_factor(bentness: Array) -> Array:
    """K at thickness over radius ``bentness`` (k,), from 0 for a straight beam and less than 2.

    Raises:
        ValueError: an inner edge on or beyond the centre of curvature.
    """
    h = 0.5 * np.asarray(bentness, dtype=float)
    if not np.all((h >= 0.0) & (h < 1.0)):
        raise ValueError("thickness over radius must be at least 0 and less than 2")
    b = hyp2f1(1.0, 1.5, 2.5, h**2) / 3.0  # Σ h^(2k)/(2k + 3), without the cancellation of a − 1 at a small h
    a = 1.0 + h**2 * b
    return np.asarray((a - h * b) / (3.0 * b * (1.0 - h)))
