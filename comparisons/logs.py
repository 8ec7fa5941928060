"""Log records of solvers and harness: printed on standard error on request, and counted for progress bars."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

PACKAGES = ("cprbm", "fea_reference", "elastica_reference", "comparisons")
"""Packages with log records; a logger below has the level of its package."""

SOLVERS = PACKAGES[:3]
RUNS = "comparisons.executor"
"""Logger of the finished runs of a comparison."""


def level() -> int:
    """The level from which on records are printed; 0 (NOTSET) if no record is printed."""
    return logging.getLogger(PACKAGES[0]).level


def print_from(least: int) -> None:
    """Print records from the level ``least`` on; with NOTSET print no further record."""
    handler = logging.StreamHandler()
    handler.setFormatter(logging.Formatter("cprbm: %(message)s"))
    for name in PACKAGES:
        logger = logging.getLogger(name)
        logger.setLevel(least)
        logger.handlers = [handler] if least else []
        logger.propagate = not least


@contextmanager
def steps_from(names: tuple[str, ...], call: Callable[[int, int], None]) -> Iterator[None]:
    """Context in which ``call`` gets the numbers of finished and of all steps from the loggers ``names``."""

    def count(record: logging.LogRecord) -> bool:
        if hasattr(record, "done") and hasattr(record, "whole"):
            call(record.done, record.whole)
        return False  # nothing is printed

    handler = logging.Handler()
    handler.addFilter(count)
    loggers = [logging.getLogger(name) for name in names]
    for logger in loggers:
        logger.addHandler(handler)
        logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeHandler(handler)
            logger.setLevel(logging.NOTSET)
