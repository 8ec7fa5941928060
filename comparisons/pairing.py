"""The solvers, and the runs of a comparison: only this module imports the solvers, at the place of use.

Seven runs (:mod:`comparisons.verdict.runs`) in one theory, the theory of the finite elements
(:meth:`comparisons.choices.Choices.kinematics_of`):

* CPRBM at N, N + N/7 and 2N links, at the last two always in ``auto``; in ``paper`` also at N in ``auto``;
* finite elements at n, n + n/7 and 2n elements;
* CPRBM at N links in ``bending``, or in ``shear`` where the comparison is in ``bending``.  The last run shows the step
  of theory; a refusal or an early end of this run leaves the verdict alone.

The runs at N and n come first.  Where these two have no station and no critical value in common, there is no row, no
other run can change the word, and all others but the run in the other theory are cancelled.

Beside ``auto``, a run at N in ``paper`` shows the effect of the contact formulation, if the contacts of two beams state
all that ``paper`` needs.  The verdict does not use this run.  There is none where a stage asks for the ends of
branches: with another contact a branch ends elsewhere, and answers on two branches show nothing of the formulation.

An exact answer stands beside both solvers at the covered stations, if the comparison is in ``bending``.  A rule on the
number of pieces and stations of a scene says whether the exact reference is asked (:func:`exact_by_rule`).

Where the reaction of a drive is a probe, the CPRBM runs at N once more at two perturbed stations around every station
of the drive (:mod:`comparisons.reactions`).  The work–energy reaction follows from the energies.  The verdict does not
use the reaction.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Literal, TypeAlias

from pydantic import ValidationError

from comparisons.choices import Choices, check_counts
from comparisons.executor import ALONE, Crew, Job, Solver
from comparisons.formats import in_file_units
from comparisons.reactions import perturbed_scene
from comparisons.stations import find_station, stations_of
from comparisons.verdict import SOLVERS, TWICE, Runs, other_theory, runs_of
from cprbm_scene import (
    Answer,
    Array,
    BodyLoad,
    Curve,
    Ending,
    Mistake,
    RigidContact,
    Scene,
    SceneError,
    Spacing,
    Spline,
    frozendict,
)

if TYPE_CHECKING:
    from cprbm import OffsetPoints

Prepared = Callable[[], Answer]

PAPER_BESIDE_AUTO = 160
"""Largest number of links per beam of a run in ``paper`` beside ``auto``: the time grows with the cube of N."""


EXACT_LIMIT = 300
"""Largest product of the pieces and the stations of a scene for which the exact reference is asked by rule.

