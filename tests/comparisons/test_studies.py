"""The studies beside planted solvers whose errors are known in closed form."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest

from comparisons import cases, documents
from comparisons.budgets.poisson import with_ratio
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers, cprbm_answer, fea_answer
from comparisons.studies import materials, table1
from comparisons.studies.materials import MATERIALS, SPECIMENS
from comparisons.studies.materials_told import told as told_of_materials
from comparisons.studies.table1_told import told as told_of_table1
from cprbm_scene import Answer, Ending, Mistake, Scene, SceneError
from cprbm_scene.answer import frozen_array
from cprbm_scene.frozendict import frozendict
from tests.comparisons.made_up import MadeUp

E_0 = 2.3e9
STRETCH, SHEAR = 0.001, 0.002
MACHINE = {
    "cpu": "a", "cores": 1, "system": "b", "python": "c", "numpy": "d", "scipy": "e", "scikit-fem": "f",
}  # fmt: skip


class Elastic:
    """An answer that goes with the load over E; stretch adds a share, and shear one that goes with 1 + ν."""

    def __init__(self, solver):
        self.solver = solver

    def __call__(self, scene, choices):
        (material,) = scene.materials.values()
        factor = 1.0
        if self.solver == "fea":
            factor += STRETCH * (choices.kinematics != "bending")
            factor += SHEAR * (1.0 + material.poisson_ratio) * (choices.kinematics == "shear")
        answer = MadeUp(self.solver, 0.0)(scene, choices)
        stations = []
        for station in answer.stations:
            reach = factor * station.value / material.youngs_modulus * E_0
            values = {
                probe.name: frozen_array(
                    [0.01 * reach, 0.02 * reach]
                    if probe.quantity == "displacement"
                    else [3.0 * reach * material.youngs_modulus / E_0]
                )
                for probe in scene.probes
            }
            stations.append(replace(station, values=frozendict(values)))
        return replace(answer, stations=tuple(stations))


ELASTIC = Solvers(Elastic("cprbm"), Elastic("fea"))


def error(poisson_ratio):
    """(f − 1)/f with f what the finite elements in shear answer for the CPRBM's 1."""
    f = 1.0 + STRETCH + SHEAR * (1.0 + poisson_ratio)
    return (f - 1.0) / f


def measured(*specimens):
    found = materials.Materials()
    for piece in materials.pieces(specimens):
        found = found.with_piece(piece(ELASTIC))
    return found


@pytest.fixture(scope="module")
def hinge_of_materials():
    return measured(SPECIMENS[0])


def test_a_material_takes_the_place_of_the_scenes_and_its_loads_are_scaled():
    scene = materials.of_material(cases.opened("hinge"), MATERIALS["steel"])
    assert {each.youngs_modulus for each in scene.materials.values()} == {2.0e11}
    np.testing.assert_allclose(scene.stages[0].stations[-1], 0.67 * 2.0e11 / 2.3e9, rtol=1e-14)
    driven = cases.opened("gripper-driven")
    assert materials.of_material(driven, MATERIALS["steel"]).stages == driven.stages  # a displacement stays


def test_a_scene_of_two_materials_is_refused():
    scene = cases.opened("hinge")
    two = scene.model_copy(update={"materials": frozendict({**scene.materials, "other": MATERIALS["steel"]})})
    with pytest.raises(ValueError, match="2 materials"):
        materials.of_material(two, MATERIALS["steel"])


@pytest.mark.parametrize("specimen", SPECIMENS)
def test_a_specimen_asks_for_its_displacements_and_forces_at_the_last_load(specimen):
    scene, whole = materials.question(specimen), cases.opened(specimen.case)
    assert [stage.stations for stage in scene.stages] == [stage.stations[-1:] for stage in whole.stages]
    assert {claim.probe for claim in scene.claims} == {f"{point}.displacement" for point in specimen.displaced}
    assert {probe.of for probe in scene.probes if probe.quantity == "force"} == set(scene.contacts)


def test_errors_claims_and_scaled_forces_are_the_planted_ones(hinge_of_materials):
    rows = told_of_materials(hinge_of_materials).data["rows"]
    displaced = [row for row in rows if row["unit"] == "m"]
    assert len(displaced) == 6
    for row in displaced:
        material = MATERIALS[row["material"]]
        assert row["difference"] == pytest.approx(error(material.poisson_ratio), rel=1e-9)
        assert row["shear_ratio"] == pytest.approx(2.0 * (1.0 + material.poisson_ratio), rel=1e-15)
        assert row["claim"] == 0.008
        assert row["claim_met"] is True
        assert sum(row["steps"].values()) == pytest.approx(row["difference"], rel=1e-9)
    for row in rows:
        assert row["difference_bending"] == pytest.approx(0.0, abs=1e-14)
        if row["unit"] == "N":
            assert row["cprbm"] / row["scaled_by"] == pytest.approx(3.0 * 0.67, rel=1e-12)


