"""Residual and tangent of the whole mechanism.

The residual is the derivative of Π(z) + Σ μ c(z) by all unknowns, with elements, contacts and loads in Π; the tangent
is the second derivative. Forces are assembled over the mesh's displacements q, and transformed to the unknowns by
∂q/∂z.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import block_diag, coo_matrix, csc_matrix, csr_matrix, vstack
from scipy.sparse.linalg import SuperLU, splu

from cprbm_scene.answer import Array
from fea_reference.solid.beam_loads import AreaLoad
from fea_reference.solid.beam_moments import CouplePart
from fea_reference.solid.bodies import across, turned
from fea_reference.solid.contacts import PredictedGap, Touch, least_gap, touch
from fea_reference.solid.elements import Strained
from fea_reference.solid.model import LoadPart, Model, SharePart
from fea_reference.solid.pairs import Pair
from fea_reference.solid.stops import STIFFNESS

_ROUND_OFF = 8.0  # measured
_NOTHING = 10.0  # floors: smaller forces are round-off


@dataclass(frozen=True, slots=True)
class Prediction:
    """Prediction of a step: ``stress`` (e, q, 3) of the elements and ``gaps`` of the pairs."""

    stress: Array
    gaps: Mapping[Pair, PredictedGap]


@dataclass(frozen=True)
class System:
    """Residual and tangent in a state ``z``.

    Attributes:
        z: the unknowns.
        q: displacements of the nodes (2N,).
        residual: unbalanced generalised forces and constraint violations (size,).
        tangent: derivative of the residual (size, size).
        carried: ∂q/∂z, extended by the three unknowns of every body.
        nodal: unbalanced forces (2N,) of elements, contacts and loads on the nodes; on tied nodes the tie's negative
            force.
        strained: the elements.
        touches: the pairs.
        scale: the largest force in equilibrium; one if all forces are round-off.
        floor: round-off of the residual: the largest nodal stiffness times the spacing of numbers at the largest
            displacement.
    """

    z: Array
    q: Array
    residual: Array
    tangent: csc_matrix
    carried: csr_matrix
    nodal: Array
    strained: Strained
    touches: tuple[Touch, ...]
    scale: float
    floor: float

    def solve(self, right: Array) -> Array | None:
        """Solution (size,) of the tangent's equations for ``right`` (size,); None for a singular tangent."""
        solution = None if self.factors is None else self.factors.solve(right)
        return None if solution is None or not np.isfinite(solution).all() else solution

    def prediction(self, step: Array) -> Prediction:
        """Prediction for a ``step`` of the unknowns, to first order."""
        moved = self.carried @ step
        stress = self.strained.predicted(moved)
        return Prediction(stress, {contact.pair: contact.predicted_gap(moved) for contact in self.touches})

    @cached_property
    def factors(self) -> SuperLU | None:
        """LU factors of the tangent; None for a singular tangent."""
        try:
            return splu(
                self.tangent, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01, options={"SymmetricMode": True}
            )
        except RuntimeError:  # exactly singular
            return None


