"""Memory of pure functions of a state, kept as long as the state."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar
from weakref import WeakKeyDictionary

from fea_reference.state import State

K = TypeVar("K", bound=Hashable)
V = TypeVar("V")


class Memory(Generic[K, V]):
    """Values by state and by a key of the function's other arguments."""

    def __init__(self) -> None:
        self._in: WeakKeyDictionary[State, dict[K, V]] = WeakKeyDictionary()

    def recall(self, z: State, key: K, find: Callable[[], V]) -> V:
        """The value for state ``z`` and ``key``, computed by ``find`` if unknown."""
        here = self._in.get(z)
        if here is None:
            here = self._in[z] = {}
        if key not in here:
            here[key] = find()
        return here[key]
