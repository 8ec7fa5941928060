"""Promises of JSON documents: paths of keys, with ``[]`` for items of lists and ``*`` for names of the user."""

from collections.abc import Iterator, Mapping, Set

SOLVERS = frozenset({"cprbm", "fea", "exact", "solid", "auto", "paper", "slsqp", "trust-constr", "ipopt"})
"""Names of solvers, and of the methods in ``bench``."""

FREE = frozenset({"strata", "machine"})
"""Keys of mappings by free texts: features of scenes, libraries of the machine."""


def paths(document: object, names: Set[str], path: str = "") -> Iterator[str]:
    """Every path of keys in a document.

    Args:
        document: plain data, as ``json.loads`` gives it.
        names: names of the user, for beams, stages, contacts.
        path: of ``document`` itself.

    A mapping by solvers gives a path for each solver and, as ``*``, the paths below.
    """
    if isinstance(document, list):
        for item in document:
            yield from paths(item, names, f"{path}[]")
    elif isinstance(document, Mapping):
        free = path.rpartition(".")[2] in FREE or (bool(document) and set(document) <= names)
        by_solver = bool(document) and set(document) <= SOLVERS
        for key, value in document.items():
            deeper = f"{path}.{key}" if path else key
            if by_solver:
                yield deeper
            if free or by_solver:
                deeper = f"{path}.*"
            yield deeper
            yield from paths(value, names, deeper)
