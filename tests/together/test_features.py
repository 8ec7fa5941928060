"""The table of features and solvers: every cell solved and compared, or refused with a clear word."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import cprbm
import exact
import fea_reference
from scene import Answer, Ending, SceneError
from scene.reading import scene_from
from tests.together.features import FEATURES, SOLVERS, Feature

DOCUMENT = Path(__file__).parents[2] / "docs" / "features.md"
LINKS, ELEMENTS = {"auto": 40, "paper": 120}, 16
TOLERANCE = {"auto": 0.02, "paper": 0.05, "fea": 0.005}  # of a probe's size, by the discretisation
CELLS = [(feature, solver) for feature in FEATURES for solver in SOLVERS]
NAMES = [f"{feature.group}: {feature.said}: {solver}" for feature, solver in CELLS]


@cache
def answered(number: int, solver: str) -> Answer:
    scene = scene_from(FEATURES[number].data)
    if solver == "fea":
        return fea_reference.answer(scene, fea_reference.Settings(elements=ELEMENTS, kinematics="bending"))
    if solver == "exact":
        return exact.answer(scene)
    formulation = "paper" if solver == "paper" else "auto"
    return cprbm.answer(scene, cprbm.Settings(links=LINKS[solver], formulation=formulation))


@pytest.mark.parametrize(("feature", "solver"), CELLS, ids=NAMES)
def test_a_cell(feature: Feature, solver: str) -> None:
    # reference: the exact answer where there is one, or else the other of the two solvers
    number = FEATURES.index(feature)
    if not feature.cells[solver]:
        if solver == "exact" and feature.solvers:
            answer = answered(number, solver)
            assert answer.ending is Ending.NOT_COVERED
            assert len(answer.sentence) > 20
        else:
            with pytest.raises(SceneError, match=r"found .* allowed"):
                answered(number, solver)
        return
    answer = answered(number, solver)
    assert answer.completed, answer.sentence
    assert all(station.certificate.holds for station in answer.stations)
    others = [other for other in ("exact", "fea", "auto") if other != solver and feature.cells[other]]
    reference = answered(number, others[0])
    assert reference.completed, reference.sentence
    allowed = max(TOLERANCE.get(each, 0.0) for each in (solver, others[0]))
    mine, theirs = answer.stations[-1].values, reference.stations[-1].values
    assert any(np.max(np.abs(value), initial=0.0) > 0.0 for value in theirs.values())
    for name, value in theirs.items():
        assert mine[name].shape == value.shape
        assert np.max(np.abs(mine[name] - value), initial=0.0) <= allowed * np.max(np.abs(value), initial=0.0), name


def table() -> str:
    """The table as the document shows it."""
    lines = ["| | | " + " | ".join(SOLVERS.values()) + " |", "|---|---|" + "---|" * len(SOLVERS)]
    group = ""
    for feature in FEATURES:
        cells = " | ".join("yes" if said else "no" for said in feature.cells.values())
        lines.append(f"| {feature.group if feature.group != group else ''} | {feature.said} | {cells} |")
        group = feature.group
    return "\n".join(lines) + "\n"


def test_the_document_shows_this_table() -> None:
    assert table() in DOCUMENT.read_text(encoding="utf-8")
