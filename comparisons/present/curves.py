"""Figures of curves, panels of lines: against loads and drives, reactions, stresses and contact forces."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import cycle, groupby, pairwise

import numpy as np

from comparisons.case import Comparison
from comparisons.formats import at_station, axis_unit, display_unit, number
from comparisons.geometry import longest
from comparisons.present.canvas import BLUE, LINES, RED, Line, Look, Panel, chart
from comparisons.present.columns import Figure
from comparisons.present.csv_table import pressing
from comparisons.quantities import UNITS, arc_lengths, load_unit
from comparisons.reactions import ENERGY, MESH_ALLOWANCE, WorkEnergyReaction, by_drive, multiplier, reaction_probe
from comparisons.stations import begins_at, station_of
from cprbm_scene import (
    Answer,
    Array,
    DisplacementDrive,
    Force,
    Probe,
    Quantity,
    RotationDrive,
    Scene,
    Stage,
    StationAnswer,
)
from cprbm_scene.curves import unit_vector as unit

FEA: Look = {"color": RED, "linewidth": 1.8, "label": "FEA"}
CPRBM: Look = {"color": BLUE, "linestyle": "none", "marker": ".", "markersize": 5.0, "label": "CPRBM"}
_MARKERS = 30  # most markers of a branch
_SHOWN = 0.025  # half of the least shown part of a beam over the longest beam

Values = Callable[[StationAnswer], Array]
"""Value (1,) of a curve at a station, in SI; empty without a value."""


def _ordinates(scene: Scene, stages: Sequence[Stage]) -> Iterator[tuple[str, str, Mapping[str, Values]]]:
    """Title, SI unit, and values by label: of the stepped load or drive, energy, rotations and contact forces."""
    asked = [probe for probe in scene.probes if all(probe.asked_in(stage.name) for stage in stages)]
    names, stepped, first = {probe.name for probe in asked}, scene.stepped(stages[0]), stages[0]

    def value(probe: Probe) -> Values:
        return lambda at: at.values[probe.name][:1]

    if isinstance(stepped, Force):
        moved, way = Probe(of=stepped.point, quantity="displacement").name, unit(stepped.direction)
        if moved in names:
            yield (
                f"displacement of {stepped.point} along the force",
                "m",
                {"": lambda at: np.atleast_1d(at.values[moved] @ way)},
            )
    elif isinstance(stepped, DisplacementDrive | RotationDrive) and reaction_probe(stepped).name in names:
        quantity = reaction_probe(stepped).quantity
        title = {"reaction": "reaction force"}.get(quantity, "reaction moment")
        yield title, UNITS[quantity], {"": lambda at: np.atleast_1d(multiplier(scene, first, at))}
    groups: dict[Quantity, str] = {"rotation": "rotation", "force": "contact force"}
    for quantity, title in groups.items():
        lines = {probe.of: value(probe) for probe in asked if probe.quantity == quantity}
        if lines:
            yield title, UNITS[quantity], lines
    if ENERGY.name in names:
        yield "potential energy", "J", {"": value(ENERGY)}


def curve_figures(scene: Scene, fea: Answer, cprbm: Answer) -> Iterator[Figure]:
    """A figure for every load or drive with two stations or more, in the manner of the paper's Fig. 18."""
    for steps in dict.fromkeys(stage.steps for stage in scene.stages):
        stages = [stage for stage in scene.stages if stage.steps == steps]
        ordinates = list(_ordinates(scene, stages))
        if ordinates and len({value for stage in stages for value in stage.stations}) > 1:
            yield _curve(scene, {"FEA": fea, "CPRBM": cprbm}, stages, ordinates)


