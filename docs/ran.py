"""The scripts of the gallery run, and shown with what they print and draw.

python docs/ran.py              every script, into docs/made/gallery
python docs/ran.py sweep        one of them
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import runpy
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from comparisons.writing import write

if TYPE_CHECKING:
    from sphinx.application import Sphinx

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE / "gallery"
MADE = HERE / "made" / "gallery"
ROOMS = ("cprbm_scene", "cprbm", "fea_reference", "comparisons", "docs/gallery")


def names() -> tuple[str, ...]:
    """Of all scripts, in the order of the page."""
    return tuple(sorted(path.stem for path in SCRIPTS.glob("*.py")))


def run(name: str, folder: Path) -> str:
    """Run a script in a folder, into which it draws; what it prints."""
    import matplotlib as mpl
    from matplotlib import pyplot

    folder.mkdir(parents=True, exist_ok=True)
    mpl.use("agg")
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed), mpl.rc_context({"svg.hashsalt": name}):
        runpy.run_path(str(SCRIPTS / f"{name}.py"), run_name="__main__")
    pyplot.close("all")
    return printed.getvalue()


def part(name: str, printed: str, drawn: Sequence[str]) -> str:
    """What the page shows of a script."""
    source = (SCRIPTS / f"{name}.py").read_text(encoding="utf-8")
    title = source.removeprefix('"""').split("\n", 1)[0].rstrip(".")
    scenes = [path.name for path in sorted(SCRIPTS.glob("*.toml")) if path.name in source]
    lines = [f"## {title}\n", f"`docs/gallery/{name}.py`\n"]
    lines.append(f"```{{literalinclude}} /gallery/{name}.py\n:language: python\n```\n")
    lines += [
        f"The scene, `{each}`:\n\n```{{literalinclude}} /gallery/{each}\n:language: toml\n```\n" for each in scenes
    ]
    lines.append(f"It prints\n\n```text\n{printed.rstrip()}\n```\n")
    for each in drawn:
        lines.append(f"```{{figure}} /made/gallery/{name}/{each}\n:alt: {title}, as the script draws it\n```\n")
    return "\n".join(lines)


def make(name: str) -> str:
    """Run a script for the page, unless it was run with the same code; the script's name."""
    stamp, now = MADE / name / "made-by", _digest()
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != now:
        printed = run(name, MADE / name)
        drawn = sorted(path.name for path in (MADE / name).glob("*.svg"))
        write(MADE / name / "part.md", part(name, printed, drawn))
        write(stamp, now)
    return name


def _digest() -> str:
    found = hashlib.sha256(Path(__file__).read_bytes())
    for room in ROOMS:
        for path in sorted((HERE.parent / room).rglob("*")):
            if path.suffix in {".py", ".toml"}:
                found.update(path.read_bytes())
    return found.hexdigest()


def make_all(chosen: Sequence[str] = ()) -> Iterator[str]:
    """Run what is missing of these scripts, or of all; each name when it is done."""
    yield from map(make, chosen or names())


def setup(app: Sphinx) -> dict[str, bool]:
    """Have Sphinx the scripts run before the pages are read."""
    app.connect("builder-inited", _inited)
    return {"parallel_read_safe": True}


def _inited(app: Sphinx) -> None:
    for name in make_all():
        print(f"output of {name}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    for done in make_all(sys.argv[1:]):
        print(done)
