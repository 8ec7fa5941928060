"""Origin of a number besides its question: sources, libraries, Python and machine."""

import os
import platform
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

_PACKAGES = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons")
_LIBRARIES = ("numpy", "scipy", "scikit-fem")
_OPTIONAL = ("casadi",)
_PROCESSORS = Path("/proc/cpuinfo")


@cache
def program(*further: str) -> str:
    """Digest of Python, of the libraries that compute and of all sources, with the sources of ``further`` packages."""
    libraries = [f"{library} {version(library)}\n".encode() for library in _LIBRARIES]
    sources = [file for package in (*_PACKAGES, *further) for file in Path(str(files(package))).rglob("*.py")]
    contents = sorted(file.name.encode() + b"\0" + file.read_bytes() for file in sources)
    return sha256(b"".join([sys.version.encode(), *libraries, *contents])).hexdigest()


def machine() -> dict[str, str | int]:
    """Processor, number of cores, system, and the versions of Python and of the libraries that compute."""
    return {
        "cpu": _processor(),
        "cores": os.cpu_count() or 1,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in _LIBRARIES},
        **{name: version(name) for name in _OPTIONAL if find_spec(name) is not None},
    }


def version_of(distribution: str) -> str:
    """The installed version of a distribution; empty without an installation."""
    with suppress(PackageNotFoundError):
        return version(distribution)
    return ""


def page_origin() -> dict[str, str | int]:
    """The machine, with the versions of this program and of the library that draws, for a page."""
    return {
        "cprbm": version_of("cprbm") or "from its sources",
        **machine(),
        "matplotlib": version("matplotlib"),
    }


def _processor() -> str:
    """Name of the processor as the system states the name."""
    text = _PROCESSORS.read_text(encoding="utf-8", errors="replace") if _PROCESSORS.is_file() else ""
    pairs = (line.partition(":") for line in text.splitlines())
    return next(
        (value.strip() for key, _, value in pairs if key.strip() == "model name"), platform.processor() or "unknown"
    )
