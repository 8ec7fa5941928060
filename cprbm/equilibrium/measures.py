"""Sizes of a state for the certificate, compiled: residual, violation, moments, turns, strains, and balance."""

from __future__ import annotations

from math import cos, hypot, sin
from typing import NamedTuple

from cprbm.chain import add_row_gradient
from cprbm.chain.compiled import compiled
from cprbm.equilibrium.linear import Numbers
from cprbm_scene.answer import Array, Flags, Ints


class Arms(NamedTuple):
    """Points on which forces act: ``first`` index (points,) of the displacements, and ``origin`` (points, 2)."""

    first: Ints
    origin: Array


@compiled
def residuals(gradient: Array, equations: Flags) -> tuple[float, float]:  # pragma: no cover
    """Largest generalised force, and largest violation: the entries of ``gradient`` marked as ``equations``."""
    force = violation = 0.0
    for i in range(gradient.size):
        if equations[i]:
            violation = max(violation, abs(gradient[i]))
        else:
            force = max(force, abs(gradient[i]))
    return force, violation


@compiled
def sizes(z: Array, m: Numbers, lean: Array) -> tuple[float, float, float, float]:  # pragma: no cover
    """Largest angle of a link, turn of a joint, and share of a link's normal force in 12 EI/h²; largest moment.

    Moments are moments of joints, of forces on their links, and of rows.
    """
    angle = turn = strain = moment = 0.0
    for j in range(m.links.length.size):
        i = m.links.first[j]
        fx, fy = z[i + 2], z[i + 3]
        angle = max(angle, abs(z[i + 4]))
        strain = max(strain, abs(lean[j] * (fx * cos(z[i + 4]) + fy * sin(z[i + 4]))))
        moment = max(moment, m.links.length[j] * hypot(fx, fy))
    for i in range(m.joints.stiffness.size):
        j = m.joints.before[i]
        elastic = abs(z[m.links.first[j + 1] + 4] - z[m.links.first[j] + 4] - m.joints.rest[i])
        turn, moment = max(turn, elastic), max(moment, m.joints.stiffness[i] * elastic)
    for i in range(m.rows.first, z.size):
        moment = max(moment, abs(z[i]))
    return angle, turn, strain, moment


@compiled
def resultants(z: Array, m: Numbers, arms: Arms, acting: Array) -> tuple[float, float]:  # pragma: no cover
    """Resultant force and moment of all rows; ``acting`` holds other forces, and the rows' forces are added."""
    add_row_gradient(z, m.rows, z[m.rows.first :], acting)
    along = across = moment = 0.0
    for k in range(arms.first.size):
        i = arms.first[k]
        along, across = along + acting[i], across + acting[i + 1]
        moment += (arms.origin[k, 0] + z[i]) * acting[i + 1] - (arms.origin[k, 1] + z[i + 1]) * acting[i]
    for i in m.turns:
        moment += acting[i]
    return hypot(along, across), abs(moment)
