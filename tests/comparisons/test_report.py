"""The command ``report``: parts, kept answers and interruptions; its page, parsed and in a real browser."""

import json
import re
from collections import Counter
from dataclasses import dataclass, field
from html.parser import HTMLParser
from itertools import count, pairwise

import pytest

from comparisons.cli.main import run
from comparisons.pairing import Solvers
from comparisons.present import page
from comparisons.studies import report
from cprbm_scene import Mistake, SceneError
from tests.comparisons.browser import WANTED, browser, found
from tests.comparisons.killed import QUESTION
from tests.verdict.made_up import MadeUp

SHORT = ("--without", "times", "--without", "convergence")
VOID = {"wbr", "meta", "link", "br", "input", "img"}


class Page(HTMLParser):
    """All elements of a page with attributes, in order, and the open elements around."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.within, self.open = [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self.within.append((tag, dict(attrs), tuple(self.open)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        self.within.append((tag, dict(attrs), tuple(self.open)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, (tag, self.getpos())


@dataclass(frozen=True)
class Counting:
    """A solver with a count of questions, interrupted at a given count."""

    solver: MadeUp
    asked: count = field(repr=False)  # the key of a kept answer contains the solver
    stopped_at: int = field(repr=False)

    def __call__(self, scene, choices):
        if next(self.asked) == self.stopped_at:
            raise KeyboardInterrupt
        return self.solver(scene, choices)


def counting(stopped_at=-1):
    """Both solvers, and a function for the number of questions so far."""
    asked = count()
    both = (Counting(made, asked, stopped_at) for made in (MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)))
    return Solvers(*both), lambda: asked.__reduce__()[1][0]


def reported(out, solvers, *arguments, asked=("hinge",)):
    """Exit code and page of a report with a short family of sizes."""
    code = run(["report", *asked, "--sizes", "10,20,40", "--out", str(out), "--quiet", *arguments], solvers)
    return code, (out / "index.html").read_bytes() if (out / "index.html").exists() else b""


@pytest.fixture
def files(tmp_path):
    """Two questions with a single beam, so that the figures take little time."""
    found = []
    for name, length in (("one", 0.113), ("two", 0.127)):
        found.append(tmp_path / f"{name}.toml")
        found[-1].write_text(QUESTION.format(name=name, length=length), "utf-8")
    return tuple(map(str, found))


@pytest.fixture
def undrawn(monkeypatch):
    """Reports without figures: figures take the most time after the solves."""
    monkeypatch.setattr(page, "figures_of", lambda found: ())


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A folder with all parts of one case."""
    out = tmp_path_factory.mktemp("reporting") / "of" / "hinge"
    file = out.parent.parent / "numbers.json"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(report, "SIZES", (20, 40))
        code, page = reported(out, counting()[0], "--json", str(file))
    assert code == 0
    return out, page.decode(), json.loads(file.read_text("utf-8"))


def test_all_parts_stand_in_the_folder_and_on_the_page(written):
    out, page, data = written
    for name in ("comparison.json", "answers.json.gz", "convergence.json", "bench.json", "scene.toml", "shapes.svg"):
        assert (out / "hinge" / name).is_file(), name
        assert name.endswith(".svg") or f'href="hinge/{name}"' in page
    figures = list((out / "hinge").glob("*.svg"))
    assert len(figures) > 4
    assert not [figure.name for figure in figures if "<dc:date>" in figure.read_text("utf-8")]
    assert (out / "hinge" / "scene.toml").read_text("utf-8").startswith("# The rotational hinge")
    for heading in ("Verdicts at a glance", "The sources’ figures and ours", "Curves",
                    "Errors in displacement, stress and force", "Stress along the beams",
                    "Error against N, and the error budget", "Run time against error",
                    "Certificates and audit", "Machine and versions"):  # fmt: skip
        assert heading in page, heading
    (case,) = data["cases"]
    assert case["verdict"] == "AGREE"
    assert case["convergence"]["families"]
    assert case["bench"]["rows"]
    assert data["machine"]["python"]


