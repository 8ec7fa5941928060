"""The text of a scene with the curves of a drawing as beams.

Every curve of a group is a beam with the group's name, numbered in a group of several curves; ends that meet are welded
to one body.  A group of points is a body: ``ground`` (or ``fixed``) stands still.  Numbers stay in the drawing's unit.
Wrong curves are left out and named in a comment.  Load, stage and probes are placeholders.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from comparisons.importing.curves import Fitted, fitted
from comparisons.importing.drawing import Drawing, DrawnCurve
from cprbm_scene import Arc, Line
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.reading import scene_from

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


@dataclass(frozen=True, slots=True)
class _Beam:
    name: str
    drawn: DrawnCurve
    fitted: Fitted
    length: float


def scene_text(drawing: Drawing, path: Path, choices: Choices) -> tuple[str, list[str]]:
    """Text of the scene, and sentences on everything left out or wrong.

    Raises:
        SceneError: the drawing has no curve for a beam.
    """
    if not drawing.curves:
        found = f"no curve {'; '.join(('', *drawing.refused))}".rstrip()
        raise SceneError([Mistake("", found, "lines, arcs and curves, in groups or layers named for beams", str(path))])
    near = SAME * max(_length(curve.points) for curve in drawing.curves)
    beams, mistakes = _beams(drawing, choices, near)
    while True:
        if not beams:
            raise SceneError([Mistake(each.key, each.found, each.allowed, str(path)) for each in mistakes])
        notes = [f"left out: {entity}" for entity in drawing.refused] + [f"left out: {each}" for each in mistakes]
        text = "\n".join(_lines(drawing, path, choices, beams, near, notes)) + "\n"
        try:
            scene_from(tomllib.loads(text))
            return text, notes
        except SceneError as error:
            keys = {each.key.split(".")[1]: each for each in error.mistakes if each.key.startswith("beams.")}
            wrong = [beam for beam in beams if beam.name in keys]
            if not wrong:
                notes += [f"to be changed: {each}" for each in error.mistakes]
                return "\n".join(_lines(drawing, path, choices, beams, near, notes)) + "\n", notes
        mistakes += [Mistake(_label(beam.drawn), keys[beam.name].found, keys[beam.name].allowed) for beam in wrong]
        beams = [beam for beam in beams if beam not in wrong]


def _length(points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _label(curve: DrawnCurve) -> str:
    return f"{curve.tag} (curve {curve.number}, {curve.kind})"


def _beams(drawing: Drawing, choices: Choices, near: float) -> tuple[list[_Beam], list[Mistake]]:
    """Beams of all curves that a beam can have, and the mistakes of the other curves."""
    beams, mistakes = [], []
    many, used = Counter(curve.tag for curve in drawing.curves), Counter[str]()
    z = drawing.curves[0].points[0, 2]
    for curve in drawing.curves:
        used[curve.tag] += 1
        name = _name(curve.tag) + (f"-{used[curve.tag]}" if many[curve.tag] > 1 else "")
        length, off = _length(curve.points), float(np.abs(curve.points[:, 2] - z).max())
        directions = None if curve.directions is None else curve.directions[:, :2]
        if off > near:
            found, allowed = (
                f"points {off:.4g} {choices.unit} off the plane z = {z:g}",
                "curves in one plane z = constant",
            )
        elif np.linalg.norm(curve.points[0] - curve.points[-1]) <= near:
            found = "a curve that comes back to the begin"
            allowed = "a curve with two ends; a closed curve is cut into two"
        elif (made := fitted(curve.points[:, :2], directions, choices.within * length)) is None:
            found = f"a curve that no spline follows within {choices.within:g} of the length"
            allowed = "a smooth curve, cut at corners, or a larger --within"
        else:
            beams.append(_Beam(name, curve, made, length))
            continue
        mistakes.append(Mistake(_label(curve), found, allowed))
    return beams, mistakes


def _name(tag: str) -> str:
    """A name of a scene for any text."""
    name = re.sub(r"[^A-Za-z0-9_-]", "_", tag)[:48]
    return name if re.match(r"[A-Za-z_]", name) else f"_{name}"


class _Bodies:
    """Named ``places`` of points, and names of points by bodies; ends that meet at no named place are a body."""

    def __init__(self, drawing: Drawing, beams: list[_Beam], near: float) -> None:
        self.places: list[tuple[Array, str]] = []
        self.names: dict[str, list[str]] = {}
        self._near = 2.0 * near
        for tag, group in drawing.points.items():
            name = _name(tag)
            single = len(group) == 1 and tag not in GROUND
            names = [name] if single else [f"{name}-{number}" for number in range(1, len(group) + 1)]
            self.names[f"{name}-body" if single else name] = names
            self.places += [(place[:2], each) for place, each in zip(group, names, strict=True)]
        ends = [np.array(end) for beam in beams for end in (beam.fitted.curve.start, beam.fitted.curve.end)]
        for end in ends:
            if sum(float(np.hypot(*(end - other))) <= near for other in ends) > 1 and self.at(end) is None:
                name = f"joint{len(self.names) + 1}"
                self.names[f"{name}-body"] = [name]
                self.places.append((end, name))
        first = self.at(ends[0])
        if not any(name in self.names for name in GROUND):
            if first is None:
                self.places.append((ends[0], "ground-1"))
                first = "ground-1"
            self.names = {body: names for body, names in self.names.items() if first not in names} | {
                "ground": next((names for names in self.names.values() if first in names), [first])
            }

    def at(self, end: Array | tuple[float, float]) -> str | None:
        """Name of the point at an end; None for a free end."""
        return next((name for place, name in self.places if float(np.hypot(*(place - end))) <= self._near), None)


def _lines(
    drawing: Drawing, path: Path, choices: Choices, beams: list[_Beam], near: float, notes: list[str]
) -> Iterator[str]:
    bodies, unit = _Bodies(drawing, beams, near), choices.unit
    where = {name: place for place, name in bodies.places}
    movable = [name for body, names in bodies.names.items() if body not in GROUND for name in names]
    curves = "curves in groups, or with names" if drawing.tagged else "all curves, without names"
    yield f"# {choices.name}: beams from {_comment(path.name)} ({curves}). Lengths are in {unit}, other numbers in SI."
    yield "# The geometry is the drawing's. Change material, load, station and probes."
    yield from (f"# {_comment(note)}" for note in notes)
    title = f"From {path.name}" if re.fullmatch(r"[^\x00-\x1f\x7f\"\\]*", path.name) else ""
    yield f'\nname = "{choices.name}"\ntitle = "{title}"\nunits = {{ length = "{unit}" }}'
    yield "\n[materials.steel]\nyoungs_modulus = 2.1e11\npoisson_ratio = 0.3"
    for body, names in bodies.names.items():
        points = ", ".join(f"{name} = {_pair(where[name])}" for name in names)
        yield f'\n[bodies.{body}]\nmotion = "{"fixed" if body in GROUND else "free"}"\npoints = {{ {points} }}'
    for beam in beams:
        yield f"\n{_accuracy(beam, unit)}\n[beams.{beam.name}]\ncurve = {_curve(beam.fitted)}"
        yield f'thickness = {choices.thickness!r}\nwidth = {choices.width!r}\nmaterial = "steel"'
        for side, end in (("start", beam.fitted.curve.start), ("end", beam.fitted.curve.end)):
            point = bodies.at(end)
            yield (
                f'{side} = {{ joint = "free" }}'
                if point is None
                else f'{side} = {{ joint = "weld", point = "{point}" }}'
            )
    yield "\n# Change the load of the mechanism.\n[loads.F]"
    if movable:
        yield f'kind = "force"\npoint = "{movable[0]}"'
    else:
        at = 1.0 if bodies.at(beams[0].fitted.curve.end) is None else 0.5
        yield f'kind = "beam_force"\nbeam = "{beams[0].name}"\nat = {at}'
    yield 'direction = [0.0, -1.0]\n\n[[stages]]\nname = "load"\nsteps = "F"\nstations = [1.0]'
    yield from (f'\n[[probes]]\nof = "{name}"\nquantity = "displacement"' for name in movable[:1])
    yield from (f'\n[[probes]]\nof = "{beam.name}"\nquantity = "bending_stress"' for beam in beams)


def _comment(text: str) -> str:
    """The text without control characters, which a comment may not have."""
    return re.sub(r"[\x00-\x1f\x7f]", " ", text)


def _accuracy(beam: _Beam, unit: str) -> str:
    curve, drawn = beam.fitted.curve, beam.drawn
    begin = f"# Curve {drawn.number} ({_comment(drawn.kind)}) of the drawing"
    if isinstance(curve, Line | Arc):
        return f"{begin}, to round-off."
    known = "" if drawn.directions is not None else ", known by places alone"
    share = beam.fitted.deviation / beam.length
    return (
        f"{begin}{known}: a spline through {len(curve.points)} places, within {beam.fitted.deviation:.2g} {unit} of "
        f"{len(drawn.points)} places ({share:.1g} of the length)."
    )


def _curve(made: Fitted) -> str:
    curve = made.curve
    ends = f"start = {_pair(curve.start)}, end = {_pair(curve.end)}"
    if isinstance(curve, Line):
        return f'{{ kind = "line", {ends} }}'
    if isinstance(curve, Arc):
        return f'{{ kind = "arc", center = {_pair(curve.center)}, {ends}, direction = "{curve.direction}" }}'
    directions = (("start_direction", curve.start_direction), ("end_direction", curve.end_direction))
    more = "".join(f", {key} = {_pair(direction)}" for key, direction in directions if direction is not None)
    return f'{{ kind = "spline", points = [{", ".join(map(_pair, curve.points))}]{more} }}'


def _pair(place: Array | tuple[float, float]) -> str:
    return f"[{float(place[0])!r}, {float(place[1])!r}]"
