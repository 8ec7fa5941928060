"""Where a branch ends, why, and where the decrease of the energy leads: both solvers beside the exact answers.

Every reference is a module of ``tests.references`` with a test of its own; what an answer may depart by is what
CPRBM's second and the finite elements' fourth order leave at these numbers of links and elements.
"""

from __future__ import annotations

import numpy as np
import pytest

import cprbm
import fea_reference
from cprbm_scene import Ending, Loss, scene_from
from tests.references import columns, deppo
from tests.together import branches
from tests.together.branches import CLAMPED_ARCH, FORCE, HELD, LENGTH, MOMENT, PINNED_ARCH, SNAP, STOPPED_AT, TOGGLE


def by_cprbm(data):
    return cprbm.answer(scene_from(data), cprbm.Settings(links=40))


def by_fea(data):
    return fea_reference.answer(scene_from(data), fea_reference.Settings(elements=16, kinematics="bending"))


SOLVERS = pytest.mark.parametrize(("solve", "within"), [(by_cprbm, 3e-3), (by_fea, 2e-4)], ids=["cprbm", "fea"])


def lost(answer):
    """Of every critical point how stability is lost, and what lets go."""
    return [(critical.loss, critical.what) for critical in answer.critical]


def nothing_lets_go(answer, critical):
    # the curvature comes down to zero; at a fold as the root of what is left of the way, so it is known less well
    first = answer.stations[0].certificate.smallest_curvature
    assert critical.curvature == pytest.approx(0.0, abs=0.01 * first)
    assert critical.left == critical.curvature


def ends(answer, loss, value, within):
    """The answer ends where its branch does, with the stations before."""
    assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
    assert lost(answer) == [(loss, "")]
    assert answer.critical[0].value == pytest.approx(value, rel=within)
    assert answer.critical[0].after is None
    nothing_lets_go(answer, answer.critical[0])
    assert len(answer.stations) == 2


def around(value):
    return [0.5 * value, 0.95 * value, 1.1 * value]


# --------------------------------------------------------------------------------------------------- arches


@SOLVERS
def test_pinned_arch_deflects_sideways(solve, within):
    # reference: arch.py, bifurcation; the symmetric branch goes on to 1.28 times the force
    force = PINNED_ARCH.bifurcation.force
    assert PINNED_ARCH.force_fold.force > 1.25 * force
    answer = solve(branches.arch(PINNED_ARCH.half_angle, "pin", "pin", around(force)))
    ends(answer, Loss.BIFURCATION, force * FORCE, within)


@SOLVERS
def test_pinned_arch_that_is_driven_deflects_sideways(solve, within):
    # reference: arch.py; the antisymmetric change does not move the drive
    way = PINNED_ARCH.bifurcation.displacement
    answer = solve(branches.driven_arch(PINNED_ARCH.half_angle, "pin", "pin", around(way)))
    ends(answer, Loss.BIFURCATION, way * LENGTH, within)


@SOLVERS
def test_clamped_arch_folds(solve, within):
    # reference: arch.py, the largest force of the symmetric branch, which comes before its bifurcation
    force = CLAMPED_ARCH.force_fold.force
    answer = solve(branches.arch(CLAMPED_ARCH.half_angle, "weld", "weld", around(force)))
    ends(answer, Loss.FOLD, force * FORCE, within)


@SOLVERS
def test_clamped_arch_that_is_driven_deflects_sideways(solve, within):
    # reference: arch.py: a drive passes the largest force
    way = CLAMPED_ARCH.bifurcation.displacement
    assert way > 1.5 * CLAMPED_ARCH.force_fold.displacement
    answer = solve(branches.driven_arch(CLAMPED_ARCH.half_angle, "weld", "weld", around(way)))
    # there the arch is bent the most of all of these: CPRBM is 0.50 % short at N = 40, 1.92 % at 20, 0.13 % at 80
    ends(answer, Loss.BIFURCATION, way * LENGTH, 2.0 * within)


@SOLVERS
def test_clamped_and_pinned_arch(solve, within):
    # reference: deppo.py; DaDeppo and Schmidt (1975) give 8.97
    force = deppo.force_fold().force
    answer = solve(branches.arch(deppo.BENCHMARK, "weld", "pin", around(force)))
    ends(answer, Loss.FOLD, force * FORCE, within)


