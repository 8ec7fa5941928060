"""Figures and tables of the pages on the built-in cases, drawn as the pages are built.

    python docs/drawn.py                    every case, into docs/made
    python docs/drawn.py hinge wrapped      two cases

The figures show answers of both solvers, coarser than the standard settings (``LINKS`` and ``ELEMENTS``).  The numbers
of the tables come from the newest record of the baseline (``tests/baseline/records``), at the standard settings.
Existing figures of the same code are kept.
"""

from __future__ import annotations

import hashlib
import json
import lzma
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Circle
from pictures import thumbnail

import cprbm
import fea_reference
from comparisons import cases, offset_drawn
from comparisons.bodies_drawn import draw_bodies, draw_edges, draw_names, draw_stops, joined_ends, places_at
from comparisons.display_units import axis_unit, display_unit
from comparisons.figures import BLUE, GREY, RED, Picture, canvas, picture, show_lengths
from comparisons.formats import number
from comparisons.framing import frame
from comparisons.geometry import length, longest, points
from comparisons.offset_verdict import compared_offset
from comparisons.quantities import COMPONENTS, arc_lengths, load_unit, unit_of
from comparisons.stations import station_of
from comparisons.writing import write
from cprbm_scene import Answer, CircleContact, OffsetQuestion, Scene, Stage, StationAnswer
from cprbm_scene.statement import STRESSES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
MADE = HERE / "made"
RECORDS = ROOT / "tests" / "baseline" / "records"
LONGEST = ("prestressed", "five-bar", "rolled")  # first, so that no process waits at the end
LINKS, ELEMENTS = 20, 40
N, n = 40, 80  # links and elements of the recorded numbers: the standard settings
MOST_STATIONS = 41  # of a drawn stage; further stations are thinned evenly, except shown stations and the last
NOTHING = 1e-15  # m, rad, N, N·m or J: round-off of zero
CURVES = ("rotation", "force", "moment", "reaction", "reaction_moment", "potential_energy")
TITLES = {
    "rotation": "rotation",
    "force": "contact force",
    "moment": "moment of a contact or stop",
    "reaction": "reaction",
    "reaction_moment": "reaction moment",
    "potential_energy": "potential energy",
}


