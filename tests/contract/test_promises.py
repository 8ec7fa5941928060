"""What commit 3c78333 promised to users still holds, but for the changes that are declared."""

import shutil
import subprocess
import sys
from pathlib import Path

from .declared import broken
from .packages import Packages
from .promises import RECORDED, recorded, text

ROOT = Path(__file__).parents[2]


def test_every_promise_holds_or_its_change_is_declared(promised, now, changes):
    assert broken(promised, now, changes) == []


def test_the_recording_is_sorted_with_an_item_a_line():
    assert RECORDED.read_text("utf-8") == text(recorded())


def test_what_only_a_checkout_takes_is_refused_by_an_installed_package(changes, tmp_path):
    """The five packages stand alone in a folder, as a wheel installs them."""
    lines = [change.shown_by for change in changes if change.shown_by]
    for package in Packages().all if lines else ():
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    for line in lines:
        command = [sys.executable, "-m", "comparisons", *line]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert (line, done.returncode) == (line, 2), done.stderr
        assert "Traceback" not in done.stderr
