"""Pictures of the tutorials and small pictures of the built-in cases, drawn as the pages are built.

    python docs/pictures.py        all pictures, into docs/made

The functions draw answers of the CPRBM with ``LINKS`` links per beam.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import cprbm
from comparisons import cases
from comparisons.geometry import length, points
from comparisons.present.canvas import BLUE, GREY, RED, canvas, draw_parts, image
from comparisons.present.picture import view_of
from comparisons.present.strips import with_stresses
from comparisons.present.view import files
from comparisons.writing import write
from cprbm_scene import Answer, OffsetQuestion, Scene, read
from cprbm_scene.answer import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
MADE = HERE / "made"
TUTORIALS = {"finger": 18.0e-3, "arch": 10.0e-3, "guide": 6.0}
"""Stations of the tutorials' pictures, SI."""
THICKNESSES = ("1.8mm", "2.0mm", "2.2mm")
"""Beam thicknesses of the gripper in its tutorial."""
LINKS = 40
SIDE = 2.4
"""Side of a small picture, inches."""


def thumbnail(question: Scene | OffsetQuestion, answer: Answer | None) -> bytes:
    """Small PNG picture of a case without axes: the mechanism as drawn in grey, at the last station in red."""
    with canvas(SIDE, SIDE) as (figure, (axes,)):
        if isinstance(question, OffsetQuestion):
            _draw_offset(axes, question)
        elif answer is not None:
            _draw_mechanism(axes, question, answer)
        axes.set_aspect("equal", adjustable="box")
        axes.set_axis_off()
        return _png(figure)


def _draw_offset(axes: Axes, question: OffsetQuestion) -> None:
    line = points(question.curve, np.linspace(0.0, length(question.curve), 200))
    normal = _normals(line) * (1.0 if question.side == "left" else -1.0)
    axes.plot(*line.T, "-", color=GREY, linewidth=2.0)
    for distance in question.offsets:
        axes.plot(*(line + distance * normal).T, "-", color=RED, linewidth=0.7)


def _draw_mechanism(axes: Axes, scene: Scene, answer: Answer) -> None:
    view = view_of(scene, answer.stations[-1])
    draw_parts(axes, view.of("edge"))
    for name, beam in scene.beams.items():
        drawn = points(beam.curve, np.linspace(0.0, length(beam.curve), 120))
        axes.plot(*drawn.T, "-", color="#c4c9cf", linewidth=2.2)
        axes.plot(*view.strips[name].line.T, "-", color=RED, linewidth=2.2)
    draw_parts(axes, view.of("body", "weld", "pin", "pivot"), "black")
    beams = np.concatenate([strip.line for strip in view.strips.values()])
    margin = 0.1 * float(np.ptp(beams, axis=0).max())
    axes.set_xlim(beams[:, 0].min() - margin, beams[:, 0].max() + margin)
    axes.set_ylim(beams[:, 1].min() - margin, beams[:, 1].max() + margin)


def _normals(line: Array) -> Array:
    tangent = np.gradient(line, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    return np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)


def _png(figure: Figure) -> bytes:
    return image(figure, "png", 120)


def draw_tutorials() -> None:
    """Write the pictures of the tutorials into ``docs/made/tutorials``, unless the same sources wrote them before."""
    folder = MADE / "tutorials"
    stamp, now = folder / "made-by", _digest()
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == now:
        return
    for name, value in TUTORIALS.items():
        scene = with_stresses(read(HERE / "tutorials" / f"{name}.toml"))
        answer = cprbm.answer(_up_to(scene, value), cprbm.Settings(links=LINKS))
        for path, content in files(scene, answer, folder / f"{name}.png", ".png", "bending_stress"):
            write(path, content)
    arch = read(HERE / "tutorials" / "arch.toml")
    answer = cprbm.answer(arch, cprbm.Settings(links=LINKS))
    push, force = zip(*((at.value, -at.values["pushed.reaction"][1]) for at in answer.stations), strict=True)
    with canvas(5.6, 2.8) as (figure, (axes,)):
        axes.set(xlabel="push, mm", ylabel="force of the drive, N")
        axes.axhline(0.0, color=GREY, linewidth=0.6)
        axes.plot(1e3 * np.array(push), force, "o-", color=BLUE)
        write(folder / "arch-force.png", _png(figure))
    with canvas(5.6, 3.2) as (figure, (axes,)):
        axes.set(xlabel="A moves down by, mm", ylabel="force at A, N")
        for thickness in THICKNESSES:
            answer = cprbm.answer(cases.opened("gripper", {"t": thickness}), cprbm.Settings(links=LINKS))
            down, force = zip(*((-at.values["A.displacement"][1], at.value) for at in answer.stations), strict=True)
            axes.plot(1e3 * np.array(down), force, "o-", markersize=3.5, label=f"t = {thickness.replace('mm', ' mm')}")
        axes.legend()
        write(folder / "gripper.png", _png(figure))
    write(stamp, now)


def write_thumbnails() -> None:
    """Write the row of small pictures for the home page and the examples: a link to the page of every case."""
    lines = [
        f"[![{cases.asked(name).title}](/made/{name}/thumbnail.png)](/examples/{name}.md)\\\n"
        f"[{name}](/examples/{name}.md)\n"
        for name in cases.names()
    ]
    write(MADE / "thumbnails.md", "\n".join(lines))


def _up_to(scene: Scene, value: float) -> Scene:
    stage = scene.stages[-1]
    kept = tuple(station for station in stage.stations if station <= value * (1.0 + 1e-9))
    return scene.model_copy(update={"stages": (stage.model_copy(update={"stations": kept}),)})


def _digest() -> str:
    """Digest of the sources that decide the pictures."""
    found = hashlib.sha256(Path(__file__).read_bytes())
    paths = [HERE / "tutorials", *(ROOT / room for room in ("cprbm_scene", "cprbm", "comparisons"))]
    for path in sorted(path for room in paths for path in room.rglob("*") if path.suffix in {".py", ".toml"}):
        found.update(path.read_bytes())
    return found.hexdigest()


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the drawing before Sphinx reads the pages."""
    app.connect("builder-inited", lambda _: draw_tutorials())
    app.connect("builder-inited", lambda _: write_thumbnails())
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    draw_tutorials()
    write_thumbnails()
