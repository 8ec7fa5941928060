"""A scene at a family of sizes N: which runs, and how every probe goes with N.

The runs are those of both solvers in one beam theory, so that both limits are of the same equations.

A penalty leaves an error that is proportional to the penetration, which falls with N as the elements' own error
(:meth:`comparisons.choices.Choices.of_size`): both are parts of one law.

Of a probe at a station a size counts if its run gave a whole answer, is on the branch of the finest size there, and the
contact (or the stop) that the probe speaks of is as closed as at the finest size; of the sizes that do not, the coarser
ones do not count either, since a contact that closes between two sizes is no matter of convergence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from comparisons.choices import Choices, Kinematics
from comparisons.crew import Crew, Job
from comparisons.pairing import Solvers, exact_or_why
from comparisons.quantities import COMPONENTS, OPEN_AT_ZERO, arc_lengths, norm, unit_of
from comparisons.sentences import problem_sentences
from comparisons.stations import station_of
from comparisons.verdict.point_forces import away_from_point_forces
from comparisons.verdict.rows import ROUND_OFF
from comparisons.verdict.scales import probe_scales
from comparisons.verdict.uncertainty import OWN, STANDARD, Limit, limit, observed, orders
from cprbm_scene import Answer, Probe, Scene, Stage
from cprbm_scene.answer import Array
from cprbm_scene.statement import STRESSES

SIZES = (10, 20, 40, 80, 160, 320)
STANDARD_AT = 40
_AS_LARGE = 1e-3  # of the largest stress, by which a place may have less and count as one with it
_BESIDE_A_KINK = 1.5  # elements: the one that holds it, and half of those beside it

Method = Literal["cprbm", "fea"]
Component = str | float | None
"""Of a vector ``x`` or ``y``, of a zone's ends ``first`` or ``last``, of a stress the arc length in m, else None."""


@dataclass(frozen=True, slots=True)
class Series:
    """One solver at all sizes.

    Attributes:
        method: who solved.
        variant: the beam theory; of the CPRBM its formulation.
        theory: the beam theory.
        answers: by N, ascending.
        why: by N, why an answer is not whole.
    """

    method: Method
    variant: str
    theory: Kinematics
    answers: Mapping[int, Answer]
    why: Mapping[int, str]

    @property
    def settings(self) -> dict[str, object]:
        """What all runs have in common, and the beam theory."""
        every = [answer.settings for answer in self.answers.values()]
        common = {key: value for key, value in every[0].items() if all(other.get(key) == value for other in every)}
        return {**common, "kinematics": self.theory}

    @property
    def order(self) -> float:
        """Order of the method on smooth states: of the paper's chain 2."""
        return STANDARD if self.variant == "paper" else OWN

    @property
    def whole(self) -> dict[int, Answer]:
        """The answers that are whole."""
        return {n: answer for n, answer in self.answers.items() if n not in self.why}


@dataclass(frozen=True)
class Family:
    """One probe at one station, solved by one solver at all sizes.

    Attributes:
        series: who solved.
        probe, stage, station, unit: what was asked.
        scale: the probe's in its stage, in its unit.
        components: what each of the k numbers is.
        values: (k,) at each N, NaN where there is none.
        used: the sizes that count.
        floor: what round-off leaves open, in the unit.
        found: the limit, if there are two sizes or more that count.
        why: why there is no limit, or no observed order.
        exact: the exact values (k,), if they are known; in ``bending`` alone.
    """

    series: Series
    probe: Probe
    stage: str
    station: float
    unit: str
    scale: float
    components: tuple[Component, ...]
    values: Mapping[int, Array]
    used: tuple[int, ...]
    floor: float
    found: Limit | None
    why: str
    exact: Array | None

    @cached_property
    def orders(self) -> tuple[float | None, ...]:
        """Observed at every three sizes that count and follow each other, by the norm of the changes."""
        return orders(self.used, self._counting, self.floor) if len(self.used) > 2 else ()

    def component_order(self, place: int) -> float | None:
        """Observed at the three finest sizes by one component alone."""
        if len(self.used) < 3:
            return None
        return observed(self.used[-3:], self._counting[-3:, place], self.floor)[0]

    def error(self, n: int) -> Array | None:
        """How far the values at N may be from the true limit, (k,)."""
        if self.found is None or n not in self.used:
            return None
        return np.asarray(self.found.errors(self.values[n][None, :])[0])

    def apart(self, n: int) -> float | None:
        """Norm of the distance of the values at N from the limit, in the unit."""
        if self.found is None or n not in self.used:
            return None
        return self.size(self.values[n] - self.found.value)

    def true_error(self, n: int) -> float | None:
        """Norm of the distance of the values at N from the exact ones, in the unit."""
        if self.exact is None or n not in self.used:
            return None
        return self.size(self.values[n] - self.exact)

    def size(self, values: Array) -> float:
        """Norm of such values."""
        return norm(self.probe.quantity, values)

    @property
    def _counting(self) -> Array:
        return np.array([self.values[n] for n in self.used])


