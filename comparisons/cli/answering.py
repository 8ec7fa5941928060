"""One solver's answer to one scene, as several sub-commands ask for it, and what they say where it is not whole."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import click

if TYPE_CHECKING:
    from comparisons.choices import Choices
    from comparisons.tolerances.search import Tolerance
    from cprbm_scene import Answer, Scene

SolverName = Literal["cprbm", "fea", "exact", "solid"]
SOLVERS: tuple[SolverName, ...] = ("cprbm", "fea", "exact", "solid")

NOT_COMPLETED = 1
NOT_WITHIN = 3


def answered(
    planted: object, scene: Scene, solver: SolverName, choices: Choices, tol: float | None, *, shown: bool
) -> tuple[Answer, tuple[Tolerance, ...]]:
    """The answer, and what the search for N within a tolerance has found where one is given.

    Raises:
        SceneError: the question is none that the solver can be asked.
    """
    from comparisons.cli import showing
    from comparisons.pairing import exact_answer, solid_answer, solvers_of

    solvers = solvers_of(planted, exact=True)  # who names the solver is not held to the rule
    if tol is not None and solver != "exact":
        from comparisons.tolerances import tolerated

        with showing.current(shown=shown) as say:
            answer, reached = tolerated.solved(scene, solver, choices, tol, solvers, say)
        return answer, (reached,)
    asked = {
        "cprbm": solvers.cprbm,
        "fea": solvers.fea,
        "exact": solvers.exact or exact_answer,
        "solid": solvers.solid or solid_answer,
    }[solver]
    with showing.stations(shown=shown):
        return asked(scene, choices), ()


def told(scene: Scene, answer: Answer, found: tuple[Tolerance, ...], complaints: tuple[str, ...]) -> int:
    """Say of an answer what is not whole about it, as its audit ``complaints`` too; the exit code."""
    if not answer.completed:
        click.echo(f"cprbm: {scene.name}: {answer.ending.value}. {answer.sentence}".rstrip(), err=True)
        return NOT_COMPLETED
    if complaints:
        for complaint in complaints:
            click.echo(f"cprbm: {scene.name}: the audit fails {complaint}", err=True)
        return NOT_WITHIN
    for reached in found:
        if not reached.met:
            click.echo(f"cprbm: {scene.name}: {reached.sentence(scene)}", err=True)
            return NOT_WITHIN
    return 0
