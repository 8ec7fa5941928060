"""The numbers of one run, as plain data.

This module alone knows the solvers and the harness of today. It reads the answer sheet and the documented JSON of
``compare``. The keys of an entry stay when solvers and harness are replaced.

An entry holds ``run``, ``outcome`` (``answered``, ``refused``, ``crashed`` or ``out of time``), ``sentence`` and
``seconds`` of the processor. An answered run of a solver adds ``ending``, ``iterations``, ``natural`` (scales),
``critical`` and ``stations``; an answered comparison adds ``verdict``, ``iterations``, ``critical`` and ``rows``.
All values are in SI units.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

import comparisons
import cprbm
import fea_reference
from comparisons.case import Comparison
from comparisons.choices import Choices
from comparisons.present import json_document
from comparisons.verdict.events import mechanism
from cprbm_scene import Answer, Critical, Scene, SceneError
from tests.baseline.runs import Run, Theory, open_scene
from tests.baseline.scales import natural_scales

Entry = dict[str, Any]

DIGITS = 12
"""Significant digits of a recorded value: three more than two records are compared to."""

DIGITS_OF_BOUND = 6
"""Significant digits of a stated uncertainty."""


def answer_of_cprbm(scene: Scene, links: int, theory: Theory | None) -> Answer:
    """The CPRBM's answer with ``links`` per beam; today's CPRBM knows the theory of bending alone."""
    return cprbm.answer(scene, cprbm.Settings(links=links))


def answer_of_fea(scene: Scene, elements: int, theory: Theory | None) -> Answer:
    """The finite elements' answer with ``elements`` per beam."""
    if theory is None:
        return fea_reference.answer(scene, fea_reference.Settings(elements=elements))
    return fea_reference.answer(scene, fea_reference.Settings(elements=elements, kinematics=theory))


def comparison_of(scene: Scene, theory: Theory | None) -> Comparison:
    """The comparison at the default sizes."""
    return comparisons.compare(scene, Choices() if theory is None else Choices(kinematics=theory))


@dataclass(frozen=True, slots=True)
class Program:
    """The measured functions; a test plants wrong functions here."""

    cprbm: Callable[[Scene, int, Theory | None], Answer] = answer_of_cprbm
    fea: Callable[[Scene, int, Theory | None], Answer] = answer_of_fea
    comparison: Callable[[Scene, Theory | None], Comparison] = comparison_of


def measure(run: Run, program: Program) -> Entry:
    """The entry of a run; a refused scene is an entry too, any other error of the program is raised."""
    scene = open_scene(run.scene)
    begun = time.process_time()
    try:
        if run.solver == "comparison":
            numbers = numbers_of_comparison(program.comparison(scene, run.theory))
        else:
            solver = program.cprbm if run.solver == "cprbm" else program.fea
            numbers = numbers_of_answer(scene, solver(scene, run.size, run.theory))
    except SceneError as error:
        numbers = {"outcome": "refused", "sentence": "; ".join(map(str, error.mistakes))}
    seconds = time.process_time() - begun
    return {**heading(run), **numbers, "seconds": round(seconds, 4)}


def heading(run: Run) -> Entry:
    """Name, scene, solver, size and theory of a run."""
    return {"run": run.name, "scene": run.scene, "solver": run.solver, "size": run.size, "theory": run.theory}


def numbers_of_answer(scene: Scene, answer: Answer) -> Entry:
    """The numbers of a solver's answer."""
    return {
        "outcome": "answered",
        "ending": answer.ending.name,
        "sentence": "" if answer.completed else answer.sentence,
        "iterations": _iterations((answer,)),
        "natural": {name: float(f"{scale:.6g}") for name, scale in natural_scales(scene, answer).items()},
        "critical": [_critical(each) for each in answer.critical],
        "stations": [
            {
                "stage": station.stage,
                "load": station.value,
                "values": {name: rounded(values) for name, values in station.values.items()},
            }
            for station in answer.stations
        ],
    }


def numbers_of_comparison(comparison: Comparison) -> Entry:
    """The numbers of a comparison, by the keys of the documented JSON."""
    document = json_document.comparison(comparison)
    runs = [*comparison.runs.same_theory.values()]
    return {
        "outcome": "answered",
        "verdict": document["verdict"],
        "sentence": "" if document["verdict"] == "AGREE" else document["sentence"],
        "iterations": _iterations(runs),
        "critical": [
            {
                "stage": row["stage"],
                "kind": {name: row["loss"][name] for name in ("cprbm", "fea")},
                "difference": row["difference"],
                "uncertainty": row["uncertainty"],
                "verdict": row["verdict"],
            }
            for row in document["critical"]
        ],
        "rows": [_row(row) for row in document["rows"]],
    }


def _row(row: Entry) -> Entry:
    """Probe, stage, load, verdict, and in the probe's unit scale, difference and stated uncertainties."""
    bounds = {name: _absolute(row, share, DIGITS_OF_BOUND) for name, share in row["uncertainty"].items()}
    return {
        "probe": row["probe"],
        "stage": row["stage"],
        "load": row["station"],
        "verdict": row["verdict"],
        "scale": float(f"{row['scale']:.6g}"),
        "difference": _absolute(row, row["difference"], DIGITS),
        "uncertainty": {name: bound for name, bound in bounds.items() if bound is not None},
    }


def _absolute(row: Entry, share: float | None, digits: int) -> float | None:
    return None if share is None else float(f"{share * row['denominator']:.{digits}g}")


def _critical(critical: Critical) -> Entry:
    return {
        "stage": critical.stage,
        "load": float(f"{critical.value:.{DIGITS}g}"),
        "uncertainty": float(f"{critical.uncertainty:.{DIGITS_OF_BOUND}g}"),
        "kind": mechanism(critical),
    }


def _iterations(answers: Iterable[Answer]) -> int:
    return sum(station.certificate.iterations for answer in answers for station in answer.stations)


def rounded(values: np.ndarray) -> list[float]:
    """``values`` (k,) to as many digits as a record keeps."""
    return [float(f"{value:.{DIGITS}g}") for value in np.ravel(values)]
