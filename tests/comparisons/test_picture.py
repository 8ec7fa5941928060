"""Pictures: places, forces and limits of the drawing list, windows, and the files of ``view``.

The cells of a series of files have the volumes and the stresses of the beams.
"""

import io
import math
import os
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

import cprbm
from comparisons import cases
from comparisons.choices import Choices
from comparisons.cli.doctor import trouble_with
from comparisons.cli.main import run
from comparisons.formats import display_unit
from comparisons.geometry import longest
from comparisons.present import curves, figures
from comparisons.present import view as pictures
from comparisons.present.picture import Arrow, Bounds, bounds_of, carried, outline_of, view_of
from comparisons.present.strips import SECTIONS, left_of, with_stresses
from comparisons.present.view import ACROSS, beam_block, force_block, obstacle_block
from cprbm_scene import (
    Certificate,
    CircleContact,
    FunctionContact,
    HalfPlaneContact,
    LineContact,
    Shape,
    StationAnswer,
    scene_from,
)
from cprbm_scene.frozendict import frozendict
from tests.cprbm_scene.editing import LINKAGE, edited
from tests.verdict.jumping import Jumping
from tests.verdict.made_up import MadeUp

pytestmark = pytest.mark.usefixtures("printed")

needs_meshio = pytest.mark.skipif(bool(trouble_with("meshio")), reason="meshio, of the extra 'view', is not there")
needs_pyvista = pytest.mark.skipif(bool(trouble_with("pyvista")), reason="pyvista, of the extra 'view', is not there")
RIGID = {"beam": "spring", "thick": False}
EDGE = {**RIGID, "kind": "beam-line", "body": "rocker", "points": [[0.15, 0.0], [0.15, 0.1]], "side": "right"}
PLANE = {"kind": "beam-half-plane", "beam": "spring", "body": "ground", "point": [0.3, 0.0], "normal": [-2.0, 0.0]}
CURVE = {
    "kind": "beam-function", "beam": "spring", "body": "crank", "axis": "y", "coefficients": [-0.5, 0.0, 1.0],
    "range": [0.0, 0.1], "side": "above",
}  # fmt: skip
FREE = {"beam": "b", "body": "g"}
BELOW = [
    LineContact(kind="beam-line", points=((0.0, 0.0), (0.7, 0.0), (1.3, 0.0)), side="left", **FREE),
    LineContact(kind="beam-line", points=((1.3, 0.0), (0.0, 0.0)), side="right", **FREE),
    HalfPlaneContact(kind="beam-half-plane", point=(0.3, 0.0), normal=(0.0, 0.9), **FREE),
    FunctionContact(kind="beam-function", axis="x", coefficients=(0.0, 0.0), range=(-0.3, 0.9), side="above", **FREE),
]


@pytest.fixture(scope="module")
def linkage():
    return scene_from(edited(("contacts", {"edge": EDGE, "plane": PLANE, "curve": CURVE}), base=LINKAGE))


@pytest.fixture(scope="module")
def station():
    """The rocker has turned by a right angle, clockwise, about its first point."""
    s = np.linspace(0.0, 1.0, 5)
    ends = {"spring": Shape(s, 0.2 + 0.05 * s, 0.0 * s)}
    turned = frozendict({"rocker": np.array([0.01, 0.0, -0.5 * math.pi])})
    return StationAnswer("load", 1.0, {}, ends, {}, Certificate(*[0.0] * 8, iterations=0), bodies=turned)


@pytest.fixture(scope="module")
def solved():
    """The hinge with stresses at all sections, and the views of all stations."""
    scene = with_stresses(cases.opened("hinge"))
    answer = cprbm.answer(scene, cprbm.Settings(links=19))
    return scene, answer, [view_of(scene, station) for station in answer.stations]


@pytest.fixture(scope="module")
def tapered():
    scene = with_stresses(cases.opened("tapered"))
    return scene, cprbm.answer(scene, cprbm.Settings(links=23))


def volume(places, cells):
    """Of prisms along z over quadrilaterals: shoelace formula times width, the mean of the four corners'."""
    corner = places[cells]
    assert np.array_equal(corner[:, :4, :2], corner[:, 4:, :2])
    x, y = corner[:, :4, 0], corner[:, :4, 1]
    area = 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1), axis=1)
    width = (corner[:, 4:, 2] - corner[:, :4, 2]).mean(axis=1)
    assert area.min() > 0.0
    assert width.min() > 0.0
    return float(area @ width)


