"""What ends a run from outside: the signals, and what they become."""

from __future__ import annotations

import signal
from types import FrameType

_SAID = {"SIGINT": "Interrupted", "SIGTERM": "Asked to end", "SIGHUP": "The terminal was closed"}
"""By names, since not every system has them all."""


class Ended(KeyboardInterrupt):
    """A signal has ended the run: an interrupt, or what is treated as one."""

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__()
        self.number = number

    @property
    def sentence(self) -> str:
        """What happened, without its full stop."""
        return _SAID[signal.Signals(self.number).name]

    @property
    def code(self) -> int:
        """The exit code that a shell gives to what a signal ends."""
        return 128 + self.number


def heed() -> None:
    """From now on each of the signals ends the run where it is, unless this process was told to ignore it."""
    for number in _numbers():
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)


def ignore() -> None:
    """From now on none of the signals does anything."""
    for number in _numbers():
        signal.signal(number, signal.SIG_IGN)


def _numbers() -> list[int]:
    return [getattr(signal, name) for name in _SAID if hasattr(signal, name)]


def _end(number: int, frame: FrameType | None) -> None:
    raise Ended(number)
