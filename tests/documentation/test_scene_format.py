"""The page on the scene format: every example reads, every key of the schema has a line, every sketch is shown."""

import re
import tomllib
from importlib import import_module
from xml.etree import ElementTree

import pytest

from cprbm_scene import scene_from
from cprbm_scene.reading import schema
from tests.documentation.pages import DOCS, blocks, directives

PAGE = DOCS / "scene-format.md"
BASE, *CHANGES = map(tomllib.loads, blocks(PAGE, "toml"))
(TABLE_OF_POINTS,) = blocks(PAGE, "text")
SCHEMA = schema()
RECORDS = SCHEMA["$defs"] | {"Scene": SCHEMA}


@pytest.fixture(scope="module")
def modules():
    """Modules of the documentation that write tables and sketches."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(DOCS)
        yield import_module("key_tables"), import_module("sketches")


def changed(base, change, depth=3):
    """The data of ``base`` with the keys of ``change``, table by table down to the keys of a named record."""
    if depth == 0 or not (isinstance(base, dict) and isinstance(change, dict)):
        return change
    return base | {key: changed(base.get(key), value, depth - 1) for key, value in change.items()}


@pytest.mark.parametrize("change", [{}, *CHANGES], ids=lambda change: "-".join(change) or "base")
def test_an_example_is_a_scene(change, tmp_path):
    (tmp_path / "profile.csv").write_text(TABLE_OF_POINTS, encoding="utf-8")
    scene_from(changed(BASE, change), file=str(tmp_path / "example.toml"))


@pytest.mark.parametrize("record", RECORDS)
def test_every_key_of_the_schema_has_a_line(record, modules):
    tables, _ = modules
    shown = {target.removeprefix("/made/format/").removesuffix(".md") for target, _ in directives(PAGE, "include")}
    assert shown == set(tables.TABLES)
    lines = [
        tables.table(name)
        for name, parts in tables.TABLES.items()
        if record in {base.__name__ for part in parts for base in part.__mro__}
    ]
    assert lines, f"no table has the record {record}"
    for key in RECORDS[record]["properties"]:
        line = re.search(rf"^\| `{key}`(?: of [\w, -]+)? \| [^|]{{4,}} \|(?: [^|]+ \|)?$", "".join(lines), re.MULTILINE)
        assert line, f"{record}.{key}"


def test_every_sketch_is_shown_and_has_the_same_bytes_at_every_drawing(modules):
    _, sketches = modules
    shown = sorted(target for target, _ in directives(PAGE, "figure"))
    assert shown == sorted(f"/made/format/{name}.svg" for name in sketches.SKETCHES)
    for sketch in sketches.SKETCHES.values():
        svg = sketches.svg(*sketch)
        assert svg == sketches.svg(*sketch)
        assert len(list(ElementTree.fromstring(svg))) > 5


def test_an_unknown_mark_is_refused(modules):
    _, sketches = modules
    with pytest.raises(ValueError, match="found the mark 'beem'; allowed: beam,"):
        sketches.svg("a sketch", 10, "beem M0,0L9,9")
