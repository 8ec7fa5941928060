"""The begin of a newcomer: a scene with an answer, the schema, and missing libraries."""

import json
import os
import shlex
import subprocess
import sys
import tomllib
from dataclasses import replace
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import jsonschema
import pytest

import cprbm
from comparisons import cases
from comparisons.cli import doctor as libraries
from comparisons.cli.files import SCHEMA, first_scene
from comparisons.cli.main import run
from cprbm_scene import read
from cprbm_scene.reading import schema

ROOT = Path(__file__).parents[2]


def test_the_first_scene_is_solved_and_touches_and_is_not_written_over(tmp_path, capsys):
    assert run(["new", "my-strip", "--out", str(tmp_path)]) == 0
    path = tmp_path / "my-strip.toml"
    assert str(path) in capsys.readouterr().out
    scene = read(path)
    assert scene.name == "my-strip"
    answer = cprbm.answer(scene, cprbm.Settings(links=23))
    assert answer.completed
    assert "pin" in answer.stations[-1].touching
    path = tmp_path / "mine.toml"
    path.write_text("my own", encoding="utf-8")
    assert run(["new", "mine", "--out", str(tmp_path)]) == 2
    assert "mine.toml, an existing file; allowed: another name" in capsys.readouterr().err
    assert path.read_text(encoding="utf-8") == "my own"


def test_a_name_has_umlauts_and_spaces(tmp_path, capsys):
    assert run(["new", "große Feder", "--out", str(tmp_path)]) == 0
    path = tmp_path / "große Feder.toml"
    assert f"cprbm compare '{path}'" in capsys.readouterr().out
    assert read(path).name == "große Feder"
    assert "cprbm compare 'große Feder.toml'" in path.read_text("utf-8")


def test_the_schema_is_one_and_stands_beside_the_scene(tmp_path, capsys):
    run(["new", "one.toml", "--out", str(tmp_path)])  # a name may have the ending of the file
    capsys.readouterr()
    assert run(["schema"]) == 0
    said = json.loads(capsys.readouterr().out)
    jsonschema.Draft7Validator.check_schema(said)
    assert json.loads((tmp_path / SCHEMA).read_text(encoding="utf-8")) == said
    assert f"#:schema ./{SCHEMA}" in (tmp_path / "one.toml").read_text(encoding="utf-8").splitlines()[0]


def test_every_built_in_scene_is_as_the_schema_says():
    assert len(cases.scenes()) > 5
    for name in cases.scenes():
        jsonschema.validate(cases._data(name), schema())


def test_the_schema_refuses_what_reading_refuses():
    for place, value in (
        (("beams", "strip", "thicknes"), 0.001),
        (("beams", "strip", "thickness"), -0.001),
        (("beams", "strip", "curve", "kind"), "parabola"),
        (("beams", "strip", "start", "joint"), "glue"),
        (("contacts", "pin", "radius"), "wide"),
        (("stages",), []),
        (("file",), "somewhere"),
    ):
        data = tomllib.loads(first_scene("strip", "strip.toml"))
        jsonschema.validate(data, schema())
        *path, last = place
        table = data
        for key in path:
            table = table[key]
        table[last] = value
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(data, schema())


def test_the_doctor_names_what_is_missing_and_what_installs_it(monkeypatch, capsys):
    asked = (
        libraries.Library("numpy", "numpy", "every number", ">=2.0"),
        libraries.Library("no-such-thing", "nothing", "the impossible", ">=0.7", "dreams"),
        libraries.Library("scipy", "scipy.no_such_part", "linear algebra", "", "dreams"),
    )
    monkeypatch.setattr(libraries, "LIBRARIES", asked)
    assert run(["doctor"]) == 0
    said = capsys.readouterr().out
    line = f'{sys.executable} -m pip install "no-such-thing>=0.7"'
    assert f"no-such-thing  missing      for the impossible; install: {line}\n" in said
    assert "cannot be imported (ModuleNotFoundError: No module named 'scipy.no_such_part')" in said
    monkeypatch.setattr(libraries, "LIBRARIES", (libraries.Library("no-such-thing", "nothing", "all", ""),))
    assert run(["doctor"]) == 1


def install(monkeypatch, asked, missing):
    """Let the ``asked`` libraries be installed and sound, except the ``missing`` ones."""

    def version(name):
        if name in missing:
            raise PackageNotFoundError(name)
        return "9.9"

    monkeypatch.setattr(libraries, "LIBRARIES", asked)
    monkeypatch.setattr("comparisons.provenance.version", version)
    monkeypatch.setattr(libraries, "trouble_with", lambda module: "")


