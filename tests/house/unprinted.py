"""Figures that are drawn and never printed: the layout of text and the printing take most of the time of a report."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

import pytest


@contextmanager
def without_printing() -> Iterator[None]:
    """Context in which Matplotlib draws all parts of a figure, and prints a white picture in their place.

    A wrong call of Matplotlib is still an error.  Errors in printing, such as a bad formula in a label, are unseen.
    """
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine
    from matplotlib.transforms import Bbox
    from PIL import Image

    def page(drawing: Figure, *_: object) -> Bbox:
        return Bbox.from_bounds(0.0, 0.0, *drawing.get_size_inches())

    def white(drawing: Figure, place: str | Path | BinaryIO, *, format: str, **_: object) -> None:  # noqa: A002
        width, height = (round(72.0 * inches) for inches in drawing.get_size_inches())
        picture = io.BytesIO()
        if format == "svg":
            picture.write(
                f'<?xml version="1.0" encoding="utf-8" standalone="no"?>\n<svg xmlns="http://www.w3.org/2000/svg" '
                f'width="{width}pt" height="{height}pt" viewBox="0 0 {width} {height}" version="1.1"></svg>\n'.encode()
            )
        else:
            Image.new("RGB", (width, height), "white").save(picture, format)
        if isinstance(place, str | Path):
            Path(place).write_bytes(picture.getvalue())
        else:
            place.write(picture.getvalue())

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", white)
        patch.setattr(Figure, "get_tightbbox", page)
        patch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: None)
        yield
