"""Rows of a comparison: a probe at a station, both values, their difference and its stated uncertainty.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM, v_f of the finite elements; v_a of the CPRBM in the formulation ``auto``
v_o     value of the CPRBM in ``auto`` in the other theory
θ       |v_o − v_a|, the step of theory, both at N links: their errors of discretisation cancel
x       exact value, where the comparison is in ``bending`` and the elastica reference has the station
q       uncertainty of x: its certificate's residual, at least 1e-9 of the scale; the root of this share for a place
        of contact at an end of the beam in the exact answer alone, since the overlap inside of the beam that moves the
        exact place grows with the square of the distance from the end
======  ==========================================================================================

A probe has one stated uncertainty per solver, stage and branch: the largest of the stations.  An error changes its sign
along a stage, and the change between two grids vanishes there by accident.  Critical points split a stage, and so do
stations at which a clamp or another contact shares the force: the shares of a force do not converge.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from comparisons.quantities import (
    OPEN_AT_ZERO,
    PLACES_OF_CONTACT,
    arc_lengths,
    denominator,
    norm,
    probe_scales,
    unit_of,
)
from comparisons.stations import Where, complete_stations
from comparisons.verdict.events import NO_EVENTS, StationEvents, station_events
from comparisons.verdict.point_forces import away_from_point_forces, largest_tilt, sharing_sources
from comparisons.verdict.runs import Bounds, Runs
from comparisons.verdict.uncertainty import Error, largest
from comparisons.verdict.words import Reason, Word
from cprbm_scene import STRESSES, Array, Flags, Probe, Quantity, Scene, StationAnswer

ROUND_OFF = 1e-9
"""Round-off of a value, and least uncertainty of an exact value, as shares of the probe's scale."""

SHARED: frozenset[Quantity] = frozenset({"force", "centre", "ends", "reaction", "reaction_moment"})
"""Quantities of a contact or a joint that depend on how a clamp and a contact share a force."""


@dataclass(frozen=True, slots=True)
class TrueErrors:
    """Distances from the exact value in the probe's unit: of v_c, of v_f, and q."""

    cprbm: float
    fea: float
    allowance: float


@dataclass(frozen=True, slots=True)
class Third:
    """A value of the solid beside a row, in the probe's unit.

    Attributes:
        solid: x (k,); uncertainty: u, as :mod:`comparisons.opinions` says.
        cprbm, fea, other: distances from x of the CPRBM, of the finite elements, and of the CPRBM in the other theory;
            NaN without a value.
    """

    solid: Array
    uncertainty: float
    cprbm: float
    fea: float
    other: float


@dataclass(frozen=True, slots=True)
class Row:
    """Probe at a station; all sizes in ``unit``.

    Attributes:
        probe, stage, station: the question.
        unit: SI unit.
        cprbm, fea: values (k,), empty where a contact is open.
        scale: of the probe in the stage; denominator: divisor of shown fractions.
        events: events of the runs by the station.
        shared: a beam, and the sources that share a force with the probe's contact or joint; None without any.
        difference: distance of v_c from v_f; NaN without a value.
        other: v_o on the row's branch; None without such a value.
        theory: θ; NaN without v_o, or with a v_o of another shape.
        bounds: stated uncertainties; None without the value of a needed run.
        missing: runs without the station; absent: runs without a value, since a contact is open.
        arc_length: places (k,) of a stress, m.
        counts: components (k,) in the difference: of a stress all away from point forces; None without a difference.
        exact: x; true_errors: distances from x.
        word: None where the row takes no part in the verdict; reason: unless the word has none.
        third: the row beside the solid; None without a solid.
    """

    probe: Probe
    stage: str
    station: float
    unit: str
    cprbm: Array
    fea: Array
    scale: float
    denominator: float
    events: StationEvents = NO_EVENTS
    shared: tuple[str, frozenset[str]] | None = None
    difference: float = math.nan
    other: Array | None = None
    theory: float = math.nan
    bounds: Bounds | None = None
    missing: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    arc_length: Array | None = None
    counts: Flags | None = None
    exact: Array | None = None
    true_errors: TrueErrors | None = None
    word: Word | None = None
    reason: Reason | None = None
    third: Third | None = None

    @property
    def branch(self) -> int | None:
        """Number of critical points before the station; None where the runs have passed different numbers."""
        return self.events.branch

    @property
    def where(self) -> tuple[str, float]:
        """Stage and station."""
        return self.stage, self.station

    @property
    def largest_difference(self) -> float:
        """Difference of the largest stresses, Pa; NaN of other quantities and without a difference."""
        if self.arc_length is None or self.counts is None:
            return math.nan
        return abs(norm(self.probe.quantity, self.cprbm) - norm(self.probe.quantity, self.fea))

    def fraction(self, value: float) -> float | None:
        """``value`` over the denominator; None without a finite quotient."""
        if math.isfinite(value) and self.denominator > 0.0:
            return value / self.denominator
        return 0.0 if value == 0.0 else None