Measured on one core: 0.03 s for each piece and station of a chain of 5 beams, 0.08 s of 40 beams, 0.1 to 0.15 s where
contacts close.  The largest product of a built-in case with an exact answer is 160, ``gripper-driven``, in 18 s.
"""


def cprbm_answer(scene: Scene, choices: Choices) -> Answer:
    """The chained pseudo-rigid-body model's answer.

    Raises:
        SceneError: the solver refuses the scene or the choices.
    """
    return cprbm_prepared(scene, choices)()


def cprbm_prepared(scene: Scene, choices: Choices) -> Prepared:
    """A function for the CPRBM's answer, to be called once; the mechanism is assembled, and nothing is solved.

    Raises:
        SceneError: as :func:`cprbm_answer`.
    """
    import cprbm

    with _named("links"):
        settings = cprbm.Settings(links=choices.links, formulation=choices.formulation)
    theory = choices.theory_of(scene)
    run = cprbm.prepared(scene.model_copy(update={"theory": theory}), settings)
    # with the theory among the settings, as the finite elements state the theory
    return lambda: in_file_units(
        scene, replace(answer := run.answer(), settings=frozendict({**answer.settings, "kinematics": theory}))
    )


def fea_answer(scene: Scene, choices: Choices) -> Answer:
    """The finite elements' answer.

    Raises:
        SceneError: the solver refuses the scene or the choices.
    """
    return fea_prepared(scene, choices)()


def fea_prepared(scene: Scene, choices: Choices) -> Prepared:
    """A function for the finite elements' answer, to be called once; the mesh is made, and nothing is solved.

    Raises:
        SceneError: as :func:`fea_answer`.
    """
    import fea_reference

    with _named("elements"):
        settings = fea_reference.Settings(
            elements=choices.elements,
            kinematics=choices.kinematics_of(scene),
            penetration=choices.penetration,
        )
    run = fea_reference.prepared(scene, settings)
    return lambda: in_file_units(scene, run.answer())


def prepared(solver: Solver, scene: Scene, choices: Choices) -> Prepared:
    """A function for the answer of a solver; our solvers are assembled already, and nothing is solved.

    Raises:
        SceneError: the solver refuses the question.
    """
    own: dict[Solver, Callable[[Scene, Choices], Prepared]] = {cprbm_answer: cprbm_prepared, fea_answer: fea_prepared}
    return own[solver](scene, choices) if solver in own else partial(solver, scene, choices)


def exact_answer(scene: Scene, choices: Choices) -> Answer:
    """The exact answer in the theory ``bending`` at the covered stations, whatever the choices.

    Raises:
        SceneError: the solver refuses the scene.
    """
    import elastica_reference

    return elastica_reference.answer(scene, elastica_reference.Settings())


def exact_if_covered(scene: Scene, choices: Choices, solve: Solver = exact_answer) -> Answer:
    """The exact answer beside other solvers; without stations, and with a sentence on refused records, if refused."""
    try:
        return solve(scene, choices)
    except SceneError as error:
        return Answer(
            "exact",
            scene.name,
            frozendict(),
            Ending.NOT_COVERED,
            f"there are no equations for {', '.join(dict.fromkeys(each.found for each in error.mistakes))}.",
            (),
        )


def exact_pieces(scene: Scene) -> int:
    """Number of pieces of the exact equations: between kinks of sections, points of splines, loads and contacts."""
    pieces = (
        len(beam.knots) - 1 + (len(beam.curve.points) - 2 if isinstance(beam.curve, Spline) else 0)
        for beam in scene.beams.values()
    )
    return sum(pieces) + sum(not isinstance(load, BodyLoad) for load in scene.loads.values()) + len(scene.contacts)


def exact_by_rule(scene: Scene, choices: Choices) -> Answer:
    """The exact answer, or none with a sentence where pieces times stations are more than ``EXACT_LIMIT``."""
    pieces, stations = exact_pieces(scene), sum(len(stage.stations) for stage in scene.stages)
    if pieces * stations <= EXACT_LIMIT:
        return exact_if_covered(scene, choices)
    return Answer(
        "exact",
        scene.name,
        frozendict(),
        Ending.NOT_COVERED,
        f"{pieces} pieces of beams at {stations} stations are beyond the rule for the exact reference (pieces times "
        f"stations at most {EXACT_LIMIT}); the option --exact runs the reference all the same.",
        (),
    )


def solid_answer(scene: Scene, choices: Choices) -> Answer:
    """The answer of the mechanism as a plane solid.

    Raises:
        SceneError: the solver refuses the scene or the choices.
    """
    from fea_reference import solid

    with _named("elements"):
        settings = solid.Settings(elements=choices.elements, across=choices.across)
    return in_file_units(scene, solid.answer(scene, settings))


SolverName = Literal["cprbm", "fea", "exact", "solid"]
ANSWERS: Mapping[SolverName, Solver] = {
    "cprbm": cprbm_answer,
    "fea": fea_answer,
    "exact": exact_answer,
    "solid": solid_answer,
}
"""Functions of all solvers of a single answer."""

Offsets: TypeAlias = "OffsetPoints"
OffsetConstruction = Callable[[Curve, Spacing, int, Array], "OffsetPoints"]
"""Arguments: a curve, a spacing, N and signed distances (k,), m, positive to the left."""


def cprbm_offset_points(curve: Curve, spacing: Spacing, n: int, distances: Array) -> Offsets:
    """The offset points of a chain of ``n`` springs."""
    import cprbm

    return cprbm.offset_points(curve, spacing, n, distances)


@dataclass(frozen=True, slots=True)
class Solvers:
    """The functions of the solvers in a comparison; tests plant others.

    ``exact`` is the exact reference, an answer for the real beams and no measure of planted solvers; ``solid`` a third
    solver.
    """

    cprbm: Solver = cprbm_answer
    fea: Solver = fea_answer
    offset: OffsetConstruction = cprbm_offset_points
    exact: Solver | None = None
    solid: Solver | None = None


def with_solid(solvers: Solvers) -> Solvers:
    """The solvers with the solid as a third opinion."""
    return solvers if solvers.solid is not None else replace(solvers, solid=solid_answer)


def solvers_of(planted: object, *, exact: bool | None = None) -> Solvers:
    """The ``planted`` solvers, or our solvers with the exact reference.

    ``exact`` says whether the exact reference is asked; with None the rule decides.
    """
    solvers = planted if isinstance(planted, Solvers) else Solvers(exact=exact_if_covered if exact else exact_by_rule)
    return replace(solvers, exact=None) if exact is False else solvers


def load_solvers() -> None:
    """Load both solvers here, so that forked workers have both loaded."""
    import cprbm  # noqa: F401
    import fea_reference  # noqa: F401


def paired(scene: Scene, choices: Choices, solvers: Solvers, crew: Crew = ALONE, *, bare: bool = False) -> Runs:
    """Run both solvers on a scene.

    Args:
        scene: the question.
        choices: how finely, and by which variants.
        solvers: who answers.
        crew: processes to share the runs.
        bare: whether to leave out all runs outside the theory of the comparison, and perturbed runs.

    Raises:
        SceneError: the choices do not fit the scene, or a solver refuses the question.
    """
    check_counts(choices, scene)
    theory = choices.kinematics_of(scene)
    choices = choices.within(theory)
    even = replace(choices, formulation="auto")
    jobs = _planned(scene, choices, solvers, bare=bare)
    theories = [] if bare else [crew.begin(in_other_theory, scene, even, solvers)]
    paper = [] if bare or "cprbm auto" in jobs else [crew.begin(in_paper, scene, choices, solvers)]
    answers = crew.answers(list(jobs.values()), partial(_nothing_in_common, scene))
    found: dict[str, Answer | str] = dict(zip(jobs, answers, strict=False))  # of decided runs the first two alone
    for results in theories + (paper if len(found) == len(jobs) else []):
        found |= results()
    beside = {f"{name} beside": 1.0 / ratio for name, ratio in zip(SOLVERS, even.ratios_beside(), strict=True)}
    return runs_of(scene, theory, found, {**beside, **TWICE})


def _planned(scene: Scene, choices: Choices, solvers: Solvers, *, bare: bool) -> dict[str, Job]:
    """The runs of a comparison by name, without the other theory and ``paper``."""
    even, finer, beside = replace(choices, formulation="auto"), choices.finer(), choices.beside()
    driven = None if bare else perturbed_scene(scene)
    planned: dict[str, tuple[Solver | None, Scene | None, Choices]] = {
        "cprbm": (solvers.cprbm, scene, choices),
        "fea": (solvers.fea, scene, choices),
        "cprbm auto": (None if even == choices else solvers.cprbm, scene, even),
        "cprbm perturbed": (solvers.cprbm, driven, choices),
        "cprbm beside": (solvers.cprbm, scene, even.beside()),
        "cprbm finer": (solvers.cprbm, scene, even.finer()),
        "fea beside": (solvers.fea, scene, beside),
        "fea finer": (solvers.fea, scene, finer),
        "exact": (solvers.exact if choices.theory == "bending" else None, scene, choices),
        "solid": (solvers.solid, scene, choices),
        "solid finer": (solvers.solid, scene, finer),
    }
    return {
        name: (solver, asked, own)
        for name, (solver, asked, own) in planned.items()
        if solver is not None and asked is not None
    }


def _nothing_in_common(scene: Scene, cprbm: Answer, fea: Answer) -> bool:
    """Whether two answers have no station of the scene in common, and neither has a critical value."""
    shared = any(find_station(cprbm, *where) and find_station(fea, *where) for where in stations_of(scene))
    return not (shared or cprbm.critical or fea.critical)


def in_paper(scene: Scene, choices: Choices, solvers: Solvers) -> dict[str, Answer]:
    """The CPRBM at N in ``paper`` and ``bending``, by name; none where a run is impossible, long, or shows nothing."""
    finest = choices.links if isinstance(choices.links, int) else max(choices.links.values())
    contacts = scene.contacts.values()
    has_hints = all(isinstance(contact, RigidContact) or contact.paper is not None for contact in contacts)
    if not contacts or not has_hints or finest > PAPER_BESIDE_AUTO or any(stage.beyond for stage in scene.stages):
        return {}
    with suppress(SceneError):  # too few links for the polynomial; no requested value depends on the run
        return {"cprbm paper": solvers.cprbm(scene, replace(choices.within("bending"), formulation="paper"))}
    return {}


def in_other_theory(scene: Scene, choices: Choices, solvers: Solvers) -> dict[str, Answer | str]:
    """The CPRBM in the other theory, or the mistakes of a refusal, by name of the run."""
    theory = other_theory(choices.kinematics_of(scene))
    try:
        return {f"cprbm {theory}": solvers.cprbm(scene, choices.within(theory))}
    except SceneError as error:
        return {f"cprbm {theory}": "; ".join(map(str, error.mistakes))}


@contextmanager
def _named(key: str) -> Iterator[None]:
    """Turn a refusal of settings into mistakes with the keys of the command line."""
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
