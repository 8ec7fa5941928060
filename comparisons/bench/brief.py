"""A benchmark that is short enough for a report: the project's own solvers, few sizes, few repetitions.

Seconds are the processor's, since a report is made on machines that have other work.
"""

from __future__ import annotations

from comparisons import provenance
from comparisons.bench import contenders, errors, question, running
from comparisons.choices import Choices
from comparisons.pairing import Solvers
from cprbm_scene import Scene
from cprbm_scene.frozendict import frozendict

SIZES = (10, 20, 40, 80, 160)
REPEAT = 3
AT_MOST = 4.0
"""Seconds after which a size is not repeated and no larger one is begun."""


def measured(scene: Scene, timed: Solvers, knowing: Solvers) -> running.Benchmark:
    """Time the solvers on a scene's last load.

    Args:
        scene: the question.
        timed: the solvers themselves, which solve whenever they are asked.
        knowing: who answers for the reference of the errors, and may have kept its answers.

    Raises:
        SceneError: every method refuses the question.
    """
    asked = question.asked(scene)
    plan = running.Plan(frozendict(dict.fromkeys(contenders.OURS, SIZES)), repeat=REPEAT, at_most=AT_MOST, clock="cpu")
    taking_part = contenders.contenders(timed, Choices(kinematics=plan.kinematics))
    session = running.Session(asked, plan, taking_part, provenance.machine(), running.CLOCKS[plan.clock])
    for job in session.jobs():
        session.do(job)
    return session.done(errors.reference(asked, knowing))
