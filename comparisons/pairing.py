"""One scene to both solvers: the only module that knows them, and it imports each where it is used.

What is run for a comparison: the CPRBM at N and 2N links (in the formulation ``paper``, whose error is uneven in
N, at N in ``paper``, and at N and 2N in ``auto``) and, where there is contact or a section has a kink, whose place
in an element matters, at N + N/7; the finite elements at n and 2n in the theory that was chosen and in ``bending``,
the CPRBM's own; and at n in the theory between the two, if there is one, so that the step from one theory to the next
can be split.

Where ``auto`` was chosen and every contact of two beams says what ``paper`` must be told, that is run at N as well.
It shows what the contact's formulation makes of the answer and takes no part in the verdict.  Not where the ends of
branches are asked for: with another contact a branch ends elsewhere, and answers on two branches show nothing of it.

Where an exact answer is known (in ``bending`` only), it stands beside both at the stations that it covers.

Where a drive's reaction is a probe, the CPRBM runs at N once more at two perturbed stations around every station of the
drive (:mod:`comparisons.reactions`). The work–energy reaction follows from their energies. The verdict does not use it.
"""

from __future__ import annotations

import gc
import logging
import os
import signal
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from typing import Protocol

from pydantic import ValidationError

from comparisons.choices import KINEMATICS, Choices, Kinematics, check
from comparisons.listening import heard_from, listen
from comparisons.processes import AloneError, deaf, pool
from comparisons.reactions import perturbed_scene
from comparisons.verdict.uncertainty import Error
from cprbm_scene import Answer, Mistake, RigidContact, Scene, SceneError, Spacing
from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import Curve

_SAYS = logging.getLogger(__name__)

Solver = Callable[[Scene, Choices], Answer]
Prepared = Callable[[], Answer]
Job = tuple[Solver, Scene, Choices]

Uncertainties = Mapping[tuple[str, float, str], Error]
"""Stated uncertainties by stage, station and probe."""

COLLECTED = (50_000, 20, 100)
"""Of a worker's collector of cycles: objects, and collections, after which it looks at the young and the older."""

PAPER_BESIDE_AUTO = 160
"""Most links per beam with which ``paper`` is run beside ``auto``: its time grows with the cube of N."""


def cprbm_answer(scene: Scene, choices: Choices) -> Answer:
    """The chained pseudo-rigid-body model's answer.

    Raises:
        SceneError: the scene or the choices are no question that this solver can be asked.
    """
    return cprbm_prepared(scene, choices)()


def cprbm_prepared(scene: Scene, choices: Choices) -> Prepared:
    """The same with the mechanism made ready and nothing solved; called once, the result solves.

    Raises:
        SceneError: as :func:`cprbm_answer`.
    """
    import cprbm

    with _named("links"):
        settings = cprbm.Settings(links=_plain(choices.links), formulation=choices.formulation)
    return cprbm.prepared(scene, settings).answer


def fea_answer(scene: Scene, choices: Choices) -> Answer:
    """The finite elements' answer.

    Raises:
        SceneError: the scene or the choices are no question that this solver can be asked.
    """
    return fea_prepared(scene, choices)()


def fea_prepared(scene: Scene, choices: Choices) -> Prepared:
    """The same with the elements made ready and nothing solved; called once, the result solves.

    Raises:
        SceneError: as :func:`fea_answer`.
    """
    import fea_reference

    with _named("elements"):
        settings = fea_reference.Settings(
            elements=_plain(choices.elements),
            kinematics=choices.kinematics,
            penetration=choices.penetration,
        )
    return fea_reference.prepared(scene, settings).answer


def prepared(solver: Solver, scene: Scene, choices: Choices) -> Prepared:
    """A solver made ready for a question: ours as far as they go without solving, others not at all.

    Raises:
        SceneError: the solver refuses the question.
    """
    if solver is cprbm_answer:
        return cprbm_prepared(scene, choices)
    if solver is fea_answer:
        return fea_prepared(scene, choices)
    return lambda: solver(scene, choices)


def exact_answer(scene: Scene, choices: Choices) -> Answer:
    """The exact answer in the theory ``bending``, or as much of it as is known; the choices have no part in it."""
    import elastica_reference

    return elastica_reference.answer(scene, elastica_reference.Settings())


def solid_answer(scene: Scene, choices: Choices) -> Answer:
    """The answer of the mechanism as a plane solid.

    Raises:
        SceneError: the scene or the choices are no question that this solver can be asked.
    """
    from fea_reference import solid

    with _named("elements"):
        settings = solid.Settings(elements=_plain(choices.elements), across=choices.across)
    return solid.answer(scene, settings)


