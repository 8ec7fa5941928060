"""A strip rolled up until it just touches itself: what closes it may be less than what a mesh tells of its gap."""

import numpy as np
import pytest
from scipy.optimize import brentq

from comparisons.audit.gaps import spaces
from comparisons.audit.rest import rests_of
from comparisons.audit.seen import seen_of
from comparisons.choices import Choices
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.verdict import compared
from comparisons.words import Word
from cprbm_scene import scene_from
from tests.cprbm.scenes import LENGTH as LONG
from tests.cprbm.scenes import MOMENT, cantilever_data
from tests.cprbm.scenes import THICKNESS as THICK
from tests.together.planted import without_contact

LENGTH, THICKNESS = 0.0923, 0.000368
WIDTH = {"at": [0.0, 0.3, 0.9, 1.0], "values": [0.0165, 0.0149, 0.0149, 0.00857]}
CHOICES = Choices(links=40, elements=40, kinematics="bending")


def rolled(station):
    return scene_from(
        {
            "name": "rolled",
            "materials": {"m": {"youngs_modulus": 1.37e9, "poisson_ratio": 0.42}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": [LENGTH, 0.0]}},
            },
            "beams": {
                "beam": {
                    "curve": {"kind": "line", "start": [0.0, 0.0], "end": [LENGTH, 0.0]},
                    "thickness": THICKNESS,
                    "width": WIDTH,
                    "material": "m",
                    "start": {"joint": "weld", "point": "R"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"roll": {"kind": "rotation", "body": "tip"}},
            "contacts": {"itself": {"kind": "beam-self", "beam": "beam"}},
            "stages": [{"name": "roll", "steps": "roll", "stations": [station]}],
            "probes": [
                {"of": "scene", "quantity": "potential_energy"},
                {"of": "T", "quantity": "displacement"},
                {"of": "itself", "quantity": "force"},
            ],
        }
    )


def gap(turn):
    """Of the strip without contact: a moment alone bends it, by as much as it is narrow; integrated on 8001 places."""
    s = np.linspace(0.0, LENGTH, 8001)
    bend = 1.0 / np.interp(s / LENGTH, WIDTH["at"], WIDTH["values"])

    def summed(f):
        return np.concatenate(([0.0], np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(s))))

    angle = summed(bend)
    line = summed(np.exp(1j * turn * angle / angle[-1]))
    first, last = line[: len(s) // 3], line[-len(s) // 3 :: 4]
    return np.min(np.abs(first[:, None] - last)) - THICKNESS


CLOSES = brentq(gap, 7.2, 7.7, xtol=1e-7)


def verdict(station, solvers=None):
    scene = rolled(station)
    return compared(scene, paired(scene, CHOICES, solvers or Solvers()))


def test_what_is_open_by_less_than_its_meshes_tell_is_not_certain():
    found = verdict(CLOSES + 0.005)
    assert gap(CLOSES + 0.005) < 0.0
    _, _, force = found.rows
    assert force.cprbm == pytest.approx([0.0], abs=0.0)
    assert force.fea[0] > 0.0
    assert {row.hardly_open for row in found.rows} == {frozenset({"itself"})}
    assert found.verdict.word is Word.UNDECIDED
    assert "itself presses in one solver" in found.verdict.sentence


def test_what_is_open_to_both_is_certain():
    found = verdict(CLOSES - 0.05)
    assert {row.hardly_open for row in found.rows} == {frozenset()}
    assert found.verdict.word is Word.AGREE


def test_a_contact_that_is_ignored_is_not_one_that_is_open():
    wrong = Solvers(cprbm=without_contact(cprbm_answer), fea=fea_answer)
    found = verdict(CLOSES + 0.05, wrong)
    assert {row.hardly_open for row in found.rows} == {frozenset()}
    assert found.verdict.word is Word.DIFFER


def test_the_gap_before_an_open_line_is_measured():
    # closed form: a beam that hardly anything bends, 0.02 of its length below a line that ends beside its middle
    data = cantilever_data(MOMENT, [1e-9])
    line = {"points": [[0.4 * LONG, 0.02 * LONG], [0.8 * LONG, 0.02 * LONG]], "side": "right"}
    data["contacts"] = {"line": {"kind": "beam-line", "beam": "beam", "body": "wall", **line}}
    scene = scene_from(data)
    answer = cprbm_answer(scene, CHOICES)
    (seen,) = seen_of(scene, answer, rests_of(scene))
    (space,) = spaces(seen, "line")
    least = np.min(space.gap, where=space.counted, initial=np.inf)
    assert least == pytest.approx(0.02 * LONG - 0.5 * THICK, rel=1e-6)
