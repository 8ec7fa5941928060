"""Critical points in the JSON, the tables, the archive, in claims and in convergence studies, on made-up answers.

The planted jumps are at 70.4057° forward and 25.3° back in the CPRBM, each with 0.3 J released.
"""

import gzip
import json
from dataclasses import replace
from math import radians

import pytest

from comparisons.answer_file import packed, unpacked
from comparisons.choices import Choices
from comparisons.executor import ALONE
from comparisons.opinions import standings
from comparisons.pairing import Solvers
from comparisons.present import json_document
from comparisons.present.case_tables import answer_tables
from comparisons.studies import convergence_tables as tables
from comparisons.studies.convergence import convergence_of
from comparisons.writing import text_of
from cprbm_scene import Claim, Loss
from tests.tables import tables_of
from tests.verdict.comparing import compared
from tests.verdict.jumping import BACK, FORWARD, Jumping
from tests.verdict.made_up import MadeUp

C, F = Jumping("cprbm"), Jumping("fea")
STOPPING = replace(C, stops=True), replace(F, stops=True)
PASSING = Jumping("cprbm", over=0.29)


def test_the_json_marks_every_row_and_holds_the_critical_points(crank):
    """25° lies within 0.3° of the planted 25.3°, and takes no part."""
    data = json.loads(text_of(json_document.comparison(compared(crank, C, F))))
    assert {row["branch"] for row in data["rows"]} == {0, 1, 2}
    without = [row for row in data["rows"] if row["verdict"] is None]
    assert {(row["stage"], round(row["station"], 4), row["uncertainty"]["cprbm"]) for row in without} == {
        ("back", round(radians(25.0), 4), None)
    }
    assert len({row["place"] for row in data["rows"]}) == 2
    forward, back = data["critical"]
    assert forward["cprbm"] == pytest.approx(FORWARD + 1e-4)
    assert back["fea"] == pytest.approx(BACK - 1e-4 / 4)
    assert forward["released"] == {"cprbm": pytest.approx(0.3), "fea": pytest.approx(0.3)}
    assert [each["verdict"] for each in (forward, back, *data["branches"])] == ["AGREE"] * 6
    own = data["solvers"]["cprbm"]["critical"]
    assert [each["loss"] for each in own] == ["fold", "fold"]
    assert json_document.solution(crank, C(crank, Choices()))["solvers"]["cprbm"]["critical"] == own


def test_a_stop_releases_nothing(crank):
    found = compared(crank, *STOPPING)
    assert json_document.comparison(found)["critical"][0]["released"] == {"cprbm": None, "fea": None}
    assert any(table.title.startswith("Critical values") for table in tables_of(found))


def test_without_critical_points_nothing_is_said_of_branches(hinge):
    found = compared(hinge, MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4))
    data = json_document.comparison(found)
    assert (data["critical"], [each["verdict"] for each in data["branches"]]) == ([], ["AGREE"])
    assert "ranch" not in found.verdict.sentence
    assert not any("ritical" in sheet.title or "ranch" in sheet.title for sheet in tables_of(found))


def test_an_answer_survives_the_archive_with_its_branches(crank):
    answer = C(crank, Choices())
    again = unpacked(packed({"C": answer}))["C"]
    assert again.critical == answer.critical
    assert [station.branch for station in again.stations] == [station.branch for station in answer.stations]
    stopped = unpacked(packed({"stopped": STOPPING[0](crank, Choices())}))["stopped"]
    assert stopped.critical[0].after is None


