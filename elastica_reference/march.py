"""Load stepping from rest through a scene's stations, with changes of contact.

The load or drive grows by steps within reach of Newton's method. After every step the contacts are checked. A contact
in tension opens, and overlapping lines close a contact. A beam about to cut into a circle beside the place of contact
wraps around the circle. The change is located as the equilibrium with a zero force of the new or old contact, and
stepping continues from there.

Every state has to be a minimum of the energy (:mod:`elastica_reference.stability`), and no beam may have passed
through another or through a circle (:mod:`elastica_reference.passing`). Load stepping ends at a fold or a
bifurcation. It also ends where two beams would lie along each other, or a contact would close at two places at once.
"""

import logging
import math
import time

from cprbm_scene import Answer, Ending, Mistake, Scene, SceneError, StationAnswer
from cprbm_scene.solving import requirements, station_reached
from cprbm_scene.statement import BeamContact, BeamMoment, EdgeContact, SelfContact, TurningBody
from elastica_reference.changes import change_form, open_first_contact, slide_onto_end
from elastica_reference.closings import close_first
from elastica_reference.gaps import overlaps
from elastica_reference.model import model_of
from elastica_reference.newton import LostError, residual_with_more_points
from elastica_reference.passing import passed_through
from elastica_reference.probing import station_answer
from elastica_reference.restructure import NotCoveredError
from elastica_reference.settings import Settings
from elastica_reference.state import State
from elastica_reference.structure import Meeting, Wrap
from elastica_reference.way import Stepping

_SAYS = logging.getLogger(__name__)

_OVERLAP = 1e-10  # units of length
_FIRST_STEP = 0.2  # share of the distance to the first station
_CHANGES = 40  # changes of structure between two stations


def answer(scene: Scene, settings: Settings | None = None) -> Answer:
    """Exact answer to a scene in the theory of bending without stretch and shear.

    Args:
        scene: the problem statement.
        settings: numerical choices.

    Returns:
        The stations up to the last with a solution; the ending is NOT_COVERED if a station is missing. Values are
        read-only arrays in SI, of the shapes in :mod:`cprbm_scene.answer`.

    Raises:
        SceneError: the scene has a record without equations; the error names every key.

    Source:
        Euler's elastica with contact, by Gauss collocation; only the integration is discretised.

    Example:
        >>> import elastica_reference
        >>> from cprbm_scene import read
        >>> answer = elastica_reference.answer(read("comparisons/cases/tapered.toml"))
        >>> answer.completed, answer.stations[-1].certificate.residual < 1e-10
        (True, True)
    """
    refuse(scene)
    chosen = settings or Settings()
    began = time.perf_counter()
    stepping = Stepping(model_of(scene), chosen)
    stations: list[StationAnswer] = []
    ending, sentence = Ending.COMPLETED, ""
    try:
        for stage in scene.stages:
            stepping.begin(stage)
            step = 0.0
            for station in stage.stations:
                step = _advance(stepping, station / stepping.unit, step)
                stations.append(_certified(stepping, station))
                station_reached(_SAYS, scene, len(stations), stations[-1])
    except NotCoveredError as error:
        ending, sentence = Ending.NOT_COVERED, f"{error}."
    return Answer(
        solver="exact",
        scene=scene.name,
        settings=chosen.plain(),
        ending=ending,
        sentence=sentence,
        stations=tuple(stations),
        events=tuple(stepping.events),
        seconds=time.perf_counter() - began,
    )