class Offsets(Protocol):
    """Offset points (k, n, 2), m, at k distances, their tangents' angles (n,), how far off they may be (k, n), m."""

    @property
    def points(self) -> Array: ...  # noqa: D102
    @property
    def tangents(self) -> Array: ...  # noqa: D102
    @property
    def off_curve(self) -> Array: ...  # noqa: D102


OffsetConstruction = Callable[[Curve, Spacing, int, Array], Offsets]
"""Of a curve, a spacing, N and signed distances (k,), m (positive to the left)."""


def cprbm_offset_points(curve: Curve, spacing: Spacing, n: int, distances: Array) -> Offsets:
    """The offset points of a chain of ``n`` springs."""
    import cprbm

    return cprbm.offset_points(curve, spacing, n, distances)


@dataclass(frozen=True, slots=True)
class Solvers:
    """The functions that are compared; others can be planted in their place.

    ``exact`` stands beside them where it is given: an exact answer is that of the real beams, and no measure of what
    is planted in the place of the solvers.  ``solid`` is asked as a third where it is given.
    """

    cprbm: Solver = cprbm_answer
    fea: Solver = fea_answer
    offset: OffsetConstruction = cprbm_offset_points
    exact: Solver | None = None
    solid: Solver | None = None


def with_solid(solvers: Solvers) -> Solvers:
    """The same with the solid as a third opinion, unless there is one already."""
    return solvers if solvers.solid is not None else replace(solvers, solid=solid_answer)


def solvers_of(planted: object) -> Solvers:
    """What was ``planted`` in the place of the solvers, or these with the exact answer beside them."""
    return planted if isinstance(planted, Solvers) else Solvers(exact=exact_answer)


def workers_for(planted: object) -> int:
    """How many processes share the runs: what is planted stays in this one."""
    return 1 if isinstance(planted, Solvers) else min(2, os.cpu_count() or 1)


@dataclass(frozen=True, slots=True)
class Runs:
    """All answers to one scene that a comparison rests on.

    Attributes:
        kinematics: the beam theory that was chosen for the reference.
        cprbm: at N and 2N links; the second always in the formulation ``auto``.
        fea: by theory, from ``bending`` up to the chosen one: at n and, for these two, at 2n elements; the one between
            them may have been left out.
        auto: the CPRBM at N links in the formulation ``auto``, if another was chosen.
        paper: the same in the formulation ``paper``, if ``auto`` was chosen and the other could be asked;
            nothing rests on it.
        beside: the CPRBM in ``auto`` at N + N/7 links, if there is contact or a section has a kink; ``ratio`` is N
            over that number.
        fea_beside, fea_ratio: likewise the finite elements in the chosen theory at n + n/7, if there is contact.
        perturbed: the CPRBM at N links, answering :func:`comparisons.reactions.perturbed_scene`; nothing rests on it.
        exact: the exact answer in ``bending``, at the stations at which one is known; None if there is no such station.
        solid: the mechanism as a solid, if that was asked for, at n and 2n elements or on as many meshes as a tolerance
            took, each twice as fine as the one before; nothing rests on it.
        settled: by the name of a run whose values are extrapolated, or whose uncertainty is known from more grids than
            these: the stated uncertainty by stage, station and probe.
    """

    kinematics: Kinematics
    cprbm: tuple[Answer, Answer]
    fea: Mapping[Kinematics, tuple[Answer, ...]]
    auto: Answer | None = None
    paper: Answer | None = None
    beside: Answer | None = None
    ratio: float = 1.0
    fea_beside: Answer | None = None
    fea_ratio: float = 1.0
    perturbed: Answer | None = None
    exact: Answer | None = None
    solid: tuple[Answer, ...] | None = None
    settled: Mapping[str, Uncertainties] = frozendict()

    @property
    def reference(self) -> Answer:
        """The finite elements' answer in the chosen theory at n elements."""
        return self.fea[self.kinematics][0]

    @property
    def formulations(self) -> tuple[Answer, Answer] | None:
        """The CPRBM at N links in ``paper`` and in ``auto``; None where one of them was not run."""
        if self.auto is not None:
            return self.cprbm[0], self.auto
        return None if self.paper is None else (self.paper, self.cprbm[0])

    def everything(self) -> Iterator[tuple[str, Answer]]:
        """Every answer of a solver that the verdict rests on, with a name that says what it is."""
        families = {"cprbm": self.cprbm, **{f"fea {kinematics}": fea for kinematics, fea in self.fea.items()}}
        for name, answers in families.items():
            for level, answer in enumerate(answers):
                yield f"{name} finer" if level else name, answer
        if self.auto is not None:
            yield "cprbm auto", self.auto
        if self.beside is not None:
            yield "cprbm beside", self.beside
        if self.fea_beside is not None:
            yield f"fea {self.kinematics} beside", self.fea_beside


