"""The chained pseudo-rigid-body model: equilibrium as a minimum of potential energy under contact."""

from cprbm.offset_points import OffsetPoints, offset_points
from cprbm.settings import Settings
from cprbm.solver import answer

__all__ = ["OffsetPoints", "Settings", "answer", "offset_points"]