def written(asked, tmp_path, name, quantity="bending_stress"):
    kind = pictures.kind_of(tmp_path / name)
    return dict(pictures.files(*asked, tmp_path / name, kind, quantity))


# -- The drawing list


def test_points_and_edges_move_with_their_bodies_which_turn_about_their_first_points(linkage, station):
    view = view_of(linkage, station)
    first = np.array(next(iter(linkage.bodies["rocker"].points.values())))
    edge, plane = (next(part for part in view.of("edge") if part.name == name) for name in ("edge", "plane"))
    drawn = [*linkage.bodies["rocker"].points.values(), *EDGE["points"]]
    moved = [*(view.points[name] for name in linkage.bodies["rocker"].points), *edge.points]
    for place, found in zip(drawn, moved, strict=True):
        x, y = np.array(place) - first
        assert found == pytest.approx((first[0] + 0.01 + y, first[1] - x))
    assert plane.points[:, 0] == pytest.approx([0.3, 0.3])
    # without a stated motion the end of a beam says where the point of the body is
    without = view_of(linkage, replace(station, bodies={}))
    assert without.points[linkage.beams["spring"].end.point] == pytest.approx([0.25, 0.0])
    scene = cases.opened("hinge")
    (x, y), *_ = scene.bodies["BD"].points.values()
    at = StationAnswer("load", 1.0, {}, {}, {}, None, bodies={"BD": np.array([0.02, -0.07, 0.5 * math.pi])})
    # a quarter turn takes (0.7, 0) beside the first point to (0, 0.7)
    assert carried(scene, at, "BD", np.array([[x + 0.7, y]]))[0] == pytest.approx([x + 0.02, y - 0.07 + 0.7])


def test_the_solid_side_lies_behind_the_edge():
    for contact in BELOW:
        outline, solid, closed = outline_of(contact, 3.0, 0.11)
        assert not closed, contact
        assert outline[:, 1] == pytest.approx(0.0, abs=1e-15)
        assert solid[:, 1] == pytest.approx(-0.11, rel=1e-12)
    along_y = FunctionContact(
        kind="beam-function", axis="y", coefficients=(0.3, 0.0), range=(0.0, 0.9), side="above", **FREE
    )
    outline, solid, _ = outline_of(along_y, 3.0, 0.11)
    assert outline[:, 0] == pytest.approx(0.3)
    assert solid[:, 0] == pytest.approx(0.19)  # the beam lies where x is larger
    corner = LineContact(kind="beam-line", points=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0)), side="left", **FREE)
    assert outline_of(corner, 3.0, 0.1)[1][1] == pytest.approx([1.1, -0.1])  # the same depth behind both pieces
    circle = CircleContact(kind="beam-circle", center=(0.5, 0.4), radius=0.13, **FREE)
    outline, solid, closed = outline_of(circle, 1.0, 0.1)
    assert closed
    assert np.hypot(*(outline - solid).T) == pytest.approx(0.13)
    assert left_of(np.array([[2.0, 0.0], [0.0, 3.0]])) == pytest.approx(np.array([[0.0, 1.0], [-1.0, 0.0]]))


