"""The neck checked by itself: work, statics, and a state that touches with no force."""

import pytest

from tests.references.neck import closed, first_touch, opened

BETA, T = 0.2, 0.02


def test_the_push_is_the_energys_slope():
    """H = −dU/dD of a half, open and closed: what touches does no work, for the mirror stands still."""
    h = 3e-5
    touched = first_touch(BETA, T, 0.14, 0.24)
    states = [opened(BETA, D) for D in (0.3 + h, 0.3, 0.3 - h)]
    assert states[1].push == pytest.approx((states[2].energy - states[0].energy) / (2.0 * h), rel=1e-6)
    states = [closed(BETA, T, touched, D) for D in (0.1 + h, 0.1, 0.1 - h)]
    assert states[1].push == pytest.approx((states[2].energy - states[0].energy) / (2.0 * h), rel=1e-6)
    assert states[1].force > 0.0


def test_the_neck_closes_with_no_force():
    touched = first_touch(BETA, T, 0.14, 0.24)
    just = closed(BETA, T, touched, touched.clamp - 1e-5, 1)
    before = opened(BETA, touched.clamp)
    assert 0.0 < just.force < 0.01
    assert before.push == pytest.approx(touched.push, rel=1e-9)
    assert just.push == pytest.approx(touched.push, rel=1e-3)
    assert just.place == pytest.approx(touched.place, abs=1e-4)
