"""Solvers of a cantilever with planted faults, and calls that no child process answers."""

import os
import signal
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from comparisons.pairing import cprbm_answer, fea_answer


def called_here(seconds, call, *arguments):
    """Value of a call in this process, in place of ``call_limited``."""
    return call(*arguments)


@dataclass(frozen=True)
class Poisoned:
    """The CPRBM, except at some thicknesses.

    Attributes:
        marks: file with a line per execution, the thickness.
        fates: by thickness, mm: ``child`` kills the process, ``worker`` also the parent; ``sleep`` takes 10 minutes;
            ``fault`` raises.
    """

    marks: str
    fates: Mapping[float, str]

    def __call__(self, scene, choices):
        thickness = round(scene.beams["b"].thickness * 1e3, 6)
        with Path(self.marks).open("a") as stream:
            stream.write(f"{thickness}\n")
        fate = self.fates.get(thickness)
        if fate == "worker":
            os.kill(os.getppid(), signal.SIGKILL)
        if fate in ("child", "worker"):
            os._exit(7)
        if fate == "sleep":
            time.sleep(600.0)
        if fate == "fault":
            raise ZeroDivisionError("a beam of no length")
        return cprbm_answer(scene, choices)


@dataclass(frozen=True)
class Breaking:
    """The CPRBM, with a fault of the program at all thicknesses from ``least`` to ``most``, m."""

    least: float = 0.0
    most: float = 1.0

    def __call__(self, scene, choices):
        if self.least < scene.beams["b"].thickness < self.most:
            raise ZeroDivisionError("a beam of no length")
        return cprbm_answer(scene, choices)


def stiff(scene, choices):
    """Answer of the finite elements with twice the modulus."""
    materials = {
        name: each.model_copy(update={"youngs_modulus": 2.0 * each.youngs_modulus})
        for name, each in scene.materials.items()
    }
    return fea_answer(scene.model_copy(update={"materials": materials}), choices)
