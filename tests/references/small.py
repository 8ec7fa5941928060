"""Textbook numbers of straight beams, each one line.

=======  ===========================================================================
symbol   meaning
=======  ===========================================================================
L        length
EI, GA   bending stiffness, shear modulus times area; EA stretching stiffness
ks       shear coefficient (5/6 for a rectangle)
P, M     transverse tip force, end moment
=======  ===========================================================================

Source: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability (Euler's columns, with shear: section
2.17); S. P. Timoshenko, Strength of Materials I (deflections, with shear).
"""

from __future__ import annotations

from math import pi


def euler_load_pinned(EI: float, L: float) -> float:
    """Buckling load of a column pinned at both ends, π² EI / L²."""
    return pi**2 * EI / L**2


def euler_load_cantilever(EI: float, L: float) -> float:
    """Buckling load of a column clamped at one end and free at the other, π² EI / (4 L²)."""
    return pi**2 * EI / (4.0 * L**2)


def euler_load_clamped(EI: float, L: float) -> float:
    """Buckling load of a column clamped at both ends, 4 π² EI / L²."""
    return 4.0 * pi**2 * EI / L**2


def cantilever_deflection(P: float, L: float, EI: float) -> float:
    """Small tip deflection of a slender cantilever, P L³ / (3 EI)."""
    return P * L**3 / (3.0 * EI)


def timoshenko_cantilever_deflection(P: float, L: float, EI: float, GA: float, ks: float) -> float:
    """Small tip deflection of a cantilever with shear, P L³ / (3 EI) + P L / (ks GA)."""
    return P * L**3 / (3.0 * EI) + P * L / (ks * GA)


def guided_deflection(P: float, L: float, EI: float) -> float:
    """Small tip deflection where the tip is kept from turning, P L³ / (12 EI)."""
    return P * L**3 / (12.0 * EI)


def bar_extension(P: float, L: float, EA: float) -> float:
    """Extension of a bar, P L / (EA)."""
    return P * L / EA


def rectangle_second_moment(thickness: float, width: float) -> float:
    """Second moment of area of a rectangle bent across its thickness, w t³ / 12."""
    return width * thickness**3 / 12.0