def test_the_doctor_lists_all_that_the_project_asks_for():
    from packaging.requirements import Requirement

    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = {
        name: asked for name, asked in project["optional-dependencies"].items() if name not in ("build", "docs", "test")
    }
    wanted = {(Requirement(each), "") for each in project["dependencies"]}
    wanted |= {(Requirement(each), extra) for extra, asked in extras.items() for each in asked}
    told = {(Requirement(library.name + library.least), library.extra) for library in libraries.LIBRARIES}
    assert told <= wanted
    assert {requirement for requirement, _ in told} == {requirement for requirement, _ in wanted}


def test_a_library_that_wants_one_of_the_system_is_told_with_what_installs_it(tmp_path, monkeypatch, capsys):
    broken = 'raise OSError("libGLU.so.1: cannot open shared object file")\n'
    (tmp_path / "gmsh_of_a_bare_machine.py").write_text(broken, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    gmsh = next(library for library in libraries.LIBRARIES if library.name == "gmsh")
    library = replace(gmsh, module="gmsh_of_a_bare_machine")
    monkeypatch.setattr(libraries, "LIBRARIES", (library,))
    monkeypatch.setattr("comparisons.provenance.version", lambda name: "4.0")
    assert run(["doctor"]) == 0
    assert (
        "its system libraries, as root: apt-get install --yes --no-install-recommends libgl1 libglu1-mesa"
        in capsys.readouterr().out
    )


@pytest.mark.parametrize(
    ("found", "said"),
    [
        ((), "All libraries are installed."),
        (("casadi", "pyvista"), "reports work; casadi, pyvista: only for the purpose beside the name."),
        (("numpy", "casadi"), "A required library is missing; install the library with the command above."),
    ],
)
def test_the_doctor_s_last_line_sums_up(found, said, monkeypatch, capsys):
    # whether VTK draws is tried where PyVista is there, and another test's concern
    asked = tuple(each for each in libraries.LIBRARIES if each.name != "pyvista" or "pyvista" in found)
    install(monkeypatch, asked, missing=found)
    assert run(["doctor"]) == ("numpy" in found)
    assert capsys.readouterr().out.splitlines()[-1].endswith(said)


def test_a_library_that_ends_the_process_is_no_end_of_the_doctor(tmp_path, monkeypatch):
    (tmp_path / "fatal.py").write_text("import os\nos._exit(7)\n", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    assert libraries.trouble_with("fatal") == "importing it ends Python with 7"


def test_quiet_says_nothing_of_what_is_in_order(tmp_path, capsys):
    assert run(["new", "still", "--out", str(tmp_path), "--quiet"]) == 0
    assert (tmp_path / "still.toml").exists()
    assert capsys.readouterr().out == ""


def test_a_quiet_doctor_says_what_is_needed_and_missing_alone(monkeypatch, capsys):
    there, gone = libraries.LIBRARIES[0], libraries.LIBRARIES[1]
    extra = next(library for library in libraries.LIBRARIES if library.extra)
    install(monkeypatch, (there, gone, extra), missing=(gone.name, extra.name))
    assert run(["doctor", "--quiet"]) == 1
    (line,) = capsys.readouterr().out.splitlines()
    assert line.split()[:2] == [gone.name, "missing"]


@pytest.mark.parametrize(
    ("library", "asked", "said"),
    [
        ("click", ["doctor"], "The library click cannot be loaded"),
        ("numpy", ["solve", "hinge"], "The library numpy cannot be loaded"),
        ("pydantic", ["solve", "hinge"], "The library pydantic cannot be loaded"),
        ("skfem", ["solve", "hinge", "--solver", "fea"], "The library skfem cannot be loaded"),
    ],
)
def test_a_library_of_the_core_that_is_wanting_is_a_sentence(tmp_path, library, asked, said):
    """It stands in the way of its own name, as NumPy's does where a library of the system is wanting."""
    (tmp_path / f"{library}.py").write_text('raise ImportError("\\n\\nPLEASE READ THIS\\n\\nlong advice")\n', "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "comparisons", *asked],
        env=os.environ | {"PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert done.stdout == ""
    distribution = {"skfem": "scikit-fem"}.get(library, library)
    install = f"{sys.executable} -m pip install --upgrade --force-reinstall {distribution}"
    assert done.stderr == f"cprbm: {said} (PLEASE READ THIS). Install it with: {install}\n"


def test_the_line_that_installs_is_one_for_a_shell(monkeypatch):
    """A folder's name may have a space."""
    monkeypatch.setattr(sys, "executable", "/somewhere/of my own/python")
    assert shlex.split(libraries.LIBRARIES[0].line)[0] == "/somewhere/of my own/python"


def test_the_doctor_can_be_asked_where_numpy_is_wanting(tmp_path):
    (tmp_path / "numpy.py").write_text('raise ImportError("broken")\n', "utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "comparisons", "doctor", "--quiet"],
        env=os.environ | {"PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    numpy = done.stdout.splitlines()[0]
    assert "cannot be imported (ImportError: broken); for every number; install the library again: " in numpy
    assert numpy.endswith('-m pip install "numpy>=2.0" --force-reinstall')
    assert done.stderr == ""
