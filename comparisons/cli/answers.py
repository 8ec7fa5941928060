"""The answer of a single solver to a scene, and its report on standard error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import click

if TYPE_CHECKING:
    from comparisons.choices import Choices
    from comparisons.tolerances.result import Tolerance
    from cprbm_scene import Answer, Scene

SolverName = Literal["cprbm", "fea", "exact", "solid"]
SOLVERS: tuple[SolverName, ...] = ("cprbm", "fea", "exact", "solid")

NOT_COMPLETED = 1
NOT_WITHIN = 3


def solve_scene(
    planted: object, scene: Scene, solver: SolverName, choices: Choices, tol: float | None, *, shown: bool
) -> tuple[Answer, tuple[Tolerance, ...]]:
    """The answer, and the result of the search for N with a tolerance ``tol``.

    Raises:
        SceneError: the solver does not support the scene.
    """
    from comparisons.cli import output
    from comparisons.pairing import Solvers, exact_answer, solid_answer, solvers_of

    solvers = solvers_of(planted or Solvers(exact=exact_answer))  # a named solver has no rule on its size
    if tol is not None and solver != "exact":
        from comparisons.tolerances.search import solve_within

        with output.current(shown=shown) as say:
            answer, reached = solve_within(scene, solver, choices, tol, solvers, say)
        return answer, (reached,)
    solve = {
        "cprbm": solvers.cprbm,
        "fea": solvers.fea,
        "exact": solvers.exact or exact_answer,
        "solid": solvers.solid or solid_answer,
    }[solver]
    with output.stations(shown=shown):
        return solve(scene, choices), ()


def report_problems(scene: Scene, answer: Answer, found: tuple[Tolerance, ...], complaints: tuple[str, ...]) -> int:
    """Report an early end, ``complaints`` of the audit, or a missed tolerance; the exit code."""
    if not answer.completed:
        ending = answer.ending.value
        sentence = answer.sentence if answer.sentence.startswith(ending) else f"{ending}. {answer.sentence}".rstrip()
        click.echo(f"cprbm: {scene.name}: {sentence}", err=True)
        return NOT_COMPLETED
    if complaints:
        for complaint in complaints:
            click.echo(f"cprbm: {scene.name}: the audit fails {complaint}", err=True)
        return NOT_WITHIN
    for tolerance in found:
        if not tolerance.met:
            click.echo(f"cprbm: {scene.name}: {tolerance.sentence(scene)}", err=True)
            return NOT_WITHIN
    return 0
