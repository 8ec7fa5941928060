"""The promises of commit 3c78333 hold, except for declared changes."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.cli import doctor
from comparisons.studies import report

from .declared import broken
from .packages import Packages
from .promises import RECORDED, recorded, text
from .today import today

ROOT = Path(__file__).parents[2]


@pytest.fixture
def brief_reports(monkeypatch):
    """Chapters of convergence and run times with two sizes and a run of each: their keys are the same."""
    monkeypatch.setattr(report, "SIZES", (20, 40))
    monkeypatch.setattr(report, "REPEAT", 1)


@pytest.fixture
def sound_libraries(monkeypatch):
    """``doctor`` imports no library in a process of its own: other tests start these 18 processes."""
    monkeypatch.setattr(doctor, "trouble_with", lambda module: "")


@pytest.mark.usefixtures("unprinted", "brief_reports", "sound_libraries")
def test_every_promise_holds_or_its_change_is_declared(promised, changes):
    assert broken(promised, today(promised, changes), changes) == []


def test_the_recording_is_sorted_with_an_item_a_line():
    assert RECORDED.read_text("utf-8") == text(recorded())


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """The program with the five packages alone in a folder, as after the installation of a wheel."""
    folder = tmp_path_factory.mktemp("installed")
    for package in Packages().all:
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))

    def code(line):
        command = [sys.executable, "-m", "comparisons", *line]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert "Traceback" not in done.stderr
        return done.returncode

    return code


def test_an_installed_package_takes_other_commands(installed):
    assert installed(["list"]) == 0


def test_an_installed_package_refuses_commands_for_checkouts(installed, changes):
    lines = [("no-such-command",), *(change.shown_by for change in changes if change.shown_by)]
    assert {line: installed(line) for line in lines} == dict.fromkeys(lines, 2)
