"""Immutable mapping with a hash, for named parts of records, settings and answers.

``types.MappingProxyType`` has no hash and cannot be pickled.  Python 3.15 has a built-in ``frozendict``.
"""

from typing import NoReturn, Self, TypeVar

K = TypeVar("K")
V = TypeVar("V")


class frozendict(dict[K, V]):  # noqa: N801 - lower case, as the built-in mappings
    """Immutable ``dict``: changes raise TypeError; the hash needs hashable values."""

    __slots__ = ()

    def _refuse(self, *given: object, **named: object) -> NoReturn:
        raise TypeError("a frozendict stays as it is; make another one of its items")

    __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse

    def __missing__(self, key: K) -> NoReturn:
        """Raise KeyError with the unknown key and all known keys."""
        raise KeyError(f"found {key!r}; allowed: {', '.join(map(repr, self)) or 'none'}")

    def __hash__(self) -> int:  # type: ignore[override]
        """Hash of the items without their order: equal mappings have equal hashes."""
        return hash(frozenset(self.items()))

    def __reduce__(self) -> tuple[type[Self], tuple[dict[K, V]]]:
        """Pickle of all items at once: the pickle of a ``dict`` would set items one after the other."""
        return type(self), (dict(self),)

    def __repr__(self) -> str:
        """Text of an expression with the same value."""
        return f"frozendict({super().__repr__()})"
