"""The beams' own differential equations, integrated to round-off: exact answers in the theory of bending alone."""

from elastica_reference.march import answer
from elastica_reference.settings import Settings

__all__ = ["Settings", "answer"]