def test_the_sweep_is_the_planted_line(hinge_of_materials):
    (sweep,) = hinge_of_materials.sweeps
    for errors in sweep.errors.values():
        assert errors == pytest.approx([error(ratio) for ratio in sweep.poisson_ratios], rel=1e-9)
    for without in sweep.without_shear.values():
        assert without["bending"] == pytest.approx(0.0, abs=1e-14)
        assert without["stretch"] == pytest.approx(STRETCH / (1.0 + STRETCH), rel=1e-9)


def test_everything_told_is_whole(hinge_of_materials):
    told = told_of_materials(hinge_of_materials)
    assert len(told.sheets) == 4
    for sheet in told.sheets:
        assert {len(row) for row in sheet.rows} == {len(sheet.headers)}
    assert any("2(1 + ν)" in sentence for sentence in told.words)
    assert told.pictures[0].png.startswith(b"\x89PNG")
    assert set(json.loads(documents.text(told.data))) == {"study", "rows", "verdicts", "bending_spread", "poisson"}


def test_a_claim_that_is_missed_is_said_to_be(hinge_of_materials):
    assert not any("not met" in sentence for sentence in told_of_materials(hinge_of_materials).words)
    strict = measured(replace(SPECIMENS[0], bound=1e-3))
    assert any("0.100 % for the hinge is not met" in sentence for sentence in told_of_materials(strict).words)


def test_with_nothing_measured_there_is_something_to_tell():
    told = told_of_materials(materials.Materials())
    assert told.sheets == ()
    assert told.pictures == ()
    assert documents.text(told.data)


def test_a_solve_that_ends_early_leaves_a_line_that_says_so():
    early = Solvers(MadeUp("cprbm", 0.0, until=0), ELASTIC.fea)
    piece, *_ = materials.pieces(SPECIMENS[:1])
    told = told_of_materials(materials.Materials().with_piece(piece(early)))
    assert told.sheets[0].rows[0][-1] == "UNDECIDED"
    assert told.data["rows"] == []
    assert told.data["verdicts"][0]["verdict"] == "UNDECIDED"


def test_in_real_bending_e_cancels_and_shear_goes_with_one_plus_the_ratio():
    """The hinge with few links and elements; to round-off, and to what is of second order in the shear."""
    scene = materials.question(SPECIMENS[0])
    choices = Choices(links=8, elements=8)
    (D,) = (probe for probe in scene.probes if probe.name == "D.displacement")
    errors = []
    for name in ("ABS", "steel"):
        asked = materials.of_material(scene, MATERIALS[name])
        answers = cprbm_answer(asked, choices), fea_answer(asked, choices.within("bending"))
        errors.append(materials.error_of(asked, D, *answers))
    assert errors[0] == pytest.approx(errors[1], abs=1e-9)
    cprbm = cprbm_answer(scene, choices)
    errors = [
        materials.error_of(scene, D, cprbm, fea_answer(with_ratio(scene, ratio), choices)) for ratio in (0.0, 0.2, 0.4)
    ]
    assert None not in errors
    first, second = np.diff(np.array(errors, dtype=float))
    assert abs(first) > 1e-4
    assert second == pytest.approx(first, rel=0.02)


@dataclass
class Clocked:
    """Answers at once, refuses or breaks off as told; counts its solves."""

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


def planted(**faults):
    return Solvers(Clocked(MadeUp("cprbm", 0.0), **faults), Clocked(MadeUp("fea", 0.0)))


def nothing(scene, choices):
    """An answer without stations, for what looks at times alone."""
    return Answer("made up", scene.name, frozendict(), Ending.COMPLETED, "", ())


def quick(**faults):
    return Solvers(Clocked(nothing, **faults), Clocked(nothing))


def test_table1_has_the_papers_discretisations_and_times():
    """Table 1 of the paper, and the gripper's (30, 40) of its section 3.3."""
    theirs = {(cell.case, cell.method, cell.contact, cell.sized): cell.theirs for cell in table1.CELLS}
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


def test_a_cell_is_asked_at_its_last_load_alone_and_without_contact_where_it_says_so():
    for cell in table1.CELLS:
        scene = table1.question(cell)
        assert [stage.stations for stage in scene.stages] == [((0.67,) if cell.case == "hinge" else (16.0,))]
        assert bool(scene.contacts) is cell.contact
        if not cell.contact:
            assert {probe.of for probe in scene.probes}.isdisjoint(cases.opened(cell.case).contacts)
            assert scene.probes


def test_every_cell_is_solved_as_often_as_asked_and_a_refusal_is_said():
    solvers = quick(refuses="gripper paper")
    table = table1.begun(solvers, MACHINE)
    for cell in table1.runs(2):
        table = table1.solved(table, cell, solvers, at_most=60.0)
    refused = [cell for cell in table1.CELLS if cell.case == "gripper" and cell.formulation == "paper"]
    for cell, times in table.times.items():
        if cell in refused:
            assert times.seconds == ()
            assert times.why == "contacts.circle.paper: found nothing; allowed: a boundary"
        else:
            assert len(times.seconds) == 2
            assert times.median is not None
            assert times.median > 0.0
    assert not table.unfinished
    told = told_of_table1(table)
    assert [row[-1] for row in told.sheets[0].rows].count("refused") == 3
    assert sum("found nothing" in sentence for sentence in told.words) == 3
    assert "i5-8500" in told.sheets[0].note
    # one solve warms up, and a refused cell is not tried again
    assert solvers.cprbm.solves == 1 + 2 * 7 + 3


