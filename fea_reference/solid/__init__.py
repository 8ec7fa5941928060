"""Third solver: the mechanism as a plane solid, with quadrilaterals of second order and contact of real edges.

The solver turns a :class:`cprbm_scene.Scene` into a :class:`cprbm_scene.Answer`, independently of beam theory.
"""

from fea_reference.solid.settings import Settings
from fea_reference.solid.solve import answer, prepared

__all__ = ["Settings", "answer", "prepared"]
