"""The work–energy reaction beside planted springs, whose energy and force are known."""

import json
from dataclasses import replace
from math import radians

import numpy as np
import pytest

from comparisons import cases, documents, reactions_drawn, sheets
from comparisons.choices import Choices
from comparisons.nearby import RHO, nearby
from comparisons.pairing import Solvers, paired
from comparisons.verdict import compared
from comparisons.work_energy import WITHIN, sentence
from cprbm_scene import Stage
from cprbm_scene.answer import frozen_array
from cprbm_scene.freedoms import unit
from cprbm_scene.frozendict import frozendict
from cprbm_scene.statement import DisplacementDrive
from tests.comparisons.jumping import Jumping
from tests.comparisons.made_up import MadeUp
from tests.together.driven import gripper_like, snapping

K, STOP_AT, STOP = 70.0, 0.006, 900.0  # N/m, m, N/m


def force(d):
    """Of a spring, and of a second one beyond a stop."""
    return K * d + STOP * max(d - STOP_AT, 0.0)


def energy(d):
    return 0.5 * K * d**2 + 0.5 * STOP * max(d - STOP_AT, 0.0) ** 2


class Spring:
    """Answers whose energy and driven force are those of the spring; ``share`` is a fault of the force."""

    def __init__(self, solver="cprbm", *, share=1.0, until=None):
        self.base, self.share, self.until = MadeUp(solver, 1e-3), share, until

    def __call__(self, scene, choices):
        answer = self.base(scene, choices)
        stations = []
        for station in answer.stations:
            stage = next(stage for stage in scene.stages if stage.name == station.stage)
            values = dict(station.values)
            values["scene.potential_energy"] = frozen_array([energy(station.value)])
            drive = scene.drives.get(stage.steps)
            pushed = self.share * force(station.value)
            if isinstance(drive, DisplacementDrive) and f"{drive.point}.reaction" in values:
                values[f"{drive.point}.reaction"] = frozen_array(pushed * unit(drive.direction))
            elif drive is not None and stage.steps == "turn":
                values["block.reaction_moment"] = frozen_array([pushed])
            touching = {"stop": frozen_array([[0.0, 0.0]])} if station.value > STOP_AT else {}
            stations.append(replace(station, values=frozendict(values), touching=frozendict(touching)))
        return replace(answer, stations=tuple(stations[: self.until]))


def driven(*stages):
    """The driven scene with stages of its drives and its load in place of its own."""
    named = tuple(
        Stage(name=f"{steps}{place}", steps=steps, stations=stations) for place, (steps, stations) in enumerate(stages)
    )
    return gripper_like().model_copy(update={"stages": named})


def found(scene, cprbm=None):
    solvers = Solvers(cprbm or Spring(), Spring("fea", share=1.01))
    return compared(scene, paired(scene, Choices(), solvers))


def test_every_station_has_two_beside_it_and_a_stage_ends_where_the_scenes_does():
    scene = nearby(driven(("push", (0.001, 0.002)), ("pull", (0.5,)), ("push", (-0.004, 0.0))))
    assert scene is not None
    push, pull, back = (stage.stations for stage in scene.stages)
    np.testing.assert_allclose(push, [0.000998, 0.001002, 0.001996, 0.002004, 0.002], rtol=1e-12)
    assert pull == (0.5,)
    np.testing.assert_allclose(back, [-0.003992, -0.004008, 0.0], rtol=1e-12)
    assert push[-1] == 0.002  # what follows finds the drive there


def test_the_energy_alone_is_asked_for_whatever_the_scene_asks():
    scene = driven(("push", (0.001,)))
    fewer = scene.model_copy(update={"probes": tuple(p for p in scene.probes if p.quantity != "potential_energy")})
    near = nearby(fewer)
    assert near is not None
    assert [probe.name for probe in near.probes] == ["scene.potential_energy"]


def test_without_a_driven_reaction_nothing_is_asked(hinge, right):
    assert nearby(hinge) is None
    assert nearby(driven(("pull", (0.5,)))) is None
    scene = driven(("push", (0.001,)))
    fewer = scene.model_copy(update={"probes": tuple(p for p in scene.probes if p.name != "M.reaction")})
    assert nearby(fewer) is None
    comparison = compared(hinge, paired(hinge, Choices(), right))
    assert comparison.reactions == ()
    assert documents.comparison(comparison)["work_energy"] == []
    assert reactions_drawn.of_comparison(comparison) == ()


