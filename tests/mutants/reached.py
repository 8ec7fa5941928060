"""A plugin of pytest that notes which functions of the rooms a test reaches, and how long it takes.

``pytest -p tests.mutants.reached --reached FILE`` writes, by test, seconds of the processor and ``[file, line]`` of the
``def`` of each function.  What an earlier test of a session has left in a cache is not reached again.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = tuple(f"{ROOT / room}/" for room in ("cprbm", "fea_reference"))


def pytest_addoption(parser):
    parser.addoption("--reached", type=Path, required=True)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    codes = set()

    def called(frame, event, argument):
        if event == "call":
            codes.add(frame.f_code)

    begun = time.process_time()
    sys.setprofile(called)
    try:
        return (yield)
    finally:
        sys.setprofile(None)
        functions = sorted(
            {
                (str(Path(code.co_filename).relative_to(ROOT)), code.co_firstlineno)
                for code in codes
                if code.co_filename.startswith(ROOMS)
            }
        )
        item.config.stash.setdefault(KEY, {})[item.nodeid] = {
            "seconds": round(time.process_time() - begun, 3),
            "functions": functions,
        }


KEY = pytest.StashKey()


def pytest_sessionfinish(session):
    session.config.getoption("--reached").write_text(json.dumps(session.config.stash.get(KEY, {})), "utf-8")
