"""Error budgets and Table 1 of made-up solvers with known parts and seconds, and the commands that print both."""

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pytest

from comparisons import cases
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.store import AnswerMemory
from comparisons.studies import table1
from comparisons.studies.budget import Budget, account_of, inner_edge_factor
from comparisons.studies.budget_section import LOOKS, budget_figures, budget_table, data_of, sentences_of
from comparisons.writing import text_of
from cprbm_scene import Answer, Ending, Mistake, Scene, SceneError, Stage
from cprbm_scene.frozendict import frozendict
from tests.verdict.made_up import MadeUp

LOAD = 0.067
"""Before the contact closes: there the rotation is 0.9 times the load, and 1 plus every error."""


def account_with(hinge, solvers, choices=None):
    return account_of(hinge, choices or Choices(), AnswerMemory(solvers=solvers))


@pytest.fixture(scope="module")
def account(hinge, right):
    """The budgets of the hinge at all stations."""
    return account_with(hinge, right)


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
def test_the_parts_sum_to_the_difference_and_all_runs_have_one_theory(hinge, right, formulation):
    solvers = Solvers(MadeUp("cprbm", 2e-3, paper=1e-3), MadeUp("fea", -5e-4, penalty=2e-4))
    budgets = account_with(hinge, solvers, Choices(formulation=formulation)).budgets
    assert len(budgets) > 100
    for each in budgets:
        assert sum(each.parts.values()) == pytest.approx(each.row.difference, rel=1e-9, abs=1e-18)
    # the made-up solvers' limits are equal in every theory
    for theory in ("bending", "stretch", "shear"):
        found = budget_at(hinge, right, Choices(theory=theory, formulation=formulation))
        assert abs(found.parts["rest"]) < 1e-12, theory
        assert sum(found.parts.values()) == pytest.approx(found.row.difference, rel=1e-9)


