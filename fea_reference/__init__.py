"""The independent reference: planar corotational beam elements with penalty contact, on scikit-fem.

It reads a :class:`cprbm_scene.Scene` and hands back a :class:`cprbm_scene.Answer`; it
knows nothing of the other solver.
"""

from fea_reference.settings import Settings
from fea_reference.solve import answer, prepared

__all__ = ["Settings", "answer", "prepared"]