def _curve(
    scene: Scene,
    answers: Mapping[str, Answer],
    stages: Sequence[Stage],
    ordinates: Sequence[tuple[str, str, Mapping[str, Values]]],
) -> Figure:
    """Values of both answers against a load or drive, branch by branch, with critical points and jumps."""
    names, steps = {stage.name for stage in stages}, stages[0].steps
    step, step_unit = axis_unit(
        scene, load_unit(scene, stages[0].name), max(abs(x) for at in stages for x in at.stations)
    )
    mine = [station for answer in answers.values() for station in answer.stations if station.stage in names]
    panels = []
    for title, si, lines in ordinates:
        sizes = (float(np.max(np.abs(of(at)), initial=0.0)) for at in mine for of in lines.values())
        factor, unit_name = display_unit(scene, si, max(sizes, default=0.0))
        drawn = [
            path
            for (label, of), (style, marker) in zip(lines.items(), cycle(LINES), strict=False)
            for name, look in (("FEA", {**FEA, "linestyle": style}), ("CPRBM", {**CPRBM, "marker": label and marker}))
            for path in _paths(scene, stages, answers[name], of, (step, factor),
                               {**look, "label": f"{label}, {name}".removeprefix(", ")})
        ]  # fmt: skip
        # a panel is 25 letters high
        panels.append(Panel(f"{title}, {unit_name}".replace(" along", "\nalong"), drawn))
    ends = {name: [each for each in answer.critical if each.stage in names] for name, answer in answers.items()}
    marks = [(each.value / step, {"FEA": RED, "CPRBM": BLUE}[name]) for name, mine in ends.items() for each in mine]
    above = [
        (f"{number(each.value / step, 4)} {step_unit}, {each.loss.value}".replace(" °", "°"), (each.value / step, 1.0),
         {"xycoords": ("data", "axes fraction"), "ha": "center", "xytext": (0, 3 + 12 * place)})
        for place, each in enumerate(ends["CPRBM"])
    ]  # fmt: skip
    titles = ", ".join(title for title, *_ in ordinates)
    jumps = " Dashed: jumps between the stations beside a critical point." if any(at.branch for at in mine) else ""
    dotted = " Dotted: critical values of either solver, the CPRBM's with names." if marks else ""
    panels[0] = panels[0]._replace(texts=above)
    return chart(
        f"path-{steps}",
        caption=f"{titles[:1].upper()}{titles[1:]} against {steps}; triangles point along the stage.{jumps}{dotted}",
        abscissa=f"{steps}, {step_unit}",
        panels=panels,
        marks=marks,
    )


