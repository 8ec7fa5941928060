"""What has been found in a state is found once: pure functions of states, remembered as long as the state is."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar
from weakref import WeakKeyDictionary

from fea_reference.state import State

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class Known(Generic[K, V]):
    """By the state itself, and by a key that says what was asked."""

    def __init__(self) -> None:
        self._in: WeakKeyDictionary[State, dict[K, V]] = WeakKeyDictionary()

    def found(self, z: State, key: K, find: Callable[[], V]) -> V:
        """What is known of state ``z`` by the ``key``, found now if it is not."""
        here = self._in.get(z)
        if here is None:
            here = self._in[z] = {}
        if key not in here:
            here[key] = find()
        return here[key]
