"""Scenes with a fate in the name, and a solver that brings the fate about."""

from __future__ import annotations

import os
import signal
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from comparisons.choices import Choices
from comparisons.executor import Solver
from comparisons.pairing import Solvers
from cprbm_scene import Answer, Ending, Mistake, Scene, SceneError
from tests.cprbm.scenes import cantilever_data, force
from tests.robustness.drawing import Drawn
from tests.robustness.toml import toml_of
from tests.verdict.made_up import MadeUp, with_value

FATES = (
    "right", "raises", "segfault", "leaves", "spins", "devours", "stiffer", "nan", "early", "refused", "vague",
)  # fmt: skip
WAYS = {
    "right": "agree",
    "raises": "crashed",
    "segfault": "crashed",
    "leaves": "crashed",
    "spins": "timed_out",
    "devours": "crashed",
    "stiffer": "wrong",
    "nan": "wrong",
    "early": "ended",
    "refused": "refused",
    "vague": "undecided",
}


def fated(seed: int, index: int) -> Drawn:
    """A cantilever with a fate in the name; all scenes of seeds other than 0 are right."""
    fate = FATES[index % len(FATES)] if seed == 0 else "right"
    data = {**cantilever_data(force(0.3, -1.0), [0.11, 0.23]), "name": f"{fate}-{seed}-{index}"}
    return Drawn(data["name"], data, toml_of(data), 1)


@dataclass(frozen=True)
class Fated:
    """Answers as the scene's name says; what is asked is noted in a file, if one is given."""

    right: Solver
    noted: str = ""

    def __call__(self, scene: Scene, choices: Choices) -> Answer:
        if self.noted:
            with Path(self.noted).open("a", encoding="utf-8") as file:
                file.write(f"{scene.name}\n")
        found = self.right(scene, choices)
        match scene.name.split("-")[0]:
            case "raises":
                raise ZeroDivisionError("a beam of no length")
            case "segfault":
                os.kill(os.getpid(), signal.SIGSEGV)
            case "leaves":
                os._exit(7)
            case "spins":
                while True:
                    pass
            case "devours":
                return replace(found, seconds=float(np.zeros(2**40).sum()))
            case "stiffer":
                return MadeUp("cprbm", 2e-3, stiffness=1.02, contact=False)(scene, choices)
            case "nan":
                return MadeUp("cprbm", 2e-3, contact=False, spoilt=with_value("T.displacement", [np.nan, 0.0]))(
                    scene, choices
                )
            case "early":
                return replace(found, stations=found.stations[:1], ending=Ending.STEP_TOO_SMALL, sentence="Too small.")
            case "refused":
                raise SceneError([Mistake("beams", "a beam", "none of these")])
            case "theory":
                raise SceneError([Mistake("theory", choices.theory_of(scene), "none")])
            case "vague":
                return MadeUp("cprbm", 6.4, contact=False)(scene, choices)
        return found


def fated_solvers(noted: str = "") -> Solvers:
    """Two that agree wherever the scene's name does not say otherwise."""
    return Solvers(Fated(MadeUp("cprbm", 2e-3, contact=False), noted), MadeUp("fea", -5e-4, contact=False))


def nothing() -> None:
    """What needs no preparation."""


def slow(scene: Scene, choices: Choices) -> Answer:
    """The made-up CPRBM after a tenth of a second."""
    time.sleep(0.1)
    return MadeUp("cprbm", 2e-3, contact=False)(scene, choices)
