"""Two answers beside each other: for every probe, stage and station the differences and what bounds them.

==========  ===========================================================================================
symbol      meaning
==========  ===========================================================================================
v_c, V_c    the CPRBM's value at N and at 2N links
v_a         at N links in the formulation ``auto``, where that was not chosen anyway; V_c is always in ``auto``
v_f, V_f    the finite elements' value at n and at 2n elements (with a 16th of the penetration), in the
            chosen theory
v_b, V_b    the same in the theory ``bending``, the CPRBM's own
v_s         at n in the theory ``stretch``
w           the CPRBM's value at N + N/7 links, where there is contact or a section has a kink
w_f         the finite elements' at n + n/7 elements in the chosen theory, where there is contact
d           v_c − v_f, the difference
u           stated uncertainty of a solver at N (or n) by :mod:`comparisons.uncertainty`, the largest over the
            stations of the stage on the branch
r           round-off allowance
x           the exact value in ``bending``, where one is known
q           what an exact value may itself be off by
==========  ===========================================================================================

The grids are N, N + N/7 and 2N links, likewise elements.  In ``bending`` the finite elements have two grids.  Both
theories are solved on the same meshes, and contact falls between the same nodes: the uneven part of u_f counts in u_b
as well.  At a station alone this part keeps u_b from vanishing where v_b − V_b passes through zero.

A force within a finite element bends it there otherwise than its cubic, which is off by F u³v³/(3 EI h³) and in its
slope by F u²v²(v − u)/(2 EI h³), with u + v = h: nothing where the place falls on a node, the most half-way and at a
quarter.  With shear the slope jumps there besides.

The formulation ``paper`` holds joints apart and not what lies between them, so that its error depends on where
a contact falls between joints and no two N tell it.  There u_c = |v_c − v_a| + u_a: its distance from the formulation
whose error is even in N, and the uncertainty of this.

The theory term is |v_b − v_f|, computed and never typed in.  Where both solvers are as good as they state,
|v_c − v_f| ≤ |v_c − v_b| + |v_b − v_f| ≤ u_c + u_b + |v_b − v_f|: u_f is therefore never taken for less than u_b.
The difference is the sum of its steps,

    v_c − v_f = (v_c − v_a) + (v_a − v_b) + (v_b − v_s) + (v_s − v_f),

and the share of each in it is its component along d.  In ``auto`` v_a is v_c.  What the contact's formulation
makes of the answer is |v_p − v_a| with v_p the value in ``paper``, whichever of the two was chosen.

Where x is known, |v_c − x| and |v_b − x| are true errors, each to be held against u_c + r or u_b + r.  An exact
answer is itself found by integration and a search for a root: q is what its certificate leaves open, and at least
1e-9 of the probe's scale, ten times what such an answer is good to.

Round-off: a certificate states the relative residual that is left and the floor below which none can be
asked.
The larger of the two, times the largest value of the probe's family at that station, is a force (or what a
force does) that the solver has left open.  It hardly depends on the load, so the largest over all stations
counts at each.  Where a contact presses is no force: at a load that nearly vanishes a residual of any share of it
may move the place along the whole beam, and says nothing of other stations. Of places each station's own counts.
It is at least 1e-12 of the family's natural scale, for what round-off does to the numbers
themselves, and ten times the share by which certificates say that joints and loops are open: levers make
more of a gap.  A contact that is open in every run has no force, and nothing is left open there.

Of contacts that press a beam at one place the sum of their forces is measured in place of each
(:mod:`comparisons.shared`).  Of one that presses within an element of its beam's joint the sum of both is measured as
well (:mod:`comparisons.beside`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from comparisons.beside import joint_beside
from comparisons.branches import MEASURED, Place, Spot, spots_of
from comparisons.choices import KINEMATICS
from comparisons.geometry import length
from comparisons.hardly_open import hardly_open
from comparisons.pairing import Runs
from comparisons.scales import denominator, family_size, natural_scale, norm, probe_scale
from comparisons.shared import resultant, sharing
from comparisons.spots import clear_of_spots
from comparisons.stations import station_of
from comparisons.uncertainty import Error, error, largest
from cprbm_scene import Answer, Probe, Scene, Stage, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import STRESSES, Quantity

LEVERS = 10.0
"""What a mechanism makes of a gap in one of its joints at the most, in multiples of it."""

ROUND_OFF = 1e-12
EXACT_TO = 1e-9
"""Share of a probe's scale below which a distance from the exact value says nothing."""