@dataclass(frozen=True, slots=True)
class Convergence:
    """A scene at all sizes.

    ``families`` stand in the order of stages, stations and probes, and for each the CPRBM's and the finite elements'.
    ``exact_absence`` says why the exact reference covers no station.
    """

    scene: Scene
    sizes: tuple[int, ...]
    series: tuple[Series, ...]
    families: tuple[Family, ...]
    exact_absence: str = ""

    @property
    def completed(self) -> bool:
        """Whether every run gave a whole answer."""
        return not any(series.why for series in self.series)


def converged(
    scene: Scene,
    sizes: Sequence[int],
    choices: Choices,
    solvers: Solvers,
    crew: Crew,
) -> Convergence:
    """Solve a scene at all sizes and see how every probe goes with N.

    Args:
        scene: the question.
        sizes: N, two or more, ascending.
        choices: the formulation and the beam theory; the sizes and the penetration are the family's own.
        solvers: who answers, and who knows the exact answer as far as there is one.
        crew: processes to share the runs.

    Raises:
        SceneError: a solver refuses the question.
    """
    theory = choices.kinematics_of(scene)
    choices = choices.within(theory)
    jobs: dict[tuple[Method, str, int], Job] = {}
    for n in sizes:
        jobs["cprbm", choices.formulation, n] = (solvers.cprbm, scene, choices.of_size(n))
        jobs["fea", theory, n] = (solvers.fea, scene, choices.of_size(n))
    known = [] if solvers.exact is None or theory != "bending" else [(solvers.exact, scene, choices)]
    found = crew.answers([*jobs.values(), *known])
    exact, exact_absence = exact_or_why(found.pop() if known else None)
    answers: dict[tuple[Method, str], dict[int, Answer]] = {}
    for (method, variant, n), answer in zip(jobs, found, strict=True):
        answers.setdefault((method, variant), {})[n] = answer
    series = [Series(*which, theory, own, _complaints(scene, own)) for which, own in answers.items()]
    return Convergence(scene, tuple(sizes), tuple(series), _families(scene, series, exact), exact_absence)


def _complaints(scene: Scene, answers: Mapping[int, Answer]) -> dict[int, str]:
    found = {n: problem_sentences(scene, answer) for n, answer in answers.items()}
    return {n: "; ".join(what) for n, what in found.items() if what}


def _families(scene: Scene, series: Sequence[Series], exact: Answer | None) -> tuple[Family, ...]:
    """Every probe at every station in every series that has a whole answer."""
    present = [one for one in series if one.whole]
    if not present:
        return ()
    sizes = sorted({n for one in present for n in one.whole})
    finest = tuple(one.whole[max(one.whole)] for one in present)
    scales = probe_scales(scene, finest)
    return tuple(
        _family(
            scene,
            one,
            probe,
            stage,
            value,
            places,
            ROUND_OFF * scales[stage.name, probe.name],
            scales[stage.name, probe.name],
            exact,
        )
        for stage in scene.stages
        for value in stage.stations
        for probe in scene.probes_in(stage.name)
        for places in (_places(scene, probe, stage, value, finest, sizes),)
        for one in present
    )


