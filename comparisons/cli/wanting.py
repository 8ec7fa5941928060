"""What is said where a library cannot be loaded; of no library itself, since any may be the one."""

from __future__ import annotations

import shlex
import sys

WRONG_QUESTION = 2

_OURS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")


def told(error: ImportError) -> tuple[str, int] | None:
    """A sentence about an ``error`` and the exit code; None where it is a module of ours that is not found."""
    library = (error.name or _raised_in(error)).partition(".")[0]
    if not library or library in _OURS:
        return None
    lines = str(error).strip().splitlines() or ["without a reason"]
    distribution = {"skfem": "scikit-fem"}.get(library, library)
    return (
        f"The library {library} cannot be loaded ({lines[0]}); this installs what is needed: "
        f"{shlex.quote(sys.executable)} -m pip install --upgrade --force-reinstall {distribution}",
        WRONG_QUESTION,
    )


def _raised_in(error: ImportError) -> str:
    """The module that raised it: NumPy and others give their advice without a name."""
    place, module = error.__traceback__, ""
    while place is not None:
        module, place = str(place.tb_frame.f_globals.get("__name__", "")), place.tb_next
    return module