def test_a_slow_cell_is_not_repeated():
    solvers = quick()
    cell = table1.CELLS[0]
    table = table1.begun(solvers, MACHINE, (cell,))
    for each in table1.runs(4, (cell,)):
        table = table1.solved(table, each, solvers, at_most=0.0)
    assert len(table.times[cell].seconds) == 1


def test_study_without_a_name_lists_the_studies(capsys):
    assert run(["study"]) == 0
    names = [line.split()[0] for line in capsys.readouterr().out.splitlines()]
    assert names == ["calibration", "materials", "readings", "relations", "table1"]


def test_an_unknown_study_is_refused_with_those_that_there_are(capsys):
    assert run(["study", "material"]) == 2
    said = capsys.readouterr().err
    assert "'material'" in said
    assert "materials, readings, relations, table1" in said


def test_table1_writes_a_page_numbers_and_a_figure(capsys, tmp_path):
    out = tmp_path / "new" / "out"
    arguments = ["study", "table1", "--repeat", "1", "--out", str(out), "--json", str(tmp_path / "t.json")]
    assert run(arguments, quick(refuses="gripper paper")) == 0
    captured = capsys.readouterr()
    assert "theirs / ours" in captured.out
    assert captured.err == ""
    data = json.loads((tmp_path / "t.json").read_text("utf-8"))
    assert data == json.loads((out / "table1.json").read_text("utf-8"))
    assert data["machine"]["cpu"]
    assert len(data["rows"]) == len(table1.CELLS)
    row = next(row for row in data["rows"] if row["case"] == "gripper" and row["formulation"] == "auto")
    assert row["size"] == {"beam1": 40, "beam2": 30}
    assert row["paper_seconds"] == 4.32
    assert row["repeats"] == 1
    page = (out / "table1.html").read_text("utf-8")
    assert "data:image/svg+xml;base64," in page
    assert 'href="table1.png"' in page
    assert (out / "table1.png").is_file()


def test_materials_keeps_standard_output_for_json(capsys):
    assert run(["study", "materials", "--json", "-"], ELASTIC) == 0
    data = json.loads(capsys.readouterr().out)
    assert {(row["case"], row["material"]) for row in data["rows"]} == {
        (case, material) for case in ("hinge", "gripper") for material in MATERIALS
    }


def test_quiet_prints_nothing(capsys):
    assert run(["study", "materials", "--quiet"], ELASTIC) == 0
    captured = capsys.readouterr()
    assert captured.out == captured.err == ""


@pytest.mark.parametrize(("study", "solvers"), [("table1", quick(until=6)), ("materials", planted(until=6))])
def test_an_interrupted_study_keeps_what_was_finished(study, solvers, capsys, tmp_path):
    file = tmp_path / "found.json"
    assert run(["study", study, "--json", str(file), "--out", str(tmp_path)], solvers) == 130
    data = json.loads(file.read_text("utf-8"))
    measured = [row for row in data["rows"] if row.get("seconds", row.get("difference")) is not None]
    assert measured
    assert len(measured) < 16
    assert (tmp_path / f"{study}.html").is_file()
    assert "Interrupted" in capsys.readouterr().err


def test_a_solve_that_does_not_complete_ends_with_1(capsys):
    assert run(["study", "table1", "--repeat", "1"], quick(ending=Ending.STEP_TOO_SMALL)) == 1
    captured = capsys.readouterr()
    assert "STEP_TOO_SMALL" in captured.out
    assert "It fell short." in captured.out
    assert run(["study", "materials"], planted(ending=Ending.STEP_TOO_SMALL)) == 1
    assert Ending.STEP_TOO_SMALL.value in " ".join(capsys.readouterr().out.split())


def test_a_place_that_cannot_be_written_is_found_before_anything_is_solved(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    solvers = quick()
    assert run(["study", "table1", "--out", str(tmp_path / "file" / "out")], solvers) == 2
    assert solvers.cprbm.solves == 0


@pytest.mark.parametrize(("arguments", "said"), [(["--repeat", "0"], "'0'"), (["--at-most", "nan"], "'nan'")])
def test_a_wrong_option_is_named(arguments, said, capsys):
    assert run(["study", "table1", *arguments], quick()) == 2
    assert said in capsys.readouterr().err


def test_the_choices_are_the_papers():
    assert SPECIMENS[0].choices == Choices(links=40, elements=80)
    assert dict(SPECIMENS[1].choices.links) == {"beam1": 30, "beam2": 40}
