"""The machine and the libraries that a time was measured with; without them it says nothing."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

_PROCESSORS = Path("/proc/cpuinfo")
_LIBRARIES = ("numpy", "scipy", "scikit-fem")
_OPTIONAL = ("casadi",)


def described() -> dict[str, str | int]:
    """Processor, number of cores, system, and the versions of Python and of the libraries that compute."""
    return {
        "cpu": _processor(),
        "cores": os.cpu_count() or 1,
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: version(name) for name in _LIBRARIES},
        **{name: version(name) for name in _OPTIONAL if find_spec(name) is not None},
    }


def made_on() -> dict[str, str | int]:
    """The same with this program itself and what draws its figures, for a page that says what has made it."""
    try:
        own = version("cprbm")
    except PackageNotFoundError:
        own = "from its sources"
    return {"cprbm": own, **described(), "matplotlib": version("matplotlib")}


def _processor() -> str:
    """The processor's name as the system tells it."""
    if _PROCESSORS.is_file():
        for line in _PROCESSORS.read_text(encoding="utf-8", errors="replace").splitlines():
            key, _, value = line.partition(":")
            if key.strip() == "model name":
                return value.strip()
    return platform.processor() or "unknown"
