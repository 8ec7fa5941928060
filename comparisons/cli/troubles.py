"""What a sub-command's trouble is called, and its exit code; imported when there is one."""

from __future__ import annotations

from concurrent.futures.process import BrokenProcessPool
from difflib import get_close_matches
from pathlib import Path

from comparisons.cli.wanting import WRONG_QUESTION
from cprbm_scene import Mistake, SceneError

NOT_FINISHED = 1


def told(error: Exception) -> tuple[str, int] | None:
    """A sentence about an ``error`` and the exit code; None of one that is nobody's but ours."""
    match error:
        case SceneError():
            told = "\n  ".join(_told(mistake) for mistake in error.mistakes)
            return f"The question is wrong.{' ' if len(error.mistakes) == 1 else chr(10) + '  '}{told}", WRONG_QUESTION
        case BrokenProcessPool():
            return (
                "A process that was solving ended by force, perhaps for want of memory; what was finished stands.",
                NOT_FINISHED,
            )
        case MemoryError():
            return "There is not enough memory for this; what was finished stands.", NOT_FINISHED
        case OSError():
            return f"Cannot write {error.filename or 'the output'}: {error.strerror or error}.", WRONG_QUESTION
    return None


def _told(mistake: Mistake) -> str:
    """A mistake, and what to do next where no file is there."""
    path = Path(mistake.file)
    if mistake.key or not mistake.file or path.exists():
        return str(mistake)
    near = get_close_matches(path.name, [each.name for each in path.parent.glob("*.toml")], n=1)
    meant = f"is {path.parent / near[0]} meant? " if near else ""
    return (
        f"{mistake}; {meant}'cprbm new NAME' writes a scene to start from, 'cprbm list' names those that are built in"
    )