BESIDE_JOINTS: frozenset[Quantity] = frozenset({"force", "centre", "ends"})
"""What of a contact elements do not resolve that are longer than its way to a joint."""

OPEN_AT_ZERO: frozenset[Quantity] = frozenset({"force", "moment"})
"""Quantities that are exactly zero while a contact is open, or no limit of a stop is reached."""

PLACES: frozenset[Quantity] = frozenset({"centre", "ends"})
"""Quantities whose family does not vanish with the load."""

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
"""Names of a quantity's numbers, where it has several that are not along a beam."""

LOAD_UNITS = {
    "moment": "N·m",
    "force": "N",
    "beam_force": "N",
    "beam_moment": "N·m",
    "distributed": "N/m",
    "displacement": "m",
    "rotation": "rad",
}


@dataclass(frozen=True, slots=True)
class Bounds:
    """What may lie between the two values of a row; all in the probe's unit, none negative.

    Attributes:
        cprbm: the CPRBM's own uncertainty.
        fea: the finite elements' own, the larger of those in the chosen theory and in ``bending``.
        bending: the finite elements' own, in the theory ``bending``.
        theory: between the theory ``bending`` and the chosen one.
        round_off: what the certificates leave unsettled.
    """

    cprbm: float
    fea: float
    bending: float
    theory: float
    round_off: float

    @property
    def total(self) -> float:
        """What may lie between the two solvers."""
        return self.cprbm + self.fea + self.theory + self.round_off

    @property
    def same_theory(self) -> float:
        """What may lie between the two solvers within the theory ``bending``."""
        return self.cprbm + self.bending + self.round_off


@dataclass(frozen=True, slots=True)
class TrueErrors:
    """How far two values of a row are from the exact one, in the probe's unit, none negative.

    Attributes:
        cprbm: |v_c − x|.
        bending: |v_b − x|, of the finite elements in the theory ``bending``.
        allowance: q.
    """

    cprbm: float
    bending: float
    allowance: float


@dataclass(frozen=True, slots=True)
class Steps:
    """The difference as a sum of steps, each its component along the difference, in the probe's unit.

    ``contact`` leads from the formulation ``paper`` to ``auto`` and is 0 if that was chosen; ``own`` from there to
    the finite elements in ``bending``; ``stretch`` and ``shear`` to each further theory.
    """

    contact: float
    own: float
    stretch: float
    shear: float


