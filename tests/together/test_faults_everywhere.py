"""Every fault, in a solver or in each in turn, on built-in cases with a place for the fault: no comparison says AGREE.

The content of a scene, never the name, picks the cases. The faults:

* *modulus*: Young's moduli are 2 % larger for one solver, in cases where loads or a probe depend on the modulus;
* *contact ignored*: a contact is missing for one solver, and the probes of the contact read as open;
* *contact sign*: inside a solver the side of the other beam, or of a circle, is reversed;
* *curvature*: a solver forgets a tenth of the stress-free curvature; or takes the stress of the whole curvature in
  place of the change;
* *sign of a value*: all probes of a quantity with a sign have the wrong sign;
* *stops early*: the last station is missing, with and without a statement.

A case has two stations of the longest stage, in one theory and with coarse sizes: the first station, and the next
station with a force in every contact (without contacts the last station), before a branch ends. There the right solvers
agree, so the fault alone ends the agreement.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import fea_reference.circle
import fea_reference.contact
import fea_reference.model
from comparisons import cases
from comparisons.case import Comparison, compare
from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.geometry import length, points
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from cprbm_scene import Answer, Arc, BeamContact, CircleContact, Ending, Polynomial, Probe, Scene, StationAnswer
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.together.planted import remembered, stiffer, without_contact

CHOICES = Choices(links=44, elements=20).within("bending")
FIRST_LOOK = Choices(links=14)
SOME = 0.25  # of a contact's largest force
REAL: dict[str, Solver] = {"cprbm": cprbm_answer, "fea": fea_answer}
SIGNED = ("displacement", "rotation", "bending_stress", "reaction", "reaction_moment", "potential_energy")
TOLD_BY_MODULUS = {"force", "bending_stress", "reaction", "reaction_moment", "potential_energy"}

OTHERS = {"five-bar": "test_five_bar, the limits of both solvers", "gripper-driven": "test_gripper, the gripper driven"}
"""Cases whose answers other modules compare, with faults that another case has a place for too."""
SCENES: dict[str, Scene] = {
    name: scene for name in cases.names() if name not in OTHERS and isinstance(scene := cases.asked(name), Scene)
}
EACH = pytest.mark.parametrize("solver", ["cprbm", "fea"])


def in_turn(questions: Iterable[object]) -> list[tuple[object, str]]:
    """Every question to one of both solvers in turn: the verdict treats both answers alike."""
    return [(question, ("fea", "cprbm")[number % 2]) for number, question in enumerate(questions)]


@cache
def thinned(case: str) -> Scene:
    """The case at two stations of the longest stage: the first, and the next with some force in every contact.

    A larger limit of a probe is doubled here.
    """
    scene = SCENES[case]
    number = int(np.argmax([len(stage.stations) for stage in scene.stages]))
    before, stage = scene.stages[:number], scene.stages[number]
    station = stage.stations[-1]
    if scene.contacts:
        forces = tuple(Probe(of=contact, quantity="force") for contact in scene.contacts)
        some = {"stations": stage.stations[:: max(1, len(stage.stations) // 10)], "shown": ()}
        looked = stage.model_copy(update=some if stage.beyond is None else {**some, "beyond": "stop"})
        asked = scene.model_copy(update={"probes": forces, "stages": (*before, looked)})
        found = [each for each in cprbm_answer(asked, FIRST_LOOK).stations if each.stage == stage.name]
        pressing = np.array([[each.values[force.name][0] for force in forces] for each in found])
        enough = (pressing >= SOME * pressing.max(axis=0)).all(axis=1)
        station = found[1 + int(np.argmax(enough[1:]))].value
    stage = stage.model_copy(update={"stations": tuple(dict.fromkeys((stage.stations[0], station))), "shown": ()})
    probes = tuple(
        probe if probe.verdict_limit is None else probe.model_copy(update={"verdict_limit": 2.0 * probe.verdict_limit})
        for probe in scene.probes
    )
    return scene.model_copy(update={"stages": (*before, stage), "probes": probes, "claims": ()})


@cache
def right(case: str) -> Runs:
    return paired(thinned(case), CHOICES, Solvers(), bare=True)


def word(case: str, solver: str, wrong: Answer) -> Word:
    """The verdict with a wrong solver beside the right solver."""
    return compared(case, solver, wrong).verdict.word


def compared(case: str, solver: str, wrong: Answer) -> Comparison:
    """The comparison of a wrong solver with the right solver.

    The fault is equal at all discretisations: every value is the right value plus the fault.
    """
    runs = right(case)
    true = remembered(runs)
    base = getattr(true, solver)(thinned(case), CHOICES)

    def answer(scene: Scene, choices: Choices) -> Answer:
        own = getattr(true, solver)(scene, choices)
        if choices == CHOICES:
            return wrong
        if len(own.stations) > len(wrong.stations):
            return replace(wrong, stations=own.stations[: len(wrong.stations)], events=own.events)
        stations = zip(own.stations, base.stations, wrong.stations, strict=True)
        return replace(wrong, stations=tuple(_as_wrong(*three) for three in stations))

    planted = replace(true, **{solver: answer})
    return compare(paired(thinned(case), CHOICES, planted, bare=True))


def _as_wrong(own: StationAnswer, base: StationAnswer, wrong: StationAnswer) -> StationAnswer:
    values = {
        name: found
        if not own.values[name].shape == base.values[name].shape == found.shape
        else frozen_array(own.values[name] + found - base.values[name])
        for name, found in wrong.values.items()
    }
    return replace(wrong, values=frozendict(values))


def asked(case: str, solver: str) -> Answer:
    """The answer of a solver with all planted faults."""
    return REAL[solver](thinned(case), CHOICES)


def known(case: str, solver: str) -> Answer:
    """The right answer."""
    return right(case).answers[solver]


def altered(answer: Answer, change: Callable[[StationAnswer], StationAnswer]) -> Answer:
    """An answer with a change at every station."""
    return replace(answer, stations=tuple(change(station) for station in answer.stations))


@pytest.mark.parametrize("case", SCENES)
def test_the_right_ones_agree(case):
    verdict = compare(right(case)).verdict
    assert verdict.word is Word.AGREE, verdict.sentence


def tells_the_modulus(scene: Scene) -> bool:
    load = any(stage.steps in scene.loads for stage in scene.stages)
    return load or any(probe.quantity in TOLD_BY_MODULUS for probe in scene.probes)


@pytest.mark.parametrize(
    ("case", "solver"), in_turn(name for name, scene in SCENES.items() if tells_the_modulus(scene))
)
def test_a_modulus_two_per_cent_too_large(case, solver):
    assert word(case, solver, REAL[solver](stiffer(thinned(case)), CHOICES)) is Word.DIFFER


CONTACTS = [(case, contact) for case, scene in SCENES.items() for contact in scene.contacts]


@pytest.mark.parametrize(("question", "solver"), in_turn(CONTACTS))
def test_a_contact_ignored(question, solver):
    case, contact = question
    assert word(case, solver, without_contact(REAL[solver], contact)(thinned(case), CHOICES)) is not Word.AGREE


def sided(scene: Scene) -> frozenset[type]:
    """The kinds of contacts with a signed side; the contact of a beam with itself has none."""
    return frozenset(type(each) for each in scene.contacts.values() if isinstance(each, BeamContact | CircleContact))


# a case for every set of kinds, since the fault is in a function for each kind: the first with the fewest contacts
SIDED = {
    sided(SCENES[name]): name
    for name in sorted(SCENES, key=lambda name: len(SCENES[name].contacts))[::-1]
    if sided(SCENES[name])
}.values()


@pytest.mark.parametrize("case", SIDED)
def test_a_contact_of_the_wrong_sign_in_the_finite_elements(case, monkeypatch):
    assert known(case, "fea").completed
    monkeypatch.setattr(fea_reference.contact, "side_of", _turned(fea_reference.contact.side_of))
    clearance = fea_reference.circle._clearance

    def inside_out(*given: object) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        r, n, g = clearance(*given)
        return r, n, -g

    if any(isinstance(contact, CircleContact) for contact in SCENES[case].contacts.values()):
        monkeypatch.setattr(fea_reference.circle, "_clearance", inside_out)
    assert word(case, "fea", asked(case, "fea")) is not Word.AGREE


def _turned(function: Callable[..., object]) -> Callable[..., object]:
    return lambda *given: -function(*given)


BENT = [
    name
    for name, scene in SCENES.items()
    if any(isinstance(beam.curve, Arc | Polynomial) for beam in scene.beams.values())
]


@pytest.mark.parametrize("case", ["hinge", "gripper"])  # arcs, and a polynomial
def test_a_tenth_of_the_curvature_is_missing_in_the_finite_elements(case, monkeypatch):
    assert known(case, "fea").completed
    whole = fea_reference.model.reference

    def flatter(*given: object) -> object:
        elements = whole(*given)
        return replace(elements, rotation=0.9 * elements.rotation)

    monkeypatch.setattr(fea_reference.model, "reference", flatter)
    assert word(case, "fea", asked(case, "fea")) is not Word.AGREE


@EACH
@pytest.mark.parametrize("case", BENT)
def test_a_stress_of_the_whole_curvature(case, solver):
    scene = thinned(case)

    def change(station: StationAnswer) -> StationAnswer:
        values = dict(station.values)
        for probe in scene.probes:
            if probe.quantity == "bending_stress":
                beam = scene.beams[probe.of]
                s = np.linspace(0.0, length(beam.curve), probe.points)
                E = scene.materials[beam.material].youngs_modulus
                x, y = points(beam.curve, s).T
                angle = np.unwrap(np.arctan2(np.gradient(y, s), np.gradient(x, s)))
                initial = 0.5 * E * beam.thickness_at(s / s[-1]) * np.gradient(angle, s)
                values[probe.name] = frozen_array(values[probe.name] + initial)
        return replace(station, values=frozendict(values))

    assert word(case, solver, altered(known(case, solver), change)) is Word.DIFFER


@EACH
@pytest.mark.parametrize("case", SCENES)
def test_quantities_of_the_wrong_sign(case, solver):
    """All signs at once, since the verdict judges row by row."""
    turned = {probe.name for probe in SCENES[case].probes if probe.quantity in SIGNED}

    def change(station: StationAnswer) -> StationAnswer:
        values = {name: frozen_array(-found if name in turned else found) for name, found in station.values.items()}
        return replace(station, values=frozendict(values))

    rows = compared(case, solver, altered(known(case, solver), change)).rows
    assert {row.probe.quantity for row in rows if row.word is Word.DIFFER} >= {
        probe.quantity for probe in SCENES[case].probes if probe.name in turned
    }


@EACH
@pytest.mark.parametrize("ending", [Ending.COMPLETED, Ending.STEP_TOO_SMALL])
@pytest.mark.parametrize("case", SCENES)
def test_an_early_stop(case, ending, solver):
    found = known(case, solver)
    assert word(case, solver, replace(found, stations=found.stations[:-1], ending=ending)) is Word.UNDECIDED
