"""Section law of an answer: stated M, N and Q against the deformation of the stated shape.

======  ===============================================================================
symbol  meaning
======  ===============================================================================
φ       rotation of the section from rest
γ       shear angle ψ - φ, with ψ of the tangent and φ of the section
h       distance of two neighbouring stated places
======  ===============================================================================

Between two places Δφ = ∫ M/(E·I) ds, with an error of an even curvature h² |Q|/(8 E·I), of kinks h² Σ|F|/(8 E·I),
and of the variation of E·I.  The law
is coarse on purpose: without a copy of any element the audit finds gross errors of the section alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from comparisons.audit.balance import nearby
from comparisons.audit.state import StationState
from cprbm_scene.answer import Array

SHARE = 0.05
"""Largest relative error of the section law, over the beam's largest value."""

HELD = 3.0
"""Thicknesses from an end, or from a force, within which shear need not be uniform over the section."""

ROUND_OFF = 1e-9
"""Largest rotation between two places that round-off explains, rad."""


def section_law(state: StationState) -> Iterator[str]:
    """Beams whose stated moments or shear forces do not belong to the stated shape."""
    for name, beam in state.beams.items():
        s, M, Q = beam.state.s, beam.state.M, np.abs(beam.state.Q)
        h, middle, turned = np.diff(s), 0.5 * (s[1:] + s[:-1]), np.diff(beam.turned)
        give = 1.0 / np.stack([beam.stiffness(at)[0] for at in (s[:-1], middle, s[1:])])
        made = h * (give[0] * M[:-1] + 2.0 * give[1] * (M[1:] + M[:-1]) + give[2] * M[1:]) / 6.0
        forces, moments = nearby(state, name, middle)
        even = 0.125 * (beam.size(middle) ** 2 * np.maximum(Q[1:], Q[:-1]) + h**2 * forces) + h * moments
        allowed = SHARE * np.abs(made / h).max() * h + h * np.ptp(give, axis=0) * np.abs(M[1:] + M[:-1])
        yield from _worst(f"{name} turns by", middle, turned, made, allowed + give.max(axis=0) * even)
        if state.kinematics == "shear":
            gamma, made, h = (
                beam.state.angle - beam.state.section_angle,
                beam.state.Q / beam.stiffness(s)[2],
                beam.size(s),
            )
            reach = np.maximum(HELD * beam.beam.thickest / h, 2.0)
            judged = (sum(nearby(state, name, s, reach)) == 0.0) & (np.minimum(s, beam.length - s) > reach * h)
            change = 0.5 * np.abs(np.diff(made))
            allowed = SHARE * np.abs(made).max() + np.maximum(np.append(change, 0.0), np.append(0.0, change))
            yield from _worst(f"{name} shears by", s, gamma, made, np.where(judged, allowed, np.inf))


def _worst(what: str, s: Array, found: Array, made: Array, allowed: Array) -> Iterator[str]:
    """The place where an angle differs most from the angle that the internal forces make."""
    off = np.abs(found - made) - allowed - ROUND_OFF
    worst = int(np.argmax(off))
    if not off[worst] <= 0.0:
        yield f"{what} {found[worst]:.4g} rad at {s[worst]:.4g} m where the internal forces make {made[worst]:.4g} rad"
