"""The text of a scene with the curves of a drawing as beams, from the template ``scene.toml.jinja``.

Every curve of a group is a beam with the group's name, numbered in a group of several curves; ends that meet are welded
to one body.  A group of points is a body: ``ground`` (or ``fixed``) stands still.  Numbers stay in the drawing's unit.
Wrong curves are left out and named in a comment.  Load, stage and probes are placeholders.

A curve is a line or an arc where the points are exact, otherwise a spline.

======  ==========================================================================
symbol  meaning
======  ==========================================================================
p_k     points along the curve, (n, 2), m
L       length of the polyline through the points, m
c, R    centre and radius of the circle nearest to the points in the least squares, m
δ       largest distance of any p_k from the record
======  ==========================================================================

A line or an arc is exact to round-off: δ is at most EXACT·L.  A spline goes through some of the points, about twice as
many each time until δ is at most the allowed distance.
"""

import math
import re
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Literal, NamedTuple

import jinja2
import numpy as np
import shapely

from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene import Arc, Array, Line, Mistake, SceneError, Spline, scene_from
from cprbm_scene.curve_records import shape_of
from cprbm_scene.fields import LETTERS

Unit = Literal["m", "cm", "mm", "um", "in"]

SAME = 1e-6
"""Distance of ends that meet, and of a plane curve from its plane, of the longest curve."""

GROUND = ("ground", "fixed")


@dataclass(frozen=True, slots=True)
class Choices:
    """Choices beside the geometry: ``thickness`` and ``width`` in the drawing's ``unit``.

    ``within`` is the largest distance of a spline from the curve, of the curve's length.
    """

    name: str
    unit: Unit
    thickness: float
    width: float
    within: float


class Fit(NamedTuple):
    """A ``curve``, and the largest distance of the points from the curve, δ: ``deviation``, m."""

    curve: Line | Arc | Spline
    deviation: float


class _Beam(NamedTuple):
    """A beam with its name, drawn curve, length of the polyline, and record."""

    name: str
    drawn: DrawnCurve
    length: float
    fit: Fit


_Bodies = dict[str, dict[str, Array]]
"""Places of named points by name of the body."""


def scene_text(drawing: Drawing, path: Path, choices: Choices) -> tuple[str, list[str]]:
    """Text of the scene, and sentences on everything left out or wrong.

    Raises:
        SceneError: the drawing has no curve for a beam.
    """
    if not drawing.curves:
        found = f"no curve {'; '.join(('', *drawing.refused))}".rstrip()
        raise SceneError([Mistake("", found, "lines, arcs and curves, in groups or layers named for beams", str(path))])
    near = SAME * max(_length(curve.points) for curve in drawing.curves)
    beams, left_out, names = list[_Beam](), list[Mistake](), _names(drawing.curves)
    for curve, name in zip(drawing.curves, names, strict=True):
        made = _beam(curve, name, drawing.curves[0].points[0, 2], choices, near)
        (beams if isinstance(made, _Beam) else left_out).append(made)  # type: ignore[arg-type]
    while beams:
        notes = [f"left out: {each}" for each in (*drawing.refused, *left_out)]
        refused = _mistakes(_text(drawing, path, choices, beams, near, notes))
        of_beams = {each.key.split(".")[1]: each for each in refused if each.key.startswith("beams.")}
        wrong = [beam for beam in beams if beam.name in of_beams]
        if not wrong:
            notes += [f"to be changed: {each}" for each in refused]
            return _text(drawing, path, choices, beams, near, notes), notes
        for beam in wrong:
            left_out.append(_refusal(beam.drawn, of_beams[beam.name].found, of_beams[beam.name].allowed))
            beams.remove(beam)
    raise SceneError([Mistake(each.key, each.found, each.allowed, str(path)) for each in left_out])


def _mistakes(text: str) -> Sequence[Mistake]:
    """Mistakes in the text of a scene."""
    try:
        scene_from(tomllib.loads(text))
    except SceneError as error:
        return error.mistakes
    return ()


