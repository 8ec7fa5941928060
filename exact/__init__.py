"""The beams' own differential equations, integrated to round-off: exact answers in the theory of bending alone."""

from exact.march import answer
from exact.settings import Settings

__all__ = ["Settings", "answer"]
