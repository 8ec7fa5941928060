"""A mapping that stays as it is: of a record's named parts, of settings, of what an answer holds.

It can be a key itself and goes to another process, neither of which ``types.MappingProxyType`` does; Python 3.15 has
such a type of this name built in.
"""

from __future__ import annotations

from typing import NoReturn, TypeVar

K = TypeVar("K")
V = TypeVar("V")


class frozendict(dict[K, V]):  # noqa: N801 - as the built-in mappings are called
    """A ``dict`` whose every way to change it raises TypeError; its hash asks that all values have one."""

    __slots__ = ()

    def _refuse(self, *given: object, **named: object) -> NoReturn:
        raise TypeError("a frozendict stays as it is; make another one of its items")

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse

    def __missing__(self, key: K) -> NoReturn:
        """Raise KeyError with the unknown key and all known keys."""
        raise KeyError(f"found {key!r}; allowed: {', '.join(map(repr, self)) or 'none'}")

    def __hash__(self) -> int:  # type: ignore[override]
        """Of the items, in whatever order they stand: equal mappings have equal hashes."""
        return hash(frozenset(self.items()))

    def __reduce__(self) -> tuple[type[frozendict[K, V]], tuple[dict[K, V]]]:
        """By its items as a whole: what pickles and copies a ``dict`` would put in one after the other."""
        return type(self), (dict(self),)

    def __repr__(self) -> str:
        """As it could be written."""
        return f"frozendict({super().__repr__()})"
