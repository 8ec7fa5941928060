"""The chained pseudo-rigid-body model: equilibrium as a minimum of potential energy under contact."""

from cprbm.paper.offset_points import OffsetPoints, offset_points
from cprbm.settings import Settings
from cprbm.solver import answer, prepared

__all__ = ["OffsetPoints", "Settings", "answer", "offset_points", "prepared"]
