"""Files that are either whole or not there, written beside their place and moved into it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from pathlib import Path

_PARTIAL = ".partial"


def write(path: Path, content: str | bytes) -> None:
    """Write a file in one step, making its folder where it is missing.

    Raises:
        OSError: the folder cannot be made or written to; the error names the file.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=_PARTIAL)
        temporary = Path(name)
        try:
            with os.fdopen(handle, "wb") as stream:
                stream.write(content.encode("utf-8") if isinstance(content, str) else content)
            temporary.chmod(0o666 & ~_umask())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        # that of a full disk names no file, and that of the file beside it would name one nobody has asked for
        error.filename, error.filename2 = str(path), None
        raise


def clear_partial(folders: Iterable[Path]) -> None:
    """Remove from some folders what a process left beside its place that was killed as it wrote.

    Raises:
        OSError: one cannot be removed.
    """
    for folder in folders:
        for partial in folder.glob(f".*{_PARTIAL}"):
            partial.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
