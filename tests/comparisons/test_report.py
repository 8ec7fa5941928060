"""The report: whole, repeatable, and readable without a network."""

import gzip
import json
import re
from dataclasses import replace

import pytest

from comparisons import cases, figures, report
from comparisons.case import compare
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.writing import write
from tests.verdict.made_up import MadeUp


@pytest.fixture(scope="module")
def comparison():
    hinge, solvers = cases.opened("hinge"), Solvers(MadeUp("cprbm", 2e-3), MadeUp("fea", -5e-4))
    return compare(hinge, paired(hinge, Choices(), solvers))


@pytest.fixture(scope="module")
def written(comparison, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "new" / "folder"
    report.put_page(folder, (report.added(folder, comparison),))
    return folder


def test_the_folder_holds_everything(written):
    found = {str(path.relative_to(written)) for path in written.rglob("*") if path.is_file()}
    names = ("shapes", "stress", "rotation", "force")
    pictures = {f"hinge/{name}.{kind}" for name in names for kind in ("svg", "png")}
    assert found == {"index.html", "hinge/comparison.json", "hinge/answers.json.gz"} | pictures
    data = json.loads((written / "hinge" / "comparison.json").read_text("utf-8"))
    assert data["cases"][0]["case"] == "hinge"
    answers = json.loads(gzip.decompress((written / "hinge" / "answers.json.gz").read_bytes()))
    assert len(answers) == 10
    assert "cprbm paper" in answers


def test_figures_are_the_same_bytes_every_time_and_carry_no_date(written, comparison):
    for picture in figures.of_comparison(comparison):
        assert (written / "hinge" / f"{picture.name}.svg").read_bytes() == picture.svg
        assert (written / "hinge" / f"{picture.name}.png").read_bytes() == picture.png
        assert b"<dc:date>" not in picture.svg
        assert picture.png.startswith(b"\x89PNG")


def test_the_page_asks_nothing_of_a_network(written):
    page = (written / "index.html").read_text("utf-8")
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert links
    for link in links:
        assert link.startswith(("data:", "#")) or (written / link).is_file()
    assert "<script" not in page


def test_the_page_shows_verdict_claims_and_certificates(written):
    page = (written / "index.html").read_text("utf-8")
    expected = (
        '<span class="badge AGREE"><span aria-hidden="true">✓</span> AGREE</span>',
        "0.620 %",
        "0.810 %",
        "t/(3R)",
        "Certificates",
        "stretch to shear",
        "contact model",
    )
    for text in expected:
        assert text in page


def test_names_from_a_scene_are_only_text(comparison):
    sly = replace(comparison, scene=comparison.scene.model_copy(update={"title": "<script>alert(1)</script>"}))
    chapter = report.chapter(sly, ())
    assert "<script>" not in report.page((chapter,))
    assert "&lt;script&gt;" in report.page((chapter,))


def test_a_case_that_did_not_complete_has_a_chapter_too(hinge, right, tmp_path):
    early = Solvers(MadeUp("cprbm", 0.0, until=2), right.fea)
    chapters = (report.added(tmp_path, compare(hinge, paired(hinge, Choices(), early))),)
    assert chapters[0].word == "UNDECIDED"
    assert chapters[0].pictures  # of the two stations that both solvers reached
    assert "UNDECIDED" in report.page(chapters)


def test_a_later_case_leaves_the_earlier_on_the_page(comparison):
    other = replace(comparison, scene=comparison.scene.model_copy(update={"name": "other"}))
    page = report.page((report.chapter(comparison, ()), report.chapter(other, ())))
    assert '<h2 id="hinge">' in page
    assert '<h2 id="other">' in page


def test_a_file_that_cannot_be_finished_leaves_the_old_one(tmp_path):
    file = tmp_path / "data.json"
    write(file, "old")
    with pytest.raises(UnicodeEncodeError):
        write(file, "new \udc80")
    assert file.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [file]
