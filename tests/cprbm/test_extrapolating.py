"""Solves that begin where the branch leads end where solves from rest end."""

import numpy as np
import pytest

import cprbm
from cprbm import Settings
from tests.cprbm.scenes import hinge


def test_contact_that_travels_is_the_same_from_many_stations_and_from_one():
    # reference: the hinge's full moment in one step from rest
    many = [{"name": "load", "steps": "M", "stations": [0.67 * k / 20 for k in range(1, 21)]}]
    one = [{"name": "load", "steps": "M", "stations": [0.67]}]
    warm, cold = (cprbm.answer(hinge(stages=stages), Settings(links=20)).stations[-1] for stages in (many, one))
    for name, value in cold.values.items():
        assert warm.values[name] == pytest.approx(value, rel=1e-7, abs=1e-7 * np.max(np.abs(value), initial=0.0))
