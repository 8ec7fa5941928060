"""The pages: whole, the same bytes every time, without a network, and made of kept parts."""

import json
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from html.parser import HTMLParser
from itertools import count, pairwise

import numpy as np
import pytest

from comparisons import cases
from comparisons.answer_file import read_answers
from comparisons.case import Comparison, Verdict, compare
from comparisons.choices import Choices
from comparisons.cli.main import run
from comparisons.pairing import Solvers, cprbm_answer, fea_answer, paired
from comparisons.present import page, stepper
from comparisons.present.columns import Section
from comparisons.studies import report
from comparisons.verdict import Word
from comparisons.verdict.runs import Runs
from comparisons.writing import write
from cprbm_scene import Mistake, SceneError
from tests.comparisons.killed import QUESTION
from tests.verdict.made_up import MadeUp

SHORT = ("--without", "times", "--without", "convergence")
VOID = {"wbr", "meta", "link", "br", "input", "img"}


class Page(HTMLParser):
    """All elements of a page with their attributes, in order, and those that are in a figure."""

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
    """A solver that counts how often it is asked, and is stopped at a certain time."""

    solver: MadeUp
    asked: count = field(repr=False)  # the key of a kept answer contains the solver
    stopped_at: int = field(repr=False)

    def __call__(self, scene, choices):
        if next(self.asked) == self.stopped_at:
            raise KeyboardInterrupt
        return self.solver(scene, choices)


def counting(stopped_at=-1):
    """Both solvers, and how often they have been asked so far."""
    asked = count()
    both = (Counting(made, asked, stopped_at) for made in (MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4)))
    return Solvers(*both), lambda: asked.__reduce__()[1][0]


def reported(out, solvers, *arguments, asked=("hinge",)):
    """A report with a short family of sizes, its exit code and its page."""
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
    """Reports without figures, which take longest of all that is no solve."""
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


def test_the_page_is_well_formed_and_every_part_has_a_name(written):
    parsed = Page(written[1])
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
    captions = re.findall(r"<caption><span>([^<]*)</span>", written[1])
    assert len(captions) == len(set(captions)) == count["caption"] == count["table"] > 10
    assert all(attributes.get("scope") in {"col", "row"} for tag, attributes, _ in parsed.within if tag == "th")


def test_the_page_asks_nothing_of_a_network(written):
    out, page, _ = written
    for tag, attributes in Page(page).elements:
        for key in ("src", "href", "srcset", "data", "action"):
            link = attributes.get(key, "#")
            assert link.startswith(("#", "data:")) or (tag == "a" and (out / link).is_file()), (tag, link)
    assert not re.search(r"@import|url\((?!#|%23)|https?://(?!www\.w3\.org)", page)


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
def test_other_choices_are_another_report(tmp_path, files):
    for place, arguments in enumerate((("-n", "40"), ("-n", "40"), ("-n", "30"))):
        solvers, asked = counting()
        code, page = reported(tmp_path / "out", solvers, *SHORT, *arguments, asked=files[:1])
        assert code == 0
        assert (asked() == 0) == (place == 1)
        assert b"Error against N" not in page
        assert b"Seconds" in page


@pytest.mark.usefixtures("undrawn")
def test_a_run_that_was_ended_goes_on_with_what_was_not_there(tmp_path, files):
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
def test_what_a_solver_refuses_beside_the_comparison_is_told(tmp_path, files):
    @dataclass(frozen=True)
    class Coarse:
        """Refuses fewer than 15 links."""

        solver: MadeUp

        def __call__(self, scene, choices):
            if choices.links < 15:
                raise SceneError([Mistake("settings.links", str(choices.links), "at least 15")])
            return self.solver(scene, choices)

    solvers = Solvers(Coarse(MadeUp("cprbm", 2e-3)), MadeUp("fea", -5e-4))
    code, page = reported(tmp_path / "out", solvers, "--without", "times", asked=files[:1])
    assert code == 0
    assert "A solver refuses the question: settings.links: found 10; allowed: at least 15." in page.decode()


@pytest.mark.usefixtures("undrawn")
def test_names_from_a_scene_are_only_text(tmp_path):
    file, sly = tmp_path / "sly.toml", "</script><script>alert(1)</script>"
    file.write_text(f"# {sly}\ntitle = '{sly}'\n" + QUESTION.format(name="sly", length=0.113), "utf-8")
    code, page = reported(tmp_path / "out", counting()[0], *SHORT, asked=(str(file),))
    assert code == 0
    assert b"<script>alert" not in page
    assert b"&lt;script&gt;alert" in page


