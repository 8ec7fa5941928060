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
from dataclasses import replace
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pictures import thumbnail

import cprbm
import fea_reference
from comparisons import cases
from comparisons.formats import axis_unit, display_unit, number
from comparisons.present import figures
from comparisons.present.columns import Figure
from comparisons.present.curves import curve_figures, stress_figures
from comparisons.present.offset import compared_offset, offset_figures
from comparisons.quantities import load_unit, unit_of
from comparisons.writing import write
from cprbm_scene import Answer, OffsetQuestion, Scene, Stage
from cprbm_scene.statement import STRESSES

if TYPE_CHECKING:
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
        fea_reference.answer(scene, fea_reference.Settings(elements=ELEMENTS, kinematics=scene.theory)),
    )


def shapes(scene: Scene, answers: tuple[Answer, Answer]) -> Figure:
    """The mechanism at rest, dashed, and at the shown stations: finite elements as lines, joints of links as dots."""
    reached = [(stage, value) for stage, value in shown(scene) if all(_has(each, stage, value) for each in answers)]
    labelled = {"FEA": answers[1], "CPRBM": answers[0]}
    drawn = figures.shapes(scene, labelled, [(stage.name, value) for stage, value in reached])
    return replace(drawn, name="shapes")


def _short(value: float, unit: str) -> str:
    """A load or drive with four digits."""
    return f"{value:.4g}{'' if unit == '°' else ' '}{unit}"


def _has(answer: Answer, stage: Stage, value: float) -> bool:
    return any(at.stage == stage.name and at.value == value for at in answer.stations)


def stress(scene: Scene, answers: tuple[Answer, Answer]) -> Iterator[Figure]:
    """Bending stress along the beams at the last station; nothing where an answer does not reach the station."""
    chain, elements = (answer.stations[-1:] for answer in answers)
    if chain and elements and (chain[0].stage, chain[0].value) == (elements[0].stage, elements[0].value):
        yield from stress_figures(scene, elements[0], chain[0])


@cache
def recorded() -> dict[str, Any]:
    """Entries of the newest record by the names of their runs."""
    with lzma.open(max(RECORDS.glob("*.jsonl.xz")), "rt", encoding="utf-8") as file:
        _, *entries = (json.loads(line) for line in file)
    return {entry["run"]: entry for entry in entries}


def numbers(scene: Scene) -> str:
    """Table of the recorded numbers at the last station, without stresses along beams."""
    last = scene.stages[-1]
    factor, unit = axis_unit(scene, load_unit(scene, last.name), last.stations[-1])
    answers = [recorded()[f"{scene.name} {run}"]["stations"][-1] for run in (f"cprbm {N}", f"fea {n}")]
    lines = [
        f"The recorded numbers at {last.steps} = {_short(last.stations[-1] / factor, unit)} ({N} links and {n} finite "
        f"elements per beam). The columns have different beam theories; `cprbm compare {scene.name}` answers in one "
        "theory. `python -m tests.baseline` compares new numbers with the record.",
        "",
        f"| probe | unit | CPRBM in {scene.theory} | FEA in shear |",
        "|---|---|---:|---:|",
    ]
    for probe in scene.probes:
        found = [answer["values"].get(probe.name) for answer in answers]
        if probe.quantity in STRESSES or not all(found):  # stresses, and probes without a value
            continue
        factor, unit = display_unit(
            scene, unit_of(scene, probe, last.name), max(abs(each) for values in found for each in values)
        )
        cells = [
            ", ".join(number(each / factor if abs(each) > NOTHING else 0.0, 5) for each in values) for values in found
        ]
        lines.append(f"| `{probe.name}` | {unit} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def pictures_of(name: str) -> tuple[str, tuple[Figure, ...]]:
    """Text before the figures of a case, and the figures."""
    question = cases.asked(name)
    if isinstance(question, OffsetQuestion):
        write(MADE / name / "thumbnail.png", thumbnail(question, None))
        return "", offset_figures(compared_offset(question))
    scene = thinned(question)
    answers = solved(scene)
    write(MADE / name / "thumbnail.png", thumbnail(scene, answers[0]))
    drawn = (shapes(scene, answers), *curve_figures(scene, answers[1], answers[0]), *stress(scene, answers))
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
