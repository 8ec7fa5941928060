"""Error budgets of real answers beside references that neither solver knows."""

import numpy as np
import pytest

from comparisons import cases
from comparisons.bench.measures import at_last_loads
from comparisons.choices import Choices
from comparisons.store import AnswerMemory
from comparisons.studies.budget import Account, Budget, account_of
from tests.fea_reference.cantilever import LENGTH, POISSON, WIDTH, YOUNG, cantilever, force
from tests.references import hinge as reference
from tests.references.small import cantilever_deflection, rectangle_second_moment, timoshenko_cantilever_deflection


@pytest.fixture(scope="module")
def hinge() -> Account:
    scene = at_last_loads(cases.opened("hinge"))
    probes = tuple(probe for probe in scene.probes if probe.name in ("B.displacement", "D.displacement", "BD.rotation"))
    return account_of(scene.model_copy(update={"probes": probes}), Choices(), AnswerMemory())


def test_the_hinges_links_and_rest_are_those_of_the_exact_answer(hinge):
    """Reference: tests.references.hinge, the differential equations by shooting."""
    exact = reference.solve(reference.PAPER, 0.67)
    values = (exact.displacement_B, exact.displacement_D, np.array([exact.rotation]))
    for found, value in zip(hinge.budgets, values, strict=True):
        size = np.linalg.norm(value)
        way = found.row.cprbm - found.row.fea
        along = way / np.linalg.norm(way)
        # the CPRBM's error is a few parts in ten thousand; the limits are known to a thousandth of that
        assert found.parts["links"] == pytest.approx(np.dot(found.row.cprbm - value, along), rel=1e-3)
        assert abs(found.parts["rest"]) < 1e-6 * size
        assert abs(found.parts["rest"]) <= found.rest_uncertainty
        assert sum(found.parts.values()) == pytest.approx(found.row.difference, rel=1e-9)


def test_the_hinges_penalty_goes_with_the_penetration(hinge):
    for found in hinge.budgets:
        assert 0.0 < found.off_line < 0.01 * abs(found.parts["penalty"])


@pytest.mark.parametrize("theory", ["bending", "shear"])
def test_a_straight_cantilever_has_no_parts(theory):
    """Timoshenko's P L³/(3 E I) + P L/(κ G A): a corrected chain has the bending of a linear moment exactly."""
    thickness, links = 0.02, 10
    EI = YOUNG * rectangle_second_moment(thickness, WIDTH)
    GA = YOUNG / (2.0 * (1.0 + POISSON)) * WIDTH * thickness
    P = 1e-5 * EI / LENGTH**2
    scene = cantilever(force(0.0, 1.0), (P,), thickness=thickness)
    found = _of(scene, "tip.displacement", Choices(links=links, elements=10, theory=theory))
    bent = cantilever_deflection(P, LENGTH, EI)
    exact = bent if theory == "bending" else timoshenko_cantilever_deflection(P, LENGTH, EI, GA, 5.0 / 6.0)
    assert found.row.cprbm[1] == pytest.approx(exact, rel=1e-6)
    assert found.row.difference < 1e-7 * bent
    assert all(abs(part) < 1e-7 * bent for part in found.parts.values())


def _of(scene, probe, choices) -> Budget:
    budgets = account_of(scene, choices, AnswerMemory()).budgets
    return next(each for each in budgets if each.row.probe.name == probe)