@pytest.fixture(scope="module")
def solved():
    """The hinge, solved at 13 links and 12 elements."""
    hinge = cases.opened("hinge")
    choices = Choices(links=13, elements=12, kinematics="bending")
    answers = cprbm_answer(hinge, choices), fea_answer(hinge, choices)
    runs = Runs(hinge, "bending", dict(zip(("cprbm", "fea"), answers, strict=True)))
    return Comparison(runs, (), Verdict(Word.UNDECIDED, (), completed=False))


def places(shown):
    """Places of the names at a station, in the picture."""
    return [np.array(list(map(float, place.split()))) for place in shown[2]]


def test_points_stand_where_the_answer_says_that_they_went(solved):
    steps = stepper.stepper(solved)
    at_rest = solved.scene.bodies["BD"].points
    assert steps["points"] == ("A", "C", "B", "D")
    fixed = np.array(solved.scene.bodies["AC"].points["A"])
    other = np.array(solved.scene.bodies["AC"].points["C"])
    for shown, answer in zip(steps["stations"], solved.runs.answers["fea"].stations, strict=True):
        A, C, B, D = places(shown)
        scale = np.hypot(*(A - C)) / np.hypot(*(fixed - other))
        for place, name in ((B, "B"), (D, "D")):
            moved = np.array(at_rest[name]) + answer.values[f"{name}.displacement"]
            expected = A + scale * (moved - fixed) * (1.0, -1.0)
            assert place == pytest.approx(expected, abs=1.6)  # places are whole numbers of a thousandth


def test_contact_is_drawn_where_it_is_closed(solved):
    steps = stepper.stepper(solved)
    zone, push = (steps["moving"].index(kind) for kind in ("zone", "push"))
    largest = max(answer.values["contact.force"][0] for answer in solved.runs.answers["fea"].stations)
    for (_, paths, *_), answer in zip(steps["stations"], solved.runs.answers["fea"].stations, strict=True):
        force = answer.values["contact.force"][0]
        assert bool(paths[zone]) == (force > 0.0)
        assert bool(paths[push]) == (force > 0.02 * largest)
    assert [bool(paths[zone]) for _, paths, *_ in steps["stations"]].count(True) == 6


def test_beams_have_their_thickness_and_the_colours_of_their_stress(solved):
    steps = stepper.stepper(solved)
    A, C, *_ = places(steps["stations"][-1])
    scale = np.hypot(*(A - C)) / 0.0525
    _, paths, *_ = steps["stations"][-1]
    areas = [areas_of(paths[steps["moving"].index(f"shade{shade}")]) for shade in range(stepper.SHADES)]
    # area of both beams: half circles of 25 mm radius, 2 mm thick
    assert sum(sum(each) for each in areas) == pytest.approx(2 * np.pi * 25e-3 * 2e-3 * scale**2, rel=0.02)
    _, first, *_ = steps["stations"][0]
    assert not first[steps["moving"].index(f"shade{stepper.SHADES - 1}")]  # the largest stress is at the last station
    assert paths[steps["moving"].index(f"shade{stepper.SHADES - 1}")]


def areas_of(path):
    """Areas of the closed polygons of a path, by the shoelace formula."""
    found = []
    for part in path.split("Z")[:-1]:
        x, y = points_of(part).T
        found.append(0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))))
    return found


def points_of(path):
    """The points of a path of straight lines."""
    return np.array([[float(x) for x in pair.split(",")] for pair in re.findall(r"-?[\d.]+,-?[\d.]+", path)])


def test_a_line_with_fewer_points_is_the_same_line():
    t = np.linspace(0.0, 3.0, 700)
    whole = np.stack([310.0 * t, 200.0 + 170.0 * np.sin(3.7 * t**1.3)], axis=1)
    kept = points_of(stepper.line(whole))
    assert len(kept) < 150
    assert np.max(np.abs(whole[:, 1] - np.interp(whole[:, 0], kept[:, 0], kept[:, 1]))) < 1.0  # steep: 0.3 across
    assert kept[[0, -1]] == pytest.approx(whole[[0, -1]], abs=0.06)


@pytest.fixture(scope="module")
def comparison():
    return compare(paired(cases.opened("hinge"), Choices(), counting()[0]))


@pytest.fixture(scope="module")
def drawn(comparison):
    """All figures of the comparison, drawn once for the tests below."""
    return page.figures_of(comparison)