def refuse(scene: Scene) -> None:
    """Refuse records without equations.

    Raises:
        SceneError: the scene has such records; the error names every key.
    """
    refused = [
        *(
            (mistake.key, mistake.found, mistake.allowed)
            for mistakes in requirements(scene).values()
            for mistake in mistakes
        ),
        *((f"stops.{name}", "a stop", "pins without stops") for name in scene.stops),
        *((f"pins.{name}", "a pin between two bodies", "pins of beams") for name in scene.pins),
        *[("assembly", "an assembly", "beams that are drawn in place")] * (scene.assembly is not None),
        *(
            (f"bodies.{name}.motion", "'turns'", "'fixed', 'free' or 'slides'")
            for name, body in scene.bodies.items()
            if isinstance(body, TurningBody)
        ),
        *(
            (f"contacts.{name}.kind", repr(contact.kind), "'beam-beam' or 'beam-circle'")
            for name, contact in scene.contacts.items()
            if isinstance(contact, EdgeContact | SelfContact)
        ),
        *(
            (f"contacts.{name}.thick", "edges of varying thickness", "thick = false, or a constant thickness")
            for name, contact in scene.contacts.items()
            if isinstance(contact, BeamContact)
            and contact.thick
            and any(scene.beams[beam].tapered for beam in contact.beams)
        ),
        *(
            (f"loads.{name}.kind", "'beam_moment'", "another kind of load")
            for name, load in scene.loads.items()
            if isinstance(load, BeamMoment)
        ),
        *(
            (f"probes[{i}]", f"{probe.name!r}, the force of a slide", "another quantity")
            for i, probe in enumerate(scene.probes)
            if probe.of in scene.bodies and probe.quantity == "reaction"
        ),
    ]
    if refused:
        raise SceneError(
            [Mistake(key, value, f"{allowed}, for the exact solution", scene.file) for key, value, allowed in refused]
        )


def _certified(stepping: Stepping, station: float) -> StationAnswer:
    """A station's answer, whose equations also hold with more Gauss points.

    Raises:
        NotCoveredError: the residual with more Gauss points is too large.
    """
    try:
        finer = residual_with_more_points(stepping.state, stepping.settings.further)
    except LostError:
        finer = math.inf
    if not finer <= stepping.settings.tolerance:
        raise NotCoveredError(f"at {station:g} more Gauss points are needed: their residual is {finer:.1e}")
    return station_answer(stepping, station, finer)


def _advance(stepping: Stepping, target: float, step: float) -> float:
    """Step to a dimensionless ``target``; returns the last successful step size.

    Raises:
        NotCoveredError: the path leads beyond the equations.
    """
    whole, changes = target - stepping.lam, 0
    largest, smallest = stepping.settings.largest_step * abs(whole), stepping.settings.smallest_step * abs(whole)
    step = min(largest, step or _FIRST_STEP * abs(whole))
    reason, tried = "", 0
    while stepping.lam != target:
        tried += 1
        goal = target if abs(target - stepping.lam) <= step else stepping.lam + math.copysign(step, whole)
        try:
            trial = stepping.attempt(goal)
            if not _accept_or_change(stepping, trial):
                changes += 1
            step = min(1.5 * step, largest)
        except LostError as error:
            reason = f", where {error}" if str(error) else ""
            if slide_onto_end(stepping, goal):
                changes += 1
            else:
                step *= 0.4
        if tried >= stepping.settings.steps and stepping.lam != target:
            raise NotCoveredError(
                f"{stepping.settings.steps} steps lead no farther than {stepping.lam * stepping.unit:.6g} of "
                f"{stepping.stepped}"
            )
        if step < smallest or changes > _CHANGES:
            raise NotCoveredError(
                f"no equilibrium was found beyond {stepping.lam * stepping.unit:.6g} of {stepping.stepped}{reason}"
            )
    return step


def _accept_or_change(stepping: Stepping, trial: State) -> bool:
    """Accept a trial without changes of contact and return True; else step to the first change and return False.

    Raises:
        LostError: the change was not found.
        NotCoveredError: there are no equations for the change.
    """
    if open_first_contact(stepping, trial) or change_form(stepping, trial):
        return False
    overlapping = overlaps(stepping.model, trial, stepping.known, _closed_ranges(trial), stepping.sides, _OVERLAP)
    if overlapping:
        try:
            close_first(stepping, trial, overlapping)
        except LostError as error:
            raise LostError(f"{overlapping[0].contact} touches") from error
        return False
    if passed_through(stepping.model, stepping.known, trial):
        raise LostError
    stepping.accept(trial)
    return True


def _closed_ranges(state: State) -> dict[tuple[str, str], tuple[float, float]]:
    """First and last arc length of every closed place, by contact and beam.

    Ends in contact are checked like other places.
    """
    ranges = {}
    for name, touch in state.structure.touches.items():
        if isinstance(touch, Wrap):
            ranges[name, touch.beam] = state.wrap_range(touch)
            continue
        if touch.at is None:
            s = state.places[name, touch.beam]
            ranges[name, touch.beam] = (s, s)
        if isinstance(touch, Meeting):
            sigma = state.places[name, touch.onto]
            ranges[name, touch.onto] = (sigma, sigma)
    return ranges
