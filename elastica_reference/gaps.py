"""Overlaps of beams and circles outside the closed contacts.

=======  ===========================================================================================
symbol   meaning
=======  ===========================================================================================
r        vector to a place of a line, from its closest point on the other line or from the circle's centre
g        gap: distance of the lines (signed by the initial side) minus half thicknesses; for a circle the
         distance from its centre minus radius and half thickness
=======  ===========================================================================================

Every line is sampled, and every local minimum between samples is refined.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cprbm_scene import BeamContact, CircleContact
from cprbm_scene.answer import Array
from elastica_reference.model import Model, Strip
from elastica_reference.state import Known

SAMPLES = 401
_ZOOMS, _ZOOMED = 6, 21  # refinements of a minimum, with this number of places
_FEET = 6  # largest number of Newton iterations of a closest point
_FOUND = 1e-12  # units of length: last step of a closest point
_TOUCHING = 1e-9  # distance of lines without a defined side
_NEAR_END = 1e-9  # times a beam's length


@dataclass(frozen=True, slots=True)
class Overlap:
    """A local minimum with a negative gap.

    Attributes:
        contact: name of the contact.
        beam, s: beam and arc length of the minimum; ``at_end`` is True at an end of the beam.
        onto, sigma: the other beam, and the closest point there; None for a circle.
        side: +1 if ``beam`` lies (or lay) to the left of ``onto``.
        gap: g, dimensionless, negative.
    """

    contact: str
    beam: str
    s: float
    at_end: bool
    onto: str | None
    sigma: float
    side: float
    gap: float


def overlaps(
    model: Model,
    now: Known,
    before: Known,
    touched: Mapping[tuple[str, str], tuple[float, float]],
    sides: Mapping[tuple[str, str, str], float],
    tolerance: float,
) -> list[Overlap]:
    """All local minima of gaps below −``tolerance``.

    Args:
        model: the mechanism.
        now, before: the state, and an earlier state without passed beams, to define the sides.
        touched: arc lengths of the first and last closed place, by contact and beam; minima there are known.
        sides: side of the beam by contact, beam and other beam, if ``before`` is still in contact.
        tolerance: dimensionless.
    """
    candidates: list[Overlap] = []
    for name, contact in model.scene.contacts.items():
        if isinstance(contact, CircleContact):
            candidates += _of_circle(model, now, name, contact, now.centre(name), touched)
        elif isinstance(contact, BeamContact):
            first, second = contact.between
            candidates += _of_pair(model, now, before, name, contact, (first, second), touched, sides)
            candidates += _of_pair(model, now, before, name, contact, (second, first), touched, sides)
    return [overlap for overlap in candidates if overlap.gap < -tolerance]


def _of_circle(
    model: Model,
    now: Known,
    name: str,
    contact: CircleContact,
    centre: Array,
    touched: Mapping[tuple[str, str], tuple[float, float]],
) -> list[Overlap]:
    strip = model.strips[contact.beam]

    def gap(s: Array) -> Array:
        x, y = now.along(contact.beam, s)[:2]
        half = strip.half_thickness(s) if contact.thick else 0.0
        return np.asarray(np.hypot(x - centre[0], y - centre[1]) - contact.radius / model.unit_length - half)

    s = np.linspace(0.0, strip.length, SAMPLES)
    return [
        Overlap(name, contact.beam, place, at_end, None, 0.0, 1.0, value)
        for place, value, at_end in _minima(gap, s, gap(s), touched.get((name, contact.beam)))
        if not (at_end and _holding_body(model, strip, place) == contact.body)
    ]


def _of_pair(
    model: Model,
    now: Known,
    before: Known,
    name: str,
    contact: BeamContact,
    beams: tuple[str, str],
    touched: Mapping[tuple[str, str], tuple[float, float]],
    sides: Mapping[tuple[str, str, str], float],
) -> list[Overlap]:
    first, second = beams
    a, b = model.strips[first], model.strips[second]
    s, sigma = np.linspace(0.0, a.length, SAMPLES), np.linspace(0.0, b.length, SAMPLES)

    def nearest(known: Known) -> Array:
        A, B = known.along(first, s)[:2], known.along(second, sigma)[:2]
        return np.asarray(sigma[np.argmin((A[0][:, None] - B[0]) ** 2 + (A[1][:, None] - B[1]) ** 2, axis=1)])

    def away(known: Known, places: Array, start: Array) -> tuple[Array, Array, Array]:
        """Distances of places to the left of the other line, closest points, and absolute distances."""
        at, r0 = start.copy(), known.along(first, places)[:2]
        for _ in range(_FEET):
            x, y, theta, m = known.along(second, at)[:4]
            t, r = np.stack([np.cos(theta), np.sin(theta)]), r0 - np.stack([x, y])
            bent = 1.0 - (b.line.curvature(at) + b.compliance(at) * m) * (t[0] * r[1] - t[1] * r[0])
            step = (t[0] * r[0] + t[1] * r[1]) / np.where(np.abs(bent) > 0.1, bent, 1.0)
            at, last = np.clip(at + step, 0.0, b.length), at
            if np.max(np.abs(at - last)) < _FOUND:
                break
        x, y, theta = known.along(second, at)[:3]
        r = r0 - np.stack([x, y])
        return np.cos(theta) * r[1] - np.sin(theta) * r[0], at, np.hypot(*r)

    def between(at: Array) -> NDArray[np.bool_]:
        """True (n,) for closest points between the ends of the other line."""
        return np.asarray((at > _NEAR_END * b.length) & (at < (1.0 - _NEAR_END) * b.length))

    feet, feet_before = (away(known, s, nearest(known))[1] for known in (now, before))

    def measured(places: Array) -> tuple[Array, Array, Array, Array]:
        """Gaps, closest points, sides and distances (n,) of places (n,).

        A place that lay beyond an end of the other line, or on the line, has no side.
        """
        lateral, at, distance = away(now, places, np.interp(places, s, feet))
        was, foot, _ = away(before, places, np.interp(places, s, feet_before))
        side = np.where(np.abs(was) > _TOUCHING, np.sign(was), sides.get((name, first, second), 0.0))
        side = np.where(between(foot), side, 0.0)
        apart = a.half_thickness(places) + b.half_thickness(at) if contact.thick else 0.0
        return np.where(side != 0.0, side * lateral - apart, np.inf), at, side, distance

    gaps, at, _, distance = measured(s)
    # far from its initial side a line has gone around the other's end rather than passed through
    gaps = np.where(between(at) & (distance < 0.1), gaps, np.inf)
    minima = []
    for place, _, at_end in _minima(lambda places: measured(places)[0], s, gaps, touched.get((name, first))):
        value, foot, side, _ = (float(array[0]) for array in measured(np.array([place])))
        if between(np.array([foot]))[0]:
            minima.append(Overlap(name, first, place, at_end, second, foot, side, value))
    return minima


def _minima(
    function: Callable[[Array], Array], s: Array, values: Array, touched: tuple[float, float] | None
) -> list[tuple[float, float, bool]]:
    """Places, values and True at an end, for all local minima except the known one."""
    fence = np.pad(values, 1, constant_values=np.inf)
    step = s[1] - s[0]
    minima = []
    # a gap changes at most by the arc length; no minimum is located where the other line ends
    beside = np.pad(np.isfinite(values), 1, constant_values=True)
    least = (values < step) & (values <= fence[:-2]) & (values < fence[2:]) & beside[:-2] & beside[2:]
    for index in np.flatnonzero(least):
        i = int(index)
        if touched is not None and touched[0] - step <= s[i] <= touched[1] + step:
            continue
        place, value = _least(function, float(s[max(i - 1, 0)]), float(s[min(i + 1, len(s) - 1)]))
        if i in (0, len(s) - 1) and values[i] <= value:
            minima.append((float(s[i]), float(values[i]), True))
        else:
            minima.append((place, value, False))
    return minima


def _least(function: Callable[[Array], Array], low: float, high: float) -> tuple[float, float]:
    """Minimum of a function between two places, and its value; approximate if not negative."""
    for _ in range(_ZOOMS):
        s = np.linspace(low, high, _ZOOMED)
        values = function(s)
        i = int(np.argmin(values))
        low, high = float(s[max(i - 1, 0)]), float(s[min(i + 1, len(s) - 1)])
        if values[i] > high - low:
            break
    return float(s[i]), float(values[i])


def _holding_body(model: Model, strip: Strip, s: float) -> str | None:
    """Body that holds the end of a beam at an arc length."""
    end = strip.start if s <= 0.5 * strip.length else strip.end
    return None if end.point is None else model.scene.body_of(end.point)
