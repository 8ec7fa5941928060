"""The chained pseudo-rigid-body model: equilibrium as a minimum of potential energy under contact."""

from cprbm.settings import Settings
from cprbm.solver import answer

__all__ = ["Settings", "answer"]
