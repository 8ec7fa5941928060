"""Where a branch ends, seen by following it: a fold, a stop that comes before it, a turn sharper than a step.

References: :mod:`tests.references.snap`, a strip without its contact, integrated (:mod:`.faint_contact`), and a branch
that is made up.
"""

from types import SimpleNamespace

import numpy as np
import pytest

import fea_reference
from cprbm_scene import Loss, scene_from
from fea_reference import Settings, following, prepared
from fea_reference.assembly import assemble_ends
from fea_reference.branch import BranchPoint
from fea_reference.curvature import Mode
from fea_reference.following import follow_branch
from fea_reference.travel import Course, reach
from tests.fea_reference import faint_contact
from tests.fea_reference.cantilever import EI, LENGTH, cantilever
from tests.together import branches
from tests.together.branches import SNAP

TURNED = 0.75  # rad; the free beam has snapped before


def turned_to(clamp, stopped_at=None):
    """The march of the beam that hangs below, its clamp turned so far."""
    scene = scene_from(branches.snap([[clamp]], stopped_at=stopped_at))
    march = prepared(scene, Settings(elements=16, kinematics="bending")).march
    assemble_ends(scene, march)
    reach(march, Course(0, TURNED), clamp)
    return march


def test_a_fold_is_found_and_known_as_finely_as_told():
    lost = follow_branch(turned_to(0.5), 0, TURNED, TURNED)
    assert lost.loss is Loss.FOLD
    assert lost.value == pytest.approx(SNAP.fold.clamp, rel=2e-4)
    # λ is even about its fold: where the curvature's zero lies within a 10⁻⁴ of a step, λ is known to its square
    assert lost.uncertainty < 1e-7 * TURNED


def test_a_stop_that_acts_before_the_fold_holds_beyond_it():
    """The beam's far end comes down to the stop's angle at φ = 0.6, before the fold, and stands there as φ grows."""
    march = turned_to(0.5, SNAP.at(0.6).far)
    assert follow_branch(march, 0, TURNED, TURNED) is None
    assert march.closing["stop"] == pytest.approx(0.6, rel=2e-4)
    assert "stop" in march.acting.limits
    assert march.values[0] > 1.05 * SNAP.fold.clamp


def test_a_contact_with_little_force_left_lets_go_and_is_no_fold():
    # reference: faint_contact.py. The following begins where the force is a hundredth of what it was, or less, and the
    # penalty, softer and softer as it goes, has a fold before it has gone
    v = faint_contact.lets_go(0.0033, 24.0, 2e-4, 0.18)
    scene = scene_from(faint_contact.scene([0.0017, 0.0037]))
    (critical,) = fea_reference.answer(scene, Settings(elements=20, kinematics="bending")).critical
    assert (critical.loss, critical.what) == (Loss.CONTACT, "plane")
    assert critical.value == pytest.approx(v, rel=5e-4)
    assert critical.left < 0.0 < critical.curvature


GREENHILL = 7.8373 * EI / LENGTH**3  # A. G. Greenhill (1881): a column clamped below and free above, by its own weight


def column(stations):
    weight = {"kind": "distributed", "beam": "beam", "direction": [-1.0, 0.0]}
    return cantilever(weight, tuple(share * GREENHILL for share in stations))


@pytest.mark.parametrize("elements", [20, 40, 60, 80])
def test_the_march_stands_before_a_station_behind_which_the_branch_ends(elements):
    scene = column([0.9, 0.99])
    march = prepared(scene, Settings(elements=elements)).march
    assemble_ends(scene, march)
    before, target = (share * GREENHILL / march.model.stepped[0].unit for share in (0.9, 0.99))
    reach(march, Course(0, before), before)
    assert follow_branch(march, 0, target, target) is None
    assert before < march.values[0] <= target
    assert march.curvature > 1e-3


@pytest.mark.parametrize("elements", [20, 60, 91])
def test_a_column_reaches_all_stations_before_its_critical_load(elements):
    found = fea_reference.answer(column([0.5, 0.9, 0.99, 1.2]), Settings(elements=elements))
    assert len(found.stations) == 3
    (critical,) = found.critical
    assert critical.loss is Loss.BIFURCATION
    assert critical.value == pytest.approx(GREENHILL, rel=5e-5)


