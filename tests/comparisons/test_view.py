"""What ``view`` writes: pictures that stay the same, and cells whose volumes and stresses are those of the beams."""

import io
import math
import os
import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

import cprbm
from comparisons import cases
from comparisons.cli.doctor import trouble_with
from comparisons.cli.main import run
from comparisons.present import view as pictures
from comparisons.present.picture import view_of
from comparisons.present.strips import SECTIONS, with_stresses
from comparisons.present.view import ACROSS, beam_block, force_block, obstacle_block

pytestmark = pytest.mark.usefixtures("printed")

needs_meshio = pytest.mark.skipif(bool(trouble_with("meshio")), reason="meshio, of the extra 'view', is not there")
needs_pyvista = pytest.mark.skipif(bool(trouble_with("pyvista")), reason="pyvista, of the extra 'view', is not there")


def views_of(scene, answer):
    """A view of every station."""
    return [view_of(scene, station) for station in answer.stations]


@pytest.fixture(scope="module")
def hinge():
    scene = with_stresses(cases.opened("hinge"))
    return scene, cprbm.answer(scene, cprbm.Settings(links=19))


@pytest.fixture(scope="module")
def tapered():
    scene = with_stresses(cases.opened("tapered"))
    return scene, cprbm.answer(scene, cprbm.Settings(links=23))


def written(asked, tmp_path, name, quantity="bending_stress"):
    kind = pictures.kind_of(tmp_path / name)
    return dict(pictures.files(*asked, tmp_path / name, kind, quantity))


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


def test_the_cells_of_beams_have_the_beams_volume(hinge):
    """Of a bent strip it is length times section, wherever its neutral line goes (Pappus)."""
    scene, answer = hinge
    expected = sum(
        math.pi * math.dist(beam.curve.center, beam.curve.start) * beam.thickness * beam.width
        for beam in scene.beams.values()
    )
    views = views_of(scene, answer)
    block = beam_block(views[0])
    assert len(block.cells) == 2 * (SECTIONS - 1) * ACROSS
    # chords in the place of arcs that turn by δ = π/240: sin δ/δ of the area, and as much again for the solver's line
    assert volume(block.places, block.cells) == pytest.approx(expected, rel=2.0 * (math.pi / 240) ** 2 / 6.0)
    # its places at 19 links, two to a link, and what bends between them where a contact presses
    last = beam_block(views[-1])
    assert volume(last.places, last.cells) == pytest.approx(expected, rel=1e-3)


def test_a_beam_that_varies_has_the_volume_of_its_pieces(tapered):
    scene, answer = tapered
    (beam,) = scene.beams.values()
    u = beam.knots
    expected = 0.0  # Simpson's rule is exact for the product of what goes straight
    for a, b in pairwise(u):
        t, w = (size(np.array([a, 0.5 * (a + b), b])) for size in (beam.thickness_at, beam.width_at))
        expected += (b - a) / 6.0 * float(np.array([1.0, 4.0, 1.0]) @ (t * w))
    expected *= math.dist(beam.curve.start, beam.curve.end)
    block = beam_block(views_of(scene, answer)[-1])
    # knots between two sections are cut off
    assert volume(block.places, block.cells) == pytest.approx(expected, rel=1e-3)


def test_cells_bear_the_stresses_and_displacements_that_the_answer_states(hinge):
    scene, answer = hinge
    station = answer.stations[-1]
    values = beam_block(views_of(scene, answer)[-1]).values
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
def test_a_series_can_be_read_back(hinge, tmp_path):
    import meshio

    scene, answer = hinge
    for path, content in written(hinge, tmp_path, "h.pvd").items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(content)
    listed = re.findall(r'timestep="([^"]+)" part="(\d)" name="(\w+)" file="([^"]+)"', (tmp_path / "h.pvd").read_text())
    assert [float(time) for time, part, _, _ in listed if part == "0"] == [each.value for each in answer.stations]
    assert all((tmp_path / file).is_file() for *_, file in listed)
    assert listed[-1][2] == "contacts"
    mesh = meshio.read(tmp_path / "h" / "beams-0009.vtu")
    block = beam_block(views_of(scene, answer)[-1])
    assert np.array_equal(mesh.points, block.places)
    assert np.array_equal(mesh.cells_dict["hexahedron"], block.cells)
    for name, values in block.values.items():
        assert np.array_equal(mesh.point_data[name], values)
    forces = meshio.read(tmp_path / listed[-1][3]).point_data["contact_force"]
    assert forces.shape == (len(force_block(views_of(scene, answer)[-1]).cells), 3)
    assert written(hinge, tmp_path, "h.pvd") == written(hinge, tmp_path, "h.pvd")


@needs_pyvista
@needs_meshio
def test_what_reads_vtk_files_sees_the_same_volume(tapered, tmp_path):
    import pyvista

    (content,) = written(tapered, tmp_path, "t.vtu").values()
    (tmp_path / "t.vtu").write_bytes(content)
    grid = pyvista.read(tmp_path / "t.vtu")
    sizes = grid.compute_cell_sizes()["Volume"]
    block = beam_block(views_of(*tapered)[-1])
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


def test_a_process_that_ends_as_it_draws_is_told_of():
    with pytest.raises(pictures.DrawingError, match="VTK ended"):
        pictures.apart(os._exit, 139)


def test_where_nothing_draws_the_line_that_helps_is_told(tmp_path, monkeypatch, capsys):
    def cannot(*_):
        raise pictures.DrawingError("VTK ended as it began to draw")

    monkeypatch.setattr(pictures, "apart", cannot)
    assert run(["view", "tapered", "-n", "10", "--out", str(tmp_path / "t.3d.png")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "apt-get install --yes --no-install-recommends libegl1 libgl1-mesa-dri" in said
    assert not list(tmp_path.iterdir())


def test_the_command_shows_the_station_that_is_asked(tmp_path, capsys):
    path = tmp_path / "t.png"
    assert run(["view", "tapered", "-n", "10", "--station", "0.7", "--quantity", "moment", "--out", str(path)]) == 0
    assert f"{path}: tapered by cprbm, load 0.7 N." in capsys.readouterr().out
    with Image.open(path) as picture:
        assert picture.size[0] > 600


def test_a_wrong_question_is_refused_with_the_allowed_values(capsys):
    for option, value, words in (
        ("--out", "t.pdf", "found 't.pdf'; allowed: a name that ends in .3d.png, .3d.gif"),
        ("--out", ".png", "found '.png'; allowed"),
        ("--station", "0.8", "found '0.8'; allowed: one of load:0.3, load:0.7, load:1.3, load:2.9"),
        ("--station", "unload:0.7", "found 'unload:0.7'; allowed"),
        ("--station", "nan", "found 'nan'; allowed"),
        ("--quantity", "colour", "'colour' is not one of"),
    ):
        assert run(["view", "tapered", option, value]) == 2
        assert words in capsys.readouterr().err


def test_a_wrapped_circle_has_its_cylinders_volume():
    scene = with_stresses(cases.opened("wrapped"))
    answer = cprbm.answer(scene, cprbm.Settings(links=10))
    (contact,) = scene.contacts.values()
    block = obstacle_block(views_of(scene, answer)[0])
    cylinder = math.pi * contact.radius**2 * scene.beams[contact.beam].width
    corners = block.places[block.cells]
    assert corners[:, 4:, 2].min() > corners[:, :4, 2].max()
    # 120 corners in the place of a circle: 1 − (2π/120)²/6 of its area
    assert volume(block.places, block.cells) == pytest.approx(cylinder, rel=5e-4)
