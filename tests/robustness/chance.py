"""What a generator of numbers is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log
from typing import TypeVar

from numpy.random import Generator

T = TypeVar("T")


class RedrawError(Exception):
    """What was drawn makes no scene worth asking; the next numbers are drawn in its place."""


def between(rng: Generator, low: float, high: float) -> float:
    """A number between two, evenly."""
    return float(rng.uniform(low, high))


def spread(rng: Generator, low: float, high: float) -> float:
    """A positive number between two, evenly in its logarithm."""
    return exp(rng.uniform(log(low), log(high)))


def happens(rng: Generator, share: float) -> bool:
    """True in a ``share`` of the draws."""
    return bool(rng.uniform() < share)


def sign(rng: Generator) -> float:
    """1 or −1."""
    return 1.0 if happens(rng, 0.5) else -1.0


def any_of(rng: Generator, things: Sequence[T]) -> T:
    """One of the things, each as often."""
    return things[int(rng.integers(len(things)))]


def weighted(rng: Generator, things: Sequence[tuple[T, float]]) -> T:
    """One of the things, by their weights."""
    at = rng.uniform() * sum(weight for _, weight in things)
    for thing, weight in things:
        at -= weight
        if at < 0.0:
            return thing
    return things[-1][0]


def rounded(value: float, digits: int = 4) -> float:
    """The number to so many significant digits."""
    return float(f"{value:.{digits}g}")