def _places(
    scene: Scene, probe: Probe, stage: Stage, value: float, finest: tuple[Answer, ...], sizes: Sequence[int]
) -> slice:
    """Of a stress the one place at which it is followed, of all else everything.

    The place has the largest stress in the finest answers, of all compared places
    (:mod:`comparisons.verdict.point_forces`) outside the elements beside a kink of the section at the three finest
    sizes, where the stress shows no order; without such a place, of all.  Of places with equal stress, as along a
    circle, it is the first.
    """
    if probe.quantity not in STRESSES:
        return slice(None)
    stations = tuple(station_of(answer, stage.name, value) for answer in finest)
    largest = np.max([np.abs(station.values[probe.name]) for station in stations], axis=0)
    clear = away_from_point_forces(scene, probe.of, arc_lengths(scene, probe), stations)
    kinks = scene.beams[probe.of].knots[1:-1]
    away = np.abs(np.linspace(0.0, 1.0, probe.points)[:, None] - kinks)
    clear = clear & np.all(away > _BESIDE_A_KINK / sizes[-3:][0], axis=1)
    among = np.where(clear, largest, -1.0) if clear.any() else largest
    place = int(np.argmax(among >= (1.0 - _AS_LARGE) * among.max()))
    return slice(place, place + 1)


def _family(
    scene: Scene,
    series: Series,
    probe: Probe,
    stage: Stage,
    value: float,
    places: slice,
    floor: float,
    scale: float,
    exact: Answer | None,
) -> Family:
    stations = {n: station_of(answer, stage.name, value) for n, answer in series.whole.items()}
    values = {n: station.values[probe.name][places] for n, station in stations.items()}
    ns = sorted(values)
    last = values[ns[-1]]
    is_force = probe.quantity in OPEN_AT_ZERO
    branched = [stations[n].branch != stations[ns[-1]].branch for n in ns]
    alike = [
        values[n].shape == last.shape and not (is_force and values[n].any() != last.any()) and not other
        for n, other in zip(ns, branched, strict=True)
    ]
    first = max((place + 1 for place, same in enumerate(alike) if not same), default=0)
    is_open = last.size == 0 or (is_force and not last.any())
    used = () if last.size == 0 else tuple(ns[first:])
    found = None
    if len(used) > 1:
        found = limit(used, np.array([values[n] for n in used]), series.order, 0.0 if is_open else floor)
    why = "" if found is None else found.why
    if is_open:
        why = "the contact is open"
    elif found is None:
        why = "one size alone gave a whole answer"
        if first:
            what = "another branch is followed" if branched[first - 1] else "the contact is open"
            why = f"{what} at N = {ns[first - 1]}"
    return Family(
        series=series,
        probe=probe,
        stage=stage.name,
        station=value,
        unit=unit_of(scene, probe, stage),
        scale=scale,
        components=_components(scene, probe, places),
        values=values,
        used=used,
        floor=floor,
        found=found,
        why=why,
        exact=_exactly(exact, stage, value, probe, places, last),
    )


def _components(scene: Scene, probe: Probe, places: slice) -> tuple[Component, ...]:
    if probe.quantity in STRESSES:
        return (float(arc_lengths(scene, probe)[places][0]),)
    return COMPONENTS.get(probe.quantity, (None,))


def _exactly(
    exact: Answer | None, stage: Stage, value: float, probe: Probe, places: slice, like: Array
) -> Array | None:
    """The exact values at a station; None where there are none of the kind that the solvers found."""
    if exact is None:
        return None
    try:
        found = station_of(exact, stage.name, value).values[probe.name][places]
    except KeyError:  # the station is not covered, or the probe
        return None
    return found if found.size and found.shape == like.shape else None
