"""Gaps that a contact law of its own measures, beside the gaps between curves.

The formulation ``paper`` measures the gap of two beams by a fitted boundary (:mod:`cprbm.paper`).  The places of such a
contact are places like others; the law writes their gaps and the border columns of the closed places.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from cprbm.contact.gap import Places
from cprbm_scene.answer import Array, Flags, Ints


class Columns(NamedTuple):
    """Border columns of closed places: columns of forces first, then columns of local motions.

    Attributes:
        values: of the rows with a force of their own (forces,).
        negative: number of negative eigenvalues of the local motions' block.
        diagonal, beside: block of the columns: diagonal, and entry beside the column before (columns,).
        entry_column, entry_index, entry_value: entries by column, unknown and value.
    """

    values: Array
    negative: int
    diagonal: Array
    beside: Array
    entry_column: Ints
    entry_index: Ints
    entry_value: Array


class Law(Protocol):
    """A contact law for some pairs of curves."""

    def measures(self, places: Places) -> Flags:
        """Places that the law measures; the last of all places."""

    def write_gaps(self, z: Array, places: Places, gaps: Array) -> None:
        """Write the gaps of the law's places at a state."""

    def columns(self, z: Array, places: Places, closed: Flags, gradient: Array) -> Columns:
        """Columns of all places marked ``closed``; adds the gradient of all −F λ to ``gradient``."""

    def force(self, z: Array, places: Places, k: int) -> Array:
        """Force (2,) on a place of the law."""

    def invalid(self, z: Array, places: Places, closed: Flags) -> str:
        """Reason why the law does not hold at a state; empty if it holds."""
