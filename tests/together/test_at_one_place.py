"""Two obstacles with a corner in common, on which a beam leans: the sum of their forces is known, and no part of it.

The reference is the same beam on one of them alone, which to mechanics is the same question.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import cprbm
import fea_reference
from comparisons.choices import Choices
from comparisons.pairing import paired, solvers_of
from comparisons.verdict import Comparison, compared
from comparisons.words import Word
from cprbm_scene import Answer, Scene, scene_from
from tests.together.planted import stiffer

CHOICES = Choices(links=37, elements=30, kinematics="bending")
CORNER = [0.0026, 0.0595]


def leaning(*obstacles: str) -> dict[str, Any]:
    """A clamped strip that a load along it presses on the corner of two triangles, or of one."""
    drawn = {
        "flat": {"points": [CORNER, [-0.0119, 0.0737], [-0.0178, 0.0498], CORNER], "side": "right"},
        "steep": {"points": [CORNER, [-0.0188, 0.0333], [-0.0042, 0.0695], CORNER], "side": "left"},
    }
    contacts = {name: {"kind": "beam-line", "beam": "strip", "body": "wall"} | drawn[name] for name in obstacles}
    return {
        "name": "at-one-place",
        "materials": {"steel": {"youngs_modulus": 2.07e11, "poisson_ratio": 0.29}},
        "bodies": {"wall": {"motion": "fixed", "points": {"R": [0.0, 0.0]}}},
        "beams": {
            "strip": {
                "curve": {"kind": "line", "start": [0.0, 0.0], "end": [0.0073, 0.099]},
                "thickness": 0.0005,
                "width": 0.0179,
                "material": "steel",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "free"},
            }
        },
        "loads": {"wind": {"kind": "distributed", "beam": "strip", "direction": [-0.844, -0.537], "along": [0.0, 1.0]}},
        "contacts": contacts,
        "stages": [{"name": "blow", "steps": "wind", "stations": [29.0, 61.0]}],
        "probes": [{"of": "scene", "quantity": "potential_energy"}]
        + [{"of": name, "quantity": "force"} for name in contacts],
    }


def by_cprbm(scene: Scene) -> Answer:
    return cprbm.answer(scene, cprbm.Settings(links=37))


def by_fea(scene: Scene) -> Answer:
    return fea_reference.answer(scene, fea_reference.Settings(elements=30, kinematics="bending"))


@pytest.mark.parametrize("solve", [by_cprbm, by_fea])
def test_their_sum_is_what_one_of_them_would_bear(solve: Any) -> None:
    both, alone = solve(scene_from(leaning("flat", "steep"))), solve(scene_from(leaning("flat")))
    assert both.completed, both.sentence
    for mine, its in zip(both.stations, alone.stations, strict=True):
        force = mine.values["flat.force"][0] + mine.values["steep.force"][0]
        assert its.values["flat.force"][0] > 0.1
        # a penalty of each is one twice as stiff
        assert force == pytest.approx(its.values["flat.force"][0], rel=1e-4)
        energy = "scene.potential_energy"
        assert mine.values[energy][0] == pytest.approx(its.values[energy][0], rel=1e-5)


def verdict(*, stiff: bool = False) -> Comparison:
    scene = scene_from(leaning("flat", "steep"))
    solvers = solvers_of(None)
    if stiff:
        right = solvers.cprbm
        solvers = replace(solvers, cprbm=lambda scene, choices: right(stiffer(scene), choices))
    return compared(scene, paired(scene, CHOICES, solvers, bare=True))


def test_a_part_of_it_cannot_be_told_and_the_sum_is() -> None:
    found = verdict()
    assert found.verdict.word is Word.UNDECIDED
    assert "no mechanics says how they share the force" in found.verdict.because
    shared = {row.probe.name for row in found.rows if row.shared}
    assert shared == {"flat.force", "steep.force"}
    for row in found.rows:
        assert row.bounds is not None
        assert row.difference <= row.bounds.total < 0.015 * row.scale
    together = [row.together for row in found.rows if row.together is not None]
    alone = by_fea(scene_from(leaning("flat"))).stations
    for (mine, theirs), station in zip(together, np.repeat(np.array(alone, dtype=object), 2), strict=True):
        assert mine == pytest.approx(station.values["flat.force"], rel=2e-3)
        assert theirs == pytest.approx(station.values["flat.force"], rel=1e-4)


def test_a_sum_that_is_wrong_differs() -> None:
    found = verdict(stiff=True)
    assert found.verdict.word is Word.DIFFER
    words = {row.probe.name: word for row, word in zip(found.rows, found.verdict.words, strict=True)}
    assert words["flat.force"] is Word.DIFFER


def test_obstacles_beside_each_other_share_nothing() -> None:
    data = leaning("flat", "steep")
    data["contacts"]["steep"]["points"] = [[x, y - 0.0004] for x, y in data["contacts"]["steep"]["points"]]
    scene = scene_from(data)
    found = compared(scene, paired(scene, CHOICES, solvers_of(None), bare=True))
    assert not any(row.shared for row in found.rows)
