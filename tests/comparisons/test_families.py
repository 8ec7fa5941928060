"""Families of made-up answers with known limits, and the output about the families."""

import json
from dataclasses import replace

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.executor import ALONE
from comparisons.pairing import Solvers
from comparisons.studies import convergence
from comparisons.studies import convergence_tables as tables
from comparisons.studies.convergence import convergence_of
from comparisons.writing import text_of
from cprbm_scene import Ending
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import THEORY, MadeUp

SIZES = (10, 20, 40, 80)
LAST = 0.67


def _found(hinge, solvers, sizes=SIZES, theory=None):
    return convergence_of(hinge, sizes, Choices(theory=theory), solvers, ALONE)


def _family(found, probe, station=LAST, method="cprbm"):
    return next(one for one in found.families if (one.probe, one.station, one.solver) == (probe, station, method))


def _changed(solver, what, *, at_most):
    """The solver with its answers changed at sizes up to ``at_most``."""

    def answer(scene, choices):
        found = solver(scene, choices)
        return what(found) if choices.links <= at_most else found

    return answer


def _with_value(probe, value):
    """An answer with one value at every station."""

    def changed(answer):
        stations = tuple(
            replace(station, values=frozendict({**station.values, probe: frozen_array(value)}))
            for station in answer.stations
        )
        return replace(answer, stations=stations)

    return changed


def test_the_limit_is_what_the_made_up_law_goes_to(hinge, right):
    found = _found(hinge, right)
    # the law of the made-up solvers without any error: made_up.MadeUp._station
    family = _family(found, "B.displacement")
    reach, push = LAST, LAST - 0.2
    assert family.found.value == pytest.approx([0.01 * reach, 0.02 * reach - 0.005 * push], rel=1e-9)
    assert family.orders == pytest.approx([2.0, 2.0], abs=1e-6)
    assert family.component_order(0) == pytest.approx(2.0, abs=1e-6)
    for n in SIZES:
        true = np.linalg.norm(family.values[n] - family.found.value)
        assert family.apart(n) == pytest.approx(true)
        assert np.all(family.error(n) >= np.abs(family.values[n] - family.found.value))


@pytest.mark.parametrize("theory", ["bending", "shear"])
def test_both_limits_meet_in_one_theory(hinge, right, theory):
    """The made-up theories make the rotation before contact 0.9·0.067 and, in shear, 0.5 % more."""
    found = _found(hinge, right, theory=theory)
    assert [(one.method, one.variant, one.theory) for one in found.series] == [
        ("cprbm", "auto", theory),
        ("fea", theory, theory),
    ]
    for pair in tables.pairs_of(found.families):
        cprbm, apart = pair.cprbm, pair.apart
        assert apart is None or apart[0] <= 1e-5 * cprbm.scale
    first = hinge.stages[0].stations[0]
    limits = [_family(found, "BD.rotation", first, method).found.value for method in ("cprbm", "fea")]
    assert limits == [pytest.approx([0.9 * first * (1.0 + THEORY[theory])], rel=1e-9)] * 2


def test_the_penetration_falls_with_the_fourth_power_and_is_never_large():
    assert Choices().of_size(40).penetration == Choices().penetration
    assert Choices().of_size(80).penetration == Choices().finer().penetration
    assert Choices().of_size(10).penetration == pytest.approx(256.0 * Choices().penetration)
    assert Choices().of_size(4).penetration == 0.05
    assert Choices().of_size(160).penetration / Choices().of_size(320).penetration == pytest.approx(4.0)
    assert (Choices().of_size(20).links, Choices().of_size(20).elements) == (20, 20)


def test_a_contact_that_is_open_at_some_sizes_or_at_every_size(hinge, right):
    opened = _changed(right.cprbm, _with_value("contact.force", [0.0]), at_most=10)
    family = _family(_found(hinge, Solvers(opened, right.fea)), "contact.force")
    assert family.used == (20, 40, 80)
    assert family.found is not None
    opened = _changed(right.cprbm, _with_value("contact.centre", []), at_most=40)
    family = _family(_found(hinge, Solvers(opened, right.fea)), "contact.centre")
    assert (family.used, family.found, family.why) == ((80,), None, "the contact is open at N = 40")
    found = _found(hinge, right)
    first = hinge.stages[0].stations[0]
    assert (_family(found, "contact.force", first).why, _family(found, "contact.force", first).found.order) == (
        "the contact is open",
        None,
    )
    assert _family(found, "contact.centre", first).found is None


def test_runs_that_are_not_whole_are_left_out_and_told(hinge, right):
    ended = _changed(
        right.cprbm,
        lambda answer: replace(answer, ending=Ending.STEP_TOO_SMALL, stations=answer.stations[:2]),
        at_most=10,
    )
    found = _found(hinge, Solvers(ended, right.fea))
    assert not found.completed
    family = _family(found, "BD.rotation")
    assert family.used == (20, 40, 80)
    (sentence,) = tables.sentences_of(found)
    assert sentence.startswith("CPRBM (auto) at N = 10 gave no complete answer: it ended early")
    entry = next(one for one in tables.document(found)["families"] if one["probe"] == "BD.rotation")
    assert entry["values"][0] is None
    assert entry["errors"][0] is None
    broken = _changed(right.cprbm, lambda answer: replace(answer, stations=answer.stations[:2]), at_most=9999)
    found = _found(hinge, Solvers(broken, _changed(right.fea, lambda a: replace(a, stations=()), at_most=9999)))
    assert found.families == ()
    assert tables.tables_of(found) == ()
    assert convergence.convergence_figures(found) == ()