@SOLVERS
def test_clamped_and_pinned_arch_that_is_driven(solve, within):
    # reference: deppo.py
    way = 1.0 - deppo.displacement_fold().place[1]
    answer = solve(branches.driven_arch(deppo.BENCHMARK, "weld", "pin", around(way)))
    ends(answer, Loss.FOLD, way * LENGTH, within)


@pytest.mark.parametrize("kind", ["force", "displacement"])
def test_cprbm_comes_nearer_by_its_fourth_order(kind):
    # reference: arch.py; halving the links' length leaves a sixteenth of the error
    if kind == "force":
        value, unit = PINNED_ARCH.bifurcation.force, FORCE
        data = branches.arch(PINNED_ARCH.half_angle, "pin", "pin", around(value))
    else:
        value, unit = CLAMPED_ARCH.bifurcation.displacement, LENGTH
        data = branches.driven_arch(CLAMPED_ARCH.half_angle, "weld", "weld", around(value))
    answers = [cprbm.answer(scene_from(data), cprbm.Settings(links=n)) for n in (20, 40)]
    errors = [answer.critical[0].value / unit / value - 1.0 for answer in answers]
    assert errors[0] / errors[1] == pytest.approx(16.0, abs=0.5)


# -------------------------------------------------------------------------------------------------- columns


@SOLVERS
def test_cantilever_column(solve, within):
    # reference: columns.py, Euler's load and the elastica; either side may be the one
    euler = columns.critical("cantilever")
    answer = solve(branches.cantilever_column([0.9 * euler, 1.2 * euler]))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.BIFURCATION, "")]
    assert answer.critical[0].value == pytest.approx(euler * FORCE, rel=within)
    nothing_lets_go(answer, answer.critical[0])
    straight, found = (station.values for station in answer.stations)
    exact = columns.bent("cantilever", 1.2 * euler)
    assert straight["T.displacement"] == pytest.approx([0.0, 0.0], abs=1e-9 * LENGTH)
    assert abs(found["tip.rotation"][0]) == pytest.approx(exact.angle, rel=3.0 * within)
    place = np.abs(found["T.displacement"]) / LENGTH
    assert place == pytest.approx([exact.shortening, exact.deflection], rel=6.0 * within)
    assert [station.branch for station in answer.stations] == [0, 1]


@SOLVERS
def test_pinned_column(solve, within):
    # reference: as above
    euler = columns.critical("pinned")
    answer = solve(branches.pinned_column([0.9 * euler, 1.2 * euler]))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.BIFURCATION, "")]
    assert answer.critical[0].value == pytest.approx(euler * FORCE, rel=within)
    found = answer.stations[1].values
    exact = columns.bent("pinned", 1.2 * euler)
    assert abs(found["M.displacement"][1]) == pytest.approx(exact.deflection * LENGTH, rel=6.0 * within)
    assert -found["E.displacement"][0] == pytest.approx(exact.shortening * LENGTH, rel=6.0 * within)


@SOLVERS
def test_a_column_just_before_its_critical_load_is_reached(solve, within):
    # reference: columns.py; the branch ends behind the last station
    euler = columns.critical("pinned")
    answer = solve(branches.pinned_column([0.5 * euler, (1.0 - 2.0 * within) * euler], beyond="stop"))
    assert answer.completed, answer.sentence
    assert not answer.critical


@pytest.mark.parametrize("angle", [0.0, 2.39])
@pytest.mark.parametrize(
    ("solver", "settings"),
    [
        (cprbm.answer, [cprbm.Settings(links=n) for n in (20, 60)]),
        (fea_reference.answer, [fea_reference.Settings(elements=n) for n in (40, 160)]),
    ],
    ids=["cprbm", "fea"],
)
def test_a_column_between_pegs_leans_to_one_side_on_every_mesh(solver, settings, angle):
    # Faint moments (1 + s/l)² per length do the work ∫ (1 + s/l)² w′ ds = −2 ∫ (1 + s/l) w ds/l on a deflection w to
    # the left that vanishes at both ends.  The work is positive to the right.
    loads = [times * columns.critical("pinned") for times in (0.9, 1.2)]
    scene = scene_from(branches.column_between_pegs(loads, angle=angle, gap=2e-3, beyond="jump"))
    for chosen in settings:
        values = solver(scene, chosen).stations[-1].values
        assert values["left.force"][0] == 0.0
        assert values["right.force"][0] > 0.0


