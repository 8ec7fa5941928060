"""Residual and tangent of the whole mechanism: elements, joints, drives, stops, loads and contacts.

The residual is the derivative of the Lagrangian Π(z) − Σ loads + λᵀ c(z) by all unknowns, multipliers included. The
tangent is the second derivative, symmetric and indefinite.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import SuperLU, splu

from cprbm_scene.answer import Array
from cprbm_scene.frozendict import frozendict
from fea_reference.acting import Acting
from fea_reference.beam_loads import BeamLoad, beam_load, load_forces
from fea_reference.contacts import touch
from fea_reference.element import ElementForces
from fea_reference.model import MOMENTS, DrivePart, Model, OnBeam, SharePart, turned
from fea_reference.outline import Graph
from fea_reference.pattern import Block, Single
from fea_reference.rigid import rigid
from fea_reference.state import State
from fea_reference.touch import Circle, Contact, Pair, Penalty, Touch

NOTHING = 10.0
"""Floors: smaller forces are round-off."""

_ROUND_OFF = 3.0  # measured: up to two for 20 to 1280 elements, in both parts of the floor
_NONE_HELD: Mapping[Contact, float] = frozendict()
_NOTHING_FORESEEN: Mapping[Contact, Array] = frozendict()


@dataclass(frozen=True)
class Tangent:
    """Tangent of a system, assembled and factorised where needed."""

    assembled: Callable[[], csc_matrix]

    @cached_property
    def matrix(self) -> csc_matrix:
        """The sparse matrix (size, size)."""
        return self.assembled()

    @cached_property
    def factors(self) -> SuperLU | None:
        """LU factors; None for a singular matrix."""
        try:
            return factors(self.matrix)
        except RuntimeError:  # exactly singular
            return None


@dataclass(frozen=True)
class System:
    """Residual and tangent in a state ``z``.

    Attributes:
        loads: loads on beams with a nonzero value.
        residual: unbalanced generalised forces and constraint violations, (size,).
        tangent: derivative of the residual, sparse (size, size).
        scale: the largest generalised force in equilibrium; EI/length² if all forces are round-off.
        floor: round-off of the residual. An element's end force is 12 EI/h² times the angle between tangent and
            chord, so that its round-off is 12 EI/h² times the spacing of machine numbers at the chord's angle. A
            penalty ε adds ε times an element's share of the zone times the round-off of the gap.
        significant: True if the forces in equilibrium exceed round-off.
    """

    z: State
    acting: Acting
    residual: Array
    tangent: Tangent
    elements: ElementForces
    touches: tuple[Touch, ...]
    loads: tuple[BeamLoad, ...]
    scale: float
    floor: float
    significant: bool

    def solve(self, right: Array) -> Array | None:
        """Solution (size,) of the tangent's equations for ``right`` (size,); None for a singular tangent."""
        factors_here = self.tangent.factors
        solution = None if factors_here is None else factors_here.solve(right)
        return None if solution is None or not np.isfinite(solution).all() else solution


def factors(matrix: csc_matrix) -> SuperLU:
    """LU factors of a matrix (m, m), without supernodes: beam matrices have too few similar columns.

    Raises:
        RuntimeError: the matrix is exactly singular.
    """
    return splu(matrix, relax=1, panel_size=1)


@dataclass(frozen=True, slots=True)
class Drag:
    """Springs of stiffness ``weights`` (size,) on all motions, relaxed in the state ``anchor``."""

    anchor: State
    weights: Array


def with_stiffness_factor(model: Model, system: System, contact: Touch, factor: float) -> System:
    """The system with a contact ``factor`` times as stiff at unchanged force; only the tangent changes."""
    change = replace(contact, stiffness=factor * contact.stiffness).hessian(contact.pushes) - contact.hessian(
        contact.pushes
    )
    changed = system.tangent.matrix + model.patterns.matrix([Block(contact.dofs, change)])
    return replace(system, tangent=Tangent(lambda: changed))


def assemble(
    model: Model,
    penalties: Mapping[Contact, Penalty],
    quadrature: int,
    values: Array,
    z: State,
    acting: Acting,
    held_depths: Mapping[Contact, float] = _NONE_HELD,
    predicted: Mapping[Contact, Array] = _NOTHING_FORESEEN,
    drag: Drag | None = None,
) -> System:
    """Residual and tangent in state ``z``.

    Args:
        model: the mechanism.
        penalties: penalty of every closed contact.
        quadrature: Gauss points per interval of a contact zone.
        values: dimensionless values of all stepped parameters, in the model's order.
        z: the unknowns.
        acting: the active constraints.
        held_depths: depths of contacts forced active, see :func:`~fea_reference.contact.touch`.
        predicted: predicted point forces (k,) of contacts, used in the tangent, see :mod:`fea_reference.newton`.
        drag: additional springs.
    """
    touches = tuple(
        touch(model, pair, penalty, quadrature, z, held_depths.get(pair)) for pair, penalty in penalties.items()
    )
    rounded = sum(_ROUND_OFF * _round_off(model, contact, penalties[contact.pair].stiffness) for contact in touches)
    return _assembled(model, touches, rounded, values, z, acting, predicted, drag)


