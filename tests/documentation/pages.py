"""The pages of the documentation as a reader of Markdown sees them, without Sphinx."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
MADE = DOCS / "made"  # by the code, as the pages are built
_FENCED = re.compile(r"^(`{3,})(.*?)\n(.*?)^\1\s*$", re.MULTILINE | re.DOTALL)


def pages():
    """All pages, and what of the project they take in."""
    return sorted(path for path in DOCS.rglob("*.md") if MADE not in path.parents)


def prose(path):
    """Text of a page without code."""
    return re.sub(r"`[^`\n]+`", "", _FENCED.sub("", path.read_text(encoding="utf-8")))


def links(path):
    """Targets of links and pictures within the project."""
    found = re.findall(r"\]\(([^)\s]+)\)", prose(path))
    return [target for target in found if not re.match(r"[a-z]+:", target)]


def anchors(path):
    """Of the headings of a page, as GitHub and Sphinx make them."""
    heads = re.findall(r"^#+ +(.+?)\s*$", _FENCED.sub("", path.read_text(encoding="utf-8")), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.replace("`", "").lower()).replace(" ", "-") for head in heads}


def blocks(path, language):
    """Code blocks of a language on a page."""
    return [body for _, info, body in _FENCED.findall(path.read_text(encoding="utf-8")) if info.strip() == language]


def directives(path, name):
    """Arguments and bodies of the directives with a name."""
    found = _FENCED.findall(path.read_text(encoding="utf-8"))
    return [
        (info.removeprefix(f"{{{name}}}").strip(), body) for _, info, body in found if info.startswith(f"{{{name}}}")
    ]


def entries(path):
    """Pages that a page's tables of contents name."""
    return [
        path.parent / f"{line.strip()}.md"
        for _, body in directives(path, "toctree")
        for line in body.splitlines()
        if line.strip() and not line.startswith(":")
    ]


def broken(path):
    """Links of a page that lead nowhere."""
    wrong = []
    for target in links(path):
        file, _, anchor = target.partition("#")
        there = (path.parent / file).resolve() if file else path
        if not there.is_file() or (anchor and anchor not in anchors(there)):
            wrong.append(target)
    return wrong
