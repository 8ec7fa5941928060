"""HTML pages from the templates beside this module: whole in themselves, figures included."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files

from comparisons.cells import cells_of, words_in
from comparisons.figures import Picture

_MARKED = ("AGREE", "DIFFER", "UNDECIDED", "met", "not met", "within", "beyond", "far beyond")
"""Cells of a table that have a style of their own."""


@dataclass(frozen=True, slots=True)
class Embedded:
    """A figure as a page holds it: ``data`` is its SVG in base 64."""

    name: str
    caption: str
    data: str


def embedded(picture: Picture) -> Embedded:
    """A figure made ready for a page."""
    return Embedded(picture.name, picture.caption, base64.b64encode(picture.svg).decode("ascii"))


def rendered(template: str, context: Mapping[str, object]) -> str:
    """The page that a template makes of a context; every text in it is escaped.

    Raises:
        jinja2.UndefinedError: the template asks for what the context does not have.
    """
    import jinja2

    environment = jinja2.Environment(
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        loader=jinja2.PackageLoader("comparisons", "pages"),
    )
    environment.filters["cells"] = cells_of
    environment.filters["words"] = words_in
    environment.filters["parted"] = _parted
    environment.filters["joined"] = lambda text: text.replace(" %", "\u00a0%")  # on one line with its number
    style = _beside("style.css")
    return environment.get_template(template).render({**context, "style": style, "marked": _MARKED}) + "\n"


def _parted(escaped: str) -> str:
    """An escaped name that may be parted behind its points and underscores, where a column is narrow.

    It stays of its type, by which a template knows that it is escaped.
    """
    return type(escaped)(re.sub(r"(?<=[^\W\d][._])(?=[^\W\d])", "<wbr>", escaped))


def script(name: str) -> str:
    """The text of a script that stands among the templates."""
    return _beside(name)


def _beside(name: str) -> str:
    return (files("comparisons.pages") / name).read_text("utf-8")
