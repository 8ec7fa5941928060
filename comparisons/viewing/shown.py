"""What an answer looks like, as the content of files: the file's name decides of what kind."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal, get_args

import numpy as np

from comparisons.viewing import flat
from comparisons.viewing.animated import animation
from comparisons.viewing.frames import ARROW, LEAST, Bounds, Coloured, Frame, bounds_of, frames_of, shown_unit
from comparisons.viewing.solids import beams, obstacles
from comparisons.viewing.space import View
from cprbm_scene import Answer, Scene
from cprbm_scene.answer import Array
from cprbm_scene.statement import FixedBody

Kind = Literal[".3d.png", ".3d.gif", ".3d.apng", ".png", ".svg", ".gif", ".apng", ".vtu", ".pvd"]
KINDS: tuple[Kind, ...] = get_args(Kind)
"""How the names of files end, and so what is in them: those that end in another one stand before it."""

MOVING = (".3d.gif", ".3d.apng", ".gif", ".apng", ".pvd")
"""Those that hold all stations."""

MOST = 120
"""Pictures in an animation: of more stations so many are shown, evenly."""

_DOTS, _MOVING_DOTS, _DRAWN_DOTS = 170.0, 90.0, 300.0  # to the inch: of a picture, an animation, an SVG's colours


def kind_of(path: Path) -> Kind | None:
    """What a file of that name holds; None of one that says nothing known."""
    return next((kind for kind in KINDS if path.name.lower().endswith(kind) and len(path.name) > len(kind)), None)


def files(scene: Scene, answer: Answer, path: Path, kind: Kind, quantity: Coloured) -> Iterator[tuple[Path, bytes]]:
    """Files and their content, ``path`` as the last.

    Args:
        scene: one that asks for stresses, :func:`comparisons.viewing.strips.with_stresses`.
        answer: with one station at least; a single picture is of the last.
        path: where what is asked for goes.
        kind: of its content.
        quantity: what colours.

    Raises:
        ImportError: a library that the kind needs is not there.
        comparisons.viewing.space.DrawingError: no picture in space can be drawn here.
    """
    frames = frames_of(scene, answer)
    if kind not in MOVING:
        frames = frames[-1:]
    bounds = bounds_of(scene, frames, quantity)
    match kind:
        case ".png" | ".svg":
            dots = _DOTS if kind == ".png" else _DRAWN_DOTS
            yield path, flat.picture(scene, frames[-1], bounds, quantity, kind.removeprefix("."), dots)
        case ".gif" | ".apng":
            drawn = [flat.picture(scene, each, bounds, quantity, "png", _MOVING_DOTS) for each in some(frames)]
            yield path, animation(drawn, "gif" if kind == ".gif" else "apng")
        case ".3d.png":
            yield path, _in_space(scene, frames, bounds, quantity)[0]
        case ".3d.gif" | ".3d.apng":
            drawn = _in_space(scene, some(frames), bounds, quantity)
            yield path, animation(drawn, "gif" if kind == ".3d.gif" else "apng")
        case ".vtu":
            from comparisons.viewing.series import vtu

            yield path, vtu(beams(frames[-1]))
        case ".pvd":
            from comparisons.viewing.series import series

            yield from series(scene, frames, path)


def some(frames: Sequence[Frame]) -> list[Frame]:
    """All frames, or MOST of them, evenly, with the last."""
    if len(frames) <= MOST:
        return list(frames)
    return [frames[round(place)] for place in np.linspace(0, len(frames) - 1, MOST)]


def _in_space(scene: Scene, frames: Sequence[Frame], bounds: Bounds, quantity: Coloured) -> list[bytes]:
    from comparisons.viewing.space import pictures

    factor, unit = shown_unit(scene, quantity, bounds.most)
    title = f"{flat.TITLES[quantity].partition(',')[0]}, {unit.replace('·', ' ').replace('µ', 'u')}"
    views = [_view(scene, frame, bounds) for frame in frames]
    return pictures(views, bounds, quantity, factor, title)


def _view(scene: Scene, frame: Frame, bounds: Bounds) -> View:
    lines = []
    for body in scene.bodies.values():
        known = [np.array([*frame.places[point], 0.0]) for point in body.points if point in frame.places]
        if not isinstance(body, FixedBody) and len(known) > 1:
            pairs = zip(known, known[1:] + known[:1] * (len(known) > 2), strict=False)
            lines += [np.stack(pair) for pair in pairs if not np.array_equal(*pair)]
    return View(
        flat.title_of(scene, frame, symbols=False), beams(frame), obstacles(frame), tuple(lines), _arrows(frame, bounds)
    )


def _arrows(frame: Frame, bounds: Bounds) -> Array:
    """Tails and ways (k, 2, 3) of the resultants, each in front of the beam, whose width would hide it."""
    wide = 0.55 * max(float(strip.width.max()) for strip in frame.strips.values())
    found = [np.zeros((0, 2, 3))]
    for push in frame.pushes:
        size = float(np.hypot(*push.resultant))
        if size > LEAST * bounds.force:
            way = ARROW * float(max(bounds.high - bounds.low)) / bounds.force * push.resultant
            found.append(np.array([[[*(push.middle - way), wide], [*way, 0.0]]]))
    return np.concatenate(found)
