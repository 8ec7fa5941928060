"""The begin of a newcomer: a scene with an answer, the schema, missing libraries, and scenes from drawings.

Curves of a drawing are exact lines and arcs, or splines with a stated deviation; a wrong curve is left out by name.
"""

import json
import math
import os
import shlex
import subprocess
import sys
import tomllib
from dataclasses import replace
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import cprbm
from comparisons import cases
from comparisons.cli import doctor as libraries
from comparisons.cli.doctor import trouble_with
from comparisons.cli.files import SCHEMA, first_scene
from comparisons.cli.main import run
from comparisons.importing.scene_text import fit
from cprbm_scene import Arc, Line, Spline, read
from cprbm_scene.curve_records import shape_of

ROOT = Path(__file__).parents[2]
ALL = libraries.LIBRARIES
"""All libraries, also where a test plants others."""
needs_ezdxf = pytest.mark.skipif(bool(trouble_with("ezdxf")), reason="ezdxf cannot be imported here")
needs_gmsh = pytest.mark.skipif(bool(trouble_with("gmsh")), reason="gmsh cannot be imported here")
FRAME = """
Point(1) = {0, 0, 0}; Point(2) = {70, 0, 0}; Point(3) = {90, 20, 0}; Point(4) = {70, 20, 0}; Point(5) = {90, 60, 0};
Point(6) = {60, 80, 0}; Point(7) = {40, 70, 0}; Point(8) = {0, 90, 0}; Point(9) = {-33, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 5}; Spline(4) = {5, 6, 7, 8}; Line(5) = {1, 9};
Physical Curve("foot") = {1}; Physical Curve("leg") = {2, 3}; Physical Curve("the arch") = {4};
Physical Point("ground") = {1}; Physical Point("tip") = {8};
"""


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
    assert run(["new", "große Feder", "--out", str(tmp_path)]) == 0  # a name has umlauts and spaces
    path = tmp_path / "große Feder.toml"
    assert f"cprbm compare '{path}'" in capsys.readouterr().out
    assert read(path).name == "große Feder"
    assert "cprbm compare 'große Feder.toml'" in path.read_text("utf-8")
    assert run(["new", "still", "--out", str(tmp_path), "--quiet"]) == 0
    assert (tmp_path / "still.toml").exists()
    assert capsys.readouterr().out == ""


def test_the_schema_stands_beside_the_scene_takes_every_built_in_scene_and_refuses_wrong_values(tmp_path, capsys):
    run(["new", "one.toml", "--out", str(tmp_path)])  # a name may have the ending of the file
    capsys.readouterr()
    assert run(["schema"]) == 0
    said = json.loads(capsys.readouterr().out)
    jsonschema.Draft7Validator.check_schema(said)
    assert json.loads((tmp_path / SCHEMA).read_text(encoding="utf-8")) == said
    assert f"#:schema ./{SCHEMA}" in (tmp_path / "one.toml").read_text(encoding="utf-8").splitlines()[0]
    validator = jsonschema.Draft7Validator(said)
    assert len(cases.scenes()) > 5
    for name in cases.scenes():
        validator.validate(cases._data(name))
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
        validator.validate(data)
        *path, last = place
        table = data
        for key in path:
            table = table[key]
        table[last] = value
        with pytest.raises(jsonschema.ValidationError):
            validator.validate(data)


# -- Libraries


