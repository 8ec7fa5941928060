"""Messages and exit codes for exceptions; imported after an exception only."""

from __future__ import annotations

from concurrent.futures import BrokenExecutor
from concurrent.futures.process import BrokenProcessPool
from difflib import get_close_matches
from pathlib import Path

from comparisons.cli.missing_library import WRONG_QUESTION
from cprbm_scene import Mistake, SceneError

NOT_FINISHED = 1


def message(error: Exception) -> tuple[str, int] | None:
    """Sentence and exit code for an ``error``; None for a fault of the program."""
    match error:
        case SceneError():
            lines = "\n  ".join(_with_next_step(mistake) for mistake in error.mistakes)
            return f"The question is wrong.{' ' if len(error.mistakes) == 1 else chr(10) + '  '}{lines}", WRONG_QUESTION
        case BrokenProcessPool():
            return (
                "A worker process was killed, perhaps for lack of memory. Finished results stand; repeat the command "
                "to go on.",
                NOT_FINISHED,
            )
        case BrokenExecutor():
            return f"{error} Finished results stand; repeat the command to go on.", NOT_FINISHED
        case MemoryError():
            return "The memory is too small for this model. Finished results stand; ask for fewer links.", NOT_FINISHED
        case OSError():
            return f"Cannot write {error.filename or 'the output'}: {error.strerror or error}.", WRONG_QUESTION
    return None


def _with_next_step(mistake: Mistake) -> str:
    """A mistake, with the next step for a missing file."""
    path = Path(mistake.file)
    if mistake.key or not mistake.file or path.exists():
        return str(mistake)
    near = get_close_matches(path.name, [file.name for file in path.parent.glob("*.toml")], n=1)
    meant = f"is {path.parent / near[0]} meant? " if near else ""
    return f"{mistake}; {meant}'cprbm new NAME' writes a scene to start from, 'cprbm list' names the built-in cases"
