"""Data of a scene without the parts that have mistakes: the other parts can still be checked against each other."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

from cprbm_scene.frozendict import frozendict
from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import Beam, Body, Material, Probe, Scene, Stage
from cprbm_scene.units import Name, Named

_PART = re.compile(r"([^.\[]*)\W?([^.\[\]]*)")
"""Begin of a key: a table with the name of a part, or a list with the number of a part."""
_NUMBER = re.compile(r"^(\w+)\[(\d+)")


class PartialScene(Scene):
    """A scene that may lack parts."""

    name: Name = "scene"
    materials: Named[Material] = frozendict()
    beams: Named[Beam] = frozendict()
    bodies: Named[Body] = frozendict()
    stages: tuple[Stage, ...] = ()
    probes: tuple[Probe, ...] = ()


class Draft:
    """Data of a scene, from which parts are left out.

    ``left_out`` has keys of the parts, of the points of such bodies and beams, and of whole tables with unknown names.
    """

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._lists = {key for key, value in data.items() if isinstance(value, list | tuple)}
        # parts of a list are known by their numbers in the file, as texts
        self._parts: dict[str, Any] = {
            **data,
            **{key: {str(i): part for i, part in enumerate(data[key])} for key in self._lists},
        }
        self.left_out: set[str] = set()

    @property
    def data(self) -> dict[str, Any]:
        """The data without the parts."""
        return {key: list(value.values()) if key in self._lists else value for key, value in self._parts.items()}

    def of_file(self, mistake: Mistake) -> Mistake:
        """A mistake of the present data, with the number in the file of a part of a list."""
        key = _NUMBER.sub(lambda place: f"{place[1]}[{[*self._parts[place[1]]][int(place[2])]}", mistake.key)
        return replace(mistake, key=key)

    def leave_out(self, key: str) -> None:
        """Leave out the part of the file with a mistake at a ``key``; a whole table if the part is unknown."""
        table, part = re.findall(_PART, key)[0]
        parts = self._parts.get(table)
        if isinstance(parts, dict) and part in parts:
            self._parts[table] = {name: value for name, value in parts.items() if name != part}
            self.left_out.update(_names(table, part, parts[part]))
        elif f"{table}.{part}" not in self.left_out:
            self._parts.pop(table, None)
            table = next(iter(get_close_matches(table, Scene.model_fields, n=1)), table)
            # bodies have points, and free ends of beams are points of bodies
            self.left_out.update({table, *{"bodies": ["points"], "beams": ["points", "bodies"]}.get(table, [])})


def _names(table: str, part: str, item: object) -> Iterator[str]:
    """Keys of the names that a part defines; the key of the table without readable names."""
    yield f"{table}.{part}"
    match table, item:
        case "bodies", {"points": dict() as points}:
            yield from (f"points.{point}" for point in points)
        case "beams", dict():
            # an end with another joint may be a free end with a mistake
            ends = [item.get(side) for side in ("start", "end")]
            new = (
                end.get("point") for end in ends if isinstance(end, dict) and end.get("joint") not in ("weld", "pin")
            )
            yield from (key for point in new for key in (f"points.{point}", f"bodies.{point}-body"))
        case "stages", {"name": name}:
            yield f"stages.{name}"
        case "probes", {"of": of, "quantity": quantity}:
            yield f"probes.{of}.{quantity}"
        case (("bodies" | "stages" | "probes"), _):
            yield {"bodies": "points"}.get(table, table)
