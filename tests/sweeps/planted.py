"""Solver that kills the child or the Dask worker at the thickness of 2 mm."""

import os
import signal
from dataclasses import dataclass
from pathlib import Path

from comparisons.pairing import cprbm_answer


@dataclass(frozen=True)
class Poisoned:
    """The CPRBM, except at the thickness of 2 mm.

    Attributes:
        marks: file with a mark per execution, the thickness.
        worker: whether the worker dies with its child.
    """

    marks: str
    worker: bool = False

    def __call__(self, scene, choices):
        thickness = round(scene.beams["b"].thickness * 1e3, 6)
        with Path(self.marks).open("a") as stream:
            stream.write(f"{thickness}\n")
        if thickness == 2.0:
            if self.worker:
                os.kill(os.getppid(), signal.SIGKILL)
            os._exit(7)
        return cprbm_answer(scene, choices)
