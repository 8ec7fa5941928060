"""pytest in a fork of this process, which has already imported what is not ours: to begin costs next to nothing.

The modules of the project are imported anew, from the tree in which it runs.
"""

from __future__ import annotations

import importlib
import os
import resource
import sys
import traceback
from pathlib import Path

OURS = ("cprbm_scene", "cprbm", "fea_reference", "elastica_reference", "comparisons", "benchmarks", "tests")
OTHERS = (
    *("numpy", "pytest", "hypothesis", "pydantic", "skfem", "scipy.linalg", "scipy.optimize", "scipy.integrate"),
    *("scipy.sparse.linalg", "scipy.interpolate", "scipy.special"),
)
KNOWN = ("-W", "ignore::pytest.PytestAssertRewriteWarning")  # of plugins that are imported already


def warm() -> None:
    """Import what is not ours."""
    for name in OTHERS:
        importlib.import_module(name)


def forked_pytest(tree: Path, arguments: list[str], seconds: float, report: Path | None = None) -> int:
    """What pytest ends with in ``tree``, or minus the signal by which it ends after ``seconds`` of the processor."""
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        code = 99
        try:
            code = _there(tree, arguments, seconds, report)
        except BaseException:
            traceback.print_exc()  # into the report
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


def _there(tree: Path, arguments: list[str], seconds: float, report: Path | None) -> int:
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 6))
    stream = os.open(report or os.devnull, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(stream, 1)
    os.dup2(stream, 2)
    os.chdir(tree)
    for name in [name for name in sys.modules if name.partition(".")[0] in OURS]:
        del sys.modules[name]
    sys.path = [str(tree), *(path for path in sys.path if path and Path(path) != Path(__file__).parents[2])]
    importlib.invalidate_caches()
    import pytest

    return int(pytest.main(["-q", "-p", "no:cacheprovider", "--tb=no", *KNOWN, *arguments]))
