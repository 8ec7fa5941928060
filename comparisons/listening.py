"""Who listens to what solvers and harness say while they work: nobody, unless asked for.

The sentences go to standard error, from this process and from those that share its work, one line each.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SPEAKERS = ("cprbm", "fea_reference", "elastica_reference", "comparisons")
"""The rooms that say something; a logger below them has their level."""

SOLVERS = SPEAKERS[:3]
RUNS = "comparisons.pairing"
"""Says of the runs of a comparison which are done."""


def heard_from() -> int:
    """From which level on somebody listens; NOTSET if nobody has asked."""
    return logging.getLogger(SPEAKERS[0]).level


def listen(asked: int) -> None:
    """Put what is said from a level on to standard error, until :func:`silence`; NOTSET is nothing."""
    if asked == logging.NOTSET:
        return
    handler = logging.StreamHandler()
    handler.setFormatter(logging.Formatter("cprbm: %(message)s"))
    for name in SPEAKERS:
        logger = logging.getLogger(name)
        logger.setLevel(asked)
        logger.handlers = [handler]
        logger.propagate = False


def silence() -> None:
    """Listen no more."""
    for name in SPEAKERS:
        logger = logging.getLogger(name)
        logger.setLevel(logging.NOTSET)
        logger.handlers = []
        logger.propagate = True


class _Steps(logging.Handler):
    """Hands on how many of how many steps a record says are done."""

    def __init__(self, tell: Callable[[int, int], None]) -> None:
        super().__init__(logging.INFO)
        self._tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Hand it on, if it says so."""
        done, whole = getattr(record, "done", None), getattr(record, "whole", None)
        if done is not None and whole is not None:
            self._tell(done, whole)


@contextmanager
def steps_of(speakers: tuple[str, ...], tell: Callable[[int, int], None]) -> Iterator[None]:
    """While within, ``tell`` is called with the steps done, and with all of them, as the ``speakers`` say."""
    handler = _Steps(tell)
    loggers = [logging.getLogger(name) for name in speakers]
    before = [logger.level for logger in loggers]
    for logger in loggers:
        logger.addHandler(handler)
        logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        for logger, old in zip(loggers, before, strict=True):
            logger.removeHandler(handler)
            logger.setLevel(old)
