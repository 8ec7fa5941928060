"""Links lead somewhere, every page can be reached, and the README is short and has what it promises."""

import re

import pytest

from comparisons import cases
from cprbm_scene import read
from tests.documentation.pages import DOCS, MADE, ROOT, broken, directives, entries, pages

README = ROOT / "README.md"


WRITTEN = {str(path.relative_to(ROOT)): path for path in (README, ROOT / "CONTRIBUTING.md", *pages())}


@pytest.mark.parametrize("path", WRITTEN.values(), ids=WRITTEN.keys())
def test_links_lead_somewhere(path):
    assert broken(path) == []


def test_a_planted_link_to_nowhere_is_found(tmp_path):
    (tmp_path / "there.md").write_text("# One `head`, two\n", encoding="utf-8")
    page = tmp_path / "page.md"
    page.write_text(
        "[a](there.md) [b](there.md#one-head-two) [c](gone.md) [d](there.md#gone) `[e](code.md)`\n\n"
        "```text\n[f](fenced.md)\n```\n[g](https://example.org/x)\n",
        encoding="utf-8",
    )
    assert broken(page) == ["gone.md", "there.md#gone"]


def test_every_page_is_reached_from_the_first():
    reached, waiting = set(), [DOCS / "index.md"]
    while waiting:
        page = waiting.pop()
        assert page.is_file(), page
        assert page not in reached, f"{page} stands in two tables of contents"
        reached.add(page)
        waiting += entries(page)
    assert set(pages()) == reached
    assert len(reached) > 30


def test_what_pages_take_in_is_there():
    for page in pages():
        for name in ("include", "literalinclude", "figure"):
            for target, _ in directives(page, name):
                path = DOCS / target[1:] if target.startswith("/") else page.parent / target
                assert MADE in path.parents or path.resolve().is_file(), f"{page}: {target}"


@pytest.mark.parametrize("name", cases.names())
def test_every_case_has_a_page_with_its_figures_and_its_scene(name):
    page = DOCS / "examples" / f"{name}.md"
    assert (f"/made/{name}/part.md", "") in directives(page, "include")
    assert [target for target, _ in directives(page, "literalinclude")] == [f"../../comparisons/cases/{name}.toml"]


def test_the_readme_is_short_and_has_one_picture_and_one_table():
    text = README.read_text(encoding="utf-8")
    assert 300 <= len(text.split()) <= 600
    (picture,) = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", text)
    assert b"<svg" in (ROOT / picture).read_bytes()
    assert len(re.findall(r"^\|[-| :]+\|$", text, re.MULTILINE)) == 1


@pytest.mark.parametrize(("page", "most"), [("docs/limits.md", 600), ("CONTRIBUTING.md", 900), ("CHANGELOG.md", 600)])
def test_a_short_page_stays_short(page, most):
    assert len((ROOT / page).read_text(encoding="utf-8").split()) <= most


def test_the_kept_random_scenes_are_read():
    kept = sorted((DOCS / "scenes").glob("*.toml"))
    assert kept
    assert [read(path).name for path in kept] == [path.stem for path in kept]
