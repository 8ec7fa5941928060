"""Accepted changes: a TOML file with a reason for each.

    [[change]]
    scene = "random-905-17"
    class = "moved beyond the stated uncertainty"
    reason = "the tip lands on the other face: the closed form says so"

    [improved]
    cprbm = "the chain is of fourth order: its stated uncertainty falls"

An entry accepts a class of change in a scene. At most ten scenes are accepted for one issue. A crash and a
verdict that became DIFFER cannot be accepted.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tests.baseline.changes import FAILING, Change, Finding

MOST_SCENES = 10
CLASSES = {change.value: change for change in sorted(FAILING - {Change.CRASHED}, key=lambda change: change.value)}
PARTS = ("cprbm", "fea", "theory", "fea_bending", "round_off")
"""Parts of a stated uncertainty, as the documented JSON of ``compare`` names them."""


class AcceptedError(ValueError):
    """A mistake in a file of accepted changes; the text names file, key, found and allowed."""


@dataclass(frozen=True, slots=True)
class Accepted:
    """Reasons of accepted changes by scene and class, and of smaller stated uncertainties by part."""

    changes: Mapping[tuple[str, Change], str] = field(default_factory=dict)
    improved: Mapping[str, str] = field(default_factory=dict)

    def reason(self, finding: Finding) -> str:
        """The reason of an accepted finding; empty for any other finding."""
        if finding.change is Change.WORD and finding.word == "DIFFER":
            return ""
        return self.changes.get((finding.scene, finding.change), "")


def read_accepted(path: Path | None) -> Accepted:
    """The accepted changes of a file; none without a file.

    Raises:
        AcceptedError: the file is missing, is no TOML, or holds a mistake.
    """
    if path is None:
        return Accepted()
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError) as error:
        raise AcceptedError(f"{path}: {error}") from None
    _check(path, "", set(data), {"change", "improved"})
    changes = {}
    for number, entry in enumerate(data.get("change", ())):
        key = f"change[{number}]"
        _check(path, key, set(entry), {"scene", "class", "reason"}, needed=True)
        if entry["class"] not in CLASSES:
            raise AcceptedError(f"{path}: {key}.class: found {entry['class']!r}, allowed: {', '.join(CLASSES)}")
        if not entry["reason"].strip():
            raise AcceptedError(f"{path}: {key}.reason: found nothing, allowed: a sentence")
        changes[entry["scene"], CLASSES[entry["class"]]] = entry["reason"]
    scenes = {scene for scene, _ in changes}
    if len(scenes) > MOST_SCENES:
        raise AcceptedError(f"{path}: change: found {len(scenes)} scenes, allowed: at most {MOST_SCENES}")
    improved = data.get("improved", {})
    _check(path, "improved", set(improved), set(PARTS))
    return Accepted(changes, improved)


def _check(path: Path, key: str, found: set[str], allowed: set[str], *, needed: bool = False) -> None:
    unknown, missing = found - allowed, allowed - found if needed else set()
    if unknown or missing:
        what = f"the unknown key {min(unknown)!r}" if unknown else f"no key {min(missing)!r}"
        where = f"{path}: {key}" if key else f"{path}"
        raise AcceptedError(f"{where}: found {what}, allowed: {', '.join(sorted(allowed))}")