def test_contact_forces_sum_to_the_probe_and_limits_span_the_shown_colours_and_arrows(solved):
    scene, answer, views = solved
    pushes = views[-1].arrows_of("push")
    (stated,) = answer.stations[-1].values["contact.force"]
    assert [push.name for push in pushes] == ["contact", "contact"]  # on both beams
    assert [push.size for push in pushes] == pytest.approx([stated, stated], rel=1e-9)
    assert np.abs(force_block(views[-1]).values["contact_force"].sum(axis=0)).max() < 1e-9 * stated
    assert force_block(views[0]) is None  # the contact is open
    first, second = (push.middle for push in pushes)
    assert math.dist(first, second) < 0.01 * scene.beams["beam1"].thickness
    largest = max(np.abs(answer.stations[-1].values[f"{beam}.bending_stress"]).max() for beam in scene.beams)
    bounds = bounds_of(scene, views, "bending_stress")
    assert (bounds.least, bounds.most) == (-largest, largest)
    assert bounds_of(scene, views, "combined_stress").least == 0.0
    vectors = [bounds.arrow(push) for view in views for push in view.arrows_of("push")]
    assert max(np.hypot(*vector) for vector in vectors if vector is not None) == pytest.approx(0.13 * bounds.size)
    # a flat picture has room for its arrows: of a level strip of 100 by 2, 13 % of the length below
    push = Arrow("push", "pin", np.array([[50.0, -1.0]]), np.array([[0.0, 7.0]]))
    bounds = Bounds(np.array([0.0, -1.0]), np.array([100.0, 1.0]), 0.0, 1.0, {"push": 7.0})
    wide = bounds.around([push])
    assert (*wide.low, *wide.high) == pytest.approx((0.0, -14.0, 100.0, 1.0))
    np.testing.assert_array_equal(bounds.around([]).high, bounds.high)


def test_the_rays_of_a_stop_turn_with_its_body():
    """The body of the stop turns by the angle of the station, and two of the four rays with it."""
    scene = cases.opened("prestressed")
    last = next(at for at in Jumping("fea")(scene, Choices()).stations if at.value > 1.57)
    names = {name for name, body in scene.bodies.items() if "B" in body.points}
    turned = replace(last, bodies=frozendict(dict.fromkeys(names, np.array([0.0, 0.0, last.value]))))
    angles = []
    for at in (turned, replace(last, bodies={})):
        rays = [np.diff(part.points, axis=0)[0] for part in view_of(scene, at).of("stop")]
        angles.append([math.degrees(math.atan2(y, x)) for x, y in rays])
    differences = {round((after - before) % 360.0, 6) for after, before in zip(*angles, strict=True)}
    assert differences <= {0.0, round(math.degrees(last.value), 6)}
    assert len(angles[0]) == 4


# -- Figures


def test_a_contact_in_a_point_and_a_window_of_beams_have_a_legible_size(solved, monkeypatch):
    """The finite elements press over 1e-4 of a beam: the figure shows a twentieth, and no wide zone."""
    scene, answer, views = solved
    monkeypatch.setattr(curves, "chart", lambda name, caption, abscissa, panels, **_: panels)
    where = SimpleNamespace(where=(answer.stations[-1].stage, answer.stations[-1].value))
    compared = SimpleNamespace(scene=scene, rows=[where], runs=SimpleNamespace(pair=(answer, answer)))
    (panels,) = curves.contact_figures(compared)
    factor, _ = display_unit(scene, "m", longest(scene))
    for panel in panels:
        shown = factor * np.ptp(np.concatenate([s for s, *_ in panel.lines]))
        assert 0.05 * longest(scene) <= shown * (1.0 + 1e-9) < 0.06 * longest(scene)
    # a window shows the beams alone where the rest is twice as large
    low, high = figures.extent(scene, views[-1:])
    assert np.max(high - low) > 0.05
    small = {name: strip._replace(line=0.02 * strip.line) for name, strip in views[-1].strips.items()}
    low, high = figures.extent(scene, [views[-1]._replace(strips=small)])
    assert np.max(high - low) < 0.003


# -- Cells


