"""Figures as a page holds them: matplotlib's SVG made part of the page's own text.

Such a part must not bring along what belongs to a file of its own: the XML header, the style sheet (it would style the
page), identifiers that other figures have as well.  Colours become those of the page, so that a figure is as dark or
light as what it stands in.  Shapes of letters are the same in all figures; a page has each of them once, for all.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from xml.etree import ElementTree

from comparisons.figures import BLUE, GREY, RED, Picture
from cprbm_scene.frozendict import frozendict

_SVG, _XLINK = "{http://www.w3.org/2000/svg}", "{http://www.w3.org/1999/xlink}"
_COLOURS: Mapping[str, str] = frozendict(
    {
        "#000000": "var(--ink)",
        "#222222": "var(--ink)",
        "#ffffff": "var(--page)",
        "#e4e4e4": "var(--rule)",
        "#eef2f7": "var(--tint)",
        GREY: "var(--grey)",
        BLUE: "var(--blue)",
        RED: "var(--red)",
    }
)
_COLOUR = re.compile("#[0-9a-f]{6}")
_REFERENCE = re.compile(r"url\(#([^)]+)\)")
_LETTER = re.compile(r"DejaVu\w+-[0-9a-f]+")
"""Identifiers of the shapes of letters, which no other text of a figure is."""


@dataclass(frozen=True, slots=True)
class Inline:
    """A figure as a page holds it.

    Attributes:
        name: of its files.
        caption: what it shows.
        svg: its markup, without the shapes of its letters.
        letters: these, markup by identifier.
        width: of the figure as drawn, points.
    """

    name: str
    caption: str
    svg: str
    letters: dict[str, str]
    width: float


def inlined(picture: Picture, chapter: str) -> Inline:
    """A drawn figure as part of the chapter of a page.

    Args:
        picture: the figure.
        chapter: a name that no other chapter of the page has.
    """
    root = ElementTree.fromstring(picture.svg)
    prefix = f"{chapter}-{picture.name}-"
    letters: dict[str, str] = {}
    for parent in list(root.iter()):
        for child in list(parent):
            name = child.get("id", "")
            if child.tag in (f"{_SVG}metadata", f"{_SVG}style"):
                parent.remove(child)
            elif _LETTER.fullmatch(name):
                letters[name] = _markup(child)
                parent.remove(child)
    wanted = {link.removeprefix("#") for each in root.iter() if (link := each.get(f"{_XLINK}href"))}
    wanted |= {name for each in root.iter() for value in each.attrib.values() for name in _REFERENCE.findall(value)}
    for each in root.iter():
        name = each.attrib.pop("id", "")
        if name in wanted:
            each.set("id", prefix + name)
        link = each.attrib.pop(f"{_XLINK}href", None)
        if link is not None:
            own = link if link.removeprefix("#") in letters or not link.startswith("#") else f"#{prefix}{link[1:]}"
            each.set("href", own)
        for key, value in each.attrib.items():
            if "url(#" in value:
                each.set(key, _REFERENCE.sub(rf"url(#{prefix}\1)", value))
            if key == "style":
                each.set(key, _COLOUR.sub(lambda found: _COLOURS.get(found[0], found[0]), each.attrib[key]))
    width, height = (float(root.attrib.pop(side).removesuffix("pt")) for side in ("width", "height"))
    root.attrib.clear()
    root.set("viewBox", f"0 0 {width:g} {height:g}")
    root.set("role", "img")
    root.set("aria-label", picture.caption)
    return Inline(picture.name, picture.caption, _markup(root), letters, width)


def letters_of(pictures: Iterable[Inline]) -> str:
    """The shapes of all letters of some figures, each once."""
    found = {name: shape for each in pictures for name, shape in each.letters.items()}
    return "".join(found[name] for name in sorted(found))


def _markup(element: ElementTree.Element) -> str:
    """An element without namespaces, which in a page it has by where it stands, and without idle white space."""
    for each in element.iter():
        each.tag = each.tag.removeprefix(_SVG)
        each.text = each.text.strip() or None if each.text else None
        each.tail = None
    return ElementTree.tostring(element, "unicode")
