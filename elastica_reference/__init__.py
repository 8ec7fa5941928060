"""Exact answers of bending theory: the beams' differential equations, integrated to round-off."""

from elastica_reference.march import answer
from elastica_reference.settings import Settings

__all__ = ["Settings", "answer"]