def test_the_cells_of_beams_and_of_a_circle_have_their_volumes(solved, tapered):
    """The volume of a bent strip is length times section, for any path of the neutral line (Pappus)."""
    scene, _, views = solved
    expected = sum(
        math.pi * math.dist(beam.curve.center, beam.curve.start) * beam.thickness * beam.width
        for beam in scene.beams.values()
    )
    block = beam_block(views[0])
    assert len(block.cells) == 2 * (SECTIONS - 1) * ACROSS
    # chords in the place of arcs that turn by δ = π/240: sin δ/δ of the area, and as much again for the solver's line
    assert volume(block.places, block.cells) == pytest.approx(expected, rel=2.0 * (math.pi / 240) ** 2 / 6.0)
    # places at 19 links, two to a link, and bending between the places under a contact
    last = beam_block(views[-1])
    assert volume(last.places, last.cells) == pytest.approx(expected, rel=1e-3)
    scene, answer = tapered
    (beam,) = scene.beams.values()
    expected = 0.0  # Simpson's rule is exact for the product of what goes straight
    for a, b in pairwise(beam.knots):
        t, w = (size(np.array([a, 0.5 * (a + b), b])) for size in (beam.thickness_at, beam.width_at))
        expected += (b - a) / 6.0 * float(np.array([1.0, 4.0, 1.0]) @ (t * w))
    expected *= math.dist(beam.curve.start, beam.curve.end)
    block = beam_block(view_of(scene, answer.stations[-1]))
    # knots between two sections are cut off
    assert volume(block.places, block.cells) == pytest.approx(expected, rel=1e-3)
    # a wrapped circle is a cylinder: its shape at rest is enough
    scene = cases.opened("wrapped")
    (contact,) = scene.contacts.values()
    answer = MadeUp("cprbm", 0.0)(scene, Choices())
    block = obstacle_block(view_of(scene, answer.stations[0]))
    cylinder = math.pi * contact.radius**2 * scene.beams[contact.beam].width
    corners = block.places[block.cells]
    assert corners[:, 4:, 2].min() > corners[:, :4, 2].max()
    # 120 corners in the place of a circle: 1 − (2π/120)²/6 of its area
    assert volume(block.places, block.cells) == pytest.approx(cylinder, rel=5e-4)


