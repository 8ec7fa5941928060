"""Are the stated uncertainties true?  Beside elasticas whose truth is known from outside.

The project's own rule stands in :mod:`comparisons.verdict.judge`: the true error lies within the stated error in
at least 95 % of the rows, and the stated error is at most ten times the true error in the median.  A statement counts
once, with the largest error of its rows.  The truth is from tests.references, which import no solver and nothing of the
exact answers in the house.  Only the bending theory has it, so the finite elements are run in that theory.
"""

from __future__ import annotations

import json
import math
from functools import cache

import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.studies.calibration import Calibration, Trial, result_of, tallies, trial_of
from comparisons.verdict import Word
from comparisons.verdict.judge import Tally
from comparisons.verdict.rows import rows_of
from comparisons.writing import text_of
from cprbm_scene import scene_from
from tests.together import truths

SHARES = (0.6, 1.4, 2.2)
TRUTHS = {
    "hinge": (lambda: truths.of_hinge(truths.PAPER_HINGE, SHARES), ((17, 21),)),
    "wrapped": (truths.of_wrapped, ((20, 24),)),
    "tapered": (truths.of_tapered, ((17, 20), (30, 50))),
    "two cantilevers": (truths.of_two_cantilevers, ((17, 20),)),
}


@cache
def trials(case: str) -> tuple[Trial, ...]:
    made, sizes = TRUTHS[case]
    scene, truth = made()
    exact = truth(scene, Choices())
    return tuple(trial_of(scene, links, elements, exact, Solvers()) for links, elements in sizes)


def of(case: str, solver: str) -> Tally:
    return next(mine for mine in tallies(trials(case)) if mine.solver == solver)


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize("case", TRUTHS)
def test_the_true_error_lies_within_the_stated_one(case, solver):
    mine = of(case, solver)
    assert mine.rows >= 20
    assert mine.share >= 0.95, [(each.row.probe.name, each.row.station, each.ratio) for each in mine.worst]


@pytest.mark.parametrize("solver", ["cprbm", "fea"])
@pytest.mark.parametrize("case", TRUTHS)
def test_the_stated_error_is_no_excuse(case, solver):
    assert of(case, solver).over <= 10.0


@pytest.mark.parametrize("case", TRUTHS)
def test_no_truth_is_taken_for_a_difference(case):
    assert Word.DIFFER not in [trial.verdict.word for trial in trials(case)]


def test_what_the_study_finds_can_be_told():
    data = json.loads(text_of(result_of(Calibration(trials("wrapped"), {"wrapped": (6, 6, None)})).data))
    counts = [trial["solvers"]["cprbm"]["rows"] for trial in data["cases"][0]["trials"]]
    assert sum(counts) == of("wrapped", "cprbm").rows


def test_a_contact_that_closes_at_once():
    """A gap of a two-hundredth of the thickness: the penetration is then a large part of what moves.

    The finite elements may leave less of it than they were allowed, and the finer ones a larger share of theirs.
    """
    data = cases.data("hinge")
    data["claims"] = []
    for body, beam in (("AC", "beam1"), ("BD", "beam2")):
        data["bodies"][body]["points"] = {
            name: [x, math.copysign(0.026005, y)] for name, (x, y) in data["bodies"][body]["points"].items()
        }
        for place in ("center", "start", "end"):
            x, y = data["beams"][beam]["curve"][place]
            data["beams"][beam]["curve"][place] = [x, math.copysign(0.026005, y)]
    data["stages"][0]["stations"] = [0.067]
    scene = scene_from(data)
    runs = paired(scene, Choices(kinematics="bending"), Solvers())
    row = next(row for row in rows_of(runs) if row.probe.name == "contact.force")
    assert row.bounds is not None
    assert row.difference <= row.bounds.total
