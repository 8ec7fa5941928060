"""The archive of sources, made from a copy of a checkout, and the wheel, made from what that archive holds.

Neither is made in the checkout itself, where setuptools leaves folders behind from which a later wheel takes modules
that are there no more.  Nothing comes from the network: setuptools is the one that runs this.
"""

import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
ROOMS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
FILES = (
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "LICENSE",
    "MANIFEST.in",
    "Makefile",
    "README.md",
    "pyproject.toml",
    "requirements.lock",
)
FOLDERS = (*ROOMS, "benchmarks", "docs", "tests")
_LEFT_BY_RUNS = shutil.ignore_patterns("__pycache__", "*.pyc", "_build")


def copied(folder: Path) -> Path:
    """What of the checkout is anyone's, copied below ``folder``."""
    copy = folder / "checkout"
    copy.mkdir(parents=True)
    for name in FILES:
        shutil.copy(ROOT / name, copy)
    for name in FOLDERS:
        shutil.copytree(ROOT / name, copy / name, ignore=_LEFT_BY_RUNS)
    return copy


def sources(checkout: Path, into: Path) -> Path:
    """The archive of sources of a checkout."""
    return _made("build_sdist", checkout, into)


def wheel(archive: Path, into: Path) -> Path:
    """The wheel of an archive of sources."""
    with tarfile.open(archive) as opened:
        # the archive is our own; the first releases of 3.11 know no filter, and later ones ask for one
        if hasattr(tarfile, "data_filter"):
            opened.extraction_filter = tarfile.data_filter
        opened.extractall(into / "unpacked")
    (tree,) = (into / "unpacked").iterdir()
    return _made("build_wheel", tree, into)


def _made(hook: str, tree: Path, into: Path) -> Path:
    program = f"import sys\nfrom setuptools import build_meta\nprint(build_meta.{hook}(sys.argv[1]))"
    into.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning", "-c", program, str(into.resolve())],
        cwd=tree,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        raise RuntimeError(done.stderr)
    return into / done.stdout.splitlines()[-1]


def main(into: Path) -> None:
    """Both, put into a folder; ``make wheel``."""
    into.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        archive = sources(copied(folder), folder / "sdist")
        for path in (archive, wheel(archive, folder / "wheel")):
            sys.stdout.write(f"{shutil.copy(path, into)}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
