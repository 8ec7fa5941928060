"""The work–energy reaction beside springs, an elastica in closed form, and the multipliers of the CPRBM.

References: energies and forces of springs by hand, M = EIθ/L of a beam in pure bending, and the constraint reaction
of the solver itself, which the solver does not take from energies.
"""

import json
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from comparisons import cases
from comparisons import reactions as module
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.present import curves, json_document
from comparisons.present.case_tables import summary
from comparisons.reactions import (
    EQUILIBRIUM_ALLOWANCE,
    MESH_ALLOWANCE,
    MOST_PERTURBED,
    PERTURBATION,
    Absence,
    perturbed_scene,
    reactions,
)
from comparisons.writing import text_of
from cprbm_scene import Ending, Stage
from cprbm_scene.answer import frozen_array
from cprbm_scene.curves import unit_vector as unit
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import DisplacementDrive
from tests.tables import tables_of
from tests.together.driven import GAP, gripper_like, punched, snapping
from tests.verdict.jumping import Jumping
from tests.verdict.made_up import MadeUp

K, STOP = 70.0, 900.0  # N/m
STOP_AT = 0.006  # m
COARSE = Choices(links=8)


class Spring:
    """Answers with the energy and the force of a spring with a stop at ``at``.

    F = K d^p + STOP max(d − at, 0); ``share`` is a fault of the force, and a ``silent`` stop has no contact.
    """

    def __init__(self, solver="cprbm", *, p=1, at=STOP_AT, share=1.0, until=None, silent=False):
        self.base, self.p, self.at, self.share = MadeUp(solver, 1e-3), p, at, share
        self.until, self.silent = until, silent

    def force(self, d):
        return K * d**self.p + STOP * max(d - self.at, 0.0)

    def energy(self, d):
        return K * d ** (self.p + 1) / (self.p + 1) + 0.5 * STOP * max(d - self.at, 0.0) ** 2

    def __call__(self, scene, choices):
        answer = self.base(scene, choices)
        steps = {stage.name: stage.steps for stage in scene.stages}
        stations = []
        for station in answer.stations:
            values = dict(station.values)
            values["scene.potential_energy"] = frozen_array([self.energy(station.value)])
            drive = scene.drives.get(steps[station.stage])
            pushed = self.share * self.force(station.value)
            if isinstance(drive, DisplacementDrive):
                values[f"{drive.point}.reaction"] = frozen_array(pushed * unit(drive.direction))
            elif drive is not None:
                values[f"{drive.body}.reaction_moment"] = frozen_array([pushed])
            closed = station.value > self.at and not self.silent
            touching = {"stop": frozen_array([[0.0, 0.0]])} if closed else {}
            stations.append(replace(station, values=frozendict(values), touching=frozendict(touching)))
        ending = Ending.COMPLETED if self.until is None else Ending.STEP_TOO_SMALL
        return replace(answer, stations=tuple(stations[: self.until]), ending=ending)


def driven(*stages, **shown):
    """The driven scene with the given stages (drive or load, stations) in place of its own."""
    named = tuple(
        Stage(name=f"{steps}{place}", steps=steps, stations=stations, **shown)
        for place, (steps, stations) in enumerate(stages)
    )
    return gripper_like().model_copy(update={"stages": named})


def comparison_of(scene, cprbm=None):
    return compare(paired(scene, Choices(), Solvers(cprbm or Spring(), Spring("fea", share=1.01))))


def of_one_solver(scene, solver, choices=COARSE):
    """The reactions with the CPRBM's answer also in the place of the finite elements'."""
    answer = solver(scene, choices)
    asked = perturbed_scene(scene)
    return reactions(scene, answer, answer, None if asked is None else solver(asked, choices))


def with_values(answer, changes):
    """The answer with other values, by the value of the station or at all stations."""
    stations = tuple(
        replace(at, values={**at.values, **changes.get(at.value, changes.get("all", {}))}) for at in answer.stations
    )
    return replace(answer, stations=stations)