@pytest.mark.parametrize("steps", ["push", "turn"])
def test_the_energies_give_the_springs_force_along_the_drive_or_its_moment(steps):
    """Of a quadratic the central difference is exact; a stage may go back, below zero, and to zero."""
    comparison = found(driven((steps, (0.001, 0.004)), (steps, (0.002, -0.003, 0.0))))
    assert [each.station for each in comparison.reactions] == [0.001, 0.004, 0.002, -0.003]
    for each in comparison.reactions:
        assert each.unit == ("N" if steps == "push" else "N·m")
        assert each.multiplier == pytest.approx(K * each.station, rel=1e-12)
        assert each.work_energy == pytest.approx(K * each.station, rel=1e-9)
        assert each.fea == pytest.approx(1.01 * K * each.station, rel=1e-12)
        assert each.from_fea == pytest.approx(-0.01 * np.sign(each.station), rel=1e-9)
        assert each.changes == ()
        assert not each.apart
        # certificates of 1e-13, an energy of half the force times d
        assert each.floor / each.scale == pytest.approx(1e-13 / (4.0 * RHO), rel=0.01)


def test_a_contact_that_closes_is_named_within_one_station_and_nowhere_else():
    comparison = found(driven(("push", (0.002, 0.004, 0.007, 0.008)), ("push", (0.005, 0.001))))
    changes = {(each.stage, each.station): each.changes for each in comparison.reactions}
    assert changes == {
        ("push0", 0.002): (),
        ("push0", 0.004): ("stop",),
        ("push0", 0.007): ("stop",),
        ("push0", 0.008): ("stop",),  # it opens again before the next
        ("push1", 0.005): ("stop",),
        ("push1", 0.001): (),
    }


def test_at_a_kink_the_two_are_apart_and_the_sentence_lists_it():
    """At the stop d2 has felt it and d1 has not: STOP (ρd)²/2 of energy over 2ρd."""
    comparison = found(driven(("push", (0.002, STOP_AT, 0.009))))
    kink = comparison.reactions[1]
    assert kink.changes == ("stop",)
    assert kink.difference == pytest.approx(0.25 * STOP * RHO * STOP_AT / force(STOP_AT), rel=1e-6)
    assert kink.apart
    said = sentence(comparison.reactions)
    assert "push0 0.006 (0.643 %)" in said
    assert "within 0.100 % of the multiplier at 1 of 1 stations away" in said


def test_a_multiplier_that_is_wrong_is_told():
    comparison = found(driven(("push", (0.002, 0.004))), Spring(share=1.0 + 2.0 * WITHIN))
    assert [each.apart for each in comparison.reactions] == [True, True]
    assert "at 0 of 2 stations" in sentence(comparison.reactions)


def test_the_forces_of_two_oblique_drives_of_a_point_are_told_apart():
    """3 N along the one and 5 N along the other; their sum's projection would be another number."""
    scene = snapping()
    oblique = scene.drives["aside"].model_copy(update={"direction": (1.0, -1.0)})
    scene = scene.model_copy(update={"drives": frozendict({**scene.drives, "aside": oblique})})
    whole = 3.0 * np.array([0.0, -1.0]) + 5.0 * np.array([1.0, -1.0]) / np.sqrt(2.0)

    def pushed(scene, choices):
        answer = Spring()(scene, choices)
        stations = tuple(
            replace(station, values={**station.values, "T.reaction": frozen_array(whole)})
            for station in answer.stations
        )
        return replace(answer, stations=stations)

    comparison = compared(scene, paired(scene, Choices(), Solvers(pushed, pushed)))
    assert [each.multiplier for each in comparison.reactions] == pytest.approx(4 * [3.0], rel=1e-12)


def test_a_run_beside_that_ends_early_leaves_the_rest_without():
    scene = driven(("push", (0.001, 0.002, 0.003)))

    def early(scene, choices):
        return Spring(until=3 if len(scene.stages[0].stations) > 3 else None)(scene, choices)

    comparison = found(scene, early)
    assert [each.work_energy is None for each in comparison.reactions] == [False, True, True]
    assert "2 stations were not reached" in sentence(comparison.reactions)
    assert len(reactions_drawn.of_comparison(comparison)) == 1
    assert json.loads(documents.text(documents.comparison(comparison)))["work_energy"][2]["work_energy"] is None


