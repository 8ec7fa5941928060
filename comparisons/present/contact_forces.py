"""Contact zones and their forces along the beams: a figure of the last station, and a table of all stations.

A solver states forces at places: a zone is a row of point forces.  The CPRBM has a force per link in contact, the
finite elements a force per quadrature point.  Sums along the beam compare, single forces do not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from comparisons.case import Comparison
from comparisons.display_units import at_station, display_unit
from comparisons.present.canvas import BLUE, GREY, RED, canvas, finished, show_lengths
from comparisons.present.columns import Column, Figure, records_of
from comparisons.present.csv_table import csv_text, in_file_units
from comparisons.quantities import load_unit
from cprbm_scene import Answer, Scene, StationAnswer
from cprbm_scene.answer import PointForce

NAME = "contact-forces"
"""Name of the figure and of the table."""

_LOOKS = {"FEA": (RED, "-"), "CPRBM": (BLUE, "o:")}


class _Entry(NamedTuple):
    """A contact force of a solver at a station."""

    solver: str
    station: StationAnswer
    acting: PointForce


def contact_figures(compared: Comparison) -> tuple[Figure, ...]:
    """Forces along every pressed beam at the last common station; no figure without a contact force."""
    scene = compared.scene
    stations = {"FEA": compared.runs.reference.stations, "CPRBM": compared.runs.cprbm[0].stations}
    last = compared.rows[-1].where if compared.rows else None
    forces = {
        name: [each for at in mine if (at.stage, at.value) == last for each in _pressing(scene, at)]
        for name, mine in stations.items()
    }
    panels = sorted({(each.source, each.target) for mine in forces.values() for each in mine})
    if last is None or not panels:
        return ()
    largest = max(float(np.hypot(*each.force)) for mine in forces.values() for each in mine)
    factor, unit = display_unit(scene, "N", largest)
    with canvas(7.2, 0.6 + 2.3 * len(panels)) as drawing:
        for place, (contact, beam) in enumerate(panels):
            axes = drawing.add_subplot(len(panels), 1, place + 1)
            for name, (colour, style) in _LOOKS.items():
                mine = [each for each in forces[name] if (each.source, each.target) == (contact, beam)]
                if mine:
                    mine.sort(key=lambda each: float(each.s))
                    s, sizes = [float(each.s) for each in mine], [np.hypot(*each.force) / factor for each in mine]
                    axes.step([s[0], *s], [0.0, *np.cumsum(sizes)], style, color=colour, where="post", label=name,
                              linewidth=1.6, markersize=4.0, markerfacecolor="none")  # fmt: skip
            axes.axhline(0.0, color=GREY, linewidth=0.6)
            axes.set_title(f"{contact} on {beam}", loc="left", fontsize=9)
            axes.set_ylabel(f"sum of forces, {unit}")
            axes.legend(loc="best", fontsize=8.5)
            show_lengths(scene, axes.xaxis, "initial arc length" if place == len(panels) - 1 else "")
        caption = (
            f"Contact forces along the beams at {at_station(scene, *last)}, summed up from the start of the beam. A "
            "step is a force at a point, a slope is a zone; where the sum is constant, nothing presses."
        )
        return (finished(drawing, NAME, caption),)


def contact_csv(scene: Scene, answers: Sequence[Answer]) -> str:
    """Contact forces of answers as comma-separated values in the units of the scene's file, with a line of headers."""
    units = {stage.name: load_unit(scene, stage) for stage in scene.stages}
    columns = [
        Column[_Entry]("scene", lambda at: scene.name),
        Column("solver", lambda at: at.solver),
        Column("stage", lambda at: at.station.stage),
        Column("station", lambda at: at.station.value),
        Column("station_unit", lambda at: units[at.station.stage]),
        Column("contact", lambda at: at.acting.source),
        Column("beam", lambda at: at.acting.target),
        Column("arc_length", lambda at: float(at.acting.s)),
        Column("x", lambda at: float(at.acting.place[0])),
        Column("y", lambda at: float(at.acting.place[1])),
        Column("arc_length_unit", lambda at: "m"),
        Column("force_x", lambda at: float(at.acting.force[0])),
        Column("force_y", lambda at: float(at.acting.force[1])),
        Column("unit", lambda at: "N"),
    ]
    entries = (
        _Entry(answer.solver, station, each)
        for answer in answers
        for station in answer.stations
        for each in _pressing(scene, station)
    )
    return csv_text(
        [column.header for column in columns],
        (in_file_units(scene, record) for record in records_of(columns, entries)),
    )


def _pressing(scene: Scene, station: StationAnswer) -> Iterator[PointForce]:
    """Forces of contacts on beams, in the order of contacts and beams."""
    for each in station.forces:
        if each.source in scene.contacts and each.target in scene.beams and each.force.any():
            yield each
