"""Orders and limits of both solvers, against elasticas that are known to many digits.

References: tests.references.hinge (a boundary-value problem with one point of contact) and tests.references.wrapped
(a closed form for contact over a length), which import no solver and hold in the theory ``bending``.
"""

from __future__ import annotations

from functools import lru_cache
from statistics import median

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.executor import ALONE
from comparisons.pairing import Solvers
from comparisons.studies.convergence import Convergence, convergence_of
from comparisons.studies.families import Family, size
from cprbm_scene import Scene
from cprbm_scene.curve_records import shape_of
from tests.references import hinge as exact
from tests.together.truths import hinge_truth, wrapped_truth

APART, TOUCHING = (0.201, 0.268), (0.402, 0.67)  # N·m on the hinge, which closes at 0.32
QUIET = 1e-9  # of the scale: below this a change is no matter of discretisation


def _at(case: str, stations: tuple[float, ...]) -> Scene:
    scene = cases.opened(case)
    (stage,) = scene.stages
    return scene.model_copy(update={"stages": (stage.model_copy(update={"stations": stations}),)})


def _converged(scene: Scene, *sizes: int) -> Convergence:
    return convergence_of(scene, sizes, Choices(kinematics="bending"), Solvers(), ALONE)


@pytest.fixture(scope="module")
def hinge() -> Convergence:
    return _converged(_at("hinge", (*APART, *TOUCHING)), 10, 20, 40, 80, 160)


@pytest.fixture(scope="module")
def wrapped() -> Convergence:
    return _converged(_at("wrapped", (97.0, 191.0)), 20, 40, 80, 160)


@pytest.fixture(scope="module")
def gripper() -> Convergence:
    return _converged(_at("gripper", (12.0, 16.0)), 20, 40, 80)


def _families(found: Convergence, method: str) -> dict[tuple[str, float], Family]:
    return {(one.probe, one.station): one for one in found.families if one.solver == method}


@lru_cache
def _solved(moment: float) -> tuple[exact.HingeSolution, float]:
    return exact.solve(exact.PAPER, moment), exact.closing_moment(exact.PAPER)


def _hinge_truth(probe: str, moment: float, arc: np.ndarray | None = None) -> np.ndarray:
    return np.asarray(hinge_truth(*_solved(moment), probe, arc), dtype=float)


SMOOTH = (
    "B.displacement",
    "D.displacement",
    "BD.rotation",
    "A.reaction",
    "C.reaction_moment",
    "scene.potential_energy",
)
CONTACT = ("contact.force", "contact.closing_load")


def _observed(
    families: dict[tuple[str, float], Family], probes: tuple[str, ...], stations: tuple[float, ...], first: int = 0
):
    """All orders from the ``first`` on; of the finest sizes there is none where a change is down to round-off."""
    every = [families[probe, station].orders[first:] for probe in probes for station in stations]
    assert all(orders[0] is not None for orders in every)
    return [order for orders in every for order in orders if order is not None]


@pytest.mark.parametrize("stations", [APART, TOUCHING])
def test_the_order_of_the_cprbm_without_contact_and_with_contact_in_a_point(hinge, stations):
    # theory: the corrected chain has order 4 (docs/method.md), the next term of the error is a few h² of the first.
    # From 20 links on the next term is small, of the contact's probes at the three finest sizes.
    families = _families(hinge, "cprbm")
    found = _observed(families, SMOOTH, stations, first=1)
    if stations is TOUCHING:
        found += _observed(families, CONTACT, stations, first=2)
    assert found == pytest.approx([4.0] * len(found), abs=0.1)


@pytest.mark.parametrize(("probes", "stations"), [(SMOOTH, APART), (("contact.closing_load",), TOUCHING)])
def test_the_order_of_the_elements_before_anything_presses(hinge, probes, stations):
    found = _observed(_families(hinge, "fea"), probes, stations)
    assert found == pytest.approx([4.0] * len(found), abs=0.1)


def test_the_order_of_the_elements_where_a_penalty_presses(hinge):
    # The penetration that is allowed falls with the fourth power of N, what a penalty leaves of it is up to the march:
    # a quarter of that at one size and all of it at the next are two orders more or less.  With 10 elements that would
    # be felt by more than a hundredth of the force; it is held to that, and the order is that from 20 on.
    found = _observed(_families(hinge, "fea"), (*SMOOTH, *CONTACT), TOUCHING, first=1)
    assert median(found) == pytest.approx(4.0, abs=0.05)
    assert 2.0 < min(found) <= max(found) < 6.0


