"""The built-in cases, and how one is named."""

import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.opinions import claim_of
from comparisons.pairing import paired
from comparisons.verdict.rows import rows_of
from cprbm_scene import SceneError


def test_a_case_is_a_question_of_its_files_name():
    assert len(cases.names()) > 5
    assert [cases.asked(name).name for name in cases.names()] == list(cases.names())


def test_every_claim_of_the_hinge_stands_at_a_row(hinge, right):
    rows = rows_of(paired(hinge, Choices(), right))
    claims = [claim for row in rows if (claim := claim_of(hinge, row)) is not None]
    assert sorted(claim.bound for claim in claims) == [0.0062, 0.0081]  # section 3.2 of the paper


@pytest.mark.parametrize("name", ["", "Hinge", "hinge2", "../cases/hinge", "hinge\n"])
def test_an_unknown_case_is_refused_with_what_there_is(name):
    with pytest.raises(SceneError, match=r"hinge|cannot be read"):
        cases.opened(name)