# The perturbed scene


def test_the_perturbed_scene_has_two_stations_around_every_station_and_its_own_probes(hinge, right):
    scene = perturbed_scene(driven(("push", (0.001, 0.002)), ("pull", (0.5,)), ("push", (-0.004, 0.0))))
    push, pull, back = (stage.stations for stage in scene.stages)
    np.testing.assert_allclose(push, [0.000998, 0.001002, 0.001996, 0.002004, 0.002], rtol=1e-12)
    assert pull == (0.5,)
    np.testing.assert_allclose(back, [-0.004008, -0.003992, -8e-6, 8e-6, 0.0], rtol=1e-12)
    assert push[-1] == 0.002  # exactly: the next stage begins there
    scene = driven(("push", (0.001,)))
    fewer = tuple(probe for probe in scene.probes if probe.quantity != "potential_energy")
    names = [probe.name for probe in perturbed_scene(scene.model_copy(update={"probes": fewer})).probes]
    assert names[0] == "scene.potential_energy"
    assert {"M.reaction", "block.reaction_moment"} < set(names)
    assert "straight.bending_stress" not in names
    # without a reaction probe of a moved drive there is none
    without = tuple(probe for probe in scene.probes if probe.name != "M.reaction")
    without = scene.model_copy(update={"probes": without})
    for unmoved in (hinge, driven(("pull", (0.5,))), driven(("push", (0.0,))), without):
        assert perturbed_scene(unmoved) is None
    comparison = compare(paired(hinge, Choices(), right))
    assert comparison.reactions == ()
    assert json_document.comparison(comparison)["work_energy"] == []
    assert list(curves.reaction_figures(comparison)) == []


def test_the_neighbouring_stations_of_a_long_stage_give_the_derivative_without_a_further_run():
    """The energy of a linear spring is a parabola: the central difference over any even step is the force itself."""
    stations = tuple(1e-4 * place for place in range(1, MOST_PERTURBED + 2))
    few, many, uneven = (driven(("push", values)) for values in (stations[:-1], stations, (0.5e-4, *stations[1:])))
    assert len(perturbed_scene(few).stages[0].stations) == 2 * MOST_PERTURBED + 1
    assert perturbed_scene(many) is None
    found = comparison_of(many).reactions
    assert [at.absence for at in found] == [Absence.NOT_PERTURBED, *[None] * (len(stations) - 2), Absence.NOT_PERTURBED]
    assert all(abs(at.difference) <= at.allowed for at in found[1:-1])
    assert "No value at 2 stations: no even neighbours in a long stage." in summary(many, found)
    assert comparison_of(uneven).reactions[1].absence is Absence.NOT_PERTURBED


# The central difference and its errors


@pytest.mark.parametrize(("steps", "newton"), [("push", "N"), ("turn", "N·m")])
def test_of_a_linear_spring_the_difference_is_exact_at_zero_too(steps, newton):
    comparison = comparison_of(driven((steps, (0.001, 0.004)), (steps, (0.002, -0.003, 0.0))))
    assert [at.station for at in comparison.reactions] == [0.001, 0.004, 0.002, -0.003, 0.0]
    for at in comparison.reactions:
        assert at.unit == newton
        assert at.multiplier == pytest.approx(K * at.station, rel=1e-12)
        assert at.work_energy == pytest.approx(K * at.station, rel=1e-9, abs=1e-9)
        assert at.from_fea == pytest.approx(-0.01 * np.sign(at.station), rel=1e-9)
        assert at.truncation < 1e-12 * at.scale
        assert not at.apart
    at = comparison.reactions[0]
    # certificates of 1e-13, twice the energy K d²/2, over 2ρd
    assert at.share(at.round_off) == pytest.approx(1e-13 / (2.0 * PERTURBATION), rel=1e-3)