def test_the_doctor_names_missing_and_broken_libraries_and_the_installing_command(tmp_path, monkeypatch, capsys):
    asked = (
        libraries.Library("numpy", "numpy", "every number", ">=2.0"),
        libraries.Library("no-such-thing", "nothing", "the impossible", ">=0.7", "dreams"),
        libraries.Library("scipy", "scipy.no_such_part", "linear algebra", "", "dreams"),
        libraries.Library("pydantic", "fatal", "scenes", "", "dreams"),
    )
    (tmp_path / "fatal.py").write_text("import os\nos._exit(7)\n", "utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(libraries, "LIBRARIES", asked)
    assert run(["doctor"]) == 0
    said = capsys.readouterr().out
    line = f'{sys.executable} -m pip install "no-such-thing>=0.7"'
    assert f"no-such-thing  missing      for the impossible; install: {line}\n" in said
    assert "cannot be imported (ModuleNotFoundError: No module named 'scipy.no_such_part')" in said
    assert "importing it ends Python with 7" in said
    monkeypatch.setattr(libraries, "LIBRARIES", (libraries.Library("no-such-thing", "nothing", "all", ""),))
    assert run(["doctor"]) == 1
    # a library that wants a library of the system
    broken = 'raise OSError("libGLU.so.1: cannot open shared object file")\n'
    (tmp_path / "gmsh_of_a_bare_machine.py").write_text(broken, encoding="utf-8")
    library = replace(next(each for each in ALL if each.name == "gmsh"), module="gmsh_of_a_bare_machine")
    monkeypatch.setattr(libraries, "LIBRARIES", (library,))
    monkeypatch.setattr("comparisons.provenance.version", lambda name: "4.0")
    capsys.readouterr()
    assert run(["doctor"]) == 0
    install = "its system libraries, as root: apt-get install --yes --no-install-recommends libgl1 libglu1-mesa"
    assert install in capsys.readouterr().out
    # the folder of Python may have a space
    monkeypatch.setattr(sys, "executable", "/somewhere/of my own/python")
    assert shlex.split(ALL[0].line)[0] == "/somewhere/of my own/python"


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


@pytest.mark.parametrize(
    ("found", "said"),
    [
        ((), "All libraries are installed."),
        (("casadi", "pyvista"), "reports work; casadi, pyvista: only for the purpose beside the name."),
        (("numpy", "casadi"), "A required library is missing; install the library with the command above."),
    ],
)
def test_the_doctor_s_last_line_sums_up_and_a_quiet_doctor_names_missing_required_libraries(
    found, said, monkeypatch, capsys
):
    # whether VTK draws is tried where PyVista is there, and another test's concern
    asked = tuple(each for each in ALL if each.name != "pyvista" or "pyvista" in found)
    install(monkeypatch, asked, missing=found)
    assert run(["doctor"]) == ("numpy" in found)
    assert capsys.readouterr().out.splitlines()[-1].endswith(said)
    assert run(["doctor", "--quiet"]) == ("numpy" in found)
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[:2] for line in lines] == [["numpy", "missing"]] * ("numpy" in found)


