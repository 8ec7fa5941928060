"""Following a branch, on a circle: where its coordinates vanish is known."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.branch import vanishing

START, UP = np.array([1.0, 0.0]), np.array([0.0, 1.0])


def circle(X, _):
    return np.array([X @ X - 1.0]), 2.0 * X[None, :]


@pytest.mark.parametrize(("along", "end"), [(UP, [0.0, 1.0]), (-UP, [0.0, -1.0])])
def test_first_place_to_either_side(along, end):
    # the place is a fold of the second coordinate: nothing is special there for the branch
    assert vanishing(circle, lambda X, _: X[0], START, along, 0.3, 20) == pytest.approx(end, abs=1e-12)


def test_what_does_not_vanish_is_said():
    with pytest.raises(ValueError, match="no change of sign in 20 steps"):
        vanishing(circle, lambda X, _: X[0] + 1.5, START, UP, 0.3, 20)
