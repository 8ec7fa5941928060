"""What a sub-command's trouble is called, and its exit code; imported when there is one."""

from __future__ import annotations

import sys
from concurrent.futures.process import BrokenProcessPool

from scene import SceneError

WRONG_QUESTION = 2
NOT_FINISHED = 1


def told(error: Exception) -> tuple[str, int] | None:
    """A sentence about an ``error`` and the exit code; None of one that is nobody's but ours."""
    match error:
        case SceneError():
            return f"The question is wrong. {'; '.join(str(mistake) for mistake in error.mistakes)}", WRONG_QUESTION
        case BrokenProcessPool():
            return (
                "A process that was solving ended by force, perhaps for want of memory; what was finished stands.",
                NOT_FINISHED,
            )
        case MemoryError():
            return "There is not enough memory for this; what was finished stands.", NOT_FINISHED
        case ImportError() if _of_others(error.name):
            return (
                f"The library {error.name} cannot be loaded ({error}); this installs what is needed: "
                f"{sys.executable} -m pip install --upgrade --force-reinstall {_distribution(error.name)}",
                WRONG_QUESTION,
            )
        case OSError():
            return f"Cannot write {error.filename or 'the output'}: {error.strerror or error}.", WRONG_QUESTION
    return None


def _of_others(module: str | None) -> bool:
    return module is not None and module.partition(".")[0] not in (
        "scene",
        "cprbm",
        "fea_reference",
        "exact",
        "comparisons",
    )


def _distribution(module: str | None) -> str:
    """What the library of a module is called where it is installed from."""
    top = (module or "").partition(".")[0]
    return {"skfem": "scikit-fem"}.get(top, top)