def test_the_page_is_well_formed_every_part_has_a_name_and_nothing_is_asked_of_a_network(written):
    out, text, _ = written
    parsed = Page(text)
    names = [attributes["id"] for _, attributes in parsed.elements if "id" in attributes]
    wanted = {link[1:] for _, attributes in parsed.elements if (link := attributes.get("href") or "").startswith("#")}
    assert len(names) == len(set(names))
    assert len(wanted) > 3
    assert wanted <= set(names)
    count = Counter(tag for tag, _, _ in parsed.within)
    levels = [int(tag[1]) for tag, _, _ in parsed.within if re.fullmatch("h[1-6]", tag)]
    assert levels[0] == 1
    assert all(after - before <= 1 for before, after in pairwise(levels))
    drawn = [attributes for tag, attributes, around in parsed.within if tag in {"svg", "img"} and "figure" in around]
    assert count["figure"] == len(drawn) == count["figcaption"] > 5
    assert all(each.get("alt") or (each["role"] == "img" and len(each["aria-label"]) > 15) for each in drawn)
    captions = re.findall(r"<caption><span>([^<]*)</span>", text)
    assert len(captions) == len(set(captions)) == count["caption"] == count["table"] > 10
    assert all(attributes.get("scope") in {"col", "row"} for tag, attributes, _ in parsed.within if tag == "th")
    for tag, attributes in parsed.elements:
        for key in ("src", "href", "srcset", "data", "action"):
            link = attributes.get(key, "#")
            assert link.startswith(("#", "data:")) or (tag == "a" and (out / link).is_file()), (tag, link)
    assert not re.search(r"@import|url\((?!#|%23)|https?://(?!www\.w3\.org)", text)


@pytest.mark.usefixtures("printed")
def test_other_runs_write_the_same_bytes(tmp_path, files):
    pages = [reported(tmp_path / name, counting()[0], "--without", "times", asked=files[:1])[1] for name in "ab"]
    assert pages[0].count(b"<figure") > 3
    assert pages[0] == pages[1]


@pytest.mark.usefixtures("printed")
def test_what_is_there_is_not_solved_again_and_keeps_its_run_times(written):
    out, page, data = written
    solvers, asked = counting()
    file = out.parent.parent / "again.json"
    code, again = reported(out, solvers, "--json", str(file))
    assert (code, again.decode()) == (0, page)
    assert asked() == 0
    assert json.loads(file.read_text("utf-8")) == data


@pytest.mark.usefixtures("undrawn")
def test_run_times_are_of_solves_and_not_of_what_was_kept(tmp_path, files, monkeypatch):
    monkeypatch.setattr(report, "SIZES", (20, 40))
    asked = []
    for name, left_out in (("with", SHORT[2:]), ("without", SHORT)):
        solvers, so_far = counting()
        assert reported(tmp_path / name, solvers, *left_out, asked=files[:1])[0] == 0
        asked.append(so_far())
    # three methods at two sizes three times, twice in a row, and once before anything counts; three answers for the
    # reference
    assert asked[0] - asked[1] == 3 * (3 * 2 * 2 + 1) + 3


@pytest.mark.usefixtures("undrawn")
def test_a_stopped_run_goes_on_with_the_missing_answers_and_other_choices_are_another_report(tmp_path, files):
    whole, of_both = counting()
    assert reported(tmp_path / "whole", whole, *SHORT, asked=files)[0] == 0
    stopped, before = counting(stopped_at=of_both() - 2)
    code, page = reported(tmp_path / "ended", stopped, *SHORT, asked=files)
    assert code == 130
    assert b'id="one"' in page
    assert b'id="two"' not in page
    again, after = counting()
    code, page = reported(tmp_path / "ended", again, *SHORT, asked=files)
    assert code == 0
    assert (before() - 1, after()) == (of_both() - 2, 2)  # the last question before the end is asked again
    assert page == (tmp_path / "whole" / "index.html").read_bytes()
    assert not (tmp_path / "ended" / ".unfinished").exists()
    for links, kept in (("40", False), ("40", True), ("30", False)):
        solvers, asked = counting()
        code, page = reported(tmp_path / "out", solvers, *SHORT, "-n", links, asked=files[:1])
        assert code == 0
        assert (asked() == 0) is kept
        assert b"Error against N" not in page
        assert b"Seconds" in page