@pytest.mark.parametrize(
    ("solver", "settings"),
    [
        (cprbm.answer, [cprbm.Settings(links=n) for n in (20, 50)]),
        (fea_reference.answer, [fea_reference.Settings(elements=40)]),
    ],
    ids=["cprbm", "fea"],
)
def test_a_strip_between_walls_leans_to_one_side_on_every_mesh(solver, settings):
    # Clamped at both ends, the strip touches the upper wall in the middle, and deflects by an antisymmetric w there.
    # The faint moments do the work −2 ∫ s w ds/l².  The work is positive with w > 0 in the first half: the strip
    # presses on the wall before the middle.
    for chosen in settings:
        answer = solver(scene_from(branches.strip_between_walls([0.3, 0.5])), chosen)
        assert lost(answer) == [(Loss.BIFURCATION, "")]
        pressed = answer.stations[-1].values["top.centre"][0]
        assert 0.25 * LENGTH < pressed < 0.45 * LENGTH


def test_a_dome_under_a_plunger_leans_aside_and_comes_back():
    """Reference: the CPRBM; beyond the bifurcation an upright dome is a minimum under loose penalties alone."""
    radius, half = 0.13233, 0.02
    data = {
        "name": "dome",
        "materials": {"steel": {"youngs_modulus": 1.93e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": [-half, 0.0], "B": [half, 0.0]}},
            "plunger": {"motion": "slides", "points": {"P": [0.0, 0.01]}, "along": [0.0, 1.0]},
        },
        "beams": {
            "dome": {
                "curve": {
                    "kind": "arc",
                    "center": [0.0, -radius],
                    "start": [-half, 0.0],
                    "end": [half, 0.0],
                    "direction": "clockwise",
                },
                "thickness": 2e-4,
                "width": 5e-3,
                "material": "steel",
                "start": {"joint": "weld", "point": "A"},
                "end": {"joint": "weld", "point": "B"},
            }
        },
        "contacts": {
            "k": {"kind": "beam-circle", "beam": "dome", "body": "plunger", "center": [0.0, 3.603e-3], "radius": 2e-3}
        },
        "drives": {"v": {"kind": "displacement", "point": "P", "direction": [0.0, -1.0]}},
        "stages": [
            {"name": "on", "steps": "v", "stations": [8e-4, 1.2e-3, 2e-3], "beyond": "jump"},
            {"name": "off", "steps": "v", "stations": [8e-4, 0.0], "beyond": "jump"},
        ],
        "probes": [{"of": "k", "quantity": "force"}],
    }
    scene = scene_from(data)
    found = fea_reference.answer(scene, fea_reference.Settings(elements=24))
    forces, expected = (
        [station.values["k.force"][0] for station in answer.stations]
        for answer in (found, cprbm.answer(scene, cprbm.Settings(links=40)))
    )
    assert found.completed, found.sentence
    assert [critical.loss for critical in found.critical if critical.stage == "on"] == [Loss.BIFURCATION]
    assert forces == pytest.approx(expected, rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("elements", [91, 160])
def test_a_frame_that_sways_bifurcates(elements):
    """Both guided columns of a frame carry π² EI/L² (Euler); round-off near the load makes no fold of it.

    The stretch before the load shortens the columns by π² t²/12L² = 4e-5, and so does the shear.
    """
    column = {"thickness": 0.001, "width": 0.01, "material": "steel"}
    data = {
        "name": "frame",
        "materials": {"steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3}},
        "bodies": {
            "ground": {"motion": "fixed", "points": {"A": [0.0, 0.0], "B": [0.08, 0.0]}},
            "top": {"motion": "free", "points": {"C": [0.0, 0.15], "D": [0.08, 0.15], "M": [0.04, 0.15]}},
        },
        "beams": {
            name: column
            | {"curve": {"kind": "line", "start": [x, 0.0], "end": [x, 0.15]}}
            | {"start": {"joint": "weld", "point": foot}, "end": {"joint": "weld", "point": head}}
            for name, x, foot, head in (("left", 0.0, "A", "C"), ("right", 0.08, "B", "D"))
        },
        "loads": {"P": {"kind": "force", "point": "M", "direction": [0.0, -1.0]}},
        "stages": [{"name": "press", "steps": "P", "stations": [70.0, 130.0, 160.0]}],
        "probes": [{"of": "M", "quantity": "displacement"}],
    }
    euler = 2.0 * np.pi**2 * 2e11 * 0.01 * 0.001**3 / 12.0 / 0.15**2
    for answer in (
        fea_reference.answer(scene_from(data), fea_reference.Settings(elements=elements, kinematics="shear")),
        cprbm.answer(scene_from(data), cprbm.Settings(links=elements)),
    ):
        ends(answer, Loss.BIFURCATION, euler, 5e-4)


# --------------------------------------------------------------------------------------------------- a turn


def is_at(values, state, within):
    """The turned beam's moment and reaction; the clamp's moment on the beam is −M₀."""
    assert values["hub.reaction_moment"][0] == pytest.approx(-state.clamp_moment * MOMENT, abs=20.0 * within * MOMENT)
    assert values["Q.reaction"] == pytest.approx(state.force * FORCE, abs=40.0 * within * FORCE)


@SOLVERS
def test_turned_beam_snaps_there_and_back(solve, within):
    # reference: snap.py; what is above is the image of what hangs below
    fold, turned = SNAP.fold, 0.75
    answer = solve(branches.snap([[0.0, 0.5, turned], [0.0, -turned]]))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.FOLD, "")] * 2
    assert [critical.stage for critical in answer.critical] == ["way0", "way1"]
    there, back = answer.critical
    assert [there.value, back.value] == pytest.approx([fold.clamp, -fold.clamp], rel=within)
    for critical in (there, back):
        nothing_lets_go(answer, critical)
        assert critical.energy == pytest.approx(fold.energy * MOMENT, rel=10.0 * within)
        assert critical.after == pytest.approx(SNAP.above(fold.clamp).energy * MOMENT, rel=10.0 * within)
    assert [station.branch for station in answer.stations] == [0, 0, 1, 1, 2]
    expected = [SNAP.at(0.0), SNAP.at(0.5), SNAP.above(turned), SNAP.above(0.0), SNAP.at(-turned)]
    for station, state in zip(answer.stations, expected, strict=True):
        is_at(station.values, state, within)


@SOLVERS
def test_stop_catches_the_beam_and_lets_it_go(solve, within):
    # reference: snap.py, a fold there, and on the way back a stop that leaves a negative curvature behind
    free, turned = SNAP.let_go(STOPPED_AT), 0.75
    answer = solve(branches.snap([[0.5, turned], [0.6]], stopped_at=STOPPED_AT))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.FOLD, ""), (Loss.STOP, "stop")]
    there, back = answer.critical
    assert [there.value, back.value] == pytest.approx([SNAP.fold.clamp, free.clamp], rel=within)
    assert back.left < 0.0 < back.curvature
    assert back.energy == pytest.approx(free.energy * MOMENT, rel=10.0 * within)
    before, caught, after = (station.values for station in answer.stations)
    held = SNAP.stopped(turned, STOPPED_AT, free)
    assert caught["stop.angle"][0] == pytest.approx(STOPPED_AT, abs=1e-8)
    assert caught["stop.moment"][0] == pytest.approx(held.far_moment * MOMENT, rel=20.0 * within)
    is_at(caught, held, within)
    for values, clamp in ((before, 0.5), (after, 0.6)):
        is_at(values, SNAP.at(clamp), within)
        assert values["stop.angle"][0] == pytest.approx(SNAP.at(clamp).far, abs=5.0 * within)
        assert values["stop.moment"][0] == 0.0


