"""How two beams stand to each other free of stress, on lines whose sides and ends are plain."""

import numpy as np
import pytest

import cprbm
from cprbm.curves import neutral_line
from cprbm.mechanism import mechanism_of
from cprbm.model import Fit
from cprbm.section import Section
from cprbm.standing import Attachment, Side, standing
from cprbm_scene import Arc, Line, Polynomial
from tests.cprbm.scenes import hinge

T = 0.02
WALL, TIP = Attachment(-1, (0.0, 0.0), welded=True), Attachment(0, (0.0, 0.0), welded=True)


def section(*thickness):
    return Section(np.linspace(0.0, 1.0, len(thickness)), np.array(thickness), np.ones(len(thickness)), 1.0)


def beam(curve, ends=(None, None), of=(T, T)):
    return Side(neutral_line(curve), section(*of), ends)


def straight(begin, end, *more):
    return beam(Line(kind="line", start=begin, end=end), *more)


FLAT = Line(kind="line", start=(0.0, 0.0), end=(1.0, 0.0))
ARCH = Arc(kind="arc", center=(0.5, 1.2), start=(0.0, 0.7), end=(1.0, 0.7), direction="counterclockwise")
BOWL = Polynomial(kind="polynomial", axis="x", coefficients=(0.2, -0.6, 0.6), range=(0.0, 1.0))


@pytest.mark.parametrize("above", [ARCH, BOWL], ids=["arc", "polynomial"])
@pytest.mark.parametrize("lift", [0.0, -0.049])
def test_a_beam_above_lies_on_the_left_of_one_that_runs_to_the_right(above, lift):
    flat = Line(kind="line", start=(0.0, -lift), end=(1.0, -lift)) if above is BOWL else FLAT
    found = standing(beam(above), beam(flat), 1.0, thick=True)
    assert (found.side, found.across) == (1.0, -1.0)
    found = standing(beam(flat), beam(above), 1.0, thick=True)
    assert (found.side, found.across) == (-1.0, 1.0)


@pytest.mark.parametrize("turn", [0.0, 0.9, 2.3, -2.0])
@pytest.mark.parametrize("above", [0.013, -0.013])
@pytest.mark.parametrize("back", [False, True])
def test_on_which_side_a_beam_lies_is_no_matter_of_where_the_two_begin(turn, above, back):
    # a straight one 1.7 long, and a shorter bowed one beside its far end, that starts a length away or more
    def placed(x, y):
        return (float(np.cos(turn) * x - np.sin(turn) * y), float(np.sin(turn) * x + np.cos(turn) * y))

    center, ends = placed(1.3, above - 0.9), [placed(1.3 - 0.27, above - 0.9 + np.sqrt(0.81 - 0.27**2))]
    ends.append(placed(1.3 + 0.27, above - 0.9 + np.sqrt(0.81 - 0.27**2)))
    start, end = ends[::-1] if back else ends
    way = "counterclockwise" if back else "clockwise"
    bowed = beam(Arc(kind="arc", center=center, start=start, end=end, direction=way))
    level = 0.0 if above > 0.0 else 0.05  # below its ends, or above its crown
    long = straight(placed(0.0, level - 0.05), placed(1.7, level - 0.05))
    side = 1.0 if above > 0.0 else -1.0
    assert standing(bowed, long, 1.7, thick=False).side == side
    assert standing(long, bowed, 1.7, thick=False).side == (side if back else -side)
    assert standing(long, bowed, 1.7, thick=False).across == side


def test_where_beams_are_closest_tells():
    # beyond the end of B its line goes on below A, and A is bent down there: what has no foot tells nothing
    bent = Polynomial(kind="polynomial", axis="x", coefficients=(0.02, 0.0, 0.3, -0.3), range=(0.0, 1.3))
    found = standing(beam(bent), straight((0.0, 0.0), (0.9, 0.0)), 1.3, thick=False)
    assert found.side == 1.0


@pytest.mark.parametrize("gap", [T, T + 1e-6])
@pytest.mark.parametrize("back", [False, True])
def test_ends_are_clamped_where_they_touch_on_one_body(gap, back):
    upper = straight((0.0, gap), (1.0, gap), (WALL, TIP))
    lower = straight((1.0, 0.0), (0.0, 0.0), (TIP, WALL)) if back else straight((0.0, 0.0), (1.0, 0.0), (WALL, TIP))
    touch = gap == T
    assert standing(upper, lower, 1.0, thick=True).clamps == ((touch, touch), (touch, touch))
    # of lines these are far apart
    assert standing(upper, lower, 1.0, thick=False).clamps == ((False, False), (False, False))


def test_ends_on_two_bodies_and_ends_that_are_not_beside_each_other_are_not_clamped():
    upper = straight((0.0, T), (1.0, T), (WALL, TIP))
    for lower in (
        straight((0.0, 0.0), (1.0, 0.0), (TIP, WALL)),
        straight((0.0, 0.0), (1.0, 0.0), (None, None)),
        straight((0.1, 0.0), (0.9, 0.0), (WALL, TIP)),
        straight((0.0, 0.0), (1.0, -0.01), (WALL, TIP)),
    ):
        assert standing(upper, lower, 1.0, thick=True).clamps == ((False, False), (False, False))


def test_edges_of_tapered_beams_lie_along_each_other():
    # each is thinner towards the tip, and its neutral line leans by as much: the edges that touch are level at y = 0
    slope, thick, ends = 0.01, (2.0 * T + 0.02, 2.0 * T), (WALL, TIP)
    begin, end = (0.0, -0.5 * thick[0]), (float(np.sqrt(1.0 - slope**2)), -0.5 * thick[0] + slope)
    lower = straight(begin, end, ends, thick)
    upper = straight((begin[0], -begin[1]), (end[0], -end[1]), ends, thick)
    found = standing(upper, lower, 1.0, thick=True)
    assert (found.side, found.across) == (1.0, -1.0)
    assert found.clamps == ((True, True), (True, True))
    # of one thickness they part from each other
    lower = straight(begin, end, ends, (thick[0], thick[0]))
    assert standing(upper, lower, 1.0, thick=True).clamps == ((False, False), (False, False))


def test_a_further_mesh_is_made_of_what_the_first_was():
    scene, settings = hinge(), cprbm.Settings(links=12)
    first = mechanism_of(scene, settings)
    borders = np.linspace(0.0, 1.0, 13) ** 1.1
    fit = Fit({"beam1": borders}, {})
    again, anew = (mechanism_of(scene, settings, fit, before) for before in (first, None))
    ours, others = again.problem.model, anew.problem.model
    assert ours.outset is first.problem.model.outset
    assert others.outset is not ours.outset
    for name in ("lengths", "rest", "couplings"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(others, name))
    assert again.pairs["contact"].side == anew.pairs["contact"].side


def test_what_lies_beyond_the_other_beams_ends_has_not_been_seen():
    # B goes up from beyond the end of A; A's end has its foot on B
    level, upright = straight((0.0, 0.0), (1.0, 0.0)), straight((1.2, -0.5), (1.2, 0.7))
    assert standing(level, upright, 1.2, thick=True).seen == (True, False)
    assert standing(upright, level, 1.2, thick=True).seen == (False, True)
    # two in one line do not see each other
    assert standing(level, straight((1.2, 0.0), (2.0, 0.0)), 1.0, thick=True).seen == (False, False)
