"""The chained pseudo-rigid-body model: equilibrium as a minimum of potential energy under contact."""

from cprbm.discretisation import Discretised, discretised
from cprbm.offset_points import OffsetPoints, offset_points
from cprbm.settings import Settings
from cprbm.solver import answer, prepared

__all__ = ["Discretised", "OffsetPoints", "Settings", "answer", "discretised", "offset_points", "prepared"]