def thinned(scene: Scene) -> Scene:
    """The scene with the stations of a picture."""
    stages = []
    for stage in scene.stages:
        every = -(-len(stage.stations) // MOST_STATIONS)
        kept = set(stage.stations[::every]) | set(stage.shown) | {stage.stations[-1]}
        stations = tuple(value for value in stage.stations if value in kept)
        stages.append(stage.model_copy(update={"stations": stations}))
    return scene.model_copy(update={"stages": tuple(stages)})


def shown(scene: Scene) -> list[tuple[Stage, float]]:
    """Stages and stations of the drawings: shown stations and the last of every stage, four at most."""
    found = [
        (stage, value)
        for stage in scene.stages
        for value in stage.stations
        if value in stage.shown or value == stage.stations[-1]
    ]
    return found[-4:]


def solved(scene: Scene) -> tuple[Answer, Answer]:
    """Answers of both solvers at ``LINKS`` and ``ELEMENTS``."""
    return (
        cprbm.answer(scene, cprbm.Settings(links=LINKS)),
        fea_reference.answer(scene, fea_reference.Settings(elements=ELEMENTS)),
    )


def shapes(scene: Scene, answers: tuple[Answer, Answer]) -> Picture:
    """The undeformed mechanism, dashed, and the shown stations: finite elements as lines, joints of links as dots."""
    reached = [(stage, value) for stage, value in shown(scene) if all(_has(each, stage, value) for each in answers)]
    columns = min(2, len(reached))
    with canvas(4.4 * columns, 4.2 * -(-len(reached) // columns) + 0.4) as figure:
        for place, (stage, value) in enumerate(reached):
            axes = figure.add_subplot(-(-len(reached) // columns), columns, place + 1)
            chain, elements = (station_of(answer, stage.name, value) for answer in answers)
            _as_drawn(axes, scene)
            _loaded(axes, scene, chain, elements)
            factor, unit = axis_unit(scene, load_unit(scene, stage), value)
            axes.set_title(f"{stage.steps} = {_short(value / factor, unit)}", loc="left", fontsize=10)
            frame(axes, elements)
            show_lengths(scene, axes.xaxis)
            show_lengths(scene, axes.yaxis)
            if place == 0:
                draw_names(axes, scene)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2 * columns)
        _, unit = display_unit(scene, "m", longest(scene))
        return picture(
            figure, "shapes", f"Neutral lines in {unit}, as drawn and under load, with the places of contact."
        )


def _short(value: float, unit: str) -> str:
    """A load or drive with four digits."""
    return f"{value:.4g}{'' if unit == '°' else ' '}{unit}"


def _has(answer: Answer, stage: Stage, value: float) -> bool:
    return any(at.stage == stage.name and at.value == value for at in answer.stations)


def _as_drawn(axes: Axes, scene: Scene) -> None:
    for place, beam in enumerate(scene.beams.values()):
        x, y = points(beam.curve, np.linspace(0.0, length(beam.curve), 120)).T
        axes.plot(x, y, "--", color=GREY, linewidth=1.0, label="as drawn" if place == 0 else None)
    draw_bodies(axes, scene, {end.point: scene.place_of(end.point) for _, end, _ in joined_ends(scene)}, "--", GREY)
    for contact in scene.contacts.values():
        if isinstance(contact, CircleContact):
            x, y = contact.center
            # an artist, no patch: a large circle must not make the beams small
            axes.add_artist(Circle((x, y), contact.radius, fill=False, edgecolor=GREY))


def _loaded(axes: Axes, scene: Scene, chain: StationAnswer, elements: StationAnswer) -> None:
    places = places_at(scene, elements)
    draw_edges(axes, scene, places, GREY)
    draw_bodies(axes, scene, places, "-", "black")
    draw_stops(axes, scene, places)
    for place, beam in enumerate(scene.beams):
        one, other = elements.shapes[beam], chain.shapes[beam]
        label = ("finite elements", "CPRBM") if place == 0 else (None, None)
        axes.plot(one.x, one.y, "-", color=RED, linewidth=2.0, label=label[0])
        axes.plot(other.x, other.y, ".", color=BLUE, markersize=4.0, label=label[1])
    touching = [spots for spots in chain.touching.values() if len(spots)]
    if touching:
        x, y = np.concatenate(touching).T
        axes.plot(x, y, "o", color=BLUE, markersize=7.0, markerfacecolor="none", linestyle="", label="contact")


def curves(scene: Scene, answers: tuple[Answer, Answer]) -> Picture | None:
    """Rotations, forces, moments and energy against the load or drive of the last stage."""
    last = scene.stages[-1]
    stages = [stage for stage in scene.stages if stage.steps == last.steps]
    asked = {quantity: [each for each in scene.probes if each.quantity == quantity] for quantity in CURVES}
    panels = {quantity: probes for quantity, probes in asked.items() if probes}
    if not panels or sum(len(stage.stations) for stage in stages) < 2:
        return None
    step, step_unit = axis_unit(
        scene, load_unit(scene, last), max(abs(value) for stage in stages for value in stage.stations)
    )
    with canvas(7.0, 0.4 + 2.5 * len(panels)) as figure:
        for axes, (quantity, probes) in zip(
            np.atleast_1d(figure.subplots(len(panels), 1, sharex=True)), panels.items(), strict=True
        ):
            sizes = [
                abs(float(each)) for answer in answers for at in answer.stations for probe in probes
                for each in at.values[probe.name]
            ]  # fmt: skip
            factor, unit = display_unit(scene, unit_of(scene, probes[0], last), max(sizes, default=1.0))
            for place, probe in enumerate(probes):
                for component, name in enumerate(COMPONENTS.get(quantity, ("",))):
                    look = ("-", "--", ":", "-.")[(2 * place + component) % 4]
                    label = f"{probe.of} {name}".strip()
                    _curve(axes, stages, answers, probe.name, component, look, label, (step, factor))
            axes.set_ylabel(f"{TITLES[quantity]}, {unit}")
            axes.legend(loc="best", fontsize=8)
        axes.set_xlabel(f"{last.steps}, {step_unit}")
        titles = ", ".join(TITLES[quantity] for quantity in panels)
        return picture(
            figure, "curves", f"Against {last.steps}: {titles}. Lines: finite elements; dots: CPRBM. Gaps are jumps."
        )


def _curve(
    axes: Axes,
    stages: Sequence[Stage],
    answers: tuple[Answer, Answer],
    probe: str,
    component: int,
    look: str,
    label: str,
    scales: tuple[float, float],
) -> None:
    step, factor = scales
    chain, elements = answers
    names = {stage.name for stage in stages}
    for answer, style in ((elements, {"linestyle": look, "color": RED}), (chain, {"marker": ".", "color": BLUE})):
        runs = dict.fromkeys((each.stage, each.branch) for each in answer.stations if each.stage in names)
        for place, (stage, branch) in enumerate(runs):
            mine = [
                (each.value / step, float(each.values[probe][component]) / factor)
                for each in answer.stations
                if (each.stage, each.branch) == (stage, branch) and len(each.values[probe]) > component
            ]
            if mine:
                legend = label if answer is elements and place == 0 else None
                axes.plot(*zip(*mine, strict=True), label=legend, **{"linestyle": "none", **style})


def stress(scene: Scene, answers: tuple[Answer, Answer]) -> Picture | None:
    """Bending stress along the beams at the last station."""
    probes = [probe for probe in scene.probes if probe.quantity == "bending_stress"]
    reached = [answer.stations[-1] for answer in answers if answer.stations]
    if not probes or len(reached) < len(answers):
        return None
    with canvas(7.0, 0.4 + 2.2 * len(probes)) as figure:
        largest = max(float(np.max(np.abs(at.values[probe.name]))) for at in reached for probe in probes)
        factor, unit = display_unit(scene, "Pa", largest)
        for axes, probe in zip(np.atleast_1d(figure.subplots(len(probes), 1)), probes, strict=True):
            s = arc_lengths(scene, probe)
            chain, elements = (at.values[probe.name] / factor for at in reached)
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            axes.plot(s, elements, "-", color=RED, linewidth=1.6, label="finite elements")
            axes.plot(s, chain, ".", color=BLUE, markersize=4.0, label="CPRBM")
            axes.set_title(probe.of, loc="left", fontsize=10)
            axes.set_ylabel(f"stress, {unit}")
            show_lengths(scene, axes.xaxis)
        show_lengths(scene, axes.xaxis, "arc length as drawn")
        figure.axes[0].legend(loc="best", fontsize=8)
        return picture(
            figure,
            "stress",
            "Bending stress along the beams at the last station, positive where the load turns the tangent "
            "counter-clockwise along the beam.",
        )


@cache
def recorded() -> dict[str, Any]:
    """Entries of the newest record by the names of their runs."""
    with lzma.open(max(RECORDS.glob("*.jsonl.xz")), "rt", encoding="utf-8") as file:
        _, *entries = (json.loads(line) for line in file)
    return {entry["run"]: entry for entry in entries}


def numbers(scene: Scene) -> str:
    """Table of the recorded numbers at the last station, without stresses along beams."""
    last = scene.stages[-1]
    factor, unit = axis_unit(scene, load_unit(scene, last), last.stations[-1])
    answers = [recorded()[f"{scene.name} {run}"]["stations"][-1] for run in (f"cprbm {N}", f"fea {n}")]
    lines = [
        f"The recorded numbers at {last.steps} = {_short(last.stations[-1] / factor, unit)} ({N} links and {n} finite "
        "elements per beam, which stretch and shear; `python -m tests.baseline` compares new numbers with the record):",
        "",
        "| probe | unit | CPRBM | FEA |",
        "|---|---|---:|---:|",
    ]
    for probe in scene.probes:
        found = [answer["values"].get(probe.name) for answer in answers]
        if probe.quantity in STRESSES or not all(found):  # stresses, and probes without a value
            continue
        factor, unit = display_unit(
            scene, unit_of(scene, probe, last), max(abs(each) for values in found for each in values)
        )
        cells = [
            ", ".join(number(each / factor if abs(each) > NOTHING else 0.0, 5) for each in values) for values in found
        ]
        lines.append(f"| `{probe.name}` | {unit} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def pictures_of(name: str) -> tuple[str, tuple[Picture, ...]]:
    """Text before the figures of a case, and the figures."""
    question = cases.asked(name)
    if isinstance(question, OffsetQuestion):
        write(MADE / name / "thumbnail.png", thumbnail(question, None))
        return "", offset_drawn.of_comparison(compared_offset(question))
    scene = thinned(question)
    answers = solved(scene)
    write(MADE / name / "thumbnail.png", thumbnail(scene, answers[0]))
    drawn = (shapes(scene, answers), curves(scene, answers), stress(scene, answers))
    said = "".join(
        f"The {who} end before the last station: {answer.sentence}.\n\n"
        for who, answer in zip(("links", "elements"), answers, strict=True)
        if not answer.completed
    )
    return numbers(question) + "\n" + said, tuple(each for each in drawn if each is not None)


def make(name: str) -> str:
    """Draw the figures and write the page's part of a case, unless the same code did before; the case's name."""
    folder = MADE / name
    stamp, now = folder / "made-by", _digest()
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == now:
        return name
    said, drawn = pictures_of(name)
    parts = [said]
    for each in drawn:
        write(folder / f"{each.name}.svg", each.svg)
        parts.append(f"```{{figure}} /made/{name}/{each.name}.svg\n:alt: {each.caption}\n\n{each.caption}\n```\n")
    coarse = f"{LINKS} links and {ELEMENTS} elements per beam"
    if not isinstance(cases.asked(name), OffsetQuestion):
        parts.append(f"The build of this page draws the figures with {coarse}; the numbers above are finer.\n")
    write(folder / "part.md", "\n".join(parts))
    write(stamp, now)
    return name


def _digest() -> str:
    """Digest of the sources of the figures."""
    found = hashlib.sha256(Path(__file__).read_bytes() + (HERE / "pictures.py").read_bytes())
    for room in ("cprbm_scene", "cprbm", "fea_reference", "comparisons"):
        for path in sorted((ROOT / room).rglob("*")):
            if path.suffix in {".py", ".toml"}:
                found.update(str(path.relative_to(ROOT)).encode())
                found.update(path.read_bytes())
    for path in sorted(RECORDS.glob("*.jsonl.xz")):
        found.update(path.read_bytes())
    return found.hexdigest()


def make_all(names: Sequence[str] = (), workers: int = 2) -> Iterator[str]:
    """Draw the missing figures of the named cases, or of all; a name for every finished case."""
    todo = sorted(names or cases.names(), key=lambda name: name not in LONGEST)
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        yield from pool.map(make, todo)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the drawing before Sphinx reads the pages."""
    app.connect("builder-inited", _inited)
    return {"parallel_read_safe": True}


def _inited(app: Sphinx) -> None:
    for name in make_all():
        print(f"figures of {name}")


if __name__ == "__main__":
    for done in make_all(sys.argv[1:]):
        print(done)
