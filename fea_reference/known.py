"""Memory of pure functions of a state, kept as long as the state."""

from collections.abc import Callable, Hashable
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

from fea_reference.state import State

V = TypeVar("V")


class Memory:
    """Values by state and by a key: the function's name and other arguments.

    A value holds no state, since the memory would keep the state alive.
    """

    def __init__(self) -> None:
        self._in: WeakKeyDictionary[State, dict[Hashable, Any]] = WeakKeyDictionary()

    def recall(self, z: State, key: Hashable, find: Callable[[], V]) -> V:
        """The value for state ``z`` and ``key``, computed by ``find`` if unknown."""
        here = self._in.setdefault(z, {})
        try:
            value: V = here[key]
        except KeyError:
            here[key] = value = find()
        return value