def test_the_error_is_of_second_order_and_below_the_stated_truncation(monkeypatch):
    # of a kink without a name, where the slope of F changes by STOP at d + ξh: R − F = STOP h (1 − ξ)²/4, by hand
    d = 0.004
    h = PERTURBATION * d
    for xi in (0.0, 0.2, 0.5, 0.9):
        (at,) = of_one_solver(driven(("push", (d,))), Spring(at=d + xi * h, silent=True))
        error = STOP * h * (1.0 - xi) ** 2 / 4.0
        assert at.work_energy - at.multiplier == pytest.approx(error, rel=1e-3), xi
        assert error <= at.truncation * (1.0 + 1e-6), xi
        assert not at.apart
    # of F = K d³ the error is K d h² without further terms; the leading term is stated with a factor of 1.5
    for rho in (PERTURBATION, PERTURBATION / 2.0):
        monkeypatch.setattr(module, "PERTURBATION", rho)
        (at,) = of_one_solver(driven(("push", (d,))), Spring(p=3))
        error = K * d * (rho * d) ** 2
        assert at.work_energy - at.multiplier == pytest.approx(error, rel=1e-4)
        assert at.truncation == pytest.approx(1.5 * error, rel=1e-4)


def test_a_wrong_multiplier_is_apart_and_named():
    """The contact is open at 2 and 4 mm and closed at 8 mm, where the mesh may move."""
    scene, least = driven(("push", (0.002, 0.004, 0.008))), 2.0 * EQUILIBRIUM_ALLOWANCE
    slight, gross = (comparison_of(scene, Spring(share=1.0 + off)) for off in (least, 2.0 * MESH_ALLOWANCE))
    assert [at.apart for at in slight.reactions] == [True, True, False]
    assert [at.apart for at in gross.reactions] == [True, True, True]
    said = summary(scene, gross.reactions)
    assert "within the allowance at 0 of 3 stations. Beyond the allowance: push0 0.002 m (-0.200 %), " in said


def test_the_forces_of_two_oblique_drives_of_a_point_are_told_apart():
    """3 N along the first and 5 N along the second; the projection of their sum would be another number."""
    scene = snapping()
    oblique = scene.drives["aside"].model_copy(update={"direction": (1.0, -1.0)})
    scene = scene.model_copy(update={"drives": frozendict({**scene.drives, "aside": oblique})})
    whole = 3.0 * np.array([0.0, -1.0]) + 5.0 * np.array([1.0, -1.0]) / np.sqrt(2.0)

    def pushed(scene, choices):
        return with_values(Spring()(scene, choices), {"all": {"T.reaction": frozen_array(whole)}})

    assert [at.multiplier for at in of_one_solver(scene, pushed)] == pytest.approx(4 * [3.0], rel=1e-12)


# The CPRBM itself


def test_a_driven_beam_resists_with_the_moment_of_its_closed_form_and_with_its_multiplier():
    # M = EIθ/L of a clamped strip with a turned end: an elastica with a circle as its shape
    rolled = cases.opened("rolled")
    (strip,) = rolled.beams.values()
    strip = strip.model_copy(update={"width": 0.0155})
    free = rolled.model_copy(
        update={
            "stages": (rolled.stages[0].model_copy(update={"stations": (0.0, 2.0, 4.0)}),),
            "beams": frozendict({"strip": strip}),
            "contacts": frozendict(),
            "probes": tuple(probe for probe in rolled.probes if probe.quantity == "reaction_moment"),
            "claims": (),
        }
    )
    modulus, thickness, length = 2.9e9, 0.0008, 0.24  # of the file
    stiffness = modulus * strip.width * thickness**3 / 12.0 / length
    for at in of_one_solver(free, Solvers().cprbm):
        assert at.work_energy == pytest.approx(stiffness * at.station, abs=1e-9 * at.scale)
    # a driven displacement, then a driven rotation; the mesh does not move, so that no allowance is needed
    found = of_one_solver(gripper_like(), Solvers().cprbm)
    assert [(at.stage, at.unit) for at in found] == [("push", "N"), ("push", "N"), ("turn", "N·m")]
    for at in found:
        # of the equilibrium the certificates leave less than 1e-9 of the force
        assert abs(at.work_energy - at.multiplier) <= at.truncation + at.round_off + 1e-9 * at.scale
        assert 0.0 < at.truncation < 1e-4 * at.scale


