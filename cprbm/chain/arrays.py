"""Arrays of a mechanism for the compiled kernels, and the kernel of rows.

The gradient of the Lagrangian by z is the chains' gradient plus Σ μ ∂f/∂z of the rows.  By the multiplier of a row
with prescribed value the gradient is f(z) − f*.
"""

from math import cos, sin
from typing import NamedTuple

import numpy as np

from cprbm.chain.compiled import compiled
from cprbm.chain.kernel import Joints, Links
from cprbm.chain.mechanism import PER_LINK, Mechanism
from cprbm_scene.answer import Array, Ints


class RowArrays(NamedTuple):
    """Rows: index of the first multiplier, constants; terms with the number of their row."""

    first: int
    constant: Array
    linear_row: Ints
    linear_index: Ints
    linear_factor: Array
    turning_row: Ints
    turning_index: Ints
    turning_cos: Array
    turning_sin: Array


def link_arrays(m: Mechanism) -> tuple[Links, Joints]:
    """Links and joints of all beams in the order of the unknowns."""
    chains = m.chains.values()
    first = np.concatenate([m.starts[name] + PER_LINK * np.arange(chain.links) for name, chain in m.chains.items()])
    links = Links(
        first.astype(np.int64),
        np.concatenate([chain.link_length for chain in chains]),
        np.concatenate([chain.stretch for chain in chains]),
        np.concatenate([chain.shear + chain.lean for chain in chains]),
    )
    offsets = np.cumsum([0, *(chain.links for chain in chains)])
    joints = Joints(
        np.concatenate([at + np.arange(chain.links - 1) for at, chain in zip(offsets, chains, strict=False)]),
        np.concatenate([chain.stiffness for chain in chains]),
        np.concatenate([np.diff(chain.link_angle) for chain in chains]),
        np.concatenate([chain.bend for chain in chains]),
        np.concatenate([chain.skew for chain in chains]),
        np.concatenate([chain.growth[:, 0] for chain in chains]),
        np.concatenate([chain.growth[:, 1] for chain in chains]),
        np.concatenate([chain.half_lean[:-1] for chain in chains]),
        np.concatenate([chain.half_lean[1:] for chain in chains]),
    )
    return links, joints


def row_arrays(m: Mechanism) -> RowArrays:
    """Terms of all rows."""
    linear = [(r, i, a) for r, row in enumerate(m.rows) for i, a in row.form.linear if a != 0.0]
    turning = [(r, *term) for r, row in enumerate(m.rows) for term in row.form.turning]
    return RowArrays(
        len(m.rest),
        np.array([row.form.constant for row in m.rows], dtype=float),
        np.array([r for r, _, _ in linear], dtype=np.int64),
        np.array([i for _, i, _ in linear], dtype=np.int64),
        np.array([a for _, _, a in linear], dtype=float),
        np.array([r for r, _, _, _ in turning], dtype=np.int64),
        np.array([i for _, i, _, _ in turning], dtype=np.int64),
        np.array([A for _, _, A, _ in turning], dtype=float),
        np.array([B for _, _, _, B in turning], dtype=float),
    )


@compiled
def row_values(z: Array, rows: RowArrays) -> Array:  # pragma: no cover
    """f of all rows."""
    values = rows.constant.copy()
    for t in range(rows.linear_row.size):
        values[rows.linear_row[t]] += rows.linear_factor[t] * z[rows.linear_index[t]]
    for t in range(rows.turning_row.size):
        half = sin(0.5 * z[rows.turning_index[t]])
        turned = -2.0 * rows.turning_cos[t] * half * half + rows.turning_sin[t] * sin(z[rows.turning_index[t]])
        values[rows.turning_row[t]] += turned
    return values


@compiled
def add_row_gradient(z: Array, rows: RowArrays, weight: Array, gradient: Array) -> None:  # pragma: no cover
    """Add Σ weight ∂f/∂z of all rows to ``gradient``."""
    for t in range(rows.linear_row.size):
        gradient[rows.linear_index[t]] += weight[rows.linear_row[t]] * rows.linear_factor[t]
    for t in range(rows.turning_row.size):
        angle = z[rows.turning_index[t]]
        slope = rows.turning_sin[t] * cos(angle) - rows.turning_cos[t] * sin(angle)
        gradient[rows.turning_index[t]] += weight[rows.turning_row[t]] * slope