def _length(points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _refusal(curve: DrawnCurve, found: str, allowed: str) -> Mistake:
    return Mistake(f"{curve.tag} (curve {curve.number}, {curve.kind})", found, allowed)


def _names(curves: Sequence[DrawnCurve]) -> list[str]:
    """Names of the beams, with a number in a group of several curves."""
    tags = [curve.tag for curve in curves]
    several = {tag for tag in tags if tags.count(tag) > 1}
    return [name_of(tag) + (f"-{tags[: k + 1].count(tag)}" if tag in several else "") for k, tag in enumerate(tags)]


def name_of(text: str) -> str:
    """A name in a scene for any text."""
    name = re.sub(f"[^{LETTERS}0-9-]", "_", text)[:48]
    return name if re.match(f"[{LETTERS}]", name) else f"_{name}"


def _beam(curve: DrawnCurve, name: str, z: float, choices: Choices, near: float) -> _Beam | Mistake:
    """The beam of a curve in the plane at ``z``, or the reason why the curve is left out."""
    p, length, off = curve.points, _length(curve.points), float(np.abs(curve.points[:, 2] - z).max())
    if off > near:
        found = f"points {off:.4g} {choices.unit} off the plane z = {z:g}"
        return _refusal(curve, found, "curves in one plane z = constant")
    if np.linalg.norm(p[0] - p[-1]) <= near:
        allowed = "a curve with two ends; a closed curve is cut into two"
        return _refusal(curve, "a curve that comes back to the begin", allowed)
    directions = None if curve.directions is None else curve.directions[:, :2]
    made = fit(p[:, :2], directions, choices.within * length)
    if made is None:
        found = f"a curve that no spline follows within {choices.within:g} of the length"
        return _refusal(curve, found, "a smooth curve, cut at corners, or a larger --within")
    return _Beam(name, curve, length, made)


def _bodies(drawing: Drawing, ends: Array, near: float) -> _Bodies:
    """Bodies of the groups of points, and of ``ends`` (k, 2) that meet at no named point; with a ground."""
    bodies: _Bodies = {}
    for tag, group in drawing.points.items():
        name = name_of(tag)
        if len(group) == 1 and tag not in GROUND:
            bodies[f"{name}-body"] = {name: group[0, :2]}
        else:
            bodies[name] = {f"{name}-{number}": place[:2] for number, place in enumerate(group, 1)}
    for end in ends:
        if np.sum(np.hypot(*(ends - end).T) <= near) > 1 and not _point_at(bodies, end, near):
            bodies[f"joint{len(bodies) + 1}-body"] = {f"joint{len(bodies) + 1}": end}
    if not bodies.keys() & set(GROUND):
        first = _point_at(bodies, ends[0], near)
        own = next((body for body, points in bodies.items() if first in points), None)
        bodies["ground"] = {"ground-1": ends[0]} if own is None else bodies.pop(own)
    return bodies


def _point_at(bodies: _Bodies, end: Sequence[float] | Array, near: float) -> str:
    """Name of the point at an end; empty for a free end."""
    every = ((name, place) for points in bodies.values() for name, place in points.items())
    return next((name for name, place in every if float(np.hypot(*(place - end))) <= 2.0 * near), "")


def _text(
    drawing: Drawing, path: Path, choices: Choices, beams: Sequence[_Beam], near: float, notes: Sequence[str]
) -> str:
    """The text with all ``beams``, and ``notes`` as comments."""
    environment = jinja2.Environment(
        undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True
    )
    # a key with an accent stands in quotes, a comment has no control characters
    environment.filters["key"] = lambda name: name if name.isascii() else f'"{name}"'
    environment.filters["comment"] = lambda text: re.sub(r"[\x00-\x1f\x7f]", " ", text)
    curves = [beam.fit.curve for beam in beams]
    bodies = _bodies(drawing, np.array([end for curve in curves for end in (curve.start, curve.end)]), near)
    template = files("comparisons.importing").joinpath("scene.toml.jinja").read_text(encoding="utf-8")
    return environment.from_string(template).render(
        file=path.name,
        title=f"From {path.name}" if re.fullmatch(r"[^\x00-\x1f\x7f\"\\]*", path.name) else "",
        choices=choices,
        notes=notes,
        ground=GROUND,
        bodies=bodies,
        movable=[name for body, points in bodies.items() if body not in GROUND for name in points],
        beams=[
            (beam, _point_at(bodies, curve.start, near), _point_at(bodies, curve.end, near))
            for beam, curve in zip(beams, curves, strict=True)
        ],
    )


EXACT = 1e-9
MOST = 257
"""Points of a spline."""

_DIGITS = 13
_FINE = 8001


def fit(p: Array, directions: Array | None, allowed: float) -> Fit | None:
    """The record of points ``p`` (n, 2), m, in order; None if no spline of MOST points is near enough.

    Args:
        p: along the curve, both ends among them.
        directions: unit tangents (2, 2) at the ends; None without known tangents.
        allowed: δ of a spline, m.
    """
    s = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
    off = _distance(p, p[[0, -1]])
    # a line that turns back on itself is longer than the distance of the ends
    if max(off, s[-1] - float(np.hypot(*(p[-1] - p[0])))) <= EXACT * s[-1]:
        return Fit(Line(kind="line", start=_point(p[0], s[-1]), end=_point(p[-1], s[-1])), off)
    return _arc(p, s[-1]) or _spline(p, s, directions, allowed)


def _point(place: Array, L: float) -> tuple[float, float]:
    """A place to as many digits as its file has: 0.05 and not 0.05000000000000001."""
    x, y = (round(float(each), _DIGITS - math.ceil(math.log10(L))) + 0.0 for each in place)
    return x, y


def _arc(p: Array, L: float) -> Fit | None:
    """The arc through all points; None without such an arc."""
    # |q|² = 2 c·q + (R² − |c|²), about the mean so that nothing cancels
    q = p - p.mean(axis=0)
    c, rest = np.split(np.linalg.lstsq(np.column_stack([2.0 * q, np.ones(len(q))]), np.sum(q**2, axis=1))[0], [2])
    x, y = (q - c).T
    off = float(np.max(np.abs(np.hypot(x, y) - math.sqrt(max(rest[0] + c @ c, 0.0)))))
    turn = np.diff(np.unwrap(np.arctan2(y, x)))
    if len(p) < 4 or off > EXACT * L or abs(np.sum(np.sign(turn))) < len(turn):
        return None
    start, end, centre = (_point(place, L) for place in (p[0], p[-1], p.mean(axis=0) + c))
    arc = Arc(
        kind="arc",
        center=centre,
        start=start,
        end=end,
        direction="counterclockwise" if turn[0] > 0.0 else "clockwise",
    )
    return Fit(arc, off)


def _spline(p: Array, s: Array, directions: Array | None, allowed: float) -> Fit | None:
    """The spline through the fewest points; ``s`` are the lengths of the polyline up to the points, m."""
    first, last = [None, None] if directions is None else [(float(x), float(y)) for x, y in directions]
    for count in 2 ** np.arange(2, math.log2(MOST)).astype(int) + 1:
        chosen = np.unique(np.abs(s[:, None] - np.linspace(0.0, s[-1], count)).argmin(axis=0))
        points = tuple(_point(place, s[-1]) for place in p[chosen])
        # few points may leave no smooth curve, and a curve with a mistake is still one to edit
        spline = Spline.model_construct(kind="spline", points=points, start_direction=first, end_direction=last)
        deviation = _distance(p, shape_of(spline).point(np.linspace(0.0, 1.0, _FINE)))
        if deviation <= allowed:
            return Fit(spline, deviation)
        if len(chosen) == len(p):
            break
    return None


def _distance(p: Array, line: Array) -> float:
    """Largest distance of points (n, 2) from a polyline (m, 2)."""
    return float(np.max(shapely.distance(shapely.points(p), shapely.LineString(line))))