def test_a_punch_has_no_value_only_where_its_contact_closes_within_the_step():
    """The circle meets the undeformed beam at d = GAP; at zero it touches nothing and no force is left."""
    scene = punched()
    down, up = scene.stages
    down = down.model_copy(update={"stations": (0.001, GAP, 0.003, 0.012)})
    found = of_one_solver(scene.model_copy(update={"stages": (down, up)}), Solvers().cprbm)
    assert [(at.station, at.absence, at.changes) for at in found] == [
        (0.001, None, ()),
        (GAP, Absence.CONTACT, ("circle",)),
        (0.003, None, ()),
        (0.012, None, ()),
        (0.005, None, ()),
        (0.0, None, ()),
    ]
    assert found[-1].work_energy == pytest.approx(0.0, abs=1e-12)
    assert all(not at.apart for at in found)


# Absence beside events


def test_a_contact_that_closes_within_the_step_is_named_and_its_neighbours_keep_their_values():
    comparison = comparison_of(driven(("push", (0.002, STOP_AT, 0.00602, 0.009)), ("push", (0.0059,))))
    assert {at.station: (at.absence, at.changes) for at in comparison.reactions} == {
        0.002: (None, ()),
        STOP_AT: (Absence.CONTACT, ("stop",)),
        0.00602: (None, ()),  # d₁ is 8 µm behind the stop
        0.009: (None, ()),
        0.0059: (None, ()),
    }
    for at in comparison.reactions:
        assert at.absence or at.work_energy == pytest.approx(Spring().force(at.station), rel=1e-9)


def jumping(**planted):
    """Reactions of the crank that jumps at 70.4° and back at 25.3°, with a station 0.14 % before the jump."""
    scene = cases.opened("prestressed")
    degrees = {"forward": (10.0, 70.3, 75.0, 90.0), "back": (40.0, 30.0, 20.0)}
    stages = tuple(
        stage.model_copy(update={"stations": tuple(map(radians, degrees[stage.name])), "shown": ()})
        for stage in scene.stages
    )
    scene = scene.model_copy(update={"stages": stages, "claims": ()})
    solvers = Solvers(Jumping("cprbm", **planted), Jumping("fea", **planted))
    return compare(paired(scene, Choices(), solvers))


def test_no_difference_is_taken_across_a_jump_a_passed_critical_point_or_a_stop_that_takes_hold():
    """At 70.3° the perturbed run reaches 70.44°, behind the jump; elsewhere M = sin α + C/N² is the derivative."""
    comparison = jumping()
    found = comparison.reactions
    assert [at.absence for at in found] == [None, Absence.BRANCH, None, None, None, None, None]
    assert [at.branch for at in found] == [0, 0, 1, 1, 1, 1, 2]
    for at in found:
        assert at.absence or abs(at.work_energy - at.multiplier) <= at.truncation + 1e-9 * at.scale
    passed = jumping(over=0.05).reactions
    assert [at.absence for at in passed][:4] == [None, Absence.CRITICAL_POINT, None, None]
    assert {at.branch for at in passed} == {0}
    # the moment of one stop is planted in the perturbed state at 75° (1 + ρ) alone
    answers = comparison.runs.answers
    hold = {"stopB.moment": frozen_array([0.1]), "stopC.moment": frozen_array([0.0])}
    free = {"all": {name: frozen_array([0.0]) for name in hold}}
    after = radians(75.0) + PERTURBATION * radians(75.0)
    cprbm = with_values(answers["cprbm"], free)
    at = reactions(comparison.scene, cprbm, cprbm, with_values(answers["cprbm perturbed"], {**free, after: hold}))[2]
    assert (at.absence, at.changes, at.work_energy) == (Absence.CONTACT, ("stopB",), None)


