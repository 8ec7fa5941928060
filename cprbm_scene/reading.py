"""TOML in; a :class:`~cprbm_scene.Scene` or an :class:`~cprbm_scene.OffsetQuestion` out, or all mistakes.

The JSON schema of a scene file follows from the records: editors complete keys and mark mistakes with it.  Rules
between records need the reader.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from difflib import get_close_matches
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar, cast

from pydantic import ValidationError

from cprbm_scene.clearance import distant_ends, wrong_assembly, wrong_clearance, wrong_stops
from cprbm_scene.fields import Name, OptionalNamed, Reading
from cprbm_scene.freedoms import wrong_actions, wrong_mobility
from cprbm_scene.mistakes import MOST, Mistake, SceneError, first_of, mistake, mistakes_of, refuse_broken, unknown_name
from cprbm_scene.names import (
    MECHANICAL,
    repeated_names,
    unknown_names,
    wrong_claims,
    wrong_contacts,
    wrong_probes,
    wrong_stages,
)
from cprbm_scene.offset import OffsetQuestion
from cprbm_scene.statement import Beam, Body, Material, Probe, Scene, Stage
from cprbm_scene.units import text_of

_BY_NAME = (repeated_names, unknown_names, wrong_contacts, wrong_stages, wrong_probes, wrong_claims)
_BY_PLACE = (
    distant_ends,
    wrong_assembly,
    wrong_stops,
    wrong_mobility,
    wrong_actions,
    wrong_clearance,
)
_FIRST = ("units", "parameters")
"""Parts of a file that decide on the numbers of all other parts."""
_AT_ONCE = 1000
"""Unknown names of a pass over the file."""


def mistakes_in(scene: Scene) -> Iterator[Mistake]:
    """Mistakes between the records of a scene; none of a valid scene.

    Checks of places need the units of all numbers.
    """
    checks = _BY_NAME if scene.lacks("length", "units") else (*_BY_NAME, *_BY_PLACE)
    return (each for check in checks for each in check(scene) if each.found)


Question = Scene | OffsetQuestion
Asked = TypeVar("Asked", Scene, OffsetQuestion)

DEEPEST = 32
_DEEP_KEY = re.compile(rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){{{DEEPEST}}}""", re.ASCII)
"""A dotted key deeper than any scene's: the parser's time and memory grow with the square of the parts."""


def toml_data(path: str | Path) -> dict[str, Any]:
    """Plain data of a TOML file in UTF-8, with or without a byte-order mark.

    Raises:
        SceneError: the file cannot be read, is too large or too deep, or is no TOML.
    """
    readable = "TOML in UTF-8: numbers with a decimal point; texts, and names with spaces or accents, in quotes"
    try:
        text = text_of(path, readable)
        refuse_broken(
            _DEEP_KEY.search(text) and Mistake("", f"a key of more than {DEEPEST} parts", "the keys of a scene")
        )
        return tomllib.loads(text)
    except (RecursionError, ValueError) as error:
        # nested too deeply, or an integer with too many digits
        wrong = error if isinstance(error, SceneError) else mistake(f"text that is no TOML ({error})", readable)
        raise SceneError(first_of(wrong.mistakes, str(path))) from None


def read(path: str | Path, parameters: Mapping[str, float | str] | None = None) -> Scene:
    """Read a scene file.

    Args:
        path: a TOML file, in SI units or in the units that the file states.
        parameters: values of the file's parameters by name, numbers in SI units or texts such as ``1.9mm``; None keeps
            the file's values.

    Returns:
        The scene, with ``file`` set to ``path``.

    Raises:
        SceneError: the file cannot be read, is no valid scene (the error names all mistakes), or is another question.

    Example:
        >>> from cprbm_scene import read
        >>> hinge = read("comparisons/cases/hinge.toml")
        >>> hinge.beams["beam1"].thickness, hinge.loads["M"].body
        (0.002, 'BD')
    """
    question = read_question(path, parameters)
    refuse_broken(
        isinstance(question, OffsetQuestion)
        and Mistake(
            "question",
            repr(question.question),
            "a scene of beams; of an offset there is no equilibrium, and 'compare' answers it",
            str(path),
        )
    )
    return cast("Scene", question)


