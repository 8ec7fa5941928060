"""Error budgets of made-up answers whose parts are known, and the sentences about the budgets."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.store import AnswerMemory
from comparisons.studies.budget import Budget, account_of, inner_edge_factor
from comparisons.studies.budget_section import LOOKS, budget_figures, budget_table, data_of, sentences_of
from comparisons.writing import text_of
from cprbm_scene import Ending, Stage
from tests.verdict.made_up import MadeUp

LOAD = 0.067
"""Before the contact closes: there the rotation is 0.9 times the load, and 1 plus every error."""


def budget_at(scene, solvers, choices=None, probe="BD.rotation") -> Budget:
    """The budget at the load before contact, as ``paper`` may be run there."""
    before = scene.model_copy(update={"stages": (Stage(name="load", steps="M", stations=(LOAD,)),), "claims": ()})
    account = account_of(before, choices or Choices(), AnswerMemory(solvers=solvers))
    (found,) = [each for each in account.budgets if each.row.probe.name == probe]
    return found


def test_each_part_is_the_planted_one_and_the_contact_is_a_part_of_paper(hinge):
    # v_c = 1.004/1.001, v_f = 1 − 0.008/4 + 0.0005: the links' share, the fault, and so on.
    solvers = Solvers(MadeUp("cprbm", 4e-3, stiffness=1.001, paper=3e-3), MadeUp("fea", -8e-3, penalty=5e-4))
    found = budget_at(hinge, solvers)
    rotation, sign = 0.9 * LOAD, 1.0
    assert found.row.difference == pytest.approx(rotation * (1.004 / 1.001 - 0.9985), rel=1e-9)
    expected = {
        "contact": 0.0,
        "links": sign * 4e-3 / 1.001,
        "rest": sign * (1.0 / 1.001 - 1.0),
        "elements": sign * 8e-3 / 4.0,
        "penalty": -sign * 5e-4,
    }
    for name, part in found.parts.items():
        assert part == pytest.approx(rotation * expected[name], rel=1e-9, abs=1e-15), name
    assert found.paper == pytest.approx(sign * rotation * 3e-3 / 1.001, rel=1e-9)
    assert found.off_line < 1e-15
    solvers = Solvers(MadeUp("cprbm", 4e-3, paper=3e-3), MadeUp("fea", 0.0))
    found = budget_at(hinge, solvers, Choices(formulation="paper"))
    rotation = 0.9 * LOAD
    assert found.row.difference == pytest.approx(rotation * 0.007, rel=1e-9)
    assert found.parts["contact"] == found.paper == pytest.approx(rotation * 3e-3, rel=1e-9)
    assert found.parts["links"] == pytest.approx(rotation * 4e-3, rel=1e-9)


@pytest.mark.parametrize("formulation", ["auto", "paper"])
def test_the_parts_sum_to_the_difference(hinge, formulation):
    solvers = Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", -5e-4, penalty=2e-4))
    budgets = account_of(hinge, Choices(formulation=formulation), AnswerMemory(solvers=solvers)).budgets
    assert len(budgets) > 100
    for each in budgets:
        assert sum(each.parts.values()) == pytest.approx(each.row.difference, rel=1e-9, abs=1e-18)


@pytest.mark.parametrize("theory", ["bending", "stretch", "shear"])
def test_all_runs_of_a_budget_have_one_theory(hinge, right, theory):
    """The made-up solvers' limits are equal in every theory."""
    found = budget_at(hinge, right, Choices(theory=theory))
    assert abs(found.parts["rest"]) < 1e-12
    assert sum(found.parts.values()) == pytest.approx(found.row.difference, rel=1e-9)


def test_no_difference_has_no_parts_and_no_picture(hinge):
    same = Solvers(MadeUp("cprbm", 0.0), MadeUp("fea", 0.0))
    found = budget_at(hinge, same, Choices())
    assert found.row.difference == 0.0
    assert set(found.parts.values()) == {0.0}
    assert found.all_parts == 0.0
    same = Solvers(MadeUp("cprbm", 0.0), MadeUp("fea", 0.0))
    assert budget_figures(account_of(hinge, Choices(), AnswerMemory(solvers=same))) == ()


def test_parts_that_cancel_are_told_along_the_value(hinge):
    """2e-3 too much at 40 links, and as much at 80 elements: 8e-3 (40/80)²."""
    same = Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", 8e-3))
    found = budget_at(hinge, same, Choices())
    assert found.row.difference == 0.0
    assert found.parts["links"] == pytest.approx(0.9 * LOAD * 2e-3, rel=1e-9)
    assert found.parts["elements"] == pytest.approx(-found.parts["links"], rel=1e-9)


def test_an_open_contact_has_no_budget(hinge, right):
    budgets = account_of(hinge, Choices(), AnswerMemory(solvers=right)).budgets
    of_contact = {(each.row.probe.name, each.row.station) for each in budgets if each.row.probe.of == "contact"}
    names = {name for name, station in of_contact if station == 0.67}
    assert names == {"contact.force", "contact.centre", "contact.closing_load"}
    assert not any(station < 0.2 for _, station in of_contact)  # it closes at a load of 0.2


