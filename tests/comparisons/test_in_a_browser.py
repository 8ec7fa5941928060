"""The report in a real browser: without a complaint, on every width, by mouse and by keyboard, and on paper."""

import re

import pytest

from comparisons.cli.main import run
from comparisons.pairing import Solvers
from tests.comparisons.browser import WANTED, browser, found
from tests.verdict.made_up import MadeUp

pytestmark = pytest.mark.usefixtures("printed")

WIDTHS = (1280, 1024, 900, 768, 390)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The report of the hinge, by solvers that solve nothing."""
    out = tmp_path_factory.mktemp("browser")
    solvers = Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4))
    asked = ["report", "hinge", "--sizes", "10,20", "--without", "times", "--out", str(out), "--quiet"]
    assert run(asked, solvers) == 0
    return out / "index.html"


@pytest.fixture(scope="module")
def tab(page):
    """The page, open in a tab."""
    program = found()
    if program is None:
        pytest.skip(WANTED)
    with browser(program) as opened:
        opened.seen(WIDTHS[0])
        opened.open(page)
        yield opened


def test_nothing_is_said_on_the_console_and_nothing_asked_of_a_network(tab):
    assert tab.run("document.querySelectorAll('article').length") == 1
    assert tab.said == []


def test_the_slider_moves_the_mechanism_and_its_values(tab):
    seen = """[document.querySelector("[data-stepper] output").textContent,
        [...document.querySelectorAll("[data-stepper] path[data-moves]")].map((each) => each.getAttribute("d")).join(),
        document.querySelector("[data-stepper] td").textContent,
        document.querySelector("[data-stepper] input").getAttribute("aria-valuetext")]"""
    assert not tab.run("document.querySelector('.steps').hidden")
    last = tab.run(seen)
    assert last[0] == last[3] == "load, M = 0.67 N·m"
    tab.run("document.querySelector('[data-stepper] input').focus()")
    tab.press("ArrowLeft")
    before = tab.run(seen)
    assert before[0] == before[3] == "load, M = 0.603 N·m"
    assert all(one != other for one, other in zip(last, before, strict=True))
    tab.run("document.querySelector('[data-stepper] button[data-by=\"1\"]').click()")
    assert tab.run(seen) == last


def test_a_long_name_at_the_right_edge_stands_within_the_picture(tab, page):
    """The names are the names of the hinge's points, made longer."""
    tab.run("""document.querySelectorAll("[data-stands]").forEach((name) => name.textContent += " upper right eye")""")
    tab.run("document.querySelector('[data-stepper] input').dispatchEvent(new Event('input'))")
    beyond = """[...document.querySelectorAll("[data-stands]")].map((name) => {
        const [text, all] = [name, name.ownerSVGElement].map((each) => each.getBoundingClientRect());
        return Math.max(text.right - all.right, all.left - text.left); })"""
    assert max(tab.run(beyond)) <= 0.0
    tab.open(page)


def test_a_table_is_sorted_by_its_headings_with_the_keyboard(tab):
    first = "[...document.querySelectorAll('article table')].find((each) => each.textContent.includes('round-off'))"
    column = f"[...{first}.tBodies[0].rows].map((row) => row.cells[1].textContent)"
    head = f"{first}.tHead.rows[0].cells[1]"
    as_written = tab.run(column)
    tab.run(f"{head}.querySelector('button').focus()")
    orders = {}
    for sort in ("ascending", "descending"):
        tab.press("Enter")
        assert tab.run(f"{head}.getAttribute('aria-sort')") == sort
        orders[sort] = [float(text.removesuffix(" %")) for text in tab.run(column) if text != "–"]
    assert sorted(as_written) == sorted(tab.run(column))
    assert len(set(orders["ascending"])) > 3
    assert orders["ascending"] == sorted(orders["ascending"])
    assert orders["descending"] == sorted(orders["ascending"], reverse=True)
    assert tab.run("document.activeElement.tagName") == "BUTTON"


def test_nothing_is_wider_than_the_window_and_text_of_figures_is_legible(tab):
    beyond = """[...document.querySelectorAll("body *")]
        .filter((each) => !each.closest(".scroll, .contents, pre, .skip"))
        .filter((each) => each.getBoundingClientRect().right > innerWidth + 1)
        .map((each) => each.outerHTML.slice(0, 90))"""
    scales = """[...document.querySelectorAll("figure img")]
        .map((each) => each.getBoundingClientRect().width / each.naturalWidth)"""
    for width in WIDTHS:
        tab.seen(width, phone=width < 500)
        assert tab.run("innerWidth") == width
        assert tab.run("document.documentElement.scrollWidth") <= width
        assert tab.run(beyond) == []
        # 11 points are 14.7 pixels; 9 pixels are the least legible size
        assert min(tab.run(scales)) * 14.7 > 9.0


def test_words_are_legible_in_the_light_and_in_the_dark(tab):
    contrast = """(() => {
        const light = (text) => {
          const parts = text.match(/[\\d.]+/g).slice(0, 3).map((each) => each / 255);
          const linear = parts.map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
          return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        };
        const page = light(getComputedStyle(document.body).backgroundColor);
        const found = {};
        const words = "p, td, th, a, h1, h2, h3, figcaption, caption, output, button, dt";
        for (const each of document.querySelectorAll(words)) {
          const [a, b] = [light(getComputedStyle(each).color), page].sort((x, y) => y - x);
          found[each.tagName + "." + each.className] = (a + 0.05) / (b + 0.05);
        }
        return [page, Object.entries(found).filter(([, ratio]) => ratio < 4.5)];
      })()"""
    for dark in (False, True):
        tab.seen(WIDTHS[0], dark=dark)
        page, faint = tab.run(contrast)
        assert (page < 0.1) == dark
        assert faint == []  # WCAG 2, 1.4.3: 4.5 to 1


def test_it_prints_on_a4_and_nothing_is_cut(tab):
    tab.seen(WIDTHS[0])
    printed = tab.pdf()
    assert printed.startswith(b"%PDF")
    boxes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", printed)
    assert len(boxes) > 3
    width, height = 210.0 / 25.4 * 72.0, 297.0 / 25.4 * 72.0
    assert all((float(w), float(h)) == pytest.approx((width, height), abs=1.0) for w, h in boxes)
    tab.call("Emulation.setEmulatedMedia", media="print")
    inside = round((210.0 - 28.0) / 25.4 * 96.0)
    tab.call("Emulation.setDeviceMetricsOverride", width=inside, height=1000, deviceScaleFactor=1, mobile=False)
    wide = """[...document.querySelectorAll("table, figure")]
        .map((each) => [each.textContent.trim().slice(0, 70), each.getBoundingClientRect().right - innerWidth])
        .filter(([, beyond]) => beyond > 1)"""
    assert tab.run(wide) == []
    tab.call("Emulation.setEmulatedMedia", media="")


def test_without_a_script_the_last_station_is_shown_and_the_tables_are_whole(tab, page):
    tab.call("Emulation.setScriptExecutionDisabled", value=True)
    tab.open(page)
    tab.call("Emulation.setScriptExecutionDisabled", value=False)
    assert tab.run("document.querySelector('[data-stepper] output').textContent") == "load, M = 0.67 N·m"
    assert tab.run("document.querySelector('.steps').hidden")
    assert tab.run("[...document.querySelectorAll('tbody')].every((each) => each.rows.length > 0)")
    assert tab.run("document.querySelectorAll('th button').length") == 0
    assert tab.said == []