END, RADIUS = 0.137, 0.0021


class Sharp:
    """The branch x = λ, which turns back at END on a circle of RADIUS; its curvature falls to zero there, with dλ/ds.

    Steps longer than RADIUS across the turn come to another branch, stable and beyond.
    """

    def at(self, s):
        straight = (END - RADIUS * (1.0 + np.sqrt(0.5))) * np.sqrt(2.0)
        angle = 0.25 * np.pi + np.clip((s - straight) / RADIUS, 0.0, np.pi)
        way, rate = np.cos(angle), np.sin(angle)
        on, back = min(s, straight), max(s - straight - np.pi * RADIUS, 0.0)
        value = on * np.sqrt(0.5) + RADIUS * (np.sqrt(0.5) - np.cos(angle)) + back * rate
        return self.place(value, min(rate, 0.7), way, rate, s)

    @staticmethod
    def place(value, curvature, way, rate, s):
        return BranchPoint(
            float(value), SimpleNamespace(z=None, s=s, touches=()), Mode(curvature, np.ones(1)), np.array([way]), rate
        )

    def onwards(self, branch, here, length):
        there = self.at(here.system.s + length)
        if length > RADIUS and there.rate != here.rate:
            return self.place(1.7 * END, 1.0, -here.way[0], -here.rate, np.inf)
        return there


def test_a_turn_sharper_than_a_step_is_not_stepped_over(monkeypatch):
    sharp, ends = Sharp(), []
    unit = SimpleNamespace(weights=np.ones(1), weight=1.0, at=lambda value: np.array([value]))
    monkeypatch.setattr(following, "_vanishing_contact", lambda march, load, target, span: None)
    monkeypatch.setattr(following, "_end_slip", lambda march, load, target, span: None)
    monkeypatch.setattr(following, "_branch", lambda march, load, span: unit)
    monkeypatch.setattr(following, "branch_point", lambda branch, value, system, before: sharp.at(0.0))
    monkeypatch.setattr(following, "point_at", sharp.onwards)
    monkeypatch.setattr(following, "_distance", lambda branch, one, other: 0.0)

    def lost(march, branch, first, here, there, length):
        ends.append((here, there))
        return SimpleNamespace(value=here.value, uncertainty=0.0, system=there.system)

    monkeypatch.setattr(following, "_critical_between", lost)
    march = SimpleNamespace(
        saved=lambda: None,
        update_sides=lambda: None,
        loosened=False,
        has_soft_penalty=lambda: False,
        values=np.zeros(1),
        system=SimpleNamespace(z=None, touches=()),
        model=SimpleNamespace(size=1, moving=np.array([True])),
        least_gap=lambda system: np.inf,
        passing_failure=lambda before, system, what: None,
    )
    follow_branch(march, 0, 1.0, 1.0)
    ((here, there),) = ends
    assert here.curvature > 0.0 >= there.curvature
    assert here.value == pytest.approx(END, abs=RADIUS)
    assert there.value == pytest.approx(END, abs=RADIUS)


def test_places_on_two_branches_are_told_apart_at_once():
    # by construction: an arc of one motion, and beyond 0.37 another one, as far away however short the arc between
    seen = []

    def at(s):
        seen.append(s)
        values = np.array([s if s < 0.37 else s + 0.2])
        z = SimpleNamespace(values=values, rest=np.zeros(1))
        curvature = 1.0 if s < 0.37 else -3.0
        return BranchPoint(values[0], SimpleNamespace(z=z), Mode(curvature, np.ones(1)), np.ones(1), 1.0)

    branch = SimpleNamespace(weights=np.full(1, 0.5), weight=0.5, span=1.0)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(following, "point_at", lambda branch, here, length: at(length))
        assert following._critical_between(None, branch, at(0.0), at(0.0), at(0.5), 0.5) is None
    assert len(seen) < 15
