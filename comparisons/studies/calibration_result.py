"""Result of the calibration: a table by case and size, the worst rows, a figure, and the documented JSON."""

from __future__ import annotations

import numpy as np

from comparisons.formats import number, percent
from comparisons.plain import Plain
from comparisons.present.canvas import GREY, canvas, finished
from comparisons.present.columns import Figure, Section, Table
from comparisons.studies.calibration import Calibration, Trial, tallies
from comparisons.verdict.calibration import LARGEST_MEDIAN, SHARE_WITHIN, ErrorRatio, Tally
from comparisons.verdict.runs import SOLVERS
from comparisons.verdict.words import Word

_NAMES = {"cprbm": "CPRBM", "fea": "FEA in bending"}


def result_of(found: Calibration) -> Section:
    """Result of the measurements so far."""
    return Section(
        "Stated uncertainties beside true errors",
        _words(found),
        (stated_against_true(found),) if any(trial.held for trial in found.trials) else (),
        tuple(table for table in (_tallies(found), _worst(found)) if table.rows),
        "calibration",
        _data(found),
    )


def _words(found: Calibration) -> tuple[str, ...]:
    sentences = []
    broken = [
        f"{_NAMES[mine.solver]} on {case}"
        for case in found.cases
        for mine in tallies(found.of_case(case))
        if not mine.holds
    ]
    if found.trials:
        sentences.append(
            f"The house's rule: the true error lies within the stated one in at least {percent(SHARE_WITHIN)} of the "
            f"rows, and stated over true is at most {LARGEST_MEDIAN:g} in the median. "
            + (f"It is broken by the {', by the '.join(broken)}." if broken else "It is kept by both on every case.")
        )
    sentences += [
        f"{trial.case} at {trial.size('cprbm')} links and {trial.size('fea')} elements: {trial.verdict.word.value}. "
        f"{trial.verdict.sentence}"
        for trial in found.trials
        if trial.verdict.word is not Word.AGREE
    ]
    for case, (known, asked) in found.covered.items():
        if known < asked:
            where = f"{known} of {asked} stations" if known else "no station"
            sentences.append(f"{case}: an exact answer is known for {where}. {found.why[case]}")
    return tuple(sentences)


def _tallies(found: Calibration) -> Table:
    body = []
    for case in found.cases:
        trials = found.of_case(case)
        for place, solver in enumerate(SOLVERS):
            for trial in trials:
                body.append((case, _NAMES[solver], str(trial.size(solver)), *_figures(tallies((trial,))[place])))
            body.append((case, _NAMES[solver], "all", *_figures(tallies(trials)[place])))
    return Table(
        "Calibration",
        ("case", "solver", "N", "rows", "within", "share", "stated over true", "largest true over stated", "rule"),
        tuple(body),
        "Rows with a true error of more than 1e-9 of the probe's scale, all stations, a closing load once; N is the "
        "number of links or elements per beam. Stated over true: the median.",
    )


def _figures(mine: Tally) -> tuple[str, ...]:
    return (
        str(mine.rows),
        str(mine.within),
        percent(mine.share),
        number(mine.over),
        number(mine.worst[0].ratio) if mine.worst else "–",
        "met" if mine.holds else "not met",
    )


def _worst(found: Calibration) -> Table:
    body = []
    for case in found.cases:
        for mine in tallies(found.of_case(case)):
            for each in mine.worst:
                trial = next(trial for trial in found.of_case(case) if any(each is one for one in trial.held))
                body.append(
                    (
                        case,
                        _NAMES[each.solver],
                        str(trial.size(each.solver)),
                        each.row.probe.name,
                        f"{each.row.stage} {each.row.station:g}",
                        percent(each.true / each.row.scale),
                        percent(each.stated / each.row.scale),
                        number(each.ratio),
                        each.word,
                    )
                )
    return Table(
        "The least well stated",
        ("case", "solver", "N", "probe", "at", "true", "stated", "true over stated", ""),
        tuple(body),
        "True and stated as fractions of the probe's scale.",
    )


def _data(found: Calibration) -> Plain:
    return {
        "study": "calibration",
        "cases": [
            {
                "case": case,
                "stations_covered": known,
                "stations": asked,
                "why": found.why.get(case),
                "trials": [_trial(trial) for trial in found.of_case(case)],
            }
            for case, (known, asked) in found.covered.items()
        ],
    }


def _trial(trial: Trial) -> Plain:
    return {
        "links": trial.size("cprbm"),
        "elements": trial.size("fea"),
        "verdict": trial.verdict.word.value,
        "solvers": {
            mine.solver: {
                "rows": mine.rows,
                "within": mine.within,
                "share": mine.share,
                "stated_over_true": mine.over,
                "holds": mine.holds,
                "worst": [_held(each) for each in mine.worst],
            }
            for mine in tallies((trial,))
        },
    }


def _held(each: ErrorRatio) -> Plain:
    return {
        "probe": each.row.probe.name,
        "stage": each.row.stage,
        "station": each.row.station,
        "true": each.true / each.row.scale,
        "stated": each.stated / each.row.scale,
        "true_over_stated": each.ratio,
    }


_COLOURS = ("#1f5fa8", "#c8321e", "#2c8a4b", "#a05fb4", "#c98a12", "#3aa6a6", "#555555")
_TITLES = {"cprbm": "CPRBM", "fea": "FEA in bending"}


def stated_against_true(found: Calibration) -> Figure:
    """Stated against true errors of every row, a panel for each solver and a colour for each case."""
    with canvas(9.6, 5.2) as figure:
        panels = figure.subplots(1, 2, sharex=True, sharey=True)
        both = [(each.true / each.row.scale, each.stated / each.row.scale) for t in found.trials for each in t.held]
        low, high = 0.5 * float(np.min(both)), 2.0 * float(np.max(both))
        for axes, solver in zip(panels, SOLVERS, strict=True):
            for place, name in enumerate(found.cases):
                mine = [each for t in found.of_case(name) for each in t.held if each.solver == solver]
                axes.plot(
                    [each.true / each.row.scale for each in mine],
                    [each.stated / each.row.scale for each in mine],
                    "o",
                    color=_COLOURS[place % len(_COLOURS)],
                    markersize=2.5,
                    alpha=0.6,
                    label=name if solver == SOLVERS[0] else None,
                )
            axes.plot([low, high], [low, high], "-", color="black", linewidth=1.0)
            axes.plot([low, high], [LARGEST_MEDIAN * low, LARGEST_MEDIAN * high], "--", color=GREY, linewidth=1.0)
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.set_xlim(low, high)
            axes.set_ylim(low, high)
            axes.set_aspect("equal")
            axes.set_title(_TITLES[solver], loc="left")
            axes.set_xlabel("true error / scale")
        panels[0].set_ylabel("stated error / scale")
        figure.legend(loc="outside lower center", ncols=4, markerscale=2.0)
        return finished(
            figure,
            "calibration",
            "Each row's stated error against its true one. On the line they are equal; below it the statement is not "
            "true. Dashed: stated ten times the true one, which the median is not to exceed.",
        )