def test_a_penalty_that_does_not_go_with_the_penetration_is_off_the_line(hinge, right):
    def uneven(scene, choices):
        return MadeUp("fea", 0.0, penalty=1e-3 if choices.penetration == 1e-4 else 0.0)(scene, choices)

    found = budget_at(hinge, Solvers(right.cprbm, uneven))
    assert found.off_line == pytest.approx(0.9 * LOAD * 1e-3, rel=1e-9)
    assert abs(found.parts["penalty"]) == pytest.approx(0.9 * LOAD * 1e-3, rel=1e-9)


def test_a_change_with_the_penetration_that_follows_no_law_spoils_no_limit(hinge, right):
    """1e-3 too much at a quarter of the penetration alone: the line through it would move every limit by 3e-4."""

    def restless(scene, choices):
        tighter = choices.elements == 80 and choices.penetration == 2.5e-5
        return MadeUp("fea", 0.0, stiffness=1.0 / 1.001 if tighter else 1.0)(scene, choices)

    found = budget_at(hinge, Solvers(MadeUp("cprbm", 0.0), restless))
    assert abs(found.parts["rest"]) < 1e-12
    assert found.rest_uncertainty == pytest.approx(0.9 * LOAD * 1e-3 / 3.0, rel=2e-2)


def a_solid(rotation, *, until=None):
    """A third opinion whose values are those of the load times a factor, at every mesh."""

    def answer(scene, choices):
        made = MadeUp("fea", 0.0, stiffness=1.0 / rotation, until=until)
        return made(scene, Choices(elements=choices.elements, kinematics="bending"))

    return answer


def test_what_the_beam_theories_miss_is_told_beside_the_sum(hinge):
    """L_f = 1 and the solid's 1.0022, where v_c = 0.99 is the lower: 0.0022 on from the CPRBM's side."""
    beams = Solvers(MadeUp("cprbm", -1e-2), MadeUp("fea", -8e-3))
    found = budget_at(hinge, replace(beams, solid=a_solid(1.0022)))
    assert found.missed == pytest.approx(0.9 * LOAD * 0.0022, rel=1e-9)
    assert found.missed_uncertainty == pytest.approx(found.elements_uncertainty, rel=1e-9)  # both meshes say the same
    without = budget_at(hinge, beams)
    assert (without.missed, without.parts) == (None, found.parts)
    account = account_of(hinge, Choices(), AnswerMemory(solvers=replace(beams, solid=a_solid(1.0022))))
    assert budget_table(account).headers[-2:] == ("missed", "±")
    row = next(each for each in data_of(account)["budget"] if each["probe"] == "BD.rotation")
    assert row["missed"] == pytest.approx(0.0022 / (1.0 - 8e-3 / 4.0), rel=1e-9)
    assert "BD.rotation +0.2" in sentences_of(account)[-1]
    (figure,) = budget_figures(account)
    assert "miss together" in figure.caption


def test_a_solid_that_did_not_arrive_says_why_and_leaves_the_budget(hinge, right):
    account = account_of(hinge, Choices(), AnswerMemory(solvers=replace(right, solid=ended_early)))
    assert account.budgets
    assert all(each.missed is None for each in account.budgets)
    assert "det F" in sentences_of(account)[-1]
    assert all("missed" not in each for each in data_of(account)["budget"])


def ended_early(scene, choices):
    whole = a_solid(1.0)(scene, choices)
    return replace(whole, ending=Ending.NOT_CERTIFIED, sentence="det F is -1e-3", stations=whole.stations[:3])


@pytest.mark.parametrize(
    ("solver", "own", "calls"),
    [
        ("cprbm", Choices(elements=20, penetration=1e-5), 1),
        ("cprbm", Choices(links={"beam1": 40, "beam2": 40}), 2),
        ("fea", Choices(links=20, formulation="paper"), 1),
        ("fea", Choices(kinematics="bending"), 2),
    ],
)
def test_a_solver_does_not_heed_the_others_choices(hinge, right, solver, own, calls):
    found = []

    def counting(scene, choices):
        found.append(choices)
        return getattr(right, solver)(scene, choices)

    solvers = replace(right, **{solver: counting})
    AnswerMemory(solvers=solvers).answers([(counting, hinge, Choices()), (counting, hinge, own)])
    assert len(found) == calls


def test_an_answer_that_is_not_whole_leaves_no_budget_and_says_so(hinge, right):
    account = account_of(hinge, Choices(), AnswerMemory(solvers=Solvers(right.cprbm, MadeUp("fea", 0.0, until=3))))
    assert account.budgets == ()
    assert any("fea finer" in why for why in account.missing)
    assert budget_table(account).rows == ()
    assert "no error budget" in sentences_of(account)[0]
    assert budget_figures(account) == ()


