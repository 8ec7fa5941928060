"""Every script of the gallery runs, prints, draws what the page shows, and stands on the page."""

import runpy
import sys

import pytest

from tests.documentation.pages import DOCS, directives

SCRIPTS = sorted((DOCS / "gallery").glob("*.py"))
PRINTS = {  # numbers behind the figures of the pages, known from other sources
    "solve_a_case": "holds: True",
    "own_mechanism": "AGREE",
    "sweep": "t = 2.0 mm: 0.785 rad,",  # the exact solution in bending: 0.78489 rad
    "numbers_to_csv": "scene,solver,stage,station,branch,probe,component,arc_length,unit,value",
    "energy_and_force": "minimum of the energy",
}
DRAWS = {"sweep", "energy_and_force"}


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_a_script_runs(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.setattr(sys, "argv", [str(path)])
    runpy.run_path(str(path), run_name="__main__")
    assert PRINTS[path.stem] in capsys.readouterr().out
    assert [each.name for each in tmp_path.glob("*.svg")] == ([f"{path.stem}.svg"] if path.stem in DRAWS else [])


def test_every_script_stands_on_the_page():
    shown = [target for target, _ in directives(DOCS / "gallery" / "index.md", "include")]
    assert sorted(shown) == [*(f"/made/gallery/{path.stem}/part.md" for path in SCRIPTS), "/made/gallery/thumbnails.md"]
