"""Stated uncertainties of both solvers beside their true errors, on every built-in case with an exact answer.

The exact answer is an answer in the theory ``bending``: the finite elements run in this theory, too.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from comparisons.case import Verdict, compare
from comparisons.choices import Choices
from comparisons.executor import ALONE, Crew
from comparisons.formats import number, percent
from comparisons.pairing import Solvers, exact_answer, exact_if_covered, paired
from comparisons.present.canvas import GREY, Line, Panel, chart
from comparisons.present.columns import Column, Figure, Plain, Section, Table, table_of
from comparisons.stations import complete_part
from comparisons.verdict import LARGEST_MEDIAN, SHARE_WITHIN, SOLVERS, ErrorRatio, Tally, Word, error_ratios, tally
from cprbm_scene import Answer, Scene, frozendict

SIZES = ((17, 40), (20, 60), (40, 80), (80, 160))
"""Links per beam of the CPRBM and finite elements per beam."""

_NAMES = {"cprbm": "CPRBM", "fea": "FEA in bending"}
_COLOURS = ("#1f5fa8", "#c8321e", "#2c8a4b", "#a05fb4", "#c98a12", "#3aa6a6", "#555555")


@dataclass(frozen=True, slots=True)
class Trial:
    """A case at a discretisation: N by solver, the verdict, and the error ratios."""

    case: str
    sizes: Mapping[str, int]
    verdict: Verdict
    ratios: tuple[ErrorRatio, ...]


@dataclass(frozen=True, slots=True)
class Calibration:
    """All measurements so far.

    Attributes:
        trials: in the order of the cases and sizes.
        covered: by case, the number of stations with an exact answer, of all stations, and why any lacks the answer.
    """

    trials: tuple[Trial, ...] = ()
    covered: Mapping[str, tuple[int, int, str | None]] = field(default_factory=frozendict)

    def by_case(self) -> dict[str, tuple[Trial, ...]]:
        """Trials of every case."""
        names = dict.fromkeys(trial.case for trial in self.trials)
        return {name: tuple(trial for trial in self.trials if trial.case == name) for name in names}


def with_case(
    found: Calibration, scene: Scene, solvers: Solvers, crew: Crew = ALONE, sizes: Iterable[tuple[int, int]] = SIZES
) -> Calibration:
    """The measurements with a case more, at all sizes; a case without an exact answer has no trials.

    Raises:
        SceneError: a solver refuses the question.
    """
    whole = exact_if_covered(scene, Choices(theory="bending"), solvers.exact or exact_answer)
    exact = complete_part(scene, whole)
    known, asked = len(exact.stations), sum(len(stage.stations) for stage in scene.stages)
    why = None if known == asked else whole.sentence or whole.ending.value
    trials = [trial_of(scene, links, elements, exact, solvers, crew) for links, elements in sizes if known]
    return Calibration((*found.trials, *trials), frozendict({**found.covered, scene.name: (known, asked, why)}))


def trial_of(scene: Scene, links: int, elements: int, exact: Answer, solvers: Solvers, crew: Crew = ALONE) -> Trial:
    """The trial of a case with a known exact answer.

    Raises:
        SceneError: a solver refuses the question.
    """
    choices = Choices(links=links, elements=elements, theory="bending")
    runs = paired(scene, choices, replace(solvers, exact=None), crew, bare=True)
    comparison = compare(replace(runs, answers={**runs.answers, "exact": exact}))
    return Trial(scene.name, {"cprbm": links, "fea": elements}, comparison.verdict, error_ratios(comparison.rows))


def tallies(trials: Iterable[Trial]) -> tuple[Tally, ...]:
    """Error ratios of each solver together."""
    ratios = [each for trial in trials for each in trial.ratios]
    return tuple(tally(ratios, solver) for solver in SOLVERS)


def result_of(found: Calibration) -> Section:
    """Result of the measurements so far, without :func:`pictures`."""
    by_case = found.by_case()
    cases_of_json = [
        {
            "case": case,
            "stations_covered": known,
            "stations": asked,
            "why": why,
            "trials": [_record(trial) for trial in by_case.get(case, ())],
        }
        for case, (known, asked, why) in found.covered.items()
    ]
    return Section(
        "Stated uncertainties beside true errors",
        tuple(_sentences(found)),
        (),
        tuple(table for table in (_tallies(found), _worst(found)) if table.rows),
        "calibration",
        {"study": "calibration", "cases": cases_of_json},
    )


def _record(trial: Trial) -> Plain:
    """Documented JSON of a trial."""
    solvers = {
        own.solver: {
            "rows": own.rows,
            "within": own.within,
            "share": own.share,
            "stated_over_true": own.over,
            "holds": own.holds,
            "worst": [
                {
                    "probe": each.row.probe.name,
                    "stage": each.row.stage,
                    "station": each.row.station,
                    "true": each.true / each.row.scale,
                    "stated": each.stated / each.row.scale,
                    "true_over_stated": each.ratio,
                }
                for each in own.worst
            ],
        }
        for own in tallies([trial])
    }
    sizes = {"links": trial.sizes["cprbm"], "elements": trial.sizes["fea"]}
    return {**sizes, "verdict": trial.verdict.word.value, "solvers": solvers}


def _sentences(found: Calibration) -> Iterable[str]:
    if found.trials:
        every = [(case, own) for case, trials in found.by_case().items() for own in tallies(trials)]
        broken = ", by the ".join(f"{_NAMES[own.solver]} on {case}" for case, own in every if not own.holds)
        yield (
            f"The house's rule: the true error lies within the stated one in at least {percent(SHARE_WITHIN)} of the "
            f"rows, and stated over true is at most {LARGEST_MEDIAN:g} in the median. "
            + (f"It is broken by the {broken}." if broken else "It is kept by both on every case.")
        )
    for trial in found.trials:
        if trial.verdict.word is not Word.AGREE:
            sizes = f"{trial.sizes['cprbm']} links and {trial.sizes['fea']} elements"
            yield f"{trial.case} at {sizes}: {trial.verdict.word.value}. {trial.verdict.sentence}"
    for case, (known, asked, why) in found.covered.items():
        if why is not None:
            where = f"{known} of {asked} stations" if known else "no station"
            yield f"{case}: an exact answer is known for {where}. {why}"


def _tallies(found: Calibration) -> Table:
    """Error ratios by case, solver and size, and of all sizes together."""
    return table_of(
        "Calibration",
        columns=[
            Column[tuple[str, str, Tally]]("case", lambda at: at[0]),
            Column("solver", lambda at: _NAMES[at[2].solver]),
            Column("N", lambda at: at[1]),
            Column("rows", lambda at: at[2].rows),
            Column("within", lambda at: at[2].within),
            Column("share", lambda at: at[2].share, percent),
            Column("stated over true", lambda at: at[2].over, number),
            Column("largest true over stated", lambda at: at[2].worst[0].ratio if at[2].worst else None, number),
            Column("rule", lambda at: "met" if at[2].holds else "not met"),
        ],
        items=[
            (case, size, own)
            for case, trials in found.by_case().items()
            for place, solver in enumerate(SOLVERS)
            for size, own in [
                *((str(trial.sizes[solver]), tallies([trial])[place]) for trial in trials),
                ("all", tallies(trials)[place]),
            ]
        ],
        note="Rows with a true error of more than 1e-9 of the probe's scale, all stations, a closing load once; N is "
        "the number of links or elements per beam. Stated over true: the median.",
    )


def _worst(found: Calibration) -> Table:
    """The largest error ratios by case and solver."""
    sizes = {id(each): trial.sizes[each.solver] for trial in found.trials for each in trial.ratios}
    worst = [
        (case, each)
        for case, trials in found.by_case().items()
        for own in tallies(trials)
        for each in own.worst
    ]  # fmt: skip
    return table_of(
        "The least well stated",
        columns=[
            Column[tuple[str, ErrorRatio]]("case", lambda at: at[0]),
            Column("solver", lambda at: _NAMES[at[1].solver]),
            Column("N", lambda at: sizes[id(at[1])]),
            Column("probe", lambda at: at[1].row.probe.name),
            Column("at", lambda at: f"{at[1].row.stage} {at[1].row.station:g}"),
            Column("true", lambda at: _shares(at[1])[0], percent),
            Column("stated", lambda at: _shares(at[1])[1], percent),
            Column("true over stated", lambda at: at[1].ratio, number),
            Column("", lambda at: at[1].word),
        ],
        items=worst,
        note="True and stated as fractions of the probe's scale.",
    )


def pictures(found: Calibration) -> tuple[Figure, ...]:
    """Stated against true errors of every row, a panel for each solver and a colour for each case; if there are any."""
    every = [size for trial in found.trials for each in trial.ratios for size in _shares(each)]
    if not every:
        return ()
    panels, ends = list[Panel](), np.array([0.5 * min(every), 2.0 * max(every)])
    for solver in SOLVERS:
        lines: list[Line] = []
        for place, (name, trials) in enumerate(found.by_case().items()):
            points = [_shares(each) for trial in trials for each in trial.ratios if each.solver == solver]
            look = {"linestyle": "none", "marker": "o", "markersize": 2.5, "alpha": 0.6, "label": name}
            lines.append((*np.array(points).reshape(-1, 2).T, {**look, "color": _COLOURS[place % len(_COLOURS)]}))
        lines.append((ends, ends, {"color": "black", "linewidth": 1.0}))
        lines.append((ends, LARGEST_MEDIAN * ends, {"linestyle": "--", "color": GREY, "linewidth": 1.0}))
        panels.append(Panel("" if panels else "stated error / scale", lines, _NAMES[solver]))
    return (
        chart(
            "calibration",
            caption="Each row's stated error against its true one. On the line they are equal; below it the statement "
            "is not true. Dashed: stated ten times the true one, which the median is not to exceed.",
            abscissa="true error / scale",
            panels=panels,
            panel=(4.8, 4.4),
            columns=2,
            shared="xy",
            decades=(),
            legend=("lower center", 4),
        ),
    )


def _shares(ratio: ErrorRatio) -> tuple[float, float]:
    """True and stated error over the scale."""
    return ratio.true / ratio.row.scale, ratio.stated / ratio.row.scale
