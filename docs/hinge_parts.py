"""What makes the hinge's solid stiffer than straight beams with shear: the table of docs/solid.md, part by part.

Rods that stretch and shear, with sections of a curved beam that may also grow thicker and thinner, on the case `hinge`,
sharing nothing with any solver. Each part is switched on alone or on top of those before it.

    python docs/hinge_parts.py    (a minute of one core; needs the extra `peers`)

==========  =============================================================================================
symbol      meaning
==========  =============================================================================================
κ, k        curvature at rest, and its change; ε, γ stretch less one and shear of the line of means
η, w(η)     place across, to the left, and how far it moves there beyond k's rotation; its mean is zero
λ_s, λ_η    stretches (1 + ε − κ η − k η − (κ + k) w)/(1 − κ η) and 1 + w′
e           strain: λ − 1, or (λ² − 1)/2 of St. Venant and Kirchhoff
W           energy per length, ½ E/(1 − ν²) b ∫ (e_s² + e_η² + 2 ν e_s e_η)(1 − κ η) dη + ½ (5/6) G A γ²; least in w
==========  =============================================================================================

A straight section has ½ E A ε² + ½ E I k² in the place of the integral; Winkler's has e_s = (ε − η k)/(1 − κ η) alone.
The beams touch with the middles of their lengths, a thickness apart, by the symmetry of the mechanism.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import casadi as ca
import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

E, T, B, R = 2.3e9, 0.002, 0.008, 0.025  # Young's modulus, thickness, width, radius
A, INERTIA, LENGTH = B * T, B * T**3 / 12.0, np.pi * R
CENTRES, TURNS, AXIS = (0.02625, -0.02625), (1.0, -1.0), (0.001, 0.051)  # y of both arcs; x of their ends
SMALL, FULL = 0.0067, 0.67  # N·m
ELEMENTS = 24
GAUSS = [*zip(*np.polynomial.legendre.leggauss(2), strict=True)]
ACROSS = [*zip(*np.polynomial.legendre.leggauss(10), strict=True)]


@dataclass(frozen=True)
class Part:
    """What is switched on.

    Attributes:
        nu: Poisson's ratio.
        section: ``straight``, ``winkler`` or ``whole``.
        green: whether the strain is St. Venant's and Kirchhoff's.
        held: length, over the thickness, that a held face keeps from turning.
        closer: by how much less than a thickness the lines are apart where they press, m.
    """

    nu: float
    section: str = "straight"
    green: bool = False
    held: float = 0.0
    closer: float = 0.0


@dataclass(frozen=True)
class Answer:
    """Rotations at both moments, displacements of B and D (2,) and the contact's force at the full one."""

    small: float
    rotation: float
    B: np.ndarray
    D: np.ndarray
    force: float


def energy(part: Part, kappa: float, eps: ca.SX, gamma: ca.SX, k: ca.SX, c: ca.SX) -> ca.SX:
    """W, with w of powers of 2η/t by their coefficients ``c``."""
    shear = 0.5 * (5.0 / 6.0) * E / (2.0 * (1.0 + part.nu)) * A * gamma**2
    if part.section == "straight":
        return 0.5 * E * A * eps**2 + 0.5 * E * INERTIA * k**2 + shear
    found = shear
    for r, weight in ACROSS:
        eta, d = 0.5 * T * r, 0.5 * T * weight * (1.0 - 0.5 * T * r * kappa) * B
        if part.section == "winkler":
            found += 0.5 * E * d * ((eps - eta * k) / (1.0 - eta * kappa)) ** 2
            continue
        powers = (r, r**2 - 1.0 / 3.0, r**3, r**4 - 1.0 / 5.0, r**5)
        w = 0.5 * T * sum(c[i] * p for i, p in enumerate(powers))
        slope = sum(c[i] * (i + 1) * r**i for i in range(5))
        along, across = (1.0 + eps - (kappa + k) * eta - (kappa + k) * w) / (1.0 - kappa * eta), 1.0 + slope
        strains = [0.5 * (x**2 - 1.0) if part.green else x - 1.0 for x in (along, across)]
        both = strains[0] ** 2 + strains[1] ** 2 + 2.0 * part.nu * strains[0] * strains[1]
        found += 0.5 * E / (1.0 - part.nu**2) * d * both
    return found


def shapes(xi: float, h: float) -> tuple[list[float], list[float]]:
    """Quadratics of an element's three nodes, and their derivatives by the arc length."""
    values = [0.5 * xi * (xi - 1.0), 1.0 - xi**2, 0.5 * xi * (xi + 1.0)]
    return values, [(xi - 0.5) * 2.0 / h, -4.0 * xi / h, (xi + 0.5) * 2.0 / h]


