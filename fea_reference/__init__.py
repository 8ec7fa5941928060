"""Independent reference solver: planar corotational beam elements with penalty contact, on scikit-fem.

The solver turns a :class:`cprbm_scene.Scene` into a :class:`cprbm_scene.Answer`, independently of the other solver.
"""

from fea_reference.settings import Settings
from fea_reference.solve import answer, prepared

__all__ = ["Settings", "answer", "prepared"]