def read_question(path: str | Path, parameters: Mapping[str, float | str] | None = None) -> Question:
    """Read a file of either question: a scene, or an offset curve if the file says ``question = "offset"``.

    Args:
        path: a TOML file, a scene's in SI units or in the units that the file states.
        parameters: as of :func:`read`.

    Returns:
        The scene or the offset question, with ``file`` set to ``path``.

    Raises:
        SceneError: as :func:`read`.
    """
    data = toml_data(path)
    if "question" not in data:
        return scene_from(data, file=str(path), parameters=parameters)
    refuse_broken(
        parameters and Mistake("parameters", f"values of {', '.join(parameters)}", "a scene of beams", str(path))
    )
    return offset_from(data, file=str(path))


_PART = re.compile(r"([^.\[]*)\W?([^.\[\]]*)")
"""Begin of a key: a table with the name of a part, or a list with the number of a part."""
_NUMBER = re.compile(r"^(\w+)\[(\d+)")
"""Begin of a key: a list with the number of a part."""


class PartialScene(Scene):
    """A scene that may lack parts."""

    name: Name = "scene"
    materials: OptionalNamed[Material]
    beams: OptionalNamed[Beam]
    bodies: OptionalNamed[Body]
    stages: tuple[Stage, ...] = ()
    probes: tuple[Probe, ...] = ()


class Draft:
    """Data of a scene, from which parts are left out.

    ``left_out`` has tables and names of the parts, of the points of such bodies and beams, and of whole tables with
    unknown names (empty).
    """

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._lists = {key for key, value in data.items() if isinstance(value, list | tuple)}
        # parts of a list are known by their numbers in the file, as texts
        self._parts = {**data, **{key: {str(i): part for i, part in enumerate(data[key])} for key in self._lists}}
        self.left_out: set[tuple[str, str]] = set()

    @property
    def data(self) -> dict[str, Any]:
        """The data without the parts."""
        return {key: list(value.values()) if key in self._lists else value for key, value in self._parts.items()}

    def of_file(self, mistake: Mistake) -> Mistake:
        """A mistake of the present data, with the number in the file of a part of a list."""
        key = _NUMBER.sub(lambda place: f"{place[1]}[{[*self._parts[place[1]]][int(place[2])]}", mistake.key)
        return mistake._replace(key=key)

    def leave_out(self, key: str) -> None:
        """Leave out the part of the file with a mistake at a ``key``; a whole table if the part is unknown."""
        table, part = re.findall(_PART, key)[0]
        parts = self._parts.get(table)
        if isinstance(parts, dict) and part in parts:
            self._parts[table] = {name: value for name, value in parts.items() if name != part}
            self.left_out.update(_names(table, part, parts[part]))
        elif not part or (table, part) not in self.left_out:
            self._parts.pop(table, None)
            table = next(iter(get_close_matches(table, Scene.model_fields, n=1)), table)
            # bodies have points, and free ends of beams are points of bodies
            further = {"bodies": ["points"], "beams": ["points", "bodies"]}.get(table, [])
            self.left_out.update((each, "") for each in (table, *further))


def _names(table: str, part: str, item: object) -> Iterator[tuple[str, str]]:
    """Tables and names that a part defines; an empty name without readable names."""
    yield table, part
    match table, item:
        case "bodies", {"points": dict() as points}:
            yield from (("points", f"{point}") for point in points)
        case "beams", dict():
            # an end with another joint may be a free end with a mistake
            new = [
                end.get("point")
                for end in (item.get("start"), item.get("end"))
                if isinstance(end, dict) and end.get("joint") not in ("weld", "pin")
            ]
            yield from (key for point in new for key in (("points", f"{point}"), ("bodies", f"{point}-body")))
        case "stages", {"name": name}:
            yield table, f"{name}"
        case "probes", {"of": of, "quantity": quantity}:
            yield table, f"{of}.{quantity}"
        case (("bodies" | "stages" | "probes"), _):
            yield {"bodies": "points"}.get(table, table), ""


