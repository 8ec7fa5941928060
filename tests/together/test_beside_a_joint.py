"""An arc that is pressed flat from its pin on: how the pin and the plane share the load no mesh resolves at first.

The reference is statics: together pin and plane bear what is laid on, which is 1.06 way what just makes the arc lie
flat, EI/(R x) with x its end's distance from the pin, so that a sixth of an element lies flat.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from comparisons.choices import Choices
from comparisons.measures import Row
from comparisons.pairing import paired, solvers_of
from comparisons.verdict import Comparison, compared
from comparisons.words import Word
from cprbm_scene import Scene, scene_from
from tests.together.planted import stiffer

R, ANGLE = 0.31, 0.6
STANDS, LIES = 0.0354, 0.0357  # m: the end's way down before and after the arc begins to lie flat


def pressed_flat(way: float) -> Scene:
    end = [R * np.sin(ANGLE), R * (1.0 - np.cos(ANGLE))]
    return scene_from(
        {
            "name": "pressed-flat",
            "materials": {"steel": {"youngs_modulus": 2.0e11, "poisson_ratio": 0.3}},
            "bodies": {
                "wall": {"motion": "fixed", "points": {"Q": [0.0, 0.0]}},
                "tip": {"motion": "free", "points": {"T": end}},
            },
            "beams": {
                "arc": {
                    "curve": {
                        "kind": "arc",
                        "center": [0.0, R],
                        "start": [0.0, 0.0],
                        "end": end,
                        "direction": "counterclockwise",
                    },
                    "thickness": 0.0011,
                    "width": 0.017,
                    "material": "steel",
                    "start": {"joint": "pin", "point": "Q"},
                    "end": {"joint": "weld", "point": "T"},
                }
            },
            "drives": {"down": {"kind": "displacement", "point": "T", "direction": [0.0, -1.0]}},
            "contacts": {
                "plane": {
                    "kind": "beam-half-plane",
                    "beam": "arc",
                    "body": "wall",
                    "point": [0.0, 0.0],
                    "normal": [0.0, 1.0],
                    "thick": False,
                }
            },
            "stages": [{"name": "press", "steps": "down", "stations": [way]}],
            "probes": [
                {"of": "plane", "quantity": "force"},
                {"of": "plane", "quantity": "centre"},
                {"of": "T", "quantity": "reaction"},
            ],
        }
    )


def verdict(way: float, *, stiff: bool = False) -> Comparison:
    scene, solvers = pressed_flat(way), solvers_of(None)
    if stiff:
        right = solvers.cprbm
        solvers = replace(solvers, cprbm=lambda scene, choices: right(stiffer(scene), choices))
    choices = Choices(links=40, elements=40, kinematics="bending")
    return compared(scene, paired(scene, choices, solvers, bare=True))


def of_force(found: Comparison) -> Row:
    return next(row for row in found.rows if row.probe.quantity == "force")


def test_what_the_contact_bears_cannot_be_told_and_what_it_bears_with_the_joint_is() -> None:
    found = verdict(LIES)
    row = of_force(found)
    assert found.verdict.word is Word.UNDECIDED
    assert "plane presses arc within an element of its joint at Q" in found.verdict.because
    assert row.cprbm > 10.0 * row.fea
    assert row.beside is not None
    assert row.beside.together is not None
    reaction = next(row for row in found.rows if row.probe.quantity == "reaction")
    for together, pressed in zip(row.beside.together, (reaction.cprbm, reaction.fea), strict=True):
        np.testing.assert_allclose(together, np.hypot(*pressed), rtol=1e-7)


def test_a_wrong_sum_differs() -> None:
    found = verdict(LIES, stiff=True)
    words = {row.probe.quantity: word for row, word in zip(found.rows, found.verdict.words, strict=True)}
    assert found.verdict.word is Word.DIFFER
    assert words["force"] is Word.DIFFER


def test_an_arc_that_stands_free_beside_its_pin_presses_nowhere_beside_it() -> None:
    found = verdict(STANDS)
    assert of_force(found).beside is None
    assert found.verdict.word is Word.AGREE