@dataclass(frozen=True, slots=True)
class Row:
    """One probe at one station.

    ``cprbm`` and ``fea`` are the values, (k,) in ``unit``.  ``bounds`` is absent where a value is (an open
    contact has no centre), and then nothing is measured.  ``scale`` is the probe's in this stage,
    ``denominator`` what the shown fractions are divided by.  ``contact_model`` is the distance of the CPRBM's
    values in the formulations ``paper`` and ``auto``, absent where one of them is.  For a stress, ``arc_length`` (k,)
    says where, m; ``largest`` is the difference of the largest magnitudes, and the places next to the beam's held
    ends and to where contacts end take no part in ``difference``, nor in ``true_errors``.  ``exact`` (k,) is x,
    absent where none is known and empty where the contact is then open; ``true_errors`` is absent where ``bounds`` or
    ``exact`` is, and where x is not of the two values' shape.

    ``shared`` are the other contacts with which one presses its beam at one place (:mod:`comparisons.shared`); of its
    force ``difference``, ``same_theory`` and ``bounds`` are then those of the resultant of all of them,
    ``together`` (1,) the CPRBM's and the finite elements', absent where some answer does not say what acts.

    ``beside`` is the same row where some answer has the contact press within an element of a joint
    (:mod:`comparisons.beside`), which it then names as ``shared``: of a force measured by the sum of both.

    ``hardly_open`` are contacts that press in some answer, and that all of one solver's leave open by less than these
    tell (:mod:`comparisons.hardly_open`): what they do no ``bounds`` hold.

    ``branch`` is the number of the branch that all answers are on at the station, None where there is no such one, and
    ``place`` what that makes of it (:mod:`comparisons.branches`).  Only where it is compared there are ``bounds``; near
    a critical value there are differences alone, and elsewhere the values.
    """

    probe: Probe
    stage: str
    station: float
    unit: str
    cprbm: Array
    fea: Array
    scale: float
    denominator: float
    difference: float = math.nan
    same_theory: float = math.nan
    bounds: Bounds | None = None
    steps: Steps | None = None
    arc_length: Array | None = None
    largest: float | None = None
    contact_model: float | None = None
    exact: Array | None = None
    true_errors: TrueErrors | None = None
    place: Place = Place.COMPARED
    branch: int | None = 0
    shared: frozenset[str] = frozenset()
    together: tuple[Array, Array] | None = None
    beside: Row | None = None
    hardly_open: frozenset[str] = frozenset()

    def fraction(self, value: float) -> float | None:
        """``value`` as a fraction of the denominator; None where that says nothing."""
        if not math.isfinite(value):
            return None
        if self.denominator > 0.0:
            return value / self.denominator
        return 0.0 if value == 0.0 else None


def rows_of(scene: Scene, runs: Runs) -> tuple[Row, ...]:
    """All rows of a comparison, in the order of stages, stations and probes.

    Every answer must be complete, as :func:`comparisons.soundness.complaints` finds.

    Raises:
        KeyError: an answer lacks a station or a probe.
    """
    everyone = dict(runs.everything())
    compared = (runs.cprbm[0], runs.reference)
    scales = probe_scales(scene, compared)
    unsettled = {probe.name: round_offs(scene, probe, tuple(everyone.values()), compared) for probe in scene.probes}
    stages = {stage.name: stage for stage in scene.stages}
    one_place = sharing(scene, everyone.values())
    unsure = hardly_open(scene, runs)
    return _with_largest(
        tuple(
            _row(
                scene,
                runs,
                probe,
                stages[spot.stage],
                spot,
                unsettled[probe.name][spot.stage, spot.value],
                scales[spot.stage, probe.name],
                one_place.get((spot.stage, spot.value), {}),
                unsure.get((spot.stage, spot.value), frozenset()),
            )
            for spot in spots_of(scene, everyone, compared)
            for probe in scene.probes
        )
    )


def probe_scales(scene: Scene, answers: tuple[Answer, ...]) -> dict[tuple[str, str], float]:
    """By stage and probe the probe's scale in the stage, in its unit."""
    return {
        (stage.name, probe.name): probe_scale(scene, probe, stage, answers)
        for stage in scene.stages
        for probe in scene.probes
    }


def round_offs(
    scene: Scene, probe: Probe, everyone: tuple[Answer, ...], compared: tuple[Answer, ...]
) -> dict[tuple[str, float], float]:
    """What the certificates leave unsettled of a probe, in its unit, by stage and station.

    Args:
        scene: the question.
        probe: the probe.
        everyone: the answers whose certificates count.
        compared: the answers of whose values a share is left unsettled.

    Raises:
        KeyError: an answer lacks a station.
    """
    own = {}
    for stage in scene.stages:
        natural = natural_scale(scene, probe.quantity, stage, contact=probe.of)
        for value in stage.stations:
            stations = [station_of(answer, stage.name, value) for answer in everyone]
            floor = max(max(s.certificate.residual, s.certificate.residual_floor) for s in stations)
            apart = max(ROUND_OFF, *(LEVERS * s.certificate.violation for s in stations))
            size = _family_size(scene, probe, stage, value, compared)
            own[stage.name, value] = max(apart * natural, floor * size)
    if probe.quantity in PLACES:
        return own
    return dict.fromkeys(own, max(own.values(), default=0.0))


