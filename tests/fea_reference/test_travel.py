"""Steps along a branch, of a march that is nothing but where it may go: what is cut grows again, what closed is looser.

References: by construction; there is a way that obeys the march's limits, and the steps are to find it.
"""

from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

from fea_reference.march import StoppedError
from fea_reference.travel import Course, _arrive
from scene.answer import Ending

MODEL = SimpleNamespace(moving=np.array([True]))


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
    loose: bool = False
    iterations: int = 0
    steps: int = 0
    far: bool = False
    acting: tuple[str, ...] = ()
    behind: None = None
    curvature: float = -1.0
    model = MODEL
    settings: SimpleNamespace = field(default_factory=lambda: SimpleNamespace(iteration_limit=100000))

    def saved(self):
        return Ways(values=self.values.copy(), penalties=dict(self.penalties), loose=self.loose, acting=self.acting)

    def restore(self, saved):
        self.values, self.penalties, self.loose = saved.values.copy(), dict(saved.penalties), saved.loose

    def rate(self, load):
        return np.zeros(1)

    def step(self, load, value, rate):
        self.steps += 1
        self.iterations += 3
        here = self.values[load]
        over, closing = ([p for p in places if here < p <= value] for places in (self.narrows, self.closings))
        if (over and value - here > 0.002) or len(closing) > 1 or (closing and not self.loose):
            return Ending.STEP_TOO_SMALL, "no way"
        if closing:
            self.penalties[closing[0]], self.loose = 1.0, False
        self.values[load] = value
        return None

    def loosen(self, *kinds):
        if not self.closings:
            return False
        self.loose = True
        return True

    def gone(self, load, saved, rate, ahead):
        return None

    def shown(self, load, value):
        return f"{value:g}"


def test_cuts_count_in_a_row_and_a_step_that_was_cut_grows_again():
    march = Ways(narrows=tuple(0.07 * k + 0.0213 for k in range(1, 13)))
    _arrive(march, Course(0, 1.0), 1.0, watched=False)
    assert march.values[0] == 1.0
    assert march.steps < 12 * 25  # at the size of what was cut last it would take 500 or more


def test_penalties_are_loosened_once_for_every_contact_that_closes():
    march = Ways(closings=(0.37, 0.71, 0.93))
    _arrive(march, Course(0, 1.0), 1.0, watched=False)
    assert march.values[0] == 1.0
    assert list(march.penalties) == [0.37, 0.71, 0.93]


def test_where_there_is_no_way_steps_end():
    march = Ways(closings=(0.37, 0.37))
    with pytest.raises(StoppedError) as stopped:
        _arrive(march, Course(0, 1.0), 1.0, watched=False)
    assert stopped.value.ending is Ending.STEP_TOO_SMALL
    assert march.values[0] < 0.37
