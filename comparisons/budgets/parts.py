"""What the difference of a CPRBM value from the finite elements' is made of: part by part, probe by probe.

==========  ================================================================================================
symbol      meaning
==========  ================================================================================================
N, n, p     links, elements and penetration of the choices
v_c, v_f    the CPRBM's value, the finite elements' in the same theory: those that are compared
v_a         the CPRBM's in the formulation ``auto`` at N; v_c unless ``paper`` was chosen
L_c         limit of v_a for N → ∞
v_0         limit of v_f for p → 0 at n elements
L_f         limit of v_f for p → 0 and n → ∞
δ           v(p/16) − v_0, what the penalty does where it is stiffest
==========  ================================================================================================

    v_c − v_f = (v_c − v_a) + (v_a − L_c) + (L_c − L_f) + (L_f − v_0) + (v_0 − v_f)
                 contact       links         rest          elements      penalty

Each part is its component along v_c − v_f, with its sign: the parts sum to the difference's norm, and a part below
zero makes the difference smaller.  Of a stress they are taken where the difference is largest.  Where there is no
difference at all, parts with cancellation count along v_f.

The limits in N and n are those of :mod:`comparisons.verdict.uncertainty`.
What the penalty does is proportional to p once p is small: v_0 is extrapolated from p/4 and p/16, and v(p) beside
that line says whether p is small as well.  Where it lies farther off than half of what the line says of p, no law is
seen: v_0 is then the value at p/16, and what the line says of that a matter of uncertainty.  L_f is
extrapolated in n from values less what the penalty does to them, δ at n elements and p/16 and δ/16 at 2n and p/256.
On a circle the elements' length decides how deep a beam presses, whatever p: there the penalty is a part of
``elements``.

Where ``auto`` was chosen, the distance of ``paper`` at N stands beside the parts and belongs to no sum.  Nor does what
both solvers leave out of a stress alike, :mod:`comparisons.budgets.curved_beam`, nor L_f less the value of the solid
(:mod:`comparisons.solid_limits`): what the beam theories miss together, by which the sum would go on.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np

from comparisons.budgets.curved_beam import inner_edge_factor
from comparisons.budgets.runs import DEEPER, ELEMENTS, LEVELS, TIGHTNESS, BudgetRuns
from comparisons.geometry import bentness_on, length
from comparisons.quantities import direction, norm
from comparisons.solid_limits import solid_limit
from comparisons.stations import station_of
from comparisons.verdict.point_forces import away_from_point_forces
from comparisons.verdict.rows import Row, bare_row
from comparisons.verdict.scales import probe_scales
from comparisons.verdict.uncertainty import limit
from cprbm_scene import Answer, Probe, Scene, Stage
from cprbm_scene.answer import Array, Flags

LINEAR = 0.5
"""Of what the line says of p: the most by which the value at p may be off it."""

LEAST = 1e-9
"""Parts that come to less, as a fraction, tell of tolerances and of no part."""


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of a difference in the order of the sum, each along it, in the probe's unit."""

    contact: float
    links: float
    rest: float
    elements: float
    penalty: float

    def by_name(self) -> dict[str, float]:
        """The parts by their names, in the order of the sum."""
        return {each.name: getattr(self, each.name) for each in fields(self)}


PARTS = tuple(each.name for each in fields(Parts))


@dataclass(frozen=True, slots=True)
class Budget:
    """What one probe's difference at one station is made of; all in the probe's unit.

    Attributes:
        row: the values, their difference and what fractions are taken of.
        parts: the sum.
        rest_uncertainty: how far L_c − L_f may be off, by the limits' own uncertainties.
        elements_uncertainty: the same of L_f.
        off_line: distance of v_f from the line through the values at p/4 and p/16.
        paper: component of ``paper`` less ``auto`` at N along the difference; None where one of them is missing.
        inner_edge: of a stress K (k,) at all places, the curved beam's inner edge over the straight-beam formula; None
            of other probes.
        curved: the largest (K − 1)|v_f| at the places that take part.
        missed: component along the difference of L_f less the solid's value; None where the solid was not asked, or has
            no such value.
        missed_uncertainty: how far that may be off, by the uncertainties of both.
    """

    row: Row
    parts: Parts
    rest_uncertainty: float
    elements_uncertainty: float
    off_line: float
    paper: float | None
    inner_edge: Array | None
    curved: float | None
    missed: float | None = None
    missed_uncertainty: float | None = None

    @property
    def all_parts(self) -> float:
        """Σ|part| as a fraction; 0 where it is no more than tolerances of two iterations leave."""
        found = self.row.fraction(sum(map(abs, self.parts.by_name().values()))) or 0.0
        return found if found > LEAST else 0.0


