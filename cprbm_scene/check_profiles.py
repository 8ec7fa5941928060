"""Thicknesses and widths that vary along a beam: stated from its start to its end, in steps that are no jumps."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cprbm_scene.mistakes import Mistake
from cprbm_scene.statement import Beam, Profile, Scene

CLOSEST = 1e-6  # of the beam's length, between places; nearer ones would state a jump
MOST_PLACES = 1001
LARGEST_RATIO = 1e5  # of two values of one size: no beam theory holds where one is nothing beside the other


def wrong_profiles(scene: Scene) -> Iterator[Mistake]:
    """Thicknesses and widths whose places do not run from 0 to 1, or do not belong to their values."""
    for name, beam in scene.beams.items():
        for size in ("thickness", "width"):
            mistake = _wrong_profile(f"beams.{name}.{size}", getattr(beam, size))
            if mistake is not None:
                yield mistake


def has_sizes(beam: Beam) -> bool:
    """Whether a beam's thickness and width say what they are at every place."""
    return _wrong_profile("", beam.thickness) is None and _wrong_profile("", beam.width) is None


def _wrong_profile(key: str, size: float | Profile) -> Mistake | None:
    if not isinstance(size, Profile):
        return None
    at, values = size.at, size.values
    if len(at) != len(values):
        return Mistake(f"{key}.values", f"{len(values)} values at {len(at)} places", "as many values as places in at")
    if len(at) > MOST_PLACES:
        return Mistake(f"{key}.at", f"{len(at)} places", f"at most {MOST_PLACES} of them")
    if at[0] != 0.0 or at[-1] != 1.0:
        return Mistake(
            f"{key}.at",
            f"places from {at[0]:.9g} to {at[-1]:.9g}",
            "fractions of the beam's length that begin with 0 and end with 1",
        )
    if not max(values) / LARGEST_RATIO <= min(values):
        return Mistake(
            f"{key}.values",
            f"values from {min(values):g} m to {max(values):g} m",
            f"values of which the largest is at most {LARGEST_RATIO:g} times the least",
        )
    steps = np.diff(at)
    if not np.all(steps >= CLOSEST):
        first = int(np.argmin(steps >= CLOSEST))
        return Mistake(
            f"{key}.at[{first + 1}]",
            f"{at[first + 1]:.9g} after {at[first]:.9g}",
            f"places that ascend, each at least {CLOSEST:g} after the one before",
        )
    return None
