"""Check for a beam passing through another beam or a circle between two states.

=======  ==================================================================================
symbol   meaning
=======  ==================================================================================
p, q     places before and after, relative to a circle's centre or to an end of another beam
t        share of the way between the two states, with places moving along straight lines
=======  ==================================================================================

Two states without overlap may have a circle or another beam's end between them. A step is too long to decide if
places, moving straight, come deep into a circle, or if an end goes through a line.
"""

import numpy as np

from cprbm_scene import BeamContact, CircleContact
from cprbm_scene.answer import Array
from elastica_reference.gaps import SAMPLES
from elastica_reference.model import Model
from elastica_reference.state import Known

_ON = 1e-5  # units of length: larger than the distance between a line and its chords
_DEEP = 0.5  # times the distance at contact with a circle


def passed_through(model: Model, before: Known, after: Known) -> bool:
    """True if a beam may have passed through a circle or another beam between two states."""
    for name, contact in model.scene.contacts.items():
        if isinstance(contact, CircleContact):
            strip = model.strips[contact.beam]
            s = np.linspace(0.0, strip.length, SAMPLES)
            half = float(np.min(strip.half_thickness(s))) if contact.thick else 0.0
            p, q = (known.along(contact.beam, s)[:2] - known.centre(name)[:, None] for known in (before, after))
            if _through_circle(p, q, contact.radius / model.unit_length + half):
                return True
            continue
        assert isinstance(contact, BeamContact)
        for first, second in (contact.between, contact.between[::-1]):
            sigma = np.linspace(0.0, model.strips[second].length, SAMPLES)
            for end in (0.0, model.strips[first].length):
                place = np.array([end])
                p, q = (known.along(second, sigma)[:2] - known.along(first, place)[:2] for known in (before, after))
                if _through_line(p, q):
                    return True
    return False


def _through_circle(p: Array, q: Array, distance: float) -> bool:
    """True if places (2, n) come deep into a circle about the origin, or their line sweeps over the origin."""
    d = q - p
    t = np.clip(-np.sum(p * d, axis=0) / np.maximum(np.sum(d * d, axis=0), np.finfo(float).tiny), 0.0, 1.0)
    if np.min(np.hypot(*(p + t * d))) < _DEEP * distance:
        return True
    corners = [p[:, :-1], p[:, 1:], q[:, 1:], q[:, :-1]]
    turned = np.sum([_angle(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)], axis=0)
    return bool(np.any(np.abs(turned) > np.pi))


def _angle(a: Array, b: Array) -> Array:
    return np.asarray(np.arctan2(_cross(a, b), a[0] * b[0] + a[1] * b[1]))


def _through_line(p: Array, q: Array) -> bool:
    """True if the origin passes through the line whose places move from p (2, n) to q.

    The origin is on a chord from P to P + D if P × D = 0, quadratic in t, and if it lies between the chord's ends. An
    origin on the line before or after, such as an end in contact, does not count.
    """
    P, P_t = p[:, :-1], (q - p)[:, :-1]
    D, D_t = np.diff(p), np.diff(q - p)
    apart = (np.abs(_cross(P, D)) > _ON * np.hypot(*D)) & (
        np.abs(_cross(P + P_t, D + D_t)) > _ON * np.hypot(*(D + D_t))
    )
    c0, c1, c2 = _cross(P, D), _cross(P, D_t) + _cross(P_t, D), _cross(P_t, D_t)
    with np.errstate(divide="ignore", invalid="ignore"):
        # both roots without cancellation; missing roots are not finite
        w = -0.5 * (c1 + np.copysign(np.sqrt(c1 * c1 - 4.0 * c0 * c2), c1))
        roots = np.stack([w / c2, c0 / w])
    t = np.where(np.isfinite(roots) & (roots > 0.0) & (roots <= 1.0), roots, np.nan)
    place, chord = P[:, None] + t * P_t[:, None], D[:, None] + t * D_t[:, None]
    with np.errstate(invalid="ignore"):
        share = -np.sum(place * chord, axis=0) / np.maximum(np.sum(chord * chord, axis=0), np.finfo(float).tiny)
        return bool(np.any(apart & (share >= 0.0) & (share <= 1.0)))


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[0] * b[1] - a[1] * b[0])
