"""A piece of a beam, from start to end state, by Gauss collocation with exact derivatives.

=========  =====================================================================================
symbol     meaning
=========  =====================================================================================
a, b       arc lengths of the piece's start and end, h = b − a; s_i = a + h ξ_i
ξ, w, B    Gauss points in (0, 1), weights, and B_ij = ∫₀^ξi of the j-th Lagrange polynomial
x, y, θ, m position, tangent angle and bending moment
Fx, Fy     internal force at the start, of the part beyond on the part before
Qx, Qy     distributed load, constant in the piece
κ0, c      stress-free curvature and 1/EI by arc length, with derivatives κ0', c'
q          (x, y, θ, m, Fx, Fy, a, b) at the start and (Qx, Qy); e = (x, y, θ, m) at the end
=========  =====================================================================================

    θ' = κ0 + c m,    m' = X sin θ − Y cos θ,    x' = cos θ,    y' = sin θ,    (X, Y) = (Fx, Fy) − (Qx, Qy)(s − a)

Collocated, with g_j = κ0(s_j) + c(s_j) m_j and f_j = X_j sin θ_j − Y_j cos θ_j,

    m_i = m + h B_ij f_j,    0 = r_i = θ_i − θ − h B_ij g_j                                          (1)
    A = ∂r/∂θ = I − h² B diag(c) B diag(X cos θ + Y sin θ),    A dθ = −∂r/∂q dq                    (2)

and e = (x + h w·cos θ, y + h w·sin θ, θ + h w·g, m + h w·f). With p points e has order 2p in h (superconvergence of
Gauss's rule; Hairer, Nørsett and Wanner, Solving Ordinary Differential Equations I, II.7).
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from cprbm_scene.answer import Array

_ITERATIONS = 30
_SETTLED = 1e-14
_LARGEST = 1e3  # largest residual within reach of Newton's method


class UnsolvableError(ArithmeticError):
    """The collocation of a piece has no solution near its guess."""


@dataclass(frozen=True, slots=True)
class Law:
    """Properties of a piece: κ0, κ0', c and c' as functions of arc length (n,) -> (n,)."""

    curvature: Callable[[Array], Array]
    curvature_slope: Callable[[Array], Array]
    compliance: Callable[[Array], Array]
    compliance_slope: Callable[[Array], Array]


@dataclass(frozen=True, slots=True)
class Rule:
    """ξ (p,), w (p,) and B (p, p)."""

    points: Array
    weights: Array
    integrals: Array


@lru_cache(maxsize=8)
def rule(p: int) -> Rule:
    """Gauss rule of ``p`` points on (0, 1) and its integration matrix."""
    x, w = np.polynomial.legendre.leggauss(p)
    # by Legendre polynomials: the expansion of a Lagrange polynomial is (2k + 1)/2 w_j P_k(x_j), and ∫ P_k from −1 to x
    # is (P_{k+1} − P_{k−1})/(2k + 1)
    V = np.polynomial.legendre.legvander(x, p)
    k = np.arange(p)
    expansion = (2.0 * k[:, None] + 1.0) / 2.0 * (w * V[:, :p].T)
    antiderivatives = np.empty((p, p))
    antiderivatives[:, 0] = x + 1.0
    antiderivatives[:, 1:] = (V[:, 2 : p + 1] - V[:, : p - 1]) / (2.0 * k[1:] + 1.0)
    return Rule(0.5 * (x + 1.0), 0.5 * w, 0.5 * antiderivatives @ expansion)


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece's solution: ``start`` q (10,), ``end`` e (4,), ``slopes`` ∂e/∂q (4, 10), θ and m (p,) at the points."""

    start: Array
    end: Array
    slopes: Array
    theta: Array
    moment: Array


def piece(law: Law, q: Array, guess: Array) -> Piece:
    """Solution of a piece.

    Args:
        law: curvature and compliance of the piece.
        q: (x, y, θ, m, Fx, Fy, a, b, Qx, Qy).
        guess: θ at the Gauss points, (p,).

    Raises:
        UnsolvableError: Newton's method does not converge from the guess.
    """
    if not (np.all(np.isfinite(q)) and np.all(np.isfinite(guess))):
        raise UnsolvableError
    gauss = rule(len(guess))
    x, y, angle, moment, Fx, Fy, a, b, Qx, Qy = q
    h, B, w = b - a, gauss.integrals, gauss.weights
    s = a + h * gauss.points
    X, Y = Fx - Qx * h * gauss.points, Fy - Qy * h * gauss.points
    kappa, c = law.curvature(s), law.compliance(s)
    theta, last = guess.copy(), np.inf
    for _ in range(_ITERATIONS):
        cos, sin = np.cos(theta), np.sin(theta)
        m = moment + h * (B @ (X * sin - Y * cos))
        r = theta - angle - h * (B @ (kappa + c * m))
        A = np.eye(len(theta)) - h * h * (B * c) @ (B * (X * cos + Y * sin))
        size = float(np.max(np.abs(r)))
        if not size <= _LARGEST:
            raise UnsolvableError
        if size <= _SETTLED * (1.0 + float(np.max(np.abs(theta)))) or (size < 1e-11 and size >= 0.5 * last):
            break
        last = size
        try:
            theta = theta - np.linalg.solve(A, r)
        except np.linalg.LinAlgError as error:
            raise UnsolvableError from error
        if not np.all(np.isfinite(theta)):
            raise UnsolvableError
    else:
        raise UnsolvableError
    f, g = X * sin - Y * cos, kappa + c * m
    along = X * cos + Y * sin
    # at fixed θ, by columns θ, m, Fx, Fy, a, b, Qx, Qy: ∂f/∂q, ∂m/∂q, ∂s/∂q, ∂r/∂q
    spread = (Qx * sin - Qy * cos) * gauss.points
    zero = np.zeros_like(s)
    f_at = np.stack([zero, zero, sin, -cos, spread, -spread, -h * gauss.points * sin, h * gauss.points * cos], axis=1)
    kappa_s, c_s = law.curvature_slope(s), law.compliance_slope(s)
    m_q = h * (B @ f_at)
    m_q[:, 1] += 1.0
    m_q[:, 4] -= B @ f
    m_q[:, 5] += B @ f
    s_q = np.zeros((len(s), 8))
    s_q[:, 4], s_q[:, 5] = 1.0 - gauss.points, gauss.points
    g_q = (kappa_s + c_s * m)[:, None] * s_q + c[:, None] * m_q
    r_q = -h * (B @ g_q)
    r_q[:, 0] -= 1.0
    r_q[:, 4] += B @ g
    r_q[:, 5] -= B @ g
    theta_q = -np.linalg.solve(A, r_q)
    m_q = m_q + h * (B @ (along[:, None] * theta_q))
    g_q = (kappa_s + c_s * m)[:, None] * s_q + c[:, None] * m_q
    f_q = along[:, None] * theta_q + f_at
    slopes = np.zeros((4, 10))
    slopes[[0, 1, 2, 3], [0, 1, 2, 3]] = 1.0
    slopes[0, 2:] += -h * (w * sin) @ theta_q
    slopes[1, 2:] += h * (w * cos) @ theta_q
    slopes[2, 2:] += h * w @ g_q
    slopes[3, 2:] += h * w @ f_q
    sums = np.array([w @ cos, w @ sin, w @ g, w @ f])
    slopes[:, 6] -= sums
    slopes[:, 7] += sums
    end = np.array([x, y, angle, moment]) + h * sums
    return Piece(q.copy(), end, slopes, theta, m)