def assemble(
    model: Model,
    penalties: Mapping[Pair, float],
    quadrature: int,
    values: Array,
    z: Array,
    predicted: Prediction | None = None,
) -> System:
    """Residual and tangent in state ``z``.

    Args:
        model: the mechanism.
        penalties: factor ρ of every pair.
        quadrature: Gauss points per part of a zone.
        values: dimensionless values of all stepped parameters, in the model's order.
        z: the unknowns.
        predicted: prediction of the last step for the second part of the tangent; None for the state's own.
    """
    q = model.displacements(z)
    elements = model.strain_elements(q)
    touches = tuple(
        touch(model, pair, factor, quadrature, q, z, None if predicted is None else predicted.gaps[pair])
        for pair, factor in penalties.items()
    )
    local = elements.gradient
    m, nodes = len(model.bodies), q.size
    places = model.mesh.places + q.reshape(-1, 2)
    # the mesh's q, followed by three unknowns of every body
    forces: Array = np.bincount(model.elements.dofs.ravel(), local.ravel(), nodes + 3 * m).astype(float)
    rows, columns, entries = [], [], []
    for contact in touches:
        if contact.zeta.size:
            forces += np.bincount(contact.dofs.ravel(), contact.gradient.ravel(), nodes + 3 * m)
            wide = np.broadcast_to(contact.dofs[:, :, None], contact.hessian.shape)
            rows.append(wide.ravel())
            columns.append(wide.transpose(0, 2, 1).ravel())
            entries.append(contact.hessian.ravel())
    for part, value in zip(model.loads, values[: len(model.loads)], strict=True):
        if isinstance(part, AreaLoad | CouplePart):
            acting = part.forces if isinstance(part, AreaLoad) else part.forces(places)
            forces[2 * part.nodes] -= value * acting[:, 0]
            forces[2 * part.nodes + 1] -= value * acting[:, 1]
        if isinstance(part, CouplePart):
            moved, bent = part.tangent(places)
            rows.append(np.repeat(moved, moved.size))
            columns.append(np.tile(moved, moved.size))
            entries.append(-value * bent.ravel())
    carried = vstack([model.chain(z), _moving(model)], format="csr")
    stiffness = model.elements.pattern.matrix(
        elements.hessian(elements.stress if predicted is None else predicted.stress)
    )
    stiffness = block_diag((stiffness, csc_matrix((3 * m, 3 * m))), format="csc")
    if rows:
        pressed = (np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns)))
        stiffness = stiffness + coo_matrix(pressed, stiffness.shape).tocsc()
    residual = carried.T @ forces
    diagonal = model.turning(forces[:nodes], z)
    more_rows, more_columns, more = [], [], []
    for part, value in zip(model.loads, values[: len(model.loads)], strict=True):
        if isinstance(part, LoadPart):
            residual -= value * load_direction(model, part, z)
            dofs = model.bodies[part.body].dofs
            if part.direction is not None and dofs is not None:
                diagonal.append((int(dofs[2]), value * float(turned(part.arm, z[dofs[2]]) @ part.direction)))
        elif isinstance(part, SharePart):
            residual -= value * load_direction(model, part, z)
    prescribed = dict(zip((part.name for part in model.drives), values[len(model.loads) :], strict=True))
    for row in model.rows:
        dofs, slopes = row.gradient(model.bodies, z)
        mu = float(z[row.multiplier])
        goal = row.way * prescribed[row.drive] if row.drive else 0.0
        residual[row.multiplier] += row.violation(model.bodies, z) - goal
        np.add.at(residual, dofs, mu * slopes)
        for dof, slope in zip(dofs, slopes, strict=True):
            more_rows += [row.multiplier, int(dof)]
            more_columns += [int(dof), row.multiplier]
            more += [float(slope)] * 2
        diagonal += [(dof, mu * second) for dof, second in row.second(model.bodies, z)]
    for stop in model.stops:
        moment = stop.moment(z)
        for dof, slope in stop.dofs if moment else ():
            residual[dof] -= moment * slope
            for other, beside in stop.dofs:
                more_rows.append(dof)
                more_columns.append(other)
                more.append(STIFFNESS * slope * beside)
    for dof, value in diagonal:
        more_rows.append(dof)
        more_columns.append(dof)
        more.append(value)
    extra = coo_matrix((more, (more_rows, more_columns)), (model.size, model.size))
    tangent = (carried.T @ stiffness @ carried + extra).tocsc()
    pressing = [float(np.abs(contact.gradient).max()) for contact in touches if contact.zeta.size]
    largest = max(
        float(np.abs(local).max()), float(np.abs(values[: len(model.loads)]).max(initial=0.0)), *pressing, 0.0
    )
    stiffest = float(np.abs(stiffness.diagonal()).max())
    floor = _ROUND_OFF * stiffest * float(np.spacing(np.abs(q).max(initial=1e-3)))
    scale = largest if largest > _NOTHING * floor else 1.0
    return System(z, q, residual, tangent, carried, forces[:nodes], elements, touches, scale, floor)


def deepest(model: Model, pairs: Iterable[Pair], z: Array) -> float:
    """The largest penetration in a state, relative to the mean thickness."""
    places = model.mesh.places + model.displacements(z).reshape(-1, 2)
    return max((-least_gap(model, pair, places, z) / pair.measure for pair in pairs), default=0.0)


def load_direction(model: Model, part: LoadPart | SharePart, z: Array) -> Array:
    """Right-hand side (size,) of a unit load on bodies."""
    f = np.zeros(model.size)
    if isinstance(part, SharePart):
        f[part.dofs] = part.moments
        return f
    dofs = model.bodies[part.body].dofs
    if dofs is None:
        return f
    if part.direction is None:
        f[dofs[2]] = 1.0
    else:
        f[dofs] = [*part.direction, part.direction @ across(turned(part.arm, z[dofs[2]]))]
    return f


def _moving(model: Model) -> csr_matrix:
    """Matrix (3m, size) from the unknowns to three unknowns of every body, zero for fixed bodies."""
    dofs = [np.full(3, -1) if body.dofs is None else body.dofs for body in model.bodies]
    columns = np.concatenate(dofs)
    rows = np.flatnonzero(columns >= 0)
    return csr_matrix((np.ones(rows.size), (rows, columns[rows])), (columns.size, model.size))
