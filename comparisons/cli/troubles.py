"""What a sub-command's trouble is called, and its exit code; imported when there is one."""

from __future__ import annotations

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
        case OSError():
            return f"Cannot write {error.filename or 'the output'}: {error.strerror or error}.", WRONG_QUESTION
    return None
