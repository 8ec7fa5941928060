"""All answers to one scene in a comparison: by their parts in the verdict, by station, and their stated uncertainties.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM at N links; v_a in the formulation ``auto``, where ``paper`` is compared
v_f     value of the finite elements at n elements
u_c     |v_c − v_a| + u(v_a)
u_f     u(v_f)
r       round-off
======  ==========================================================================================

u is the uncertainty of :mod:`comparisons.verdict.uncertainty` on the grids N, N + N/7 and 2N.  All runs have one beam
theory.  Two right solvers therefore have

    |v_c − v_f| ≤ u_c + u_f + r.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

from comparisons.choices import Kinematics
from comparisons.stations import Where, complete_stations, ends_at_critical, problems, stations_of
from comparisons.verdict.uncertainty import Error, error
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict

Solver = Literal["cprbm", "fea"]
SOLVERS: tuple[Solver, ...] = ("cprbm", "fea")
"""The solvers, and the names of the two compared runs."""

Uncertainties: TypeAlias = Mapping[tuple[str, float, str], Error]
"""Stated uncertainties by stage, station and probe."""


@dataclass(frozen=True, slots=True)
class Bounds:
    """Stated uncertainties of a row in the probe's unit, none negative: u_c, u_f and r."""

    cprbm: float
    fea: float
    round_off: float

    @property
    def total(self) -> float:
        """Stated uncertainty of the difference between the solvers."""
        return self.cprbm + self.fea + self.round_off


@dataclass(frozen=True, slots=True)
class Runs:
    """All answers to one scene in a comparison; a failed run is a failed answer.

    Attributes:
        theory: beam theory of the comparison.
        cprbm: the CPRBM at N and 2N links, at 2N always in the formulation ``auto``; at N alone where the answers at N
            and n have nothing in common.
        fea: the finite elements at n and 2n elements; at n alone likewise.
        auto: the CPRBM at N links in ``auto``, if another formulation is chosen.
        paper: the CPRBM at N links in ``paper`` and in ``bending``, beside ``auto``; no part of the verdict.
        beside: the CPRBM in ``auto`` at N + N/7 links.
        ratio: N over N + N/7.
        fea_beside: the finite elements at n + n/7.
        fea_ratio: n over n + n/7.
        other: the CPRBM at N links in ``auto`` in :attr:`other_theory`; None without this run.
        other_absence: why the CPRBM refuses the other theory; empty otherwise.
        perturbed: the CPRBM at N links at :func:`comparisons.reactions.perturbed_scene`; no part of the verdict.
        exact: the exact answer at the covered stations; None without any, and outside ``bending``.
        exact_absence: why the exact reference covers no station; empty if the reference was not asked.
        solid: the solid at n and 2n elements, or on the meshes of a tolerance, from coarse to fine; no part of the
            verdict.
        settled: stated uncertainties by stage, station and probe, by name of a run with extrapolated values or further
            grids.
    """

    theory: Kinematics
    cprbm: tuple[Answer, ...]
    fea: tuple[Answer, ...]
    auto: Answer | None = None
    paper: Answer | None = None
    beside: Answer | None = None
    ratio: float = 1.0
    fea_beside: Answer | None = None
    fea_ratio: float = 1.0
    other: Answer | None = None
    other_absence: str = ""
    perturbed: Answer | None = None
    exact: Answer | None = None
    exact_absence: str = ""
    solid: tuple[Answer, ...] | None = None
    settled: Mapping[str, Uncertainties] = frozendict()

    @property
    def reference(self) -> Answer:
        """The finite elements' answer at n elements."""
        return self.fea[0]

    @property
    def other_theory(self) -> Kinematics:
        """``bending``, the paper's theory; ``shear`` where the comparison is in ``bending``."""
        return other_theory(self.theory)

    @property
    def formulations(self) -> tuple[Answer, Answer] | None:
        """The CPRBM at N links in ``paper`` and in ``auto``, in one theory; None without both runs."""
        if self.auto is not None:
            return self.cprbm[0], self.auto
        even = self.cprbm[0] if self.theory == "bending" else self.other
        return None if self.paper is None or even is None else (self.paper, even)

    def everything(self) -> Iterator[tuple[str, Answer]]:
        """Names and answers of all runs in the theory of the comparison."""
        for name, answers in (("cprbm", self.cprbm), ("fea", self.fea)):
            for level, answer in enumerate(answers):
                yield f"{name} finer" if level else name, answer
        others = {"cprbm auto": self.auto, "cprbm beside": self.beside, "fea beside": self.fea_beside}
        yield from ((name, answer) for name, answer in others.items() if answer is not None)

    def bounds(
        self,
        values: Mapping[str, Array],
        size: Callable[[Array], float],
        round_off: float = 0.0,
        known: Mapping[str, Error] = frozendict(),
    ) -> Bounds | None:
        """Stated uncertainties of a row; None where a solver lacks the value on the finer grid.

        Args:
            values: values (k,) by name of the run, as :meth:`everything` names the runs.
            size: norm of a difference (k,).
            round_off: r.
            known: uncertainties of settled runs, by name.
        """
        even = values.get("cprbm auto", values["cprbm"])
        of_cprbm = known.get("cprbm") or _error(even, values, "cprbm", self.ratio)
        of_fea = known.get("fea") or _error(values["fea"], values, "fea", self.fea_ratio)
        if of_cprbm is None or of_fea is None:
            return None
        return Bounds(
            cprbm=size(values["cprbm"] - even) + size(of_cprbm.even) + size(of_cprbm.uneven),
            fea=size(of_fea.even) + size(of_fea.uneven),
            round_off=round_off,
        )


def other_theory(theory: Kinematics) -> Kinematics:
    """``bending``, the paper's theory; ``shear`` for ``bending``."""
    return "shear" if theory == "bending" else "bending"


def _error(value: Array, values: Mapping[str, Array], name: str, ratio: float) -> Error | None:
    """Uncertainty of the ``value`` of the runs of a name; None without a run at 2N."""
    if f"{name} finer" not in values:
        return None
    grids = [(1.0, value), (2.0, values[f"{name} finer"])]
    if f"{name} beside" in values:
        grids.insert(1, (1.0 / ratio, values[f"{name} beside"]))
    sizes, found = zip(*grids, strict=True)
    return error(sizes, found)


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
