"""A circular bar as a plane elastic body: how far its end goes, by the stress functions of the exact theory.

======  ==================================================================================
symbol  meaning
======  ==================================================================================
a, b    inner and outer radius, R their mean, w the width
Φ       angle that the bar spans; it is held at the x-axis and goes counter-clockwise
G, m    force through the circle's centre, and moment about it, on the end
F       flexibility: displacement of what is fixed to the end at the centre, and its rotation, by (G, m)
======  ==================================================================================

A moment has H. Golovin's stresses (1881), a force through the centre those of the function f(r) sin θ (Timoshenko &
Goodier, Theory of Elasticity, sections 29 and 33); any load of the end is made up of both.  F is the second derivative
of the strain energy.  The ends carry what the stresses say there, as by Saint-Venant's principle they may.
"""

import numpy as np


def flexibility(a, b, width, span, young, poisson):
    """F (3, 3)."""
    x, wx = np.polynomial.legendre.leggauss(30)
    r, dr = 0.5 * (a + b) + 0.5 * (b - a) * x, 0.5 * (b - a) * wx
    y, wy = np.polynomial.legendre.leggauss(40)
    angle, da = 0.5 * span * (y + 1.0), 0.5 * span * wy
    log = np.log(b / a)
    inner = a**2 * b**2 * log / r**2
    radial = inner + b**2 * np.log(r / b) + a**2 * np.log(a / r)
    hoop = -inner + b**2 * np.log(r / b) + a**2 * np.log(a / r) + b**2 - a**2
    moment = width * (hoop * r * dr).sum()
    first, third = r, a**2 * b**2 / r**3
    along = -(a**2 + b**2) / r
    pulled, pressed = 3.0 * first - third + along, first + third + along  # σ_θ and σ_r over sin θ, τ over −cos θ
    axial, shear = width * (pulled * dr).sum(), width * (pressed * dr).sum()
    out, on = np.stack([np.cos(angle), np.sin(angle)]), np.stack([-np.sin(angle), np.cos(angle)])
    loads = []
    for k in range(3):
        G = np.eye(3)[k, :2]
        N, V, m = G @ on, G @ out, float(k == 2)
        loads.append(
            (
                np.outer(N / axial, pulled) + m * hoop / moment,
                np.outer(N / axial, pressed) + m * radial / moment,
                np.outer(V / shear, pressed),
            )
        )
    area = width * np.outer(da, r * dr)

    def together(one, other):
        (t, s, q), (T, S, Q) = one, other
        return (area * (t * T + s * S - poisson * (t * S + s * T) + 2.0 * (1.0 + poisson) * q * Q)).sum() / young

    return np.array([[together(one, other) for other in loads] for one in loads])


def tip_motion(F, tip, force, moment):
    """Displacement (2,) of a ``tip`` (2,) from the centre, and its rotation, under a force (2,) and a moment there."""
    carried = np.array([[1.0, 0.0, -tip[1]], [0.0, 1.0, tip[0]], [0.0, 0.0, 1.0]])
    return carried @ F @ carried.T @ np.array([*force, moment])