class Hinge:
    """The mechanism's equations; unknowns are the body's motion, nodes, the sections' own, and the contact's force."""

    def __init__(self, part: Part, *, touching: bool) -> None:
        body, moment, apart = ca.SX.sym("body", 3), ca.SX.sym("moment"), ca.SX.sym("apart")
        unknowns, begin, W, middles = [body], [np.zeros(3)], 0.0, []
        h = LENGTH / ELEMENTS
        for y, turn in zip(CENTRES, TURNS, strict=True):
            s = np.linspace(0.0, LENGTH, 2 * ELEMENTS + 1)
            angle = np.pi + turn * s / R
            rest = np.stack((0.026 + R * np.cos(angle), y + R * np.sin(angle), angle + turn * 0.5 * np.pi), axis=1)
            inner = ca.SX.sym("nodes", 3 * (len(s) - 2))
            unknowns.append(inner)
            begin.append(rest[1:-1].ravel())
            arm, co, si = rest[-1, :2] - (AXIS[1], 0.0), ca.cos(body[2]), ca.sin(body[2])
            last = (
                AXIS[1] + body[0] + co * arm[0] - si * arm[1],
                body[1] + si * arm[0] + co * arm[1],
                rest[-1, 2] + body[2],
            )
            nodes = [ca.SX(rest[0]), *ca.vertsplit(inner, 3), ca.vertcat(*last)]
            middles.append(nodes[ELEMENTS])
            curvatures = []
            for e in range(ELEMENTS):
                own = nodes[2 * e : 2 * e + 3]
                for xi, weight in GAUSS:
                    N, slope = shapes(xi, h)
                    theta = sum(N[i] * own[i][2] for i in range(3))
                    x, y_, turned = (sum(slope[i] * own[i][j] for i in range(3)) for j in range(3))
                    eps = ca.cos(theta) * x + ca.sin(theta) * y_ - 1.0
                    gamma = ca.cos(theta) * y_ - ca.sin(theta) * x
                    k = turned - turn / R
                    c = ca.SX.sym("c", 5 if part.section == "whole" else 0)
                    unknowns.append(c)
                    begin.append(np.zeros(c.numel()))
                    W += 0.5 * h * weight * energy(part, turn / R, eps, gamma, k, c)
                    curvatures.append(k)
            for near, next_ in (curvatures[:2], curvatures[:-3:-1]):  # to the end by the element's two Gauss points
                at_end = near + (near - next_) * (np.sqrt(3.0) - 1.0) / 2.0
                W += 0.5 * E * INERTIA * part.held * T * at_end**2
        across = ca.norm_2(middles[0][:2] - middles[1][:2])
        force = ca.SX.sym("force", 1 if touching else 0)
        z = ca.vertcat(*unknowns, force)
        lagrangian = W - moment * body[2] + (force * (apart - across) if touching else 0.0)
        self.begin = np.concatenate((*begin, np.zeros(force.numel())))
        hessian, gradient = ca.hessian(lagrangian, z)
        self.newton = ca.Function("newton", [z, moment, apart], [gradient, hessian])
        self.apart = ca.Function("apart", [z], [across])

    def solved(self, z: np.ndarray, moment: float, apart: float) -> np.ndarray:
        """The equilibrium near ``z`` (n,) at a moment, the lines ``apart`` where they touch."""
        for _ in range(40):
            gradient, hessian = self.newton(z, moment, apart)
            step = splu(csc_matrix(hessian)).solve(-np.array(gradient).ravel())
            z = z + step
            if np.abs(step).max() < 1e-11:
                return z
        raise ArithmeticError(f"Newton's iterations do not arrive at {moment} N·m")


def answered(part: Part) -> Answer:
    """Free up to 0.3 N·m, and from there with the contact, whose gap is closed on the way."""
    free, touching = (Hinge(part, touching=each) for each in (False, True))
    z = free.solved(free.begin, SMALL, 0.0)
    small = float(z[2])
    for moment in (0.067, 0.134, 0.2, 0.26, 0.3):
        z = free.solved(z, moment, 0.0)
    gap, z = float(free.apart(z)), np.append(z, 0.0)
    for _, share in pairwise(np.linspace(0.0, 1.0, 10)):
        z = touching.solved(z, 0.3 + (FULL - 0.3) * share, gap + (T - part.closer - gap) * share)
    moved = []
    for y in CENTRES:
        co, si = np.cos(z[2]), np.sin(z[2])
        moved.append(np.array([z[0] - si * y, z[1] + co * y - y]))
    return Answer(small, float(z[2]), moved[0], moved[1], abs(float(z[-1])))


def print_part(name: str, one: Answer, other: Answer, to: Answer) -> None:
    """What a part makes of each number, in per cent, along the displacements."""

    def share(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> float:
        return 100.0 * float(np.dot(a - b, c) / np.dot(c, c))

    rotations = [100.0 * (one.small - other.small) / to.small, 100.0 * (one.rotation - other.rotation) / to.rotation]
    moved = [share(one.B, other.B, to.B), share(one.D, other.D, to.D)]
    force = 100.0 * (one.force - other.force) / to.force
    print(f"  {name:48}" + "".join(f"{value:+9.3f}" for value in (*rotations, *moved, force)))


def main() -> None:
    """Print the table."""
    for nu, held in ((0.0, 0.0), (0.35, 0.0073)):
        parts = {
            "straight": Part(nu),
            "Winkler's coupling": Part(nu, "winkler"),
            "radial stress, and by Poisson's ratio its squeeze": Part(nu, "whole"),
            "St. Venant-Kirchhoff's strain": Part(nu, "whole", green=True),
            "held faces": Part(nu, "whole", green=True, held=held),
        }
        closest = replace(parts["held faces"], closer=2.0e-6)
        answers = {
            name: answered(part) for name, part in (parts | {"lines 2.0 µm closer at the contact": closest}).items()
        }
        straight = answers["straight"]
        print(f"ν = {nu:g}: rotation {straight.rotation:.7f} rad, contact force {straight.force:.6f} N; in per cent:")
        print(" " * 50 + "".join(f"{head:>9}" for head in ("small", "rotation", "B", "D", "force")))
        for before, after in pairwise(answers):
            print_part(after, answers[after], answers[before], straight)
        print_part("all", answers[[*answers][-1]], straight, straight)


if __name__ == "__main__":
    main()
