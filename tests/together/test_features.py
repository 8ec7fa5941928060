"""The table of features and solvers: every cell solved and compared, or refused with a clear word."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import cprbm
import elastica_reference
import fea_reference
from comparisons.verdict.point_forces import away_from_point_forces
from cprbm_scene import Answer, Scene, SceneError, SelfContact, scene_from
from cprbm_scene.curve_records import shape_of
from cprbm_scene.statement import STRESSES
from fea_reference import solid
from tests.together.feature_rows import FEATURES, SOLVERS, Feature

DOCUMENT = Path(__file__).parents[2] / "docs" / "features.md"
LINKS, ELEMENTS = {"auto": 40, "paper": 120}, 16
SOLID, PRESSED = 32, 10  # elements of the solid along a beam, and where there is contact and no stress is asked
ROLLED = 44  # and of a beam that is rolled up onto itself: longer ones are bent too far to be slender
TOLERANCE = {"auto": 0.02, "paper": 0.05, "fea": 0.005, "solid": 0.05}  # of a probe's size, by the discretisation
MOVES = "the row with the same obstacle on a body that moves"
ELSEWHERE = {
    ("imperfection", "exact"): "tests.together.test_imperfection, beside a closed form",
    ("beam with itself", "solid"): "the row of varying thickness: the same strip, thicker, rolled up farther",
    ("circle", "solid"): MOVES,
    ("half-plane", "solid"): MOVES,
    ("polyline with a corner that stands out", "solid"): MOVES,
    ("function", "solid"): MOVES,
}
"""Cells that need no solve of their own, and where the same code answers a harder question."""
CELLS = [(feature, solver) for feature in FEATURES for solver in SOLVERS if (feature.said, solver) not in ELSEWHERE]
NAMES = [f"{feature.group}: {feature.said}: {solver}" for feature, solver in CELLS]


@cache
def scene_of(number: int) -> Scene:
    return scene_from(FEATURES[number].data)


@cache
def answered(number: int, solver: str) -> Answer:
    scene = scene_of(number)
    if solver == "solid":
        coarse = scene.contacts and not any(probe.quantity in STRESSES for probe in scene.probes)
        rolled = any(isinstance(contact, SelfContact) for contact in scene.contacts.values())
        elements = ROLLED if rolled else PRESSED if coarse else SOLID
        return solid.answer(scene, solid.Settings(elements=elements, across=1))
    if solver == "shear":  # the beam theory that a solid is nearest to
        return fea_reference.answer(scene, fea_reference.Settings(elements=ELEMENTS, kinematics="shear"))
    if solver == "fea":
        return fea_reference.answer(scene, fea_reference.Settings(elements=ELEMENTS, kinematics="bending"))
    if solver == "exact":
        return elastica_reference.answer(scene)
    formulation = "paper" if solver == "paper" else "auto"
    return cprbm.answer(scene, cprbm.Settings(links=LINKS[solver], formulation=formulation))


@pytest.mark.parametrize(("feature", "solver"), CELLS, ids=NAMES)
def test_a_cell(feature: Feature, solver: str) -> None:
    # reference: the exact answer where there is one, or else the other of the two solvers; of the solid the finite
    # elements with shear
    number = FEATURES.index(feature)
    if not feature.cells[solver]:
        with pytest.raises(SceneError, match=r"found .* allowed") as refused:
            answered(number, solver)
        assert all(mistake.key for mistake in refused.value.mistakes)
        return
    answer = answered(number, solver)
    assert answer.completed, answer.sentence
    assert all(station.certificate.holds for station in answer.stations)
    others = [
        other
        for other in ("exact", "fea", "auto")
        if other != solver and feature.cells[other] and (feature.said, other) not in ELSEWHERE
    ]
    others = ["shear"] if solver == "solid" else others
    if not others:
        return  # tests of the record compare this solver with statics
    reference = answered(number, others[0])
    assert reference.completed, reference.sentence
    allowed = max(TOLERANCE.get(each, 0.0) for each in (solver, others[0]))
    mine, theirs = answer.stations[-1].values, reference.stations[-1].values
    assert any(np.max(np.abs(value), initial=0.0) > 0.0 for value in theirs.values())
    for name, value in theirs.items():
        assert mine[name].shape == value.shape
        counts = compared(feature, name, solver, answer, reference, value)
        off = np.abs(mine[name] - value)[counts]
        assert off.size or not value.size
        assert np.max(off, initial=0.0) <= allowed * np.max(np.abs(value), initial=0.0), name


def compared(
    feature: Feature, name: str, solver: str, answer: Answer, reference: Answer, value: np.ndarray
) -> NDArray[np.bool_]:
    """Which components count: of a stress in a solid those away from held ends and from where a contact presses."""
    of, quantity = name.split(".")
    if solver != "solid" or quantity not in STRESSES:
        return np.ones(value.shape, dtype=bool)
    scene = scene_of(FEATURES.index(feature))
    s = np.linspace(0.0, shape_of(scene.beams[of].curve).length, value.size)
    return away_from_point_forces(scene, of, s, (answer.stations[-1], reference.stations[-1]))


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