def test_it_stands_in_json_in_a_table_and_in_a_figure_of_each_drive_with_a_way():
    comparison = found(driven(("push", (0.002, STOP_AT)), ("turn", (0.003,))))
    data = json.loads(documents.text(documents.comparison(comparison)))["work_energy"]
    assert [(row["stage"], row["station"], row["drive"], row["unit"]) for row in data] == [
        ("push0", 0.002, "push", "N"),
        ("push0", STOP_AT, "push", "N"),
        ("turn1", 0.003, "turn", "N·m"),
    ]
    assert data[1]["changes_nearby"] == ["stop"]
    assert data[1]["difference"] == pytest.approx(data[1]["work_energy"] / data[1]["multiplier"] - 1.0, rel=1e-9)
    tables = [sheet for sheet in sheets.of_comparison(comparison) if sheet.title.startswith("Reaction at the drive")]
    assert [len(sheet.rows) for sheet in tables] == [2, 1]
    assert {len(row) for sheet in tables for row in sheet.rows} == {len(tables[0].headers)}
    pictures = reactions_drawn.of_comparison(comparison)
    assert [picture.name for picture in pictures] == ["reaction-push"]  # of one station alone there is no curve
    assert all(picture.png.startswith(b"\x89PNG") for picture in pictures)


def test_it_stands_though_a_finer_run_fails_and_not_where_one_of_its_own_does():
    scene = driven(("push", (0.002, 0.004)))

    def answers(fails):
        return lambda scene, choices: Spring(until=1 if choices.links == fails else None)(scene, choices)

    finer, own = found(scene, answers(80)), found(scene, answers(40))
    assert not finer.verdict.completed
    assert len(finer.reactions) == 2
    assert own.reactions == ()


def test_the_verdict_does_not_hang_on_it():
    scene = driven(("push", (0.002, 0.004)))
    comparison = found(scene)
    without = compared(scene, replace(comparison.runs, nearby=None))
    assert without.verdict == comparison.verdict
    assert without.reactions == ()


def jumping():
    """Two stages of the crank that jumps at 70.4° and back at 25.3°, with a station 0.14 % before the jump."""
    scene = cases.opened("prestressed")
    degrees = {"forward": (10.0, 70.3, 75.0, 90.0), "back": (40.0, 30.0, 20.0)}
    stages = tuple(
        stage.model_copy(update={"stations": tuple(map(radians, degrees[stage.name])), "shown": ()})
        for stage in scene.stages
    )
    scene = scene.model_copy(update={"stages": stages, "claims": ()})
    return compared(scene, paired(scene, Choices(), Solvers(Jumping("cprbm"), Jumping("fea"))))


def test_no_derivative_is_taken_across_a_jump():
    """At 70.3° the run beside goes on to 70.44° and has jumped; everywhere else M is the derivative on its branch."""
    comparison = jumping()
    near = comparison.runs.nearby
    assert [station.branch for station in near.stations[2:4]] == [0, 1]
    assert [each.jumped for each in comparison.reactions] == [False, True, False, False, False, False, False]
    assert [each.branch for each in comparison.reactions] == [0, 0, 1, 1, 1, 1, 2]
    for each in comparison.reactions:
        assert (each.work_energy is None) is each.jumped
        assert each.jumped or abs(each.difference) < 1e-4
    said = sentence(comparison.reactions)
    assert "At 1 stations the run beside is on another branch" in said
    assert "not reached" not in said
    assert "Largest in forward, branch 1: " in said
    assert [row["branch"] for row in documents.comparison(comparison)["work_energy"]] == [0, 0, 1, 1, 1, 1, 2]


def test_a_stop_that_takes_hold_is_a_change_nearby():
    """The made-up stops hold on the second branch."""
    changes = [each.changes for each in jumping().reactions]
    stops = ("stopB", "stopC")
    assert changes[0] == ()  # contacts may press once it is assembled
    assert changes[1:4] == [stops, stops, ()]
    assert changes[4:] == [(), stops, stops]


