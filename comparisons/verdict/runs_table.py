"""All runs of a comparison by station: complete stations, and problems of runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from comparisons.verdict.completeness import Where, complete_stations, ends_at_critical, problems, stations_of
from comparisons.verdict.runs import SOLVERS, Runs
from cprbm_scene import Answer, Scene, StationAnswer


@dataclass(frozen=True)
class RunsTable:
    """All runs of a comparison by their names; a CPRBM run's name begins with ``cprbm``."""

    scene: Scene
    runs: Runs

    @cached_property
    def answers(self) -> Mapping[str, Answer]:
        """Answer of every run."""
        return dict(self.runs.everything())

    @property
    def pair(self) -> tuple[Answer, Answer]:
        """The two compared answers."""
        return self.runs.cprbm[0], self.runs.reference

    @cached_property
    def problems(self) -> Mapping[str, tuple[str, ...]]:
        """Problems of every run that is not complete, by name."""
        found = {name: problems(self.scene, answer) for name, answer in self.answers.items()}
        return {name: each for name, each in found.items() if each}

    @cached_property
    def stations(self) -> Mapping[str, Mapping[Where, StationAnswer]]:
        """Complete stations of every run."""
        return {name: complete_stations(self.scene, answer) for name, answer in self.answers.items()}

    @cached_property
    def reached(self) -> tuple[Where, ...]:
        """Stations of both compared runs, in order."""
        both = [self.stations[name] for name in SOLVERS]
        return tuple(where for where in stations_of(self.scene) if all(where in each for each in both))

    def at(self, where: Where) -> dict[str, StationAnswer]:
        """Stations of all runs with this station, by name of the run."""
        return {name: stations[where] for name, stations in self.stations.items() if where in stations}

    @cached_property
    def following(self) -> Mapping[str, Answer]:
        """Runs up to the last station, or up to the critical point at the end of the path."""
        return {name: answer for name, answer in self.answers.items() if answer.completed or ends_at_critical(answer)}


def solver_of(name: str) -> str:
    """``cprbm`` or ``fea`` of a run's name."""
    return name.split(" ", maxsplit=1)[0]
