"""Values of a scene at a family of sizes N: what counts, orders, limits; of probes and of critical points.

All runs are in one beam theory, so that both solvers' limits solve the same equations.  The penetration of the finite
elements falls with N as the error of the elements (:meth:`comparisons.choices.Choices.of_size`).

A size counts for a probe if the run is complete, on the branch of the finest size, and has the contact or stop of the
probe in the state of the finest size.  A size counts for a critical point if the run is complete or ends at a critical
point, and has the critical point by the mechanism of the finest size.  Sizes coarser than a size that does not count do
not count either: a contact that closes between two sizes is no matter of convergence.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from comparisons.choices import Kinematics
from comparisons.quantities import COMPONENTS, OPEN_AT_ZERO, arc_lengths, load_unit, probe_scales, unit_of
from comparisons.stations import Where, ends_at_critical, find_station, last_station, span_of, station_of, stations_of
from comparisons.verdict import (
    OWN,
    ROUND_OFF,
    STANDARD,
    Limit,
    away_from_point_forces,
    limit,
    mechanism,
    observed,
    orders,
)
from cprbm_scene import CRITICAL, STRESSES, Answer, Array, Critical, Probe, Scene, Stage, frozendict

_AS_LARGE = 1e-3  # share of the largest stress within which a stress counts as equal
_BESIDE_A_KINK = 1.5  # elements: the element with the kink, and half of its neighbours

STANDARD_SIZE = 40
"""Size of the tables and of the budget, if the family has it."""

Method = Literal["cprbm", "fea"]
Component = str | float | None
"""Name of a component, of a stress the arc length in m, of a critical point the stage; None of a scalar."""

Trend = tuple[tuple[int, ...], tuple[float | None, ...], Limit | None, str]
"""Sizes that count, orders at every three consecutive of these sizes, the limit, and why limit or order is missing."""


@dataclass(frozen=True, slots=True)
class Series:
    """Answers of a solver at all sizes.

    Attributes:
        method: name of the solver.
        variant: formulation of the CPRBM; beam theory of the finite elements.
        theory: beam theory.
        answers: by N, ascending.
        why: problems of incomplete answers, by N.
    """

    method: Method
    variant: str
    theory: Kinematics
    answers: Mapping[int, Answer]
    why: Mapping[int, str]

    @property
    def settings(self) -> dict[str, object]:
        """Settings that all runs share, and the beam theory."""
        first, *others = (answer.settings for answer in self.answers.values())
        common = {key: value for key, value in first.items() if all(each.get(key) == value for each in others)}
        return {**common, "kinematics": self.theory}

    @property
    def order(self) -> float:
        """Order of the method on smooth states."""
        return STANDARD if self.variant == "paper" else OWN

    @property
    def whole(self) -> dict[int, Answer]:
        """Complete answers."""
        return {n: answer for n, answer in self.answers.items() if n not in self.why}


@dataclass(frozen=True, slots=True)
class Family:
    """Values of a solver at all sizes: of a probe at a station, or of a critical point.

    Attributes:
        solver: name of the solver; settings: of all runs.
        probe: name of the probe, or ``critical``; stage, station: the place, without a station of a critical point.
        unit: SI unit; scale: of the probe in the stage, or span of the stage, in the unit.
        components: of the k values.
        values: (k,) by N.
        floor: round-off, in the unit.
        used, orders, found, why: the trend.
        exact: exact values (k,), in ``bending``; None without these.
        critical: critical points by N; place: number of the critical point in the stage.
    """

    solver: str
    settings: Mapping[str, object]
    probe: str
    stage: str
    station: float | None
    unit: str
    scale: float
    components: tuple[Component, ...]
    values: Mapping[int, Array]
    floor: float
    used: tuple[int, ...]
    orders: tuple[float | None, ...]
    found: Limit | None
    why: str
    exact: Array | None = None
    critical: Mapping[int, Critical] = frozendict()
    place: int = 0

    @property
    def question(self) -> tuple[object, ...]:
        """Key that families of both solvers share."""
        return self.probe, self.stage, self.station, self.place

    def component_order(self, place: int) -> float | None:
        """Order of a component at the three finest sizes that count."""
        if len(self.components) == 1:
            return self.orders[-1] if self.orders else None
        last = self.used[-3:]
        return observed(last, [self.values[n][[place]] for n in last], self.floor)[0] if len(last) == 3 else None

    def error(self, n: int) -> Array | None:
        """Distances (k,) within which the values at N lie from the true limit."""
        known = self.found if n in self.used else None
        return None if known is None else np.asarray(np.abs(self.values[n] - known.value) + known.uncertainty)

    def apart(self, n: int) -> float | None:
        """Norm of the distance of the values at N from the limit."""
        return self._distance(n, None if self.found is None else self.found.value)

    def true_error(self, n: int) -> float | None:
        """Norm of the distance of the values at N from the exact values."""
        return self._distance(n, self.exact)

    def _distance(self, n: int, reference: Array | None) -> float | None:
        return None if reference is None or n not in self.used else size(self.values[n] - reference)


@dataclass(frozen=True, slots=True)
class Convergence:
    """A scene at all sizes.

    Attributes:
        scene: the question; sizes: N, ascending; series: answers of both solvers.
        families: in the order of stages, stations and probes; of the CPRBM, then of the finite elements.
        criticals: families of the critical points.
        exact: the exact answer; None in other theories than ``bending``.
    """

    scene: Scene
    sizes: tuple[int, ...]
    series: tuple[Series, ...]
    families: tuple[Family, ...]
    criticals: tuple[Family, ...]
    exact: Answer | None = None

    @property
    def completed(self) -> bool:
        """True if every answer is complete."""
        return not any(series.why for series in self.series)

    @property
    def shown(self) -> int:
        """Size of the tables: the standard size, or else the middle size."""
        return STANDARD_SIZE if STANDARD_SIZE in self.sizes else self.sizes[(len(self.sizes) - 1) // 2]

    @property
    def last(self) -> tuple[Family, ...]:
        """Families at the last station."""
        where = last_station(self.scene)
        return tuple(family for family in self.families if (family.stage, family.station) == where)


def size(values: Array) -> float:
    """Norm of the values of a family; of a stress there is one."""
    return float(np.linalg.norm(values))


def probe_families(scene: Scene, series: Sequence[Series], exact: Answer | None) -> Iterator[Family]:
    """Families of all probes, in the order of stages, stations and probes, of every series with a complete answer."""
    present = [each for each in series if each.whole]
    if not present:
        return
    sizes = sorted({n for each in present for n in each.whole})
    finest = tuple(each.whole[max(each.whole)] for each in present)
    scales = probe_scales(scene, finest)
    for where in stations_of(scene):
        for probe in scene.probes_in(where[0]):
            places = _places(scene, probe, where, finest, sizes)
            for each in present:
                yield _of_probe(scene, each, probe, where, places, scales[where[0], probe.name], exact)


def _places(scene: Scene, probe: Probe, where: Where, finest: Sequence[Answer], sizes: Sequence[int]) -> slice:
    """The followed place of a stress; all components of another probe.

    The place has the largest stress in the finest answers, of all compared places outside the elements beside a kink of
    the section at the three finest sizes, where the stress shows no order; without such a place, of all places.  Of
    places with equal stress, as along a circle, the place is the first.
    """
    if probe.quantity not in STRESSES:
        return slice(None)
    stations = tuple(station_of(answer, *where) for answer in finest)
    largest = np.max([np.abs(station.values[probe.name]) for station in stations], axis=0)
    distance = np.abs(np.linspace(0.0, 1.0, probe.points)[:, None] - scene.beams[probe.of].knots[1:-1])
    clear = away_from_point_forces(scene, probe.of, arc_lengths(scene, probe), stations)
    clear = clear & np.all(distance > _BESIDE_A_KINK / sizes[-3:][0], axis=1)
    among = np.where(clear, largest, -1.0) if clear.any() else largest
    place = int(np.argmax(among >= (1.0 - _AS_LARGE) * among.max()))
    return slice(place, place + 1)


def _of_probe(
    scene: Scene, series: Series, probe: Probe, where: Where, places: slice, scale: float, exact: Answer | None
) -> Family:
    stations = {n: station_of(answer, *where) for n, answer in series.whole.items()}
    values = {n: station.values[probe.name][places] for n, station in stations.items()}
    last, branch = values[max(values)], stations[max(values)].branch
    is_force = probe.quantity in OPEN_AT_ZERO
    is_open = last.size == 0 or (is_force and not last.any())
    obstacles = {
        n: "another branch is followed"
        if stations[n].branch != branch
        else "the contact is open"
        if own.size == 0 or own.shape != last.shape or (is_force and own.any() != last.any())
        else ""
        for n, own in values.items()
    }
    known = None if exact is None else find_station(exact, *where)
    true = np.empty(0) if known is None else known.values.get(probe.name, np.empty(0))[places]
    floor = ROUND_OFF * scale
    used, shown, found, why = _trend(values, obstacles, series.order, 0.0 if is_open else floor)
    components: tuple[Component, ...] = COMPONENTS.get(probe.quantity, (None,))
    if probe.quantity in STRESSES:
        components = (float(arc_lengths(scene, probe)[places][0]),)
    return Family(
        solver=series.method,
        settings=series.settings,
        probe=probe.name,
        stage=where[0],
        station=where[1],
        unit=unit_of(scene, probe, where[0]),
        scale=scale,
        components=components,
        values=values,
        floor=floor,
        used=used,
        orders=shown,
        found=found,
        why="the contact is open" if is_open else why,
        exact=true if true.size and true.shape == last.shape else None,
    )


def critical_families(scene: Scene, series: Sequence[Series]) -> Iterator[Family]:
    """Families of all critical points, in the order of stages; of every series with such a critical point."""
    for stage in scene.stages:
        every = [
            {
                n: [each for each in answer.critical if each.stage == stage.name]
                for n, answer in one.answers.items()
                if n not in one.why or ends_at_critical(answer)
            }
            for one in series
        ]
        for place in range(max((len(points) for known in every for points in known.values()), default=0)):
            for one, known in zip(series, every, strict=True):
                here = {n: points[place] for n, points in known.items() if len(points) > place}
                if here:
                    yield _of_critical(scene, one, stage, place, here, tuple(known))


def _of_critical(
    scene: Scene, series: Series, stage: Stage, place: int, here: Mapping[int, Critical], sizes: Sequence[int]
) -> Family:
    own = mechanism(here[max(here)])
    obstacles = {n: "" if n in here and mechanism(here[n]) == own else "there is no such critical point" for n in sizes}
    values = {n: np.array([each.value]) for n, each in here.items()}
    floor = max((here[n].uncertainty for n in _last_without(obstacles)), default=0.0)
    used, shown, found, why = _trend(values, obstacles, series.order, floor)
    return Family(
        solver=series.method,
        settings=series.settings,
        probe=CRITICAL,
        stage=stage.name,
        station=None,
        unit=load_unit(scene, stage.name),
        scale=span_of(scene, stage),
        components=(stage.name,),
        values=values,
        floor=floor,
        used=used,
        orders=shown,
        found=found,
        why=why,
        critical=here,
        place=place,
    )


def _last_without(obstacles: Mapping[int, str]) -> tuple[int, ...]:
    """Sizes finer than the last size with an obstacle."""
    sizes = sorted(obstacles)
    return tuple(sizes[max((place + 1 for place, n in enumerate(sizes) if obstacles[n]), default=0) :])


def _trend(values: Mapping[int, Array], obstacles: Mapping[int, str], order: float, floor: float) -> Trend:
    """Trend of values at the sizes behind the last obstacle."""
    used = _last_without(obstacles)
    counting = np.array([values[n] for n in used])
    if len(used) > 1:
        found = limit(used, counting, order, floor)
        return used, orders(used, counting, floor) if len(used) > 2 else (), found, found.why
    last = max((n for n in obstacles if n not in used), default=None)
    return used, (), None, "one size alone counts" if last is None else f"{obstacles[last]} at N = {last}"