def _family_size(scene: Scene, probe: Probe, stage: Stage, value: float, answers: tuple[Answer, ...]) -> float:
    """The largest value in a probe's family at one station of some answers."""
    here = stage.model_copy(update={"stations": (value,)})
    alone = tuple(replace(answer, stations=(station_of(answer, stage.name, value),)) for answer in answers)
    return family_size(scene, probe.quantity, here, alone, contact=probe.of)


def bare_row(
    scene: Scene, compared: tuple[Answer, Answer], probe: Probe, stage: Stage, value: float, scale: float
) -> Row:
    """The values of the CPRBM and of the finite elements that are compared, and no difference yet.

    Args:
        scene: the question.
        compared: the CPRBM's answer and the finite elements'.
        probe: the probe.
        stage: the stage.
        value: the station.
        scale: the probe's in the stage, :func:`probe_scales`.

    Raises:
        KeyError: an answer lacks the station or the probe.
    """
    v_c, v_f = (station_of(answer, stage.name, value).values[probe.name] for answer in compared)
    return Row(
        probe=probe,
        stage=stage.name,
        station=value,
        unit=unit_of(scene, probe, stage),
        cprbm=v_c,
        fea=v_f,
        scale=scale,
        denominator=denominator(probe, v_f, scale),
        arc_length=arc_lengths(scene, probe) if probe.quantity in STRESSES else None,
    )


def _row(
    scene: Scene,
    runs: Runs,
    probe: Probe,
    stage: Stage,
    spot: Spot,
    unsettled: float,
    scale: float,
    one_place: Mapping[str, frozenset[str]],
    unsure: frozenset[str],
) -> Row:
    compared = (runs.cprbm[0], runs.reference)
    value = spot.value
    stations = {name: station_of(answer, stage.name, value) for name, answer in runs.everything()}
    values = {name: station.values[probe.name] for name, station in stations.items()}
    chosen = f"fea {runs.kinematics}"
    shared = one_place.get(probe.of, frozenset()) if probe.quantity == "force" else frozenset[str]()
    v_c, v_f, v_b = values["cprbm"], values[chosen], values["fea bending"]
    is_stress = probe.quantity in STRESSES
    exact = _exact_station(runs, stage.name, spot)
    row = bare_row(scene, compared, probe, stage, value, scale)
    row = replace(row, place=spot.place, branch=spot.branch, hardly_open=unsure)
    if spot.branch is None:
        return row
    if shared:
        return _of_resultants(scene, runs, replace(row, shared=shared), stations, unsettled)
    joint = joint_beside(scene, stations.values(), probe.of) if probe.quantity in BESIDE_JOINTS else None
    if joint is not None:
        beside = replace(row, shared=frozenset({joint}))
        if probe.quantity == "force":
            beside = _of_resultants(scene, runs, beside, stations, unsettled)
        row = replace(row, beside=beside)
    row = replace(
        row,
        largest=abs(norm(probe.quantity, v_c) - norm(probe.quantity, v_f)) if is_stress else None,
        exact=None if exact is None else exact.values[probe.name],
    )
    if v_f.size == 0 or any(other.shape != v_f.shape for other in values.values()):
        return row
    counts = np.ones(v_f.shape, dtype=bool)
    if row.arc_length is not None:
        counts = clear_of_spots(scene, probe.of, row.arc_length, tuple(stations.values()))
        if not counts.any():
            return row
    values = {name: found[counts] for name, found in values.items()}
    v_c, v_f, v_b = values["cprbm"], values[chosen], values["fea bending"]

    def size(difference: Array) -> float:
        return norm(probe.quantity, difference)

    row = replace(row, difference=size(v_c - v_f), same_theory=size(v_c - v_b))
    if spot.place not in MEASURED:
        return row
    open_everywhere = probe.quantity in OPEN_AT_ZERO and not any(found.any() for found in values.values())
    where = stage.name, value, probe.name
    known = {name: found[where].of(counts) for name, found in runs.settled.items() if where in found}
    bounds = bounds_of(runs, values, size, 0.0 if open_everywhere else unsettled, known)
    ladder = [v_c, values.get("cprbm auto", v_c), *(values[f"fea {kinematics}"] for kinematics in runs.fea)]
    formulations = _formulations(runs, probe, stage.name, spot)
    true_errors = None
    if exact is not None and row.exact is not None and row.exact.shape == counts.shape:
        open_end = max(exact.certificate.residual, exact.certificate.residual_floor)
        true_errors = TrueErrors(
            cprbm=size(v_c - row.exact[counts]),
            bending=size(v_b - row.exact[counts]),
            allowance=max(open_end * _family_size(scene, probe, stage, value, compared), EXACT_TO * row.scale),
        )
    return replace(
        row,
        bounds=bounds,
        steps=_steps(probe.quantity, ladder) if _whole_ladder(runs) else None,
        contact_model=None if formulations is None else size((formulations[0] - formulations[1])[counts]),
        true_errors=true_errors,
    )


