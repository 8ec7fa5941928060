"""Which libraries are there, what each is for, and what installs one that is missing.

Each is imported in a process of its own: one that wants a library of the system may end the process that asks.
"""

from __future__ import annotations

import shlex
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

SECONDS = 120.0


@dataclass(frozen=True, slots=True)
class Library:
    """A library: its distribution's ``name``, the ``module`` that is imported, what it is ``needed_for``.

    ``extra`` is the part of the project that it comes with, empty of one without which nothing works; ``least`` the
    oldest release that will do.
    """

    name: str
    module: str
    needed_for: str
    least: str
    extra: str = ""

    @property
    def line(self) -> str:
        """What installs it for the Python that runs."""
        return f'{shlex.quote(sys.executable)} -m pip install "{self.name}{self.least}"'


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
    Library("numpy", "numpy", "every number", ">=2.0"),
    Library("scipy", "scipy.linalg", "linear algebra", ">=1.13"),
    Library("numba", "numba", "the compiled chain", ">=0.61"),
    Library("scikit-fem", "skfem", "the finite elements", ">=12.0,<13"),
    Library("shapely", "shapely", "outlines that cross", ">=2.1"),
    Library("pydantic", "pydantic", "reading scenes and settings", ">=2.9"),
    Library("click", "click", "the command line", ">=8.2"),
    Library("rich", "rich", "tables and progress", ">=13.7"),
    Library("jinja2", "jinja2", "pages", ">=3.1"),
    Library("matplotlib", "matplotlib.figure", "figures", ">=3.9"),
    Library("casadi", "casadi", "IPOPT, an optimiser that 'bench' compares with in a checkout", ">=3.6", "peers"),
    Library("xarray", "xarray", "sweeps as NetCDF", ">=2024.7", "netcdf"),
    Library("distributed", "distributed", "sweeps on many machines", ">=2024.8", "cluster"),
    Library(
        "threadpoolctl",
        "threadpoolctl",
        "linear algebra in one thread, where Python calls the solvers",
        ">=3.5",
        "threads",
    ),
    Library("gmsh", "gmsh", "meshes of the solid by gmsh, and 'import' of geometry", ">=4.13", "solid"),
    Library("ezdxf", "ezdxf", "'import' of DXF drawings", ">=1.3", "dxf"),
    Library("meshio", "meshio", "those meshes, and files for ParaView", ">=5.3", "solid"),
    Library("pyvista", "pyvista", "pictures in space by 'view'", ">=0.44", "view"),
)


def looked_for() -> Iterator[State]:
    """What is there of each library."""
    for library in LIBRARIES:
        try:
            found = version(library.name)
        except PackageNotFoundError:
            yield State(library, "", "")
            continue
        yield State(library, found, trouble_with(library.module))


def trouble_with(module: str) -> str:
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