@dataclass(frozen=True, slots=True)
class Crew:
    """Processes that share the runs of one case after the other; without a pool all stays in this one."""

    pool: ProcessPoolExecutor | None = None

    def answers(self, jobs: list[Job]) -> list[Answer]:
        """The answers to some jobs, in their order.

        Raises:
            SceneError: a solver refuses one.
        """
        return self.begin(jobs)()

    def begin(self, jobs: list[Job]) -> Callable[[], list[Answer]]:
        """Have the processes begin with some jobs, behind those that were begun before; called, the result waits.

        What it then gives and raises is as of :meth:`answers`.  Without a pool nothing is done before.
        """
        if self.pool is None:
            return lambda: _one_by_one(jobs)
        # The finest runs take longest, and they stand last: handed out first, they leave no worker idle.
        with deaf():  # until they are prepared
            futures: dict[_Pending, int] = {
                self.pool.submit(_job, solver, scene, choices): place
                for place, (solver, scene, choices) in reversed(list(enumerate(jobs)))
            }
        return lambda: _awaited(futures)


_Pending = Future[Answer | tuple[Mistake, ...]]


def _one_by_one(jobs: Sequence[Job]) -> list[Answer]:
    """The answers, in this process."""
    answers: list[Answer] = []
    for solver, scene, choices in jobs:
        answers.append(solver(scene, choices))
        _done(answers[-1], len(answers), len(jobs))
    return answers


def _done(answer: Answer, done: int, whole: int) -> None:
    """Say that a run is done, and how many of the ``whole`` are."""
    told = answer.scene, done, whole, answer.solver, answer.ending.name, answer.seconds
    _SAYS.info("%s: run %d of %d is done: %s, %s after %.2f s", *told, extra={"done": done, "whole": whole})


def _awaited(futures: Mapping[_Pending, int]) -> list[Answer]:
    """The answers by their places; the first refusal ends the rest."""
    answers: dict[int, Answer] = {}
    try:
        for future in as_completed(futures):
            result = future.result()
            if isinstance(result, tuple):
                raise SceneError(result)
            answers[futures[future]] = result
            _done(result, len(answers), len(futures))
    finally:
        for future in futures:
            future.cancel()
    return [answers[place] for place in range(len(futures))]


ALONE = Crew()


@contextmanager
def crew_of(workers: int) -> Iterator[Crew]:
    """A crew of so many processes, which end with the context; one worker is this process itself.

    They end at once if the context is left by an error, or this process by force.  Where the system lets none work
    beside this one, this one does all of it.
    """
    if workers <= 1:
        yield ALONE
        return
    listening, held = Pipe(duplex=False)
    try:
        shared = pool(workers, _prepared_worker, listening, heard_from())
    except AloneError as alone:
        _SAYS.info("one process does all of the work: %s", alone)
        listening.close()
        held.close()
        yield ALONE
        return
    try:
        yield Crew(shared)
    except BaseException:
        held.close()  # what they still solve nobody waits for
        raise
    finally:
        shared.shutdown(cancel_futures=True)
        held.close()
        listening.close()


def paired(scene: Scene, choices: Choices, solvers: Solvers, crew: Crew = ALONE, *, bare: bool = False) -> Runs:
    """Run both solvers on a scene.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        solvers: who answers.
        crew: processes to share the runs.
        bare: whether to leave out the runs on which no word of the verdict rests.

    Raises:
        SceneError: a solver refuses the question.
    """
    return begin(scene, choices, solvers, crew, bare=bare)()


