"""Parts of a difference: steps of theory and contact model, the formulation paper, and a solid as a third opinion."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from comparisons.case import Comparison
from comparisons.claims import as_claimed, standings
from comparisons.display_units import at_station, display_units, with_unit
from comparisons.formats import percent, vector
from comparisons.present.columns import Column, Table, table_of
from comparisons.present.row_tables import Judged, share
from comparisons.quantities import norm
from comparisons.sentences import place
from comparisons.steps import Steps, contact_model, steps_of
from comparisons.third import Third, thirds_of
from comparisons.verdict.rows import Row
from cprbm_scene import Answer, Scene

MANY_TIMES = 10.0
"""Fraction above which a distance prints with its unit."""


def explanation(compared: Comparison) -> Iterable[str]:
    """A sentence per claimed difference about its parts, at the worst station."""
    for standing in standings(compared.scene, compared.rows):
        if not isinstance(standing.worst, Row) or standing.claim.value is not None:
            continue
        row = as_claimed(standing.worst)
        steps = steps_of(compared.runs, row)
        if steps is not None:
            yield (
                f"{place(compared.scene, row)}: our difference of {share(row, row.difference)} is the finite elements' "
                f"own step of theory, {share(row, steps.stretch)} from bending to stretch and "
                f"{share(row, steps.shear)} from stretch to shear, and {_in_one_theory(compared, row, steps)}; the "
                f"source states {percent(standing.claim.bound)}."
            )


def _in_one_theory(compared: Comparison, row: Row, steps: Steps) -> str:
    own, stated = share(row, steps.own), share(row, row.bounds.same_theory if row.bounds else None)
    if compared.runs.auto is not None:
        return (
            f"{own} between the two methods within one theory and {share(row, steps.contact)} in the contact model, "
            f"from paper to auto; the runs state {stated} for both together"
        )
    text = f"{own} between the two methods within one theory, where the two discretisations state {stated}"
    model = contact_model(compared.runs, row)
    return text if model is None else f"{text}; the contact model of paper would put the CPRBM {share(row, model)} away"


def steps_table(compared: Comparison, rows: Sequence[Judged]) -> Table:
    """Steps of the differences of one station."""
    runs = compared.runs
    found = [(row, steps) for row, *_ in rows if (steps := steps_of(runs, row)) is not None]
    models = any(contact_model(runs, row) is not None for row, _ in found)
    note = "Components along the difference; the steps add up."
    if runs.auto is not None:
        note += " Contact model: the CPRBM's step from paper to auto."
    elif models:
        note += " Contact model: the CPRBM's distance in paper from auto, which is no part of the sum."
    elif runs.paper is not None and not runs.paper.completed:
        note += f" The formulation paper ended early: {runs.paper.ending.value}."
    columns = [
        Column[tuple[Row, Steps]]("probe", lambda at: at[0].probe.name),
        Column("difference", lambda at: share(at[0], at[0].difference)),
        Column(
            "contact model",
            lambda at: (
                share(at[0], at[1].contact if runs.auto is not None else contact_model(runs, at[0])) if models else None
            ),
        ),
        Column("CPRBM to bending", lambda at: share(at[0], at[1].own)),
        Column("bending to stretch", lambda at: share(at[0], at[1].stretch)),
        Column("stretch to shear", lambda at: share(at[0], at[1].shear)),
    ]
    return table_of("Steps of the difference", columns, found, note)


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
        off("FEA bending off", "bending"),
        off(f"FEA {compared.runs.kinematics} off", "chosen"),
    ]
    return table_of(
        "The beam theories beside a solid, at the last station",
        columns,
        last,
        "The solid's values are extrapolated from its meshes; distances are measured from these values.",
    )
