"""Assembly of local matrices into a sparse matrix, with remembered sparsity patterns.

The pattern changes only with the elements in contact.
"""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_matrix

from cprbm_scene.answer import Array
from fea_reference.hermite import Index

_KNOWN = 32  # number of remembered patterns


@dataclass(frozen=True, slots=True)
class Block:
    """Local symmetric matrices ``local`` (m, m, n) of the unknowns ``dofs`` (m, n)."""

    dofs: Index
    local: Array

    @property
    def key(self) -> tuple[bytes, ...]:
        """Key of the entries' positions."""
        return self.dofs.tobytes(), bytes(str(self.dofs.shape), "ascii")

    @property
    def rows(self) -> Index:
        """Rows of the entries, in order."""
        return np.broadcast_to(self.dofs[:, None], self.local.shape).ravel()

    @property
    def columns(self) -> Index:
        """Columns of the entries, in order."""
        return np.broadcast_to(self.dofs[None, :], self.local.shape).ravel()

    @property
    def values(self) -> Array:
        """Values of the entries, in order."""
        return self.local.ravel()


@dataclass(frozen=True, slots=True)
class Single:
    """Entries ``values`` at ``rows`` and ``columns``, (k,) all."""

    rows: Index
    columns: Index
    values: Array

    @property
    def key(self) -> tuple[bytes, ...]:
        """Key of the entries' positions."""
        return self.rows.tobytes(), self.columns.tobytes()


@dataclass(frozen=True, slots=True)
class _Pattern:
    """Position ``place`` (k,) of every entry among the data of the matrix ``template``."""

    place: Index
    template: csc_matrix

    def filled(self, values: Array) -> csc_matrix:
        """The matrix with other values (k,)."""
        matrix = copy(self.template)  # shares the sorted structure
        matrix.data = np.bincount(self.place, values, self.template.nnz)
        return matrix


class Patterns:
    """Remembered sparsity patterns of a model."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._known: dict[tuple[bytes, ...], _Pattern | None] = {}

    def matrix(self, blocks: Sequence[Block | Single]) -> csc_matrix:
        """The sum of all blocks, (size, size)."""
        key = tuple(part for block in blocks for part in block.key)
        values = np.concatenate([block.values for block in blocks])
        known = self._known.get(key)
        if known is not None:
            return known.filled(values)
        rows, columns = (np.concatenate([getattr(block, of) for block in blocks]) for of in ("rows", "columns"))
        assembled = csc_matrix((values, (rows, columns)), (self._size, self._size))
        if len(self._known) >= _KNOWN:
            self._known.clear()
        # a pattern is kept from its second use on
        self._known[key] = _pattern(assembled, rows, columns) if key in self._known else None
        return assembled


def _pattern(matrix: csc_matrix, rows: Index, columns: Index) -> _Pattern:
    """Pattern of entries at ``rows`` and ``columns`` (k,) in their assembled matrix."""
    size = matrix.shape[0]
    standing = np.repeat(np.arange(size), np.diff(matrix.indptr)) * size + matrix.indices
    return _Pattern(np.searchsorted(standing, columns * size + rows), matrix)