def _of_resultants(scene: Scene, runs: Runs, row: Row, stations: Mapping[str, StationAnswer], unsettled: float) -> Row:
    """The bare ``row`` of the force of a contact that presses at one place with those that it names as ``shared``, or
    beside a joint, measured by what they do together in all runs' ``stations``.
    """
    probe = row.probe
    beam = scene.contacts[probe.of].beams[0]
    found = {name: resultant(station, row.shared | {probe.of}, beam) for name, station in stations.items()}
    values = {name: value for name, value in found.items() if value is not None}
    if len(values) < len(found):
        return row
    v_c, v_f, v_b = values["cprbm"], values[f"fea {runs.kinematics}"], values["fea bending"]

    def size(difference: Array) -> float:
        return norm(probe.quantity, difference)

    row = replace(row, difference=size(v_c - v_f), same_theory=size(v_c - v_b), together=(v_c, v_f))
    if row.place not in MEASURED:
        return row
    return replace(row, bounds=bounds_of(runs, values, size, unsettled))


def bounds_of(
    runs: Runs,
    values: Mapping[str, Array],
    size: Callable[[Array], float],
    allowance: float,
    known: Mapping[str, Error] = frozendict(),
) -> Bounds:
    """Bounds of a row from the values of all runs.

    Args:
        runs: the runs.
        values: (k,) by the name of the run, as :meth:`comparisons.pairing.Runs.everything` names them.
        size: norm of a difference (k,).
        allowance: r.
        known: stated uncertainty of the values of settled runs, by their names.
    """
    chosen = f"fea {runs.kinematics}"
    v_c, v_f, v_b = values["cprbm"], values[chosen], values["fea bending"]
    even = values.get("cprbm auto", v_c)
    of_cprbm = known.get("cprbm") or _error(even, values, "cprbm", runs.ratio)
    of_fea = known.get(chosen) or _error(v_f, values, chosen, runs.fea_ratio)
    of_bending = known.get("fea bending") or _error(v_b, values, "fea bending", runs.fea_ratio)
    bending = size(of_bending.even) + max(size(of_bending.uneven), size(of_fea.uneven))
    return Bounds(
        cprbm=size(v_c - even) + size(of_cprbm.even) + size(of_cprbm.uneven),
        fea=max(size(of_fea.even) + size(of_fea.uneven), bending),
        bending=bending,
        theory=size(v_b - v_f),
        round_off=allowance,
    )


def _error(v: Array, values: Mapping[str, Array], name: str, ratio: float) -> Error:
    """Stated uncertainty of the values v (k,) at N of the runs of a ``name``."""
    grids = [(1.0, v), (2.0, values[f"{name} finer"])]
    if f"{name} beside" in values:
        grids.insert(1, (1.0 / ratio, values[f"{name} beside"]))
    sizes, found = zip(*grids, strict=True)
    return error(sizes, found)