@pytest.fixture(scope="module")
def put(comparison, drawn, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "new" / "folder"
    page.put_case(folder, comparison)
    page.put_page(folder, page.report_page([page.case_chapter(comparison, drawn)]))
    return folder


@pytest.mark.usefixtures("printed")
def test_the_folder_of_compare_holds_everything_and_figures_carry_no_date(put, drawn):
    found = {str(path.relative_to(put)) for path in put.rglob("*") if path.is_file()}
    names = ("shapes", "stress", "path-M", "contact-forces")
    figures = {f"hinge/{name}.{kind}" for name in names for kind in ("svg", "png")}
    numbers = {f"hinge/{name}" for name in ("comparison.json", "answers.json.gz", "contact-forces.csv")}
    assert found == {"index.html"} | numbers | figures
    data = json.loads((put / "hinge" / "comparison.json").read_text("utf-8"))
    assert data["cases"][0]["case"] == "hinge"
    answers = read_answers(put / "hinge" / "answers.json.gz")
    assert len(answers) == 8
    assert {"cprbm paper", "cprbm shear"} <= answers.keys()
    for figure in drawn:
        assert (put / "hinge" / f"{figure.name}.svg").read_bytes() == figure.svg
        assert (put / "hinge" / f"{figure.name}.png").read_bytes() == figure.png
        assert b"<dc:date>" not in figure.svg
        assert figure.png.startswith(b"\x89PNG")


def test_the_page_of_compare_shows_verdict_claims_and_certificates(put):
    text = (put / "index.html").read_text("utf-8")
    for part in (
        '<span class="badge AGREE"><span aria-hidden="true">✓</span> AGREE</span>',
        "0.62\u00a0%",
        "0.81\u00a0%",
        "t/(3R)",
        "Certificates",
        "Both theories",
        "The formulation paper beside auto",
    ):
        assert part in text.replace(" %", "\u00a0%"), part


@pytest.mark.usefixtures("printed")
def test_a_case_that_did_not_complete_has_a_chapter_too(right):
    early = Solvers(MadeUp("cprbm", 0.0, until=2), right.fea)
    found = compare(paired(cases.opened("hinge"), Choices(), early))
    chapter = page.case_chapter(found, page.figures_of(found))
    assert chapter.word == "UNDECIDED"
    assert any(section.figures for section in chapter.sections)  # of the two stations that both solvers reached
    assert "UNDECIDED" in page.html(page.report_page([chapter]))


def test_a_percentage_stays_on_the_line_of_its_number(comparison, drawn):
    """The texts that fold: paragraphs, captions of tables and figures, and long cells."""
    text = page.html(page.report_page([page.case_chapter(comparison, drawn)]))
    folding = re.findall(
        r'<(?:p|caption|figcaption|td class="[^"]*long)\b[^>]*>.*?</(?:p|caption|figcaption|td)>', text, re.DOTALL
    )
    assert sum("\u00a0%" in part for part in folding) > 3
    assert not [part for part in folding if re.search(r"\d %", part)]


def test_a_page_has_all_chapters_or_the_section_of_a_study_alone(comparison):
    renamed = comparison.scene.model_copy(update={"name": "other"})
    other = replace(comparison, runs=replace(comparison.runs, scene=renamed))
    text = page.html(page.report_page([page.case_chapter(each, ()) for each in (comparison, other)]))
    assert '<article id="hinge"' in text
    assert '<article id="other"' in text
    text = page.html(page.Page("Study", "", further=[Section("Heading", ("A sentence.",), name="study")]))
    assert "<h2>Heading</h2>" in text
    assert 'href="study.json"' in text
    assert "Verdicts at a glance" not in text


def test_a_file_that_cannot_be_finished_leaves_the_old_one(tmp_path):
    file = tmp_path / "data.json"
    write(file, "old")
    with pytest.raises(UnicodeEncodeError):
        write(file, "new \udc80")
    assert file.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [file]


def test_a_link_leads_no_file_out_of_the_folder(comparison, tmp_path):
    elsewhere, folder = tmp_path / "elsewhere", tmp_path / "out"
    for each in (elsewhere, folder):
        each.mkdir()
    (folder / "hinge").symlink_to(elsewhere)
    with pytest.raises(OSError, match="outside the report's folder"):
        page.put_case(folder, comparison)
    assert list(elsewhere.iterdir()) == []
    (folder / "index.html").symlink_to(elsewhere / "index.html")
    page.put_page(folder, page.report_page([]))
    assert list(elsewhere.iterdir()) == []
