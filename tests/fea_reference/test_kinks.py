"""A gap with a kink at its least value, which is one of the places at which it is known."""

import numpy as np
import pytest

from fea_reference.zones import Gap, survey

KINK, LEAST = 1.37, -0.013


@pytest.mark.parametrize("steep", [(-0.7, 0.9), (-0.3, 0.3), (-2.1, 0.11)])
@pytest.mark.parametrize("shown", [0, 1])
def test_a_kink_is_not_sought_by_halving(steep, shown):
    """Straight on both sides of the kink, where the slope is that of one ``shown``; the ends by similar triangles."""
    calls = []

    def at(zeta, _):
        calls.append(zeta.size)
        side = np.where(zeta == KINK, shown, (zeta > KINK).astype(int))
        slope = np.array(steep)[side]
        g = LEAST + slope * (zeta - KINK)
        return Gap(g, slope, np.zeros_like(g), np.zeros_like(g), np.ones(g.shape, dtype=bool))

    places = np.sort(np.append(np.arange(0.0, 3.1, 0.25), KINK))
    found = survey(at, places, at(places, places), np.ones(places.size - 1, dtype=bool), (KINK,))
    assert found.least == LEAST
    assert len(calls) <= 3  # the places, and beside the kink to either side
    zones = found.below(0.0)
    ends = KINK - LEAST / np.array(steep)
    assert [zones.intervals.min(), zones.intervals.max()] == pytest.approx(ends, abs=1e-9)
