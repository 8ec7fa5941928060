"""Where a layout stands: scaled, turned and seen in a mirror, so that no mechanism lies as it would in a drawing."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, floor, log10, sin, tau

from numpy.random import Generator

from tests.robustness.chance import between, happens, spread

Place = tuple[float, float]
DIGITS = 5  # of a coordinate, counted from the scene's size


@dataclass(frozen=True, slots=True)
class Frame:
    """``size`` of a layout's unit, m, and how it is turned, rad, after the ``mirror`` (1, or −1 for y turned down)."""

    size: float
    angle: float
    mirror: float

    def world(self, place: Place) -> Place:
        """A place of the layout, m, as it is written."""
        x, y = self.direction(place)
        return self.written((self.size * x, self.size * y))

    def direction(self, along: Place) -> Place:
        """A direction of the layout in the scene."""
        x, y = along[0], self.mirror * along[1]
        return x * cos(self.angle) - y * sin(self.angle), x * sin(self.angle) + y * cos(self.angle)

    def written(self, place: Place) -> Place:
        """A place in the scene, m, with as many digits as its size asks for."""
        digits = DIGITS - floor(log10(self.size))
        return round(float(place[0]), digits), round(float(place[1]), digits)


def drawn_frame(rng: Generator) -> Frame:
    """Any frame: units between a centimetre or two and a good foot."""
    return Frame(spread(rng, 0.02, 0.4), between(rng, 0.0, tau), 1.0 if happens(rng, 0.5) else -1.0)