def budgets_of(scene: Scene, runs: BudgetRuns) -> tuple[Budget, ...]:
    """All budgets in the order of stages, stations and probes; none where a contact is open, or where the
    answers are on different branches.

    Every answer of :meth:`BudgetRuns.everything` must be complete (:mod:`comparisons.verdict.completeness`).

    Raises:
        KeyError: an answer lacks a station or a probe.
    """
    scales = probe_scales(scene, (runs.cprbm, runs.reference))
    found = (
        _budget(scene, runs, probe, stage, value, scales[stage.name, probe.name])
        for stage in scene.stages
        for value in stage.stations
        for probe in scene.probes_in(stage.name)
    )
    return tuple(each for each in found if each is not None)


def _budget(scene: Scene, runs: BudgetRuns, probe: Probe, stage: Stage, value: float, scale: float) -> Budget | None:
    stations = tuple(station_of(answer, stage.name, value) for _, answer in runs.everything())
    if len({station.branch for station in stations}) > 1:
        return None
    every = [station.values[probe.name] for station in stations]
    if every[0].size == 0 or any(v.shape != every[0].shape for v in every) or not any(v.any() for v in every):
        return None
    pair = station_of(runs.cprbm, stage.name, value), station_of(runs.reference, stage.name, value)
    row = bare_row(scene, pair, probe, stage, value, scale)
    counts = np.ones(row.cprbm.shape, dtype=bool)
    if row.arc_length is not None:
        counts = away_from_point_forces(scene, probe.of, row.arc_length, stations)
        if not counts.any():
            return None

    def v(answer: Answer) -> Array:
        return station_of(answer, stage.name, value).values[probe.name][counts]

    v_c, v_a, v_f = v(runs.cprbm), v(runs.auto[0]), v(runs.reference)
    L_c = limit(LEVELS, np.array([v(answer) for answer in runs.auto]))
    tighter = np.array([v(answer) for answer in runs.penalty[1:]])
    v_0 = limit(TIGHTNESS[1:], tighter, 1.0).value
    delta = tighter[-1] - v_0
    off_line = norm(probe.quantity, v_f - (v_0 + TIGHTNESS[-1] * delta))
    in_doubt = np.zeros_like(delta)
    if off_line > LINEAR * norm(probe.quantity, TIGHTNESS[-1] * delta):
        v_0, delta, in_doubt = tighter[-1], in_doubt, np.abs(delta)
    left = np.outer(DEEPER, delta)
    L_f = limit(ELEMENTS, np.array([v(each) for each in runs.fea]) - left)
    d = v_c - v_f
    along = direction(probe.quantity, d if d.any() else v_f)
    parts = Parts(*(float(np.dot(a - b, along)) for a, b in pairwise([v_c, v_a, L_c.value, L_f.value, v_0, v_f])))
    paper = _in_paper(runs, row)
    K = _inner_edge(scene, row)
    elements_uncertainty = float(np.dot(L_f.uncertainty + in_doubt, np.abs(along)))
    missed = _missed(scene, runs, row, counts, L_f.value, along)
    return Budget(
        row=replace(row, difference=norm(probe.quantity, d)),
        parts=parts,
        rest_uncertainty=float(np.dot(L_c.uncertainty + L_f.uncertainty + in_doubt, np.abs(along))),
        elements_uncertainty=elements_uncertainty,
        off_line=off_line,
        paper=None if paper is None else float(np.dot(paper[counts] - v_a, along)),
        inner_edge=K,
        curved=None if K is None else float(np.max((K - 1.0)[counts] * np.abs(v_f))),
        missed=None if missed is None else missed[0],
        missed_uncertainty=None if missed is None else missed[1] + elements_uncertainty,
    )


def _in_paper(runs: BudgetRuns, row: Row) -> Array | None:
    """The value in ``paper`` at N; None where there is none, or one of a contact that is open there alone."""
    if runs.paper is None or not runs.paper.completed:
        return None
    station, found_on = station_of(runs.paper, row.stage, row.station), station_of(runs.cprbm, row.stage, row.station)
    if station.branch != found_on.branch:
        return None
    found = station.values[row.probe.name]
    return found if found.shape == row.cprbm.shape else None


def _missed(
    scene: Scene, runs: BudgetRuns, row: Row, counts: Flags, limit_of_beams: Array, along: Array
) -> tuple[float, float] | None:
    """Components of L_f less the solid's value, and of what this is uncertain by; None where there is none."""
    if runs.solid is None or not all(answer.completed for answer in runs.solid):
        return None
    limited = solid_limit(scene, row, runs.solid)
    if limited is None:
        return None
    found, clear = limited
    if not clear[counts][np.abs(along) > 0.0].all():  # the solid's contacts may end elsewhere
        return None
    off = limit_of_beams - found.value[counts]
    return float(np.dot(off, along)), float(np.dot(found.uncertainty[counts], np.abs(along)))


def _inner_edge(scene: Scene, row: Row) -> Array | None:
    """K at the places of a stress; None of other probes."""
    if row.arc_length is None:
        return None
    beam = scene.beams[row.probe.of]
    return inner_edge_factor(bentness_on(beam, row.arc_length / length(beam.curve)))
