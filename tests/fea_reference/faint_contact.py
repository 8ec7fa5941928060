"""A strip between two drives that leans on a plane and comes off it: where the plane's force is zero.

=========  ====================================================================================
symbol     meaning
=========  ====================================================================================
θ, κ       tangent angle along the strip, and its change of curvature; EI κ is the moment
F          force on the strip's end T: f₁ d₁ of the drive there and f₂ d₂ of that at Q
v          how far T is driven along d₁, while Q stays along d₂
g          distance from the plane
=========  ====================================================================================

    θ′ = κ,   EI κ′ = −t(θ) × F,   EI κ(L) = f₂ (Q − T) × d₂,

with x′ = t(θ).  Where the contact lets go the strip is in balance without it and g, half the thickness taken off, has
its least value nought within the strip.  Four unknowns (κ(0), f₁, f₂, v), four conditions; integrated by Runge and
Kutta's method of order eight, with nothing of any solver.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar, root

ROOT, T, Q = 0j, -0.0117816 - 0.0281946j, -0.0130085 - 0.0328911j
D1 = complex(-0.732, 0.681) / abs(complex(-0.732, 0.681))
D2 = complex(0.483, 0.876) / abs(complex(0.483, 0.876))
POINT, NORMAL = -0.0017631 - 0.0024852j, complex(0.8763, -0.4817) / abs(complex(0.8763, -0.4817))
E, THICKNESS, WIDTH = 2.3e9, 1.71e-4, 5.3e-3
EI = E * WIDTH * THICKNESS**3 / 12.0
LENGTH = abs(T - ROOT)


def scene(stations: list[float]) -> dict[str, Any]:
    """The strip as a scene whose first stage drives T through ``stations``, m."""
    return {
        "name": "faint-contact",
        "theory": "bending",
        "materials": {"abs": {"youngs_modulus": E, "poisson_ratio": 0.35}},
        "bodies": {
            "wall": {"motion": "fixed", "points": {"R": _pair(ROOT)}},
            "tip": {"motion": "free", "points": {"T": _pair(T), "Q": _pair(Q)}},
        },
        "beams": {
            "beam": {
                "curve": {"kind": "line", "start": _pair(ROOT), "end": _pair(T)},
                "thickness": THICKNESS,
                "width": WIDTH,
                "material": "abs",
                "start": {"joint": "weld", "point": "R"},
                "end": {"joint": "weld", "point": "T"},
            }
        },
        "drives": {
            "push": {"kind": "displacement", "point": "T", "direction": _pair(D1)},
            "held": {"kind": "displacement", "point": "Q", "direction": _pair(D2)},
        },
        "contacts": {
            "plane": {
                "kind": "beam-half-plane",
                "beam": "beam",
                "body": "wall",
                "point": _pair(POINT),
                "normal": _pair(NORMAL),
            }
        },
        "stages": [
            {"name": "push", "steps": "push", "stations": stations},
            {"name": "held", "steps": "held", "stations": [0.0011]},
        ],
        "probes": [{"of": "plane", "quantity": "force"}],
    }


def lets_go(v: float, kappa: float, f1: float, f2: float) -> float:
    """v, m, where the plane's force is zero; all are guesses, in m, 1/m and N.

    Raises:
        RuntimeError: from there nothing was found.
    """
    scales = np.array([1.0 / LENGTH, EI / LENGTH**2, EI / LENGTH**2, LENGTH])
    found = root(lambda q: _missed(*(q * scales)), np.array([kappa, f1, f2, v]) / scales, tol=1e-12)
    if not found.success:
        raise RuntimeError(found.message)
    return float(found.x[3] * scales[3])


def _missed(kappa: float, f1: float, f2: float, v: float) -> np.ndarray:
    force = f1 * D1 + f2 * D2

    def change(_s: float, y: np.ndarray) -> tuple[float, float, float, float]:
        tangent = np.exp(1j * y[0])
        return y[1], -(np.conj(tangent) * force).imag / EI, tangent.real, tangent.imag

    begin = float(np.angle(T - ROOT))
    way = solve_ivp(
        change, (0.0, LENGTH), (begin, kappa, ROOT.real, ROOT.imag), "DOP853", rtol=1e-12, atol=1e-13, dense_output=True
    )

    def gap(s: float) -> float:
        _, _, x, y = way.sol(s)
        return float(((complex(x, y) - POINT) * np.conj(NORMAL)).real) - 0.5 * THICKNESS

    least = minimize_scalar(gap, bounds=(0.3 * LENGTH, 0.98 * LENGTH), method="bounded", options={"xatol": 1e-12})
    theta, bent, x, y = way.y[:, -1]
    at, turned = complex(x, y), np.exp(1j * (theta - begin))
    lever = turned * (Q - T)
    return np.array(
        [
            (EI * bent - f2 * (np.conj(lever) * D2).imag) * LENGTH / EI,
            (((at - T) * np.conj(D1)).real - v) / LENGTH,
            ((at + lever - Q) * np.conj(D2)).real / LENGTH,
            least.fun / LENGTH,
        ]
    )


def _pair(place: complex) -> list[float]:
    return [place.real, place.imag]
