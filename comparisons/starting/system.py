"""Libraries of the system that some of Python's want, and the lines that install them on Debian and Ubuntu.

Each line was found on a bare Debian 12: without one of its packages the library does not load, or nothing is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping

APT = "apt-get install --yes --no-install-recommends"

WHAT_DRAWS = f"{APT} libegl1 libgl1-mesa-dri"
"""By what VTK draws without a screen: the dispatcher, and Mesa's renderer for machines with and without a GPU."""

WANTED: Mapping[str, str] = {
    "gmsh": f"{APT} libgl1 libglu1-mesa libgomp1 libxcursor1 libxft2 libxinerama1",
    "pyvista": WHAT_DRAWS,
}
"""By a library's name what installs all that it wants of the system."""


def line_for(library: str, trouble: str) -> str:
    """What installs what a library wants of the system, if that is its ``trouble``; else nothing."""
    return WANTED.get(library, "") if ".so" in trouble else ""
