"""What the solid's values at two meshes tend to, and how far off that may be.

======  =====================================================================================================
symbol  meaning
======  =====================================================================================================
v, V    the solid's value at n and at 2n elements along (and across, m and 2m)
p       order of convergence, 2λ
λ       exponent of the displacement at the corner where a free edge meets a face that is held, κ = (3 − ν)/(1 + ν):
        κ sin²(λ π/2) = (κ + 1)²/4 − λ², at most 1
x       extrapolated value, V + (V − v)/(2^p − 1)
u       its uncertainty, S |x − V|
======  =====================================================================================================

Elements of second order would converge with the fourth power of their size, but a face that is held keeps the section
from growing wider, and at its corners the stress has no bound: the energy, and with it every displacement, converges
with 2λ (M. L. Williams, Stress singularities resulting from various boundary conditions in angular corners of plates in
extension, J. Appl. Mech. 19 (1952) 526; Szabó & Babuška, Finite Element Analysis, on meshes that are even).  With the
largest ν of the scene this is about 1.5; taken for the order of all quantities it makes u larger where they are better.
"""

from __future__ import annotations

import numpy as np

from comparisons.measures import SAFETY
from scene import Scene
from scene.answer import Array


def extrapolated(scene: Scene, v: Array, V: Array) -> tuple[Array, Array]:
    """x and, component by component with its sign, what u is the size of; both as ``v`` (k,) and ``V`` (k,)."""
    order = corner_order(max(one.poisson_ratio for one in scene.materials.values()))
    change = (V - v) / (2.0**order - 1.0)
    return V + change, SAFETY * change


def corner_order(poisson_ratio: float) -> float:
    """p of a scene with that ratio, at most 2."""
    from scipy.optimize import brentq  # loaded when a solid is beside, not with every table

    kappa = (3.0 - poisson_ratio) / (1.0 + poisson_ratio)

    def excess(exponent: float) -> float:
        return float(kappa * np.sin(0.5 * np.pi * exponent) ** 2 - 0.25 * (kappa + 1.0) ** 2 + exponent**2)

    return 2.0 * brentq(excess, 0.1, 1.0) if excess(1.0) > 0.0 else 2.0
