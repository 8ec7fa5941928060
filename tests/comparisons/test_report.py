"""The report: whole, repeatable, and readable without a network."""

import json
import re

import pytest

from comparisons import figures, report
from comparisons.choices import Choices
from comparisons.pairing import Solvers, paired
from comparisons.verdict import compared
from comparisons.writing import write
from tests.comparisons.made_up import MadeUp


@pytest.fixture
def comparison(hinge, right):
    return compared(hinge, paired(hinge, Choices(), right))


def test_the_folder_holds_everything(tmp_path, comparison):
    report.add(tmp_path / "new" / "folder", (), comparison)
    found = {
        str(path.relative_to(tmp_path / "new" / "folder")) for path in tmp_path.rglob("*") if path.is_file()
    }
    pictures = {
        f"hinge/{name}.{kind}"
        for name in ("shapes", "stress", "rotation", "force")
        for kind in ("svg", "png")
    }
    assert found == {"index.html", "hinge/comparison.json", "hinge/answers.json"} | pictures
    data = json.loads((tmp_path / "new" / "folder" / "hinge" / "comparison.json").read_text("utf-8"))
    assert data["cases"][0]["case"] == "hinge"
    answers = json.loads((tmp_path / "new" / "folder" / "hinge" / "answers.json").read_text("utf-8"))
    assert len(answers) == 7


def test_figures_are_the_same_bytes_every_time(comparison):
    assert figures.of_comparison(comparison) == figures.of_comparison(comparison)


def test_figures_carry_no_date(comparison):
    for picture in figures.of_comparison(comparison):
        assert b"<dc:date>" not in picture.svg
        assert picture.png.startswith(b"\x89PNG")


def test_the_page_asks_nothing_of_a_network(comparison, tmp_path):
    report.add(tmp_path, (), comparison)
    page = (tmp_path / "index.html").read_text("utf-8")
    links = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert links
    for link in links:
        assert link.startswith(("data:image/svg+xml;base64,", "#")) or (tmp_path / link).is_file()
    assert "<script" not in page


def test_the_page_shows_verdict_claims_and_certificates(comparison, tmp_path):
    report.add(tmp_path, (), comparison)
    page = (tmp_path / "index.html").read_text("utf-8")
    for text in (
        '<td class="AGREE">AGREE</td>',
        "0.620 %",
        "0.810 %",
        "t/(3R)",
        "Certificates",
        "stretch to shear",
    ):
        assert text in page


def test_names_from_a_scene_are_only_text(hinge, right, tmp_path):
    sly = hinge.model_copy(update={"title": "<script>alert(1)</script>"})
    report.add(tmp_path, (), compared(sly, paired(sly, Choices(), right)))
    assert "<script>" not in (tmp_path / "index.html").read_text("utf-8")


def test_a_case_that_did_not_complete_has_a_chapter_too(hinge, right, tmp_path):
    early = Solvers(MadeUp("cprbm", 0.0, until=2), right.fea)
    chapters = report.add(tmp_path, (), compared(hinge, paired(hinge, Choices(), early)))
    assert chapters[0].word == "UNDECIDED"
    assert chapters[0].pictures == ()
    assert "UNDECIDED" in (tmp_path / "index.html").read_text("utf-8")


def test_a_later_case_leaves_the_earlier_on_the_page(comparison, hinge, right, tmp_path):
    other = hinge.model_copy(update={"name": "other"})
    chapters = report.add(tmp_path, (), comparison)
    report.add(tmp_path, chapters, compared(other, paired(other, Choices(), right)))
    page = (tmp_path / "index.html").read_text("utf-8")
    assert '<h2 id="hinge">' in page
    assert '<h2 id="other">' in page


def test_a_file_that_cannot_be_finished_leaves_the_old_one(tmp_path):
    file = tmp_path / "data.json"
    write(file, "old")
    with pytest.raises(UnicodeEncodeError):
        write(file, "new \udc80")
    assert file.read_text("utf-8") == "old"
    assert list(tmp_path.iterdir()) == [file]
