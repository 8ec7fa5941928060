"""A plugin of pytest that notes which lines of the rooms each quick test reaches, and how long it takes.

``pytest -p tests.mutants.reached --reached FILE`` writes, by test that passed, seconds of the processor and by file of
the rooms the lines that ran.  A test is broken off after ``AT_MOST`` seconds, and after ``TOGETHER`` of one session
no other is begun: what is left out is not among a mutant's tests.  What an earlier test of a session has left in a
cache is not reached again.
"""

from __future__ import annotations

import json
import signal
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = tuple(f"{ROOT / room}/" for room in ("cprbm", "fea_reference"))
AT_MOST = 1.2
"""Seconds of the processor of one test, the noting of its lines included."""
TOGETHER = 4.0


class TooSlow(BaseException):
    """Not to be taken for a failure by what catches these."""


def pytest_addoption(parser):
    parser.addoption("--reached", type=Path, required=True)


def _too_slow(number, frame):
    raise TooSlow


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    begun = time.process_time()
    if begun - SESSION > TOGETHER:
        item.add_marker(pytest.mark.skip("the file has had its seconds"))
    seen, left = {}, {}

    def called(frame, event, argument):
        code = frame.f_code
        if not code.co_filename.startswith(ROOMS):
            return None
        if code not in seen:
            seen[code] = set()
            left[code] = {line for _, _, line in code.co_lines() if line is not None}
        return at_line if left[code] else None

    def at_line(frame, event, argument):
        code, line = frame.f_code, frame.f_lineno
        seen[code].add(line)
        left[code].discard(line)
        return at_line

    signal.signal(signal.SIGPROF, _too_slow)
    signal.setitimer(signal.ITIMER_PROF, AT_MOST)
    sys.settrace(called)
    try:
        return (yield)
    finally:
        sys.settrace(None)
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        lines = {}
        for code, numbers in seen.items():
            lines.setdefault(str(Path(code.co_filename).relative_to(ROOT)), set()).update(numbers)
        item.config.stash.setdefault(KEY, {})[item.nodeid] = {
            "seconds": round(time.process_time() - begun, 3),
            "lines": {file: sorted(numbers) for file, numbers in sorted(lines.items())},
        }


KEY = pytest.StashKey()
PASSED = pytest.StashKey()
SESSION = time.process_time()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    report = yield
    if report.when == "call" and report.passed:
        item.config.stash.setdefault(PASSED, set()).add(item.nodeid)
    return report


def pytest_sessionfinish(session):
    passed = session.config.stash.get(PASSED, set())
    found = {test: each for test, each in session.config.stash.get(KEY, {}).items() if test in passed}
    session.config.getoption("--reached").write_text(json.dumps(found), "utf-8")
