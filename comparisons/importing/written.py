"""The text of a scene whose beams are the tagged curves of a file.

Every curve of a physical group is a beam with the group's name, numbered where there are several; ends that meet are
welded to one body.  A physical group of points is a body: ``ground`` (or ``fixed``) stands still.  Numbers stay in the
file's unit.  What no drawing tells, loads and what is asked, is there to be changed.
"""

from __future__ import annotations

import re
import tomllib
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from comparisons.importing.curves import Fitted, fitted
from comparisons.importing.gmshed import Drawn, Traced
from cprbm_scene import Arc, Line
from cprbm_scene.answer import Array
from cprbm_scene.mistakes import Mistake, SceneError
from cprbm_scene.reading import scene_from

Unit = Literal["m", "cm", "mm", "um", "in"]

SAME = 1e-6
"""Of the longest curve: ends nearer than this are one point, and what lies so flat is in one plane."""

GROUND = ("ground", "fixed")


@dataclass(frozen=True, slots=True)
class Wish:
    """What is asked of the scene beside its geometry: ``thickness`` and ``width`` in the file's ``unit``.

    ``within`` is how far a spline may be from a curve, of the curve's length.
    """

    name: str
    unit: Unit
    thickness: float
    width: float
    within: float


@dataclass(frozen=True, slots=True)
class _Beam:
    name: str
    traced: Traced
    fitted: Fitted


def text(drawn: Drawn, path: Path, wish: Wish) -> str:
    """The scene of what was ``drawn`` in a file.

    Raises:
        SceneError: curves are none that a beam can have, or what they make is no scene.
    """
    if not drawn.curves:
        raise SceneError([Mistake("", "no curve", "curves, in physical groups whose names the beams get", str(path))])
    longest = max(_length(curve.points) for curve in drawn.curves)
    beams = _beams(drawn, path, wish, SAME * longest)
    places, bodies = _bodies(drawn, beams, SAME * longest)
    found = "\n".join(_lines(drawn, path, wish, beams, places, bodies)) + "\n"
    scene_from(tomllib.loads(found), file=str(path))
    return found


def _length(points: Array) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _beams(drawn: Drawn, path: Path, wish: Wish, near: float) -> list[_Beam]:
    mistakes, beams = [], []
    many, used = Counter(curve.tag for curve in drawn.curves), Counter[str]()
    z = drawn.curves[0].points[0, 2]
    for curve in drawn.curves:
        used[curve.tag] += 1
        name = _name(curve.tag) + (f"-{used[curve.tag]}" if many[curve.tag] > 1 else "")
        key = f"{curve.tag} (curve {curve.number}, {curve.kind})"
        off = float(np.abs(curve.points[:, 2] - z).max())
        if off > near:
            mistakes.append(Mistake(key, f"points {off:.4g} {wish.unit} off the plane z = {z:g}",
                                    "curves in one plane z = constant", str(path)))  # fmt: skip
            continue
        if np.linalg.norm(curve.points[0] - curve.points[-1]) <= near:
            mistakes.append(Mistake(key, "a curve that comes back to where it begins", "a curve with two ends; "
                                    "one that goes round is cut into two", str(path)))  # fmt: skip
            continue
        ways = None if curve.directions is None else curve.directions[:, :2]
        made = fitted(curve.points[:, :2], ways, wish.within * _length(curve.points))
        if made is None:
            mistakes.append(Mistake(key, f"a curve that no spline follows within {wish.within:g} of its length",
                                    "a smooth curve, cut at corners, or a larger --within", str(path)))  # fmt: skip
            continue
        beams.append(_Beam(name, curve, made))
    if mistakes:
        raise SceneError(mistakes)
    return beams


def _name(tag: str) -> str:
    """A name that a scene may have, of any text."""
    name = re.sub(r"[^A-Za-z0-9_-]", "_", tag)[:48]
    return name if re.match(r"[A-Za-z_]", name) else f"_{name}"


def _bodies(drawn: Drawn, beams: list[_Beam], near: float) -> tuple[list[tuple[Array, str]], dict[str, list[str]]]:
    """Named places, and the names of every body's points; where ends meet at no named place is a body of its own."""
    places: list[tuple[Array, str]] = []
    bodies: dict[str, list[str]] = {}
    for tag, group in drawn.points.items():
        name = _name(tag)
        single = len(group) == 1 and tag not in GROUND
        bodies[f"{name}-body" if single else name] = names = (
            [name] if single else [f"{name}-{number}" for number in range(1, len(group) + 1)]
        )
        places += [(place[:2], each) for place, each in zip(group, names, strict=True)]
    ends = [np.array(end) for beam in beams for end in (beam.fitted.curve.start, beam.fitted.curve.end)]
    for end in ends:
        meeting = sum(float(np.hypot(*(end - other))) <= near for other in ends)
        if meeting > 1 and _at(places, end, near) is None:
            name = f"joint{len(bodies) + 1}"
            bodies[f"{name}-body"] = [name]
            places.append((end, name))
    if not any(name in bodies for name in GROUND):
        first = _at(places, ends[0], near)
        if first is None:
            places.append((ends[0], "ground-1"))
            bodies["ground"] = ["ground-1"]
        else:
            owner = next(body for body, names in bodies.items() if first in names)
            bodies = {("ground" if body == owner else body): names for body, names in bodies.items()}
    return places, bodies


