"""Contact of a beam with itself: which parts face each other, from where, with what force; necks and rolls."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import cprbm
from cprbm.closest import REACH
from cprbm.crossing import own_crossings
from cprbm.first_contact import NO_ROWS, Rows
from cprbm.kinematics import State, positions
from cprbm.local import local_step
from cprbm.newton import local_system_at, newton_step
from cprbm.point import contact_gradient, point_at
from cprbm_scene import Ending, SceneError, scene_from
from tests.cprbm import necks
from tests.cprbm.rolled import MODULUS, NARROWS, THICKNESS, WIDTH, coil, hooked, nearly_closed, neck, roll, strip
from tests.references import rolled as rolled_strip
from tests.references.pressed_column import closed, closing, curvatures

FORCE = 100.0  # P, E·I/L²


def faced(angle, thickness, **settings):
    mechanism, state = strip(angle, thickness, **settings)
    at = positions(mechanism.problem.model, state)
    pair = mechanism.pairs["lap"]
    return pair, state, at, pair.facing(state, at)


@pytest.mark.parametrize("turns", [0.2, 0.49, 0.9, 0.99])
@pytest.mark.parametrize("links", [12, 40])
def test_an_arc_does_not_touch_itself_however_thick(turns, links):
    # reference: of the places of a circle the diametral one is the farthest, and those beside are parts of the same;
    # only its ends may come near each other, head-on, and are a chord apart
    pair, state, at, found = faced(lambda s: 2.0 * np.pi * turns * s, 0.09, links=links)
    assert found.strands == ()
    assert found.tip is None
    chord = np.sin(np.pi * turns) / (np.pi * turns)
    expected = chord - 0.09 if turns > 0.25 else np.inf
    assert pair.least_gap(state, at) == pytest.approx(expected, abs=3.0 / links**2)
    rows = [group.values for group in pair.groups(state, at)]
    assert len(rows) == (chord < 0.09 + REACH and turns > 0.5)
    assert rows == [] or rows[0] == pytest.approx([-expected], abs=3.0 / links**2)
    elsewhere = replace(at, x=at.x + 0.217, y=at.y - 0.374)
    assert pair.least_gap(state, elsewhere) == pytest.approx(expected, abs=3.0 / links**2)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_has_turned_there_and_back_lies_beyond_something_else(sign):
    # an S of three strands: the outer two run the same way, and neither faces the other; reference: by sight
    def angle(s):
        return sign * np.interp(s, (0.0, 0.3, 0.35, 0.65, 0.7, 1.0), (0.0, 0.0, np.pi, np.pi, 0.0, 0.0))

    _, _, _, found = faced(angle, 0.002, links=240)
    assert {strand.turns for strand in found.strands} == {1, -1}
    for strand in found.strands:
        # on the inside of either bend, which is on its left where it turns to the left
        assert strand.side == strand.turns
        assert np.min(strand.D) == pytest.approx(0.05 * 2.0 / np.pi, rel=0.01)


@pytest.mark.parametrize("mirrored", [1.0, -1.0])
@pytest.mark.parametrize("backwards", [False, True])
def test_from_which_side_strands_face_each_other(mirrored, backwards):
    # references: by sight; a coil's last part lies inside, on the left of its beginning if it turns to the left; drawn
    # from the other end the coil turns on to the left, and its first part lies inside
    def turned(angle):
        return lambda s: mirrored * (angle(1.0) - angle(1.0 - s) if backwards else angle(s))

    bent = faced(turned(neck), 0.01)[3]
    (strand,) = bent.strands
    assert (strand.side, strand.turns) == (-mirrored, -1 * mirrored)
    wound = faced(turned(coil), 0.005)[3]
    side = mirrored if backwards else -mirrored
    assert {(strand.side, strand.turns) for strand in wound.strands} == {(side, 2.0 * mirrored)}


def test_a_coils_side_is_what_it_was_before():
    # as lines: the end of a coil is bent out through the first part; reference: its distance from dense points there
    mechanism, state = strip(coil, 0.005, thick=False, links=60)
    model, pair = mechanism.problem.model, mechanism.pairs["lap"]
    before = pair.facing(state, positions(model, state))
    borders = model.chains[0].borders
    beyond = State(model.rest + coil(borders) - 1.2 * np.maximum(borders - 0.75, 0.0), state.bodies)
    at = positions(model, beyond)
    assert pair.crosses(beyond, at)
    now = pair.seen(before.faces)
    found = now.facing(beyond, at)
    dense, end = found.lines[0].at(np.linspace(0.0, 0.5, 20001)), found.lines[0].at(np.ones(1))
    away = np.min(np.hypot(dense.x - end.x, dense.y - end.y))
    assert away > 0.01
    assert found.tip is not None
    assert pytest.approx(-away, rel=1e-4) == found.tip.D
    assert now.least_gap(beyond, at) <= found.tip.D
    rows = Rows(now.groups(beyond, at))
    assert rows.values[np.argmin(np.abs(rows.arc - found.tip.s))] == pytest.approx(away, rel=1e-4)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_tip_that_hangs_down_to_its_beam_stays_on_its_side(sign):
    # three quarters of a turn, a little less and a little more: reference: by sight, the tip hangs above the start
    def hanging(turn):
        mechanism, state = strip(lambda s: sign * turn * np.clip((s - 0.4) / 0.55, 0.0, 1.0), 0.005)
        return mechanism.pairs["lap"], state, positions(mechanism.problem.model, state)

    pair, state, at = hanging(1.5 * np.pi - 0.02)
    before = pair.facing(state, at)
    assert before.tip is not None
    assert before.tip.side == sign
    _, state, at = hanging(1.5 * np.pi + 0.02)
    now = pair.seen(before.faces).facing(state, at)
    assert now.tip is not None
    assert (now.tip.side, now.fresh) == (sign, np.inf)
    radius = 0.55 / (1.5 * np.pi)
    assert pytest.approx(radius - 0.05, abs=0.04 * radius) == before.tip.D
    assert not pair.seen(before.faces).passed((state, at), [(state, at)], (state, at), 0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_what_is_seen_over_a_part_in_between_is_not_beyond_it(sign):
    # a tip that hangs into a dip of the beam, below its start, which it would see over the edge of the dip; reference:
    # a line that does not cross itself lies nowhere beyond itself
    def angle(s):
        return sign * np.interp(s, (0.0, 0.05, 0.35, 0.9), (0.0, -0.3, -0.3, 4.5))

    pair, state, at, found = faced(angle, 0.002)
    assert not pair.crosses(state, at)
    assert all(np.min(strand.D) > 0.0 for strand in found.strands)
    assert found.tip is not None
    dense = found.lines[0].at(np.linspace(0.0, 0.5, 20001))
    end = found.lines[0].at(np.ones(1))
    away = np.min(np.hypot(dense.x - end.x, dense.y - end.y))
    assert pair.least_gap(state, at) == pytest.approx(away - pair.offset, rel=1e-4)


def test_going_through_itself_is_seen_on_the_way():
    mechanism, state = strip(coil, 0.005)
    model, pair = mechanism.problem.model, mechanism.pairs["lap"]
    outside = State(model.rest + 6.9 * model.chains[0].borders, state.bodies)

    def way(end):
        for part in np.arange(1, 8) / 8.0:
            between = State(state.theta + part * (end.theta - state.theta), state.bodies)
            yield between, positions(model, between)

    begin = (state, positions(model, state))
    seen = pair.seen(pair.facing(*begin).faces)
    assert not seen.passed(begin, way(state), (state, positions(model, state)), 1e-3)
    through = State(model.rest + coil(model.chains[0].borders) - 2.0 * model.chains[0].borders ** 4, state.bodies)
    assert seen.passed(begin, way(through), (through, positions(model, through)), 1e-3)
    # what has not faced anything before and is near at once has come from nobody knows where
    assert pair.passed(begin, way(state), (state, positions(model, state)), 0.02)
    assert not pair.passed(begin, way(outside), (outside, positions(model, outside)), 0.0)


def test_how_deeply_a_line_crosses_itself():
    # references: by sight; 3-4-5 triangles
    loop = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (1.0, -1.0)])
    here, there, depth = own_crossings(loop)
    assert (here.tolist(), there.tolist()) == ([0], [2])
    # the end is 1.25 beyond the crossing at (1.75, 0), at a sine of 0.8
    assert depth == pytest.approx([1.0])
    assert own_crossings(loop[:3])[0].size == 0
    # an end that just comes through lies no deeper
    assert own_crossings(np.array([*loop[:3], (1.74925, -0.001)]))[2] == pytest.approx([0.001])


@pytest.mark.parametrize("held", ["C", "T"])
def test_what_is_before_both_places_carries_nothing(held):
    mechanism, state = strip(neck, 0.012, held=held)
    problem = mechanism.problem
    point = point_at(problem, {}, state, np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    assert np.max(point.rows.values) > 0.0
    point = replace(point, lam=np.where(point.rows.values > 0.0, 3.7, 0.0))
    gradient, chain = contact_gradient(problem.model, point), problem.model.chains[0]
    first = np.min(point.rows.arc[point.lam > 0.0])
    before = np.flatnonzero(chain.s[1:] < first - 1.5 * chain.h)
    assert before.size >= 2
    assert np.all(gradient[before] == 0.0)
    assert np.all(gradient[problem.model.n_links :] == 0.0)
    assert np.max(np.abs(gradient)) > 0.01


@pytest.mark.parametrize(("angle", "thickness"), [(neck, 0.012), (coil, 0.0055), (hooked, 0.2), (nearly_closed, 0.09)])
def test_both_systems_make_the_same_step(angle, thickness):
    # reference: the system without the joints' positions among its unknowns
    mechanism, state = strip(angle, thickness)
    problem = mechanism.problem
    point = point_at(problem, {}, state, np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    point = replace(point, lam=np.where(point.rows.values > 0.0, 0.3, 0.0))
    assert np.any(point.lam > 0.0)
    one, other = newton_step(problem, point), local_step(local_system_at(problem, point), point.lam > 0.0)
    # multipliers that vanish do so but for round-off of what balances: the springs' moments, stiffness N times turns
    floor = np.finfo(float).eps * problem.model.n_links * np.max(np.abs(one[0]))
    for mine, theirs in zip(one, other, strict=True):
        assert mine == pytest.approx(theirs, rel=1e-7, abs=floor + 1e-7 * np.max(np.abs(mine), initial=0.0))


@cache
def pressed(links, thick, which):
    """The column, or half of it, under FORCE, without dimension."""
    scene = getattr(necks, which)(0.01, [FORCE], thick=thick)
    answer = cprbm.answer(scene, cprbm.Settings(links=links if which == "whole" else links // 2))
    assert answer.completed, answer.sentence
    values, length, share = answer.stations[-1].values, necks.LENGTH, 1 if which == "whole" else 2
    unit = necks.rigidity(0.01) / length**2
    moved = values["T.displacement"] if which == "whole" else 2.0 * values["R.displacement"]
    found = {
        "closing": values["neck.closing_load"][0] / unit,
        "contact": values["neck.force"][0] / unit,
        "shortening": abs(moved[0]) / length,
        "energy": share * values["scene.potential_energy"][0] / (unit * length) + FORCE * abs(moved[0]) / length,
        "place": values["neck.centre"][0] / length,
    }
    return answer.stations[-1], found


def expected(thick):
    thickness = 0.01 if thick else 0.0
    found = closed(thickness, FORCE)
    return found, {
        "closing": closing(thickness).force,
        "contact": found.contact,
        "shortening": found.shortening,
        "energy": found.energy,
        "place": found.place,
    }


def test_a_neck_that_closes():
    # reference: both halves by shooting against their mirror, tests.references.pressed_column
    column, exact = expected(True)
    errors = {}
    for links in (40, 80):
        station, values = pressed(links, True, "whole")
        errors[links] = {name: values[name] / exact[name] - 1.0 for name in exact}
        assert station.certificate.holds
        assert station.certificate.smallest_curvature > 1.0
    for name in ("closing", "contact", "shortening", "energy"):
        # of fourth order
        assert abs(errors[80][name]) < 0.12 * abs(errors[40][name]), name
        assert abs(errors[80][name]) < 2e-5, name
    assert abs(errors[80]["place"]) < 2e-4
    values = station.values
    assert values["neck.ends"][0] == values["neck.ends"][1]
    # forces are summed there
    assert values["neck.centre"][0] == pytest.approx(values["neck.ends"][0], rel=1e-14)
    unit = necks.rigidity(0.01) / necks.LENGTH
    assert abs(values["R.reaction_moment"][0]) == pytest.approx(column.moment * unit, rel=5e-4)
    # the middle between two places that are each other's mirror images
    middle = 0.5 * (necks.LENGTH + values["T.displacement"][0])
    assert station.touching["neck"][0, 0] == pytest.approx(middle, rel=1e-4)


def test_half_of_it_against_a_wall_is_the_same():
    # reference: contact of a beam with a rigid edge, and the same shooting
    _, exact = expected(True)
    _, whole = pressed(40, True, "whole")
    _, half = pressed(40, True, "half")
    for name in exact:
        assert half[name] == pytest.approx(exact[name], rel=0.01)
        assert half[name] == pytest.approx(whole[name], rel=0.01)


def test_the_stress_on_both_sides_of_a_neck():
    # reference: curvatures of the shot half, and their mirror images
    column, _ = expected(thick=True)
    station, _ = pressed(80, True, "whole")
    stress = station.values["column.bending_stress"]
    assert stress == pytest.approx(stress[::-1], rel=1e-6)
    s = np.linspace(0.0, 1.0, len(stress))
    half = s <= 0.5
    exact = 0.5 * necks.MODULUS * 0.01 * curvatures(column, s[half])
    assert stress[half] == pytest.approx(exact, abs=2e-3 * np.max(np.abs(exact)))


STRIP = rolled_strip.Strip(*NARROWS, thickness=THICKNESS)
ROLL = (6.0, 8.1, 8.4)


def rolled_values(links, *, backwards):
    answer = cprbm.answer(roll(ROLL, backwards=backwards), cprbm.Settings(links=links))
    assert answer.completed, answer.sentence
    assert all(station.certificate.holds for station in answer.stations)
    unit, values = MODULUS * WIDTH * THICKNESS**3 / 12.0, answer.stations[-1].values
    return {
        "closing": values["lap.closing_load"][0],
        "force": values["lap.force"][0] / unit,
        "place": values["lap.centre"][0],
        "moment": values["tip.reaction_moment"][0] / unit,
        "energy": values["scene.potential_energy"][0] / unit,
        "x": values["T.displacement"][0] + 1.0,
        "y": values["T.displacement"][1],
    }


def test_a_strip_that_is_rolled():
    # reference: Euler's elastica with a force between two unknown places, tests.references.rolled
    first = rolled_strip.first_touch(STRIP, 5.3, 0.16, 0.95)
    found = rolled_strip.touching(STRIP, first, ROLL[-1])
    exact = {
        "closing": first.rotation,
        "force": found.force,
        "place": found.outer,
        "moment": found.moment,
        "energy": found.energy,
        "x": found.tip[0],
        "y": found.tip[1],
    }
    coarse, fine = (rolled_values(links, backwards=False) for links in (80, 160))
    for name, value in exact.items():
        # of fourth order
        assert abs(fine[name] - value) < 0.12 * abs(coarse[name] - value) + 1e-8 * abs(value), name
        assert abs(fine[name] - value) < (1e-5 if name == "force" else 1e-6) * abs(value), name


@pytest.mark.parametrize("backwards", [False, True])
def test_an_end_that_comes_to_lie_on_its_beam(backwards):
    # reference: the same elastica, the force at its end, tests.references.rolled
    narrows = (0.0, 0.3, 0.9, 1.0), (1.0, 0.6, 0.7, 0.3)
    exact = rolled_strip.tip_touching(rolled_strip.Strip(*narrows, THICKNESS), 6.5, 0.1, 0.05)
    unit, errors = MODULUS * WIDTH * THICKNESS**3 / 12.0, []
    for links in (40, 80):
        answer = cprbm.answer(roll((6.3, 6.5), narrows, backwards=backwards), cprbm.Settings(links=links))
        assert answer.completed, answer.sentence
        before, after = (station.values for station in answer.stations)
        assert before["lap.force"][0] == 0.0
        errors.append(
            [
                after["lap.force"][0] / unit / exact.force - 1.0,
                after["tip.reaction_moment"][0] / unit / exact.moment - 1.0,
            ]
        )
        # the end itself is the smaller of both arc lengths if the strip is drawn from there
        place = 0.0 if backwards else exact.outer
        assert after["lap.centre"][0] == pytest.approx(place, abs=5e-4)
    coarse, fine = np.abs(errors)
    # of fourth order
    assert np.all(coarse / fine > 11.0)
    assert np.all(fine < (2e-4, 2e-7))


def test_lines_that_are_rolled_never_pass_through_themselves():
    # reference: the same elastica without thickness closes at 7.09 rad.  Where a line touches itself no distance tells
    # the side: the solve ends there by name, or has a force
    narrows = (0.0, 0.3, 0.9, 1.0), (1.0, 0.75, 0.825, 0.4)
    line = rolled_strip.Strip(*narrows, 0.0)
    first = rolled_strip.first_touch(line, rolled_strip.free(line, 7.0).moment, 0.09, 0.976)
    answer = cprbm.answer(roll((6.5, 7.4, 8.2), narrows, thick=False), cprbm.Settings(links=80))
    for station in answer.stations:
        assert station.values["lap.force"][0] > 0.0 or station.value < first.rotation


def test_a_strip_drawn_from_its_other_end_is_the_same():
    # references: itself, and the shot place on the inner lap; a place is told from where the drawing begins
    forth, back = (rolled_values(20, backwards=backwards) for backwards in (False, True))
    for name in ("closing", "force", "moment", "energy", "x", "y"):
        # meshes are fitted until slopes of the curvature differ by 1e-6
        assert back[name] == pytest.approx(forth[name], rel=1e-6), name
    first = rolled_strip.first_touch(STRIP, 5.3, 0.16, 0.95)
    found = rolled_strip.touching(STRIP, first, ROLL[-1])
    assert back["place"] == pytest.approx(1.0 - found.inner, abs=0.02)


@pytest.mark.parametrize("thick", [True, False])
def test_ends_of_what_is_alike_from_both_slip_by_no_side_unnamed(thick):
    # reference: symmetry; neither end may come to lie inside.  Round ends meet head on, and slip off to a side
    # that is named as left for the state beside
    alike = (0.0, 0.3, 0.7, 1.0), (1.0, 0.6, 0.6, 1.0)
    answer = cprbm.answer(roll((5.0, 5.5, 6.5), alike, thick=thick), cprbm.Settings(links=40))
    assert not answer.completed or answer.gone_over
    assert [station.value for station in answer.stations[:2]] == [5.0, 5.5]
    assert all(station.values["lap.force"][0] == 0.0 for station in answer.stations[:2])


@pytest.mark.parametrize("turns", [(1.03,), (0.97, 1.0, 1.03)])
def test_an_even_strip_that_closes_to_a_circle_presses_its_ends_until_they_slip(turns):
    # reference: M L/(E I) is the angle by which an even strip turns, a circle at 2 pi.  Its ends are t apart then; of a
    # ring that is cut a force F along it opens the cut by 3 pi F R^3/(E I), with errors like t/L.  By symmetry neither
    # end may come to lie inside the other
    unit = MODULUS * WIDTH * THICKNESS**3 / 12.0
    data = roll((1.0,), ((0.0, 1.0), (1.0, 1.0))).model_dump(mode="json", exclude={"file"})
    data["drives"] = {}
    data["loads"] = {"M": {"kind": "moment", "body": "tip"}}
    data["stages"] = [{"name": "roll", "steps": "M", "stations": [turn * 2.0 * np.pi * unit for turn in turns]}]
    data["probes"] = [{"of": "T", "quantity": "displacement"}, {"of": "lap", "quantity": "force"}]
    # what is held against geometry to nine digits of the thickness is solved to more of them than by default
    answer = cprbm.answer(scene_from(data), cprbm.Settings(links=40, tolerance=1e-13))
    assert answer.ending is Ending.BRANCH_ENDS or answer.gone_over
    for turn, station in zip(turns[:-1], answer.stations, strict=False):
        expected = unit * THICKNESS * 8.0 * np.pi**2 / 3.0 if turn == 1.0 else 0.0
        assert station.values["lap.force"][0] == pytest.approx(expected, rel=2.0 * THICKNESS, abs=1e-9)
        if expected:
            shape = station.shapes["strip"]
            apart = np.hypot(shape.x[-1] - shape.x[0], shape.y[-1] - shape.y[0])
            assert apart == pytest.approx(THICKNESS, rel=1e-9)


def test_how_strands_part():
    # reference: second differences of the distance from the same coil's later parts, integrated in steps of 1/20000
    mechanism, state = strip(coil, 0.001, links=120)
    at = positions(mechanism.problem.model, state)
    pair = mechanism.pairs["lap"]
    middles = (np.arange(20000) + 0.5) / 20000.0
    x, y = (np.append(0.0, np.cumsum(part)) / 20000.0 for part in (np.cos(coil(middles)), np.sin(coil(middles))))
    s, step = np.array([0.13, 0.15]), 0.015  # where strands run nearly side by side

    def distance(at_s):
        i = round(20000 * at_s)
        away = np.hypot(x[i + 10000 :] - x[i], y[i + 10000 :] - y[i])
        k = int(np.argmin(away))
        return away[k] if 0 < k < len(away) - 1 else np.nan

    expected = [(distance(one + step) - 2.0 * distance(one) + distance(one - step)) / step**2 for one in s]
    assert pair.parting(state, at, s) == pytest.approx(np.array(expected), rel=0.03)


def test_the_papers_formulation_has_no_form_for_it():
    with pytest.raises(SceneError, match=r"contacts\.lap\.kind.*'beam-self'.*'auto'"):
        cprbm.answer(roll(ROLL), cprbm.Settings(formulation="paper"))
