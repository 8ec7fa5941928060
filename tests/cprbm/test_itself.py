"""Contact of a beam with itself: which parts face each other, from where, with what force; necks and rolls."""

from functools import cache

import numpy as np
import pytest

import cprbm
from cprbm_scene import Ending, SceneError, scene_from
from tests.cprbm import necks
from tests.cprbm.rolled import MODULUS, NARROWS, THICKNESS, WIDTH, roll
from tests.references import rolled as rolled_strip
from tests.references.pressed_column import closed, closing, curvatures

FORCE = 100.0  # P, E·I/L²


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


def test_the_papers_formulation_has_no_form_for_it():
    with pytest.raises(SceneError, match=r"contacts\.lap\.kind.*'beam-self'.*'auto'"):
        cprbm.answer(roll(ROLL), cprbm.Settings(formulation="paper"))