def program(tmp_path, *asked):
    """The program in a process whose path begins with a folder."""
    return subprocess.run(
        [sys.executable, "-m", "comparisons", *asked],
        env=os.environ | {"PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    ("library", "asked", "distribution"),
    [
        ("click", ["doctor"], "click"),
        ("numpy", ["solve", "hinge"], "numpy"),
        ("pydantic", ["solve", "hinge"], "pydantic"),
        ("skfem", ["solve", "hinge", "--solver", "fea"], "scikit-fem"),
    ],
)
def test_a_library_of_the_core_that_is_wanting_is_a_sentence(tmp_path, library, asked, distribution):
    """A file with the name of the library fails, as NumPy does without a library of the system."""
    (tmp_path / f"{library}.py").write_text('raise ImportError("\\n\\nPLEASE READ THIS\\n\\nlong advice")\n', "utf-8")
    done = program(tmp_path, *asked)
    assert (done.returncode, done.stdout) == (2, "")
    install = f"{sys.executable} -m pip install --upgrade --force-reinstall {distribution}"
    said = f"cprbm: The library {library} cannot be loaded (PLEASE READ THIS). Install it with: {install}\n"
    assert done.stderr == said
    if library == "numpy":  # the doctor can be asked, too
        (tmp_path / "numpy.py").write_text('raise ImportError("broken")\n', "utf-8")
        done = program(tmp_path, "doctor", "--quiet")
        assert (done.returncode, done.stderr) == (1, "")
        line = done.stdout.splitlines()[0]
        assert "cannot be imported (ImportError: broken); for every number; install the library again: " in line
        assert line.endswith('-m pip install "numpy>=2.0" --force-reinstall')


# -- Scenes from drawings


def import_of(path, *more):
    return run(["import", str(path), "--thickness", "1", "--width", "9", "--out", str(path.parent), *more])


@needs_gmsh
def test_a_drawing_becomes_a_scene_that_is_solved(tmp_path):
    (tmp_path / "frame.geo").write_text(FRAME, encoding="utf-8")
    asked = ["import", str(tmp_path / "frame.geo"), "--thickness", "1.1", "--width", "9", "--out", str(tmp_path)]
    assert run(asked) == 0
    scene = read(tmp_path / "frame.toml")
    assert list(scene.beams) == ["foot", "leg-1", "leg-2", "the_arch"]  # the curve without a tag is none
    foot, bend, leg, arch = scene.beams.values()
    assert foot.curve == Line(kind="line", start=(0.0, 0.0), end=(0.07, 0.0))
    assert isinstance(bend.curve, Arc)
    assert bend.curve.center == pytest.approx((0.07, 0.02), rel=1e-12)
    assert bend.curve.direction == "counterclockwise"
    assert isinstance(leg.curve, Line)
    assert isinstance(arch.curve, Spline)
    assert foot.thickness == pytest.approx(0.0011)
    assert scene.bodies["ground"].points == {"ground-1": (0.0, 0.0)}
    assert scene.place_of("tip") == pytest.approx((0.0, 0.09))
    assert foot.end.point == bend.start.point
    assert arch.end.point == "tip"
    assert cprbm.answer(scene, cprbm.Settings(links=7)).completed
    before = (tmp_path / "frame.toml").read_bytes()
    assert run(asked) == 2  # what is there is kept
    assert run([*asked, "--name", "again"]) == 0
    again = (tmp_path / "again.toml").read_bytes()
    assert again == before.replace(b'name = "frame"', b'name = "again"').replace(b"# frame:", b"# again:")


@needs_gmsh
def test_a_wrong_curve_is_left_out_or_refused_by_name(tmp_path, capsys):
    (tmp_path / "up.geo").write_text(
        "Point(1) = {0, 0, 0}; Point(2) = {7, 0, 3}; Point(3) = {0, 50, 0}; Point(4) = {2, 50, 0}; Line(1) = {1, 2};"
        'Line(2) = {1, 3}; Line(3) = {3, 4}; Physical Curve("up") = {1}; Physical Curve("leg") = {2};'
        'Physical Curve("toe") = {3};\n',
        encoding="utf-8",
    )
    assert import_of(tmp_path / "up.geo") == 0
    assert list(read(tmp_path / "up.toml").beams) == ["leg"]
    said, text = capsys.readouterr().err, (tmp_path / "up.toml").read_text(encoding="utf-8")
    for words in (
        "up (curve 1, Line): found points 3 mm off the plane z = 0; allowed: curves in one plane",
        "toe (curve 3, Line): found 0.001 m, which is 0.5 of the beam's length",
    ):
        assert f"left out: {words}" in said
        assert f"# left out: {words}" in text
    path = tmp_path / "bad.geo"
    for drawing, words in (
        ("Point(1) = {0, 0", "found what gmsh does not read"),
        (
            "Point(1) = {0, 0, 0}; Point(2) = {7, 1, 0}; Point(3) = {3, 5, 0}; Spline(1) = {1, 2, 3, 1}; "
            'Physical Curve("ring") = {1};',
            "ring (curve 1, Nurb): found a curve that comes back",
        ),
    ):
        path.write_text(drawing + "\n", encoding="utf-8")  # gmsh leaves out a last line without an end
        assert import_of(path) == 2
        said = capsys.readouterr().err
        assert str(path) in said
        assert words in said
        assert not (tmp_path / "bad.toml").exists()


@needs_ezdxf
def test_the_curves_of_a_dxf_drawing(tmp_path, capsys):
    """Reference: a bulge is the tangent of a quarter of the arc's angle, so that 1 is a half circle.

    The spline is the symmetric cubic of Bézier through (−10, 4.5) mm, and the ellipse has the half axes 10 and 5 mm.
    """
    import ezdxf

    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_line((0, 0), (40, 0), dxfattribs={"layer": "leg"})
    space.add_arc((40, 20), 20, -90, 0, dxfattribs={"layer": "leg"})
    space.add_lwpolyline([(60, 20, 0), (60, 60, 1), (20, 60, 0)], format="xyb", dxfattribs={"layer": "top"})
    space.add_circle((9, 9), 3, dxfattribs={"layer": "hole"})
    space.add_ellipse((0, 10), (0, -10), 0.5, 0, np.pi / 2, dxfattribs={"layer": "bow"})
    space.add_spline_control_frame([(0, 0), (-10, 0), (-10, 9), (-20, 9)], dxfattribs={"layer": "bend"})
    space.add_point((0, 0), dxfattribs={"layer": "ground"})
    document.saveas(tmp_path / "a.dxf")
    assert import_of(tmp_path / "a.dxf") == 0
    scene = read(tmp_path / "a.toml")
    assert list(scene.beams) == ["leg-1", "leg-2", "top-1", "top-2", "bow", "bend"]
    line, arc, side, half, bow, bend = (beam.curve for beam in scene.beams.values())
    assert line == Line(kind="line", start=(0.0, 0.0), end=(0.04, 0.0))
    assert (arc.center, arc.direction) == (pytest.approx((0.04, 0.02), rel=1e-12), "counterclockwise")
    assert (side.start, side.end) == ((0.06, 0.02), (0.06, 0.06))
    assert (half.center, half.end) == (pytest.approx((0.04, 0.06)), pytest.approx((0.02, 0.06)))
    assert half.direction == "counterclockwise"
    x, y = np.array(bow.points).T
    assert (x / 0.005) ** 2 + ((y - 0.01) / 0.01) ** 2 == pytest.approx(np.ones(len(x)), abs=1e-6)
    assert np.min(np.hypot(*(np.array(bend.points) - [-0.01, 0.0045]).T)) < 1e-6
    assert scene.bodies["ground"].points == {"ground-1": (0.0, 0.0)}
    said = capsys.readouterr().err
    assert "left out: CIRCLE on the layer 'hole'" in said
    assert "no line, arc, spline, elliptic arc or polyline" in said
    assert import_of(tmp_path / "a.dxf", "--unit", "m", "--name", "b") == 2
    assert "a drawing in mm ($INSUNITS = 4), read in m; allowed: --unit mm" in capsys.readouterr().err


def test_a_table_of_points_is_a_curve_and_files_keep_their_accents(tmp_path, capsys):
    (tmp_path / "3 Träger.csv").write_text("nr;X [mm];Y [cm]\n1;0;0\n2;30;0.8\n3;70;0.4\n4;100;0\n", "utf-8-sig")
    assert import_of(tmp_path / "3 Träger.csv") == 0
    scene = read(tmp_path / "_3_Träger.toml")
    assert (scene.name, [*scene.beams]) == ("_3_Träger", ["_3_Träger"])
    assert scene.beams["_3_Träger"].curve.points == ((0.0, 0.0), (0.03, 0.008), (0.07, 0.004), (0.1, 0.0))
    (tmp_path / "bad.csv").write_text("x,y\n0,0\n30,a\n", encoding="utf-8")
    assert import_of(tmp_path / "bad.csv") == 2
    assert "'a' in bad.csv, row 3, column y" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        (
            "m.msh",
            'Printf("x") > "ran";',
            "a file of another format; allowed: a drawing: STEP (.step, .stp), gmsh mesh",
        ),
        ("m.step", 'Printf("x") > "ran";', "a file of another format"),
        ("m.txt", 'Printf("x") > "ran";', "a file of another format"),
        ("m.txt", "ISO-10303-21;", "a STEP file with the ending '.txt'; allowed: the ending .step"),
        ("m.geo", "$MeshFormat", "a gmsh mesh file with the ending '.geo'; allowed: the ending .msh"),
        pytest.param("m.geo", "0\nSECTION\n2\n", "a file that ezdxf does not read", marks=needs_ezdxf),
    ],
)
def test_only_a_geo_file_is_run_as_a_program(tmp_path, capsys, name, text, words):
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert import_of(tmp_path / name) == 2
    assert words in capsys.readouterr().err
    assert sorted(file.name for file in tmp_path.iterdir()) == [name]


