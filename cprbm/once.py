"""A property that is worked out when it is asked for first, and then kept.

As ``functools.cached_property``, but without the lock that Python 3.11 takes, which costs as much as what many of them
hold.  Two threads may both work it out, and find the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, Self, TypeVar, overload

T = TypeVar("T")


class once(Generic[T]):  # noqa: N801  a decorator is named like a function
    """Of a method without arguments, a property whose value the object keeps in its own ``__dict__``."""

    def __init__(self, find: Callable[[Any], T]) -> None:
        self.find, self.name, self.__doc__ = find, find.__name__, find.__doc__

    @overload
    def __get__(self, of: None, owner: type) -> Self: ...

    @overload
    def __get__(self, of: object, owner: type) -> T: ...

    def __get__(self, of: object | None, owner: type) -> T | Self:
        if of is None:
            return self
        found = of.__dict__[self.name] = self.find(of)
        return found