@pytest.mark.parametrize(
    ("fea", "word"),
    [(MadeUp("fea", -5e-4, stiffness=1.05), "DIFFER"), (MadeUp("fea", -5e-4, until=1), "UNDECIDED")],
)
@pytest.mark.usefixtures("undrawn")
def test_a_report_is_written_whatever_its_verdict(tmp_path, files, fea, word):
    code, page = reported(tmp_path / "out", Solvers(MadeUp("cprbm", 2e-3), fea), *SHORT, asked=files[:1])
    assert code == 0
    text = page.decode()
    assert text.count(f'class="badge {word}"') == 3  # of all, in the table, at the chapter
    assert f"load, F = {'0.7 N' if word == 'UNDECIDED' else '1.3 N'}" in text  # the last that both have reached


@pytest.mark.usefixtures("undrawn")
def test_a_refusal_beside_the_comparison_is_told_and_names_from_a_scene_are_only_text(tmp_path):
    @dataclass(frozen=True)
    class Coarse:
        """Refuses fewer than 15 links."""

        solver: MadeUp

        def __call__(self, scene, choices):
            if choices.links < 15:
                raise SceneError([Mistake("settings.links", str(choices.links), "at least 15")])
            return self.solver(scene, choices)

    file, sly = tmp_path / "sly.toml", "</script><script>alert(1)</script>"
    file.write_text(f"# {sly}\ntitle = '{sly}'\n" + QUESTION.format(name="sly", length=0.113), "utf-8")
    solvers = Solvers(Coarse(MadeUp("cprbm", 2e-3)), MadeUp("fea", -5e-4))
    code, page = reported(tmp_path / "out", solvers, "--without", "times", asked=(str(file),))
    assert code == 0
    assert "A solver refuses the question: settings.links: found 10; allowed: at least 15." in page.decode()
    assert b"<script>alert" not in page
    assert b"&lt;script&gt;alert" in page


# -- In a browser: without a complaint, on every width, by mouse and by keyboard, and on paper

WIDTHS = (1280, 1024, 900, 768, 390)


@pytest.fixture(scope="module")
def tab(written):
    """The page, open in a tab."""
    program = found()
    if program is None:
        pytest.skip(WANTED)
    with browser(program) as opened:
        opened.seen(WIDTHS[0])
        opened.open(written[0] / "index.html")
        yield opened


def test_the_slider_moves_the_mechanism_and_its_values_without_a_complaint_of_the_browser(tab, written):
    assert tab.run("document.querySelectorAll('article').length") == 1
    assert tab.said == []  # nothing on the console, and nothing asked of a network
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
    # a long name at the right edge stands within the picture: the names of the hinge's points, made longer
    tab.run("""document.querySelectorAll("[data-stands]").forEach((name) => name.textContent += " upper right eye")""")
    tab.run("document.querySelector('[data-stepper] input').dispatchEvent(new Event('input'))")
    beyond = """[...document.querySelectorAll("[data-stands]")].map((name) => {
        const [text, all] = [name, name.ownerSVGElement].map((each) => each.getBoundingClientRect());
        return Math.max(text.right - all.right, all.left - text.left); })"""
    assert max(tab.run(beyond)) <= 0.0
    tab.open(written[0] / "index.html")


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


def test_nothing_is_wider_than_the_window_and_texts_are_legible_in_the_light_and_in_the_dark(tab):
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
        background, faint = tab.run(contrast)
        assert (background < 0.1) == dark
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


def test_without_a_script_the_last_station_is_shown_and_the_tables_are_whole(tab, written):
    tab.call("Emulation.setScriptExecutionDisabled", value=True)
    tab.open(written[0] / "index.html")
    tab.call("Emulation.setScriptExecutionDisabled", value=False)
    assert tab.run("document.querySelector('[data-stepper] output').textContent") == "load, M = 0.67 N·m"
    assert tab.run("document.querySelector('.steps').hidden")
    assert tab.run("[...document.querySelectorAll('tbody')].every((each) => each.rows.length > 0)")
    assert tab.run("document.querySelectorAll('th button').length") == 0
    assert tab.said == []
