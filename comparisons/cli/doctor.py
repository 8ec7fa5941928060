"""``cprbm list`` and ``doctor``: built-in cases, and installed and missing libraries with install commands.

Every library is imported in a separate process: without a library of the system the import may end the process.
"""

import platform
import shlex
import subprocess
import sys
from dataclasses import dataclass

import click

from comparisons import cases
from comparisons.cli.errors import code_of
from comparisons.provenance import version_of

SECONDS = 120.0

_APT = "apt-get install --yes --no-install-recommends"

WHAT_DRAWS = f"{_APT} libegl1 libgl1-mesa-dri"
"""Command for all that VTK needs to draw without a screen: the dispatcher, and Mesa's renderer."""


@dataclass(frozen=True, slots=True)
class Library:
    """A library.

    Attributes:
        name: of the distribution; module: imported name; needed_for: purpose.
        least: range of releases.
        extra: part of the project with the library; empty of a required library.
        system: command, as root on Debian and Ubuntu, for the libraries of the system; found on a bare Debian 12.
    """

    name: str
    module: str
    needed_for: str
    least: str
    extra: str = ""
    system: str = ""

    @property
    def line(self) -> str:
        """Command that installs the library for the running Python."""
        return f'{shlex.quote(sys.executable)} -m pip install "{self.name}{self.least}"'

    def state(self) -> tuple[bool, str]:
        """Whether the library can be used; and version, purpose, and the command that installs it if needed."""
        found = version_of(self.name)
        if not found:
            return False, f"{'missing':<12} for {self.needed_for}; install: {self.line}"
        trouble = trouble_with(self.module)
        if not trouble:
            return True, f"{found:<12} for {self.needed_for}"
        remedy = f"install the library again: {self.line} --force-reinstall"
        if system := line_for(self.name, trouble):
            remedy = f"on Debian and Ubuntu install its system libraries, as root: {system}"
        return False, f"{found:<12} cannot be imported ({trouble}); for {self.needed_for}; {remedy}"


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
    Library(
        "gmsh",
        "gmsh",
        "meshes of the solid by gmsh, and 'import' of geometry",
        ">=4.13",
        "solid",
        f"{_APT} libgl1 libglu1-mesa libgomp1 libxcursor1 libxft2 libxinerama1",
    ),
    Library("ezdxf", "ezdxf", "'import' of DXF drawings", ">=1.3", "dxf"),
    Library("meshio", "meshio", "meshes of gmsh, and files for ParaView", ">=5.3", "solid"),
    Library("pyvista", "pyvista", "pictures in space by 'view'", ">=0.44", "view", WHAT_DRAWS),
)


def trouble_with(module: str) -> str:
    """Trouble of an import: the last line of Python's message; empty after a successful import."""
    try:
        done = subprocess.run(
            [sys.executable, "-c", f"import {module}"], capture_output=True, text=True, timeout=SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        return f"importing it takes more than {SECONDS:.0f} s"
    last = (done.stderr.strip().splitlines() or [f"importing it ends Python with {done.returncode}"])[-1]
    return last if done.returncode else ""


def line_for(name: str, trouble: str) -> str:
    """Command for the libraries of the system, if the ``trouble`` of a library names a shared library; else empty."""
    return next((each.system for each in LIBRARIES if each.name == name), "") if ".so" in trouble else ""


def list_cases() -> None:
    """Print name, title and source of every built-in case."""
    for name, title, source in cases.described():
        click.echo(f"{name:<16} {title}" + (f" ({source})" if source else ""))


def doctor(quiet: bool) -> int:  # noqa: FBT001 - click passes a keyword
    """Print the state of all libraries; exit code 1 without a required library."""
    if not quiet:
        click.echo(f"Python {platform.python_version()}")
    there, missing, required = list[str](), list[str](), False
    for library in LIBRARIES:
        usable, text = library.state()
        lacking = not (usable or library.extra)
        required |= lacking
        (there if usable else missing).append(library.name)
        if lacking or not quiet:
            click.echo(f"{library.name:<14} {text}")
    if not quiet:
        if "pyvista" in there:
            click.echo(f"{'drawing':<14} {_drawing_text()}")
        summary = f"Answers, verdicts and reports work; {', '.join(missing)}: only for the purpose beside the name."
        if required:
            summary = "A required library is missing; install the library with the command above."
        click.echo(summary if missing else "All libraries are installed.")
    return code_of(incomplete=required)


def _drawing_text() -> str:
    """Whether PyVista draws here."""
    from comparisons.present.view import tried  # NumPy may be missing

    trouble = tried()
    remedy = f"{'impossible':<12} ({trouble}); on Debian and Ubuntu install, as root: {WHAT_DRAWS}"
    return remedy if trouble else f"{'works':<12} for pictures in space by 'view'"
