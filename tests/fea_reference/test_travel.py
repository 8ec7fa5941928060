"""Steps along a branch, of a march that is nothing but where it may go: what is cut grows again, what closed is looser.

References: by construction; there is a way that obeys the march's limits, and the steps are to find it.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from cprbm_scene import Ending, Loss
from fea_reference import travel
from fea_reference.following import CriticalPoint
from fea_reference.march import StoppedError
from fea_reference.travel import Course, _step_to

MODEL = SimpleNamespace(moving=np.array([True]), stepped=[SimpleNamespace(unit=1.0)])


@pytest.fixture(autouse=True)
def _energy_is_kept(monkeypatch):
    monkeypatch.setattr(travel, "_released_energy", lambda *step: False)


@dataclass
class Ways:
    """A march over λ in which nothing moves.

    No step over one of the ``narrows`` may be longer than a 500th.  Over one of the ``closings`` there is a way only
    once penalties were loosened since the one before, and there is none over two at once.
    """

    narrows: tuple[float, ...] = ()
    closings: tuple[float, ...] = ()
    values: np.ndarray = field(default_factory=lambda: np.zeros(1))
    penalties: dict[float, float] = field(default_factory=dict)
    loosened: bool = False
    iterations: int = 0
    steps: int = 0
    zones_far: bool = False
    acting: tuple[str, ...] = ()
    last_step: None = None
    previous_point: None = None
    curvature: float = -1.0
    model = MODEL
    settings: SimpleNamespace = field(
        default_factory=lambda: SimpleNamespace(iteration_limit=100000, kinematics="shear")
    )
    largest_axial_force: float = 0.0

    def points_before(self, load):
        return []

    def saved(self):
        return Ways(
            values=self.values.copy(), penalties=dict(self.penalties), loosened=self.loosened, acting=self.acting
        )

    def restore(self, saved):
        self.values, self.penalties, self.loosened = saved.values.copy(), dict(saved.penalties), saved.loosened

    def rate(self, load):
        return np.zeros(1)

    def step(self, load, value, rate):
        self.steps += 1
        self.iterations += 3
        here = self.values[load]
        over, closing = ([p for p in places if here < p <= value] for places in (self.narrows, self.closings))
        if (over and value - here > 0.002) or len(closing) > 1 or (closing and not self.loosened):
            return Ending.STEP_TOO_SMALL, "no way"
        if closing:
            self.penalties[closing[0]], self.loosened = 1.0, False
        self.values[load] = value
        return None

    def loosen(self, *kinds):
        if not self.closings:
            return False
        self.loosened = True
        return True

    def has_deep_tip(self):
        return False

    def step_record(self, load, saved, rate, ahead):
        return None

    def path_tangent(self, load, rate, target):
        return SimpleNamespace(rate=rate)

    def described(self, load, value):
        return f"{value:g}"


WALL = 0.61803


def test_cuts_count_in_a_row_and_a_step_that_was_cut_grows_again():
    march = Ways(narrows=tuple(0.07 * k + 0.0213 for k in range(1, 13)))
    _step_to(march, Course(0, 1.0), 1.0, watched=False)
    assert march.values[0] == 1.0
    assert march.steps < 12 * 25  # at the size of what was cut last it would take 500 or more


def test_penalties_are_loosened_once_for_every_contact_that_closes():
    march = Ways(closings=(0.37, 0.71, 0.93))
    _step_to(march, Course(0, 1.0), 1.0, watched=False)
    assert march.values[0] == 1.0
    assert list(march.penalties) == [0.37, 0.71, 0.93]


def test_where_there_is_no_way_steps_end(monkeypatch):
    monkeypatch.setattr("fea_reference.travel.follow_branch", lambda *asked: None)
    march = Ways(closings=(0.37, 0.37))
    with pytest.raises(StoppedError) as stopped:
        _step_to(march, Course(0, 1.0), 1.0, watched=False)
    assert stopped.value.ending is Ending.STEP_TOO_SMALL
    assert march.values[0] < 0.37
    assert march.steps < 40  # 4⁻¹⁰ is twenty halvings


@dataclass
class Yielding(Ways):
    """A march in which loose penalties let anything through beyond WALL, and tight ones go 0.0004 at a time there.

    Where penalties are ``tightened``; ``again`` is where they are loosened after that.
    """

    loosened: bool = True
    tightened: list[float] = field(default_factory=list)
    again: list[float] = field(default_factory=list)

    def saved(self):
        return Yielding(values=self.values.copy(), loosened=self.loosened)

    def step(self, load, value, rate):
        self.steps += 1
        self.iterations += 3
        if value > WALL and self.loosened:
            return Ending.BEAMS_CROSSED, "through"
        if value > WALL and value - self.values[load] > 0.0004:
            return Ending.STEP_TOO_SMALL, "no way"
        self.values[load] = value
        return None

    def has_deep_pair(self):
        return self.loosened

    def tighten(self):
        self.loosened = False
        self.tightened.append(float(self.values[0]))

    def loosen(self, *kinds):
        self.loosened = True
        if self.values[0] in self.tightened:
            self.again.append(float(self.values[0]))
        return True


def test_what_was_tightened_lest_it_goes_through_is_not_loosened_where_it_stands(monkeypatch):
    # from a place where loose penalties let it through, and tight ones ask for shorter steps, these are to be made
    monkeypatch.setattr("fea_reference.travel.follow_branch", lambda *asked: None)
    march = Yielding()
    _step_to(march, Course(0, 1.0), WALL + 0.002, watched=False)
    assert march.values[0] == WALL + 0.002
    assert march.tightened
    assert not march.again


@dataclass
class Creeping(Ways):
    """A march that comes no farther than to WALL, but a third of the way there with every step that is short enough."""

    def step(self, load, value, rate):
        self.steps += 1
        self.iterations += 3
        if value - self.values[load] > (WALL - self.values[load]) / 3.0:
            return Ending.STEP_TOO_SMALL, "no way"
        self.values[load] = value
        return None


def test_steps_that_grow_ever_shorter_without_leading_on_end(monkeypatch):
    # ten cuts in a row make of the way to λ = 1 a step of 4⁻¹⁰; where a second of these fails is the end, and what
    # succeeds in between does not count.  The distance to the wall falls by a third at the least with every success
    monkeypatch.setattr("fea_reference.travel.follow_branch", lambda *asked: None)
    march = Creeping()
    with pytest.raises(StoppedError) as stopped:
        _step_to(march, Course(0, 1.0), 1.0, watched=False)
    assert stopped.value.ending is Ending.STEP_TOO_SMALL
    assert 0.0 < WALL - march.values[0] < 1e-5
    assert march.steps < 150  # to the last digit of the wall it would be 279


END = 0.7313


@dataclass
class Ended(Ways):
    """A march whose one motion is λ, on a branch that ends at END; beyond stands another one.

    Nothing but the curvature μ tells of that: the branch beyond goes on in the same direction, and is stable.
    """

    folds: bool = True
    reached: list[float] = field(default_factory=list)

    @property
    def system(self):
        return SimpleNamespace(z=SimpleNamespace(values=self.values.copy()), touches=())

    @property
    def curvature(self):
        here = self.values[0]
        return np.sqrt(1.0 - here / END) if self.folds and here < END else 1.0

    @curvature.setter
    def curvature(self, value):
        pass

    def rate(self, load):
        return np.ones(1)

    def saved(self):
        return Ended(values=self.values.copy(), acting=self.acting, folds=self.folds)

    def step(self, load, value, rate):
        self.reached.append(value)
        return super().step(load, value, rate)


def ending(monkeypatch, march, *, lets_go):
    """Where the branch began to be followed, of a march to λ = 1; ``lets_go``, it ends as a contact lets go."""
    followed = []

    def follow(march, load, target, span):
        followed.append(float(march.values[load]))
        return CriticalPoint(END, 0.0, Loss.FOLD, "", 0.0, 0.0, 0.0, march.system, np.zeros(1))

    monkeypatch.setattr(travel, "follow_branch", follow)
    monkeypatch.setattr(travel, "force_about_to_vanish", lambda march, load, value: lets_go and value > END)
    with pytest.raises(StoppedError) as stopped:
        _step_to(march, Course(0, 1.0), 1.0, watched=True)
    assert stopped.value.ending is Ending.BRANCH_ENDS
    (begun,) = followed
    return begun


def test_no_step_goes_over_a_fold_that_the_curvature_foresees(monkeypatch):
    """μ² goes evenly to zero at END, as towards any fold: two steps before it tell where that is."""
    march = Ended()
    begun = ending(monkeypatch, march, lets_go=False)
    assert max(march.reached) < END
    assert 0.95 * END < begun < END


def test_no_step_goes_over_where_a_contact_is_about_to_let_go(monkeypatch):
    march = Ended(folds=False)
    begun = ending(monkeypatch, march, lets_go=True)
    assert max(march.reached) == begun < END