def _exact_station(runs: Runs, stage: str, spot: Spot) -> StationAnswer | None:
    """The exact answer's station; None where it has none, or one of another branch."""
    if runs.exact is None:
        return None
    try:
        found = station_of(runs.exact, stage, spot.value)
    except KeyError:
        return None
    return found if found.branch == spot.branch else None


def _with_largest(rows: tuple[Row, ...]) -> tuple[Row, ...]:
    """The rows with one uncertainty per solver, probe, stage and branch: the largest over the compared stations.

    Beside an end of a branch the uncertainty grows with the square root of the distance and counts at its station.
    A contact that is open in every run has no force and no uncertainty.
    """
    compared = [row for row in rows if row.bounds is not None and row.place is Place.COMPARED]
    stated = {
        name: largest((_statement(row), getattr(row.bounds, name)) for row in compared)
        for name in ("cprbm", "fea", "bending")
    }

    def widened(row: Row) -> Row:
        if row.bounds is None or row.bounds.total == 0.0:
            return row
        own = {name: max(getattr(row.bounds, name), every.get(_statement(row), 0.0)) for name, every in stated.items()}
        return replace(row, bounds=replace(row.bounds, **own))

    return tuple(map(widened, rows))


def _statement(row: Row) -> tuple[str, str, int | None]:
    """Probe, stage and branch of a row, which have one uncertainty."""
    return row.probe.name, row.stage, row.branch


def _formulations(runs: Runs, probe: Probe, stage: str, spot: Spot) -> tuple[Array, Array] | None:
    """A probe's values in ``paper`` and in ``auto``; None where one of them is missing or on another branch."""
    if runs.formulations is None:
        return None
    try:
        stations = [station_of(answer, stage, spot.value) for answer in runs.formulations]
    except KeyError:  # it ended before
        return None
    paper, auto = (station.values[probe.name] for station in stations)
    alike = paper.shape == auto.shape and all(station.branch == spot.branch for station in stations)
    return (paper, auto) if alike else None


def unit_of(scene: Scene, probe: Probe, stage: Stage) -> str:
    """The SI unit of a probe's values in a stage."""
    return load_unit(scene, stage) if probe.quantity == "closing_load" else UNITS[probe.quantity]


def load_unit(scene: Scene, stage: Stage) -> str:
    """The SI unit of the load or drive that a stage steps."""
    return LOAD_UNITS[scene.stepped(stage).kind]


def arc_lengths(scene: Scene, probe: Probe) -> Array:
    """Arc lengths (k,), m, of the places at which a beam's stress is asked."""
    return np.linspace(0.0, length(scene.beams[probe.of].curve), probe.points)


def direction(quantity: Quantity, way: Array) -> Array:
    """The unit vector (k,) along ``way`` (k,), zero where that is.

    Of a stress, whose norm is its largest magnitude, it points along the component where that stands.
    """
    if not way.any():
        return np.zeros_like(way)
    if quantity in STRESSES:
        along = np.zeros_like(way)
        worst = int(np.argmax(np.abs(way)))
        along[worst] = np.sign(way[worst])
        return along
    return np.asarray(way / np.linalg.norm(way))


def components(ladder: Sequence[Array], along: Array) -> tuple[float, ...]:
    """Each step down a ladder of values (k,), its component along the unit vector ``along`` (k,)."""
    return tuple(float(np.dot(a - b, along)) for a, b in pairwise(ladder))


def _whole_ladder(runs: Runs) -> bool:
    """Whether no theory between ``bending`` and the chosen one was left out."""
    return len(runs.fea) == KINEMATICS.index(runs.kinematics) + 1


def _steps(quantity: Quantity, ladder: list[Array]) -> Steps | None:
    """Each step from the CPRBM to ``auto``, bending, stretch and shear, along the whole way; None if that is zero."""
    d = ladder[0] - ladder[-1]
    if not d.any():
        return None
    steps = components(ladder, direction(quantity, d))
    return Steps(*steps, *(0.0,) * (4 - len(steps)))
