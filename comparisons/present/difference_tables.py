"""Values beside the verdict: the other theory, the formulation paper, and a solid as a third opinion."""

from __future__ import annotations

from comparisons.case import Comparison
from comparisons.contact_model import contact_model
from comparisons.display_units import at_station, display_units, with_unit
from comparisons.formats import percent, vector
from comparisons.present.columns import Column, Table, table_of
from comparisons.quantities import norm
from comparisons.third import Third, thirds_of
from comparisons.verdict.rows import Row
from cprbm_scene import Answer, Scene

MANY_TIMES = 10.0
"""Fraction above which a distance prints with its unit."""


def paper_table(compared: Comparison) -> Table:
    """Distances of the CPRBM's values in ``paper`` from the values in ``auto`` at the same N, over all stations."""
    scene, last = compared.scene, ("", 0.0)
    by_probe: dict[str, list[tuple[Row, float]]] = {}
    for row in compared.rows:
        model = contact_model(compared.runs, row)
        if model is not None:
            by_probe.setdefault(row.probe.name, []).append((row, model))
            last = row.where
    worst = {name: max(rows, key=lambda at: at[0].fraction(at[1]) or 0.0) for name, rows in by_probe.items()}

    def text(row: Row, model: float) -> str:
        large = (row.fraction(model) or 0.0) > MANY_TIMES
        return with_unit(scene, model, row.unit, 3) if large else percent(row.fraction(model))

    columns = [
        Column[str]("probe", str),
        Column("largest distance", lambda name: text(*worst[name])),
        Column("at", lambda name: at_station(scene, *worst[name][0].where)),
        Column(
            f"at {at_station(scene, *last)}" if by_probe else "",
            lambda name: next((text(*pair) for pair in by_probe[name] if pair[0].where == last), None),
        ),
    ]
    paper = compared.runs.paper if compared.runs.formulations is None else compared.runs.formulations[0]
    note = "Distances of the CPRBM's values at the same N; they take no part in the verdict. Fractions above tenfold "
    note += "stand as distances." + ("" if paper is None else _paper_note(scene, paper))
    return table_of("The formulation paper beside auto", columns, by_probe, note)


def _paper_note(scene: Scene, paper: Answer) -> str:
    """Notes and end of the answer in ``paper``."""
    note = f" In paper: {'; '.join(paper.notes)}." if paper.notes else ""
    asked = [(stage.name, value) for stage in scene.stages for value in stage.stations]
    if not paper.completed and len(paper.stations) < len(asked):
        before = at_station(scene, *asked[len(paper.stations)])
        note += f" It ended before {before}: {paper.sentence or paper.ending.value}."
    return note


def solid_table(compared: Comparison) -> Table:
    """Rows of the last station beside the solid."""
    thirds = thirds_of(compared)
    last = [one for one in thirds if one.row.where == thirds[-1].row.where]
    sizes = ((one.row.unit, norm(one.row.probe.quantity, one.solid)) for one in last)
    units = display_units(compared.scene, sizes)

    def value(header: str, chosen: str) -> Column[Third]:
        return Column(
            header,
            lambda one: vector(one.solid if chosen == "solid" else getattr(one.row, chosen), units[one.row.unit][0]),
        )

    def off(header: str, chosen: str) -> Column[Third]:
        return Column(header, lambda one: percent(one.row.fraction(getattr(one, chosen))))

    columns = [
        Column[Third]("probe", lambda one: one.row.probe.name),
        Column("unit", lambda one: units[one.row.unit][1]),
        value("CPRBM", "cprbm"),
        value("FEA", "fea"),
        value("solid", "solid"),
        off("u solid", "uncertainty"),
        off("CPRBM off", "cprbm"),
        off("FEA off", "fea"),
        off(f"CPRBM in {compared.runs.other_theory} off", "other"),
    ]
    return table_of(
        "The beam theories beside a solid, at the last station",
        columns,
        last,
        "The solid's values are extrapolated from its meshes; distances are measured from these values.",
    )
