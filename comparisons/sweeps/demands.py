"""Demands on a mechanism in a TOML file: a goal and limits, on numbers of probes.

    [goal]
    probe = "contact.force"
    aim = "maximise"            # or "minimise", or "reach" with a value

    [[limits]]
    probe = "beam1.bending_stress"
    most = 30.0
    at = "every"                # of the stage's stations; otherwise the last station

All numbers have the units of the scene's file.  Of a stress along a beam the largest magnitude counts.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import inf, isfinite, isinf
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from comparisons.formats import file_unit, joined, with_symbols
from comparisons.quantities import COMPONENTS, unit_of
from comparisons.sweeps.outcome import NumberRecord, Outcome
from cprbm_scene import Mistake, Scene, SceneError
from cprbm_scene.fields import Reading, Record
from cprbm_scene.mistakes import broken, first_of, mistakes_of
from cprbm_scene.reading import toml_data


class _Asked(Record):
    """Number of a probe.

    ``component`` belongs to a probe with two components, ``stage`` is the last stage of the probe unless stated, and
    ``at`` selects the last or every station of the stage.
    """

    probe: str
    component: str = ""
    stage: str = ""
    at: Literal["last", "every"] = "last"


class Goal(_Asked):
    """Number of a probe to minimise, to maximise or to bring to a ``value``."""

    aim: Literal["minimise", "maximise", "reach"] = "minimise"
    value: float | None = None

    def rules(self) -> Iterator[Mistake]:
        """The value belongs to the aim ``reach``."""
        if (self.value is None) == (self.aim == "reach"):
            yield Mistake("value", str(self.value), "a value with aim = 'reach' only")


class Limit(_Asked):
    """The ``least`` and the ``most`` of a number of a probe."""

    least: float = -inf
    most: float = inf

    def rules(self) -> Iterator[Mistake]:
        """A limit has a bound, and values between its bounds."""
        yield from broken(
            isinf(self.least) and isinf(self.most) and Mistake("", "neither least nor most", "least, most, or both"),
            self.least > self.most and Mistake("least", f"{self.least:g}", f"a number of at most {self.most:g}, most"),
        )


class Demands(Record):
    """Content of a file of demands."""

    goal: Goal | None = None
    limits: tuple[Limit, ...] = ()


@dataclass(frozen=True, slots=True)
class Measure:
    """A number of an outcome.

    Attributes:
        stage, probe, component: of the number.
        every: whether every station counts, or the last alone.
        stations: number of stations of the stage.
        size, unit: unit in the scene's file, and its size in SI.
    """

    stage: str
    probe: str
    component: str
    every: bool
    stations: int
    size: float
    unit: str

    @property
    def name(self) -> str:
        """Probe and component."""
        return ".".join(filter(None, (self.probe, self.component)))

    def __str__(self) -> str:
        return f"{self.stage} {self.name}"

    def numbers(self, outcome: Outcome) -> list[NumberRecord]:
        """Numbers station by station, SI; of values along a beam the largest magnitude."""
        mine = [
            each if each["arc_length"] is None else {**each, "value": abs(each["value"])}
            for each in outcome.numbers_with_values
            if (each["stage"], each["probe"], each["component"]) == (self.stage, self.probe, self.component)
        ]
        largest = {each["station"]: each for each in sorted(mine, key=lambda each: each["value"])}
        return [largest[station] for station in dict.fromkeys(each["station"] for each in mine)]

    def last(self, outcome: Outcome) -> NumberRecord | None:
        """Number at the last reached station of the stage, SI; None without a number there."""
        reached = {number["stage"]: number["station"] for number in outcome.numbers_with_values}.get(self.stage)
        return next((number for number in self.numbers(outcome) if number["station"] == reached), None)

    def values(self, outcome: Outcome) -> list[float]:
        """Values at the stations in the unit of the file; none where a station of the stage has no value."""
        values = [number["value"] / self.size for number in self.numbers(outcome)]
        return [] if len(values) < self.stations else values if self.every else values[-1:]

    def text(self, value: float) -> str:
        """A value with its unit."""
        return joined(f"{value:.6g}", with_symbols(self.unit))


@dataclass(frozen=True, slots=True)
class Bound:
    """A limit of a scene: a measure, and the least and the most."""

    measure: Measure
    least: float
    most: float

    def excess(self, outcome: Outcome) -> float:
        """Largest distance beyond the limit over the scale, negative within the limit; infinite without a value.

        The scale is the largest magnitude of the finite ends, 1 without such a magnitude.
        """
        values = self.measure.values(outcome) if outcome.completed else []
        scale = max(abs(end) for end in (self.least, self.most) if isfinite(end)) or 1.0
        return max((max(self.least - each, each - self.most) / scale for each in values), default=inf)

    def __str__(self) -> str:
        parts = [f"at least {self.measure.text(self.least)}"] if self.least > -inf else []
        parts += [f"at most {self.measure.text(self.most)}"] if self.most < inf else []
        return f"{self.measure} {' and '.join(parts)}"


def meets(outcome: Outcome, bounds: Sequence[Bound]) -> bool:
    """Whether a complete outcome is within all ``bounds``."""
    return outcome.completed and all(bound.excess(outcome) <= 0.0 for bound in bounds)


def read_demands(path: Path) -> Demands:
    """The demands in a file.

    Raises:
        SceneError: the file cannot be read, or a key or a value is wrong.
    """
    data = toml_data(path)
    if isinstance(data.get("limits"), list):
        data["limits"] = tuple(data["limits"])
    try:
        return Demands.model_validate(data, context=Reading())  # the rules hold for what is read
    except ValidationError as error:
        raise SceneError(first_of(mistakes_of(error), str(path))) from None


def bounds_of(scene: Scene, demands: Demands, file: str) -> tuple[Bound, ...]:
    """Limits of a scene.

    Raises:
        SceneError: the scene has no such number.
    """
    return tuple(
        Bound(measure_of(scene, limit, f"limits[{place}]", file), limit.least, limit.most)
        for place, limit in enumerate(demands.limits)
    )


def measure_of(scene: Scene, wanted: _Asked, key: str, file: str) -> Measure:
    """The number of a goal or of a limit in a ``file``.

    Raises:
        SceneError: the scene has no such number.
    """

    def see(part: str, found: str, allowed: Iterable[str]) -> None:
        names = list(dict.fromkeys(allowed))
        if found not in names:
            listed = ", ".join(repr(name) if name else "no value" for name in names)
            raise SceneError([Mistake(f"{key}.{part}", repr(found), listed, file)])

    found = [each for each in measures(scene, every=wanted.at == "every") if each.probe == wanted.probe]
    see("probe", wanted.probe, (each.name for each in scene.probes))
    see("component", wanted.component, (each.component for each in found))
    see("stage", wanted.stage or found[-1].stage, (each.stage for each in found))
    return next(
        each for each in reversed(found) if each.component == wanted.component and wanted.stage in ("", each.stage)
    )


def measures(scene: Scene, *, every: bool = False) -> tuple[Measure, ...]:
    """All numbers of the last, or of ``every``, station of all stages."""
    return tuple(
        Measure(
            stage.name,
            probe.name,
            component,
            every,
            len(set(stage.stations)),
            *file_unit(scene, unit_of(scene, probe, stage.name)),
        )
        for stage in scene.stages
        for probe in scene.probes_in(stage.name)
        for component in COMPONENTS.get(probe.quantity, ("",))
    )
