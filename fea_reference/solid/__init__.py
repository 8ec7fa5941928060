"""A third opinion: the mechanism as a plane solid, by quadrilaterals of second order and contact of real edges.

It reads a :class:`cprbm_scene.Scene` and hands back a :class:`cprbm_scene.Answer`; it knows nothing of beams' theories.
"""

from fea_reference.solid.settings import Settings
from fea_reference.solid.solve import answer, prepared

__all__ = ["Settings", "answer", "prepared"]