def with_point_forces(model: Model, system: System, values: Array, z: State, pushes: Mapping[Contact, Array]) -> System:
    """The system with given contact point forces ``pushes`` (k,), in a state ``z`` with nearly the same contacts.

    The forces then are free of the round-off of gaps.
    """
    touches = tuple(
        replace(contact, gap=-pushes[contact.pair] / np.where(contact.stiffness > 0.0, contact.stiffness, 1.0))
        if contact.closed
        else contact
        for contact in system.touches
    )
    return _assembled(model, touches, 0.0, values, z, system.acting, _NOTHING_FORESEEN, None)


def _assembled(
    model: Model,
    touches: tuple[Touch, ...],
    rounded: float,
    values: Array,
    z: State,
    acting: Acting,
    predicted: Mapping[Contact, Array],
    drag: Drag | None,
) -> System:
    """The system with contacts of a given round-off."""
    elements = model.bend(z)
    residual, rigid_entries = rigid(model, values, z, acting)
    parts = [(model.element_dofs, elements.gradient)]
    pressing = [(contact, contact.gradient) for contact in touches if contact.closed]
    parts += [(contact.dofs, gradient) for contact, gradient in pressing]
    loads = tuple(
        beam_load(model, part, float(value), z)
        for part, value in zip(model.loads, values[: len(model.loads)], strict=True)
        if isinstance(part, OnBeam) and value != 0.0  # loads of later stages do not act yet
    )
    for load in loads:
        parts.append((load.dofs, -load.gradient))
    for dofs, gradient in parts:
        residual += model.spread(dofs, gradient)
    if drag is not None:
        residual += drag.weights * (z.values - drag.anchor.values + (z.rest - drag.anchor.rest))

    def tangent() -> csc_matrix:
        entries: list[Block | Single] = [rigid_entries, Block(model.element_dofs, elements.hessian())]
        for contact, _ in pressing:
            entries.append(Block(contact.dofs, contact.hessian(_pushes(contact, predicted.get(contact.pair)))))
        entries += [Block(load.dofs, -load.hessian) for load in loads]
        if drag is not None:
            unknowns = np.arange(model.size)
            entries.append(Single(unknowns, unknowns, drag.weights))
        return model.patterns.matrix(entries)

    balanced = [np.abs(elements.gradient[:6]).max(), np.abs(values[: len(model.loads)]).max(initial=0.0)]
    balanced += [np.abs(gradient).max() for _, gradient in pressing]
    auxiliary = (abs(values[model.stepped.index(MOMENTS)] * contact.moment) for contact in model.apart)
    largest = float(max(*balanced, *auxiliary))
    angle = max(1.0, float(np.abs(z[model.node_dofs[2]]).max()))
    floor = _ROUND_OFF * model.stiffest * float(np.spacing(angle)) + rounded
    significant = largest > NOTHING * floor
    return System(
        z,
        acting,
        residual,
        Tangent(tangent),
        elements,
        touches,
        loads,
        largest if significant else 1.0,
        floor,
        significant,
    )


def _pushes(contact: Touch, predicted: Array | None) -> Array:
    """Predicted point forces (k,) of a contact for the tangent.

    If the points have changed, the current forces are scaled down to the predicted sum.
    """
    if predicted is None:
        return contact.pushes
    if predicted.size == contact.pushes.size:
        return predicted
    share = float(predicted.sum()) / contact.push if contact.push != 0.0 else 0.0
    return min(1.0, max(-1.0, share)) * contact.pushes


def _round_off(model: Model, touch: Touch, stiffness: float) -> float:
    """Round-off of a contact's nodal force: ε times the zone's length in an element times the round-off of the gap.

    The gap is rounded relative to the element's length, for a pair or an edge also to the distance in contact. On a
    moving body or on the graph of a function the round-off is relative to the longest beam.
    """
    pair = touch.pair
    h = float(model.elements.length[model.beams[pair.first].elements.start])
    if isinstance(pair, Pair):
        lengths = h + float(model.elements.length[model.beams[pair.second].elements.start]) + pair.distance
    elif model.bodies[pair.body].dofs is not None:
        lengths = 1.0
    elif isinstance(pair, Circle):
        lengths = h
    else:
        lengths = 1.0 if isinstance(pair.outline, Graph) else h + pair.edge.farthest
    widest = h * float((touch.zones.intervals[:, 1] - touch.zones.intervals[:, 0]).max(initial=0.0))
    return 2.0**-52 * stiffness * widest * lengths


def load_direction(model: Model, load: int, z: State, acting: Acting) -> Array:
    """Right-hand side (size,) of a unit load, drive or share.

    A load or moment gives its generalised forces, a drive a unit in its row, a way the shortening in its rows.
    """
    part = model.stepped[load]
    f = np.zeros(model.size)
    if isinstance(part, OnBeam):
        return load_forces(model, part, z)
    if isinstance(part, SharePart):
        for i, end in enumerate(model.apart):
            if part is MOMENTS:
                f[end.joint.dofs[2]] = end.moment
            elif acting.ways is not None:
                f[end.joint.rows] = -acting.ways[i]
        return f
    body = model.bodies[part.body]
    if isinstance(part, DrivePart):
        f[part.row] = 1.0
        return f
    if body.dofs is None:
        return f
    if part.direction is None:
        f[body.dofs[2]] = 1.0
        return f
    arm = turned(part.arm, z[body.dofs[2]])
    f[body.dofs] = [*part.direction, arm[0] * part.direction[1] - arm[1] * part.direction[0]]
    return f