def rows_of(runs: Runs) -> tuple[Row, ...]:
    """All rows of the stations that both compared runs reach, in the order of stations and probes."""
    scene, events, found = runs.scene, station_events(runs), list[Row]()
    scales = probe_scales(scene, runs.pair)
    opinions = [each and complete_stations(scene, each) for each in (runs.answers.get("exact"), runs.other)]
    for where in runs.reached:
        stations, branch = runs.at(where), events[where].branch
        exact, other = (
            at if at and at.branch == branch else None for at in (each and each.get(where) for each in opinions)
        )
        missing = tuple(name for name in runs.same_theory if name not in stations)
        tilt = largest_tilt(scene, stations["fea"]) if runs.theory == "shear" else 0.0
        for probe in scene.probes_in(where[0]):
            row = bare_row(scene, (stations["cprbm"], stations["fea"]), probe, where, scales[where[0], probe.name])
            row = replace(
                row,
                events=events[where],
                shared=sharing_sources(scene, stations.values(), probe.of) if probe.quantity in SHARED else None,
                missing=missing,
            )
            found.append(_measured(runs, row, stations, exact, other, tilt))
    return _with_largest_uncertainties(found)


def bare_row(scene: Scene, pair: tuple[StationAnswer, StationAnswer], probe: Probe, where: Where, scale: float) -> Row:
    """The values of the two compared answers, without a difference.

    Args:
        scene: the question.
        pair: the station of the CPRBM and of the finite elements.
        probe: the probe.
        where: the stage and the station.
        scale: of the probe in the stage, :func:`comparisons.quantities.probe_scales`.

    Raises:
        KeyError: an answer lacks the probe.
    """
    v_c, v_f = (station.values[probe.name] for station in pair)
    return Row(
        probe=probe,
        stage=where[0],
        station=where[1],
        unit=unit_of(scene, probe, where[0]),
        cprbm=v_c,
        fea=v_f,
        scale=scale,
        denominator=denominator(probe, norm(probe.quantity, v_f), scale),
        arc_length=arc_lengths(scene, probe) if probe.quantity in STRESSES else None,
    )


def _measured(
    runs: Runs,
    row: Row,
    stations: Mapping[str, StationAnswer],
    exact: StationAnswer | None,
    other: StationAnswer | None,
    tilt: float,
) -> Row:
    """The row with its difference, step of theory, stated uncertainties and true errors."""
    probe = row.probe
    values = {name: station.values[probe.name] for name, station in stations.items()}
    row = replace(
        row,
        exact=None if exact is None else exact.values[probe.name],
        other=None if other is None else other.values.get(probe.name),
        absent=tuple(name for name, value in values.items() if value.size == 0),
    )
    if row.fea.size == 0 or any(value.shape != row.fea.shape for value in values.values()):
        return row
    counts = np.ones(row.fea.shape, dtype=bool)
    if row.arc_length is not None:
        every = (*stations.values(), *(() if other is None else (other,)))
        counts = away_from_point_forces(runs.scene, probe.of, row.arc_length, every)
    if not counts.any():
        return row

    def size(difference: Array) -> float:
        return norm(probe.quantity, difference[counts])

    row = replace(row, counts=counts, difference=size(row.cprbm - row.fea))
    if row.other is not None and row.other.shape == row.fea.shape:
        even = "cprbm finer" if "cprbm" in runs.settled else "cprbm auto"  # settled values have the answer at N there
        row = replace(row, theory=size(row.other - values.get(even, row.cprbm)))
    if row.events.between:
        return row
    is_open = probe.quantity in OPEN_AT_ZERO and not any(value.any() for value in values.values())
    floor = 0.0 if is_open else ROUND_OFF * row.scale
    key = (row.stage, row.station, probe.name)
    settled = {name: each[key] for name, each in runs.settled.items() if key in each}
    known = {name: Error(each.even[counts], each.uneven[counts]) for name, each in settled.items()}
    return replace(
        row,
        bounds=runs.bounds(
            {name: value[counts] for name, value in values.items()},
            lambda difference: norm(probe.quantity, difference),
            floor,
            known,
            tilt * row.scale,
        ),
        true_errors=_true_errors(row, exact, size),
    )


def _true_errors(row: Row, exact: StationAnswer | None, size: Callable[[Array], float]) -> TrueErrors | None:
    if exact is None or row.exact is None or row.exact.shape != row.fea.shape:
        return None
    share = max(exact.certificate.residual, exact.certificate.residual_floor, ROUND_OFF)
    if row.probe.quantity in PLACES_OF_CONTACT:
        exact_ends, *ends = (
            np.minimum(x, row.scale - x) <= ROUND_OFF * row.scale for x in (row.exact, row.cprbm, row.fea)
        )
        share = math.sqrt(share) if np.any(exact_ends & ~np.any(ends, axis=0)) else share
    return TrueErrors(size(row.cprbm - row.exact), size(row.fea - row.exact), share * row.scale)


def _with_largest_uncertainties(rows: Sequence[Row]) -> tuple[Row, ...]:
    """The rows with one uncertainty per solver, probe, stage and branch: the largest of the stations.

    A contact that is open in all runs has no force and no uncertainty.
    """

    def key(row: Row) -> tuple[object, ...]:
        return row.probe.name, row.stage, row.branch, row.shared is None

    stated = {
        name: largest(
            (key(row), getattr(row.bounds, name)) for row in rows if row.bounds is not None and not row.events.unsettled
        )
        for name in ("cprbm", "fea")
    }

    def widened(row: Row) -> Row:
        if row.bounds is None or row.bounds.total == 0.0:
            return row
        own = {name: max(getattr(row.bounds, name), each.get(key(row), 0.0)) for name, each in stated.items()}
        return replace(row, bounds=replace(row.bounds, **own))

    return tuple(map(widened, rows))
