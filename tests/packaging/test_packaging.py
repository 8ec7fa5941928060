"""The archive of sources and the wheel are whole: held against the checkout's files and its description."""

import subprocess
import tarfile
import tomllib
import zipfile
from email import message_from_string

import pytest

from tests.packaging.made import FILES, FOLDERS, ROOMS, ROOT, copied, sources, wheel

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CORE = {"numpy", "scipy", "numba", "scikit-fem", "shapely", "pydantic", "click", "rich", "matplotlib", "jinja2"}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The copy of the checkout, the archive's names below its one folder, and the wheel."""
    folder = tmp_path_factory.mktemp("packaging")
    checkout = copied(folder)
    before = _files(checkout)
    archive = sources(checkout, folder / "sdist")
    with tarfile.open(archive) as opened:
        names = {name.partition("/")[2] for name in opened.getnames() if opened.getmember(name).isfile()}
    return before, names, wheel(archive, folder / "wheel")


@pytest.fixture(scope="module")
def opened(made):
    with zipfile.ZipFile(made[2]) as archive:
        yield archive


def _files(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_the_archive_of_sources_holds_what_the_checkout_does(made):
    before, names, _ = made
    assert set(FILES) <= names
    assert {name.partition("/")[0] for name in before} == {*FILES, *FOLDERS}
    assert before - names == set()
    added = {name for name in names - before if not name.startswith("cprbm.egg-info/")}
    assert added == {"PKG-INFO", "setup.cfg"}


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="no checkout of git")
def test_nothing_that_is_kept_in_git_is_left_out(made):
    _, names, _ = made
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True)
    kept = {name for name in listed.stdout.splitlines() if (ROOT / name).exists()}
    assert kept - names <= {".ci/run", ".gitignore"}


def test_the_wheel_holds_every_file_of_every_room_and_nothing_else(made, opened):
    before, _, _ = made
    expected = {name for name in before if name.partition("/")[0] in ROOMS}
    found = {name for name in opened.namelist() if ".dist-info/" not in name}
    assert expected - found == set()
    assert found - expected == set()
    for kind in ("comparisons/cases/hinge.toml", "comparisons/pages/page.html", "comparisons/importing/scene.toml"):
        assert kind in found


def test_every_module_s_folder_is_a_package(opened):
    """A folder without its ``__init__`` would be found in a checkout only."""
    folders = {name.rpartition("/")[0] for name in opened.namelist() if name.endswith(".py")}
    assert {f"{folder}/__init__.py" for folder in folders} <= set(opened.namelist())


def _told(opened, name):
    (path,) = (each for each in opened.namelist() if each.endswith(f".dist-info/{name}"))
    return opened.read(path).decode()


def test_the_metadata_says_what_the_project_does(opened):
    metadata = message_from_string(_told(opened, "METADATA"))
    assert metadata["Name"] == "cprbm"
    assert metadata["Version"] == PROJECT["version"]
    assert metadata["Requires-Python"] == ">=3.11"
    assert metadata["License-Expression"] == "MIT"
    assert metadata["Description-Content-Type"] == "text/markdown"
    assert metadata.get_payload().strip() == (ROOT / "README.md").read_text(encoding="utf-8").strip()
    assert set(metadata.get_all("Provides-Extra")) == set(PROJECT["optional-dependencies"])
    assert {"peers", "solid", "test"} <= set(PROJECT["optional-dependencies"])
    minors = {f"Programming Language :: Python :: 3.{minor}" for minor in (11, 12, 13, 14)}
    assert minors <= set(metadata.get_all("Classifier"))
    assert "permission" in _told(opened, "licenses/LICENSE").lower()


def test_the_core_asks_for_no_more_libraries_than_listed(opened):
    asked = message_from_string(_told(opened, "METADATA")).get_all("Requires-Dist")
    core = {line.split(";")[0].split(">")[0].split("<")[0].strip() for line in asked if "extra ==" not in line}
    assert core <= CORE


def test_the_program_is_the_one_that_heeds_signals(opened):
    assert "cprbm = comparisons.cli.program:main" in _told(opened, "entry_points.txt")
    assert "class" not in _told(opened, "entry_points.txt")


def test_a_type_checker_may_read_each_room(opened):
    assert {f"{room}/py.typed" for room in ROOMS} <= set(opened.namelist())