def _at(places: list[tuple[Array, str]], end: Array, near: float) -> str | None:
    return next((name for place, name in places if float(np.hypot(*(end - place))) <= 2.0 * near), None)


def _lines(
    drawn: Drawn,
    path: Path,
    wish: Wish,
    beams: list[_Beam],
    places: list[tuple[Array, str]],
    bodies: dict[str, list[str]],
) -> list[str]:
    where = {name: place for place, name in places}
    near = SAME * max(_length(beam.traced.points) for beam in beams)
    of_tags = "curves in physical groups, or with names" if drawn.tagged else "all curves: none has a tag"
    ours = [name for body, names in bodies.items() if body not in GROUND for name in names]
    found = [
        f"# {wish.name}: beams from {path.name} ({of_tags}). Lengths are in {wish.unit}, all else is in SI.",
        "# The geometry is that of the file; material, load, station and probes are to be changed into your own.",
        "",
        f'name = "{wish.name}"',
        f'title = "From {path.name}"' if '"' not in path.name and "\\" not in path.name else 'title = ""',
        f'units = {{ length = "{wish.unit}" }}',
        "",
        "[materials.steel]",
        "youngs_modulus = 2.1e11",
        "poisson_ratio = 0.3",
    ]
    for body, names in bodies.items():
        motion = "fixed" if body in GROUND else "free"
        points = ", ".join(f"{name} = {_pair(where[name])}" for name in names)
        found += ["", f"[bodies.{body}]", f'motion = "{motion}"', f"points = {{ {points} }}"]
    for beam in beams:
        found += ["", _said(beam, wish), f"[beams.{beam.name}]", f"curve = {_curve(beam.fitted)}"]
        found += [f"thickness = {wish.thickness!r}", f"width = {wish.width!r}", 'material = "steel"']
        for side, end in (("start", beam.fitted.curve.start), ("end", beam.fitted.curve.end)):
            point = _at(places, np.array(end), near)
            joint = '{ joint = "free" }' if point is None else f'{{ joint = "weld", point = "{point}" }}'
            found.append(f"{side} = {joint}")
    found += ["", "# To be changed: what loads the mechanism."]
    if ours:
        found += ["[loads.F]", 'kind = "force"', f'point = "{ours[0]}"', "direction = [0.0, -1.0]"]
    else:
        found += ["[loads.F]", 'kind = "beam_force"', f'beam = "{beams[0].name}"', "at = 1.0" if _free(beams[0], places,
                  near) else "at = 0.5", "direction = [0.0, -1.0]"]  # fmt: skip
    found += ["", "[[stages]]", 'name = "load"', 'steps = "F"', "stations = [1.0]"]
    if ours:
        found += ["", "[[probes]]", f'of = "{ours[0]}"', 'quantity = "displacement"']
    for beam in beams:
        found += ["", "[[probes]]", f'of = "{beam.name}"', 'quantity = "bending_stress"']
    return found


def _free(beam: _Beam, places: list[tuple[Array, str]], near: float) -> bool:
    return _at(places, np.array(beam.fitted.curve.end), near) is None


def _said(beam: _Beam, wish: Wish) -> str:
    curve = beam.fitted.curve
    of = f"# Curve {beam.traced.number} ({beam.traced.kind}) of the file"
    if isinstance(curve, Line | Arc):
        return f"{of}, to round-off."
    known = "" if beam.traced.directions is not None else ", of which places alone are known"
    share = beam.fitted.deviation / _length(beam.traced.points)
    return (
        f"{of}{known}: a spline through {len(curve.points)} of its points, within {beam.fitted.deviation:.2g} "
        f"{wish.unit} of {len(beam.traced.points)} of them ({share:.1g} of its length)."
    )


def _curve(made: Fitted) -> str:
    curve = made.curve
    ends = f"start = {_pair(curve.start)}, end = {_pair(curve.end)}"
    if isinstance(curve, Line):
        return f'{{ kind = "line", {ends} }}'
    if isinstance(curve, Arc):
        return f'{{ kind = "arc", center = {_pair(curve.center)}, {ends}, direction = "{curve.direction}" }}'
    ways = "".join(
        f", {key} = {_pair(way)}"
        for key, way in (("start_direction", curve.start_direction), ("end_direction", curve.end_direction))
        if way is not None
    )
    return f'{{ kind = "spline", points = [{", ".join(map(_pair, curve.points))}]{ways} }}'


def _pair(place: Array | tuple[float, float]) -> str:
    return f"[{float(place[0])!r}, {float(place[1])!r}]"