def test_stations_behind_the_end_of_the_perturbed_run_and_an_energy_that_is_no_number_have_no_value():
    def early(scene, choices):
        return Spring(until=3 if len(scene.stages[0].stations) > 3 else None)(scene, choices)

    comparison = comparison_of(driven(("push", (0.001, 0.002, 0.003))), early)
    assert [at.absence for at in comparison.reactions] == [None, Absence.NOT_REACHED, Absence.NOT_REACHED]
    (table,) = [sheet for sheet in tables_of(comparison) if sheet.title.startswith("Reaction at the drive")]
    assert table.note.endswith(f"The perturbed run ended early: {Ending.STEP_TOO_SMALL.value}.")
    assert [row[-1] for row in table.rows] == ["", "perturbed stations not reached", "perturbed stations not reached"]
    runs = comparison_of(driven(("push", (0.001, 0.002)))).runs
    perturbed = runs.answers["cprbm perturbed"]
    nowhere = {perturbed.stations[0].value: {"scene.potential_energy": frozen_array([np.nan])}}
    answers = {**runs.answers, "cprbm perturbed": with_values(perturbed, nowhere)}
    assert [at.absence for at in compare(replace(runs, answers=answers)).reactions] == [Absence.NOT_REACHED, None]


# JSON, table, figure, verdict


@pytest.mark.usefixtures("printed")
def test_json_table_and_figure_show_it():
    comparison = comparison_of(driven(("push", (0.002, STOP_AT)), ("turn", (0.003,))))
    known, without, moment = json.loads(text_of(json_document.comparison(comparison)))["work_energy"]
    assert (known["stage"], known["station"], known["drive"], known["unit"]) == ("push0", 0.002, "push", "N")
    assert (moment["drive"], moment["unit"]) == ("turn", "N·m")
    assert known["difference"] == pytest.approx(known["work_energy"] / known["multiplier"] - 1.0, abs=1e-12)
    assert known["allowed"] == pytest.approx(EQUILIBRIUM_ALLOWANCE + known["truncation"] + known["round_off"])
    assert (known["absence"], known["energies"], known["branch"]) == (None, None, 0)
    assert (without["absence"], without["changes_nearby"]) == ("CONTACT", ["stop"])
    assert [without[key] for key in ("work_energy", "difference", "allowed", "round_off", "truncation")] == 5 * [None]
    tables = [sheet for sheet in tables_of(comparison) if sheet.title.startswith("Reaction at the drive")]
    assert [len(sheet.rows) for sheet in tables] == [2, 1]
    assert tables[0].rows[1][-1] == "contact or stop changes: stop"
    pictures = list(curves.reaction_figures(comparison))
    assert [picture.name for picture in pictures] == ["reaction-push"]  # a single station has no curve
    assert all(picture.png.startswith(b"\x89PNG") for picture in pictures)


def test_the_verdict_does_not_use_it_and_it_needs_the_run_at_n_alone():
    scene = driven(("push", (0.002, 0.004)))
    comparison = comparison_of(scene)
    answers = {name: each for name, each in comparison.runs.answers.items() if name != "cprbm perturbed"}
    without = compare(replace(comparison.runs, answers=answers))
    assert without.verdict == comparison.verdict
    assert without.reactions == ()

    def failing(links):
        return lambda scene, choices: Spring(until=1 if choices.links == links else None)(scene, choices)

    finer, own = comparison_of(scene, failing(80)), comparison_of(scene, failing(40))
    assert finer.verdict.completed  # both compared answers are
    assert len(finer.reactions) == 2
    assert own.reactions == ()
