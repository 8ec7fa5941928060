"""Memories of pure functions: of a state, kept as long as the state, and of other arguments."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar
from weakref import WeakKeyDictionary

from fea_reference.state import State

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")
_KNOWN = 64


class Memory(Generic[K, V]):
    """Values by state and by a key of the function's other arguments."""

    def __init__(self) -> None:
        self._in: WeakKeyDictionary[State, dict[K, V]] = WeakKeyDictionary()

    def recall(self, z: State, key: K, find: Callable[[], V]) -> V:
        """The value for state ``z`` and ``key``, computed by ``find`` if unknown."""
        here = self._in.get(z)
        if here is None:
            here = self._in[z] = {}
        try:
            return here[key]
        except KeyError:
            here[key] = value = find()
            return value


class Recent(Generic[K, V]):
    """Values by key of the most recent arguments, a bounded number."""

    def __init__(self) -> None:
        self._in: dict[K, V] = {}

    def recall(self, key: K, find: Callable[[], V]) -> V:
        """The value for ``key``, computed by ``find`` if unknown."""
        if key not in self._in:
            if len(self._in) >= _KNOWN:
                self._in.clear()
            self._in[key] = find()
        return self._in[key]
