"""The reaction as the energy's derivative, and as a multiplier: the real solvers, driven."""

import pytest

from comparisons.choices import Choices
from comparisons.nearby import RHO
from comparisons.pairing import Solvers, paired
from comparisons.verdict import compared
from comparisons.work_energy import WITHIN
from tests.cprbm.driven import driven_hinge
from tests.together.driven import gripper_like, punched

COARSE = Choices(links=8, elements=8, kinematics="bending")
TRUNCATION = 10.0 * RHO**2  # of a smooth force: ρ²/6 times its second derivative in units of F/d²


def reactions(scene):
    comparison = compared(scene, paired(scene, COARSE, Solvers()))
    assert comparison.verdict.completed, comparison.verdict.sentence
    return comparison.reactions


def test_a_force_and_a_moment_are_the_derivative_of_the_energy():
    """A driven displacement, then a driven rotation while that is held; the load stage has none."""
    found = reactions(gripper_like())
    assert [(each.stage, each.unit) for each in found] == [("push", "N"), ("push", "N"), ("turn", "N·m")]
    for each in found:
        assert each.difference == pytest.approx(0.0, abs=TRUNCATION)
        assert each.from_fea == pytest.approx(0.0, abs=0.05)  # eight links
        assert each.floor < 1e-6 * each.scale


def test_a_driven_hinge_with_contact_too():
    for each in reactions(driven_hinge(0.6)):
        assert each.apart is False or each.changes


def test_a_punch_is_apart_only_where_its_contact_closes_or_opens():
    """Down through the gap, and up again; at zero there is none."""
    found = reactions(punched())
    assert [(each.stage, each.station) for each in found] == [
        ("down", 0.001),
        ("down", 0.003),
        ("down", 0.012),
        ("up", 0.005),
    ]
    assert [bool(each.changes) for each in found] == [True, True, False, True]
    for each in found:
        assert each.difference is not None
        assert abs(each.difference) <= WITHIN
