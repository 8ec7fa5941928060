"""Values of the shared options of commands."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from comparisons.choices import Choices


@dataclass(frozen=True, slots=True)
class Request:
    """Values of shared options; an option without a place in a command has the value here.

    Attributes:
        planted: solvers in place of the real solvers.
        choices: links, elements and variants.
        case: name or file of a single scene; arguments: of several questions.
        values: values of the scene's parameters by name.
        tol: wanted error, a share of the scale; None with stated numbers of links and elements.
        exact: whether the exact reference is asked; with None a rule decides.
        opinions: solvers of a comparison.
        json_file, csv_file, plot_file, out: output files and folder.
        quiet: whether tables and progress are left out.
        place: of the workers.
        at_most: time limit of a solve, s.
    """

    planted: object = None
    choices: Choices = field(default_factory=Choices)
    case: str = ""
    arguments: tuple[str, ...] = ()
    values: Mapping[str, str] = field(default_factory=dict)
    tol: float | None = None
    exact: bool | None = None
    opinions: tuple[str, ...] = ("cprbm", "fea")
    json_file: Path | None = None
    csv_file: Path | None = None
    plot_file: Path | None = None
    out: Path | None = None
    quiet: bool = False
    place: str = ""
    at_most: float = math.inf

    @property
    def prints(self) -> bool:
        """Whether standard output is for people: no JSON goes there."""
        return str(self.json_file) != "-"