def test_a_stress_is_followed_at_one_place_that_is_compared(hinge, right):
    family = _family(_found(hinge, right), "beam1.bending_stress")
    ((place,),) = (family.components,)
    ends = hinge.beams["beam1"].thickest, np.pi * 0.025 - hinge.beams["beam1"].thickest
    assert ends[0] <= place <= ends[1]
    assert family.found.value.shape == (1,)


def test_the_exact_values_stand_beside_where_they_are_known(hinge, right):
    known = MadeUp("cprbm", 0.0)(hinge, Choices())
    covered = replace(known, stations=known.stations[3:], ending=Ending.NOT_COVERED)
    found = _found(hinge, replace(right, exact=lambda scene, choices: covered))
    family = _family(found, "BD.rotation")
    assert family.true_error(20) == pytest.approx(family.apart(20), rel=1e-6)
    assert _family(found, "BD.rotation", hinge.stages[0].stations[0]).exact is None
    sheared = _found(hinge, replace(right, exact=lambda scene, choices: covered), theory="shear")
    assert all(one.exact is None for one in sheared.families)
    assert tables.tables_of(found)[0].headers[-1] == "CPRBM limit from exact"


def test_the_document_has_the_promised_keys_and_the_tables_have_whole_rows(hinge, right):
    data = json.loads(text_of(tables.document(_found(hinge, right))))
    assert data["case"] == "hinge"
    entry = next(one for one in data["families"] if one["probe"] == "B.displacement" and one["component"] == "y")
    assert entry["n"] == list(SIZES)
    assert len(entry["values"]) == len(entry["errors"]) == len(SIZES)
    for key in ("solver", "settings", "stage", "station", "order", "limit", "limit_uncertainty"):
        assert entry[key] is not None
    assert entry["settings"]["kinematics"] == "bending"
    assert len(data["runs"]) == 2 * len(SIZES)
    for sheet in tables.tables_of(_found(hinge, right)):
        assert sheet.rows
        assert {len(row) for row in sheet.rows} == {len(sheet.headers)}


def test_the_command_writes_prints_and_ends_with_0(right, capsys, tmp_path):
    arguments = ["converge", "hinge", "--sizes", "10,20,40", "--theory", "bending"]
    assert run([*arguments, "--out", str(tmp_path / "c"), "--json", str(tmp_path / "c.json")], right) == 0
    captured = capsys.readouterr()
    assert "limits at load 0.67" in captured.out
    assert "order CPRBM" in captured.out
    assert captured.err == ""
    assert 'id="hinge"' in (tmp_path / "c" / "index.html").read_text("utf-8")
    for name in ("convergence.json", "convergence.svg", "convergence.png"):
        assert (tmp_path / "c" / "hinge" / name).is_file()
    assert json.loads((tmp_path / "c.json").read_text("utf-8"))["case"] == "hinge"
    assert run([*arguments, "--json", "-"], right) == 0
    assert json.loads(capsys.readouterr().out)["families"]


def test_the_command_ends_with_1_where_a_run_is_not_whole(right, capsys):
    ended = _changed(right.cprbm, lambda answer: replace(answer, stations=answer.stations[:2]), at_most=10)
    assert run(["converge", "hinge", "--sizes", "10,20", "--quiet"], Solvers(ended, right.fea)) == 1
    assert "at N = 10 gave no complete answer" in capsys.readouterr().out


def test_sizes_that_are_no_family_are_refused(right, capsys):
    for sizes in ("40", "40,20", "20,20", "ten,20", "", "0,10"):
        assert run(["converge", "hinge", "--sizes", sizes], right) == 2, sizes
        assert "allowed" in capsys.readouterr().err


def test_an_interruption_keeps_what_was_finished(right, capsys, tmp_path):
    def interrupted(scene, choices):
        if scene.name == "wrapped":
            raise KeyboardInterrupt
        return right.fea(scene, choices)

    arguments = ["--sizes", "10,20", "--out", str(tmp_path / "c"), "--json", str(tmp_path / "c.json"), "--quiet"]
    assert run(["converge", "hinge", "wrapped", *arguments], Solvers(right.cprbm, interrupted)) == 130
    assert "Interrupted" in capsys.readouterr().err
    assert (tmp_path / "c" / "hinge" / "convergence.json").is_file()
    assert len(json.loads((tmp_path / "c.json").read_text("utf-8"))["cases"]) == 1


def test_an_offset_question_shows_its_error_against_the_exact_curve_at_the_allowed_sizes(capsys, tmp_path):
    assert run(["converge", "offset", "--sizes", "3,10,20,40,400", "--json", str(tmp_path / "c.json")], Solvers()) == 0
    assert "offset: An offset question takes 4 to 200 springs; left out: 3, 400." in capsys.readouterr().out
    families = json.loads((tmp_path / "c.json").read_text("utf-8"))["families"]
    question = cases.asked("offset")
    assert len(families) == len(question.spacings) * len(question.offsets)
    # second order of the midpoints of even elements, fourth of the rest: see the table of the errors in the page
    for family in families:
        expected = 2.0 if family["settings"]["spacing"] == "even-elements" else 4.0
        assert family["order"] == pytest.approx(expected, abs=0.25)
        assert family["exact"] == 0.0
    assert run(["converge", "offset", "--sizes", "100,400"], Solvers()) == 0
    assert "left out: 400" in capsys.readouterr().out
