"""The neutral line's tangents where the theory has shear."""

import numpy as np
import pytest

from fea_reference import Settings
from fea_reference.march import begin
from fea_reference.model import build
from fea_reference.travel import Course, reach
from tests.fea_reference.cantilever import LENGTH, POISSON, THICKNESS, WIDTH, YOUNG, cantilever, force


@pytest.mark.parametrize("elements", [10, 80])
def test_the_line_leans_by_the_angle_of_shear_wherever_in_an_element(elements):
    """Timoshenko's cantilever, small: w' = F s (2 L − s)/(2 EI) + F/(k G A), of which the second does not go with n."""
    thickness, F = 10 * THICKNESS, 1e-3
    scene = cantilever(force(0.0, 1.0), (F,), thickness=thickness)
    settings = Settings(elements=elements, kinematics="shear")
    model = build(scene, settings)
    march = begin(model, settings, ())
    reach(march, Course(0, 1.0), F / model.units.force)

    # beyond the first element, whose tangent at the clamp is the section's, and up to the welded tip's
    zeta = np.linspace(2.0, elements - 2.0, 371)
    tangent = model.line(model.beams[0], march.system.z).at(zeta)[1]
    s, EI = zeta / elements * LENGTH, YOUNG * WIDTH * thickness**3 / 12
    bent = F * s * (2 * LENGTH - s) / (2 * EI)
    sheared = F / (5 / 6 * YOUNG / (2 * (1 + POISSON)) * WIDTH * thickness)
    assert np.arctan2(tangent[1], tangent[0]) - bent == pytest.approx(sheared, rel=1e-3)
