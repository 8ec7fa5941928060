"""Sentences of a verdict, and critical points in the JSON, the tables, the archive, claims and convergence studies.

All answers are made up.  The planted jumps are at 70.4057° forward and 25.3° back in the CPRBM, each with 0.3 J
released.
"""

import gzip
import json
import re
from dataclasses import replace
from math import degrees, radians

import pytest

from comparisons.answer_file import packed, unpacked
from comparisons.choices import Choices
from comparisons.executor import ALONE
from comparisons.opinions import standings
from comparisons.pairing import Solvers
from comparisons.present import json_document
from comparisons.present.brief import brief
from comparisons.present.case_tables import answer_tables
from comparisons.studies import convergence_tables as tables
from comparisons.studies.convergence import convergence_of
from comparisons.writing import text_of
from cprbm_scene import Claim, Ending, Loss
from tests.tables import tables_of
from tests.verdict.comparing import C, F, altered, compared, ending, only, word_of
from tests.verdict.jumping import BACK, FORWARD, Jumping
from tests.verdict.made_up import MadeUp, with_value

COARSE = MadeUp("cprbm", 2e-2), MadeUp("fea", -8e-2)
JUMPS = Jumping("cprbm"), Jumping("fea")
STOPS = Jumping("cprbm", stops=True), Jumping("fea", stops=True)
PASSES = Jumping("cprbm", over=0.29)


# -- Sentences


@pytest.mark.parametrize(
    ("cprbm", "fea", "options", "most"),
    [
        (COARSE[0], F, {"-n"}, "most of it of the CPRBM"),
        (MadeUp("cprbm", 1e-3), COARSE[1], {"--elements"}, "most of it of the finite elements"),
        (*COARSE, {"-n", "--elements"}, ""),
    ],
)
def test_the_sentence_names_the_uncertain_solver_and_the_size_that_makes_the_limit(hinge, cprbm, fea, options, most):
    """Errors of second order: the sizes of the command make AGREE, half of the sizes make UNDECIDED."""
    (stage,) = hinge.stages
    stations = tuple(value for value in stage.stations if value != 0.201)  # 0.201 is beside the closing of the contact
    away = hinge.model_copy(update={"stages": (stage.model_copy(update={"stations": stations}),)})
    found = compared(away, cprbm, fea)
    assert word_of(found) == "UNDECIDED COARSE"
    assert most in found.verdict.because
    command = re.search(r"`([^`]*)` would do", found.verdict.because)[1].split()
    sizes = dict(zip(command[::2], map(int, command[1::2]), strict=True))
    assert set(sizes) == options
    for share, word in ((1.0, "AGREE"), (0.5, "UNDECIDED")):
        asked = {name: int(share * size) for name, size in sizes.items()}
        choices = Choices(links=asked.get("-n", 40), elements=asked.get("--elements", 80))
        assert word_of(compared(away, cprbm, fea, choices)).split()[0] == word


def test_the_sentence_names_the_row_that_decides_or_the_closest_row(hinge, agreeing):
    found = compared(hinge, altered(C, with_value("BD.rotation", [0.9]), 0.67), F)
    assert found.verdict.because.startswith("1 of 126 rows differ, first of all BD.rotation at load 0.67 N·m: ")
    assert "--solver cprbm,fea,solid" in found.verdict.because
    assert found.verdict.sentence.startswith(found.verdict.because)
    assert agreeing.verdict.because.startswith("All 126 rows agree; the closest is ")
    (stage,) = hinge.stages
    stage = stage.model_copy(update={"stations": (0.67,), "shown": ()})
    probes = tuple(probe for probe in hinge.probes if probe.quantity == "rotation")
    alone = hinge.model_copy(update={"stages": (stage,), "probes": probes, "claims": ()})
    assert compared(alone, C, F).verdict.because.startswith("The only row agrees, BD.rotation at load 0.67 N·m: ")


def test_a_problem_of_several_runs_is_told_once(hinge):
    """All runs of the finite elements end alike, a run of the CPRBM for another reason."""

    def stuck(scene, choices):
        found = ending(C, 5)(scene, choices)
        return replace(found, ending=Ending.STEP_TOO_SMALL, sentence="It lacks air.")

    cprbm = only(C, stuck, lambda choices: choices.links == 80)
    sentence = compared(hinge, cprbm, ending(F, 5)).verdict.sentence
    assert sentence.count("It stuck") == sentence.count("It lacks air") == 1
    assert "fea, fea finer, fea beside: " in sentence
    assert "cprbm finer: it ended early: It lacks air" in sentence


