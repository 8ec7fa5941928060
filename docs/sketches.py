"""Sketches of the page on the scene format, drawn as SVG as the pages are built.

    python docs/sketches.py        all sketches, into docs/made/format

A sketch is a text of marks, a line for each: the name of the mark, numbers or an SVG path without spaces, and a label.
Coordinates are pixels, y down; every sketch is ``WIDTH`` wide.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from sketch_marks import SKETCHES

from comparisons.writing import write

if TYPE_CHECKING:
    from sphinx.application import Sphinx

MADE = Path(__file__).resolve().parent / "made" / "format"
WIDTH = 400
INK, BLUE, RED, GREY, AREA = "#222", "#1f5fa8", "#c8321e", "#888", "#c9ced4"

PATHS: Mapping[str, str] = {
    "beam": f'stroke="{BLUE}" stroke-width="6"',
    "slim": f'stroke="{BLUE}" stroke-width="2"',
    "line": f'stroke="{INK}" stroke-width="1.2"',
    "rest": f'stroke="{GREY}" stroke-width="1.2" stroke-dasharray="5 4"',
    "body": f'stroke="{INK}" stroke-width="3"',
    "axis": f'stroke="{GREY}" stroke-width="1.2" marker-end="url(#grey)"',
    "load": f'stroke="{RED}" stroke-width="2" marker-end="url(#red)"',
    "span": f'stroke="{GREY}" stroke-width="1.2" marker-start="url(#grey)" marker-end="url(#grey)"',
    "solid": f'fill="{AREA}"',
    "strip": f'fill="{BLUE}" fill-opacity="0.35" stroke="{BLUE}" stroke-width="1.5"',
}
"""Looks of marks with a path."""

CIRCLES: Mapping[str, str] = {
    "disc": f'fill="{AREA}" stroke="{INK}" stroke-width="1.2"',
    "pin": f'fill="white" stroke="{INK}" stroke-width="2"',
    "dot": f'fill="{INK}"',
}
"""Looks of marks with a center and a radius."""

_ARROW = (
    '<marker id="{}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto-start-reverse" '
    'markerUnits="userSpaceOnUse"><path d="M0 0L8 4L0 8z" fill="{}"/></marker>'
)


def svg(title: str, height: int, marks: str) -> str:
    """A sketch as SVG, ``WIDTH`` by ``height`` pixels, with a white ground."""
    shapes = [_shape(line.strip()) for line in marks.strip().splitlines()]
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}" '
            'font-family="DejaVu Sans, sans-serif" font-size="13" fill="none" stroke-linejoin="round" role="img">',
            f"<title>{title}</title>",
            f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
            f"<defs>{_ARROW.format('red', RED)}{_ARROW.format('grey', GREY)}</defs>",
            *shapes,
            "</svg>\n",
        ]
    )


def _shape(line: str) -> str:
    """SVG of a line of marks."""
    mark, *words = line.split()
    if mark in PATHS:
        return f'<path d="{words[0]}" {PATHS[mark]}/>'
    if mark in CIRCLES:
        x, y, radius = words
        return f'<circle cx="{x}" cy="{y}" r="{radius}" {CIRCLES[mark]}/>'
    if mark == "ground":
        x, y, length, angle = words
        teeth = "".join(f"M{i},0l-6,8" for i in range(6, int(length) + 1, 8))
        place = f'transform="translate({x} {y}) rotate({angle})"'
        return f'<path d="M0,0H{length}{teeth}" {place} stroke="{INK}" stroke-width="1.5"/>'
    if mark in ("start", "middle", "end"):
        x, y, *text = words
        return f'<text x="{x}" y="{y}" text-anchor="{mark}" fill="{INK}">{" ".join(text)}</text>'
    raise ValueError(f"found the mark {mark!r}; allowed: {', '.join((*PATHS, *CIRCLES))}, ground, start, middle, end")


def write_sketches() -> None:
    """Write all sketches into ``docs/made/format``."""
    for name, (title, height, marks) in SKETCHES.items():
        write(MADE / f"{name}.svg", svg(title, height, marks))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the drawing before Sphinx reads the pages."""
    app.connect("builder-inited", lambda _: write_sketches())
    return {"parallel_read_safe": True}


if __name__ == "__main__":
    write_sketches()
