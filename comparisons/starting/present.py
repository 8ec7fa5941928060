"""Which libraries are there, what each is for, and what installs one that is missing.

Each is imported in a process of its own: one that wants a library of the system may end the process that asks.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

SECONDS = 120.0


@dataclass(frozen=True, slots=True)
class Library:
    """A library: its distribution's ``name``, the ``module`` that is imported, what it is ``needed_for``.

    ``extra`` is the part of the project that it comes with, empty of one without which nothing works.
    """

    name: str
    module: str
    needed_for: str
    extra: str = ""

    @property
    def line(self) -> str:
        """What installs it."""
        return f'pip install "cprbm[{self.extra}]"' if self.extra else "pip install cprbm"


@dataclass(frozen=True, slots=True)
class State:
    """What was found: the ``version``, empty where it is not installed, and why it cannot be imported, else empty."""

    library: Library
    version: str
    trouble: str

    @property
    def there(self) -> bool:
        """Whether it can be used."""
        return bool(self.version) and not self.trouble


LIBRARIES = (
    Library("numpy", "numpy", "every number"),
    Library("scipy", "scipy.linalg", "linear algebra"),
    Library("scikit-fem", "skfem", "the finite elements"),
    Library("pydantic", "pydantic", "reading scenes and settings"),
    Library("click", "click", "the command line"),
    Library("rich", "rich", "tables and progress"),
    Library("jinja2", "jinja2", "pages"),
    Library("matplotlib", "matplotlib.figure", "figures"),
    Library("casadi", "casadi", "IPOPT, one of the optimisers that 'bench' and 'study readings' compare with", "peers"),
    Library("threadpoolctl", "threadpoolctl", "one thread of BLAS where Python has loaded it before", "threads"),
    Library("gmsh", "gmsh", "meshes of the solid by gmsh, in the place of plain ones", "solid"),
    Library("meshio", "meshio", "carrying them over", "solid"),
)


def looked_for() -> Iterator[State]:
    """What is there of each library."""
    for library in LIBRARIES:
        try:
            found = version(library.name)
        except PackageNotFoundError:
            yield State(library, "", "")
            continue
        yield State(library, found, _trouble(library.module))


def _trouble(module: str) -> str:
    """Why a module cannot be imported: the last line that Python says of it."""
    try:
        done = subprocess.run(
            [sys.executable, "-c", f"import {module}"], capture_output=True, text=True, timeout=SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        return f"importing it takes more than {SECONDS:.0f} s"
    if done.returncode == 0:
        return ""
    lines = done.stderr.strip().splitlines()
    return lines[-1] if lines else f"importing it ends Python with {done.returncode}"
