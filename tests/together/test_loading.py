"""Probes, drives and loads by stage, and the solvers that answer."""

import json

import pytest

import cprbm
import elastica_reference
import fea_reference
from comparisons.cli.main import run
from cprbm_scene import SceneError, scene_from
from fea_reference import solid
from tests.cprbm_scene.editing import REMOVED, edited, mistakes
from tests.robustness.toml import toml_of
from tests.together.features import CIRCLE, FORCE, held_by, pressed_then_held, probes, stepped_together

SOLVERS = {
    "cprbm": lambda scene: cprbm.answer(scene, cprbm.Settings(links=10)),
    "fea": lambda scene: fea_reference.answer(scene, fea_reference.Settings(elements=8)),
    "exact": elastica_reference.answer,
    "solid": lambda scene: solid.answer(scene, solid.Settings(elements=8, across=1)),
}


def two_stages(**stages):
    """A cantilever, pressed on a circle and then pulled; ``stages`` of probes by the names of parts."""
    data = held_by(CIRCLE) | {"probes": probes("T.displacement", "c.force", "R.reaction", "beam.bending_stress")}
    data["loads"] |= {"H": {"kind": "force", "point": "T", "direction": [1.0, 0.0]}}
    steps = {"down": ("F", 1.5 * FORCE), "pull": ("H", FORCE)}
    data["stages"] = [{"name": name, "steps": load, "stations": [value]} for name, (load, value) in steps.items()]
    for probe in data["probes"]:
        if probe["of"] in stages:
            probe["stages"] = [stages[probe["of"]]]
    return data


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_probe_is_asked_in_some_stages(solver):
    # reference: the same scene without the key, whose values are the same to the last bit
    all_, some = (SOLVERS[solver](scene_from(data)) for data in (two_stages(), two_stages(c="pull", beam="down")))
    assert some.completed
    for whole, part in zip(all_.stations, some.stations, strict=True):
        for name, value in part.values.items():
            asked = name.split(".")[0] != {"down": "c", "pull": "beam"}[part.stage]
            assert value.tolist() == (whole.values[name].tolist() if asked else []), name


def test_rows_of_a_comparison_are_those_asked(tmp_path, capsys):
    path = tmp_path / "stages.toml"
    path.write_text(toml_of(two_stages(c="pull", beam="down")), encoding="utf-8")
    run(["compare", str(path), "-n", "8", "--elements", "8", "--no-exact", "--json", "-"])
    rows = json.loads(capsys.readouterr().out)["cases"][0]["rows"]
    asked = {"down": ["T.displacement", "R.reaction", "beam.bending_stress"]}
    asked["pull"] = ["T.displacement", "c.force", "R.reaction"]
    expected = [(stage, probe) for stage, names in asked.items() for probe in names]
    assert [(row["stage"], row["probe"]) for row in rows] == expected


def test_a_drive_holds_from_a_stage_on():
    scene = scene_from(pressed_then_held())
    assert [scene.holds(scene.drives["d"], stage.name) for stage in scene.stages] == [False, True]
    early = mistakes(("stages/0/steps", "d"), base=pressed_then_held())
    assert "free until the stage 'hold'" in early["stages[0].steps"]
    assert "driven by drives.d" in mistakes(("drives/d/from", REMOVED), base=pressed_then_held())["loads.F"]


def test_loads_are_stepped_together():
    stage = scene_from(stepped_together()).stages[0]
    assert (stage.steps, stage.together) == ("F", ("F", "H"))
    moment = edited(("loads/H", {"kind": "moment", "body": "tip"}), base=stepped_together())
    assert "loads in N and m*N" in mistakes(base=moment)["stages[0].steps"]


@pytest.mark.parametrize(
    ("data", "key"),
    [(pressed_then_held(), "drives.d.from"), (stepped_together(), "stages[0].steps")],
    ids=["from", "together"],
)
@pytest.mark.parametrize("solver", [name for name in SOLVERS if name != "cprbm"])
def test_the_cprbm_alone_answers(solver, data, key):
    with pytest.raises(SceneError) as refused:
        SOLVERS[solver](scene_from(data))
    assert [mistake.key for mistake in refused.value.mistakes] == [key]


@pytest.mark.parametrize("data", [pressed_then_held(), stepped_together()], ids=["from", "together"])
def test_the_audit_finds_nothing_wrong_in_the_answer(data, tmp_path, capsys):
    """The audit has the loads of a list, and no value of a drive that is free."""
    path = tmp_path / "scene.toml"
    path.write_text(toml_of(data), encoding="utf-8")
    assert run(["solve", str(path), "-n", "8", "--quiet"]) == 0
    assert "audit" not in capsys.readouterr().err


def test_a_station_has_values_of_all_loads_and_of_held_drives():
    held, together = scene_from(pressed_then_held()), scene_from(stepped_together())
    assert held.values_at("press", 2.0) == {"F": 2.0}
    assert held.values_at("hold", 0.004) == {"F": FORCE, "d": 0.004}
    assert together.values_at(together.stages[0].name, 3.0) == {"F": 3.0, "H": 3.0}