def test_a_passed_critical_point_is_in_the_json_the_table_and_the_archive(crank):
    scene = crank.model_copy(update={"stages": crank.stages[:1]})
    found = compared(scene, PASSING, STOPPING[1])
    data = json_document.comparison(found)
    (end,) = data["solvers"]["cprbm"]["gone_over"]
    assert (end["stage"], end["loss"], end["what"], end["turned"]) == ("forward", "fold", None, 0.29)
    assert end["value"] == pytest.approx(FORWARD, abs=1e-3)
    assert end["released"] == pytest.approx(0.3)
    assert data["solvers"]["fea"]["gone_over"] == []
    assert data["critical"][0]["gone_over"]["cprbm"] == 0.29
    answer = found.runs.answers["cprbm"]
    kept = packed({"C": answer})
    assert unpacked(kept)["C"].gone_over == answer.gone_over
    (sheet,) = (one for one in answer_tables(scene, answer) if one.title.startswith("Critical values"))
    assert "0.290 rad" in sheet.rows[0][3]
    document = json.loads(gzip.decompress(kept))
    del document["answers"]["C"]["gone_over"]  # a field that the file lacks
    assert unpacked(gzip.compress(json.dumps(document).encode()))["C"].gone_over == ()


def test_a_claim_of_a_critical_value_is_compared_with_the_cprbms(crank):
    """A claim of 35.5 ± 0.5 is not met, a claim of 70.5 ± 0.5 is; without a value the solvers are compared."""
    far = Claim(probe="critical", stage="forward", value=radians(35.5), bound=0.5 / 35.5)
    near = Claim(probe="critical", stage="forward", value=radians(70.5), bound=0.5 / 70.5)
    scene = crank.model_copy(update={"claims": (far, near, Claim(probe="critical", bound=0.01))})
    comparison = compared(scene, C, F)
    found = standings(scene, (), comparison.criticals)
    assert [each.holds for each in found] == [False, True, True]
    assert found[0].difference == pytest.approx((70.4 + 0.0057296 - 35.5) / 35.5, rel=1e-6)
    assert [each.stations for each in found] == [1, 1, 2]
    forward, back = json_document.comparison(comparison)["critical"]
    assert (forward["claim"], forward["claim_value"], forward["claim_met"]) == (far.bound, far.value, False)
    assert (back["claim"], back["claim_value"]) == (0.01, None)


def test_a_claimed_value_of_a_probe_is_compared_with_the_cprbms(crank):
    """The moment at 0° vanishes."""
    claims = tuple(
        Claim(probe="crank.reaction_moment", stage="forward", station=0.0, value=value, bound=bound)
        for value, bound in ((0.0, 1e-6), (0.1, 0.5))
    )
    comparison = compared(crank.model_copy(update={"claims": claims}), C, F)
    sheet = next(each for each in tables_of(comparison) if each.title == "Claims of the source")
    assert [row[-1] for row in sheet.rows] == ["met", "not met"]
    assert sheet.rows[1][1:3] == ("0.100 ± 50.0 %", "100 %")


def test_critical_values_converge_though_the_branches_end(crank):
    """No probe has all stations; the critical value has its limit, the planted 70.4°."""
    found = convergence_of(crank, (20, 40, 80), Choices(), Solvers(*STOPPING), ALONE)
    assert (found.completed, found.families) == (False, ())
    entries = tables.document(found)["families"]
    assert [(each["solver"], each["component"]) for each in entries] == [
        (solver, "forward") for solver in ("cprbm", "fea")
    ]
    assert entries[0]["limit"] == pytest.approx(FORWARD, abs=1e-8)
    (sheet,) = tables.tables_of(found)
    assert len(sheet.rows) == 2
    assert any("in bending, where" in sentence for sentence in tables.sentences_of(found))


def test_a_mechanism_that_changes_with_n_counts_from_there_on(crank):
    """A contact lets go at 20 links, a fold is found from 40 on."""

    def changing(scene, choices):
        return replace(C, loss=Loss.CONTACT if choices.links == 20 else Loss.FOLD)(scene, choices)

    found = convergence_of(crank, (20, 40, 80, 160), Choices(), Solvers(changing, F), ALONE)
    family = found.criticals[0]
    assert family.used == (40, 80, 160)
    assert family.error(20) is None
    assert family.orders == pytest.approx((2.0,), abs=1e-2)
