"""The outcome at a point of a sweep: an ending, a verdict and numbers, as plain records that a line of JSON holds."""

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from time import perf_counter
from traceback import extract_tb
from typing import Any, Literal

from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.executor import TimeLimitError, WorkerDiedError, call_limited
from comparisons.pairing import Solvers, paired
from comparisons.present.csv_table import comparison_records, records
from comparisons.verdict import passed_by
from cprbm_scene import Answer, Scene, SceneError

Asked = Literal["cprbm", "fea", "compare"]
"""The solver of a point, or both solvers with a verdict."""

ATTEMPTS = 2
"""Number of solves of a point that crashes or takes too long: an other program on the machine may be the reason."""

NumberRecord = Mapping[str, Any]
"""A number of an outcome: stage, station, branch, probe, component, arc length, unit and values, SI."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """Outcome at a point.

    Attributes:
        solver: of the point.
        ending: name of the solver's ending, or ``REFUSED``, ``FAULT``, ``CRASHED`` or ``TIME_LIMIT``.
        sentence: details of the ending or of the verdict.
        verdict, reason: of a comparison; otherwise empty.
        iterations: sum over all stations.
        seconds: time of the solve.
        limit: time limit of the solve, s.
        numbers: all numbers of the answer; of a comparison a number that the CPRBM did not reach has no value.
    """

    solver: str
    ending: str
    sentence: str
    verdict: str = ""
    reason: str = ""
    iterations: int = 0
    seconds: float = 0.0
    limit: float = 0.0
    numbers: tuple[NumberRecord, ...] = ()

    @property
    def completed(self) -> bool:
        """Whether every station was reached."""
        return self.ending == "COMPLETED"

    @property
    def numbers_with_values(self) -> list[NumberRecord]:
        """Numbers with a value."""
        return [number for number in self.numbers if number["value"] is not None]

    @property
    def branch(self) -> tuple[bool, int]:
        """Whether the answer is complete, and the branch of the last station: joined points have equal branches."""
        return self.completed, self.numbers[-1]["branch"] if self.numbers else -1

    def line(self, key: str) -> str:
        """The outcome with its key as a line of JSON."""
        own = {each.name: getattr(self, each.name) for each in fields(self)}  # asdict would copy all numbers
        return json.dumps({"key": key, **own}, ensure_ascii=False)


def outcome_of(line: str) -> tuple[str, Outcome]:
    """Key and outcome of a line.

    Raises:
        ValueError, KeyError, TypeError: the line is damaged.
    """
    data = json.loads(line)
    return data.pop("key"), Outcome(**{**data, "numbers": tuple(data["numbers"])})


def crashed(asked: Asked, cause: str) -> Outcome:
    """The outcome at a point whose process died."""
    return Outcome(asked, "CRASHED", f"{cause}; the same command tries again")


def solve_limited(scene: Scene, choices: Choices, asked: Asked, solvers: Solvers, seconds: float) -> Outcome:
    """The outcome at a point, solved in the child of this thread; a crash or a time-out is tried again."""
    for attempt in range(1, ATTEMPTS + 1):
        try:
            return call_limited(seconds, solve, scene, choices, asked, solvers)
        except TimeLimitError:
            late = f"{attempt} solves took more than {seconds:g} s; a longer --at-most tries again"
            found = Outcome(asked, "TIME_LIMIT", late, limit=seconds)
        except WorkerDiedError as error:
            found = crashed(asked, f"{attempt} solves crashed: {error}")
    return found


def solve(scene: Scene, choices: Choices, asked: Asked, solvers: Solvers) -> Outcome:
    """The outcome at a point; a refusal and a fault of the program are outcomes too."""
    begun = perf_counter()
    try:
        if asked == "compare":
            return _compared(scene, choices, solvers, begun)
        answer: Answer = getattr(solvers, asked)(scene, choices)
    except SceneError as error:
        return Outcome(asked, "REFUSED", "; ".join(map(str, error.mistakes)))
    except Exception as error:
        place = extract_tb(error.__traceback__)[-1]
        return Outcome(asked, "FAULT", f"{type(error).__name__}: {error} (line {place.lineno} of {place.name})")
    return Outcome(
        asked,
        answer.ending.name,
        "" if answer.completed else answer.sentence,
        iterations=_iterations([answer]),
        seconds=perf_counter() - begun,
        numbers=_kept(records(scene, answer), {"value": "value"}, _passed(scene, answer)),
    )


def _compared(scene: Scene, choices: Choices, solvers: Solvers, begun: float) -> Outcome:
    compared = compare(paired(scene, choices, solvers))
    verdict, pair = compared.verdict, compared.runs.pair
    endings = [answer.ending.name for answer in pair if not answer.completed]
    columns = {"cprbm": "value", "fea": "fea", "difference": "difference", "stated": "stated", "word": "word"}
    return Outcome(
        "compare",
        "COMPLETED" if verdict.completed else next(iter(endings), "NOT_CERTIFIED"),
        verdict.because,
        verdict.word.value,
        "" if verdict.reason is None else verdict.reason.value,
        iterations=_iterations(pair),
        seconds=perf_counter() - begun,
        numbers=_kept(comparison_records(compared), columns, _passed(scene, pair[0])),
    )


def _kept(
    records: Iterable[Mapping[str, Any]], values: Mapping[str, str], passed: Mapping[tuple[str, float], int]
) -> tuple[NumberRecord, ...]:
    """Records with the columns of a sweep, whose branches count ``passed`` points; ``values`` has new by old names."""
    common = ("stage", "station", "station_unit", "branch", "probe", "component", "arc_length", "unit")
    return tuple(
        {name: each[name] for name in common}
        | {"branch": (each["branch"] or 0) + passed[each["stage"], each["station"]]}
        | {new: each[old] for old, new in values.items()}
        for each in records
    )


def _iterations(answers: Iterable[Answer]) -> int:
    return sum(station.certificate.iterations for answer in answers for station in answer.stations)


def _passed(scene: Scene, answer: Answer) -> dict[tuple[str, float], int]:
    """Number of critical points that the answer passed to a state beside, by stage and station."""
    counts, earlier = {}, 0
    for stage in scene.stages:
        for place, value in enumerate(stage.stations):
            counts[stage.name, value] = earlier + passed_by(scene, stage, answer, place)
        earlier += sum(each.end.stage == stage.name for each in answer.gone_over)
    return counts