def _paths(
    scene: Scene, stages: Sequence[Stage], answer: Answer, of: Values, scales: tuple[float, float], look: Look
) -> Iterator[Line]:
    """A line for every branch of every stage, and a dashed line for every jump; only the first has a label."""
    before: StationAnswer | None = None
    for stage in stages:
        up = stage.stations[-1] > begins_at(scene, stage)
        stations = [at for at in answer.stations if at.stage == stage.name and of(at).size]
        for branch in dict.fromkeys(at.branch for at in stations):
            mine = [at for at in stations if at.branch == branch]
            if before is not None and before.branch != branch:
                jump = {**look, "linestyle": "--", "marker": "", "linewidth": 1.0, "label": None}
                yield *_points([before, mine[0]], of, scales), jump
            marker = {"marker": look["marker"] or (">" if up else "<")} if "marker" in look else {}
            marks = {
                "markerfacecolor": look["color"] if up else "white",
                "markersize": 4.0,
                "markeredgewidth": 0.7,
                "markevery": -(-len(mine) // _MARKERS),  # more markers would hide the line
            }
            yield *_points(mine, of, scales), {**look, **marks, **marker}
            look, before = {**look, "label": None}, mine[-1]


def _points(stations: Sequence[StationAnswer], of: Values, scales: tuple[float, float]) -> tuple[Array, Array]:
    return np.array([at.value for at in stations]) / scales[0], np.array([of(at)[0] for at in stations]) / scales[1]


def reaction_figures(compared: Comparison) -> Iterator[Figure]:
    """A figure for every drive with two stations or more, in the manner of the paper's Fig. 15."""
    scene = compared.scene
    every = by_drive(compared.reactions)
    several = {drive: found for drive, found in every.items() if len({each.station for each in found}) > 1}
    for drive, found in several.items():
        factor, unit_name = display_unit(scene, found[0].unit, max(abs(each.multiplier) for each in found))
        si = load_unit(scene, found[0].stage)
        step, step_unit = axis_unit(scene, si, max(abs(each.station) for each in found))
        crosses = {**FEA, "linestyle": "none", "marker": "x"}
        forces = {
            "fea": crosses,
            "multiplier": {**CPRBM, "linestyle": "-", "marker": "", "label": "CPRBM, multiplier"},
            "work_energy": {**CPRBM, "marker": "o", "markerfacecolor": "none", "label": "CPRBM, work–energy"},
        }
        band = 100.0 * MESH_ALLOWANCE
        yield chart(
            f"reaction-{drive}",
            caption=(
                f"Reaction at the drive {drive}. Below: relative differences from the CPRBM's multiplier. The band of "
                f"{band:g} % to either side is the allowance for the motion of the mesh where contacts are closed. "
                "Stations beside an event have no work–energy reaction."
            ),
            abscissa=f"{drive}, {step_unit}",
            panels=[
                Panel(
                    f"reaction {'moment' if si == 'rad' else 'force'}, {unit_name}",
                    _reaction_lines(found, step, factor, forces),
                ),
                Panel(
                    "relative difference, %",
                    _reaction_lines(found, step, -0.01, {"from_fea": crosses})
                    + _reaction_lines(found, step, 0.01, {"difference": {**CPRBM, "label": "work–energy"}}),
                    band=band,
                ),
            ],
        )


def _reaction_lines(
    found: Sequence[WorkEnergyReaction], step: float, factor: float, looks: Mapping[str, Look]
) -> list[Line]:
    """Lines of numbers of reactions by name, over the units of the axes, with gaps between branches."""
    pairs = enumerate(pairwise(found), 1)
    gaps = [place for place, (one, other) in pairs if (one.stage, one.branch) != (other.stage, other.branch)]
    x = np.insert(np.array([at.station for at in found]) / step, gaps, np.nan)
    values = {name: np.array([getattr(at, name) for at in found], dtype=float) / factor for name in looks}
    return [(x, np.insert(values[name], gaps, np.nan), look) for name, look in looks.items()]


def _along_beams(
    scene: Scene, name: str, caption: str, quantity: tuple[str, str], lines: Mapping[str, Sequence[Line]]
) -> Figure:
    """Figure of a quantity along beams.

    Args:
        scene, name, caption: of the figure.
        quantity: title and SI unit.
        lines: arc lengths, m, values, SI, and looks, by title of the panel.
    """
    title, si = quantity
    factor, unit_name = display_unit(scene, si, max(np.max(np.abs(y)) for panel in lines.values() for _, y, _ in panel))
    metre, length_unit = display_unit(scene, "m", longest(scene))
    return chart(
        name,
        caption,
        f"initial arc length, {length_unit}",
        panels=[
            Panel(
                f"{title}, {unit_name}",
                [(np.asarray(s) / metre, np.asarray(y) / factor, look) for s, y, look in panel],
                beam,
            )
            for beam, panel in lines.items()
        ],
        shared="",
    )


def stress_figures(scene: Scene, fea: StationAnswer, cprbm: StationAnswer) -> Iterator[Figure]:
    """Bending stress along the beams at a station of both answers, in the manner of the paper's Fig. 10."""
    lines = {
        probe.of: [
            (arc_lengths(scene, probe), at.values[probe.name], look) for at, look in ((fea, FEA), (cprbm, CPRBM))
        ]
        for probe in scene.probes_in(fea.stage)
        if probe.quantity == "bending_stress" and fea.values[probe.name].size == cprbm.values[probe.name].size > 0
    }
    if lines:
        yield _along_beams(
            scene,
            "stress",
            caption=(
                f"Bending stress along the beams at {at_station(scene, fea.stage, fea.value)}, positive where the load "
                "turns the tangent counter-clockwise along the beam."
            ),
            quantity=("bending stress", "Pa"),
            lines=lines,
        )


def contact_figures(compared: Comparison) -> Iterator[Figure]:
    """Forces along every pressed beam at the last common station, summed up from the start of the beam.

    A solver states forces at places: a zone is a row of point forces.  The CPRBM has a force per link in contact, the
    finite elements a force per quadrature point.  Sums along the beam compare, single forces do not.
    """
    scene, last, lines = compared.scene, compared.rows[-1].where, dict[str, list[Line]]()
    dotted = {**CPRBM, "linestyle": ":", "marker": "o"}
    for answer, look in zip(reversed(compared.runs.pair), (FEA, dotted), strict=True):
        forces = sorted(pressing(scene, station_of(answer, *last)), key=lambda at: (at.source, at.target, float(at.s)))
        for pair, found in groupby(forces, key=lambda at: f"{at.source} on {at.target}"):
            s, sizes = np.array([(float(at.s), np.hypot(*at.force)) for at in found]).T
            step = {**look, "drawstyle": "steps-post", "markerfacecolor": "none"}
            shown = s.mean() + _SHOWN * longest(scene) * np.array([-1.0, 1.0])
            lines.setdefault(pair, [(shown, np.zeros(2), {"linestyle": "none"})]).append(
                (np.append(s[:1], s), np.cumsum([0.0, *sizes]), step)
            )
    if lines:
        yield _along_beams(
            scene,
            "contact-forces",
            caption=(
                f"Contact forces along the beams at {at_station(scene, *last)}, summed up from the start of the beam. "
                "A step is a force at a point, a slope is a zone; where the sum is constant, nothing presses."
            ),
            quantity=("sum of forces", "N"),
            lines=dict(sorted(lines.items())),
        )
