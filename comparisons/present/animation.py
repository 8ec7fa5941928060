"""Pictures, animations and files of an answer: the ending of the file's name selects the kind.

Matplotlib brings Pillow, which joins the pictures of an animation.  The same pictures give the same bytes.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from comparisons.present.figures import stress_picture
from comparisons.present.picture import View, bounds_of, views_of
from comparisons.present.space import space_pictures
from comparisons.present.strips import Coloured
from comparisons.present.vtu import beam_block, series, vtu
from cprbm_scene import Answer, Scene

Kind = Literal[".3d.png", ".3d.gif", ".3d.apng", ".png", ".svg", ".gif", ".apng", ".vtu", ".pvd"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""Endings of files; ``.3d.png`` stands before ``.png``."""

_MOVING = (".3d.gif", ".3d.apng", ".gif", ".apng", ".pvd")  # kinds with all stations
_MOST = 120  # pictures of an animation; of more stations some are shown, evenly
_DOTS = {".png": 170.0, ".svg": 300.0}  # to the inch
_MOVING_DOTS = 90.0
_WHOLE, _SHORTEST, _LONGEST, _REST = 6000, 40, 500, 1500  # ms: all pictures, one picture, the last picture


def kind_of(path: Path) -> Kind | None:
    """Kind of a file by name; None for an unknown ending."""
    return next((kind for kind in KINDS if path.name.lower().endswith(kind) and len(path.name) > len(kind)), None)


def files(scene: Scene, answer: Answer, path: Path, kind: Kind, quantity: Coloured) -> Iterator[tuple[Path, bytes]]:
    """Files and their content, ``path`` as the last.

    Args:
        scene: with probes for stresses, :func:`comparisons.present.strips.with_stresses`.
        answer: with one station at least; a single picture shows the last.
        path: of the file.
        kind: of the content.
        quantity: quantity of the colours.

    Raises:
        ImportError: a library for the kind is not installed.
        comparisons.present.space.DrawingError: VTK cannot draw here.
    """
    views = views_of(scene, answer)[0 if kind in _MOVING else -1 :]
    bounds = bounds_of(scene, views, quantity)
    if kind == ".pvd":
        yield from series(scene, views, path)
    elif kind == ".vtu":
        yield path, vtu(beam_block(views[-1]))
    elif kind in _DOTS:
        yield path, stress_picture(scene, views[-1], bounds, quantity, kind[1:], _DOTS[kind])
    else:
        few = _some(views)
        pictures = (
            space_pictures(scene, few, bounds, quantity)
            if kind.startswith(".3d")
            else [stress_picture(scene, view, bounds, quantity, "png", _MOVING_DOTS) for view in few]
        )
        yield path, pictures[0] if kind == ".3d.png" else animation(pictures, "gif" if "gif" in kind else "apng")


def _some(views: Sequence[View]) -> Sequence[View]:
    """All views, or ``_MOST`` evenly chosen views with the last."""
    if len(views) <= _MOST:
        return views
    return [views[round(place)] for place in np.linspace(0, len(views) - 1, _MOST)]


def animation(pictures: Sequence[bytes], kind: Literal["gif", "apng"]) -> bytes:
    """PNG ``pictures`` of one size as an animation without end."""
    from PIL import Image

    each = int(min(_LONGEST, max(_SHORTEST, 10 * round(_WHOLE / 10 / len(pictures)))))
    stays = [each] * (len(pictures) - 1) + [max(each, _REST)]
    frames = [Image.open(io.BytesIO(content)).convert("RGB") for content in pictures]
    stream = io.BytesIO()
    if kind == "gif":
        # one palette for all, of the last picture with all colours: otherwise the pictures flicker
        palette = frames[-1].quantize(colors=255)
        frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
        frames[0].save(stream, "GIF", save_all=True, append_images=frames[1:], duration=stays, loop=0, disposal=1)
    else:
        frames[0].save(stream, "PNG", save_all=True, append_images=frames[1:], duration=stays, loop=0)
    return stream.getvalue()