def test_points_are_a_line_an_arc_or_a_spline_as_near_as_it_says_and_no_corner():
    t = np.linspace(0.0, 1.0, 57)[:, None]
    made = fit((1.0 - t) * np.array([0.3, 0.1]) + t * np.array([0.9, -0.7]), None, 1e-5)
    assert made.curve == Line(kind="line", start=(0.3, 0.1), end=(0.9, -0.7))
    assert made.deviation < 1e-15
    for first, turn, direction in ((0.3, 1.1, "counterclockwise"), (2.9, -4.7, "clockwise")):
        angle = first + turn * np.linspace(0.0, 1.0, 61)
        made = fit(np.array([13.0, -7.0]) + 0.9 * np.stack([np.cos(angle), np.sin(angle)], axis=1), None, 1e-5)
        assert isinstance(made.curve, Arc)
        assert made.curve.center == pytest.approx((13.0, -7.0), rel=1e-11)
        assert made.curve.direction == direction
    angle = np.linspace(0.2, 1.7, 151)
    p = np.stack([3.0 * np.cos(angle), 3.00003 * np.sin(angle)], axis=1)
    assert isinstance(fit(p, None, 1e-5).curve, Spline)
    t = np.linspace(0.0, 1.0, 201)
    p = np.concatenate([np.stack([t, 0.0 * t], axis=1), np.stack([1.0 + 0.0 * t[1:], t[1:]], axis=1)])
    assert fit(p, None, 1e-9) is None
    # the deviation of a spline is the true deviation: on y = sin x, the distance of a near place (x, y) is
    # |y − sin x|/√(1 + cos²x) to first order
    x = np.linspace(0.0, 3.0, 1001)
    ways = np.array([[1.0, math.cos(at)] for at in (0.0, 3.0)])
    ways /= np.hypot(ways[:, 0], ways[:, 1])[:, None]
    made = fit(np.stack([x, np.sin(x)], axis=1), ways, 3e-5)
    assert isinstance(made.curve, Spline)
    assert made.deviation <= 3e-5
    px, py = shape_of(made.curve).point(np.linspace(0.0, 1.0, 4001)).T
    true = float(np.max(np.abs(py - np.sin(px)) / np.hypot(1.0, np.cos(px))))
    chord = (3.7 / 8000) ** 2 / 8.0  # measured against a polyline, whose height over a chord is κh²/8 with κ ≤ 1
    assert made.deviation == pytest.approx(true, abs=chord)