@pytest.mark.parametrize(
    ("cprbm", "fea", "word", "first", "parts"),
    [
        (
            *(replace(each, what="stopB") for each in JUMPS),
            "AGREE",
            "forward at 1.2288 rad (70.41°) (stopB: fold) in the CPRBM and 1.2287 rad",
            # 70.4057° and 70.4014°; 0.1·0.005 rad of theory
            ["0.0043° apart against a stated 0.0091°, 0.30° allowed; the theories are 0.029° apart: AGREE."],
        ),
        (
            replace(JUMPS[0], loss=Loss.BIFURCATION),
            JUMPS[1],
            "UNDECIDED BRANCH",
            "forward at 1.2288 rad (70.41°) (bifurcation) in the CPRBM and 1.2287 rad (70.40°) (fold) in the finite",
            ["the loads agree, the mechanisms do not: UNDECIDED"],
        ),
        (
            STOPS[0],
            JUMPS[1],
            "DIFFER EVENTS",
            "back at nowhere in the CPRBM and 0.44",  # the worst comes first
            ["70.41°"],
        ),
        (
            PASSES,
            replace(STOPS[1], loss=Loss.BIFURCATION),
            "DIFFER EVENTS",
            "forward at nowhere in the CPRBM, which passed 1.2288 rad",
            ["(fold) and went on, and 1.2287 rad (70.40°) (bifurcation) in the finite elements"],
        ),
        (
            STOPS[0],
            only(STOPS[1], replace(STOPS[1], loss=Loss.BIFURCATION), lambda choices: choices.elements == 91),
            "UNDECIDED BRANCH",
            "forward at ",
            ["fold in cprbm, cprbm finer, fea, fea finer, cprbm beside; ", "bifurcation in fea beside)"],
        ),
    ],
    ids=["degrees and mechanism", "kinds", "one stops", "passed", "runs of one solver"],
)
def test_critical_points_are_told_once_with_their_loads_and_mechanisms(coarse, cprbm, fea, word, first, parts):
    found = compared(coarse, cprbm, fea)
    assert word_of(found) == word
    assert found.verdict.because.startswith(f"The branch ends in {first}")
    assert [part for part in parts if part not in found.verdict.sentence] == []
    assert len(set(found.verdict.sentences)) == len(found.verdict.sentences)
    assert found.verdict.sentence.count("The branch ends in forward") == 1
    incomplete = "Runs without a complete answer" in found.verdict.sentence
    assert incomplete is (word == "DIFFER EVENTS"), "one solver stops where the other goes on"


@pytest.mark.parametrize(("loss", "remedy"), [(Loss.FOLD, 'beyond = "jump"'), (Loss.BIFURCATION, "imperfection")])
def test_runs_that_end_before_the_first_station_name_the_critical_point_and_a_remedy(coarse, loss, remedy):
    cprbm, fea = Jumping("cprbm", stops=True, loss=loss), Jumping("fea", stops=True, loss=loss)
    pair = (lambda scene, choices, own=own: replace(own(scene, choices), stations=()) for own in (cprbm, fea))
    printed = " ".join(brief(compared(coarse, *pair), "crank.toml").split())
    assert ": UNDECIDED (RUN_ENDED). No station has a row that can be compared. The branch ends in forward" in printed
    assert remedy in printed


def test_an_agreement_up_to_a_critical_point_counts_the_unreached_stations_and_releases_nothing(crank):
    """Both solvers stop at one critical point: the rows before the point agree."""
    stopped = compared(crank, *STOPS)
    assert word_of(stopped) == "AGREE"
    asked = sum(len(stage.stations) for stage in crank.stages)
    left = asked - len({row.where for row in stopped.rows})
    assert 0 < left < asked
    end = stopped.runs.answers["cprbm"].critical[-1]
    sentence = f"The case ends early, at forward {end.value:.6g} rad ({degrees(end.value):.2f}°) (fold): "
    sentence += f"{left} of {asked} stations are not reached."
    assert sentence in stopped.verdict.sentence
    assert sentence in " ".join(brief(stopped, "crank.toml").split())
    assert json_document.comparison(stopped)["critical"][0]["released"] == {"cprbm": None, "fea": None}
    assert any(table.title.startswith("Critical values") for table in tables_of(stopped))


def test_without_critical_points_nothing_is_said_of_branches(agreeing):
    data = json_document.comparison(agreeing)
    assert (data["critical"], [each["verdict"] for each in data["branches"]]) == ([], ["AGREE"])
    assert "ranch" not in agreeing.verdict.sentence
    assert not any("ritical" in sheet.title or "ranch" in sheet.title for sheet in tables_of(agreeing))