def test_cells_bear_the_stresses_and_displacements_that_the_answer_states(solved):
    scene, answer, views = solved
    station = answer.stations[-1]
    values = beam_block(views[-1]).values
    stress = values["bending_stress"].reshape(2, SECTIONS, ACROSS + 1, 2)
    for number, name in enumerate(scene.beams):
        stated = station.values[f"{name}.bending_stress"]
        assert np.array_equal(stress[number, :, 0, 0], stated)  # a moment that turns to the left pulls the right edge
        assert np.array_equal(stress[number, :, -1, 1], -stated)
        assert np.abs(stress[number, :, ACROSS // 2]).max() == 0.0
    beam = scene.beams["beam1"]
    moment = values["moment"].reshape(2, SECTIONS, -1)[0, :, 0]
    inertia = beam.width * beam.thickness**3 / 12.0
    bent = moment * 0.5 * beam.thickness / inertia
    assert bent == pytest.approx(station.values["beam1.bending_stress"], rel=1e-12)
    middle = values["displacement"].reshape(2, SECTIONS, ACROSS + 1, 2, 3)[:, :, ACROSS // 2, 0, :2]
    for number, (beam, point) in enumerate((("beam1", "B"), ("beam2", "D"))):
        assert scene.beams[beam].end.point == point
        stated = station.values[f"{point}.displacement"]
        assert middle[number, -1] == pytest.approx(stated, abs=1e-9 * np.abs(stated).max())


# -- Files


@pytest.mark.parametrize("name", ["a.svg", "a.gif"])
def test_pictures_are_the_same_to_the_byte(tapered, tmp_path, name):
    scene, answer = tapered
    asked = scene, replace(answer, stations=answer.stations[-2:])
    first, second = (written(asked, tmp_path, name) for _ in range(2))
    assert first == second
    assert list(first) == [tmp_path / name]
    (content,) = first.values()
    if name.endswith("svg"):
        assert b"<svg" in content
        assert not re.search(rb"<dc:date>", content)
    else:
        assert Image.open(io.BytesIO(content)).n_frames == 2


@pytest.mark.parametrize("kind", ["gif", "apng"])
def test_an_animation_rests_at_its_end(kind):
    streams = [io.BytesIO() for _ in range(3)]
    for place, stream in enumerate(streams):
        picture = Image.new("RGB", (31, 17), "white")
        picture.putpixel((5 + 7 * place, 9), (200, 10, 10))
        picture.save(stream, "PNG")
    made = Image.open(io.BytesIO(pictures.animation([stream.getvalue() for stream in streams], kind)))
    assert made.n_frames == 3
    stays = []
    for place in range(3):
        made.seek(place)
        stays.append(made.info["duration"])
        assert np.asarray(made.convert("RGB"))[9, 5 + 7 * place].tolist() == pytest.approx([200, 10, 10], abs=8)
    assert stays == [500, 500, 1500]


@needs_meshio
def test_a_series_can_be_read_back(solved, tmp_path):
    import meshio

    scene, answer, views = solved
    files = written((scene, answer), tmp_path, "h.pvd")
    assert files == written((scene, answer), tmp_path, "h.pvd")
    for path, content in files.items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    listed = re.findall(r'timestep="([^"]+)" part="(\d)" name="(\w+)" file="([^"]+)"', (tmp_path / "h.pvd").read_text())
    assert [float(time) for time, part, _, _ in listed if part == "0"] == [each.value for each in answer.stations]
    assert all((tmp_path / file).is_file() for *_, file in listed)
    assert listed[-1][2] == "contacts"
    mesh = meshio.read(tmp_path / "h" / "beams-0009.vtu")
    block = beam_block(views[-1])
    assert np.array_equal(mesh.points, block.places)
    assert np.array_equal(mesh.cells_dict["hexahedron"], block.cells)
    for name, values in block.values.items():
        assert np.array_equal(mesh.point_data[name], values)
    forces = meshio.read(tmp_path / listed[-1][3]).point_data["contact_force"]
    assert forces.shape == (len(force_block(views[-1]).cells), 3)


@needs_pyvista
@needs_meshio
def test_what_reads_vtk_files_sees_the_same_volume(tapered, tmp_path):
    import pyvista

    (content,) = written(tapered, tmp_path, "t.vtu").values()
    (tmp_path / "t.vtu").write_bytes(content)
    grid = pyvista.read(tmp_path / "t.vtu")
    sizes = grid.compute_cell_sizes()["Volume"]
    block = beam_block(view_of(tapered[0], tapered[1].stations[-1]))
    assert sizes.min() > 0.0
    # where the width varies a cell is no prism
    assert sizes.sum() == pytest.approx(volume(block.places, block.cells), rel=1e-3)


@needs_pyvista
def test_a_picture_in_space_shows_both_edges(tapered, tmp_path):
    if pictures.tried():
        pytest.skip("no library of the system draws here")
    (content,) = written(tapered, tmp_path, "t.3d.png").values()
    picture = np.asarray(Image.open(io.BytesIO(content)).convert("RGB")).astype(int)
    inside = picture[100:, : int(0.75 * picture.shape[1])]
    red = (inside[..., 0] > inside[..., 2] + 80).sum()
    blue = (inside[..., 2] > inside[..., 0] + 80).sum()
    assert red > 500
    assert blue > 500


def test_a_process_that_ends_as_it_draws_is_named_with_the_command_that_helps(tmp_path, monkeypatch, capsys):
    with pytest.raises(pictures.DrawingError, match="VTK ended"):
        pictures.apart(os._exit, 139)

    def cannot(*_):
        raise pictures.DrawingError("VTK ended as it began to draw")

    monkeypatch.setattr(pictures, "apart", cannot)
    assert run(["view", "tapered", "-n", "10", "--out", str(tmp_path / "t.3d.png")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "apt-get install --yes --no-install-recommends libegl1 libgl1-mesa-dri" in said
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("mechanism", ["docs/gallery/latch.toml", "docs/tutorials/finger.toml"], ids=["wide", "tall"])
def test_a_picture_cuts_no_label_and_has_narrow_margins(mechanism, tmp_path, monkeypatch):
    monkeypatch.chdir(Path(__file__).parents[2])
    assert run(["view", mechanism, "-n", "10", "--out", str(tmp_path / "p.png")]) == 0
    dark = np.asarray(Image.open(tmp_path / "p.png").convert("L")) < 128
    for inked in (dark.any(axis=0), dark.any(axis=1)):
        first, last = np.flatnonzero(inked)[[0, -1]]
        assert 5 < first < 100, "170 dots to the inch"
        assert 5 < len(inked) - last < 100


def test_the_command_shows_the_station_that_is_asked(tmp_path, capsys):
    path = tmp_path / "t.png"
    assert run(["view", "tapered", "-n", "10", "--station", "0.7", "--quantity", "moment", "--out", str(path)]) == 0
    assert f"{path}: tapered by cprbm, load 0.7 N." in capsys.readouterr().out
    with Image.open(path) as picture:
        assert picture.size[0] > 600