# ---------------------------------------------------------------------------------------------- an obstacle


@SOLVERS
def test_column_that_only_a_circle_holds(solve, within):
    # reference: let_go.py; the circle's force vanishes, and what is left is no minimum
    free = HELD.let_go()
    pressed, beyond = 0.1, 1.5 * free.side_force
    answer = solve(branches.held([pressed, beyond]))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.CONTACT, "touch")]
    critical = answer.critical[0]
    assert critical.stage == "release"
    # Q* is small against the force that holds the column
    assert critical.value == pytest.approx(free.side_force * FORCE, abs=within * FORCE)
    assert critical.left < 0.0 < critical.curvature
    assert critical.energy == pytest.approx(HELD.energy(free) * MOMENT, abs=within * MOMENT)
    fallen = HELD.fallen(free.side_force)
    assert critical.after == pytest.approx(HELD.energy(fallen) * MOMENT, rel=10.0 * within)
    before, after = (station.values for station in answer.stations[2:])
    held = HELD.under(pressed)
    assert before["touch.force"][0] == pytest.approx(held.pressing * FORCE, rel=10.0 * within)
    assert before["touch.centre"][0] == pytest.approx(held.touch * LENGTH, rel=10.0 * within)
    assert after["touch.force"][0] == 0.0
    tip = HELD.fallen(beyond).tip
    assert after["T.displacement"] / LENGTH == pytest.approx([tip[0] - 1.0, tip[1]], rel=10.0 * within)
    assert after["tip.rotation"][0] == pytest.approx(tip[2], rel=10.0 * within)


