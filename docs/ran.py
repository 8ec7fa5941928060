"""Run the scripts of the gallery and write their pages with output and drawings.

python docs/ran.py              all scripts, into docs/made/gallery
python docs/ran.py sweep        a single script
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import re
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
    """Names of all scripts, in the order of the page."""
    return tuple(sorted(path.stem for path in SCRIPTS.glob("*.py")))


def run(name: str, folder: Path) -> str:
    """Run a script in a folder for its drawings; the printed text."""
    import matplotlib as mpl
    from matplotlib import pyplot

    folder.mkdir(parents=True, exist_ok=True)
    mpl.use("agg")
    printed = io.StringIO()
    with contextlib.chdir(folder), contextlib.redirect_stdout(printed), mpl.rc_context({"svg.hashsalt": name}):
        runpy.run_path(str(SCRIPTS / f"{name}.py"), run_name="__main__")
    pyplot.close("all")
    return printed.getvalue()


def title_of(name: str) -> str:
    """Title of a script: the first line of its docstring."""
    source = (SCRIPTS / f"{name}.py").read_text(encoding="utf-8")
    return source.removeprefix('"""').split("\n", 1)[0].rstrip(".")


def part(name: str, printed: str, drawings: Sequence[str]) -> str:
    """Section of the page for a script: source, scene, output and drawings."""
    source = (SCRIPTS / f"{name}.py").read_text(encoding="utf-8")
    scenes = [path.name for path in sorted(SCRIPTS.glob("*.toml")) if path.name in source]
    lines = [f"## {title_of(name)}\n", f"`docs/gallery/{name}.py`\n"]
    lines.append(f"```{{literalinclude}} /gallery/{name}.py\n:language: python\n```\n")
    lines += [
        f"The scene, `{scene}`:\n\n```{{literalinclude}} /gallery/{scene}\n:language: toml\n```\n" for scene in scenes
    ]
    lines.append(f"Output:\n\n```text\n{printed.rstrip()}\n```\n")
    for drawing in drawings:
        lines.append(f"```{{figure}} /made/gallery/{name}/{drawing}\n:alt: {title_of(name)}\n```\n")
    return "\n".join(lines)


def make(name: str) -> str:
    """Run a script for the page, unless the same code ran before; the script's name."""
    stamp, now = MADE / name / "made-by", _digest()
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != now:
        printed = run(name, MADE / name)
        drawings = sorted(path.name for path in (MADE / name).glob("*.svg"))
        write(MADE / name / "part.md", part(name, printed, drawings))
        write(stamp, now)
    return name


def write_thumbnails() -> None:
    """Write the row of small pictures: a link to the section of every script with a drawing."""
    lines = []
    for drawing in sorted(MADE.glob("*/*.svg")):
        title = title_of(drawing.parent.name)
        anchor = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        lines.append(
            f"[![{title}](/made/gallery/{drawing.parent.name}/{drawing.name})](#{anchor})\\\n[{title}](#{anchor})\n"
        )
    write(MADE / "thumbnails.md", "\n".join(lines))


def _digest() -> str:
    found = hashlib.sha256(Path(__file__).read_bytes())
    for room in ROOMS:
        for path in sorted((HERE.parent / room).rglob("*")):
            if path.suffix in {".py", ".toml"}:
                found.update(path.read_bytes())
    return found.hexdigest()


def make_all(chosen: Sequence[str] = ()) -> Iterator[str]:
    """Run the named scripts, or all; a name for every finished script."""
    yield from map(make, chosen or names())
    write_thumbnails()


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the run of the scripts before Sphinx reads the pages."""
    app.connect("builder-inited", _inited)
    return {"parallel_read_safe": True}


def _inited(app: Sphinx) -> None:
    for name in make_all():
        print(f"output of {name}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    for done in make_all(sys.argv[1:]):
        print(done)
