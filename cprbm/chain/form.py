"""Forms: functions of the unknowns for joints, guides, drives, stops and loads.

=======  ====================================================================================
symbol   meaning
=======  ====================================================================================
z        unknowns of the mechanism
c        constant of a form
a_i      coefficient of z_i
φ        rotation of a rigid body, an unknown
A, B     coefficients of cos φ − 1 and sin φ
=======  ====================================================================================

    f(z) = c + Σ a_i z_i + Σ [A (cos φ − 1) + B sin φ]

A body with the reference point X₀, displacement q and rotation φ carries the point X to X + q + (R(φ) − 1)(X − X₀).
The point's coordinate along d is a form with A = d·(X − X₀) and B = d·J(X − X₀), J the quarter turn.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cprbm_scene.answer import Array

Direction = tuple[float, float]
X_AXIS: Direction = (1.0, 0.0)
Y_AXIS: Direction = (0.0, 1.0)


@dataclass(frozen=True, slots=True)
class Form:
    """A form; ``linear`` holds (index, a), ``turning`` (index of φ, A, B)."""

    constant: float = 0.0
    linear: tuple[tuple[int, float], ...] = ()
    turning: tuple[tuple[int, float, float], ...] = ()

    def __add__(self, other: Form) -> Form:
        return Form(self.constant + other.constant, self.linear + other.linear, self.turning + other.turning)

    def __sub__(self, other: Form) -> Form:
        return self + other * -1.0

    def __mul__(self, factor: float) -> Form:
        return Form(
            self.constant * factor,
            tuple((i, a * factor) for i, a in self.linear),
            tuple((i, A * factor, B * factor) for i, A, B in self.turning),
        )

    def value(self, z: Array) -> float:
        """f(z)."""
        linear = sum(a * float(z[i]) for i, a in self.linear)
        turned = sum(-2.0 * A * np.sin(0.5 * z[i]) ** 2 + B * np.sin(z[i]) for i, A, B in self.turning)
        return float(self.constant + linear + turned)


def unknown(index: int, rest: float = 0.0) -> Form:
    """Change of an unknown from the value at rest."""
    return Form(-rest, ((index, 1.0),))


def node_coordinate(index: int, direction: Direction) -> Form:
    """Coordinate along ``direction`` of the node whose x is the unknown ``index``."""
    return Form(linear=((index, direction[0]), (index + 1, direction[1])))


def carried_coordinate(body: int, reference: Array, place: Array, direction: Direction) -> Form:
    """Coordinate along ``direction`` of a point of a body whose displacement and rotation begin at index ``body``."""
    d, arm = np.array(direction), place - reference
    turning = ((body + 2, float(d @ arm), float(d[1] * arm[0] - d[0] * arm[1])),)
    return Form(float(d @ place), node_coordinate(body, direction).linear, turning if np.any(arm) else ())