def begin(scene: Scene, choices: Choices, solvers: Solvers, crew: Crew, *, bare: bool = False) -> Callable[[], Runs]:
    """Have the crew begin with the runs of a scene; called, the result waits for them.

    The arguments, and what it then raises, are those of :func:`paired`.

    Raises:
        SceneError: the choices do not fit the scene.
    """
    check(choices, scene)
    even = replace(choices, formulation="auto")
    extra = [] if even == choices else [(solvers.cprbm, scene, even)]
    beside = [(solvers.cprbm, scene, even.beside())] if may_be_uneven(scene) else []
    driven = None if bare else perturbed_scene(scene)
    round_each = [] if driven is None else [(solvers.cprbm, driven, choices)]
    jobs = [(solvers.cprbm, scene, choices), (solvers.cprbm, scene, even.finer()), *extra, *beside, *round_each]
    first = len(jobs)
    places: list[tuple[Kinematics, int]] = []
    for kinematics in KINEMATICS[: KINEMATICS.index(choices.kinematics) + 1]:
        between = kinematics not in ("bending", choices.kinematics)
        if bare and between:
            continue
        variant = choices.within(kinematics)
        levels = (variant,) if between else (variant, variant.finer())
        for level, settings in enumerate(levels):
            places.append((kinematics, level))
            jobs.append((solvers.fea, scene, settings))
    if scene.contacts:
        jobs.append((solvers.fea, scene, choices.beside()))
    behind = len(jobs)
    if solvers.exact is not None:
        jobs.append((solvers.exact, scene, choices))
    third = len(jobs)
    if solvers.solid is not None:
        jobs += [(solvers.solid, scene, choices), (solvers.solid, scene, choices.finer())]
    pending = crew.begin(jobs)

    def ended() -> Runs:
        answers = pending()
        exact = answers[behind] if solvers.exact is not None else None
        fea: dict[Kinematics, tuple[Answer, ...]] = {}
        for (kinematics, _), answer in zip(places, answers[first : first + len(places)], strict=True):
            fea[kinematics] = (*fea.get(kinematics, ()), answer)
        ratio, fea_ratio = even.ratios_beside()
        return Runs(
            choices.kinematics,
            (answers[0], answers[1]),
            frozendict(fea),
            auto=answers[2] if extra else None,
            paper=None if extra or bare else in_paper(scene, choices, solvers),
            beside=answers[2 + len(extra)] if beside else None,
            ratio=ratio,
            fea_beside=answers[behind - 1] if scene.contacts else None,
            fea_ratio=fea_ratio,
            perturbed=answers[first - 1] if round_each else None,
            exact=exact if exact is not None and exact.stations else None,
            solid=(answers[third], answers[third + 1]) if solvers.solid is not None else None,
        )

    return ended


def known_exactly(scene: Scene, choices: Choices, solvers: Solvers, crew: Crew) -> Answer | None:
    """The exact answer, as in :class:`Runs`.

    Raises:
        SceneError: the question is refused.
    """
    if solvers.exact is None:
        return None
    (answer,) = crew.answers([(solvers.exact, scene, choices)])
    return answer if answer.stations else None


def may_be_uneven(scene: Scene) -> bool:
    """Whether the CPRBM's error may depend on where joints fall: at a contact, or at a kink of a section."""
    return bool(scene.contacts) or any(len(beam.knots) > 2 for beam in scene.beams.values())


def in_paper(scene: Scene, choices: Choices, solvers: Solvers) -> Answer | None:
    """The CPRBM at N in the formulation ``paper``; None where that cannot be asked, takes long or shows nothing."""
    finest = choices.links if isinstance(choices.links, int) else max(choices.links.values())
    contacts = scene.contacts.values()
    told = all(isinstance(contact, RigidContact) or contact.paper is not None for contact in contacts)
    ends = any(stage.beyond is not None for stage in scene.stages)
    if not contacts or not told or ends or finest > PAPER_BESIDE_AUTO:
        return None
    try:
        return solvers.cprbm(scene, replace(choices, formulation="paper"))
    except SceneError:  # at this number of links it lacks something, and nothing that was asked for depends on it
        return None


def _job(solver: Solver, scene: Scene, choices: Choices) -> Answer | tuple[Mistake, ...]:
    """A worker's job; mistakes travel as plain records, since an exception is rebuilt from its text alone."""
    try:
        return solver(scene, choices)
    except SceneError as error:
        return error.mistakes


def _prepared_worker(listening: Connection, heard: int) -> None:
    """An interrupt ends a worker at once and without a word: the main process says what happened.

    What it says is ``heard`` from the same level on as there.
    It ends as soon as the other end of ``listening`` is closed, which nobody but the main process holds.
    Its collector of cycles looks less often, and never at what is loaded: records of a march are many and make none.
    """
    listen(heard)
    gc.freeze()
    gc.set_threshold(*COLLECTED)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_end_with, args=(listening,), daemon=True).start()


def _end_with(listening: Connection) -> None:
    """End this process when there is nobody to listen to any more."""
    with suppress(EOFError, OSError):
        listening.recv_bytes()
    os._exit(1)


@contextmanager
def _named(key: str) -> Iterator[None]:
    """Turn a solver's refusal of its settings into mistakes whose keys the user has typed."""
    try:
        yield
    except ValidationError as error:
        raise SceneError(
            [
                Mistake(
                    str(details["loc"][0]) if details["loc"] else key,
                    repr(details.get("input")),
                    details["msg"],
                )
                for details in error.errors()
            ]
        ) from None


def _plain(count: int | Mapping[str, int]) -> int | dict[str, int]:
    return count if isinstance(count, int) else dict(count)
