"""Beams that lie on each other's far side: through each other, or round an end."""

import numpy as np
import pytest

import cprbm
import elastica_reference
from cprbm.crossing import cross
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import rest_state
from cprbm.mechanism import mechanism_of
from cprbm.point import point_at
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH, RIGIDITY, THICKNESS, cantilever_data, force

UNIT = RIGIDITY / LENGTH**2


def line(*points):
    return np.array(points, dtype=float)


@pytest.mark.parametrize("piece", [0, 63, 64, 150, 198])
def test_a_crossing_is_found_in_whichever_piece_of_long_lines_it_is(piece):
    """By construction: a straight line of 199 pieces, and a cut across the middle of one of them."""
    x = np.linspace(0.0, 1.0, 200)
    line = np.stack((x, np.zeros(200)), axis=1)
    across = np.stack((np.full(200, 0.5 * (x[piece] + x[piece + 1])), np.linspace(-0.31, 0.47, 200)), axis=1)
    assert cross(line, across)
    assert cross(across, line)
    short = across[across[:, 1] > 0.0]
    assert not cross(line, short)
    assert not cross(short, line)


def test_lines_cross_where_a_piece_of_each_has_the_others_ends_on_both_sides():
    # references: by sight
    bent = line((0.0, 0.0), (1.0, 0.1), (2.0, -0.3), (3.0, 0.0))
    assert cross(bent, line((1.4, -1.0), (1.6, 1.0)))
    assert cross(line((9.0, 9.0), (1.4, -1.0), (1.6, 1.0)), bent)
    # above one end and below the other, but round it
    assert not cross(bent, line((2.5, 1.0), (3.2, 0.5), (3.2, -0.5), (2.5, -1.0)))
    # each continued would meet the other
    assert not cross(line((0.0, 0.0), (1.0, 0.0)), line((0.5, 0.1), (0.5, 2.0)))
    assert not cross(line((0.0, 0.0), (1.0, 0.0)), line((2.0, -1.0), (2.0, 1.0)))


def beside_another(other, pressed, stations, *, thick, thicker=1.0):
    """A cantilever, pressed at its tip, and another from one place to another, all over the first one's length."""
    begin, end = (np.array(place) * LENGTH for place in other)
    data = cantilever_data(force(0.0, -1.0), stations)
    if pressed["kind"] == "displacement":
        del data["loads"]
        data["drives"] = {"P": pressed}
    else:
        data["loads"] = {"P": pressed}
    data["bodies"]["wall"]["points"]["Q"] = begin.tolist()
    data["beams"]["other"] = {
        **data["beams"]["beam"],
        "curve": {"kind": "line", "start": begin.tolist(), "end": end.tolist()},
        "thickness": thicker * THICKNESS,
        "start": {"joint": "weld", "point": "Q"},
        "end": {"joint": "free"},
    }
    data["contacts"] = {"contact": {"kind": "beam-beam", "between": ["beam", "other"], "thick": thick}}
    data["probes"] = [
        {"of": "T", "quantity": "displacement"},
        {"of": "tip", "quantity": "rotation"},
        {"of": "contact", "quantity": "force"},
    ]
    return scene_from(data)


def check(scene, links):
    """Against the beams' differential equations at every station that is reached; the values there.

    A place that comes to an end of the other beam ends the solve by name until sides change there.
    """
    answer, reference = cprbm.answer(scene, cprbm.Settings(links=links)), elastica_reference.answer(scene)
    assert reference.completed, reference.sentence
    for ours, true in zip(answer.stations, reference.stations, strict=False):
        for name, values in true.values.items():
            scale = {"T.displacement": LENGTH}.get(name, 1.0)
            assert ours.values[name] == pytest.approx(values, rel=2.0 / links**2, abs=2.0 / links**2 * scale)
    return [station.values for station in answer.stations]


@pytest.mark.parametrize("thick", [False, True])
def test_a_tip_goes_down_beside_a_tip_that_is_then_above_it(thick):
    pressed = {"kind": "force", "point": "T", "direction": [0.0, -1.0]}
    stations = [UNIT * times for times in (0.47, 1.41, 2.81, 4.7)]
    found = check(beside_another(((0.82, -0.66), (1.07, -0.1)), pressed, stations, thick=thick), 20)
    # the other's tip is never touched
    assert all(values["contact.force"][0] == 0.0 for values in found)


def test_a_tip_slides_along_a_beam_whose_further_part_it_turns_its_back_on():
    pressed = {"kind": "displacement", "point": "T", "direction": [-0.58, -0.81]}
    stations = [LENGTH * share for share in (0.046, 0.124, 0.216, 0.309, 0.38, 0.45)]
    other = ((1.106, -0.175), (-0.112, -0.036))
    found = check(beside_another(other, pressed, stations, thick=True, thicker=1.7), 20)
    assert found[0]["contact.force"][0] == 0.0


@pytest.mark.parametrize("links", [20, 37])
@pytest.mark.parametrize("thick", [False, True])
@pytest.mark.parametrize("end", [(0.45, -0.6), (0.1, -0.5)])
def test_a_beam_is_drawn_over_the_root_of_another_that_stands_between_its_arms(end, thick, links):
    # what hangs on the far side has come there round the root, and touches nothing else
    pressed = {"kind": "force", "point": "T", "direction": [-0.3, -1.0]}
    scene = beside_another(
        ((0.5 if end[0] > 0.4 else 0.45, -0.05), end), pressed, [3.0 * UNIT, 15.0 * UNIT], thick=thick
    )
    check(scene, links)


@pytest.mark.parametrize(
    ("begin", "end", "through"), [((1.5, -0.1), (0.5, -0.1), True), ((1.5, -0.1), (1.2, -0.1), False)]
)
def test_a_step_that_leads_through_a_beam_is_told_from_one_round_its_end(begin, end, through):
    """A tip goes down by 0.7 of its beam's length, through another or past its end."""
    pressed = {"kind": "force", "point": "T", "direction": [0.0, -1.0]}
    mechanism = mechanism_of(beside_another((begin, end), pressed, [UNIT], thick=True), cprbm.Settings(links=20))
    apart, pair = mechanism.without("contact"), mechanism.pairs["contact"]
    rest = point_at(apart, {}, rest_state(apart.model), np.zeros(apart.closure.rows), np.zeros(0), NO_ROWS)
    bent = equilibrium(apart, {"P": 4.7 * UNIT}, rest, 1e-11, 50)
    assert bent.converged
    for point in (rest, bent.point):
        assert pair.least_gap(point.state, point.at) > 0.0
    assert mechanism.passed(rest, bent.point) == ("contact" if through else "")
