"""Signals that end a run: handlers, sentences and exit codes."""

from __future__ import annotations

import signal
from types import FrameType

_SENTENCES = {"SIGINT": "Interrupted", "SIGTERM": "Asked to end", "SIGHUP": "The terminal was closed"}
"""Sentences by signal name; some systems lack some of the signals."""


class SignalInterrupt(KeyboardInterrupt):
    """A signal ended the run."""

    def __init__(self, number: int = signal.SIGINT) -> None:
        super().__init__()
        self.number = number

    @property
    def sentence(self) -> str:
        """Description of the signal without a full stop."""
        return _SENTENCES[signal.Signals(self.number).name]

    @property
    def code(self) -> int:
        """Exit code of a shell for the signal."""
        return 128 + self.number


def install_handlers() -> None:
    """Let every signal raise :class:`SignalInterrupt`, except signals that this process ignores already."""
    for number in _numbers():
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)


def ignore_signals() -> None:
    """Ignore all signals of this module from now on."""
    for number in _numbers():
        signal.signal(number, signal.SIG_IGN)


def _numbers() -> list[int]:
    return [getattr(signal, name) for name in _SENTENCES if hasattr(signal, name)]


def _interrupt(number: int, frame: FrameType | None) -> None:
    raise SignalInterrupt(number)
