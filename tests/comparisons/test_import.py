"""Scenes from drawings: exact lines and arcs, splines with a stated deviation, left-out curves, refused files."""

import math

import numpy as np
import pytest

import cprbm
from comparisons.cli.doctor import trouble_with
from comparisons.cli.main import run
from comparisons.importing.scene_text import fit
from cprbm_scene import Arc, Line, Spline, read

needs_ezdxf = pytest.mark.skipif(bool(trouble_with("ezdxf")), reason="ezdxf cannot be imported here")
needs_gmsh = pytest.mark.skipif(bool(trouble_with("gmsh")), reason="gmsh cannot be imported here")

FRAME = """
Point(1) = {0, 0, 0}; Point(2) = {70, 0, 0}; Point(3) = {90, 20, 0}; Point(4) = {70, 20, 0}; Point(5) = {90, 60, 0};
Point(6) = {60, 80, 0}; Point(7) = {40, 70, 0}; Point(8) = {0, 90, 0}; Point(9) = {-33, 0, 0};
Line(1) = {1, 2}; Circle(2) = {2, 4, 3}; Line(3) = {3, 5}; Spline(4) = {5, 6, 7, 8}; Line(5) = {1, 9};
Physical Curve("foot") = {1}; Physical Curve("leg") = {2, 3}; Physical Curve("the arch") = {4};
Physical Point("ground") = {1}; Physical Point("tip") = {8};
"""


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
@pytest.mark.parametrize(
    ("drawing", "words"),
    [
        ("Point(1) = {0, 0", "found what gmsh does not read"),
        (
            "Point(1) = {0, 0, 0}; Point(2) = {7, 1, 0}; Point(3) = {3, 5, 0}; Spline(1) = {1, 2, 3, 1}; "
            'Physical Curve("ring") = {1};',
            "ring (curve 1, Nurb): found a curve that comes back",
        ),
    ],
    ids=["syntax", "ring"],
)
def test_what_is_no_beam_is_refused_by_name(tmp_path, capsys, drawing, words):
    path = tmp_path / "bad.geo"
    path.write_text(drawing + "\n", encoding="utf-8")  # gmsh leaves out a last line without an end
    assert run(["import", str(path), "--thickness", "1", "--width", "9", "--out", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert str(path) in said
    assert words in said
    assert not (tmp_path / "bad.toml").exists()


def import_of(path, *more):
    return run(["import", str(path), "--thickness", "1", "--width", "9", "--out", str(path.parent), *more])


@needs_gmsh
def test_a_wrong_curve_is_left_out_and_named_in_the_scene(tmp_path, capsys):
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


def test_a_table_of_points_is_a_curve(tmp_path, capsys):
    (tmp_path / "arch.csv").write_text("nr;X [mm];Y [cm]\n1;0;0\n2;30;0.8\n3;70;0.4\n4;100;0\n", "utf-8-sig")
    assert import_of(tmp_path / "arch.csv") == 0
    curve = read(tmp_path / "arch.toml").beams["arch"].curve
    assert curve.points == ((0.0, 0.0), (0.03, 0.008), (0.07, 0.004), (0.1, 0.0))
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


def test_layers_and_files_keep_their_accents(tmp_path):
    path = tmp_path / "3 Träger.csv"
    path.write_text("x,y\n0,0\n30,1\n60,0\n", encoding="utf-8")
    assert import_of(path) == 0
    scene = read(tmp_path / "_3_Träger.toml")
    assert (scene.name, [*scene.beams]) == ("_3_Träger", ["_3_Träger"])


def test_points_of_a_line_are_a_line():
    t = np.linspace(0.0, 1.0, 57)[:, None]
    made = fit((1.0 - t) * np.array([0.3, 0.1]) + t * np.array([0.9, -0.7]), None, 1e-5)
    assert made.curve == Line(kind="line", start=(0.3, 0.1), end=(0.9, -0.7))
    assert made.deviation < 1e-15


@pytest.mark.parametrize(("first", "turn"), [(0.3, 1.1), (2.9, -4.7)])
def test_points_of_a_circle_are_an_arc(first, turn):
    angle = first + turn * np.linspace(0.0, 1.0, 61)
    p = np.array([13.0, -7.0]) + 0.9 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    made = fit(p, None, 1e-5)
    assert isinstance(made.curve, Arc)
    assert made.curve.center == pytest.approx((13.0, -7.0), rel=1e-11)
    assert made.curve.direction == ("counterclockwise" if turn > 0.0 else "clockwise")


def test_points_of_no_exact_circle_make_a_spline_and_a_corner_makes_none():
    angle = np.linspace(0.2, 1.7, 301)
    p = np.stack([3.0 * np.cos(angle), 3.00003 * np.sin(angle)], axis=1)
    assert isinstance(fit(p, None, 1e-5).curve, Spline)
    t = np.linspace(0.0, 1.0, 201)
    p = np.concatenate([np.stack([t, 0.0 * t], axis=1), np.stack([1.0 + 0.0 * t[1:], t[1:]], axis=1)])
    assert fit(p, None, 1e-9) is None


def test_a_spline_is_as_near_as_it_says():
    """On y = sin x, whose distance from a place (x, y) near it is |y − sin x|/√(1 + cos²x) to first order."""
    x = np.linspace(0.0, 3.0, 2001)
    ways = np.array([[1.0, math.cos(at)] for at in (0.0, 3.0)])
    ways /= np.hypot(ways[:, 0], ways[:, 1])[:, None]
    made = fit(np.stack([x, np.sin(x)], axis=1), ways, 3e-5)
    assert isinstance(made.curve, Spline)
    assert made.deviation <= 3e-5
    from cprbm_scene.curve_records import shape_of

    px, py = shape_of(made.curve).point(np.linspace(0.0, 1.0, 4001)).T
    true = float(np.max(np.abs(py - np.sin(px)) / np.hypot(1.0, np.cos(px))))
    chord = (3.7 / 8000) ** 2 / 8.0  # measured against a polyline, whose height over a chord is κh²/8 with κ ≤ 1
    assert made.deviation == pytest.approx(true, abs=chord)
