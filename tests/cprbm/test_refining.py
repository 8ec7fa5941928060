"""Meshes fitted to contact over a length, coarse meshes to start from, and zones' ends."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from cprbm import Settings
from cprbm.first_contact import NO_ROWS
from cprbm.first_equilibrium import equilibrium
from cprbm.kinematics import State, rest_state
from cprbm.levelling import levelled
from cprbm.march import March
from cprbm.mechanism import mechanism_of
from cprbm.model import Fit, Kinks, build
from cprbm.point import point_at
from cprbm.refining import BEYOND, SHARE, all_zones, carried_over, coarser, ends_of, fits, fitted, long_ones
from cprbm.zones import Zone
from tests.cprbm.scenes import hinge
from tests.cprbm.test_circle import BEAM, RADIUS, scene_of
from tests.references.wrapped import Wrapped


def marched(links, load=97.0):
    march = March(scene_of([load]), (Settings(links=links),))
    assert march.run()[0].name == "COMPLETED"
    return march


def test_many_links_are_reached_through_quarters_and_few_at_once():
    assert [s.links for s in coarser(Settings(links=80))] == [80]
    family = [s.links for s in coarser(Settings(links=1281))]
    assert family[-1] == 1281
    assert family[0] <= 80
    assert all(fine <= 4 * coarse for coarse, fine in pairwise(family))


def test_beams_with_few_links_keep_some():
    family = coarser(Settings(links={"beam1": 3000, "beam2": 30}))
    assert [s.links_of("beam2") for s in family] == [8, 8, 8, 30]


def test_borders_stand_where_zones_end_and_elements_are_even_between():
    march = marched(40)
    mechanism, point = march.on.mechanism, march.on.point
    zones = all_zones(mechanism, point)
    ends = ends_of(mechanism, zones)
    fit = fitted(mechanism, point, zones, march.on.settings)
    (end,), borders = ends["circle"], fit.borders["beam"]
    # reference: tests.references.wrapped
    assert end == pytest.approx(Wrapped(**BEAM, radius=RADIUS, force=97.0).wrap_length / BEAM["length"], abs=2e-4)
    k = int(np.argmin(np.abs(borders - end)))
    assert borders[k] == pytest.approx(end, abs=1e-15)
    assert np.diff(borders[: k + 1]) == pytest.approx(end / k)
    assert np.diff(borders[k:]) == pytest.approx((1.0 - end) / (40 - k))
    model = build(march.scene, march.on.settings, fit)
    assert model.chains[0].sizes.sum() == pytest.approx(1.0)
    assert not fits(mechanism, fit)
    meshed = mechanism_of(march.scene, march.on.settings, fit)
    assert fits(meshed, fit)
    # as soon as one of its borders is to be elsewhere by more than two hundredths of an element
    for border, moved, same in ((3, 0.023, False), (7, -0.023, False), (3, 0.017, True)):
        other = {"beam": fit.borders["beam"].copy()}
        other["beam"][border] += moved / (len(other["beam"]) - 1)
        assert fits(meshed, replace(fit, borders=other)) == same


def test_ends_much_closer_than_an_element_leave_the_elements_even():
    march = marched(40)
    near = {"circle": (Zone(0.5, 0.5001, long=True),)}
    assert fitted(march.on.mechanism, march.on.point, near, march.on.settings) == Fit({}, {})


@pytest.mark.parametrize("links", [20, 40, 46, 80])
def test_a_place_close_to_a_held_end_has_its_share_of_the_elements(links):
    march = marched(links)
    borders = fitted(
        march.on.mechanism, march.on.point, {"circle": (Zone(0.03, 0.03, long=False),)}, march.on.settings
    ).borders
    sizes, share, beyond = np.diff(borders["beam"]), links / SHARE, links / BEYOND
    # the place has elements of one size on either side
    fine = 0.03 / share
    before = int(share + beyond)
    assert sizes[:before] == pytest.approx(fine)
    assert sizes[before + 1 :] == pytest.approx((0.97 - beyond * fine) / (links - share - beyond))
    # the mesh goes evenly with the place
    near = {"circle": (Zone(0.03 + 1e-6, 0.03 + 1e-6, long=False),)}
    moved = fitted(march.on.mechanism, march.on.point, near, march.on.settings).borders["beam"]
    assert np.all(np.abs(moved - borders["beam"]) <= 1.001e-6 * (share + beyond) / share)


def test_a_place_far_from_everything_leaves_the_elements_even():
    march = marched(40)
    far = {"circle": (Zone(0.4, 0.4, long=False),)}
    fit = fitted(march.on.mechanism, march.on.point, far, march.on.settings)
    assert not fit.borders
    assert not fit.ends
    assert list(fit.kinks) == ["circle"]


def test_a_state_carried_to_its_own_mesh_is_itself():
    march = marched(40)
    point = carried_over(march.on.mechanism, march.on.point, march.on.mechanism, march.on.values)
    assert point.state.theta == pytest.approx(march.on.point.state.theta, abs=1e-14)
    assert point.rows.keys == march.on.point.rows.keys


def test_a_state_carried_to_a_finer_mesh_and_back_turns_no_link_by_more_than_the_coarse_mesh_resolves():
    march = marched(40)
    finer = mechanism_of(march.scene, Settings(links=160))
    there = carried_over(march.on.mechanism, march.on.point, finer, march.on.values)
    back = carried_over(finer, there, march.on.mechanism, march.on.values)
    assert back.state.theta == pytest.approx(march.on.point.state.theta, abs=1e-12)
    # what presses lies in the zone
    pressing = there.rows.arc[there.lam > 0.0]
    (zone,) = all_zones(march.on.mechanism, march.on.point)["circle"]
    assert np.all(pressing < zone.end + 1.0 / 160)


@pytest.mark.parametrize(("force", "finer"), [(97.0, 24), (97.0, 30), (191.0, 9), (191.0, 16)])
def test_a_zone_goes_on_from_elements_of_one_size_to_those_of_another(force, finer):
    # reference: tests.references.wrapped; sizes change by up to six times at little more than half of the zone
    end = Wrapped(**BEAM, radius=RADIUS, force=force).wrap_length / BEAM["length"]
    fit = Fit({"beam": np.interp(np.arange(41), [0, finer, 40], [0.0, 0.55 * end, 1.0])}, {})
    mechanism = mechanism_of(scene_of([force]), Settings(links=40), fit)
    problem = mechanism.problem
    point = point_at(problem, {}, rest_state(problem.model), np.zeros(problem.closure.rows), np.zeros(0), NO_ROWS)
    for part in (0.25, 0.5, 0.75, 1.0):
        found = equilibrium(problem, {"P": part * force}, point, 1e-11, 60)
        assert found.converged
        point = found.point
    (zone,) = all_zones(mechanism, point)["circle"]
    assert zone.long
    assert zone.begin == 0.0
    assert zone.end == pytest.approx(end, abs=1e-3)


def test_a_place_is_no_long_zone():
    march = March(hinge(), (Settings(links=40),))
    march.run()
    zones = all_zones(march.on.mechanism, march.on.point)
    assert [len(found) for found in zones.values()] == [1]
    assert long_ones(zones) == {}


def test_the_fitted_mesh_is_that_of_the_same_beam():
    # at rest, and bent at random: the smooth line goes through the same places, whatever the elements
    scene, settings = scene_of([1.0]), Settings(links=30)
    uneven = Fit({"beam": np.interp(np.arange(31), [0, 11, 30], [0.0, 0.4, 1.0])}, {})
    for fit in (Fit({}, {}), uneven):
        mechanism = mechanism_of(scene, settings, fit)
        model = mechanism.problem.model
        chain = model.chains[0]
        state = State(0.8 * np.sin(2.0 * chain.borders), rest_state(model).bodies)
        point = point_at(mechanism.problem, {}, state, np.zeros(mechanism.problem.closure.rows), np.zeros(0), NO_ROWS)
        line = mechanism.pairs["circle"].line(point.state, point.at).at(np.array([0.9]))
        # reference: ∫(cos, sin)(0.8 sin 2s) ds by a fine midpoint sum
        s = (np.arange(200_000) + 0.5) * 0.9 / 200_000
        angle = 0.8 * np.sin(2.0 * s)
        assert line.x[0] == pytest.approx(0.9 * np.mean(np.cos(angle)), abs=3e-4)
        assert line.y[0] == pytest.approx(0.9 * np.mean(np.sin(angle)), abs=3e-4)


def test_a_place_on_a_circle_is_no_matter_of_two_beams_that_lie_on_each_other():
    march = marched(40)
    kinks = Kinks(np.array([0.4]), np.array([1.0]), np.array([-1.0]))
    fit = Fit({}, {}, {"circle": (kinks,)})
    on = march.on
    assert levelled(march.scene, on.settings, on.mechanism, on.point, fit, on.values) is None