def dense(cprbm=None, *, forward=91, back=89):
    """The same crank at every degree, or as far as that, and back."""
    scene = cases.opened("prestressed")
    ways = {"forward": range(forward), "back": range(back, -1, -1)}
    stages = tuple(
        stage.model_copy(update={"stations": tuple(radians(a) for a in ways[stage.name]), "shown": ()})
        for stage in scene.stages
    )
    scene = scene.model_copy(update={"stages": stages, "claims": ()})
    solvers = Solvers(cprbm or Jumping("cprbm"), Jumping("fea"))
    return scene, compared(scene, paired(scene, Choices(), solvers))


def test_close_stations_tell_the_energys_rate_by_themselves():
    """No run stands beside them, zero has a rate too, and nothing is differentiated across the two jumps."""
    scene, comparison = dense()
    assert nearby(scene) is None
    assert comparison.runs.nearby is None
    found = comparison.reactions
    assert len(found) == 181
    assert {each.station for each in found if each.jumped} == {radians(a) for a in (70, 71, 26, 25)}
    assert {each.branch for each in found} == {0, 1, 2}
    for each in found:
        assert each.dense
        assert abs(each.difference) < 1e-7
        assert each.truncation < 1e-4 * each.scale
        assert not each.apart
    said = sentence(found)
    assert "within 0.0100 % of the multiplier at 181 of 181 stations" in said
    assert "Largest in back, branch 2: " in said
    row = documents.comparison(comparison)["work_energy"][0]
    assert (row["energies"], row["allowed"], row["station"]) == ("of the stations", 1e-4, 0.0)


def test_close_stations_find_a_multiplier_that_is_wrong_by_two_ten_thousandths():
    def wrong(scene, choices):
        answer = Jumping("cprbm")(scene, choices)
        stations = tuple(
            replace(at, values={**at.values, "crank.reaction_moment": 1.0002 * at.values["crank.reaction_moment"]})
            if at.stage == "forward" and 0.5 < at.value < 0.6
            else at
            for at in answer.stations
        )
        return replace(answer, stations=stations)

    _, comparison = dense(wrong)
    apart = [each for each in comparison.reactions if each.apart]
    assert [round(np.degrees(each.station)) for each in apart] == [29, 30, 31, 32, 33, 34]
    said = sentence(comparison.reactions)
    assert "Further apart: forward 0.506145 to 0.593412 (6 stations, at most 0.0200 % at 0." in said


def test_a_stretch_of_too_few_stations_is_told():
    """The branch after the jump at 70.4° has the three stations 71° to 73°; the way back begins with it anew."""
    _, comparison = dense(forward=74, back=72)
    without = [each for each in comparison.reactions if each.work_energy is None]
    assert [round(np.degrees(each.station)) for each in without] == [71, 72, 73]
    assert "3 stations are in stretches of fewer than 4 between changes." in sentence(comparison.reactions)


def test_stations_that_are_far_apart_or_without_their_energy_have_a_run_beside_them():
    scene, _ = dense()
    probes = tuple(probe for probe in scene.probes if probe.quantity != "potential_energy")
    assert nearby(scene.model_copy(update={"probes": probes})) is not None
    back = scene.stages[1].model_copy(update={"stations": scene.stages[1].stations[::2]})
    half = nearby(scene.model_copy(update={"stages": (scene.stages[0], back)}))
    assert half is not None
    assert half.stages[0].stations == scene.stages[0].stations
    assert len(half.stages[1].stations) == 2 * 45 + 1


def test_close_and_far_stations_stand_beside_each_other():
    """One stage by itself, the other by a run: each as if it were alone."""
    scene, _ = dense()
    back = scene.stages[1].model_copy(update={"stations": scene.stages[1].stations[9::20]})
    mixed = scene.model_copy(update={"stages": (scene.stages[0], back)})
    comparison = compared(mixed, paired(mixed, Choices(), Solvers(Jumping("cprbm"), Jumping("fea"))))
    assert [each.dense for each in comparison.reactions] == [True] * 91 + [False] * 4
    for each in comparison.reactions:
        assert each.work_energy is not None
        assert abs(each.difference) < 1e-4
    said = sentence(comparison.reactions)
    assert said.startswith("Work–energy with ρ")
    assert "from the stations' own energies" in said
