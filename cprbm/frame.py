"""Places as a rigid body sees them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array


@dataclass(frozen=True, slots=True)
class Frame:
    """Where the body of something rigid is: m (2,), units of length, and φ, rad."""

    m: Array
    phi: float

    def inwards(self, places: Array) -> Array:
        """Places (k, 2) as the body sees them."""
        return self.turned(places - self.m, -self.phi)

    def outwards(self, places: Array) -> Array:
        """Places (k, 2) on the body as they are."""
        return self.m + self.turned(places, self.phi)

    @staticmethod
    def turned(vectors: Array, angle: float) -> Array:
        """Vectors (k, 2) turned counter-clockwise."""
        if angle == 0.0:
            return vectors
        cos, sin = np.cos(angle), np.sin(angle)
        return np.asarray(vectors @ np.array([[cos, sin], [-sin, cos]]))
