"""Stress along a beam from the strain of both faces.

======  ===================================================================================
symbol  meaning
======  ===================================================================================
ε       strain along a face, its stretch minus one, as read by a strain gauge
±       left and right face
bending E (ε₋ − ε₊)/2: positive where the tangent turns counter-clockwise, as in a beam
membrane  E (ε₋ + ε₊)/2
======  ===================================================================================

An element's strain is most accurate at two Gauss points along the element (Barlow, Int. J. Numer. Meth. Engng 10
(1976) 243); a cubic spline interpolates in between.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from cprbm_scene.answer import Array
from fea_reference.solid.model import Model

_GAUSS = 1.0 / np.sqrt(3.0)


def bending_and_membrane(model: Model, q: Array, beam: int, youngs_modulus: float, u: Array) -> tuple[Array, Array]:
    """Bending and membrane stress (k,) at fractions ``u`` (k,) of the arc length, in the unit of ``youngs_modulus``."""
    right, left = (_face_strain(model, q, beam, side, u) for side in (-1.0, 1.0))
    return 0.5 * youngs_modulus * (right - left), 0.5 * youngs_modulus * (right + left)


def _face_strain(model: Model, q: Array, beam: int, side: float, u: Array) -> Array:
    nodes = model.mesh.line(beam, side)
    before = model.mesh.places[nodes]
    after = before + q.reshape(-1, 2)[nodes]
    places, strains = [], []
    for xi in (-_GAUSS, _GAUSS):
        shapes = np.array([0.5 * xi * (xi - 1.0), 1.0 - xi**2, 0.5 * xi * (xi + 1.0)])
        slopes = np.array([xi - 0.5, -2.0 * xi, xi + 0.5])
        s0, s = (slopes[0] * x[:-2:2] + slopes[1] * x[1::2] + slopes[2] * x[2::2] for x in (before, after))
        at = model.mesh.u[nodes]
        places.append(shapes[0] * at[:-2:2] + shapes[1] * at[1::2] + shapes[2] * at[2::2])
        strains.append(np.hypot(*s.T) / np.hypot(*s0.T) - 1.0)
    at, strain = np.concatenate(places), np.concatenate(strains)
    order = np.argsort(at)
    if at.size < 4:
        return np.asarray(np.interp(u, at[order], strain[order]))
    return np.asarray(CubicSpline(at[order], strain[order])(u))
