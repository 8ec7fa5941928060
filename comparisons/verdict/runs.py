"""All answers to one scene in a comparison: by name of the run, by station, and their stated uncertainties.

======  ==========================================================================================
symbol  meaning
======  ==========================================================================================
v_c     value of the CPRBM at N links; v_a in the formulation ``auto``, where ``paper`` is compared
v_f     value of the finite elements at n elements
u_c     |v_c − v_a| + u(v_a)
u_f     u(v_f) + t
t       error by the tilt of contact forces, in ``shear``: :func:`comparisons.verdict.point_forces.largest_tilt`
r       round-off
======  ==========================================================================================

u is the uncertainty of :mod:`comparisons.verdict.uncertainty` on the grids N, N + N/7 and 2N.  All runs have one beam
theory.  Two right solvers therefore have

    |v_c − v_f| ≤ u_c + u_f + r.

====================  ============================================================================
run                   answer
====================  ============================================================================
cprbm, fea            the compared answers at N links and n elements
cprbm finer           the CPRBM at 2N links, always in ``auto``
fea finer             the finite elements at 2n elements
cprbm auto            the CPRBM at N links in ``auto``, if another formulation is chosen
cprbm beside          the CPRBM at N + N/7 links in ``auto``; fea beside at n + n/7 elements
cprbm paper           at N links in ``paper`` and in ``bending``, beside ``auto``
cprbm perturbed       at N links at :func:`comparisons.reactions.perturbed_scene`
exact                 the exact answer at the covered stations, in ``bending``
cprbm bending, shear  at N links in ``auto`` in the other theory
====================  ============================================================================

Where the answers at N and n have nothing in common, no further run of the theory is there.  The last four runs are no
part of the verdict, except that the exact answer contradicts, and the other theory leaves rows undecided.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

from comparisons.choices import Kinematics
from comparisons.stations import Where, complete_stations, ends_at_critical, problems, stations_of
from comparisons.verdict.uncertainty import Error, error
from cprbm_scene import Answer, Array, Scene, StationAnswer, frozendict

Solver = Literal["cprbm", "fea"]
SOLVERS: tuple[Solver, ...] = ("cprbm", "fea")
"""The solvers, and the names of the two compared runs."""

SAME_THEORY = ("cprbm", "cprbm finer", "fea", "fea finer", "cprbm auto", "cprbm beside", "fea beside")
"""Names of the runs in the theory of the comparison."""

NAMES = (*SAME_THEORY, "cprbm paper", "cprbm perturbed", "exact", "cprbm bending", "cprbm shear")
"""Names of all runs, in the order of a file of answers."""

TWICE: Mapping[str, float] = frozendict({"cprbm finer": 2.0, "fea finer": 2.0})

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


@dataclass(frozen=True)  # slots refuse cached properties
class Runs:
    """All answers to one scene in a comparison; a failed run is a failed answer.

    Attributes:
        scene: the question.
        theory: beam theory of the comparison.
        answers: by name of the run, in the order of ``NAMES``.
        absences: why the CPRBM refuses the other theory, and why no station has an exact answer; by name of the run.
        sizes: N of further runs over N of the compared run, by name of the run, ascending.
        solids: the solid at n and 2n elements, or on the meshes of a tolerance, from coarse to fine; no part of the
            verdict.
        settled: stated uncertainties by stage, station and probe, by name of a run with extrapolated values or further
            grids.
    """

    scene: Scene
    theory: Kinematics
    answers: Mapping[str, Answer]
    absences: Mapping[str, str] = frozendict()
    sizes: Mapping[str, float] = TWICE
    solids: tuple[Answer, ...] = ()
    settled: Mapping[str, Uncertainties] = frozendict()

    @property
    def pair(self) -> tuple[Answer, Answer]:
        """The two compared answers."""
        return self.answers["cprbm"], self.answers["fea"]

    @property
    def other(self) -> Answer | None:
        """The CPRBM's answer in the other theory; None without this run."""
        return self.answers.get(f"cprbm {other_theory(self.theory)}")

    @property
    def formulations(self) -> tuple[str, str]:
        """Names of the CPRBM's runs at N links in ``paper`` and in ``auto``, in one theory."""
        if "cprbm auto" in self.answers:
            return "cprbm", "cprbm auto"
        return "cprbm paper", "cprbm" if self.theory == "bending" else "cprbm bending"

    @cached_property
    def same_theory(self) -> Mapping[str, Answer]:
        """Answers in the theory of the comparison, by name of the run."""
        return {name: self.answers[name] for name in SAME_THEORY if name in self.answers}

    @cached_property
    def problems(self) -> Mapping[str, tuple[str, ...]]:
        """Problems of every run of the theory that is not complete, by name."""
        found = {name: problems(self.scene, answer) for name, answer in self.same_theory.items()}
        return {name: each for name, each in found.items() if each}

    @cached_property
    def stations(self) -> Mapping[str, Mapping[Where, StationAnswer]]:
        """Complete stations of every run of the theory."""
        return {name: complete_stations(self.scene, answer) for name, answer in self.same_theory.items()}

    @cached_property
    def reached(self) -> tuple[Where, ...]:
        """Stations of both compared runs, in order."""
        return tuple(
            where for where in stations_of(self.scene) if all(where in self.stations[name] for name in SOLVERS)
        )

    def at(self, where: Where) -> dict[str, StationAnswer]:
        """Stations of all runs of the theory with this station, by name of the run."""
        return {name: stations[where] for name, stations in self.stations.items() if where in stations}

    @cached_property
    def following(self) -> Mapping[str, Answer]:
        """Runs of the theory up to the last station, or up to the critical point at the end of the path."""
        return {name: each for name, each in self.same_theory.items() if each.completed or ends_at_critical(each)}

    def bounds(
        self,
        values: Mapping[str, Array],
        size: Callable[[Array], float],
        round_off: float = 0.0,
        known: Mapping[str, Error] = frozendict(),
        tilt: float = 0.0,
    ) -> Bounds | None:
        """Stated uncertainties of a row; None where a solver lacks the value on the finer grid.

        Args:
            values: values (k,) by name of the run.
            size: norm of a difference (k,).
            round_off: r.
            known: uncertainties of settled runs, by name.
            tilt: t.
        """
        even = values.get("cprbm auto", values["cprbm"])
        of_cprbm = known.get("cprbm") or self._error(even, values, "cprbm")
        of_fea = known.get("fea") or self._error(values["fea"], values, "fea")
        if of_cprbm is None or of_fea is None:
            return None
        return Bounds(
            cprbm=size(values["cprbm"] - even) + size(of_cprbm.even) + size(of_cprbm.uneven),
            fea=size(of_fea.even) + size(of_fea.uneven) + tilt,
            round_off=round_off,
        )

    def _error(self, value: Array, values: Mapping[str, Array], solver: Solver) -> Error | None:
        """Uncertainty of the ``value`` of a solver; None without a value at 2N."""
        finer = {
            size: values[name] for name, size in self.sizes.items() if name in values and solver_of(name) == solver
        }
        return error([1.0, *finer], [value, *finer.values()]) if f"{solver} finer" in values else None


def runs_of(
    scene: Scene,
    theory: Kinematics,
    results: Mapping[str, Answer | str],
    sizes: Mapping[str, float] = TWICE,
    settled: Mapping[str, Uncertainties] = frozendict(),
) -> Runs:
    """Runs from results by name: answers, or the reasons of absences; an exact answer without a station is absent."""
    answers = {name: each for name in NAMES if isinstance(each := results.get(name), Answer)}
    absences = {name: each for name, each in results.items() if isinstance(each, str) and each}
    if "exact" in answers and not answers["exact"].stations:
        absences["exact"] = answers.pop("exact").sentence
    return Runs(
        scene,
        theory,
        answers,
        absences,
        sizes,
        solids=tuple(each for name, each in results.items() if name.startswith("solid") and isinstance(each, Answer)),
        settled=settled,
    )


def other_theory(theory: Kinematics) -> Kinematics:
    """``bending``, the paper's theory; ``shear`` for ``bending``."""
    return "shear" if theory == "bending" else "bending"


def solver_of(name: str) -> str:
    """``cprbm`` or ``fea`` of a run's name."""
    return name.split(" ", maxsplit=1)[0]
