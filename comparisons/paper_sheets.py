"""What tables say of the formulation ``paper`` beside ``auto``: by how much it is off, where it ends, and why."""

from __future__ import annotations

from comparisons.formats import along, number, percent, scaled_unit
from comparisons.quantities import load_unit
from comparisons.sheet import Sheet
from comparisons.verdict.case import Comparison
from comparisons.verdict.rows import Row
from cprbm_scene import Answer, Scene

MANY_TIMES = 10.0


def of_paper(compared: Comparison) -> Sheet:
    """By how much the CPRBM's values in ``paper`` are off those in ``auto`` at the same N, over all stations."""
    measured = [row for row in compared.rows if row.contact_model is not None]
    by_probe: dict[str, list[Row]] = {}
    for row in measured:
        by_probe.setdefault(row.probe.name, []).append(row)
    last = (measured[-1].stage, measured[-1].station) if measured else ("", 0.0)
    body = []
    for name, rows in by_probe.items():
        worst = max(rows, key=lambda row: _share(row) or 0.0)
        there = next((_told(row) for row in rows if (row.stage, row.station) == last), "–")
        body.append((name, _told(worst), _place(compared.scene, worst.stage, worst.station), there))
    paper = compared.runs.paper if compared.runs.formulations is None else compared.runs.formulations[0]
    return Sheet(
        "The formulation paper beside auto",
        ("probe", "off by at most", "at", f"at {_place(compared.scene, *last)}" if measured else "at the last"),
        tuple(body),
        "Distances of the CPRBM's values at the same N; they take no part in the verdict. Fractions as above, and "
        "where those are tenfold and more the distance itself."
        + ("" if paper is None else _why(compared.scene, paper)),
    )


def _share(row: Row) -> float | None:
    return None if row.contact_model is None else row.fraction(row.contact_model)


def _told(row: Row) -> str:
    """A fraction, or what it is of where that is next to nothing beside it."""
    share = _share(row)
    if share is None or share <= MANY_TIMES:
        return percent(share)
    assert row.contact_model is not None
    factor, unit = scaled_unit(row.unit, row.contact_model)
    return f"{number(row.contact_model / factor)} {unit}"


def _place(scene: Scene, name: str, station: float) -> str:
    stage = next(stage for stage in scene.stages if stage.name == name)
    return f"{name} {along(station, load_unit(scene, stage))}"


def _why(scene: Scene, paper: Answer) -> str:
    """What the solver says of its answer, and where that ends."""
    said = f" In paper: {'; '.join(paper.notes)}." if paper.notes else ""
    reached = len(paper.stations)
    asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    if not paper.completed and reached < len(asked):
        said += f" It ended before {_place(scene, *asked[reached])}: {paper.sentence or paper.ending.value}."
    return said