@pytest.mark.parametrize(("probe", "order"), [("C.reaction_moment", 2.0), ("C.reaction", 1.0)])
def test_the_order_of_the_cprbm_at_the_clamp_from_which_it_lies_on_a_circle(wrapped, probe, order):
    # theory: the pressure stands as forces at places a link apart.  The moment of a link's pressure is off by its
    # square; the clamp carries half a link's pressure, so the force that clamp and circle share has the first order.
    found = [order_ for load in (97.0, 191.0) for order_ in _true_orders(wrapped, probe, load)]
    assert found == pytest.approx([order] * len(found), abs=0.15)


def test_the_order_of_the_cprbm_where_it_leaves_a_circle(wrapped):
    # theory: order 2 along a length.  The beam leaves the circle somewhere within a link, at another share of the link
    # in each mesh, so errors fall unevenly: from the coarsest size to the finest they fall at least so fast.
    for probe in ("T.displacement", "tip.rotation", "scene.potential_energy"):
        for load in (97.0, 191.0):
            assert np.mean(_true_orders(wrapped, probe, load)) > 1.9, (probe, load)


@pytest.mark.parametrize("load", [97.0, 191.0])
def test_the_end_of_the_contact_lies_within_two_squares_of_a_link_over_the_length(wrapped, load):
    # theory: order 2 along a length; the reference is the closed form
    values, truth = _families(wrapped, "cprbm")["contact.ends", load].values, wrapped_truth("contact.ends", load)
    length = shape_of(wrapped.scene.beams["beam"].curve).length
    for n, ends in values.items():
        assert np.linalg.norm(ends - truth) < 2.0 * length / n**2, n


def _true_orders(wrapped: Convergence, probe: str, load: float) -> np.ndarray:
    """Orders by which the CPRBM's errors beside the closed form fall from each size to the next."""
    values, truth = _families(wrapped, "cprbm")[probe, load].values, np.asarray(wrapped_truth(probe, load))
    return -np.diff(np.log2([np.linalg.norm(values[n] - truth) for n in sorted(values)]))


def test_the_order_of_the_elements_where_they_lie_on_a_circle(wrapped):
    # Where the beam leaves the circle a point force stands somewhere within an element, and the curvature has a kink:
    # over that element's length h a cubic's curvature is off by h, and the energy by the square of it, h² times h.
    found = _observed(_families(wrapped, "fea"), ("scene.potential_energy",), (97.0, 191.0))
    assert found == pytest.approx([3.0] * len(found), abs=0.15)


def test_the_limits_of_the_hinge_are_the_exact_ones(hinge):
    for method in ("cprbm", "fea"):
        for (probe, station), family in _families(hinge, method).items():
            if probe in ("BD.rotation", "B.displacement", "D.displacement"):
                truth = _hinge_truth(probe, station)
                assert np.linalg.norm(family.found.value - truth) <= 2e-5 * np.linalg.norm(truth), (method, probe)


def test_the_limits_of_the_wrapped_cantilever_are_the_exact_ones(wrapped):
    # the ends of the chain's contact fall unevenly with N, which no limit can follow: their errors are bounded above
    for method, probes in (
        ("cprbm", ("C.reaction_moment", "T.displacement")),
        ("fea", ("contact.ends", "T.displacement")),
    ):
        families = _families(wrapped, method)
        for station in (97.0, 191.0):
            for probe in probes:
                truth = np.asarray(wrapped_truth(probe, station))
                error = np.linalg.norm(families[probe, station].found.value - truth)
                assert error <= 5e-5 * np.linalg.norm(truth), (method, probe, station)


@pytest.mark.parametrize(
    ("case", "method"),
    [("hinge", "cprbm"), ("hinge", "fea"), ("wrapped", "cprbm"), ("wrapped", "fea")],
)
def test_limits_and_sizes_are_as_near_the_truth_as_they_say(request, case, method):
    found = request.getfixturevalue(case)
    shares: list[float] = []
    outside: list[str] = []
    for (probe, station), family in _families(found, method).items():
        if family.found is None or not family.values[family.used[-1]].size:
            continue
        arc = np.array(family.components) if probe.endswith(".bending_stress") else None
        if case == "hinge":
            truth = _hinge_truth(probe, station, arc)
        elif arc is None:
            truth = np.asarray(wrapped_truth(probe, station))
        else:
            truth = wrapped_truth(probe, station)[np.isclose(np.linspace(0.0, 0.0973, 81), arc)]
        assert truth.shape == family.found.value.shape
        for what, value, stated in (
            ("limit", family.found.value, family.found.uncertainty),
            *((f"N = {n}", family.values[n], family.error(n)) for n in family.used),
        ):
            error, may = size(value - truth), size(stated)
            if max(error, may) > QUIET * family.scale:
                shares.append(error / may)
                if error > may:
                    outside.append(f"{probe} at {station:g}, {what}: {error / may:.2f}")
    assert len(shares) > 60
    assert len(outside) <= 0.05 * len(shares), outside
    assert median(shares) >= 0.1