def scene_from(data: dict[str, Any], *, file: str = "", parameters: Mapping[str, float | str] | None = None) -> Scene:
    """A scene from plain data, checked as :func:`read` checks a file.

    Args:
        data: tables, lists, numbers and texts with the keys of a scene file, as ``tomllib.loads`` returns them. Numbers
            are in SI units or in the units that ``data["units"]`` states.
        file: the name of the file in messages and in ``Scene.file``; may be empty.
        parameters: as of :func:`read`.

    Returns:
        The scene in SI units.

    Raises:
        SceneError: the data are no valid scene. The error names every mistake with its key.

    Example:
        >>> import tomllib
        >>> from pathlib import Path
        >>> from cprbm_scene import scene_from
        >>> data = tomllib.loads(Path("comparisons/cases/hinge.toml").read_text(encoding="utf-8"))
        >>> data["beams"]["beam1"]["thickness"] = 0.003
        >>> scene_from(data).beams["beam1"].thickness
        0.003
    """
    again, found = partial(scene_from, data, file=file), list[Mistake]()
    draft = Draft({"parameters": {}, **data})  # the reading needs parameters, be there none
    while len(found) <= MOST:
        reading = Reading(dict(parameters or {}), Path(file).parent, left_out=frozenset(draft.left_out), again=again)
        kind = Scene if all(table in _FIRST for table, _ in reading.left_out) else PartialScene
        scene, mistakes = _validated(kind, draft.data, file, reading)
        if scene is not None:
            scene._reading = reading
            mistakes = list(islice(unknown_names(scene, MECHANICAL), _AT_ONCE))
            found += () if mistakes else first_of(map(draft.of_file, mistakes_in(scene)))
        first = [each for each in mistakes if each.key.startswith(_FIRST)]
        mistakes = [draft.of_file(each) for each in first or mistakes]
        found += (each for each in mistakes if each.found)
        for each in mistakes:
            draft.leave_out(each.key)
        if reading.left_out == draft.left_out:
            break
    if scene is None or found:
        raise SceneError(first_of(found, file))
    return scene


def offset_from(data: dict[str, Any], *, file: str = "") -> OffsetQuestion:
    """An offset question from plain data, as :func:`scene_from`.

    Raises:
        SceneError: the data are no valid question. The error names every mistake with its key.
    """
    question, found = _validated(OffsetQuestion, data, file, Reading(parameters={}))
    if question is None:
        raise SceneError(first_of(found, file))
    return question


def _validated(
    kind: type[Asked], data: Mapping[str, Any], file: str, reading: Reading
) -> tuple[Asked | None, list[Mistake]]:
    """A question of a ``kind`` from plain data, or None with the mistakes of its records."""
    if "file" in data:  # a record has the name of the file, and a file has not
        return None, [unknown_name("file", "file", "key here", (key for key in kind.model_fields if key != "file"))]
    try:
        return kind.model_validate({**_tuples(data), "file": file}, context=reading), []
    except ValidationError as error:
        return None, mistakes_of(error)
    except RecursionError:
        return None, [Mistake("", "tables nested too deeply", "a scene")]


def _tuples(value: Any) -> Any:  # noqa: ANN401 - whatever TOML holds
    """Plain data with tuples for lists: strict validation of an immutable record takes no lists."""
    if isinstance(value, dict):
        return {key: _tuples(item) for key, item in value.items()}
    return tuple(_tuples(item) for item in value) if isinstance(value, list) else value


def schema() -> dict[str, Any]:
    """The JSON schema of a scene file as plain data, in the dialect that editors of TOML know."""
    return {"$schema": "http://json-schema.org/draft-07/schema#", **Scene.model_json_schema(), "title": "Scene"}