def test_no_difference_has_no_parts_and_parts_that_cancel_are_told_along_the_value(hinge):
    same = Solvers(MadeUp("cprbm", 0.0), MadeUp("fea", 0.0))
    found = budget_at(hinge, same)
    assert found.row.difference == 0.0
    assert set(found.parts.values()) == {0.0}
    assert found.all_parts == 0.0
    assert budget_figures(account_with(hinge, same)) == ()
    # 2e-3 too much at 40 links, and as much at 80 elements: 8e-3 (40/80)²
    found = budget_at(hinge, Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", 8e-3)))
    assert found.row.difference == 0.0
    assert found.parts["links"] == pytest.approx(0.9 * LOAD * 2e-3, rel=1e-9)
    assert found.parts["elements"] == pytest.approx(-found.parts["links"], rel=1e-9)


def test_a_change_with_the_penetration_without_a_law_is_off_the_line_and_spoils_no_limit(hinge, right):
    def uneven(scene, choices):
        return MadeUp("fea", 0.0, penalty=1e-3 if choices.penetration == 1e-4 else 0.0)(scene, choices)

    found = budget_at(hinge, Solvers(right.cprbm, uneven))
    assert found.off_line == pytest.approx(0.9 * LOAD * 1e-3, rel=1e-9)
    assert abs(found.parts["penalty"]) == pytest.approx(0.9 * LOAD * 1e-3, rel=1e-9)

    def restless(scene, choices):
        """1e-3 too much at a quarter of the penetration alone: the line through it would move every limit by 3e-4."""
        tighter = choices.elements == 80 and choices.penetration == 2.5e-5
        return MadeUp("fea", 0.0, stiffness=1.0 / 1.001 if tighter else 1.0)(scene, choices)

    found = budget_at(hinge, Solvers(MadeUp("cprbm", 0.0), restless))
    assert abs(found.parts["rest"]) < 1e-12
    assert found.rest_uncertainty == pytest.approx(0.9 * LOAD * 1e-3 / 3.0, rel=2e-2)


def a_solid(rotation, *, until=None):
    """A third opinion with the values of the load times a factor, at every mesh."""

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


def test_an_incomplete_solid_leaves_the_budget_and_an_incomplete_beam_leaves_none(hinge, right):
    def ended_early(scene, choices):
        whole = a_solid(1.0)(scene, choices)
        return replace(whole, ending=Ending.NOT_CERTIFIED, sentence="det F is -1e-3", stations=whole.stations[:3])

    account = account_with(hinge, replace(right, solid=ended_early))
    assert account.budgets
    assert all(each.missed is None for each in account.budgets)
    assert "det F" in sentences_of(account)[-1]
    assert all("missed" not in each for each in data_of(account)["budget"])
    account = account_with(hinge, Solvers(right.cprbm, MadeUp("fea", 0.0, until=3)))
    assert account.budgets == ()
    assert any("fea finer" in why for why in account.missing)
    assert budget_table(account).rows == ()
    assert "no error budget" in sentences_of(account)[0]
    assert budget_figures(account) == ()


def test_the_table_has_every_probe_at_the_last_station_and_the_json_every_station(hinge, account):
    table = budget_table(account)
    assert [row[0] for row in table.rows] == [probe.name for probe in hinge.probes]
    signs = dict(zip(table.headers, table.rows[2], strict=True))
    # the limit of the rotation is 0.8·0.67 + 0.02, of which the first part has errors of 0.2 % and −0.0125 %
    assert (signs["links"], signs["elements"]) == ("+0.193", "+0.0121")
    assert "contact" not in table.headers
    data = json.loads(text_of(data_of(account)))
    assert len({row["station"] for row in data["budget"]}) == 10
    for row in data["budget"]:
        assert sum(row["parts"].values()) == pytest.approx(row["difference"], rel=1e-9, abs=1e-15)
    stress = next(row for row in data["budget"] if row["probe"] == "beam1.bending_stress")
    # 1 + t/(3R) + ..., t/R = 2/25
    np.testing.assert_allclose(stress["inner_edge_factor"], 81 * [1.0273], rtol=1e-4)
    assert 0.0 < stress["curved_beam"] <= 0.0274
    # an open contact has no budget; the contact closes at a load of 0.2
    of_contact = {(each.row.probe.name, each.row.station) for each in account.budgets if each.row.probe.of == "contact"}
    names = {name for name, station in of_contact if station == 0.67}
    assert names == {"contact.force", "contact.centre", "contact.closing_load"}
    assert not any(station < 0.2 for _, station in of_contact)


@pytest.mark.usefixtures("printed")
def test_the_picture_shows_every_part_that_there_is(account):
    (picture,) = budget_figures(account)
    assert picture.name == "budget"
    (again,) = budget_figures(account)
    assert again.svg == picture.svg
    for name, (colour, _) in LOOKS.items():
        shown = any(each.parts[name] != 0.0 for each in account.budgets)
        assert (colour.encode() in picture.svg) == shown or name == "contact", name
    assert not any(each.parts["contact"] for each in account.budgets)


def test_converge_tells_the_budget_writes_its_figure_and_spares_its_own_runs(hinge, right, tmp_path, capsys):
    calls = []

    def counting(name):
        def answer(scene, choices):
            calls.append((name, choices))
            return getattr(right, name)(scene, choices)

        return answer

    command = ["converge", "hinge", "--sizes", "20,40,80,160", "--json", str(tmp_path / "all.json")]
    assert run([*command, "--out", str(tmp_path)], Solvers(counting("cprbm"), counting("fea"))) == 0
    case = json.loads((tmp_path / "all.json").read_text("utf-8"))
    assert {row["probe"] for row in case["budget"]} == {probe.name for probe in hinge.probes}
    assert len(calls) == len(set(calls))
    # four sizes, twice; then two penetrations at 80 elements, and paper
    assert len(calls) == 4 * 2 + 2 + 1
    assert "Error budget at load 0.67 N·m with 40 links and 80 elements per beam" in capsys.readouterr().out
    assert (tmp_path / "hinge" / "budget.svg").read_bytes().startswith(b"<?xml")
    assert "Error budget" in (tmp_path / "index.html").read_text(encoding="utf-8")


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
    # slender beams: K = 1 + x/3 + O(x²), and 1 for a straight beam
    for bentness in (1e-7, 1e-4, 1e-2):
        found = inner_edge_factor(np.array([bentness]))[0] - 1.0
        assert found == pytest.approx(bentness / 3.0, rel=bentness, abs=1e-15)
    assert inner_edge_factor(np.zeros(2)).tolist() == [1.0, 1.0]
    for bentness in (-0.1, 2.0, math.nan):
        with pytest.raises(ValueError, match="less than 2"):
            inner_edge_factor(np.array([0.1, bentness]))


# -- Table 1 of the paper

MACHINE = {
    "cpu": "a", "cores": 1, "system": "b", "python": "c", "numpy": "d", "scipy": "e", "scikit-fem": "f",
}  # fmt: skip


@dataclass
class Clocked:
    """Answers at once, refuses or breaks off on request; counts the solves."""

    base: Callable[[Scene, Choices], Answer]
    refuses: str = ""
    ending: Ending = Ending.COMPLETED
    until: int = 10**6
    solves: int = 0

    def __call__(self, scene, choices):
        self.solves += 1
        if self.solves > self.until:
            raise KeyboardInterrupt
        if self.refuses == f"{scene.name} {choices.formulation}":
            raise SceneError([Mistake("contacts.circle.paper", "nothing", "a boundary")])
        return replace(self.base(scene, choices), ending=self.ending, sentence="It fell short.")


def nothing(scene, choices):
    """An answer without stations, for tests of times."""
    return Answer("made up", scene.name, frozendict(), Ending.COMPLETED, "", ())


def quick(**faults):
    return Solvers(Clocked(nothing, **faults), Clocked(nothing))


@pytest.fixture
def three_cells(monkeypatch):
    """The command measures three cells of the gripper: a study of all cells draws a figure per cell."""
    sizes = 80, {"beam1": 40, "beam2": 30}
    cells = [cell for cell in table1.CELLS if cell.case == "gripper" and cell.contact and cell.size in sizes]
    for name in ("session", "result_of", "pictures"):
        monkeypatch.setattr(table1, name, partial(getattr(table1, name), cells=tuple(cells)))
    return cells


def test_table1_has_the_papers_cells_at_their_last_load():
    """Table 1 of the paper, and the gripper's (30, 40) of section 3.3."""
    theirs = {(cell.case, cell.method, cell.contact, cell.size_text): cell.theirs for cell in table1.CELLS}
    assert theirs == {
        ("hinge", "fea", True, "80"): 4.0,
        ("hinge", "fea", True, "160"): 5.0,
        ("hinge", "fea", False, "80"): 4.0,
        ("hinge", "cprbm", True, "(40, 40)"): 5.0,
        ("hinge", "cprbm", True, "(60, 60)"): 11.75,
        ("gripper", "fea", True, "80"): 23.0,
        ("gripper", "fea", True, "160"): 40.0,
        ("gripper", "fea", False, "80"): 4.0,
        ("gripper", "cprbm", True, "(40, 30)"): 4.32,
        ("gripper", "cprbm", True, "(30, 40)"): None,
        ("gripper", "cprbm", True, "(60, 50)"): 19.56,
    }
    assert {cell.formulation for cell in table1.CELLS if cell.method == "cprbm"} == {"auto", "paper"}
    for cell in table1.CELLS:
        scene = table1.question(cell)
        assert [stage.stations for stage in scene.stages] == [((0.67,) if cell.case == "hinge" else (16.0,))]
        assert bool(scene.contacts) is cell.contact
        if not cell.contact:
            assert {probe.of for probe in scene.probes}.isdisjoint(cases.opened(cell.case).contacts)
            assert scene.probes


def measured(solvers, **plan):
    """A finished session of all cells."""
    session = table1.session(solvers, MACHINE, **plan)
    for job in session.jobs():
        session.do(job)
    return session


def test_every_cell_is_solved_as_often_as_asked_and_a_refusal_is_said():
    solvers = quick(refuses="gripper paper")
    result = table1.result_of(measured(solvers, repeat=2, at_most=60.0))
    assert result.complete
    for cell, row in zip(table1.CELLS, result.data["rows"], strict=True):
        if (cell.case, cell.formulation) == ("gripper", "paper"):
            assert (row["repeats"], row["seconds"], row["ended"]) == (0, None, None)
            assert row["why"] == "contacts.circle.paper: found nothing; allowed: a boundary"
        else:
            assert (row["repeats"], row["ended"], row["why"]) == (2, "COMPLETED", None)
            assert row["seconds"] > 0.0
    assert [row[-1] for row in result.tables[0].rows].count("refused") == 3
    assert sum("found nothing" in sentence for sentence in result.sentences) == 3
    assert "i5-8500" in result.tables[0].note
    # a quick solve runs twice and the second run counts; one solve warms up; a refused cell is not tried again
    assert solvers.cprbm.solves == 1 + 2 * 2 * 7 + 3
    # a slow cell is not repeated, and stops no other cell
    slow = measured(quick(), repeat=4, at_most=0.0)
    assert {len(timing.seconds) for timing in slow.rows()} == {1}
    assert len(slow.rows()) == len(table1.CELLS)


@pytest.mark.usefixtures("printed")
def test_the_study_writes_a_page_numbers_and_a_figure_and_is_quiet_on_request(capsys, tmp_path, three_cells):
    out, asked = tmp_path / "new" / "out", ["study", "table1", "--repeat", "1"]
    arguments = [*asked, "--out", str(out), "--json", str(tmp_path / "t.json")]
    assert run(arguments, quick(refuses="gripper paper")) == 0
    captured = capsys.readouterr()
    assert "theirs / ours" in captured.out
    assert captured.err == ""
    data = json.loads((tmp_path / "t.json").read_text("utf-8"))
    assert data == json.loads((out / "table1.json").read_text("utf-8"))
    assert data["machine"]["cpu"]
    assert len(data["rows"]) == len(three_cells) == 3
    row = next(row for row in data["rows"] if row["case"] == "gripper" and row["formulation"] == "auto")
    assert (row["size"], row["paper_seconds"], row["repeats"]) == ({"beam1": 40, "beam2": 30}, 4.32, 1)
    page = (out / "table1.html").read_text("utf-8")
    assert "data:image/svg+xml," in page
    assert 'href="table1.png"' in page
    assert (out / "table1.png").is_file()
    assert run([*asked, "--json", "-"], quick()) == 0
    assert len(json.loads(capsys.readouterr().out)["rows"]) == len(three_cells)
    assert run([*asked, "--quiet"], quick()) == 0
    captured = capsys.readouterr()
    assert captured.out == captured.err == ""


@pytest.mark.usefixtures("three_cells")
def test_an_interrupted_study_keeps_finished_cells_and_an_incomplete_solve_is_code_1(capsys, tmp_path):
    file = tmp_path / "found.json"
    assert run(["study", "table1", "--json", str(file), "--out", str(tmp_path)], quick(until=3)) == 130
    seconds = [row["seconds"] for row in json.loads(file.read_text("utf-8"))["rows"]]
    assert 0 < sum(each is not None for each in seconds) < 3
    assert (tmp_path / "table1.html").is_file()
    assert "Interrupted" in capsys.readouterr().err
    assert run(["study", "table1", "--repeat", "1"], quick(ending=Ending.STEP_TOO_SMALL)) == 1
    captured = capsys.readouterr()
    assert "STEP_TOO_SMALL" in captured.out
    assert "It fell short." in captured.out
