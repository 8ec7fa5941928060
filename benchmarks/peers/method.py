"""A peer as a method of the benchmark: the discretised problem, the optimiser's solve, and its judgement."""

from __future__ import annotations

from collections.abc import Callable

import cprbm
from benchmarks.peers import record
from benchmarks.peers.judged import TOLERANCE, judged
from benchmarks.peers.record import Discretised
from benchmarks.peers.solving import Optimiser, Solved
from comparisons.bench.running import Clocked, Contender, Outcome, Run
from comparisons.choices import Count
from cprbm_scene import Scene


def discretised(scene: Scene, links: Count) -> Discretised:
    """The scene's last state as the problem of the CPRBM's formulation ``paper``.

    Args:
        scene: the question.
        links: per beam, one number or one by the beam's name.

    Raises:
        SceneError: the formulation does not offer it, or it is more than one minimum over links and bodies.
    """
    plain = links if isinstance(links, int) else dict(links)
    return record.discretised(scene, cprbm.Settings(links=plain, formulation="paper"))


def method(
    name: str,
    label: str,
    optimiser: Optimiser,
    largest: int,
    look: tuple[str, str],
    ratios: tuple[Clocked, ...],
    absence: str = "",
) -> Contender:
    """An optimiser as a contender of the benchmark.

    Args:
        name: as the option ``--method`` and the JSON have it.
        label: as tables have it.
        optimiser: the set-up of its solve.
        largest: number of links up to which it goes if no sizes are named.
        look: colour and marker of its points in figures.
        ratios: clocks of the ratios of its time to the time of the CPRBM.
        absence: why it cannot take part on this machine; empty if it can.
    """
    return Contender(
        name,
        method=name,
        formulation="paper",
        label=label,
        begin=_begin(optimiser),
        largest=largest,
        tolerance=TOLERANCE,
        ratios=ratios,
        look=look,
        absence=absence,
    )


def _begin(optimiser: Optimiser) -> Callable[[Scene, Count, float], Run]:
    def begin(scene: Scene, count: Count, at_most: float) -> Run:
        # cutting beams into links is no part of an optimiser's time
        problem = discretised(scene, count)

        def outcome(solved: Solved) -> Outcome:
            found = judged(scene, problem, solved)
            return Outcome(found.ended, found.why, (solved.iterations,), found.values, found.residual)

        return Run(lambda: optimiser(problem, at_most), outcome)

    return begin
