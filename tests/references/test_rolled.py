"""The rolled strip checked by itself: a circle, work, and statics of the lap that is pressed."""

import numpy as np
import pytest

from tests.references.rolled import Strip, first_touch, free, tip_touching, touching

STRIP = Strip((0.0, 0.3, 0.9, 1.0), (1.0, 0.75, 0.8, 0.4), 0.005)


def test_an_even_strip_is_a_circle():
    at = free(Strip((0.0, 1.0), (1.0, 1.0), 0.005), 5.0)
    assert at.moment == pytest.approx(5.0, rel=1e-12)
    assert at.tip == pytest.approx([np.sin(5.0) / 5.0, (1.0 - np.cos(5.0)) / 5.0], abs=1e-10)
    assert at.energy == pytest.approx(12.5, rel=1e-10)


def test_the_moment_is_the_energys_slope():
    """M = dU/dΘ, while the laps are apart, while they touch, and while the end does."""
    h = 1e-4
    touched = first_touch(STRIP, free(STRIP, 6.8).moment, 0.06, 0.985)
    states = [touching(STRIP, touched, at, 2) for at in (7.6 - h, 7.6, 7.6 + h)]
    assert states[1].moment == pytest.approx((states[2].energy - states[0].energy) / (2.0 * h), rel=1e-6)
    assert states[1].force > 0.0
    narrow = Strip(STRIP.at, (1.0, 0.6, 0.7, 0.3), 0.005)
    states = [tip_touching(narrow, at, 0.15, 0.05) for at in (6.5 - h, 6.5, 6.5 + h)]
    assert states[1].moment == pytest.approx((states[2].energy - states[0].energy) / (2.0 * h), rel=1e-6)
    assert states[1].force > 0.0


def test_the_first_touch_has_no_force():
    touched = first_touch(STRIP, free(STRIP, 6.8).moment, 0.06, 0.985)
    assert touched.moment == pytest.approx(free(STRIP, touched.rotation).moment, rel=1e-10)
    just = touching(STRIP, touched, touched.rotation + 1e-5, 1)
    assert 0.0 < just.force < 1e-3
