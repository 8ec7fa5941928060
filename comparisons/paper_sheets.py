"""What tables say of the formulation ``paper`` beside ``auto``: by how much it is off, where it ends, and why."""

from __future__ import annotations

from comparisons.case import Comparison
from comparisons.display_units import at_station, with_unit
from comparisons.formats import percent
from comparisons.sheet import Sheet
from comparisons.steps import contact_model
from comparisons.verdict.rows import Row
from cprbm_scene import Answer, Scene

MANY_TIMES = 10.0


def of_paper(compared: Comparison) -> Sheet:
    """Distances of the CPRBM's values in ``paper`` from those in ``auto`` at the same N, over all stations."""
    by_probe: dict[str, list[tuple[Row, float]]] = {}
    last = ("", 0.0)
    for row in compared.rows:
        model = contact_model(compared.runs, row)
        if model is not None:
            by_probe.setdefault(row.probe.name, []).append((row, model))
            last = row.where
    body = []
    for name, measured in by_probe.items():
        row, model = max(measured, key=lambda pair: pair[0].fraction(pair[1]) or 0.0)
        there = next((_shown(compared.scene, *pair) for pair in measured if pair[0].where == last), "–")
        body.append((name, _shown(compared.scene, row, model), at_station(compared.scene, *row.where), there))
    paper = compared.runs.paper if compared.runs.formulations is None else compared.runs.formulations[0]
    return Sheet(
        "The formulation paper beside auto",
        ("probe", "off by at most", "at", f"at {at_station(compared.scene, *last)}" if by_probe else "at the last"),
        tuple(body),
        "Distances of the CPRBM's values at the same N; they take no part in the verdict. Fractions as above, and "
        "where those are tenfold and more the distance itself."
        + ("" if paper is None else _why(compared.scene, paper)),
    )


def _shown(scene: Scene, row: Row, model: float) -> str:
    """A distance as a fraction, or with its unit where the fraction is large."""
    share = row.fraction(model)
    if share is None or share <= MANY_TIMES:
        return percent(share)
    return with_unit(scene, model, row.unit, 3)


def _why(scene: Scene, paper: Answer) -> str:
    """What the solver says of its answer, and where that ends."""
    said = f" In paper: {'; '.join(paper.notes)}." if paper.notes else ""
    reached = len(paper.stations)
    asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    if not paper.completed and reached < len(asked):
        said += f" It ended before {at_station(scene, *asked[reached])}: {paper.sentence or paper.ending.value}."
    return said