def test_the_table_has_every_probe_at_the_last_station_and_the_json_every_station(hinge, right):
    table = budget_table(account_of(hinge, Choices(), AnswerMemory(solvers=right)))
    assert [row[0] for row in table.rows] == [probe.name for probe in hinge.probes]
    signs = dict(zip(table.headers, table.rows[2], strict=True))
    # the limit of the rotation is 0.8·0.67 + 0.02, of which the first part has errors of 0.2 % and −0.0125 %
    assert (signs["links"], signs["elements"]) == ("+0.193", "+0.0121")
    assert "contact" not in table.headers
    account = account_of(hinge, Choices(), AnswerMemory(solvers=right))
    data = json.loads(text_of(data_of(account)))
    assert len({row["station"] for row in data["budget"]}) == 10
    for row in data["budget"]:
        assert sum(row["parts"].values()) == pytest.approx(row["difference"], rel=1e-9, abs=1e-15)
    stress = next(row for row in data["budget"] if row["probe"] == "beam1.bending_stress")
    # 1 + t/(3R) + ..., t/R = 2/25
    np.testing.assert_allclose(stress["inner_edge_factor"], 81 * [1.0273], rtol=1e-4)
    assert 0.0 < stress["curved_beam"] <= 0.0274


@pytest.mark.usefixtures("printed")
def test_the_picture_shows_every_part_that_there_is(hinge, right):
    account = account_of(hinge, Choices(), AnswerMemory(solvers=right))
    (picture,) = budget_figures(account)
    assert picture.name == "budget"
    (again,) = budget_figures(account)
    assert again.svg == picture.svg
    for name, (colour, _) in LOOKS.items():
        shown = any(each.parts[name] != 0.0 for each in account.budgets)
        assert (colour.encode() in picture.svg) == shown or name == "contact", name
    assert not any(each.parts["contact"] for each in account.budgets)


def test_converge_tells_the_budget_and_spares_its_own_runs(hinge, right, capsys):
    calls = []

    def counting(name):
        def answer(scene, choices):
            calls.append((name, choices))
            return getattr(right, name)(scene, choices)

        return answer

    command = ["converge", "hinge", "--sizes", "20,40,80,160", "--json", "-"]
    assert run(command, Solvers(counting("cprbm"), counting("fea"))) == 0
    case = json.loads(capsys.readouterr().out)
    assert {row["probe"] for row in case["budget"]} == {probe.name for probe in hinge.probes}
    assert len(calls) == len(set(calls))
    # four sizes, twice; then two penetrations at 80 elements, and paper
    assert len(calls) == 4 * 2 + 2 + 1


@pytest.mark.usefixtures("printed")
def test_converge_shows_the_budget_and_writes_its_figure(right, tmp_path, capsys):
    assert run(["converge", "hinge", "--sizes", "40,80", "--out", str(tmp_path)], right) == 0
    assert "Error budget at load 0.67 N·m with 40 links and 80 elements per beam" in capsys.readouterr().out
    assert (tmp_path / "hinge" / "budget.svg").read_bytes().startswith(b"<?xml")
    assert "Error budget" in (tmp_path / "index.html").read_text(encoding="utf-8")


# -- The curved beam's inner edge


def test_the_inner_edge_factor_is_the_quotient_of_both_stresses_of_plane_sections():
    # σ_i = M (r_n − r_i)/(A e r_i) and 6 M/(w t²), with R = M = w = 1.
    for t in (0.02, 0.08, 0.1999, 0.2001, 0.5, 1.0, 1.9):
        r_i, r_o = 1.0 - 0.5 * t, 1.0 + 0.5 * t
        r_n = t / math.log(r_o / r_i)
        curved = (r_n - r_i) / (t * (1.0 - r_n) * r_i)
        # where the beam is slender, 1 − r_n loses digits here
        assert inner_edge_factor(np.array([t]))[0] == pytest.approx(curved / (6.0 / t**2), rel=1e-13 / t**2), t
    # Winkler's assumption and no more: ε = a + b/r without a force, its moment about R = 1 being 1, by quadrature.
    points, weights = np.polynomial.legendre.leggauss(40)
    for bentness in (0.08, 1.0):
        r = 1.0 + 0.5 * bentness * points
        dA = 0.5 * bentness * weights
        force = [np.sum(dA), np.sum(dA / r)]
        moment = [np.sum(dA * (r - 1.0)), np.sum(dA * (r - 1.0) / r)]
        a, b = np.linalg.solve([force, moment], [0.0, 1.0])
        inner = abs(a + b / (1.0 - 0.5 * bentness))
        assert inner_edge_factor(np.array([bentness]))[0] == pytest.approx(inner / (6.0 / bentness**2), rel=1e-9)


def test_the_inner_edge_factor_of_a_slender_beam_and_beyond_the_centre():
    """K = 1 + x/3 + O(x²), and 1 for a straight beam."""
    for bentness in (1e-7, 1e-4, 1e-2):
        found = inner_edge_factor(np.array([bentness]))[0] - 1.0
        assert found == pytest.approx(bentness / 3.0, rel=bentness, abs=1e-15)
    assert inner_edge_factor(np.zeros(2)).tolist() == [1.0, 1.0]
    for bentness in (-0.1, 2.0, math.nan):
        with pytest.raises(ValueError, match="less than 2"):
            inner_edge_factor(np.array([0.1, bentness]))
