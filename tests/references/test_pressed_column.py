"""The column whose neck closes beside elliptic integrals, the work of its load, and equilibrium of a half."""

from __future__ import annotations

import numpy as np
import pytest

from tests.references.post_buckled import post_buckled
from tests.references.pressed_column import closed, closing, curvatures


@pytest.mark.parametrize("thickness", [0.0, 0.03])
def test_until_it_closes_it_is_the_free_column(thickness):
    # reference: elliptic integrals
    found = closing(thickness)
    free = post_buckled(found.force)
    assert found.contact == 0.0
    assert [found.shortening, found.moment, found.energy, found.height] == pytest.approx(
        [free.shortening, free.moment, free.strain_energy, free.deflection], rel=1e-8
    )


def test_its_load_does_the_work():
    # reference: dU = P dδ by trapezoids between loads; the contact force is across the way and does none
    loads = (120.0, 122.0, 124.0)
    found = [closed(0.01, load) for load in loads]
    work = np.trapezoid(loads, [each.shortening for each in found])
    assert work > 0.05
    assert found[-1].energy - found[0].energy == pytest.approx(work, rel=1e-3)


def test_the_moment_between_clamp_and_touch_is_the_levers():
    # reference: statics; between the clamp and the middle κ falls by P y up to the touch and by Q y beyond
    found = closed(0.01, 150.0)
    at_touch, middle = curvatures(found, np.array([found.place, 0.5]))
    lifted = (found.moment - at_touch) / found.force
    beyond = (at_touch - middle) / (found.force - found.contact)
    assert lifted + beyond == pytest.approx(found.height, rel=1e-8)
    assert found.contact > 50.0
    with pytest.raises(ValueError, match="the neck closes at"):
        closed(0.01, 60.0)
