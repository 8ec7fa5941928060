"""Messages for a library that cannot be loaded; the module imports no library, since any library may be missing."""

from __future__ import annotations

import shlex
import sys

WRONG_QUESTION = 2

_OURS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")


def message(error: ImportError) -> tuple[str, int] | None:
    """Sentence and exit code for an ``error``; None for a module of this project."""
    library = (error.name or _raising_module(error)).partition(".")[0]
    if not library or library in _OURS:
        return None
    lines = str(error).strip().splitlines() or ["without a reason"]
    distribution = {"skfem": "scikit-fem"}.get(library, library)
    return (
        f"The library {library} cannot be loaded ({lines[0]}). Install it with: "
        f"{shlex.quote(sys.executable)} -m pip install --upgrade --force-reinstall {distribution}",
        WRONG_QUESTION,
    )


def _raising_module(error: ImportError) -> str:
    """Name of the raising module: NumPy and other libraries raise errors without a name."""
    place, module = error.__traceback__, ""
    while place is not None:
        module, place = str(place.tb_frame.f_globals.get("__name__", "")), place.tb_next
    return module
