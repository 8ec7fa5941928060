"""The step after one that succeeded, where another was refused before: on towards that, and never beyond it."""

import pytest

from cprbm import Settings
from cprbm.following import Follower, Way


@pytest.mark.parametrize(
    ("step", "near", "expected"),
    [
        (0.1, 0.0, 0.1),  # what was refused is far
        (1.0, 0.4, 0.25),  # it was tried from not much farther: half-way
        (1.0, 0.5, 0.5),  # it was tried from twice as far
    ],
)
def test_no_step_goes_beyond_what_was_refused(step, near, expected):
    # reference: bisection of what lies between the minimum at a half of the way and the step refused at its end
    follower = Follower(None, Settings(), None, {}, [])
    assert follower._next(Way("", {}, {}), 0.5, step, 1.0, near) == expected