# -- JSON, tables and archive


def test_the_json_and_the_archive_mark_every_row_and_hold_the_critical_points(crank, jumped):
    """25° lies within 0.3° of the planted 25.3°, and takes no part."""
    data = json.loads(text_of(json_document.comparison(jumped)))
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
    answer = JUMPS[0](crank, Choices())
    assert json_document.solution(crank, answer)["solvers"]["cprbm"]["critical"] == own
    kept = unpacked(packed({"jumps": answer, "stops": STOPS[0](crank, Choices())}))
    assert kept["jumps"].critical == answer.critical
    assert [station.branch for station in kept["jumps"].stations] == [station.branch for station in answer.stations]
    assert kept["stops"].critical[0].after is None


def test_a_passed_critical_point_is_in_the_json_the_table_and_the_archive(forward):
    found = compared(forward, PASSES, STOPS[1])
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
    (sheet,) = (one for one in answer_tables(forward, answer) if one.title.startswith("Critical values"))
    assert "0.290 rad" in sheet.rows[0][3]
    document = json.loads(gzip.decompress(kept))
    del document["answers"]["C"]["gone_over"]  # a field that the file lacks
    assert unpacked(gzip.compress(json.dumps(document).encode()))["C"].gone_over == ()


# -- Claims and convergence


def test_claims_of_a_critical_value_and_of_a_probe_are_compared_with_the_cprbms(crank):
    """A claim of 35.5 ± 0.5 is not met, a claim of 70.5 ± 0.5 is; without a value the solvers are compared.

    The moment at 0° vanishes.
    """
    far = Claim(probe="critical", stage="forward", value=radians(35.5), bound=0.5 / 35.5)
    near = Claim(probe="critical", stage="forward", value=radians(70.5), bound=0.5 / 70.5)
    claims = (far, near, Claim(probe="critical", bound=0.01))
    moments = tuple(
        Claim(probe="crank.reaction_moment", stage="forward", station=0.0, value=value, bound=bound)
        for value, bound in ((0.0, 1e-6), (0.1, 0.5))
    )
    comparison = compared(crank.model_copy(update={"claims": (*claims, *moments)}), *JUMPS)
    found = standings(crank.model_copy(update={"claims": claims}), (), comparison.criticals)
    assert [each.holds for each in found] == [False, True, True]
    assert found[0].difference == pytest.approx((70.4 + 0.0057296 - 35.5) / 35.5, rel=1e-6)
    assert [each.stations for each in found] == [1, 1, 2]
    forward, back = json_document.comparison(comparison)["critical"]
    assert (forward["claim"], forward["claim_value"], forward["claim_met"]) == (far.bound, far.value, False)
    assert (back["claim"], back["claim_value"]) == (0.01, None)
    sheet = next(each for each in tables_of(comparison) if each.title == "Claims of the source")
    rows = [row for row in sheet.rows if row[-1] in ("met", "not met") and "crank" in row[0]]
    assert [row[-1] for row in rows] == ["met", "not met"]
    assert rows[1][1:3] == ("0.100 ± 50.0 %", "100 %")


def test_critical_values_converge_though_the_branches_end_and_the_mechanism_changes(coarse):
    """No probe has all stations; the critical value has its limit, the planted 70.4°."""
    found = convergence_of(coarse, (20, 40, 80), Choices(), Solvers(*STOPS), ALONE)
    assert (found.completed, found.families) == (False, ())
    entries = tables.document(found)["families"]
    assert [(each["solver"], each["component"]) for each in entries] == [("cprbm", "forward"), ("fea", "forward")]
    assert entries[0]["limit"] == pytest.approx(FORWARD, abs=1e-8)
    (sheet,) = tables.tables_of(found)
    assert len(sheet.rows) == 2
    assert any("in bending, where" in sentence for sentence in tables.sentences_of(found))
    # a contact lets go at 20 links, a fold is found from 40 on: the mechanism counts from there on
    changing = only(JUMPS[0], replace(JUMPS[0], loss=Loss.CONTACT), lambda choices: choices.links == 20)
    found = convergence_of(coarse, (20, 40, 80, 160), Choices(), Solvers(changing, JUMPS[1]), ALONE)
    family = found.criticals[0]
    assert family.used == (40, 80, 160)
    assert family.error(20) is None
    assert family.orders == pytest.approx((2.0,), abs=1e-2)