# ------------------------------------------------------------------------------------------------- a toggle


@SOLVERS
def test_lever_goes_over_the_centre(solve, within):
    # reference: toggle.py, the largest moment, and the lever beyond it
    fold, rest = TOGGLE.fold(), TOGGLE.under(0.0)
    pushed = 1.2 * fold.moment
    answer = solve(branches.toggle([0.0, 0.8 * fold.moment, pushed]))
    assert answer.completed, answer.sentence
    assert lost(answer) == [(Loss.FOLD, "")]
    assert answer.critical[0].value == pytest.approx(fold.moment * MOMENT, rel=within)
    nothing_lets_go(answer, answer.critical[0])
    turned = rest.lever - TOGGLE.beyond(pushed).lever
    assert answer.stations[-1].values["lever.rotation"][0] == pytest.approx(turned, rel=3.0 * within)
    assert [station.branch for station in answer.stations] == [0, 0, 1]


# ------------------------------------------------------------------------------------ where nobody has asked for ends


def unasked(data):
    """The same scene without a word on what to do where a branch ends."""
    return {**data, "stages": [{k: v for k, v in stage.items() if k != "beyond"} for stage in data["stages"]]}


@SOLVERS
def test_an_end_that_nobody_asked_for_is_told_all_the_same(solve, within):
    # reference: arch.py and snap.py; a station beyond is not reached by a jump without a word
    times = 1.37
    clamped, pinned = CLAMPED_ARCH.force_fold.force, PINNED_ARCH.bifurcation.force
    scenes = [
        (branches.arch(CLAMPED_ARCH.half_angle, "weld", "weld", [0.83 * clamped, times * clamped]), Loss.FOLD),
        (branches.arch(PINNED_ARCH.half_angle, "pin", "pin", [0.83 * pinned, times * pinned]), Loss.BIFURCATION),
        (branches.snap([[0.47, min(0.9, 0.66 * times)]]), Loss.FOLD),
    ]
    values = [clamped * FORCE, pinned * FORCE, SNAP.fold.clamp]
    for (data, loss), value in zip(scenes, values, strict=True):
        answer = solve(unasked(data))
        assert answer.ending is Ending.BRANCH_ENDS, answer.sentence
        assert lost(answer) == [(loss, "")]
        assert answer.critical[0].value == pytest.approx(value, rel=within)
        assert answer.critical[0].after is None
        assert len(answer.stations) == 1


@pytest.mark.parametrize(
    ("solver", "sizes"),
    [
        (cprbm.answer, (cprbm.Settings(links=20), cprbm.Settings(links=27))),
        (fea_reference.answer, (fea_reference.Settings(elements=20), fea_reference.Settings(elements=27))),
    ],
    ids=["cprbm", "fea"],
)
def test_two_halves_that_snap_alone_lean_to_one_side_in_both_solvers(solver, sizes):
    # Turned about its middle, a half of a cosine beam is the same half, and it buckles to either side: the mechanism
    # has four branches.  Faint moments (1 + s)² per length do the work −2 ∫ (1 + s) w ds on a half with ends at rest,
    # w the deflection to the left.  The work is positive for a half that bulges to the right: downwards.
    for settings in sizes:
        answer = solver(scene_from(branches.double_cosine()), settings)
        assert lost(answer) == [(Loss.BIFURCATION, "")]
        for shape in answer.stations[-1].shapes.values():
            middle = np.interp(0.5 * shape.s[-1], shape.s, shape.y)
            assert middle < 0.5 * (shape.y[0] + shape.y[-1]) - 0.2 * branches.RISE


def test_a_fold_close_behind_a_bifurcation_is_named_by_both_solvers():
    # reference: the other solver; the fold is 0.6 % of the way to the station behind the bifurcation
    scene = scene_from(branches.uneven_halves())
    answers = (
        cprbm.answer(scene, cprbm.Settings(links=40)),
        fea_reference.answer(scene, fea_reference.Settings(elements=40, kinematics="stretch")),
    )
    assert [lost(answer) for answer in answers] == [[(Loss.BIFURCATION, ""), (Loss.FOLD, "")]] * 2
    values = [[critical.value for critical in answer.critical] for answer in answers]
    assert values[0] == pytest.approx(values[1], rel=2e-5)
