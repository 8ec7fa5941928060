"""Files of the harness: text of JSON, files that are whole or absent, and files that grow by whole lines.

A file stays whole after a kill or a loss of power.
"""

import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from uuid import uuid4

_PARTIAL = ".partial"


def text_of(data: Mapping[str, Any], indent: int | None = 1) -> str:
    """``data`` as JSON with a line end; without an ``indent`` in a single line.

    Raises:
        ValueError: a number in ``data`` is not finite.
    """
    return (
        json.dumps(data, indent=indent, ensure_ascii=False, allow_nan=False, separators=None if indent else (",", ":"))
        + "\n"
    )


def write(path: Path, content: str | bytes) -> None:
    """Write a file in one step: beside its place, to the disk, and then into its place; a missing folder is made.

    Raises:
        OSError: the folder cannot be made or written to; the error names the file.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{path.name}.{uuid4().hex}{_PARTIAL}")
        try:
            with os.fdopen(os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666), "wb") as stream:
                stream.write(content.encode("utf-8") if isinstance(content, str) else content)
                stream.flush()
                os.fsync(stream.fileno())
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)
    except OSError as error:
        # the error of a full disk names no file, and another error names the temporary file
        error.filename, error.filename2 = str(path), None
        raise


def append_line(path: Path, line: str) -> None:
    """Add a line to a file; a line that a kill cuts short has no end and is dropped by :func:`whole_lines`.

    Raises:
        OSError: the file cannot be written to.
    """
    with path.open("ab") as stream:
        stream.write(line.encode("utf-8") + b"\n")


def whole_lines(path: Path) -> list[str]:
    """The whole lines of a file, none where the file is absent; a last line without an end is cut off the file.

    Raises:
        OSError: the file cannot be read or cut.
    """
    if not path.exists():
        return []
    content = path.read_bytes()
    whole = content[: content.rfind(b"\n") + 1]
    if len(whole) < len(content):
        os.truncate(path, len(whole))
    return whole.decode("utf-8").split("\n")[:-1]


def clear_partial(folders: Iterable[Path]) -> None:
    """Remove from ``folders`` the temporary files of killed processes.

    Raises:
        OSError: a file cannot be removed.
    """
    for folder in folders:
        for partial in folder.glob(f".*{_PARTIAL}"):
            partial.unlink(missing_ok=True)
